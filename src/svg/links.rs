//! Pictures that an SVG links to or embeds: from its own folder, packed SVGs too, and no larger than makes sense.

use std::fs::File;
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use super::read;
use usvg::{ImageHrefResolver, ImageKind, Options, Tree};

/// The most bytes of a linked file, and the most that an embedded packed SVG may unpack to.
const LARGEST: usize = 64 << 20;

/// Finds linked and embedded pictures for [`usvg::Options::image_href_resolver`], and says to `warn`, in a line, which are
/// left out and why.
///
/// Differences to usvg's own way: packed SVGs (`.svgz`) are read in `data:` links, too; only regular files of up to 64 MiB
/// are read; and of those only
/// - what lies in [`usvg::Options::resources_dir`] or below, or, without that, in the working folder,
/// - what a relative link leads to, if all of its way does not lie through the root folder.
pub fn image_resolver(warn: impl Fn(String) + Send + Sync + 'static) -> ImageHrefResolver<'static> {
    let warn = Arc::new(warn);
    let data = ImageHrefResolver::default_data_resolver();
    let embedded = ImageHrefResolver::default_data_resolver();
    let say = Arc::clone(&warn);
    ImageHrefResolver {
        resolve_data: Box::new(move |mime, bytes, options| {
            if is_packed(&bytes) { unpack(&bytes, options, &*say) } else { data(mime, bytes, options) }
        }),
        resolve_string: Box::new(move |link, options| {
            let bytes = match read_linked(link, options.resources_dir.as_deref()) {
                Ok(bytes) => bytes,
                Err(reason) => {
                    warn(format!("image '{}' is left out: {reason}", link.escape_debug()));
                    return None;
                }
            };
            // This type makes usvg look at the bytes.
            if is_packed(&bytes) {
                unpack(&bytes, options, &*warn)
            } else {
                embedded("text/plain", Arc::new(bytes), options)
            }
        }),
    }
}

fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

fn unpack(bytes: &[u8], options: &Options<'_>, warn: &dyn Fn(String)) -> Option<ImageKind> {
    let tree = read::unpack(bytes, LARGEST)
        .map_err(|error| error.to_string())
        .and_then(|text| Tree::from_data_nested(&text, options).map_err(|error| error.to_string()));
    match tree {
        Ok(tree) => Some(ImageKind::SVG(tree)),
        Err(error) => {
            warn(format!("packed SVG image is left out: {error}"));
            None
        }
    }
}

/// The bytes of a linked file, or why there are none.
fn read_linked(link: &str, folder: Option<&Path>) -> Result<Vec<u8>, String> {
    if link.contains("://") && !link.starts_with("file://") {
        return Err("links to the network are not followed".to_owned());
    }
    let base = folder.unwrap_or(Path::new("."));
    let link = Path::new(link.strip_prefix("file://").unwrap_or(link));
    let no_file = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => error.to_string(),
    };
    let path = std::fs::canonicalize(base.join(link)).map_err(no_file)?;
    let base = std::fs::canonicalize(base).map_err(|error| error.to_string())?;
    if !is_within(&path, &base, link.is_relative()) {
        return Err("it is outside of the resources folder".to_owned());
    }
    // Devices and pipes may have no end, or wait for ever.
    if !std::fs::metadata(&path).map_err(no_file)?.is_file() {
        return Err("it is no regular file".to_owned());
    }
    let mut bytes = Vec::new();
    let file = File::open(&path).map_err(no_file)?;
    file.take(LARGEST as u64 + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    if bytes.len() > LARGEST {
        return Err(format!("it is over the limit of {} MiB", LARGEST >> 20));
    }
    Ok(bytes)
}

/// Whether a file may be read; both paths are absolute and without links.
fn is_within(path: &Path, base: &Path, is_relative: bool) -> bool {
    if path.starts_with(base) {
        return true;
    }
    let common: PathBuf =
        path.components().zip(base.components()).take_while(|(a, b)| a == b).map(|(a, _)| a).collect();
    is_relative && common.components().any(|part| matches!(part, Component::Normal(_)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_read_from_the_folder_and_from_around_it() {
        let within = |path: &str, relative| is_within(Path::new(path), Path::new("/home/me/drawings"), relative);
        assert!(within("/home/me/drawings/a.png", true) && within("/home/me/drawings/deep/a.png", false));
        assert!(within("/home/me/pictures/a.png", true));
        assert!(!within("/home/me/pictures/a.png", false));
        assert!(!within("/etc/a.png", true));
        assert!(is_within(Path::new("/etc/a.png"), Path::new("/"), false));
    }

    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_refused_with_a_reason() {
        let root = Some(Path::new("/"));
        assert_eq!(read_linked("/dev/zero", root).unwrap_err(), "it is no regular file");
        assert_eq!(read_linked("/dev", root).unwrap_err(), "it is no regular file");
        assert_eq!(read_linked("/no/such/file", root).unwrap_err(), "there is no such file");
        assert_eq!(read_linked("/dev/zero", None).unwrap_err(), "it is outside of the resources folder");
        assert!(read_linked("https://example.org/a.png", root).unwrap_err().contains("network"));
        assert!(read_linked("a\0b", root).is_err());
    }
}
