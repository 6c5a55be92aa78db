//! Shadow maps.
//!
//! Directional and spot lights have one depth image. Point lights have six, the faces of a cube around the light. A face covers 90° and, beyond,
//! as many texels as filtering reaches, so that no filter ends at a face's side. Faces are drawn with reversed depth n / z, which is a plane on the
//! screen and about as fine everywhere as a float; what is kept is z, the distance along the face's axis, so that a bias means the
//! same near by and far off.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x8};
use glam::Mat4;

use super::bounds::Aabb;
use super::model::{Light, LightKind, Mesh, MeshVertex, ShadowSettings, unit};
use super::render::{Item, SceneSettings};
use super::surface_shader::{Vector, to_integers};
use crate::error::{Error, Result};
use crate::num::lanes::each;
use crate::space::{
    ClipDepth, ClipPlane, ClipVertex, Compare, Depth, Pipeline, Primitives, Target, Topology, camera, clip_polygon,
    vertex_fn,
};

/// Depths as a light sees them.
pub(super) struct ShadowMap {
    view: View,
    /// Columns and rows, of a face for cubes.
    pub(super) side: u32,
    /// Rows top down; the faces of a cube one after the other.
    pub(super) depths: Vec<f32>,
    bias: f32,
    radius: i32,
}

enum View {
    /// From world space to the light's clip space.
    Flat(Mat4),
    /// Around a place. `scale` is the share of a face's half side that 45° take.
    Cube { position: [f32; 3], scale: f32 },
}

/// The matrix to the clip space of a light, such that a scene's box is inside; `None` for a light whose map is no single picture.
pub(super) fn flat_view(light: &Light, bounds: &Aabb) -> Option<Mat4> {
    if bounds.is_empty() {
        return None;
    }
    let up = |d: [f32; 3]| {
        if d[1].abs() < 0.9 * (d[0].abs() + d[1].abs() + d[2].abs()) { [0.0, 1.0, 0.0] } else { [1.0, 0.0, 0.0] }
    };
    match light.kind {
        LightKind::Directional(towards) => {
            let direction = unit(towards.map(f64::from))?;
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
            let direction = unit(direction.map(f64::from))?;
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

/// Where a place is in the clip space of a cube's face: along axis `face` / 2, upwards or (odd) downwards; the two axes that follow in the
/// cycle x, y, z are right and up.
fn on_face(way: [f32; 3], face: usize, scale: f32, near: f32) -> [f32; 4] {
    let axis = face / 2;
    let depth = if face.is_multiple_of(2) { way[axis] } else { -way[axis] };
    [way[(axis + 1) % 3] * scale, way[(axis + 2) % 3] * scale, near, depth]
}

/// A mesh's triangles on a face, as corners, clipped to the face's sides: all of them, so that neighbours stay watertight. The rasterizer's own
/// clipping leaves corners thousands of texels away where walls run past the light, and planes of depths through those are coarse.
fn clipped_triangles(corners: &[[f32; 4]], mesh: &Mesh) -> Vec<[f32; 4]> {
    let sides = &ClipPlane::VIEW_VOLUME[..4];
    let mut out = Vec::new();
    for triangle in mesh.triangles() {
        let [Some(a), Some(b), Some(c)] = triangle.map(|i| corners.get(i as usize).copied()) else { continue };
        let codes = [a, b, c].map(|[x, y, _, w]| [x < -w, x > w, y < -w, y > w]);
        if (0..4).any(|side| codes.iter().all(|code| code[side])) {
            continue;
        }
        if codes == [[false; 4]; 3] {
            out.extend([a, b, c]);
            continue;
        }
        let polygon = clip_polygon(&[a, b, c].map(|p| ClipVertex::new(p, &[])), sides);
        for pair in polygon.windows(2).skip(1) {
            out.extend([polygon[0].position, pair[0].position, pair[1].position]);
        }
    }
    out
}

/// The ways from a place to a mesh's vertices.
fn ways_to(item: &Item<'_>, position: [f32; 3]) -> Vec<[f32; 3]> {
    let way = |v: &MeshVertex| {
        let [x, y, z] = v.position;
        let world = camera::transform(&item.world, [x, y, z, 1.0]);
        std::array::from_fn(|i| world[i] - position[i])
    };
    item.mesh.vertices.iter().map(way).collect()
}

/// Draws the depths of meshes.
fn draw(pipeline: &Pipeline, target: &mut Target, to_clip: &Mat4, items: &[Item<'_>]) {
    for item in items {
        let m = camera::product(to_clip, &item.world);
        let vertex = vertex_fn(0, move |v: &MeshVertex, _: &mut [f32]| {
            let [x, y, z] = v.position;
            camera::transform(&m, [x, y, z, 1.0])
        });
        let mesh = item.mesh;
        let primitives = Primitives { vertices: &mesh.vertices, indices: Some(&mesh.indices), topology: mesh.topology };
        pipeline.draw_depth(target, &primitives, &vertex);
    }
}

impl ShadowMap {
    /// The map of a light in a scene; `None` for a light that cannot have one.
    ///
    /// # Errors
    /// [`Error::Limit`] where memory is not to be had.
    pub(super) fn new(
        shadows: &ShadowSettings,
        light: &Light,
        items: &[Item<'_>],
        bounds: &Aabb,
        settings: &SceneSettings,
    ) -> Result<Option<Self>> {
        if let LightKind::Point { position, .. } = light.kind {
            return Self::cube(shadows, position, items, bounds, settings);
        }
        let Some(to_light) = flat_view(light, bounds) else { return Ok(None) };
        Self::flat(shadows, to_light, items, settings).map(Some)
    }

    /// One picture.
    ///
    /// # Errors
    /// As [`ShadowMap::new`].
    pub(super) fn flat(
        shadows: &ShadowSettings,
        to_light: Mat4,
        items: &[Item<'_>],
        settings: &SceneSettings,
    ) -> Result<Self> {
        let side = shadows.resolution.clamp(16, 8192);
        let radius = shadows.radius.min(8);
        let mut target = Target::new(side, side)?;
        let mut pipeline = Pipeline::new(side, side).with_threads(settings.threads).with_level(settings.level);
        // Filtering compares with texels that lie farther off along the slope.
        let bias_slope = shadows.bias_slope * (1 + radius) as f32;
        pipeline.state.depth = Depth { bias_slope, clamp: true, ..Depth::default() };
        draw(&pipeline, &mut target, &to_light, items);
        let (view, depths) = (View::Flat(to_light), target.depths());
        Ok(Self { view, side, depths, bias: shadows.bias, radius: radius as i32 })
    }

    /// Six faces.
    fn cube(
        shadows: &ShadowSettings,
        position: [f32; 3],
        items: &[Item<'_>],
        bounds: &Aabb,
        settings: &SceneSettings,
    ) -> Result<Option<Self>> {
        let reach = bounds.corners().into_iter().flat_map(|corner| [0, 1, 2].map(|i| (corner[i] - position[i]).abs()));
        let far = reach.fold(0.0, |far, v| if v > far { v } else { far });
        if bounds.is_empty() || !(far > 0.0 && far.is_finite()) {
            return Ok(None);
        }
        let (resolution, radius) = (shadows.resolution.clamp(16, 4096), shadows.radius.min(8));
        let side = resolution + 2 * (radius + 1);
        let scale = resolution as f32 / side as f32;
        // What is nearer is taken to be there: depths are clamped.
        let near = far * 1e-4;
        let mut target = Target::new(side, side)?;
        let mut pipeline = Pipeline::new(side, side).with_threads(settings.threads).with_level(settings.level);
        pipeline.viewport.clip_depth = ClipDepth::ZeroToOne;
        // Depths fall with the distance, so that a bias away from the light is negative.
        let bias_slope = -shadows.bias_slope * (1 + radius) as f32;
        pipeline.state.depth = Depth { bias_slope, clamp: true, ..Depth::compare(Compare::Greater) };
        let texels = (side * side) as usize;
        let mut depths = Vec::new();
        depths
            .try_reserve_exact(6 * texels)
            .map_err(|_| Error::Limit(format!("no memory for a shadow map of 6 × {side} × {side}")))?;
        let ways: Vec<Vec<[f32; 3]>> = items.iter().map(|item| ways_to(item, position)).collect();
        for face in 0..6 {
            target.clear_depth(0.0);
            for (item, ways) in items.iter().zip(&ways) {
                let mesh = item.mesh;
                let corners: Vec<[f32; 4]> = ways.iter().map(|way| on_face(*way, face, scale, near)).collect();
                let vertex = vertex_fn(0, |corner: &[f32; 4], _: &mut [f32]| *corner);
                if matches!(mesh.topology, Topology::Triangles | Topology::TriangleStrip | Topology::TriangleFan) {
                    let clipped = clipped_triangles(&corners, mesh);
                    pipeline.draw_depth(&mut target, &Primitives::triangles(&clipped), &vertex);
                } else {
                    let indices = Some(&mesh.indices[..]);
                    let primitives = Primitives { vertices: &corners, indices, topology: mesh.topology };
                    pipeline.draw_depth(&mut target, &primitives, &vertex);
                }
            }
            depths.extend(target.depths().into_iter().map(|depth| near / depth));
        }
        let view = View::Cube { position, scale };
        Ok(Some(Self { view, side, depths, bias: shadows.bias * far, radius: radius as i32 }))
    }

    /// Where places are in the map.
    #[inline(always)]
    fn locate<S: Simd>(&self, place: &Vector<S>) -> Located<S> {
        let simd = place[0].simd;
        let one = f32x8::splat(simd, 1.0);
        let half = 0.5 * self.side as f32;
        match &self.view {
            View::Flat(to_light) => {
                let m = to_light.to_cols_array_2d();
                let row = |r: usize| place[0] * m[0][r] + place[1] * m[1][r] + place[2] * m[2][r] + m[3][r];
                let w = row(3);
                let inverse = one / w;
                let (x, y) = ((row(0) * inverse + 1.0) * half, (one - row(1) * inverse) * half);
                Located { x, y, depth: (row(2) * inverse + 1.0) * 0.5, w, face: [0; 8] }
            }
            View::Cube { position, scale } => {
                let zero = f32x8::splat(simd, 0.0);
                let way: Vector<S> = each(simd, |i| place[i] - position[i]);
                let length: Vector<S> = each(simd, |i| way[i].simd_lt(zero).select(-way[i], way[i]));
                let along_x = length[0].simd_ge(length[1]) & length[0].simd_ge(length[2]);
                let along_y = length[1].simd_ge(length[2]);
                let pick = |v: &Vector<S>, turn: usize| {
                    along_x.select(v[turn], along_y.select(v[(1 + turn) % 3], v[(2 + turn) % 3]))
                };
                let w = pick(&length, 0);
                let inverse = one / w;
                let (x, y) = (pick(&way, 1) * inverse * *scale, pick(&way, 2) * inverse * *scale);
                let (bits_x, bits_y) = (along_x.to_bitmask(), along_y.to_bitmask());
                let down = pick(&way, 0).simd_lt(zero).to_bitmask();
                let face = std::array::from_fn(|lane| {
                    let bit = |bits: u64| (bits >> lane & 1) as i32;
                    let axis = if bit(bits_x) == 1 { 0 } else { 2 - bit(bits_y) };
                    axis * 2 + bit(down)
                });
                Located { x: (x + 1.0) * half, y: (one - y) * half, depth: w, w, face }
            }
        }
    }

    /// How much of the light reaches places: percentage-closer filtering (Reeves, Salesin and Cook, *Rendering antialiased shadows
    /// with depth maps*, 1987). Places outside of the map are lit.
    #[inline(always)]
    pub(super) fn light_at<S: Simd>(&self, place: &Vector<S>, mask: u8) -> f32x8<S> {
        let simd = place[0].simd;
        let located = self.locate(place);
        let x = to_integers(located.x.floor()).to_array();
        let y = to_integers(located.y.floor()).to_array();
        let depth = (located.depth - self.bias).to_array();
        let w = located.w.to_array();
        let radius = self.radius;
        let taps = ((2 * radius + 1) * (2 * radius + 1)) as f32;
        let side = self.side as i32;
        let mut out = [1.0_f32; 8];
        for lane in (0..8).filter(|lane| mask >> lane & 1 == 1 && w[*lane] > 0.0) {
            let first = located.face[lane] as usize * (side * side) as usize;
            let mut lit = 0_u32;
            for dy in -radius..=radius {
                for dx in -radius..=radius {
                    let (x, y) = (x[lane].saturating_add(dx), y[lane].saturating_add(dy));
                    let inside = x >= 0 && y >= 0 && x < side && y < side;
                    let stored = if inside { self.depths.get(first + (y * side + x) as usize).copied() } else { None };
                    lit += u32::from(stored.is_none_or(|stored| depth[lane] <= stored));
                }
            }
            out[lane] = lit as f32 / taps;
        }
        f32x8::load_array(simd, out)
    }
}

/// Where places are in a map.
struct Located<S: Simd> {
    /// In texels, rows down.
    x: f32x8<S>,
    y: f32x8<S>,
    depth: f32x8<S>,
    /// Above 0 in front of the light.
    w: f32x8<S>,
    face: [i32; 8],
}
