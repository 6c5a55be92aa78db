//! One colour everywhere.

use super::image::Image;
use crate::color::Color;
use crate::error::Result;
use crate::geom::IntRect;

/// `area` full of a colour.
pub(super) fn flood(area: IntRect, color: Color) -> Result<Image> {
    let pixel = color.premultiply();
    if pixel == [0; 4] {
        return Ok(Image::empty());
    }
    let mut out = Image::new(area)?;
    out.pixels_mut().fill(pixel);
    Ok(out)
}
