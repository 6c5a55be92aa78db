//! What can go wrong, split by whose fault it is.

use std::fmt;
use std::path::PathBuf;

/// Everything that a call of this crate can refuse.
///
/// The variants say whose fault it is: the machine's ([`Error::Io`]), the data's ([`Error::Format`]),
/// the caller's ([`Error::Parameter`]) or a limit's ([`Error::Limit`]). Drawing itself cannot fail.
#[derive(Debug)]
#[non_exhaustive]
pub enum Error {
    /// A file could not be read or written.
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Data is not what it claims to be. The text names the place and the fault.
    Format(String),
    /// An argument is outside its documented range. The text names it and the remedy.
    Parameter(String),
    /// A size is over a limit, or memory is not to be had. The text names the limit.
    Limit(String),
}

/// The result of this crate's fallible calls.
pub type Result<T> = std::result::Result<T, Error>;

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io { path, source } => write!(f, "{}: {source}", path.display()),
            Self::Format(text) | Self::Parameter(text) | Self::Limit(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io { source, .. } => Some(source),
            _ => None,
        }
    }
}
