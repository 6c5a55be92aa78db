//! Lights ready for shading, and shadow volumes.

use super::model::{Light, LightKind};
use super::shadow::ShadowMap;
use super::surface_shader::{Vector, dot, normalized};
use crate::num::lanes::each;
use crate::num::trig;
use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};

/// A light with everything reckoned that does not change over a frame.
pub(super) struct PreparedLight {
    pub(super) color: [f32; 3],
    kind: Prepared,
    pub(super) shadow: Option<ShadowMap>,
}

enum Prepared {
    Directional([f32; 3]),
    Point { position: [f32; 3], inverse_range: f32 },
    Spot { position: [f32; 3], direction: [f32; 3], inverse_range: f32, outer: f32, inverse_width: f32 },
}

impl PreparedLight {
    pub(super) fn new(light: &Light) -> Self {
        let inverse = |range: f32| if range > 0.0 && range.is_finite() { 1.0 / range } else { 0.0 };
        let direction = |v: [f32; 3]| super::model::unit(v.map(f64::from)).unwrap_or([0.0, 0.0, 1.0]);
        let kind = match light.kind {
            LightKind::Directional(towards) => Prepared::Directional(direction(towards)),
            LightKind::Point { position, range } => Prepared::Point { position, inverse_range: inverse(range) },
            LightKind::Spot { position, direction: towards, range, angle } => {
                let cosine = |angle: f32| trig::sin_cos(f64::from(angle)).1 as f32;
                let (outer, inner) = (cosine(angle), cosine(angle * 0.75));
                let width = if inner - outer > 1e-6 { inner - outer } else { 1e-6 };
                Prepared::Spot {
                    position,
                    direction: direction(towards),
                    inverse_range: inverse(range),
                    outer,
                    inverse_width: 1.0 / width,
                }
            }
        };
        Self { color: light.color, kind, shadow: None }
    }

    /// The direction to the light and its strength at places.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, place: &Vector<S>) -> (Vector<S>, f32x8<S>) {
        let one = f32x8::splat(simd, 1.0);
        match &self.kind {
            Prepared::Directional(direction) => (each(simd, |i| f32x8::splat(simd, direction[i])), one),
            Prepared::Point { position, inverse_range } => towards(simd, place, position, *inverse_range),
            Prepared::Spot { position, direction, inverse_range, outer, inverse_width } => {
                let (way, strength) = towards(simd, place, position, *inverse_range);
                let axis: Vector<S> = each(simd, |i| f32x8::splat(simd, -direction[i]));
                let cone = (dot(&way, &axis) - *outer) * *inverse_width;
                let zero = f32x8::splat(simd, 0.0);
                let cone = cone.simd_gt(zero).select(cone, zero);
                let cone = cone.simd_lt(one).select(cone, one);
                (way, strength * cone)
            }
        }
    }

    /// The strength that shadows leave.
    #[inline(always)]
    pub(super) fn shadowed<S: Simd>(&self, place: &Vector<S>, strength: f32x8<S>, mask: u8) -> f32x8<S> {
        match &self.shadow {
            Some(map) => strength * map.light_at(place, mask),
            None => strength,
        }
    }
}

/// The direction to a position, and what its distance leaves of a light there.
#[inline(always)]
fn towards<S: Simd>(simd: S, place: &Vector<S>, position: &[f32; 3], inverse_range: f32) -> (Vector<S>, f32x8<S>) {
    let one = f32x8::splat(simd, 1.0);
    let way: Vector<S> = each(simd, |i| f32x8::splat(simd, position[i]) - place[i]);
    let fraction = dot(&way, &way) * (inverse_range * inverse_range);
    (normalized(way), one / (fraction + 1.0))
}

/// The shadow volumes of triangles for a light, as triangles in homogeneous world space: each triangle, the same pushed away from the light to
/// infinity (w = 0), and the sides between, wound so that the volume's outside is its front (counter-clockwise). `light` is (x, y, z, 1) for a
/// place and (x, y, z, 0) for a direction towards the light. Counting with z-fail, which needs depth clamping, gives stencil
/// values above 0 in shadow (Everitt and Kilgard, *Practical and robust stenciled shadow volumes*, 2002).
pub fn shadow_volumes(triangles: &[[[f32; 3]; 3]], light: [f32; 4]) -> Vec<[[f32; 4]; 3]> {
    let mut out = Vec::with_capacity(triangles.len() * 8);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|p| p.map(f64::from));
        let (u, v): ([f64; 3], [f64; 3]) = (std::array::from_fn(|i| b[i] - a[i]), std::array::from_fn(|i| c[i] - a[i]));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let towards: [f64; 3] = std::array::from_fn(|i| f64::from(light[i]) - a[i] * f64::from(light[3]));
        let facing = (0..3).map(|i| normal[i] * towards[i]).sum::<f64>();
        if facing == 0.0 || !facing.is_finite() {
            continue;
        }
        let mut near = triangle.map(|[x, y, z]| [x, y, z, 1.0]);
        if facing < 0.0 {
            // Seen from the light the front is outside: turn it round.
            near.swap(1, 2);
        }
        let far = near.map(|p| {
            let away: [f32; 3] = std::array::from_fn(|i| p[i] * light[3] - light[i]);
            [away[0], away[1], away[2], 0.0]
        });
        out.push(near);
        if light[3] != 0.0 {
            out.push([far[0], far[2], far[1]]);
        }
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            out.push([near[j], near[i], far[i]]);
            if light[3] != 0.0 {
                out.push([near[j], far[i], far[j]]);
            }
        }
    }
    out
}
