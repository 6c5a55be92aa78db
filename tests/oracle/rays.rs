//! Ray casting, the other way to see: image order instead of object order.

/// A point or direction in space.
pub(crate) type V3 = [f64; 3];

pub(crate) fn sub(a: V3, b: V3) -> V3 {
    [0, 1, 2].map(|i| a[i] - b[i])
}

pub(crate) fn dot(a: V3, b: V3) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: V3, b: V3) -> V3 {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn normalize(v: V3) -> V3 {
    let length = dot(v, v).sqrt();
    v.map(|v| v / length)
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// Along the ray, in lengths of its direction.
    pub(crate) t: f64,
    /// The weights of the second and third corner.
    pub(crate) u: f64,
    pub(crate) v: f64,
}

impl Hit {
    /// How far the hit is from the triangle's sides, as the smallest weight.
    pub(crate) fn margin(&self) -> f64 {
        self.u.min(self.v).min(1.0 - self.u - self.v)
    }
}

/// The ray origin + t·direction against a triangle, both sides, t > 0 (Möller and Trumbore, 1997); also beside the triangle, where
/// the margin is negative.
pub(crate) fn meet(origin: V3, direction: V3, [a, b, c]: [V3; 3]) -> Option<Hit> {
    let (e1, e2) = (sub(b, a), sub(c, a));
    let p = cross(direction, e2);
    let det = dot(e1, p);
    if det.abs() < 1e-14 {
        return None;
    }
    let s = sub(origin, a);
    let q = cross(s, e1);
    let hit = Hit { t: dot(e2, q) / det, u: dot(s, p) / det, v: dot(direction, q) / det };
    (hit.t > 0.0).then_some(hit)
}

/// The direction, with z = −1, through the centre of a pixel of a camera at the origin that looks along −z.
pub(crate) fn through(x: u32, y: u32, (width, height): (u32, u32), tan_half: f64) -> V3 {
    let ndc_x = (f64::from(x) + 0.5) / f64::from(width) * 2.0 - 1.0;
    let ndc_y = 1.0 - (f64::from(y) + 0.5) / f64::from(height) * 2.0;
    [ndc_x * tan_half * f64::from(width) / f64::from(height), ndc_y * tan_half, -1.0]
}

/// The nearest triangle along a ray, and its hit; `None` also where the ray comes closer than `margin` to some side of any triangle, in weights,
/// so that rounding may decide.
pub(crate) fn nearest(origin: V3, direction: V3, triangles: &[[V3; 3]], margin: f64) -> Option<Option<(usize, Hit)>> {
    let mut best: Option<(usize, Hit)> = None;
    for (i, triangle) in triangles.iter().enumerate() {
        let Some(hit) = meet(origin, direction, *triangle) else { continue };
        if hit.margin().abs() < margin {
            return None;
        }
        if hit.margin() > 0.0 && best.is_none_or(|(_, other)| hit.t < other.t) {
            best = Some((i, hit));
        }
    }
    Some(best)
}
