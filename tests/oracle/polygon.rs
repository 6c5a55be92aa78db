//! The lectures' ways to fill a polygon, and the definition that judges them all.
//!
//! Vertices are in 1/256 of a pixel; the centre of pixel (x, y) lies at (256·x + 128, 256·y + 128). A
//! centre on an edge belongs to the side right of it, or below it if the edge is level.

use std::collections::BTreeSet;

use rastrum::{FillRule, Point};

use super::Pixel;

/// A vertex in 1/256 pixels.
pub(crate) type Vertex = (i64, i64);

/// A vertex as the library takes it, without loss for coordinates below 2^16 pixels.
pub(crate) fn to_point((x, y): Vertex) -> Point {
    Point::new(x as f32 / 256.0, y as f32 / 256.0)
}

/// The pixel's centre.
fn center((x, y): Pixel) -> Vertex {
    (i64::from(x) * 256 + 128, i64::from(y) * 256 + 128)
}

/// The edges of a closed contour.
fn edges(contour: &[Vertex]) -> impl Iterator<Item = (Vertex, Vertex)> {
    contour.iter().copied().zip(contour.iter().copied().cycle().skip(1))
}

/// The winding of an edge around a point, as a ray to the left meets it: 0 if it passes above or below,
/// or to the right of the point.
fn crossing((a, b): (Vertex, Vertex), p: Vertex) -> i32 {
    let (upper, lower, winding) = if a.1 < b.1 { (a, b, 1) } else { (b, a, -1) };
    if p.1 < upper.1 || p.1 >= lower.1 {
        return 0;
    }
    let side = (lower.0 - upper.0) * (p.1 - upper.1) - (p.0 - upper.0) * (lower.1 - upper.1);
    if side <= 0 { winding } else { 0 }
}

/// Whether the pixel's centre is inside: count the edges to its left.
pub(crate) fn inside(contours: &[&[Vertex]], rule: FillRule, pixel: Pixel) -> bool {
    let crossings = contours.iter().flat_map(|contour| edges(contour)).map(|edge| crossing(edge, center(pixel)));
    match rule {
        FillRule::NonZero => crossings.sum::<i32>() != 0,
        FillRule::EvenOdd => crossings.filter(|&winding| winding != 0).count() % 2 == 1,
    }
}

/// All pixels of a square grid from (0, 0).
pub(crate) fn grid(size: i32) -> impl Iterator<Item = Pixel> {
    (0..size).flat_map(move |y| (0..size).map(move |x| (x, y)))
}

/// Edge-flip: every edge inverts all pixels to its right.
pub(crate) fn edge_flip(contour: &[Vertex], size: i32) -> BTreeSet<Pixel> {
    let mut set = BTreeSet::new();
    for edge in edges(contour) {
        for pixel in grid(size).filter(|&pixel| crossing(edge, center(pixel)) != 0) {
            if !set.remove(&pixel) {
                set.insert(pixel);
            }
        }
    }
    set
}

/// A triangle by its three edge functions, with the top-left rule: a centre on a top or a left edge
/// is in.
pub(crate) fn edge_functions(triangle: [Vertex; 3], size: i32) -> BTreeSet<Pixel> {
    let [a, b, c] = triangle;
    let function = |a: Vertex, b: Vertex, p: Vertex| (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0);
    let area = function(a, b, c);
    if area == 0 {
        return BTreeSet::new();
    }
    // Clockwise on the canvas, where y points down: the inside is on the positive side of every edge.
    let (b, c) = if area > 0 { (b, c) } else { (c, b) };
    grid(size)
        .filter(|&pixel| {
            [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| {
                let top_left = to.1 < from.1 || (to.1 == from.1 && to.0 > from.0);
                let value = function(from, to, center(pixel));
                value > 0 || (value == 0 && top_left)
            })
        })
        .collect()
}

/// A number as a fraction with a positive denominator.
#[derive(Clone, Copy)]
struct Fraction(i128, i128);

impl Fraction {
    fn less(self, other: Self) -> bool {
        self.0 * other.1 < other.0 * self.1
    }
}

impl From<i64> for Fraction {
    fn from(v: i64) -> Self {
        Self(i128::from(v), 1)
    }
}

/// Where an edge that is not level crosses the height `y`.
fn x_at(a: (Fraction, i64), b: (Fraction, i64), y: i64) -> Fraction {
    let (Fraction(an, ad), Fraction(bn, bd)) = (a.0, b.0);
    let (dy, down) = (i128::from(b.1 - a.1), i128::from(y - a.1));
    // a + (b − a)·down/dy over the common denominator
    let (numerator, denominator) = (an * bd * (dy - down) + bn * ad * down, ad * bd * dy);
    if denominator < 0 { Fraction(-numerator, -denominator) } else { Fraction(numerator, denominator) }
}

/// Fills a row from `left`, the first centre not left of it, up to `right`.
fn fill_row(set: &mut BTreeSet<Pixel>, y: i32, left: Fraction, right: Fraction, size: i32) {
    for x in 0..size {
        let p = Fraction::from(center((x, y)).0);
        if !p.less(left) && p.less(right) {
            set.insert((x, y));
        }
    }
}

/// A triangle by the leftmost and the rightmost point of its outline on every line of centres.
pub(crate) fn leftmost_rightmost(triangle: [Vertex; 3], size: i32) -> BTreeSet<Pixel> {
    let mut set = BTreeSet::new();
    for row in 0..size {
        let y = center((0, row)).1;
        let crossings: Vec<Fraction> = edges(&triangle)
            .filter(|(a, b)| a.1.min(b.1) <= y && y < a.1.max(b.1))
            .map(|(a, b)| x_at((a.0.into(), a.1), (b.0.into(), b.1), y))
            .collect();
        let least = crossings.iter().copied().reduce(|a, b| if b.less(a) { b } else { a });
        let most = crossings.iter().copied().reduce(|a, b| if a.less(b) { b } else { a });
        if let (Some(left), Some(right)) = (least, most) {
            fill_row(&mut set, row, left, right, size);
        }
    }
    set
}

/// A triangle cut at the height of its middle vertex: v4 on the long side makes a flat-bottom triangle
/// above and a flat-top one below.
pub(crate) fn flat_split(triangle: [Vertex; 3], size: i32) -> BTreeSet<Pixel> {
    let mut sorted = triangle;
    sorted.sort_unstable_by_key(|vertex| vertex.1);
    let [v1, v2, v3] = sorted.map(|(x, y)| (Fraction::from(x), y));
    let mut set = BTreeSet::new();
    if v1.1 == v3.1 {
        return set;
    }
    let v4 = (x_at(v1, v3, v2.1), v2.1);
    let mut half = |apex: (Fraction, i64), rows: std::ops::Range<i64>| {
        let (left, right) = if v2.0.less(v4.0) { (v2, v4) } else { (v4, v2) };
        for row in 0..size {
            let y = center((0, row)).1;
            if rows.contains(&y) {
                fill_row(&mut set, row, x_at(apex, left, y), x_at(apex, right, y), size);
            }
        }
    };
    half(v1, v1.1..v2.1);
    half(v3, v2.1..v3.1);
    set
}
