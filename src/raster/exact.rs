//! Exact coverage where outlines cross.
//!
//! Sums of areas are coverage as long as windings are 0 and 1. Where they are not, edges are cut where they cross each
//! other, and of the pieces those are kept that have the inside on one side and the outside on the other, each going the
//! way that winds around the inside once. What is then drawn are edges as any others.
//!
//! Outlines are swept from top to bottom, from one height at which an edge starts, ends or crosses another to the next. Between
//! two of them (a *scanbeam*, after Vatti, *A generic solution to polygon clipping*, 1992) edges have an order from left to right;
//! by the windings between them the fill rule says of each whether it bounds the inside. At a height only those
//! are looked at that something happens to, and their neighbours.
//!
//! Crossings are rounded to 1/256 pixel, as corners are. The order is that in the middle between two such heights, and windings
//! are counted along it, so that they always add up: what rounding may change is some 2^-17 of a pixel, never a row.

use fearless_simd::i32x8;
use fearless_simd::prelude::*;

use super::edge::FixedPoint;
use super::simple::Side;
use crate::num::lanes::round_f64;
use crate::style::FillRule;

/// After so many looks at edges in all, and so many for each corner, outlines stay as they are: at such density, what
/// is inside of them no longer shows.
const LOOKS: usize = 1 << 21;
const LOOKS_PER_CORNER: usize = 128;

/// Where nothing happens.
const NEVER: i32 = i32::MAX;

/// Working memory, and the pieces of the shape in work.
#[derive(Debug, Default)]
pub(super) struct Resolver {
    active: Row,
    /// The height at which each of them ends or crosses the next one.
    next: Vec<i32>,
    touched: Touched,
    /// How many looks are left.
    looks: usize,
    /// Where each piece starts and ends.
    pieces: Vec<[FixedPoint; 2]>,
}

/// An edge that the scanbeam in work crosses. Heights and x in 1/256 pixel.
#[derive(Clone, Copy, Debug)]
struct Active {
    /// The edge, and how to go on from it.
    side: Side,
    /// The change of x per unit of y.
    slope: f64,
    winding: i32,
    /// The winding left of it.
    left: i32,
    /// How it winds around the inside from the height `since` on: 1 or -1, or 0 where it does not bound it.
    bounds: i32,
    since: i32,
}

/// How many heights come before the first that is `y`.
#[inline(always)]
fn first_at<S: Simd>(simd: S, heights: &[i32], y: i32) -> usize {
    let (eights, rest) = heights.as_chunks::<8>();
    for (index, eight) in eights.iter().enumerate() {
        let here = i32x8::load_array_ref(simd, eight).simd_eq(y).to_bitmask() as u32;
        if here != 0 {
            return 8 * index + here.trailing_zeros() as usize;
        }
    }
    8 * eights.len() + rest.iter().position(|height| *height == y).unwrap_or(rest.len())
}

/// The active edges from left to right, and where each of them is kept: order changes all the time, and moves numbers alone.
#[derive(Debug, Default)]
struct Row {
    order: Vec<u32>,
    edges: Vec<Active>,
    /// Places in `edges` of such as have left.
    free: Vec<u32>,
}

impl Row {
    fn clear(&mut self) {
        self.order.clear();
        self.edges.clear();
        self.free.clear();
    }

    #[inline(always)]
    fn len(&self) -> usize {
        self.order.len()
    }

    #[inline(always)]
    fn get(&self, index: usize) -> Option<&Active> {
        self.edges.get(*self.order.get(index)? as usize)
    }

    #[inline(always)]
    fn get_mut(&mut self, index: usize) -> Option<&mut Active> {
        self.edges.get_mut(*self.order.get(index)? as usize)
    }

    #[inline(always)]
    fn insert(&mut self, index: usize, edge: Active) {
        let place = match self.free.pop() {
            Some(place) => {
                if let Some(old) = self.edges.get_mut(place as usize) {
                    *old = edge;
                }
                place
            }
            None => {
                self.edges.push(edge);
                self.edges.len() as u32 - 1
            }
        };
        self.order.insert(index, place);
    }

    /// The first edge of which `is_left` does not hold, which holds of all before it.
    #[inline(always)]
    fn partition_point(&self, is_left: impl Fn(&Active) -> bool) -> usize {
        self.order.partition_point(|place| self.edges.get(*place as usize).is_some_and(&is_left))
    }
}

/// Active edges side by side to which something happens: from the first to the last.
#[derive(Clone, Copy, Debug)]
struct Range {
    first: usize,
    last: usize,
}

/// All of those at one height. Many things happen at once, but far from each other.
#[derive(Debug, Default)]
struct Touched {
    ranges: Vec<Range>,
}

impl Touched {
    /// Adds an edge that lies right of those added before, or is next to them.
    #[inline(always)]
    fn add(&mut self, index: usize) {
        match self.ranges.last_mut() {
            Some(range) if index <= range.last + 1 => {
                range.first = range.first.min(index);
                range.last = range.last.max(index);
            }
            _ => self.ranges.push(Range { first: index, last: index }),
        }
    }

    /// Adds an edge that was put in before the edge that was number `index`.
    #[inline(always)]
    fn add_new(&mut self, index: usize) {
        for range in &mut self.ranges {
            range.first += usize::from(range.first >= index);
            range.last += usize::from(range.last >= index);
        }
        self.ranges.push(Range { first: index, last: index });
    }

    /// Puts ranges in order, and those together that meet.
    #[inline(always)]
    fn merge(&mut self) {
        if !self.ranges.is_sorted_by(|a, b| a.last + 1 < b.first) {
            self.ranges.sort_unstable_by_key(|range| range.first);
            self.ranges.dedup_by(|next, range| {
                let meets = next.first <= range.last + 1;
                if meets {
                    range.last = range.last.max(next.last);
                }
                meets
            });
        }
    }
}

impl Active {
    #[inline(always)]
    fn new(side: Side) -> Self {
        let winding = if side.forwards { 1 } else { -1 };
        Self { side, slope: slope(side), winding, left: 0, bounds: 0, since: side.from.y }
    }

    /// x at half of a height.
    #[inline(always)]
    fn x_at(&self, half: i32) -> f64 {
        f64::from(self.side.from.x) + self.slope * (0.5 * f64::from(half - 2 * self.side.from.y))
    }

    /// The point at a height.
    #[inline(always)]
    fn point(&self, y: i32) -> FixedPoint {
        if y == self.side.to.y { self.side.to } else { FixedPoint { x: round_f64(self.x_at(2 * y)), y } }
    }

    #[inline(always)]
    fn leftmost(&self) -> i32 {
        self.side.from.x.min(self.side.to.x)
    }

    #[inline(always)]
    fn rightmost(&self) -> i32 {
        self.side.from.x.max(self.side.to.x)
    }

    /// Whether it shares no column with those beside it: it then stays where it is.
    #[inline(always)]
    fn is_alone(&self, before: Option<&Self>, after: Option<&Self>) -> bool {
        before.is_none_or(|before| before.rightmost() < self.leftmost())
            && after.is_none_or(|after| self.rightmost() < after.leftmost())
    }

    /// Ends the piece in work at `y`.
    #[inline(always)]
    fn finish(&mut self, y: i32, pieces: &mut Vec<[FixedPoint; 2]>) {
        if self.bounds != 0 && self.since < y {
            let (start, end) = (self.point(self.since), self.point(y));
            pieces.push(if self.bounds > 0 { [start, end] } else { [end, start] });
        }
        self.since = y;
    }

    /// Goes on to the edge below; false where there is none.
    #[inline(always)]
    fn advance(&mut self, points: &[FixedPoint]) -> bool {
        let more = self.side.advance(points);
        if more {
            self.slope = slope(self.side);
        }
        more
    }

    /// Where this edge crosses one that is right of it just below `y`; at least 1/256 pixel further down.
    #[inline(always)]
    fn crossing(&self, other: &Self, y: i32) -> i32 {
        let bottom = self.side.to.y.min(other.side.to.y);
        if self.rightmost() <= other.leftmost() || bottom - y < 2 {
            return NEVER;
        }
        let overlap = self.x_at(2 * bottom - 1) - other.x_at(2 * bottom - 1);
        if overlap <= 0.0 {
            return NEVER;
        }
        let gap = other.x_at(2 * y + 1) - self.x_at(2 * y + 1);
        y + 1 + (f64::from(bottom - y - 1) * (gap / (gap + overlap))) as i32
    }
}

#[inline(always)]
fn slope(side: Side) -> f64 {
    f64::from(side.to.x - side.from.x) / f64::from(side.to.y - side.from.y)
}

impl Resolver {
    /// Finds the pieces that bound the inside of a shape. `sides` are those of its outlines, whose corners are `points`, in the
    /// order of their tops. False where sums of areas are coverage, or where it takes too long to find out.
    #[inline(never)]
    pub(super) fn resolve<S: Simd>(&mut self, simd: S, points: &[FixedPoint], sides: &[Side], rule: FillRule) -> bool {
        let found = simd.vectorize(
            #[inline(always)]
            || match rule {
                FillRule::NonZero => self.sweep::<S, false>(simd, points, sides),
                FillRule::EvenOdd => self.sweep::<S, true>(simd, points, sides),
            },
        );
        found.unwrap_or(false)
    }

    /// The pieces: from where to where each goes.
    pub(super) fn pieces(&self) -> &[[FixedPoint; 2]] {
        &self.pieces
    }

    /// Whether edges had to be cut, left out or turned round; `None` where that takes too long.
    #[inline(always)]
    fn sweep<S: Simd, const EVEN_ODD: bool>(&mut self, simd: S, points: &[FixedPoint], sides: &[Side]) -> Option<bool> {
        self.active.clear();
        self.next.clear();
        self.pieces.clear();
        let mut coming = sides;
        self.looks = LOOKS + LOOKS_PER_CORNER * points.len();
        // Whether all edges bound the inside as they are, or all the other way round.
        let (mut same, mut reversed) = (true, true);
        loop {
            let start = coming.first().map_or(NEVER, |side| side.from.y);
            let event = self.next.iter().fold(NEVER, |first, next| first.min(*next));
            let y = start.min(event);
            if y == NEVER {
                break;
            }
            self.touched.ranges.clear();
            if event == y {
                self.go_on(simd, points, y);
                self.arrange(y);
            }
            while let [side, rest @ ..] = coming
                && side.from.y == y
            {
                self.insert(*side);
                coming = rest;
            }
            self.spend(1 + self.active.len() / 8);
            self.touched.merge();
            for index in 0..self.touched.ranges.len() {
                let Some(range) = self.touched.ranges.get(index).copied() else { break };
                self.spend(3 + range.last - range.first);
                self.look_ahead(y, range);
                self.apply::<EVEN_ODD>(y, range, &mut same, &mut reversed);
            }
            if self.looks == 0 {
                return None;
            }
        }
        Some(!same && !reversed)
    }

    /// Counts looks.
    #[inline(always)]
    fn spend(&mut self, looks: usize) {
        self.looks = self.looks.saturating_sub(looks);
    }

    /// Goes on from edges that end at `y`.
    #[inline(always)]
    fn go_on<S: Simd>(&mut self, simd: S, points: &[FixedPoint], y: i32) {
        let Self { active, next, pieces, touched, .. } = self;
        let (mut index, mut kept) = (0_usize, 0_usize);
        while index < active.len() {
            // Mostly nothing happens to many side by side.
            let run = first_at(simd, next.get(index..).unwrap_or(&[]), y);
            if run > 0 {
                if kept < index {
                    active.order.copy_within(index..index + run, kept);
                    next.copy_within(index..index + run, kept);
                }
                (index, kept) = (index + run, kept + run);
                continue;
            }
            if let Some(edge) = active.get_mut(index) {
                let (mut is_alone, mut last) = (false, kept + 1);
                if edge.side.to.y == y {
                    edge.finish(y, pieces);
                    if !edge.advance(points) {
                        touched.add(kept.saturating_sub(1));
                        touched.add(kept);
                        active.free.extend(active.order.get(index));
                        index += 1;
                        continue;
                    }
                    let edge = *edge;
                    let before = kept.checked_sub(1).and_then(|before| active.get(before));
                    is_alone = edge.is_alone(before, active.get(index + 1));
                    last = kept;
                    if let Some(event) = next.get_mut(index) {
                        *event = edge.side.to.y;
                    }
                }
                if !is_alone {
                    touched.add(kept);
                    touched.add(last);
                }
            }
            if kept < index {
                active.order.copy_within(index..=index, kept);
                next.copy_within(index..=index, kept);
            }
            (index, kept) = (index + 1, kept + 1);
        }
        active.order.truncate(kept);
        next.truncate(kept);
    }

    /// Puts the touched edges in their order just below `y`.
    #[inline(always)]
    fn arrange(&mut self, y: i32) {
        for number in 0..self.touched.ranges.len() {
            let Some(mut range) = self.touched.ranges.get(number).copied() else { break };
            self.arrange_range(y, &mut range);
            if let Some(arranged) = self.touched.ranges.get_mut(number) {
                *arranged = range;
            }
        }
    }

    #[inline(always)]
    fn arrange_range(&mut self, y: i32, range: &mut Range) {
        let half = 2 * y + 1;
        let mut index = range.first.max(1);
        while let (Some(before), Some(edge)) = (self.active.get(index - 1), self.active.get(index)) {
            let x = edge.x_at(half);
            if before.x_at(half) > x {
                let is_left = |place: &usize| self.active.get(*place).is_none_or(|other| other.x_at(half) <= x);
                let place = (0..index - 1).rev().find(is_left).map_or(0, |place| place + 1);
                // Mostly two change places.
                self.spend(index - place);
                if self.looks == 0 {
                    return;
                }
                if let Some(moved) = self.active.order.get_mut(place..=index) {
                    moved.rotate_right(1);
                }
                range.first = range.first.min(place);
                range.last = range.last.max(index);
            } else if index > range.last {
                break;
            }
            index += 1;
        }
    }

    /// Puts an edge that starts among those that are in order.
    #[inline(always)]
    fn insert(&mut self, side: Side) {
        let edge = Active::new(side);
        let half = 2 * side.from.y + 1;
        let x = edge.x_at(half);
        let place = self.active.partition_point(|other| other.x_at(half) <= x);
        self.spend((self.active.len() - place) / 8);
        self.active.insert(place, edge);
        self.next.insert(place, NEVER);
        self.touched.add_new(place);
    }

    /// Finds what happens next to the touched edges and the one left of them.
    #[inline(always)]
    fn look_ahead(&mut self, y: i32, touched: Range) {
        let first = touched.first.saturating_sub(1);
        let nexts = self.next.get_mut(first..).unwrap_or(&mut []);
        for (index, next) in (first..=touched.last).zip(nexts) {
            let Some(edge) = self.active.get(index) else { break };
            let crossing = self.active.get(index + 1).map_or(NEVER, |other| edge.crossing(other, y));
            *next = edge.side.to.y.min(crossing);
        }
    }

    /// Applies the fill rule to the windings between the edges from `y` on.
    #[inline(always)]
    fn apply<const EVEN_ODD: bool>(&mut self, y: i32, touched: Range, same: &mut bool, reversed: &mut bool) {
        let is_inside = |winding: i32| if EVEN_ODD { winding & 1 } else { (winding != 0) as i32 };
        let before = touched.first.checked_sub(1).and_then(|index| self.active.get(index));
        let mut winding = before.map_or(0, |edge| edge.left + edge.winding);
        let mut inside = is_inside(winding);
        let Self { active: Row { order, edges, .. }, pieces, .. } = self;
        for (index, place) in order.iter().enumerate().skip(touched.first) {
            let Some(edge) = edges.get_mut(*place as usize) else { break };
            if index > touched.last && edge.left == winding {
                break;
            }
            edge.left = winding;
            winding += edge.winding;
            let right = is_inside(winding);
            let bounds = right - inside;
            inside = right;
            *same &= bounds == edge.winding;
            *reversed &= bounds == -edge.winding;
            if bounds != edge.bounds {
                edge.finish(y, pieces);
                edge.bounds = bounds;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::raster::batch::add_edges;
    use crate::raster::bins::Edges;
    use crate::raster::cell::{Accumulator, FULL};
    use crate::raster::simple::Simplicity;

    const WIDTH: usize = 64;

    /// Numbers below `end` (SplitMix64).
    struct Random(u64);

    impl Random {
        fn below(&mut self, end: i32) -> i32 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) % end as u64) as i32
        }
    }

    /// How much of each pixel of two strips is inside outlines, by scanlines in the middles of all 1/256 pixels.
    fn scanned(outlines: &[Vec<FixedPoint>], rule: FillRule) -> Vec<f64> {
        let mut covered = vec![0.0; WIDTH * 16];
        for scanline in 0..16 * 256 {
            let y = f64::from(scanline) + 0.5;
            let mut crossings = Vec::new();
            for pair in outlines.iter().flat_map(|outline| outline.windows(2)) {
                let [a, b] = [pair[0], pair[1]].map(|p| (f64::from(p.x), f64::from(p.y)));
                if (a.1 < y) != (b.1 < y) {
                    crossings.push((a.0 + (b.0 - a.0) * (y - a.1) / (b.1 - a.1), if a.1 < b.1 { 1 } else { -1 }));
                }
            }
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut winding = 0;
            for pair in crossings.windows(2) {
                winding += pair[0].1;
                let inside = match rule {
                    FillRule::NonZero => winding != 0,
                    FillRule::EvenOdd => winding % 2 != 0,
                };
                for column in 0..WIDTH {
                    let (left, right) = (column as f64 * 256.0, column as f64 * 256.0 + 256.0);
                    if inside {
                        let part = (pair[1].0.min(right) - pair[0].0.max(left)).max(0.0);
                        covered[scanline as usize / 256 * WIDTH + column] += part / 65_536.0;
                    }
                }
            }
        }
        covered
    }

    /// The pieces that bound outlines.
    fn pieces_of(outlines: &[Vec<FixedPoint>], rule: FillRule) -> Option<Vec<FixedPoint>> {
        let points: Vec<FixedPoint> = outlines.concat();
        let ends = outlines.iter().scan(0, |end, outline| {
            *end += outline.len();
            Some(*end)
        });
        let ends: Vec<usize> = ends.collect();
        let mut simplicity = Simplicity::default();
        assert_ne!(simplicity.sweep_outlines(&points, &ends), None);
        let found = SimdLevel::available().into_iter().map(|level| {
            let mut resolver = Resolver::default();
            let found = dispatch!(level, simd => resolver.resolve(simd, &points, simplicity.sides(), rule));
            found.then(|| resolver.pieces().concat())
        });
        let found: Vec<_> = found.collect();
        assert!(found.windows(2).all(|pair| pair[0] == pair[1]), "levels differ");
        found.into_iter().next().unwrap()
    }

    /// How much of each pixel is inside by summed areas of the pieces.
    fn resolved(level: SimdLevel, outlines: &[Vec<FixedPoint>], rule: FillRule) -> Vec<f64> {
        let mut points: Vec<FixedPoint> = outlines.concat();
        let mut starts = Vec::new();
        let mut first = 0;
        for outline in outlines {
            starts.extend(first..first + outline.len() as u32 - 1);
            first += outline.len() as u32;
        }
        if let Some(pieces) = pieces_of(outlines, rule) {
            starts = (0..pieces.len() as u32).step_by(2).collect();
            points = pieces;
        }
        let mut cells = Accumulator::default();
        cells.resize(WIDTH, 2);
        dispatch!(level, simd => add_edges(simd, &mut cells, Edges::of(&points, &starts), 0, 2, &[]));
        let mut covered = Vec::new();
        for row in 0..16 {
            let mut sum = 0;
            for column in &cells.strip(row / 8).unwrap().columns[..WIDTH] {
                sum += column.0[row % 8];
                // Outlines that are drawn as they are may all go the other way.
                covered.push((f64::from(sum) / f64::from(FULL)).abs());
            }
        }
        covered
    }

    fn compare(outlines: &[Vec<FixedPoint>], what: &str) {
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let expected = scanned(outlines, rule);
            for level in SimdLevel::available() {
                let found = resolved(level, outlines, rule);
                for (index, (expected, found)) in expected.iter().zip(&found).enumerate() {
                    let place = (index % WIDTH, index / WIDTH);
                    assert!((expected - found).abs() < 0.008, "{what}, {rule:?}, {place:?}: {found}, not {expected}");
                }
            }
        }
    }

    fn closed(points: impl IntoIterator<Item = (i32, i32)>) -> Vec<FixedPoint> {
        let mut outline: Vec<FixedPoint> = points.into_iter().map(|(x, y)| FixedPoint { x, y }).collect();
        outline.push(outline[0]);
        outline
    }

    #[test]
    fn outlines_that_cross_are_covered_as_by_scanlines() {
        let mut random = Random(1);
        for round in 0..60 {
            let outlines: Vec<_> = (0..1 + round % 3)
                .map(|_| {
                    let corners = 3 + random.below(12);
                    closed((0..corners).map(|_| (random.below(60 * 256), random.below(16 * 256))))
                })
                .collect();
            compare(&outlines, &format!("round {round}"));
        }
    }

    /// Corners on few places: level and upright edges, edges that lie on each other, crossings in corners.
    #[test]
    fn outlines_that_meet_and_lie_on_each_other_are_covered_as_by_scanlines() {
        let mut random = Random(2);
        for round in 0..120 {
            let outlines: Vec<_> = (0..1 + round % 4)
                .map(|_| {
                    let corners = 3 + random.below(6);
                    closed((0..corners).map(|_| (random.below(5) * 640 + 100, random.below(9) * 512)))
                })
                .collect();
            compare(&outlines, &format!("round {round}"));
        }
    }

    #[test]
    fn what_is_between_level_edges_is_inside_where_they_are_far_apart() {
        let frame = |left, top, right, bottom| closed([(left, top), (right, top), (right, bottom), (left, bottom)]);
        compare(&[frame(300, 700, 15_000, 3000), frame(900, 1000, 14_000, 2600)], "frames");
        compare(&[frame(300, 700, 15_000, 3000), frame(14_000, 1000, 900, 2600)], "a hole");
    }

    #[test]
    fn outlines_whose_areas_are_coverage_stay_as_they_are() {
        let frame = |left, top, right, bottom| closed([(left, top), (right, top), (right, bottom), (left, bottom)]);
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            assert_eq!(pieces_of(&[frame(300, 700, 9000, 3000)], rule), None);
            assert_eq!(pieces_of(&[frame(9000, 700, 300, 3000)], rule), None);
            assert_eq!(pieces_of(&[frame(300, 700, 9000, 3000), frame(8000, 1000, 900, 2600)], rule), None);
        }
        // Of one in another, by the nonzero rule, the outer is left; of two that overlap, what is inside goes.
        let nested = pieces_of(&[frame(300, 700, 9000, 3000), frame(900, 1000, 8000, 2600)], FillRule::NonZero);
        assert_eq!(nested.map(|pieces| pieces.len()), Some(4));
        let overlapping = pieces_of(&[frame(0, 0, 512, 1024), frame(256, 512, 768, 2048)], FillRule::NonZero).unwrap();
        let mut upright: Vec<_> = overlapping.as_chunks::<2>().0.iter().map(|[a, b]| (a.x, a.y, b.y)).collect();
        upright.sort_unstable();
        assert_eq!(upright, [(0, 0, 1024), (256, 1024, 2048), (512, 512, 0), (768, 2048, 512)]);
    }

    /// Thousands of lines that all cross in one point, and a comb whose teeth all start at one height beside long lines.
    #[test]
    fn many_edges_at_one_height_end_soon() {
        let star = closed((0..4001).map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) * 2000.0 / 4001.0;
            let [x, y] = [libm::cos(angle), libm::sin(angle)].map(|v| (v * 4e6) as i32 + 5_000_000);
            (x, y)
        }));
        let teeth = |left: i32, top: i32| {
            closed((0..20_000).map(|i| (left + 64 * i, if i % 2 == 0 { 9_000_000 } else { top })))
        };
        pieces_of(&[star], FillRule::EvenOdd);
        pieces_of(&[teeth(2_000_000, 0), teeth(0, 5000)], FillRule::NonZero);
    }

    #[test]
    fn what_is_too_dense_stays_as_it_is() {
        let mut random = Random(3);
        let outline = closed((0..8000).map(|_| (random.below(60 * 256), random.below(16 * 256))));
        assert_eq!(pieces_of(&[outline], FillRule::NonZero), None);
    }
}
