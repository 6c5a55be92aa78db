//! What an SVG tree asks for and does not get.

use std::collections::HashSet;
use std::fmt;

/// Something in an SVG tree that was not drawn, or not as the file asks for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct Warning {
    /// What it is.
    pub kind: WarningKind,
    /// The `id` of the element that shows it, or the pattern's own. Empty where it has none.
    pub id: String,
}

/// The kinds of [`Warning`].
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum WarningKind {
    /// A filter whose picture is too large or has no memory: the picture is left out.
    FilterSize,
    /// An embedded picture that cannot be decoded, and why: it is left out.
    Image(String),
    /// A pattern, or a filter's picture, inside patterns and filters' pictures beyond the limit: it is left out.
    PatternDepth,
    /// A pattern whose tile is too large or has no memory: it is drawn at a lower resolution or left out.
    PatternSize,
    /// The tree expands to more elements or layers than the limit: the rest is left out.
    TooComplex,
}

impl fmt::Display for Warning {
    /// One line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let id = |f: &mut fmt::Formatter<'_>| {
            // An id is any text of the file's; a line break in it would forge a line of its own.
            if self.id.is_empty() { Ok(()) } else { write!(f, " '{}'", self.id.escape_debug()) }
        };
        match &self.kind {
            WarningKind::FilterSize => {
                f.write_str("filter")?;
                id(f)?;
                f.write_str(" has too large a picture: it is left out")
            }
            WarningKind::Image(reason) => {
                f.write_str("image")?;
                id(f)?;
                write!(f, " is left out: {}", reason.escape_debug())
            }
            WarningKind::PatternDepth => {
                f.write_str("pattern or filter")?;
                id(f)?;
                f.write_str(" is left out: they are nested too deeply")
            }
            WarningKind::PatternSize => {
                f.write_str("pattern")?;
                id(f)?;
                f.write_str(" has too large a tile: it is drawn at a lower resolution or left out")
            }
            WarningKind::TooComplex => f.write_str("the drawing expands to too many elements: the rest is left out"),
        }
    }
}

/// Warnings in the order in which they came up, each once.
#[derive(Debug, Default)]
pub(super) struct Warnings {
    list: Vec<Warning>,
    seen: HashSet<Warning>,
}

impl Warnings {
    pub(super) fn add(&mut self, kind: WarningKind, id: &str) {
        let warning = Warning { kind, id: id.to_owned() };
        if self.seen.insert(warning.clone()) {
            self.list.push(warning);
        }
    }

    pub(super) fn into_vec(self) -> Vec<Warning> {
        self.list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_comes_once_and_is_one_line() {
        let mut warnings = Warnings::default();
        warnings.add(WarningKind::PatternSize, "a\nb");
        warnings.add(WarningKind::PatternSize, "a\nb");
        warnings.add(WarningKind::PatternSize, "");
        let lines: Vec<_> = warnings.into_vec().iter().map(ToString::to_string).collect();
        assert_eq!(
            lines,
            [
                "pattern 'a\\nb' has too large a tile: it is drawn at a lower resolution or left out",
                "pattern has too large a tile: it is drawn at a lower resolution or left out"
            ]
        );
    }
}
