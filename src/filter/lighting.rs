//! A picture's alpha as a surface in the light.

use super::image::{Image, Work, grown};
use super::light::{Light, LightSource, Power, dot};
use crate::color::{Color, unit};
use crate::error::Result;
use crate::geom::IntRect;

/// A surface that scatters light to all sides. The result is opaque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseLighting {
    /// The surface's height where alpha is 1, in pixels.
    pub surface_scale: f32,
    /// How much of the light it scatters; not negative.
    pub diffuse_constant: f32,
    /// The light's colour; its alpha does not matter.
    pub color: Color,
    /// Where the light comes from.
    pub light: LightSource,
}

/// A surface that reflects light like a mirror, more or less polished. The result is the light alone, its alpha the
/// greatest of its components.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpecularLighting {
    /// The surface's height where alpha is 1, in pixels.
    pub surface_scale: f32,
    /// How much of the light it reflects; not negative.
    pub specular_constant: f32,
    /// How well it is polished, 1 ..= 128.
    pub specular_exponent: f32,
    /// The light's colour; its alpha does not matter.
    pub color: Color,
    /// Where the light comes from.
    pub light: LightSource,
}

/// Scattered light, in `area`; the map takes user space to pixels.
pub(super) fn diffuse(
    image: &Image,
    area: IntRect,
    region: IntRect,
    lighting: &DiffuseLighting,
    map: &Map,
    work: Work,
) -> Result<Image> {
    let light = Light::new(&lighting.light, map.scale, map.origin);
    let constant = lighting.diffuse_constant;
    let color = components(lighting.color);
    shade(image, area, region, lighting.surface_scale, work, |point, normal| {
        let (direction, bright) = light.at(point);
        let factor = constant * bright * dot(normal, direction) / dot(normal, normal).sqrt();
        let [r, g, b] = color.map(|v| level(v * factor));
        [r, g, b, 255]
    })
}

/// Reflected light, in `area`.
pub(super) fn specular(
    image: &Image,
    area: IntRect,
    region: IntRect,
    lighting: &SpecularLighting,
    map: &Map,
    work: Work,
) -> Result<Image> {
    let light = Light::new(&lighting.light, map.scale, map.origin);
    let constant = lighting.specular_constant;
    let polish = Power::new(lighting.specular_exponent);
    let color = components(lighting.color);
    shade(image, area, region, lighting.surface_scale, work, |point, normal| {
        let ([x, y, z], bright) = light.at(point);
        // Half way between the light and the viewer.
        let half = [x, y, z + 1.0];
        let lengths = (dot(normal, normal) * dot(half, half)).sqrt();
        let cosine = if lengths > 0.0 { dot(normal, half) / lengths } else { 0.0 };
        let factor = constant * bright * polish.of(cosine);
        let [r, g, b] = color.map(|v| level(v * factor));
        [r, g, b, r.max(g).max(b)]
    })
}

/// From user space to pixels.
pub(super) struct Map {
    pub(super) scale: (f32, f32),
    pub(super) origin: (f32, f32),
}

fn components(color: Color) -> [f32; 3] {
    [color.r, color.g, color.b].map(|v| unit(v) * 255.0)
}

/// Rounded to 0 ..= 255; what is not a number is 0.
fn level(v: f32) -> u8 {
    (v + 0.5) as u8
}

/// Calls `f` with the point of the surface and its normal at each pixel of `area`.
///
/// The normal is by Sobel's operator; at the region's sides, by the neighbours that there are, as the tables of the
/// specification (`feDiffuseLighting`) have it, whose factors are all 2 / (weights · distance).
fn shade(
    image: &Image,
    area: IntRect,
    region: IntRect,
    height: f32,
    work: Work,
    f: impl Fn([f32; 3], [f32; 3]) -> [u8; 4] + Sync,
) -> Result<Image> {
    let window = grown(area, (1, 1), (1, 1)).intersect(region);
    let height = if height.is_finite() { height / 255.0 } else { 0.0 };
    let mut out = Image::new(area)?;
    out.for_rows(work, |y, row| {
        let (top, bottom) = ((y - 1).max(region.top), (y + 1).min(region.bottom - 1));
        let [above, own, below] = [top, y, bottom].map(|y| image.part(y, window.left, window.right));
        // A row at the region's side has no neighbour there, and no weight.
        let (weight_above, weight_below) = (if top < y { 1.0 } else { 0.0 }, if bottom > y { 1.0 } else { 0.0 });
        let factor_x = |distance: i32| 2.0 / ((2.0 + weight_above + weight_below) * distance as f32);
        let down = (bottom - top) as f32;
        for (x, pixel) in (area.left..).zip(row) {
            let (left, right) = ((x - 1).max(region.left), (x + 1).min(region.right - 1));
            let at = |(first, row): (i32, &[[u8; 4]]), x: i32| {
                usize::try_from(x - first).ok().and_then(|x| row.get(x)).map_or(0.0, |pixel| f32::from(pixel[3]))
            };
            let side = |x: i32| at(above, x) * weight_above + 2.0 * at(own, x) + at(below, x) * weight_below;
            let (weight_left, weight_right) = (if left < x { 1.0 } else { 0.0 }, if right > x { 1.0 } else { 0.0 });
            let end = |row| at(row, left) * weight_left + 2.0 * at(row, x) + at(row, right) * weight_right;
            let slope_x = if left < right { (side(right) - side(left)) * factor_x(right - left) } else { 0.0 };
            let weights = (2.0 + weight_left + weight_right) * down;
            let slope_y = if top < bottom { (end(below) - end(above)) * 2.0 / weights } else { 0.0 };
            let point = [x as f32, y as f32, at(own, x) * height];
            *pixel = f(point, [-slope_x * height, -slope_y * height, 1.0]);
        }
    });
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, image, noise};
    use super::*;

    const MAP: Map = Map { scale: (1.0, 1.0), origin: (0.0, 0.0) };

    fn distant(azimuth: f32, elevation: f32) -> DiffuseLighting {
        DiffuseLighting {
            surface_scale: 1.0,
            diffuse_constant: 1.0,
            color: Color::WHITE,
            light: LightSource::Distant { azimuth, elevation },
        }
    }

    #[test]
    fn a_flat_surface_has_the_sine_of_the_elevation() {
        let area = IntRect::from_ltrb(0, 0, 3, 3);
        let source = image(0, 0, &["555", "555", "555"]);
        let out = diffuse(&source, area, area, &distant(45.0, 30.0), &MAP, WORK).unwrap();
        assert!(out.pixels().iter().all(|pixel| *pixel == [128, 128, 128, 255]), "{out:?}");
    }

    #[test]
    fn slopes_are_those_of_the_tables() {
        // Alpha x · 51 / 255: it rises by 1/5 a pixel, which the specification's factors double. Lit from the left, at the
        // horizon: N = (−2/5, 0, 1) · surface scale 5 = (−2, 0, 1), L = (−1, 0, 0), N · L / |N| = 2 / √5.
        let source = image(0, 0, &["0246", "0246", "0246"]);
        let area = IntRect::from_ltrb(0, 0, 4, 3);
        let lighting = DiffuseLighting { surface_scale: 5.0, ..distant(180.0, 0.0) };
        let out = diffuse(&source, area, area, &lighting, &MAP, WORK).unwrap();
        let expected = 255.0 * 2.0 / 5.0_f32.sqrt();
        for pixel in out.pixels() {
            assert!((f32::from(pixel[0]) - expected).abs() <= 1.0, "{out:?}");
        }
    }

    #[test]
    fn reflections_are_sharper_the_better_the_polish() {
        let area = IntRect::from_ltrb(0, 0, 3, 3);
        let source = image(0, 0, &["###", "###", "###"]);
        let shine = |specular_exponent| {
            let lighting = SpecularLighting {
                surface_scale: 1.0,
                specular_constant: 1.0,
                specular_exponent,
                color: Color::from_rgba(1.0, 0.5, 0.0, 1.0),
                light: LightSource::Distant { azimuth: 0.0, elevation: 30.0 },
            };
            specular(&source, area, area, &lighting, &MAP, WORK).unwrap().pixels()[4]
        };
        // L = (cos 30°, 0, ½), H = (0.866, 0, 1.5), N · H / |H| = 1.5 / √3 = cos 30°; squared 3/4.
        assert_eq!(shine(1.0), [221, 110, 0, 221]);
        assert_eq!(shine(2.0), [191, 96, 0, 191]);
    }

    #[test]
    fn a_part_is_what_the_whole_has_there() {
        let region = IntRect::from_ltrb(0, 0, 30, 20);
        let source = noise(region, 8);
        let lighting = DiffuseLighting {
            surface_scale: 3.0,
            light: LightSource::Point { position: [5.0, 40.0, 9.0] },
            ..distant(0.0, 0.0)
        };
        let whole = diffuse(&source, region, region, &lighting, &MAP, WORK).unwrap();
        for area in [IntRect::from_ltrb(3, 4, 9, 12), IntRect::from_ltrb(0, 15, 30, 20)] {
            let part = diffuse(&source, area, region, &lighting, &MAP, WORK).unwrap();
            assert_eq!(part, whole.crop(area).unwrap());
        }
    }
}
