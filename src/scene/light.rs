//! Lights ready for shading, and their shadow maps.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::Mat4;

use super::bounds::Aabb;
use super::model::{Light, LightKind, ShadowSettings};
use super::surface_shader::{Vector, dot, normalized, to_integers};
use crate::num::trig;
use crate::space::camera;

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

/// Depths as a light sees them.
pub(super) struct ShadowMap {
    /// From world space to the light's clip space.
    pub(super) to_light: Mat4,
    pub(super) side: u32,
    pub(super) depths: Vec<f32>,
    pub(super) settings: ShadowSettings,
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
        let towards = |position: &[f32; 3], inverse_range: f32| {
            let way: Vector<S> = std::array::from_fn(|i| f32x8::splat(simd, position[i]) - place[i]);
            let fraction = dot(&way, &way) * (inverse_range * inverse_range);
            (normalized(way), one / (fraction + 1.0))
        };
        match &self.kind {
            Prepared::Directional(direction) => (direction.map(|v| f32x8::splat(simd, v)), one),
            Prepared::Point { position, inverse_range } => towards(position, *inverse_range),
            Prepared::Spot { position, direction, inverse_range, outer, inverse_width } => {
                let (way, strength) = towards(position, *inverse_range);
                let axis = direction.map(|v| f32x8::splat(simd, -v));
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

impl ShadowMap {
    /// The matrix to the clip space of a light, such that a scene's box is inside; `None` for a light that cannot have a map.
    pub(super) fn matrix(light: &Light, bounds: &Aabb) -> Option<Mat4> {
        if bounds.is_empty() {
            return None;
        }
        let up = |d: [f32; 3]| {
            if d[1].abs() < 0.9 * (d[0].abs() + d[1].abs() + d[2].abs()) { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] }
        };
        match light.kind {
            LightKind::Directional(towards) => {
                let direction = super::model::unit(towards.map(f64::from))?;
                let (center, radius) = (bounds.center(), bounds.radius().max(1e-6) * 1.001);
                let eye = std::array::from_fn(|i| center[i] + direction[i] * radius * 2.0);
                let view = camera::look_at(eye, center, up(direction));
                // As tight around the box as the light's axes allow.
                let seen = bounds.transformed(&view);
                let margin = radius * 0.002;
                let projection = camera::orthographic(
                    seen.min[0] - margin,
                    seen.max[0] + margin,
                    seen.min[1] - margin,
                    seen.max[1] + margin,
                    -seen.max[2] - margin,
                    -seen.min[2] + margin,
                );
                Some(camera::product(&projection, &view))
            }
            LightKind::Spot { position, direction, angle, .. } => {
                let direction = super::model::unit(direction.map(f64::from))?;
                let at = std::array::from_fn(|i| position[i] + direction[i]);
                let view = camera::look_at(position, at, up(direction));
                let seen = bounds.transformed(&view);
                let far = (-seen.min[2]).max(1e-3) * 1.001;
                let near = (-seen.max[2] * 0.999).max(far * 1e-3);
                let fov = (angle * 2.02).clamp(0.01, 3.1);
                Some(camera::product(&camera::perspective(fov, 1.0, near, far), &view))
            }
            LightKind::Point { .. } => None,
        }
    }

    /// How much of the light reaches places: percentage-closer filtering (Reeves, Salesin and Cook, *Rendering antialiased shadows
    /// with depth maps*, 1987). Places outside of the map are lit.
    #[inline(always)]
    fn light_at<S: Simd>(&self, place: &Vector<S>, mask: u8) -> f32x8<S> {
        let simd = place[0].simd;
        let m = self.to_light.to_cols_array_2d();
        let row = |r: usize| place[0] * m[0][r] + place[1] * m[1][r] + place[2] * m[2][r] + m[3][r];
        let w = row(3);
        let inverse = f32x8::splat(simd, 1.0) / w;
        let side = self.side as f32;
        let x = to_integers(((row(0) * inverse + 1.0) * (0.5 * side)).floor()).to_array();
        let y = to_integers(((f32x8::splat(simd, 1.0) - row(1) * inverse) * (0.5 * side)).floor()).to_array();
        let depth = ((row(2) * inverse + 1.0) * 0.5 - self.settings.bias).to_array();
        let w = w.to_array();
        let radius = self.settings.radius.min(8) as i32;
        let taps = ((2 * radius + 1) * (2 * radius + 1)) as f32;
        let side = self.side as i32;
        let mut out = [1.0_f32; 8];
        for lane in (0..8).filter(|lane| mask >> lane & 1 == 1 && w[*lane] > 0.0) {
            let mut lit = 0_u32;
            for dy in -radius..=radius {
                for dx in -radius..=radius {
                    let (x, y) = (x[lane].saturating_add(dx), y[lane].saturating_add(dy));
                    let inside = x >= 0 && y >= 0 && x < side && y < side;
                    let stored = if inside { self.depths.get((y * side + x) as usize).copied() } else { None };
                    lit += u32::from(stored.is_none_or(|stored| depth[lane] <= stored));
                }
            }
            out[lane] = lit as f32 / taps;
        }
        f32x8::load_array(simd, out)
    }
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
