//! Homogeneous clipping: polygons in clip space against planes through the origin of four dimensions.
//!
//! Sutherland and Hodgman, *Reentrant polygon clipping*, 1974, with the intersections of Blinn and Newell, *Clipping
//! using homogeneous coordinates*, 1978. An intersection is always reckoned from the inner vertex to the outer one, so that two
//! triangles that share an edge get the same point whichever way round they list it: meshes stay watertight.

use super::vertex::MAX_VARYINGS;

/// A vertex in clip space with its varyings; those not in use are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipVertex {
    /// x, y, z, w.
    pub position: [f32; 4],
    /// The values to be interpolated.
    pub varyings: [f32; MAX_VARYINGS],
}

impl ClipVertex {
    /// A vertex whose first varyings are given; more than 16 are cut off.
    pub fn new(position: [f32; 4], varyings: &[f32]) -> Self {
        let mut vertex = Self { position, varyings: [0.0; MAX_VARYINGS] };
        for (to, from) in vertex.varyings.iter_mut().zip(varyings) {
            *to = *from;
        }
        vertex
    }

    /// The point at `t` on the way to `other`, in double precision.
    fn lerp(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f32, b: f32| (f64::from(a) + (f64::from(b) - f64::from(a)) * t) as f32;
        Self {
            position: std::array::from_fn(|i| mix(self.position[i], other.position[i])),
            varyings: std::array::from_fn(|i| mix(self.varyings[i], other.varyings[i])),
        }
    }
}

/// A half-space of clip space: a·x + b·y + c·z + d·w ≥ 0 is inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClipPlane(pub [f32; 4]);

impl ClipPlane {
    /// The six planes of the OpenGL view volume: left, right, bottom, top, near, far.
    pub const VIEW_VOLUME: [Self; 6] = [
        Self([1.0, 0.0, 0.0, 1.0]),
        Self([-1.0, 0.0, 0.0, 1.0]),
        Self([0.0, 1.0, 0.0, 1.0]),
        Self([0.0, -1.0, 0.0, 1.0]),
        Self([0.0, 0.0, 1.0, 1.0]),
        Self([0.0, 0.0, -1.0, 1.0]),
    ];

    /// The signed distance, up to the plane's scale: not negative inside. NaN for what is not a number.
    pub fn distance(&self, position: [f32; 4]) -> f64 {
        let term = |i: usize| f64::from(self.0[i]) * f64::from(position[i]);
        term(0) + term(1) + term(2) + term(3)
    }
}

/// The part of a convex polygon inside all planes: empty, or at least three vertices in the same order.
///
/// A vertex exactly on a plane is inside. A polygon with a vertex that is not a number has no inside.
pub fn clip_polygon(polygon: &[ClipVertex], planes: &[ClipPlane]) -> Vec<ClipVertex> {
    let finite = |v: &ClipVertex| v.position.iter().all(|p| p.is_finite());
    if !polygon.iter().all(finite) {
        return Vec::new();
    }
    let mut current = polygon.to_vec();
    let mut next = Vec::with_capacity(polygon.len() + planes.len());
    for plane in planes {
        next.clear();
        for (a, b) in current.iter().zip(current.iter().cycle().skip(1)) {
            let (da, db) = (plane.distance(a.position), plane.distance(b.position));
            if da >= 0.0 {
                next.push(*a);
                if db < 0.0 && da > 0.0 {
                    next.push(a.lerp(b, da / (da - db)));
                }
            } else if db > 0.0 {
                next.push(b.lerp(a, db / (db - da)));
            }
        }
        std::mem::swap(&mut current, &mut next);
        if current.len() < 3 {
            return Vec::new();
        }
    }
    current
}

/// Clips a triangle to the OpenGL view volume: the lecture's four cases for each plane (in; out; one vertex in gives one
/// triangle; two in give a quadrilateral, two triangles as a fan).
pub fn clip_triangle(triangle: [ClipVertex; 3]) -> Vec<ClipVertex> {
    clip_polygon(&triangle, &ClipPlane::VIEW_VOLUME)
}

/// Clips a segment to the planes, or `None` where nothing is inside.
pub fn clip_segment(a: ClipVertex, b: ClipVertex, planes: &[ClipPlane]) -> Option<(ClipVertex, ClipVertex)> {
    let (mut start, mut end) = (a, b);
    if !a.position.iter().chain(&b.position).all(|p| p.is_finite()) {
        return None;
    }
    for plane in planes {
        let (ds, de) = (plane.distance(start.position), plane.distance(end.position));
        match (ds >= 0.0, de >= 0.0) {
            (true, true) => {}
            (false, false) => return None,
            (true, false) => end = start.lerp(&end, ds / (ds - de)),
            (false, true) => start = end.lerp(&start, de / (de - ds)),
        }
    }
    Some((start, end))
}

/// Which of the planes a position is outside of, one bit each; all bits for what is not a number.
pub(crate) fn outcode(position: [f32; 4], planes: &[ClipPlane]) -> u32 {
    planes.iter().enumerate().fold(0, |code, (i, plane)| {
        let inside = plane.distance(position) >= 0.0;
        code | u32::from(!inside) << i
    })
}
