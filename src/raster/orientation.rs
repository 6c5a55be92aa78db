//! Which way corners turn, never "straight on": ties are broken as if all corners were moved by a little.
//!
//! Each corner is moved down by far more than those of higher numbers, and all of them to the right by still less, in the same order.
//! No three are then on one line and no edges touch, so that whatever follows from the answers fits together: outlines that meet in
//! corners, or lie on each other, either cross or do not. This is the simulation of simplicity by Edelsbrunner and Mücke (1990).

use super::edge::FixedPoint;

/// A corner and its number, which no other corner has.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) point: FixedPoint,
    pub(super) number: u32,
}

/// An edge's corners.
pub(super) type Ends = [Corner; 2];

impl Corner {
    /// Whether it lies above another corner.
    #[inline(always)]
    pub(super) fn is_above(self, other: Self) -> bool {
        self.point.y < other.point.y || self.point.y == other.point.y && self.number > other.number
    }
}

/// Twice the area of the triangle `a`, `b`, `c`, whose corners are at most 2^29 apart: above 0 where `c` lies right of the way from `a` to `b` on the canvas.
#[inline(always)]
pub(super) fn area([a, b]: Ends, c: Corner) -> i64 {
    let [bx, by, cx, cy] =
        [b.point.x - a.point.x, b.point.y - a.point.y, c.point.x - a.point.x, c.point.y - a.point.y].map(i64::from);
    bx * cy - by * cx
}

/// The areas of the triangles of each of two edges' corners with the other edge, as by [`area`].
#[inline(always)]
pub(super) fn areas([[a, b], [c, d]]: [Ends; 2]) -> [[i64; 2]; 2] {
    let way = |from: Corner, to: Corner| (i64::from(to.point.x - from.point.x), i64::from(to.point.y - from.point.y));
    let product = |(ax, ay): (i64, i64), (bx, by): (i64, i64)| ax * by - ay * bx;
    let (edge, other, between) = (way(a, b), way(c, d), way(c, a));
    // One end's area and the other's differ by the edges' product.
    let (both, area, other_area) = (product(other, edge), product(other, between), product(between, edge));
    [[area, area + both], [other_area, other_area - both]]
}

/// Whether `corner` lies right of an edge with which it makes a triangle of `area`.
#[inline(always)]
pub(super) fn is_right_of(edge: Ends, corner: Corner, area: i64) -> bool {
    if area == 0 { is_moved_right_of(edge, corner) } else { area > 0 }
}

/// As [`is_right_of`] for three corners on one line.
#[cold]
fn is_moved_right_of([a, b]: Ends, c: Corner) -> bool {
    let across = |from: Corner, to: Corner| to.point.x.cmp(&from.point.x) as i32;
    // By how much the area changes as each of them is moved down.
    let mut moved = [(a.number, across(b, c)), (b.number, across(c, a)), (c.number, across(a, b))];
    moved.sort_unstable_by_key(|(number, _)| *number);
    if let Some((_, change)) = moved.iter().find(|(_, change)| *change != 0) {
        return *change > 0;
    }
    // On one upright line it is the first one's move to the right that counts.
    let [(first, _), ..] = moved;
    match first {
        _ if first == a.number => c.is_above(b),
        _ if first == b.number => a.is_above(c),
        _ => b.is_above(a),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corners moved as much as the docs say, in whole numbers large enough: a coordinate's unit is 2^110, the first corner is moved down by
    /// 2^104, and each other by a 2^12th of the one before; across by 2^76 and a 2^30th or less.
    fn moved(corner: Corner) -> (i128, i128) {
        let (across, down) = [(76, 104), (46, 92), (16, 80)][corner.number as usize];
        let at = |v: i32, by: u32| (i128::from(v) << 110) + (1_i128 << by);
        (at(corner.point.x, across), at(corner.point.y, down))
    }

    #[test]
    fn ties_are_broken_as_if_corners_were_moved() {
        let points: Vec<FixedPoint> = (0..9).map(|i| FixedPoint { x: i % 3, y: i / 3 }).collect();
        let mut ties = 0;
        for [i, j, k] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            for a in &points {
                for b in &points {
                    for c in &points {
                        let corner = |point: &FixedPoint, number| Corner { point: *point, number };
                        let (a, b, c) = (corner(a, i), corner(b, j), corner(c, k));
                        let area = area([a, b], c);
                        ties += usize::from(area == 0);
                        let found = is_right_of([a, b], c, area);
                        let [(ax, ay), (bx, by), (cx, cy)] = [moved(a), moved(b), moved(c)];
                        let truth = product(bx - ax, cy - ay) > product(by - ay, cx - ax);
                        assert_eq!(found, truth, "{a:?} {b:?} {c:?}");
                        assert_eq!(is_right_of([b, a], c, -area), !found);
                        assert_eq!(is_right_of([b, c], a, area), found);
                        assert_eq!(a.is_above(b), ay < by);
                    }
                }
            }
        }
        assert!(ties > 500, "{ties}");
    }

    #[test]
    fn areas_of_two_edges_are_those_of_four_triangles() {
        let mut seed = 9_u32;
        let mut corner = || {
            let mut coordinate = || {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                // As far from 0 as corners may be.
                [-(1 << 28), 1 << 28, (seed >> 4) as i32 - (1 << 27), (seed >> 28) as i32][(seed >> 26) as usize & 3]
            };
            Corner { point: FixedPoint { x: coordinate(), y: coordinate() }, number: 0 }
        };
        for _ in 0..2000 {
            let [edge, other] = [[corner(), corner()], [corner(), corner()]];
            let one_by_one = [other.map(|end| area(edge, end)), edge.map(|end| area(other, end))];
            assert_eq!(areas([edge, other]), [one_by_one[1], one_by_one[0]], "{edge:?} {other:?}");
        }
    }

    /// A product as high and low part, in order like the product itself.
    fn product(a: i128, b: i128) -> (i128, u128) {
        let (high_a, low_a) = (a >> 64, a & ((1 << 64) - 1));
        let (high_b, low_b) = (b >> 64, b & ((1 << 64) - 1));
        let low = (low_a as u128) * (low_b as u128);
        let middle = high_a * low_b + high_b * low_a;
        let (sum, carry) = low.overflowing_add((middle as u128) << 64);
        (high_a * high_b + (middle >> 64) + i128::from(carry), sum)
    }
}
