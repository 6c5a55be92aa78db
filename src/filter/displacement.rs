//! Pixels moved by another picture's colours.

use std::sync::Arc;

use super::image::{Image, Work};
use crate::color::demultiply_u8;
use crate::error::Result;
use crate::geom::IntRect;

/// A component of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// Alpha.
    Alpha,
}

impl Channel {
    fn of(self, [r, g, b, a]: [u8; 4]) -> u8 {
        match self {
            Self::Red => r,
            Self::Green => g,
            Self::Blue => b,
            Self::Alpha => a,
        }
    }
}

/// How [`Kind::DisplacementMap`](super::Kind::DisplacementMap) reads its map: a pixel shows what lies
/// scale · (C − ½) away, with C the straight component of the map in 0 ..= 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplacementMap {
    /// Twice the greatest distance, in user space.
    pub scale: f32,
    /// The component that moves pixels across.
    pub x_channel: Channel,
    /// The component that moves pixels down.
    pub y_channel: Channel,
}

/// The picture displaced, in `area`; `scale` is in pixels, across and down.
pub(super) fn displace(
    image: &Image,
    map: Arc<Image>,
    area: IntRect,
    displacement: &DisplacementMap,
    scale: (f32, f32),
    work: Work,
) -> Result<Image> {
    let mut out = Arc::unwrap_or_clone(map).with_bounds(area)?;
    out.for_rows(work, |y, row| {
        for (x, pixel) in (area.left..).zip(row) {
            let by = demultiply_u8(*pixel);
            // To the nearest pixel: interpolation would mix what lies on both sides of a fold.
            let from = |at: i32, scale: f32, channel: Channel| {
                at.saturating_add((scale * (f32::from(channel.of(by)) / 255.0 - 0.5) + 0.5).floor() as i32)
            };
            let x = from(x, scale.0, displacement.x_channel);
            let (_, source) = image.part(from(y, scale.1, displacement.y_channel), x, x.saturating_add(1));
            *pixel = source.first().copied().unwrap_or([0; 4]);
        }
    });
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, image};
    use super::*;

    #[test]
    fn pixels_come_from_where_the_map_says() {
        let source = image(0, 0, &["1234", "5678"]);
        let mut map = Image::new(IntRect::from_ltrb(0, 0, 4, 2)).unwrap();
        // Red 255: half of the scale to the right. Green 0: half of it up. 127 and 128 round to none of 3 pixels.
        map.pixels_mut().fill([255, 128, 0, 255]);
        map.pixels_mut()[5] = [127, 0, 0, 255];
        // Straight red is 255 here, too.
        map.pixels_mut()[6] = [100, 50, 0, 100];
        let by = DisplacementMap { scale: 2.0, x_channel: Channel::Red, y_channel: Channel::Green };
        let area = IntRect::from_ltrb(0, 0, 4, 2);
        let out = displace(&source, map.into(), area, &by, (2.0, 2.0), WORK).unwrap();
        assert_eq!(out, image(0, 0, &["234.", "628."]));
    }
}
