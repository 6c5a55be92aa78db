//! The picture over a blurred, tinted and moved copy of its alpha.

use super::blur::{Blur, blur};
use super::composite::blend_onto;
use super::image::{Image, Work, moved, union};
use super::source::{Parts, bands_of_parts};
use crate::blend::BlendMode;
use crate::color::Color;
use crate::error::Result;
use crate::geom::IntRect;
use crate::num::lanes::div255;

/// A shadow's blur, offset in pixels, and colour in the space of the picture.
pub(super) struct DropShadow {
    pub(super) across: Blur,
    pub(super) down: Blur,
    pub(super) offset: (i32, i32),
    pub(super) color: Color,
}

/// The picture over its shadow, in `area`.
pub(super) fn drop_shadow(
    image: &dyn Parts,
    area: IntRect,
    region: Option<IntRect>,
    shadow: &DropShadow,
    work: Work,
) -> Result<Image> {
    let (dx, dy) = shadow.offset;
    let inside = moved(area, -dx, -dy).intersect(region.unwrap_or(EVERYTHING));
    let mut cast = blur(image, inside, region, &shadow.across, &shadow.down, work)?;
    tint(&mut cast, shadow.color, work);
    let cast = cast.moved(dx, dy);
    let touched = image.bounds().intersect(area);
    let all = union(cast.bounds(), touched);
    let mut out = cast.with_bounds(all)?;
    // What is drawn part by part is drawn for the second time here: else it would be a picture while the shadow is cast.
    for band in bands_of_parts(touched, touched.width()) {
        blend_onto(&mut out, &*image.part(band)?, band, BlendMode::SourceOver, work);
    }
    Ok(out)
}

const EVERYTHING: IntRect = IntRect::from_ltrb(i32::MIN, i32::MIN, i32::MAX, i32::MAX);

/// Gives a picture one colour, times its alpha.
pub(crate) fn tint(image: &mut Image, color: Color, work: Work) {
    let color = color.premultiply().map(u32::from);
    image.for_pixels(work, |pixels| {
        for pixel in pixels {
            let alpha = u32::from(pixel[3]);
            *pixel = color.map(|component| div255(component * alpha) as u8);
        }
    });
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, image};
    use super::*;

    #[test]
    fn the_shadow_lies_beneath() {
        let shadow = DropShadow {
            across: Blur::new(0.0),
            down: Blur::new(0.0),
            offset: (1, 0),
            color: Color::from_rgba(1.0, 0.0, 0.0, 0.5),
        };
        let area = IntRect::from_ltrb(0, 0, 4, 1);
        let out = drop_shadow(&image(0, 0, &["##"]), area, None, &shadow, WORK).unwrap();
        assert_eq!(out.pixels(), [[255; 4], [255; 4], [128, 0, 0, 128]]);
    }
}
