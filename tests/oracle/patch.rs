//! Curved surfaces: bicubic Bézier patches and the triangles that stand for them.

/// A point in space.
pub(crate) type Point3 = [f64; 3];

/// Sixteen control points: four rows along v, four points along u in each.
pub(crate) type Patch = [[Point3; 4]; 4];

/// What `a` and `b` make of each coordinate of two points.
fn with(a: Point3, b: Point3, f: impl Fn(f64, f64) -> f64) -> Point3 {
    [0, 1, 2].map(|i| f(a[i], b[i]))
}

pub(crate) fn length(v: Point3) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// The point of a cubic at `t`, by de Casteljau's steps.
fn along([a, b, c, d]: [Point3; 4], t: f64) -> Point3 {
    let mix = |a, b| with(a, b, |a, b| a * (1.0 - t) + b * t);
    let (ab, bc, cd) = (mix(a, b), mix(b, c), mix(c, d));
    mix(mix(ab, bc), mix(bc, cd))
}

/// The patch's point at (u, v).
pub(crate) fn at(patch: &Patch, u: f64, v: f64) -> Point3 {
    along(patch.map(|row| along(row, u)), v)
}

/// How many pieces each side needs for triangles no farther than `tolerance` from the surface: an eighth of
/// the largest second derivatives bounds the distance of a triangle whose sides are 1 in u and v (Filip,
/// Magedson and Markot, *Surface algorithms using bounds on derivatives*, 1986).
pub(crate) fn pieces(patch: &Patch, tolerance: f64) -> usize {
    let bend = |a, b, c| length(with(with(a, b, |a, b| a - 2.0 * b), c, |ab, c| ab + c)) * 6.0;
    let most = |lines: &Patch| {
        lines.iter().flat_map(|line| line.windows(3)).map(|w| bend(w[0], w[1], w[2])).fold(0.0, f64::max)
    };
    let (uu, vv) = (most(patch), most(&[0, 1, 2, 3].map(|i| patch.map(|row| row[i]))));
    let mut uv = 0.0_f64;
    for rows in patch.windows(2) {
        for (here, there) in rows[0].windows(2).zip(rows[1].windows(2)) {
            let (step, other) = (with(here[1], here[0], |a, b| a - b), with(there[1], there[0], |a, b| a - b));
            uv = uv.max(length(with(other, step, |a, b| a - b)) * 9.0);
        }
    }
    ((uu + 2.0 * uv + vv) / (8.0 * tolerance)).sqrt().ceil().max(1.0) as usize
}

/// The corners of the triangles in u and v: squares of side 1/n, each cut along its diagonal.
pub(crate) fn triangles(n: usize) -> impl Iterator<Item = [(f64, f64); 3]> {
    let at = move |i: usize| i as f64 / n as f64;
    (0..n).flat_map(move |j| (0..n).map(move |i| (i, j))).flat_map(move |(i, j)| {
        let (a, b) = ((at(i), at(j)), (at(i + 1), at(j)));
        let (c, d) = ((at(i + 1), at(j + 1)), (at(i), at(j + 1)));
        [[a, b, c], [a, c, d]]
    })
}
