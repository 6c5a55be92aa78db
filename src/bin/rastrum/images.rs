//! Images that an SVG links to or embeds: as usvg reads them, and packed SVGs too.

use std::path::Path;

use rastrum::svg::{self, usvg};
use usvg::{ImageHrefResolver, ImageKind, Options, Tree};

use crate::notes;

/// The most that an embedded packed SVG may unpack to.
const LARGEST: usize = 64 << 20;

/// Finds images for usvg.
pub(crate) fn resolver() -> ImageHrefResolver<'static> {
    let data = ImageHrefResolver::default_data_resolver();
    let string = ImageHrefResolver::default_string_resolver();
    ImageHrefResolver {
        resolve_data: Box::new(move |mime, bytes, options| {
            if bytes.starts_with(&[0x1f, 0x8b]) { packed(&bytes, options) } else { data(mime, bytes, options) }
        }),
        resolve_string: Box::new(move |link, options| {
            let path = options.get_abs_path(Path::new(link));
            if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svgz")) {
                match std::fs::read(&path) {
                    Ok(bytes) => packed(&bytes, options),
                    Err(error) => {
                        notes::add(format!("image '{link}' is left out: {error}"));
                        None
                    }
                }
            } else {
                string(link, options)
            }
        }),
    }
}

fn packed(bytes: &[u8], options: &Options<'_>) -> Option<ImageKind> {
    let tree = svg::unpack(bytes, LARGEST)
        .map_err(|error| error.to_string())
        .and_then(|text| Tree::from_data_nested(&text, options).map_err(|error| error.to_string()));
    match tree {
        Ok(tree) => Some(ImageKind::SVG(tree)),
        Err(error) => {
            notes::add(format!("packed SVG image is left out: {error}"));
            None
        }
    }
}
