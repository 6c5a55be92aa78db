//! Outlines that go around a point, always the same way, once: circles, rounded rectangles, all that is convex, and much that is
//! not. From that point their corners are seen in their order, so that no two edges meet but where they follow each other.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use super::edge::FixedPoint;

/// Eight edges, of which `count` are meant: the x and the y at which they start and end.
pub(super) struct Eight<S: Simd> {
    pub(super) from: [i32x8<S>; 2],
    pub(super) to: [i32x8<S>; 2],
    pub(super) count: usize,
}

/// Which way an outline turns, as seen along it on the canvas: where its inside lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    Right,
    Left,
}

/// How an outline has gone around a point so far.
pub(super) struct Turn {
    point: FixedPoint,
    /// Whether all edges went on to the right, and to the left.
    right: bool,
    left: bool,
    /// How often it came down to the point's level from above.
    falls: u32,
}

impl Turn {
    /// An outline of so many corners is looked at from the middle between its first corner and the one half of the way around: inside, where
    /// it is convex.
    #[inline(always)]
    pub(super) fn of(corners: &[FixedPoint], count: usize) -> Self {
        let point = match (corners.first(), corners.get(count / 2)) {
            // Sides are at most 2^28 from 0.
            (Some(a), Some(b)) => FixedPoint { x: (a.x + b.x) >> 1, y: (a.y + b.y) >> 1 },
            _ => FixedPoint::default(),
        };
        Self { point, right: true, left: true, falls: 0 }
    }

    /// Whether it always went the same way. Not known of some that do, where rounding may matter.
    #[inline(always)]
    pub(super) fn goes_on(&self) -> bool {
        self.right | self.left
    }

    /// Which way it went around, if at its end it did so once.
    #[inline(always)]
    pub(super) fn whole(&self) -> Option<Way> {
        // Each time around it comes down once, and goes up.
        match (self.falls, self.right, self.left) {
            (1, true, _) => Some(Way::Right),
            (1, _, true) => Some(Way::Left),
            _ => None,
        }
    }

    /// Goes on, and says whether these edges go less than once around, always the same way.
    #[inline(always)]
    pub(super) fn go<S: Simd>(&mut self, simd: S, edges: &Eight<S>) -> bool {
        let others = !0_u32 << edges.count & 0xff;
        let Eight { from: [from_x, from_y], to: [to_x, to_y], .. } = *edges;
        let (x, y) = (self.point.x, self.point.y);
        let (from_y, to_y) = (from_y - y, to_y - y);
        let (from_above, to_above) =
            (from_y.simd_lt(0).to_bitmask() as u32 & !others, to_y.simd_lt(0).to_bitmask() as u32 & !others);
        self.falls += (from_above & !to_above).count_ones();
        let (from_x, from_y) = ((from_x - x).to_float::<f32x8<S>>(), from_y.to_float::<f32x8<S>>());
        let (to_x, to_y) = ((to_x - x).to_float::<f32x8<S>>(), to_y.to_float::<f32x8<S>>());
        // Twice the area that an edge spans with the point. The margin is more than what rounding may add.
        let (one, other) = (from_x * to_y, from_y * to_x);
        let (area, margin) = (one - other, (one.abs() + other.abs()) * (1.0 / (1 << 20) as f32));
        self.right &= area.simd_gt(margin).to_bitmask() as u32 | others == 0xff;
        self.left &= (f32x8::splat(simd, 0.0) - area).simd_gt(margin).to_bitmask() as u32 | others == 0xff;
        // It comes to the point's level each half of the way around.
        self.goes_on() && (from_above ^ to_above).count_ones() <= 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::num::trig::sin_cos;
    use crate::raster::edge::{coordinates, for_eights};

    /// Which way an outline is found to go around once, at all levels.
    fn goes_around(outline: &[(i32, i32)]) -> Option<Way> {
        let mut corners: Vec<_> = outline.iter().map(|(x, y)| FixedPoint { x: *x, y: *y }).collect();
        corners.resize((outline.len() + 1).next_multiple_of(8), corners[0]);
        let found = SimdLevel::available().into_iter().map(|level| {
            let mut turn = Turn::of(&corners, outline.len());
            dispatch!(level, simd => for_eights(&corners, outline.len(), |_, eight, next, count| {
                let (x, y) = coordinates(simd, eight);
                let end = |v: i32| i32x8::splat(simd, v);
                let to = [x.slide::<1>(end(next.x)), y.slide::<1>(end(next.y))];
                turn.go(simd, &Eight { from: [x, y], to, count });
            }));
            turn.whole()
        });
        let found: Vec<_> = found.collect();
        assert!(found.iter().all(|one| *one == found[0]), "levels differ");
        found[0]
    }

    /// Whether two edges that do not follow each other have a point in common, by the sides on which their ends lie.
    fn meets_itself(outline: &[(i32, i32)]) -> bool {
        let edge = |index: usize| [outline[index], outline[(index + 1) % outline.len()]];
        let side = |[a, b]: [(i32, i32); 2], c: (i32, i32)| {
            let [bx, by, cx, cy] = [b.0 - a.0, b.1 - a.1, c.0 - a.0, c.1 - a.1].map(i64::from);
            (bx * cy - by * cx).signum()
        };
        let overlap = |[a, b]: [i32; 2], [c, d]: [i32; 2]| a.min(b) <= c.max(d) && c.min(d) <= a.max(b);
        let meet = |[a, b]: [(i32, i32); 2], [c, d]: [(i32, i32); 2]| {
            side([a, b], c) * side([a, b], d) <= 0
                && side([c, d], a) * side([c, d], b) <= 0
                && overlap([a.0, b.0], [c.0, d.0])
                && overlap([a.1, b.1], [c.1, d.1])
        };
        let follow = |one: usize, other: usize| one + 1 == other || one == 0 && other + 1 == outline.len();
        (0..outline.len())
            .any(|one| (one + 1..outline.len()).any(|other| !follow(one, other) && meet(edge(one), edge(other))))
    }

    fn reversed(outline: &[(i32, i32)]) -> Vec<(i32, i32)> {
        outline.iter().rev().copied().collect()
    }

    /// So many corners evenly around a point, by so many turns.
    fn around(corners: usize, turns: f64, radius: impl Fn(usize) -> f64) -> Vec<(i32, i32)> {
        let corner = |index: usize| {
            let (sin, cos) = sin_cos(index as f64 / corners as f64 * turns * std::f64::consts::TAU);
            ((5000.0 + radius(index) * cos).round() as i32, (-7000.0 + radius(index) * sin).round() as i32)
        };
        (0..corners).map(corner).collect()
    }

    #[test]
    fn what_is_convex_goes_around_once() {
        // Not three: from the middle of one side, that side is not seen to go anywhere.
        for corners in 4..60 {
            let circle = around(corners, 1.0, |_| 3000.0);
            let ellipse: Vec<_> = circle.iter().map(|(x, y)| (5 * x, y / 3)).collect();
            for outline in [circle, ellipse] {
                assert_eq!(goes_around(&outline), Some(Way::Right), "{corners}");
                assert_eq!(goes_around(&reversed(&outline)), Some(Way::Left), "{corners}");
            }
        }
        // Wherever it starts, as far out as there may be corners.
        let far = 1 << 28;
        let mut rectangle = [(-far, -far), (far, -far), (far, -far + 300), (-far, -far + 300)];
        for _ in 0..4 {
            rectangle.rotate_left(1);
            assert_eq!(goes_around(&rectangle), Some(Way::Right));
            assert_eq!(goes_around(&reversed(&rectangle)), Some(Way::Left));
        }
    }

    #[test]
    fn what_turns_back_or_goes_around_twice_does_not() {
        for (what, outline) in [
            ("a star of five points in one line", around(5, 2.0, |_| 3000.0)),
            ("two turns of a spiral", around(40, 2.0, |index| 500.0 + 90.0 * index as f64)),
            ("a circle twice", around(48, 2.0, |_| 3000.0)),
            ("an eight", vec![(0, 0), (1000, 1000), (1000, 0), (0, 1000)]),
            ("a comb", vec![(0, 0), (900, 0), (900, 900), (600, 900), (600, 100), (300, 100), (300, 900), (0, 900)]),
            ("a line to and fro", vec![(0, 0), (500, 10), (1000, 20), (500, 10)]),
            ("a point", vec![(7, 7); 5]),
        ] {
            assert_eq!([goes_around(&outline), goes_around(&reversed(&outline))], [None, None], "{what}");
        }
    }

    #[test]
    fn what_goes_around_once_does_not_meet_itself() {
        let mut seed = 3_u32;
        let mut below = |end: i32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as i32 % end
        };
        let mut found = [0, 0];
        for round in 0..4000 {
            let (corners, size) = (3 + below(12) as usize, [6, 40, 4000][round % 3]);
            let turns = f64::from(1 + below(4) / 3);
            let radii: Vec<_> =
                (0..corners).map(|_| f64::from(size) * (1.0 + f64::from(below(size)) / 900.0)).collect();
            let mut outline = around(corners, turns, |index| radii[index]);
            for corner in &mut outline {
                *corner = (corner.0 + below(size) / 3, corner.1 + below(size) / 3);
            }
            if goes_around(&outline).is_some() {
                found[0] += 1;
                assert!(!meets_itself(&outline), "{outline:?}");
            } else {
                found[1] += 1;
            }
        }
        assert!(found.iter().all(|found| *found > 500), "{found:?}");
    }
}
