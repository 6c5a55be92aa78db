//! sRGB to linear light and back, eight bits a component.

use std::sync::LazyLock;

use super::graph::ColorSpace;
use super::image::{Image, Work};
use crate::color::{Color, unit};
use crate::num::trig;

/// The component in the other space, for each of 256.
type Table = [u8; 256];

static TO_LINEAR: LazyLock<Table> = LazyLock::new(|| table(to_linear));
static TO_SRGB: LazyLock<Table> = LazyLock::new(|| table(to_srgb));

fn table(f: fn(f64) -> f64) -> Table {
    std::array::from_fn(|v| (f(v as f64 / 255.0) * 255.0 + 0.5) as u8)
}

/// The transfer function of IEC 61966-2-1.
fn to_linear(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { trig::pow((v + 0.055) / 1.055, 2.4) }
}

fn to_srgb(v: f64) -> f64 {
    if v <= 0.003_130_8 { v * 12.92 } else { 1.055 * trig::pow(v, 1.0 / 2.4) - 0.055 }
}

/// The picture's pixels, from one space to another.
pub(super) fn convert(image: &mut Image, from: ColorSpace, to: ColorSpace, work: Work) {
    let table: &Table = match (from, to) {
        (ColorSpace::Srgb, ColorSpace::LinearRgb) => &TO_LINEAR,
        (ColorSpace::LinearRgb, ColorSpace::Srgb) => &TO_SRGB,
        _ => return,
    };
    image.map_straight(work, |[r, g, b, a]| {
        let look_up = |v: u8| table.get(usize::from(v)).copied().unwrap_or(v);
        [look_up(r), look_up(g), look_up(b), a]
    });
}

/// A colour of sRGB in `space`.
pub(super) fn color_in(space: ColorSpace, color: Color) -> Color {
    match space {
        ColorSpace::Srgb => color,
        ColorSpace::LinearRgb => {
            let linear = |v: f32| to_linear(f64::from(unit(v))) as f32;
            Color { r: linear(color.r), g: linear(color.g), b: linear(color.b), a: color.a }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_hold_known_values() {
        // 21.404 % of the light is sRGB's middle grey; the ends and the straight part near black are exact.
        assert_eq!([0, 1, 10, 128, 255].map(|v: usize| TO_LINEAR[v]), [0, 0, 1, 55, 255]);
        assert_eq!([0, 1, 55, 128, 255].map(|v: usize| TO_SRGB[v]), [0, 13, 128, 188, 255]);
        assert!(TO_LINEAR.is_sorted() && TO_SRGB.is_sorted());
    }
}
