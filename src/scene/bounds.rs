//! Boxes, and the view frustum as planes.

use glam::Mat4;

use crate::space::camera::transform;

/// An axis-aligned box; empty where some minimum exceeds its maximum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The smallest coordinates.
    pub min: [f32; 3],
    /// The largest coordinates.
    pub max: [f32; 3],
}

impl Aabb {
    /// The box of nothing.
    pub const EMPTY: Self = Self { min: [f32::INFINITY; 3], max: [f32::NEG_INFINITY; 3] };

    /// The box of some points; those with a coordinate that is not finite are left out.
    pub fn of_points(points: impl IntoIterator<Item = [f32; 3]>) -> Self {
        let mut bounds = Self::EMPTY;
        for p in points {
            if p.iter().all(|v| v.is_finite()) {
                for i in 0..3 {
                    bounds.min[i] = bounds.min[i].min(p[i]);
                    bounds.max[i] = bounds.max[i].max(p[i]);
                }
            }
        }
        bounds
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        (0..3).any(|i| !(self.min[i] <= self.max[i]))
    }

    /// The box of both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: std::array::from_fn(|i| self.min[i].min(other.min[i])),
            max: std::array::from_fn(|i| self.max[i].max(other.max[i])),
        }
    }

    /// Whether `other` lies inside, sides included.
    pub fn contains(&self, other: &Self) -> bool {
        (0..3).all(|i| self.min[i] <= other.min[i] && other.max[i] <= self.max[i])
    }

    /// Whether the boxes meet, sides included.
    pub fn meets(&self, other: &Self) -> bool {
        (0..3).all(|i| self.min[i] <= other.max[i] && other.min[i] <= self.max[i])
    }

    /// The middle; the origin for an empty box.
    pub fn center(&self) -> [f32; 3] {
        if self.is_empty() { [0.0; 3] } else { std::array::from_fn(|i| self.min[i] * 0.5 + self.max[i] * 0.5) }
    }

    /// Half of the diagonal; 0 for an empty box.
    pub fn radius(&self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        // In double precision squares of 1e30 are numbers.
        let d: [f64; 3] = std::array::from_fn(|i| 0.5 * (f64::from(self.max[i]) - f64::from(self.min[i])));
        (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() as f32
    }

    /// The eight corners.
    pub fn corners(&self) -> [[f32; 3]; 8] {
        std::array::from_fn(|c| std::array::from_fn(|i| if c >> i & 1 == 0 { self.min[i] } else { self.max[i] }))
    }

    /// The box of the corners after a transform; empty stays empty.
    #[must_use]
    pub fn transformed(&self, by: &Mat4) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        Self::of_points(self.corners().map(|[x, y, z]| {
            let [x, y, z, _] = transform(by, [x, y, z, 1.0]);
            [x, y, z]
        }))
    }
}

/// The six planes of a view volume, in the space that its matrix takes to clip space.
///
/// Gribb and Hartmann, *Fast extraction of viewing frustum planes*, 2001: sums and differences of the matrix' rows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frustum {
    /// a·x + b·y + c·z + d ≥ 0 inside: left, right, bottom, top, near, far.
    pub planes: [[f32; 4]; 6],
}

impl Frustum {
    /// The view volume of a matrix to clip space with −w ≤ z ≤ w.
    pub fn new(to_clip: &Mat4) -> Self {
        let m = to_clip.to_cols_array_2d();
        let row = |i: usize| m.map(|column| column[i]);
        let with = |i: usize, sign: f32| {
            let (a, w) = (row(i), row(3));
            std::array::from_fn(|k| w[k] + sign * a[k])
        };
        Self { planes: [with(0, 1.0), with(0, -1.0), with(1, 1.0), with(1, -1.0), with(2, 1.0), with(2, -1.0)] }
    }

    /// Whether a box may be visible. False only if it lies wholly outside of one plane: a box near a corner of the frustum may
    /// be taken for visible though it is not.
    pub fn meets(&self, bounds: &Aabb) -> bool {
        !bounds.is_empty()
            && self.planes.iter().all(|[a, b, c, d]| {
                // The corner that is farthest inside, in double precision, with a little to spare.
                let pick =
                    |n: f32, i: usize| f64::from(n) * f64::from(if n > 0.0 { bounds.max[i] } else { bounds.min[i] });
                let terms = [pick(*a, 0), pick(*b, 1), pick(*c, 2), f64::from(*d)];
                let scale: f64 = terms.iter().map(|t| t.abs()).sum();
                !(terms.iter().sum::<f64>() < -1e-6 * scale)
            })
    }
}
