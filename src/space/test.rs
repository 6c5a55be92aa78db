//! Stencil and depth tests of a row of eight pixels, for any samples.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, mask32x8};

use super::batch::BatchTriangle;
use super::depth::log2;
use super::hiz::DepthRule;
use super::state::{Compare, Stencil, StencilFace};
use super::target::{BandMut, TILE};

/// The tests of a draw.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tests {
    pub(crate) depth: DepthRule,
    pub(crate) stencil: Option<Stencil>,
}

/// The lanes' offsets from the first pixel.
#[inline(always)]
pub(crate) fn lane_offsets<S: Simd>(simd: S) -> f32x8<S> {
    f32x8::load_array(simd, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0])
}

/// A plane at eight pixels: dx of each, and dy, from the triangle's first vertex. Rises or falls evenly along x and y however
/// it is rounded, which the hierarchical depth relies on.
#[inline(always)]
pub(crate) fn plane_at<S: Simd>([c, gx, gy]: [f32; 3], dx: f32x8<S>, dy: f32x8<S>) -> f32x8<S> {
    (dx * gx + c) + dy * gy
}

/// The depth keys of eight places of a triangle.
#[inline(always)]
pub(crate) fn depth_keys<S: Simd>(rule: &DepthRule, triangle: &BatchTriangle, dx: f32x8<S>, dy: f32x8<S>) -> i32x8<S> {
    let z = match rule.logarithm {
        None => plane_at(triangle.z, dx, dy),
        Some((offset, scale)) => {
            let simd = dx.simd;
            let inverse_w = plane_at(triangle.inverse_w, dx, dy);
            // A place beside the triangle may have any 1 / w; it is covered by no sample, but must stay a number.
            let sound = inverse_w.simd_gt(f32x8::splat(simd, 1e-30));
            let w = f32x8::splat(simd, 1.0) / sound.select(inverse_w, f32x8::splat(simd, 1.0));
            (log2(w) - offset) * scale + triangle.z[0]
        }
    };
    rule.format.keys(z)
}

/// Which lanes pass the depth comparison.
#[inline(always)]
pub(crate) fn depth_passes<S: Simd>(compare: Compare, key: i32x8<S>, stored: i32x8<S>) -> mask32x8<S> {
    match compare {
        Compare::Never => mask32x8::splat(key.simd, false),
        Compare::Less => key.simd_lt(stored),
        Compare::Equal => key.simd_eq(stored),
        Compare::LessEqual => key.simd_le(stored),
        Compare::Greater => key.simd_gt(stored),
        Compare::NotEqual => !key.simd_eq(stored),
        Compare::GreaterEqual => key.simd_ge(stored),
        Compare::Always => mask32x8::splat(key.simd, true),
    }
}

/// Runs stencil and depth tests on a row of pixels of a tile, stores what they store, and gives the samples that passed.
#[inline(always)]
pub(crate) fn test_group<S: Simd>(
    simd: S,
    tests: &Tests,
    triangle: &BatchTriangle,
    band: &mut BandMut<'_>,
    (x, y): (u16, u16),
    masks: [u64; 2],
) -> [u64; 2] {
    let row = usize::from(y) % TILE;
    let tile = (usize::from(y) / TILE - band.first) * band.tiles_x + usize::from(x) / TILE;
    let positions = band.samples.positions();
    let mut passed = [0_u64; 2];
    let face = tests.stencil.map(|stencil| if triangle.front { stencil.front } else { stencil.back });
    for (sample, (sx, sy)) in positions.iter().enumerate() {
        let mut bits = (masks[sample / 8] >> (8 * (sample % 8))) as u8;
        if bits == 0 {
            continue;
        }
        let place = tile * positions.len() + sample;
        if let Some(face) = face {
            let Some(stored) = band.stencil.get_mut(place) else { continue };
            bits = stencil_test(&face, &mut stored[row], bits);
            if bits == 0 {
                continue;
            }
        }
        let mut through = bits;
        if tests.depth.is_on() {
            let Some(depth) = band.depth.get_mut(place) else { continue };
            let left = f32::from(x) + f32::from(*sx) / 16.0 - triangle.gradients.x0;
            let dy = f32::from(y) + f32::from(*sy) / 16.0 - triangle.gradients.y0;
            let dx = lane_offsets(simd) + left;
            let key = depth_keys(&tests.depth, triangle, dx, f32x8::splat(simd, dy));
            let stored = i32x8::load_array_ref(simd, &depth[row]);
            let pass = depth_passes(tests.depth.compare, key, stored) & mask32x8::from_bitmask(simd, u64::from(bits));
            through = pass.to_bitmask() as u8;
            if tests.depth.write {
                pass.select(key, stored).store_array(&mut depth[row]);
            }
        }
        if let Some(face) = face {
            let Some(stored) = band.stencil.get_mut(place) else { continue };
            for (i, value) in stored[row].iter_mut().enumerate() {
                if bits >> i & 1 == 1 {
                    let op = if through >> i & 1 == 1 { face.pass } else { face.depth_fail };
                    *value = face.update(op, *value);
                }
            }
        }
        passed[sample / 8] |= u64::from(through) << (8 * (sample % 8));
    }
    passed
}

/// The lanes that pass the stencil test; the others' values are updated.
#[inline(always)]
fn stencil_test(face: &StencilFace, values: &mut [u8; TILE], mut bits: u8) -> u8 {
    for (i, value) in values.iter_mut().enumerate() {
        if bits >> i & 1 == 1 && !face.passes(*value) {
            *value = face.update(face.fail, *value);
            bits &= !(1 << i);
        }
    }
    bits
}
