//! From a file's bytes to a tree.

use std::borrow::Cow;
use std::io::Read as _;

use flate2::read::MultiGzDecoder;

use super::limits::ParseLimits;
use crate::error::{Error, Result};

/// The SVG text in a file's bytes: unpacked if they are gzip (`.svgz`), else as they are.
///
/// # Errors
/// [`Error::Format`] if the gzip data is broken; [`Error::Limit`] if it, or the file as it is, holds more
/// than `limit` bytes.
pub fn unpack(bytes: &[u8], limit: usize) -> Result<Cow<'_, [u8]>> {
    let too_large = || Error::Limit(format!("the file holds more than the limit of {limit} bytes of SVG"));
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return if bytes.len() > limit { Err(too_large()) } else { Ok(Cow::Borrowed(bytes)) };
    }
    let mut text = Vec::new();
    // One byte more than the limit tells a file that is too large from one that just fits.
    MultiGzDecoder::new(bytes)
        .take((limit as u64).saturating_add(1))
        .read_to_end(&mut text)
        .map_err(|error| Error::Format(format!("the gzip data is broken: {error}")))?;
    if text.len() > limit {
        return Err(too_large());
    }
    Ok(Cow::Owned(text))
}

/// Parses the bytes of an SVG file, packed (`.svgz`) or not.
///
/// usvg recurses into nested elements: a thread with a stack of 16 MiB or more is wanted for files from
/// anywhere. There are files of a few kilobytes that keep it busy for minutes or overflow any stack: see
/// [`parse_with_limits`].
///
/// # Errors
/// [`Error::Format`] if the data is not an SVG; [`Error::Limit`] if it unpacks to more than 256 MiB.
pub fn parse(bytes: &[u8], options: &usvg::Options<'_>) -> Result<usvg::Tree> {
    let text = unpack(bytes, UNPACKED_LIMIT)?;
    parse_text(utf8(&text)?, options)
}

/// Parses as [`parse`] does what stays within limits that are checked before: the length, how deep elements lie, and how
/// much there is when references are replaced by what they refer to.
///
/// The estimate covers what attributes say, not style sheets; a file made to harm can still ask for more than it seems to,
/// and cyclic patterns overflow the stack. Who draws files from anyone does so in a process of its own, as the
/// program does.
///
/// # Errors
/// As [`parse`]; [`Error::Limit`] for what is over a limit.
pub fn parse_with_limits(bytes: &[u8], options: &usvg::Options<'_>, limits: &ParseLimits) -> Result<usvg::Tree> {
    let text = unpack(bytes, limits.bytes)?;
    let text = utf8(&text)?;
    limits.check(text)?;
    parse_text(text, options)
}

fn utf8(text: &[u8]) -> Result<&str> {
    std::str::from_utf8(text)
        .map_err(|error| Error::Format(format!("not an SVG: byte {} is not UTF-8", error.valid_up_to())))
}

fn parse_text(text: &str, options: &usvg::Options<'_>) -> Result<usvg::Tree> {
    usvg::Tree::from_str(text, options).map_err(|error| match error {
        usvg::Error::ParsingFailed(usvg::roxmltree::Error::NodesLimitReached) => Error::Limit(
            "the SVG nests its elements more than 1,024 deep, or has more than 1,000,000 of them".to_owned(),
        ),
        usvg::Error::ParsingFailed(error) => Error::Format(format!("not an SVG: {error}")),
        usvg::Error::InvalidSize => {
            Error::Format("the SVG has no valid size: width and height must be above 0".to_owned())
        }
        usvg::Error::ElementsLimitReached => Error::Limit("the SVG has more than 1,000,000 elements".to_owned()),
        error => Error::Format(format!("not an SVG: {error}")),
    })
}

/// The most that a packed file may unpack to.
const UNPACKED_LIMIT: usize = 256 << 20;

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use flate2::Compression;
    use flate2::write::GzEncoder;

    use super::*;

    fn packed(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn packed_and_plain_bytes_give_the_same_text() {
        assert_eq!(unpack(b"<svg/>", 6).unwrap(), b"<svg/>".as_slice());
        assert_eq!(unpack(&packed(b"<svg/>"), 6).unwrap(), b"<svg/>".as_slice());
    }

    #[test]
    fn the_limit_is_the_last_size_that_passes() {
        assert!(matches!(unpack(b"<svg/>", 5), Err(Error::Limit(_))));
        assert!(matches!(unpack(&packed(b"<svg/>"), 5), Err(Error::Limit(_))));
    }

    #[test]
    fn broken_gzip_is_an_error_at_every_length() {
        let bytes = packed(b"<svg xmlns='http://www.w3.org/2000/svg'/>");
        for length in 2..bytes.len() {
            assert!(matches!(unpack(&bytes[..length], 1000), Err(Error::Format(_))), "{length}");
        }
    }

    #[test]
    fn what_is_no_svg_says_so() {
        let options = usvg::Options::default();
        for bytes in [b"".as_slice(), b"\xff\xfe\x00", b"<html/>", b"<svg", b"no"] {
            let Err(Error::Format(text)) = parse(bytes, &options) else { panic!("{bytes:?} parses") };
            assert!(text.starts_with("not an SVG"), "{text}");
        }
    }
}
