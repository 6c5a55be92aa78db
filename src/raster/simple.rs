//! Whether an outline crosses itself: if not, sums of areas are exact coverage as they are.
//!
//! Coverage by areas is right in a pixel as long as the fill rule is linear between the windings there. So it is in a strip of
//! rows if along each of its scanlines the outline goes down and up by turns, always the same way first: windings are
//! then 0 and one of 1 and −1. That is proved by a sweep from top to bottom over the outline's *sides*, pieces that go
//! all down or all up, in their order from left to right: two that lie side by side are compared at every corner of either
//! (Shamos and Hoey, *Geometric intersection problems*, 1976, with sides for segments). Where that fails, edges are cut where they cross
//! ([`exact`](super::exact)). Arithmetic is in integers, and the shape alone decides, not how it is cut into bands.

use fearless_simd::Simd;

use super::apart::{Apart, is_quicker};
use super::edge::FixedPoint;
use super::kernel::STRIP_SHIFT;

/// Corners further out are not looked at: their products might not fit 64 bits.
const FARTHEST: i32 = 1 << 29;

/// After so many looks at active sides for each corner, and so many in all, the search is given up.
const LOOKS_PER_CORNER: usize = 32;
const LOOKS: usize = 8192;

/// Outlines of more corners or sides are not looked at: what crosses itself so often does so everywhere, and memory matters.
pub(super) const MOST_CORNERS: usize = 1 << 20;
const MOST_SIDES: usize = 1 << 16;

/// A piece of an outline that goes all down or, walked backwards, up: an edge of it, from which the others are found downwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) from: FixedPoint,
    pub(super) to: FixedPoint,
    /// The number of `to`, and where the next corner is: the one after or, where the outline goes up, before.
    index: usize,
    pub(super) forwards: bool,
    /// Where the last edge ends.
    bottom: i32,
}

/// A side that the scanline crosses.
#[derive(Clone, Copy, Debug)]
struct Active {
    /// How far it is compared with the side left of it, and with the one right of it.
    leftwards: Side,
    rightwards: Side,
}

/// The search's working memory.
#[derive(Debug, Default)]
pub(super) struct Simplicity {
    apart: Apart,
    sides: Vec<Side>,
    active: Vec<Active>,
}

impl Simplicity {
    /// Whether closed outlines neither cross themselves nor each other, and wind once around what is inside, all the same way; false
    /// where that is not found out. `None` if there are too many of them, or they lie too far out. Each outline's last corner is its first; `ends` says where they end.
    #[inline(never)]
    pub(super) fn wind_once<S: Simd>(&mut self, simd: S, points: &[FixedPoint], ends: &[usize]) -> Option<bool> {
        let apart = &mut self.apart;
        let wind_once = simd.vectorize(
            #[inline(always)]
            || is_quicker(points) && apart.wind_once(simd, points, ends),
        );
        if wind_once { Some(true) } else { self.sweep_outlines(points, ends) }
    }

    /// As [`wind_once`](Self::wind_once), by the sweep alone.
    #[inline(never)]
    pub(super) fn sweep_outlines(&mut self, points: &[FixedPoint], ends: &[usize]) -> Option<bool> {
        self.list_outlines(points, ends).then(|| self.sweep(points).unwrap_or(false))
    }

    /// Lists the sides of outlines; false if there are too many, or they lie too far out.
    pub(super) fn list_outlines(&mut self, points: &[FixedPoint], ends: &[usize]) -> bool {
        self.sides.clear();
        let mut start = 0;
        for end in ends {
            if !self.list_sides(points, start, *end) || self.sides.len() > MOST_SIDES {
                return false;
            }
            start = *end;
        }
        self.sides.sort_unstable_by_key(|side| (side.from.y, side.from.x));
        true
    }

    /// The sides that are listed, in the order of their tops.
    pub(super) fn sides(&self) -> &[Side] {
        &self.sides
    }

    /// Lists the sides of the outline of corners `start..end`; false if it lies too far out.
    #[inline(always)]
    fn list_sides(&mut self, points: &[FixedPoint], start: usize, end: usize) -> bool {
        let Some((first, rest)) = points.get(start..end).and_then(|points| points.split_first()) else { return true };
        let (mut last, mut direction, mut far) = (*first, 0, is_far(*first));
        for (index, point) in (start + 1..).zip(rest) {
            far |= is_far(*point);
            let next = (point.y > last.y) as i32 - (point.y < last.y) as i32;
            if next != direction {
                // A side that goes up begins where the one before it ends.
                if direction < 0 {
                    self.close_upwards(points, index - 1);
                }
                if next != 0 {
                    let bottom = last.y;
                    self.sides.push(Side { from: last, to: *point, index, forwards: next > 0, bottom });
                }
                direction = next;
            }
            if next > 0
                && let Some(side) = self.sides.last_mut()
            {
                side.bottom = point.y;
            }
            last = *point;
        }
        if direction < 0 {
            self.close_upwards(points, end - 1);
        }
        !far
    }

    /// The last side goes up, and ends at a corner: its uppermost.
    #[inline(always)]
    fn close_upwards(&mut self, points: &[FixedPoint], top: usize) {
        if let Some(side) = self.sides.last_mut()
            && let Some([to, from]) = top.checked_sub(1).and_then(|index| points.get(index..)?.first_chunk())
        {
            (side.from, side.to, side.index) = (*from, *to, top - 1);
        }
    }

    /// From top to bottom, to where outlines cross; `None` where the search is given up.
    fn sweep(&mut self, points: &[FixedPoint]) -> Option<bool> {
        let Self { sides, active, .. } = self;
        active.clear();
        let mut looks = LOOKS + LOOKS_PER_CORNER * points.len();
        let mut coming = &sides[..];
        let mut strip = i32::MIN;
        loop {
            if active.is_empty() {
                let Some(next) = coming.first() else { return Some(true) };
                strip = next.from.y >> STRIP_SHIFT;
            }
            if !sweep_strip(points, active, &mut coming, (strip + 1) << STRIP_SHIFT, &mut looks)? {
                return Some(false);
            }
            strip += 1;
            looks = looks.checked_sub(active.len() + 1)?;
        }
    }
}

/// Sweeps down to `end`; whether all was in order. `None` where the search is given up.
#[inline(always)]
fn sweep_strip(
    points: &[FixedPoint],
    active: &mut Vec<Active>,
    coming: &mut &[Side],
    end: i32,
    looks: &mut usize,
) -> Option<bool> {
    // Which way the outermost sides on the left go.
    let mut outer = active.first().map(|first| first.leftwards.forwards);
    loop {
        *looks = looks.checked_sub(active.len() + 1)?;
        let bottom = active.iter().map(|side| side.leftwards.bottom).fold(i32::MAX, i32::min);
        let top = coming.first().map_or(i32::MAX, |side| side.from.y);
        let y = if bottom < top { bottom } else { top };
        if y > end || y == end && bottom > end {
            break;
        }
        let mut in_order = true;
        let mut index = 0;
        while let Some(side) = active.get(index) {
            if side.leftwards.bottom > y {
                index += 1;
                continue;
            }
            in_order &= index.checked_sub(1).is_none_or(|left| compare(points, active, left, y));
            in_order &= compare(points, active, index, y);
            active.remove(index);
        }
        while let Some((side, rest)) = coming.split_first().filter(|(side, _)| side.from.y == y && y < end) {
            *coming = rest;
            in_order &= insert(points, active, *side);
        }
        if let Some(first) = active.first().map(|first| first.leftwards.forwards) {
            in_order &= *outer.get_or_insert(first) == first && is_by_turns(active);
        }
        if !in_order {
            return Some(false);
        }
    }
    // Edges may cross long before they end.
    Some((0..active.len()).all(|index| compare(points, active, index, end)) && are_in_order(active, end))
}

/// Puts a side that begins among the active ones; whether it fits between its neighbours.
#[inline(always)]
fn insert(points: &[FixedPoint], active: &mut Vec<Active>, side: Side) -> bool {
    let (mut low, mut high, mut in_order) = (0, active.len(), true);
    while low < high {
        let middle = (low + high) / 2;
        in_order &= compare(points, active, middle, side.from.y);
        if active.get(middle).is_some_and(|other| other.rightwards.is_left_of(side)) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    for index in [low.checked_sub(1), Some(low)].into_iter().flatten() {
        in_order &= compare(points, active, index, side.from.y);
    }
    active.insert(low, Active { leftwards: side, rightwards: side });
    // How it begins; what it meets further down is seen when they are compared.
    let left = low.checked_sub(1).and_then(|left| active.get(left));
    in_order
        && left.is_none_or(|left| left.rightwards.side_of(side.from) <= 0)
        && active.get(low + 1).is_none_or(|right| right.leftwards.side_of(side.from) >= 0)
}

/// Whether sides go down and up by turns.
#[inline(always)]
fn is_by_turns(active: &[Active]) -> bool {
    let turns = |pair: &[Active]| matches!(pair, [a, b] if a.leftwards.forwards != b.leftwards.forwards);
    active.len().is_multiple_of(2) && active.windows(2).all(turns)
}

/// Whether the active sides lie in their order at `y`.
#[inline(always)]
fn are_in_order(active: &[Active], y: i32) -> bool {
    active.windows(2).all(|pair| matches!(pair, [a, b] if a.rightwards.is_left_at(b.leftwards, y)))
}

fn is_far(point: FixedPoint) -> bool {
    let near = -FARTHEST..=FARTHEST;
    !near.contains(&point.x) || !near.contains(&point.y)
}

/// Whether the side `index` stays left of the next one down to `y`, or meets it; moves both cursors there. The last is moved alone.
#[inline(always)]
fn compare(points: &[FixedPoint], active: &mut [Active], index: usize, y: i32) -> bool {
    let (mut left, mut right) = match active.get(index..) {
        Some([left, right, ..]) => (left.rightwards, right.leftwards),
        _ => {
            if let Some(last) = active.get_mut(index) {
                while last.rightwards.to.y <= y && last.rightwards.advance(points) {}
            }
            return true;
        }
    };
    let mut in_order = true;
    // Between two corners the distance grows or shrinks evenly.
    while left.to.y <= y || right.to.y <= y {
        let (end_left, end_right) = (left.to, right.to);
        if end_left.y <= end_right.y {
            in_order &= right.side_of(end_left) >= 0;
            if !left.advance(points) {
                break;
            }
        }
        if end_right.y <= end_left.y {
            in_order &= left.side_of(end_right) <= 0;
            if !right.advance(points) {
                break;
            }
        }
    }
    if let Some([a, b, ..]) = active.get_mut(index..) {
        (a.rightwards, b.leftwards) = (left, right);
    }
    in_order
}

impl Side {
    /// Goes on to the next edge; false where there is none downwards.
    #[inline(always)]
    pub(super) fn advance(&mut self, points: &[FixedPoint]) -> bool {
        let index = if self.forwards { self.index + 1 } else { self.index.wrapping_sub(1) };
        match points.get(index) {
            Some(next) if self.to.y < self.bottom => {
                (self.from, self.to, self.index) = (self.to, *next, index);
                true
            }
            _ => false,
        }
    }

    /// Above 0 where a point at the edge's height lies left of it, below 0 right of it.
    #[inline(always)]
    fn side_of(self, point: FixedPoint) -> i64 {
        let across = |a: FixedPoint, b: FixedPoint| i64::from(b.x) - i64::from(a.x);
        let down = |a: FixedPoint, b: FixedPoint| i64::from(b.y) - i64::from(a.y);
        across(self.from, self.to) * down(self.from, point) - across(self.from, point) * down(self.from, self.to)
    }

    /// Whether this edge lies left of another at `y`, which both cross, or meets it there.
    #[inline(always)]
    fn is_left_at(self, other: Self, y: i32) -> bool {
        let (rightmost, leftmost) = (self.from.x.max(self.to.x), other.from.x.min(other.to.x));
        rightmost <= leftmost || self.is_exactly_left_at(other, y)
    }

    #[inline(never)]
    fn is_exactly_left_at(self, other: Self, y: i32) -> bool {
        // Each place times its edge's height.
        let place = |side: Self| {
            let [x0, y0, x1, y1] = [side.from.x, side.from.y, side.to.x, side.to.y].map(i64::from);
            (i128::from(x0 * (y1 - y0) + (x1 - x0) * (i64::from(y) - y0)), i128::from(y1 - y0))
        };
        let ((own, own_height), (others, others_height)) = (place(self), place(other));
        own * others_height <= others * own_height
    }

    /// Whether this edge passes left of where `other` starts; where both meet, whether it leads further to the left.
    #[inline(always)]
    fn is_left_of(self, other: Self) -> bool {
        match self.side_of(other.from) {
            0 => {
                let across = |c: Self| i64::from(c.to.x) - i64::from(c.from.x);
                let down = |c: Self| i64::from(c.to.y) - i64::from(c.from.y);
                across(self) * down(other) < across(other) * down(self)
            }
            side => side < 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    type Outline = Vec<(i32, i32)>;

    /// The corners of outlines, each with its first once more, and where they end.
    fn corners(outlines: &[Outline]) -> (Vec<FixedPoint>, Vec<usize>) {
        let (mut points, mut ends) = (Vec::new(), Vec::new());
        for outline in outlines {
            points.extend(outline.iter().chain(outline.first()).map(|(x, y)| FixedPoint { x: *x, y: *y }));
            ends.push(points.len());
        }
        (points, ends)
    }

    /// Whether outlines are found to wind once.
    fn found(outlines: &[Outline]) -> Option<bool> {
        let (points, ends) = corners(outlines);
        let found = dispatch!(SimdLevel::best(), simd => Simplicity::default().wind_once(simd, &points, &ends));
        // Without the quick proof it is less often.
        let swept = Simplicity::default().sweep_outlines(&points, &ends);
        assert!(swept == found || found == Some(true), "{outlines:?}");
        found
    }

    /// Whether the quick proof is found.
    fn are_apart(outlines: &[Outline]) -> bool {
        let (points, ends) = corners(outlines);
        let found = SimdLevel::available()
            .into_iter()
            .map(|level| dispatch!(level, simd => Apart::default().wind_once(simd, &points, &ends)));
        let found: Vec<bool> = found.collect();
        assert!(found.windows(2).all(|pair| pair[0] == pair[1]), "{found:?}");
        found[0]
    }

    fn rect(left: i32, top: i32, right: i32, bottom: i32) -> Outline {
        vec![(left, top), (right, top), (right, bottom), (left, bottom)]
    }

    fn reversed(mut outline: Outline) -> Outline {
        outline.reverse();
        outline
    }

    #[test]
    fn rings_and_stars_are_proved_apart() {
        // A wavy ring of `corners` corners around (0, 0), the one way or the other.
        let ring = |corners: i32, radius: f64, way: f64, twist: f64| -> Outline {
            let at = |i: i32| {
                let angle = twist + way * f64::from(i) / f64::from(corners) * std::f64::consts::TAU;
                let r = radius * (1.0 + 0.2 * libm::cos(7.0 * angle));
                ((r * libm::cos(angle)) as i32, (r * libm::sin(angle)) as i32)
            };
            (0..corners).map(at).collect()
        };
        for corners in [3, 8, 9, 17, 64, 100] {
            let (outer, hole, dot) =
                (ring(corners, 9e3, 1.0, 0.1), ring(corners, 4e3, -1.0, 0.5), ring(corners, 1e3, 1.0, 0.0));
            let beside = outer.iter().map(|(x, y)| (x + 30_000, y - 500)).collect::<Outline>();
            for simple in [
                vec![outer.clone()],
                vec![outer.clone(), hole.clone()],
                vec![dot.clone(), outer.clone(), hole.clone()],
                vec![reversed(outer.clone()), reversed(hole.clone()), reversed(beside.clone())],
                // Corners twice in a row, and an outline that is a point.
                vec![outer.iter().flat_map(|p| [*p, *p]).collect(), vec![(50, 50)], beside.clone()],
            ] {
                assert!(are_apart(&simple) && found(&simple) == Some(true), "{corners}");
            }
            for other in [
                vec![outer.clone(), reversed(hole.clone())],
                vec![outer.clone(), reversed(beside)],
                vec![outer.clone(), dot.clone()],
                vec![hole.clone(), hole.iter().map(|(x, y)| (x + 900, *y)).collect()],
                // To a corner and back again; a corner that touches an edge.
                vec![vec![(0, 0), (500, 0), (900, 0), (500, 0), (500, 500)]],
                vec![vec![(0, 0), (800, 0), (800, 800), (400, 0), (0, 800)]],
                vec![vec![(0, 0), (100, 100), (100, 0), (0, 100)]],
            ] {
                assert!(!are_apart(&other), "{corners}");
            }
        }
        // The last edge of an outline and the first of the next are no neighbours.
        assert!(!are_apart(&[rect(0, 0, 100, 100), reversed(rect(0, 0, 50, 50))]));
    }

    #[test]
    fn shapes_that_wind_once_and_others() {
        let square = rect(0, 0, 100, 100);
        let comb = vec![(0, 0), (10, 90), (20, 0), (30, 95), (40, 0), (50, 80), (60, 0), (60, 100), (0, 100)];
        let spiral = vec![
            (0, 0),
            (90, 0),
            (90, 90),
            (20, 90),
            (20, 30),
            (60, 30),
            (60, 40),
            (30, 40),
            (30, 80),
            (80, 80),
            (80, 10),
            (0, 10),
        ];
        let level = vec![(0, 0), (50, 0), (50, 20), (90, 20), (90, 50), (40, 50), (40, 20), (0, 20)];
        for simple in [
            vec![square.clone()],
            vec![reversed(square.clone())],
            vec![comb.clone()],
            vec![reversed(comb)],
            vec![spiral.clone()],
            vec![square.clone(), reversed(rect(20, 20, 80, 80))],
            vec![square.clone(), reversed(rect(20, 20, 80, 80)), rect(30, 30, 40, 70), rect(50, 30, 60, 70)],
            // Beside, below, and at a corner.
            vec![square.clone(), rect(150, 50, 250, 150), rect(0, 100, 50, 300), rect(100, 150, 150, 200)],
            vec![vec![(0, 0), (10, 10), (-10, 10)], vec![(0, 0), (-10, -10), (10, -10)]],
            vec![level],
            vec![],
            vec![vec![(3, 4)], square.clone()],
            vec![vec![(0, 0), (100, 0)]],
        ] {
            assert_eq!(found(&simple), Some(true), "{simple:?}");
        }
        for other in [
            // Twice around, once each way, crossed, and a star.
            vec![square.clone(), square.clone()],
            vec![square.clone(), rect(20, 20, 80, 80)],
            vec![square.clone(), reversed(rect(150, 50, 250, 150))],
            vec![square.clone(), reversed(rect(0, 150, 100, 250))],
            vec![square.clone(), reversed(rect(20, 20, 120, 80))],
            vec![vec![(0, 0), (100, 100), (100, 0), (0, 100)]],
            vec![vec![(50, 0), (80, 100), (0, 40), (100, 40), (20, 100)]],
            vec![spiral, rect(50, 34, 70, 36)],
        ] {
            assert_eq!(found(&other), Some(false), "{other:?}");
        }
        // Too far out for 64 bits, and too high for the time that it is worth.
        assert_eq!(found(&[vec![(0, 0), (i32::MAX, 5), (i32::MIN, 9)]]), None);
        assert_eq!(found(&[rect(0, 0, 9, 1 << 28)]), Some(false));
        // Far down, and opposite windings in different strips.
        assert_eq!(found(&[vec![(0, -4000), (100, -4000), (0, 9000), (100, 9000)]]), Some(false));
        assert_eq!(found(&[rect(0, -9000, 50, 2048), reversed(rect(0, 2048, 50, 2100))]), Some(true));
    }

    /// By definition: along every scanline of a strip down and up by turns, the same first. `None` where pieces lie on each other.
    fn winds_once(outlines: &[Outline], strip: i32) -> Option<bool> {
        let mut edges = Vec::new();
        for outline in outlines {
            for (a, b) in outline.iter().zip(outline.iter().cycle().skip(1)) {
                if a.1 != b.1 {
                    let ((x0, y0), (x1, y1), down) = if a.1 < b.1 { (*a, *b, true) } else { (*b, *a, false) };
                    edges.push((f64::from(x0), f64::from(y0), f64::from(x1), f64::from(y1), down));
                }
            }
        }
        let x_at = |e: &(f64, f64, f64, f64, bool), y: f64| e.0 + (e.2 - e.0) * (y - e.1) / (e.3 - e.1);
        // Heights at which the order may change.
        let ends = [strip, strip + 1].map(|strip| f64::from(strip << STRIP_SHIFT));
        let mut heights: Vec<f64> = edges.iter().flat_map(|e| [e.1, e.3]).chain(ends).collect();
        for (i, a) in edges.iter().enumerate() {
            for b in &edges[i + 1..] {
                let (slope_a, slope_b) = ((a.2 - a.0) / (a.3 - a.1), (b.2 - b.0) / (b.3 - b.1));
                let y = (b.0 - slope_b * b.1 - a.0 + slope_a * a.1) / (slope_a - slope_b);
                if y.is_finite() && y > a.1.max(b.1) && y < a.3.min(b.3) {
                    heights.push(y);
                }
            }
        }
        heights.retain(|y| ends[0] <= *y && *y <= ends[1]);
        heights.sort_by(f64::total_cmp);
        heights.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
        let mut first = None;
        for pair in heights.windows(2) {
            let y = (pair[0] + pair[1]) / 2.0;
            let mut crossed: Vec<(f64, bool)> =
                edges.iter().filter(|e| e.1 < y && y < e.3).map(|e| (x_at(e, y), e.4)).collect();
            crossed.sort_by(|a, b| a.0.total_cmp(&b.0));
            if crossed.windows(2).any(|pair| pair[1].0 - pair[0].0 < 1e-7) {
                return None;
            }
            let Some((_, start)) = crossed.first() else { continue };
            if crossed.iter().enumerate().any(|(i, (_, down))| *down != (*start == (i % 2 == 0)))
                || *first.get_or_insert(*start) != *start
            {
                return Some(false);
            }
        }
        Some(true)
    }

    #[test]
    fn an_edge_that_goes_back_is_seen_wherever_it_is() {
        // Around a circle of 21 corners.
        let around = |size: i32| -> Outline {
            let corner = |i: i32| {
                let angle = f64::from(i) * std::f64::consts::TAU / 21.0;
                let reach = |v: f64| (v * f64::from(size)) as i32;
                (reach(libm::cos(angle)), reach(libm::sin(angle)))
            };
            (0..21).map(corner).collect()
        };
        for size in [8_000, 20_000, 4_000_000] {
            let outline = around(size);
            assert!(are_apart(std::slice::from_ref(&outline)), "{size}");
            for index in 0..outline.len() {
                // To the next corner, a part of the way back, and on.
                let (from, to) = (outline[index], outline[(index + 1) % outline.len()]);
                let part = |a: i32, b: i32| b + (a - b) / 3 * 2;
                let mut spiked = outline.clone();
                let back = (part(from.0, to.0), part(from.1, to.1));
                // Exactly on the edge, which goes on to three times as far.
                let on = (back.0 + (back.0 - from.0) * 2, back.1 + (back.1 - from.1) * 2);
                spiked.splice(index + 1..index + 1, [on, back]);
                assert!(!are_apart(&[spiked]), "{size}: {index}");
            }
        }
    }

    #[test]
    fn random_outlines_are_told_apart() {
        let mut seed = 7_u32;
        let mut random = |limit: i32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as i32 % limit
        };
        let (mut simple, mut others, mut missed, mut all_apart) = (0, 0, 0, 0);
        for round in 0..30_000 {
            // Small numbers, so that corners meet and lie on edges.
            let (size, step) = (6 + round % 9, [100, 517, 1024][round as usize / 9 % 3]);
            let outlines: Vec<Outline> = (0..1 + round % 3)
                .map(|_| (0..3 + random(4)).map(|_| (random(size) * step, random(size) * step)).collect())
                .collect();
            let found = found(&outlines).unwrap();
            let apart = are_apart(&outlines);
            all_apart += usize::from(apart);
            let strips = 0..=((size * step) >> STRIP_SHIFT);
            let truth: Option<Vec<bool>> = strips.map(|strip| winds_once(&outlines, strip)).collect();
            match truth.map(|strips| strips.iter().all(|once| *once)) {
                Some(true) if found => simple += 1,
                Some(true) => missed += 1,
                Some(false) => {
                    assert!(!found && !apart, "{outlines:?}");
                    others += 1;
                }
                None => {}
            }
        }
        // Outlines that touch may be missed.
        assert!(
            simple > 2_000 && others > 10_000 && missed * 10 < simple && all_apart > 2_000,
            "{simple} {others} {missed} {all_apart}"
        );
    }
}
