//! Matrices of the camera: column-major, for column vectors, right-handed view space that looks along −z.
//!
//! Entries are reckoned in double precision and rounded once; products are spelled out term by term, so that they are the same
//! on every machine.

use glam::Mat4;

use crate::num::trig;

/// `m` · `v`, term by term: ((m₀·x + m₁·y) + m₂·z) + m₃·w for each row.
#[inline(always)]
pub fn transform(m: &Mat4, [x, y, z, w]: [f32; 4]) -> [f32; 4] {
    let [a, b, c, d] = m.to_cols_array_2d();
    std::array::from_fn(|i| ((a[i] * x + b[i] * y) + c[i] * z) + d[i] * w)
}

/// The product `a` · `b`, which applies `b` first, term by term.
pub fn product(a: &Mat4, b: &Mat4) -> Mat4 {
    Mat4::from_cols_array_2d(&b.to_cols_array_2d().map(|column| transform(a, column)))
}

/// A matrix from rows, for entries in the order in which books print them.
fn rows(rows: [[f64; 4]; 4]) -> Mat4 {
    Mat4::from_cols_array_2d(&std::array::from_fn(|c| std::array::from_fn(|r| rows[r][c] as f32)))
}

/// The perspective projection of the view frustum whose near rectangle is left ..= right × bottom ..= top at distance `near`: distance
/// `near` maps to z / w = −1, `far` to 1, and w is the distance along the view axis (−z).
///
/// 2n/(r−l), 0, (r+l)/(r−l), 0; 0, 2n/(t−b), (t+b)/(t−b), 0; 0, 0, −(f+n)/(f−n), −2fn/(f−n); 0, 0, −1, 0
pub fn frustum(left: f32, right: f32, bottom: f32, top: f32, near: f32, far: f32) -> Mat4 {
    let [l, r, b, t, n, f] = [left, right, bottom, top, near, far].map(f64::from);
    rows([
        [2.0 * n / (r - l), 0.0, (r + l) / (r - l), 0.0],
        [0.0, 2.0 * n / (t - b), (t + b) / (t - b), 0.0],
        [0.0, 0.0, -(f + n) / (f - n), -2.0 * f * n / (f - n)],
        [0.0, 0.0, -1.0, 0.0],
    ])
}

/// The perspective projection of a symmetric frustum: `fov_y` is the vertical field of view in radians, `aspect` width / height.
pub fn perspective(fov_y: f32, aspect: f32, near: f32, far: f32) -> Mat4 {
    let scale = 1.0 / trig::tan(f64::from(fov_y) / 2.0);
    let [aspect, n, f] = [aspect, near, far].map(f64::from);
    rows([
        [scale / aspect, 0.0, 0.0, 0.0],
        [0.0, scale, 0.0, 0.0],
        [0.0, 0.0, (f + n) / (n - f), 2.0 * f * n / (n - f)],
        [0.0, 0.0, -1.0, 0.0],
    ])
}

/// The same with reversed depth: `near` maps to z / w = 1, infinitely far to 0, for
/// [`ClipDepth::ZeroToOne`](super::ClipDepth::ZeroToOne), a depth cleared to 0 and [`Compare::Greater`](super::Compare::Greater). Float
/// depths are then about as fine everywhere: their steps shrink towards 0 as fast as the projection crowds depths there.
pub fn perspective_reversed(fov_y: f32, aspect: f32, near: f32) -> Mat4 {
    let scale = 1.0 / trig::tan(f64::from(fov_y) / 2.0);
    let [aspect, n] = [aspect, near].map(f64::from);
    rows([[scale / aspect, 0.0, 0.0, 0.0], [0.0, scale, 0.0, 0.0], [0.0, 0.0, 0.0, n], [0.0, 0.0, -1.0, 0.0]])
}

/// The parallel projection of a box: distances `near` ..= `far` along −z map to −1 ..= 1, w is 1.
pub fn orthographic(left: f32, right: f32, bottom: f32, top: f32, near: f32, far: f32) -> Mat4 {
    let [l, r, b, t, n, f] = [left, right, bottom, top, near, far].map(f64::from);
    rows([
        [2.0 / (r - l), 0.0, 0.0, -(r + l) / (r - l)],
        [0.0, 2.0 / (t - b), 0.0, -(t + b) / (t - b)],
        [0.0, 0.0, -2.0 / (f - n), -(f + n) / (f - n)],
        [0.0, 0.0, 0.0, 1.0],
    ])
}

fn subtract(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] - b[i])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn normalized(v: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(v, v).sqrt();
    (length > 1e-30 && length.is_finite()).then(|| v.map(|v| v / length))
}

/// The view matrix V⁻¹ of a camera at `eye` that looks towards `at` with `up` upwards. Where `up` is along the view axis another
/// direction is taken for it; where `eye` is `at` the camera looks along −z.
pub fn look_at(eye: [f32; 3], at: [f32; 3], up: [f32; 3]) -> Mat4 {
    let [eye, at, up] = [eye, at, up].map(|v| v.map(f64::from));
    let forward = normalized(subtract(at, eye)).unwrap_or([0.0, 0.0, -1.0]);
    let right = normalized(cross(forward, up))
        .filter(|right| dot(*right, *right).is_finite())
        .or_else(|| normalized(cross(forward, if forward[1].abs() < 0.9 { [0.0, 1.0, 0.0] } else { [0.0, 0.0, 1.0] })))
        .unwrap_or([1.0, 0.0, 0.0]);
    let up = cross(right, forward);
    rows([
        [right[0], right[1], right[2], -dot(right, eye)],
        [up[0], up[1], up[2], -dot(up, eye)],
        [-forward[0], -forward[1], -forward[2], dot(forward, eye)],
        [0.0, 0.0, 0.0, 1.0],
    ])
}

/// A translation.
pub fn translation([x, y, z]: [f32; 3]) -> Mat4 {
    let [x, y, z] = [x, y, z].map(f64::from);
    rows([[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z], [0.0, 0.0, 0.0, 1.0]])
}

/// A scale along the axes.
pub fn scale([x, y, z]: [f32; 3]) -> Mat4 {
    let [x, y, z] = [x, y, z].map(f64::from);
    rows([[x, 0.0, 0.0, 0.0], [0.0, y, 0.0, 0.0], [0.0, 0.0, z, 0.0], [0.0, 0.0, 0.0, 1.0]])
}

/// A rotation by `angle` radians about an axis through the origin, counter-clockwise as seen against the axis (Rodrigues). The identity
/// for an axis without length.
pub fn rotation(axis: [f32; 3], angle: f32) -> Mat4 {
    let Some([x, y, z]) = normalized(axis.map(f64::from)) else { return Mat4::IDENTITY };
    let (s, c) = trig::sin_cos(f64::from(angle));
    let t = 1.0 - c;
    rows([
        [t * x * x + c, t * x * y - s * z, t * x * z + s * y, 0.0],
        [t * x * y + s * z, t * y * y + c, t * y * z - s * x, 0.0],
        [t * x * z - s * y, t * y * z + s * x, t * z * z + c, 0.0],
        [0.0, 0.0, 0.0, 1.0],
    ])
}

/// The inverse, by cofactors in double precision; `None` for a matrix without one.
pub fn inverse(m: &Mat4) -> Option<Mat4> {
    let m = m.to_cols_array_2d().map(|column| column.map(f64::from));
    // Gauss and Jordan with the largest pivot.
    let mut a: [[f64; 8]; 4] =
        std::array::from_fn(|r| std::array::from_fn(|c| if c < 4 { m[c][r] } else { f64::from(u8::from(c - 4 == r)) }));
    for column in 0..4 {
        let pivot = (column..4).max_by(|i, j| a[*i][column].abs().total_cmp(&a[*j][column].abs()))?;
        a.swap(column, pivot);
        let divisor = a[column][column];
        if !(divisor.abs() > 1e-300 && divisor.is_finite()) {
            return None;
        }
        a[column] = a[column].map(|v| v / divisor);
        for row in 0..4 {
            if row != column {
                let factor = a[row][column];
                let pivot = a[column];
                for (value, pivot) in a[row].iter_mut().zip(pivot) {
                    *value -= factor * pivot;
                }
            }
        }
    }
    Some(rows(a.map(|row| [row[4], row[5], row[6], row[7]])))
}

/// The matrix for normals: the cofactors of the upper left 3 × 3, which is its inverse transposed up to a positive or negative
/// scale; columns. Right also where the matrix is singular.
pub fn normal_matrix(m: &Mat4) -> [[f32; 3]; 3] {
    let c = m.to_cols_array_2d().map(|column| [column[0], column[1], column[2]].map(f64::from));
    let cofactors = [cross(c[1], c[2]), cross(c[2], c[0]), cross(c[0], c[1])];
    // A mirrored matrix turns the cofactors round.
    let sign = if dot(c[0], cofactors[0]) < 0.0 { -1.0 } else { 1.0 };
    cofactors.map(|column| column.map(|v| (v * sign) as f32))
}
