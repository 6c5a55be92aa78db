//! Exact coverage where outlines cross.
//!
//! Sums of areas are coverage as long as windings are 0 and 1. Where they are not, edges are cut where they cross each
//! other, and of the pieces those are kept that have the inside on one side and the outside on the other, each going the
//! way that winds around the inside once. What is then drawn are edges as any others.
//!
//! Edges that may meet are found by their boxes ([`boxes`](super::boxes)); which of them cross, by the sides on which corners lie
//! ([`orientation`](super::orientation), where ties are broken). How often outlines wind left of an edge is counted once for each
//! outline, at its leftmost corner, or at its first where it turns one way and crosses nothing; along the outline it changes by one at each crossing.
//! What is kept are parts of outlines, in their order.
//!
//! Crossings are rounded to 1/256 pixel, as corners are; exactly, so that where three edges cross in one point all agree on it. Along an edge
//! they are put in order exactly as well. Kept pieces thus always close: what rounding may change is some 2^-17 of a pixel, never a row.

use core::cmp::Ordering;
use core::ops::Range;

use fearless_simd::Simd;

use super::boxes::{Bounds, Boxes, FEW, Numbers};
use super::edge::{FixedPoint, append_eights};
use super::orientation::{Corner, Ends, area, areas, is_right_of};
use super::star::Way;
use crate::num::lanes::round_f64;
use crate::path::polygons::Polygons;
use crate::style::FillRule;

/// After so many looks at boxes in all, and so many for each corner, outlines stay as they are.
const LOOKS: usize = 1 << 19;
const LOOKS_PER_CORNER: usize = 16;

/// Where edges cross more often, outlines stay as they are: at such density, what is inside of them no longer shows.
const CROSSINGS: usize = 1 << 16;
const CROSSINGS_PER_CORNER: usize = 4;
const MOST_CROSSINGS: usize = 1 << 17;

/// Outlines of more corners are not looked at: what crosses itself so often does so everywhere, and memory matters.
pub(super) const MOST_CORNERS: usize = 1 << 20;

/// No crossing.
const NONE: u32 = u32::MAX;

/// A closed outline: the numbers of its first corner and of the last one, which is the first once more.
#[derive(Clone, Copy, Debug)]
struct Outline {
    first: u32,
    last: u32,
    /// Its first node of boxes, and the first of the next outline.
    nodes: [usize; 2],
    around: Bounds,
    /// Which way it turns, if that is known.
    way: Option<Way>,
    /// Whether an edge crosses another.
    crosses: bool,
    /// A corner, and how often outlines wind left of where it starts from there.
    start: u32,
    left: i32,
}

/// Where an edge crosses another.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    /// The part of the edge that lies before it, rounded.
    part: f64,
    place: FixedPoint,
    other: Numbers,
    /// By how much the windings beside the edge change.
    change: i32,
    /// The edge's next crossing, in no order.
    next: u32,
}

/// What bounds the inside of polygons.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Resolved {
    /// Their outlines as they are, of which the corners were appended to those that were there.
    Outlines,
    /// Pieces of them.
    Pieces,
    /// It would take too long to find out.
    Unknown,
}

/// Working memory, and the pieces of the shape in work.
#[derive(Debug, Default)]
pub(super) struct Resolver {
    outlines: Vec<Outline>,
    boxes: Boxes,
    crossings: Vec<Crossing>,
    /// For each edge, by the number of its first corner, one of its crossings.
    first: Vec<u32>,
    /// Those of the edge in work: their parts as bits, and their numbers.
    along: Vec<(u64, u32)>,
    pieces: Pieces,
}

/// Polylines that bound the inside.
#[derive(Debug, Default)]
struct Pieces {
    points: Vec<FixedPoint>,
    /// Where each of them ends.
    ends: Vec<u32>,
    /// Where the one in work starts, and how it bounds the inside; 0 where there is none.
    start: usize,
    way: i32,
}

impl Resolver {
    /// Finds what bounds the inside of polygons, whose corners lie within a million pixels.
    #[inline(never)]
    pub(super) fn resolve<S: Simd>(
        &mut self,
        simd: S,
        polygons: &Polygons,
        rule: FillRule,
        corners: &mut Vec<FixedPoint>,
    ) -> Resolved {
        simd.vectorize(
            #[inline(always)]
            || {
                let start = corners.len();
                self.list(simd, polygons, corners);
                let resolved = self.resolve_listed(simd, rule, corners.get(start..).unwrap_or(&[]));
                if resolved != Resolved::Outlines {
                    corners.truncate(start);
                }
                resolved
            },
        )
    }

    #[inline(always)]
    fn resolve_listed<S: Simd>(&mut self, simd: S, rule: FillRule, corners: &[FixedPoint]) -> Resolved {
        if !self.find_crossings(simd, corners) {
            return Resolved::Unknown;
        }
        // One that does not cross itself winds around its inside once.
        if self.outlines.len() <= 1 && self.crossings.is_empty() {
            return Resolved::Outlines;
        }
        if self.find_windings(simd, corners).is_none() {
            return Resolved::Unknown;
        }
        match rule {
            FillRule::NonZero => self.keep::<false>(corners),
            FillRule::EvenOdd => self.keep::<true>(corners),
        }
    }

    /// Where the outlines' corners are, each with the first one once more at its end, of those that were appended.
    pub(super) fn outlines(&self) -> impl Iterator<Item = Range<usize>> {
        self.outlines.iter().map(|outline| outline.first as usize..outline.last as usize + 1)
    }

    /// The pieces: polylines, each from its first to its last point. They have the inside on one side all.
    pub(super) fn pieces(&self) -> impl Iterator<Item = &[FixedPoint]> {
        let mut start = 0;
        self.pieces.ends.iter().filter_map(move |end| {
            let end = *end as usize;
            let piece = self.pieces.points.get(start..end);
            start = end;
            piece
        })
    }

    /// The number of points of all pieces.
    pub(super) fn len(&self) -> usize {
        self.pieces.points.len()
    }

    /// Lists corners, and boxes around edges. Corners that follow themselves are left out, as are outlines of fewer than three, whose area is 0.
    #[inline(always)]
    fn list<S: Simd>(&mut self, simd: S, polygons: &Polygons, corners: &mut Vec<FixedPoint>) {
        let Self { outlines, boxes, .. } = self;
        outlines.clear();
        boxes.clear();
        let start = corners.len();
        for (eights, count) in polygons.iter_eights() {
            let (start_of_this, node) = (corners.len(), boxes.len());
            let first = (start_of_this - start) as u32;
            let mut count = append_eights(simd, eights, count, corners);
            // Called in one place, so that it is inlined.
            let mut have_length = true;
            let around = loop {
                let own = corners.get(start_of_this..).unwrap_or(&[]);
                let around = boxes.add(simd, own, count - 1, first);
                if around.is_some() || !have_length {
                    break around;
                }
                (count, have_length) = (leave_out_repeated(corners, start_of_this, count), false);
            };
            let Some((around, way)) = around.filter(|_| count >= 4) else {
                corners.truncate(start_of_this);
                boxes.truncate(node);
                continue;
            };
            corners.truncate(start_of_this + count);
            let (last, nodes) = (first + count as u32 - 1, [node, boxes.len()]);
            outlines.push(Outline { first, last, nodes, around, way, crosses: false, start: first, left: 0 });
        }
        boxes.build(simd);
    }

    /// Finds where edges cross; false where that takes too long.
    #[inline(always)]
    fn find_crossings<S: Simd>(&mut self, simd: S, corners: &[FixedPoint]) -> bool {
        let Self { boxes, crossings, first, .. } = self;
        crossings.clear();
        first.clear();
        let mut looks = LOOKS + LOOKS_PER_CORNER * corners.len();
        // Each is kept for either edge.
        let most = 2 * MOST_CROSSINGS.min(CROSSINGS + CROSSINGS_PER_CORNER * corners.len());
        boxes.for_pairs(
            simd,
            &mut looks,
            #[inline(always)]
            |edge, other| {
                let ends = [ends_of(corners, edge), ends_of(corners, other)];
                if let [Some(ends), Some(others)] = ends
                    && let Some((place, both)) = cross(ends, others)
                {
                    if first.is_empty() {
                        first.resize(corners.len(), NONE);
                    }
                    let [(part, change), (other_part, other_change)] = both;
                    let number = crossings.len() as u32;
                    let mut put = |[edge, _]: Numbers, number: u32| {
                        first.get_mut(edge as usize).map_or(NONE, |head| core::mem::replace(head, number))
                    };
                    let (next, other_next) = (put(edge, number), put(other, number + 1));
                    crossings.extend_from_slice(&[
                        Crossing { part, place, other, change, next },
                        Crossing { part: other_part, place, other: edge, change: other_change, next: other_next },
                    ]);
                }
                crossings.len() < most
            },
        )
    }

    /// Counts how often outlines wind beside a corner of each; `None` where that takes too long.
    #[inline(always)]
    fn find_windings<S: Simd>(&mut self, simd: S, corners: &[FixedPoint]) -> Option<()> {
        let Self { outlines, boxes, first, .. } = self;
        let mut looks = LOOKS + LOOKS_PER_CORNER * corners.len();
        for index in 0..outlines.len() {
            let Outline { first: start, last, nodes: [node, end], around, way, .. } = *outlines.get(index)?;
            let edges = start as usize..last as usize;
            let crosses = first.get(edges).is_some_and(|first| first.iter().any(|first| *first != NONE));
            let (place, way) = match way.filter(|_| !crosses) {
                Some(way) => (corner(corners, start)?, way),
                // At its leftmost corner an outline turns to where it has its inside.
                None => {
                    let place = corner(corners, boxes.leftmost(simd, node..end, around, corners)?)?;
                    let before = corner(corners, if place.number == start { last - 1 } else { place.number - 1 })?;
                    let after = corner(corners, if place.number + 1 == last { start } else { place.number + 1 })?;
                    let turns_right = is_right_of([before, place], after, area([before, place], after));
                    (place, if turns_right { Way::Right } else { Way::Left })
                }
            };
            let mut outside = 0;
            let mut pass = |edge: Numbers| {
                if !(start..last).contains(&edge[0]) {
                    outside += winding_right_of(corners, edge, place);
                }
            };
            // As few outlines as nodes: each is asked by itself, if its box is around the corner. Most are not.
            if outlines.len() <= FEW {
                let (mut others, point) = (0_u32, Bounds::of(place.point));
                for (other, outline) in outlines.iter().enumerate() {
                    others |= u32::from(outline.around.contains(simd, &point)) << other;
                }
                others &= !(1 << index);
                while others != 0 {
                    let [node, end] = outlines.get(others.trailing_zeros() as usize)?.nodes;
                    others &= others - 1;
                    looks = looks.checked_sub(boxes.for_left_of_in(simd, node..end, place.point, &mut pass))?;
                }
            } else if !boxes.for_left_of(simd, place.point, &mut looks, &mut pass) {
                return None;
            }
            let outline = outlines.get_mut(index)?;
            (outline.crosses, outline.start) = (crosses, place.number);
            outline.left = if way == Way::Right { outside } else { outside + 1 };
        }
        Some(())
    }

    /// Keeps the pieces that bound the inside, unless all do.
    #[inline(always)]
    fn keep<const EVEN_ODD: bool>(&mut self, corners: &[FixedPoint]) -> Resolved {
        let Self { outlines, crossings, first, along, pieces, .. } = self;
        let bounds = bounds::<EVEN_ODD>;
        let is = |way: i32| outlines.iter().all(|outline| !outline.crosses && bounds(outline.left) == way);
        if is(1) || is(-1) {
            return Resolved::Outlines;
        }
        pieces.clear();
        for outline in outlines {
            let (edges, start) = (outline.first as usize..outline.last as usize, outline.start as usize);
            let mut left = outline.left;
            // From where the winding is known to the end, and from the first corner on.
            for part in [start..edges.end, edges.start..start] {
                let mut from = part.start;
                if !outline.crosses {
                    pieces.follow(corners.get(from..=part.end).unwrap_or(&[]), bounds(left));
                    continue;
                }
                while from < part.end {
                    // Up to the next edge that crosses another.
                    let heads = first.get(from..part.end).unwrap_or(&[]);
                    let run = heads.iter().position(|first| *first != NONE).unwrap_or(heads.len());
                    if run > 0 {
                        pieces.follow(corners.get(from..=from + run).unwrap_or(&[]), bounds(left));
                        from += run;
                        continue;
                    }
                    let next = if from + 1 == edges.end { edges.start } else { from + 1 };
                    let head = heads.first().copied().unwrap_or(NONE);
                    list_along(corners, crossings, [from as u32, next as u32], head, along);
                    let Some([start, end]) = corners.get(from..).and_then(|corners| corners.first_chunk()) else {
                        break;
                    };
                    let mut last = *start;
                    for (_, number) in &*along {
                        let Some(crossing) = crossings.get(*number as usize) else { break };
                        pieces.step(last, crossing.place, bounds(left));
                        last = crossing.place;
                        left += crossing.change;
                    }
                    pieces.step(last, *end, bounds(left));
                    from += 1;
                }
            }
        }
        pieces.finish();
        Resolved::Pieces
    }
}

/// How an edge with such a winding left of it bounds the inside: 1 where it lies left, -1 where right, 0 where on both sides or none.
#[inline(always)]
fn bounds<const EVEN_ODD: bool>(left: i32) -> i32 {
    if EVEN_ODD { if left & 1 == 0 { -1 } else { 1 } } else { (left == 1) as i32 - (left == 0) as i32 }
}

/// A corner by its number.
#[inline(always)]
fn corner(corners: &[FixedPoint], number: u32) -> Option<Corner> {
    Some(Corner { point: *corners.get(number as usize)?, number })
}

/// An edge's corners: each outline's first one stands at its end as well.
#[inline(always)]
fn ends_of(corners: &[FixedPoint], [from, to]: Numbers) -> Option<Ends> {
    let [start, end] = *corners.get(from as usize..)?.first_chunk()?;
    Some([Corner { point: start, number: from }, Corner { point: end, number: to }])
}

/// How often an edge winds around a corner of another outline, if it passes to the corner's left: 1 or -1, else 0.
#[inline(always)]
fn winding_right_of(corners: &[FixedPoint], edge: Numbers, corner: Corner) -> i32 {
    let Some([from, to]) = ends_of(corners, edge) else { return 0 };
    let down = from.is_above(corner);
    if to.is_above(corner) == down {
        return 0;
    }
    // Right of an edge that goes down, seen along it, lies what is left of it on the canvas.
    let passes_left = is_right_of([from, to], corner, area([from, to], corner)) != down;
    match (passes_left, down) {
        (false, _) => 0,
        (true, true) => 1,
        (true, false) => -1,
    }
}

/// Leaves out those of the `count` corners from `first` on that are where the one before is, and says how many are left; as often as it takes to
/// make their number a multiple of eight, the first one follows.
#[cold]
fn leave_out_repeated(corners: &mut Vec<FixedPoint>, first: usize, count: usize) -> usize {
    let mut kept = first;
    for index in first..first + count {
        let Some(corner) = corners.get(index).copied() else { break };
        let is_repeated = kept > first && corners.get(kept - 1) == Some(&corner);
        if !is_repeated && let Some(place) = corners.get_mut(kept) {
            *place = corner;
            kept += 1;
        }
    }
    let count = kept - first;
    corners.truncate(kept);
    if let Some(corner) = corners.get(first).copied() {
        corners.resize(first + count.next_multiple_of(8), corner);
    }
    count
}

/// Where two edges cross; for each of them, which part of it lies before, and by how much the windings beside it change there.
#[inline(always)]
fn cross(edge: Ends, other: Ends) -> Option<(FixedPoint, [(f64, i32); 2])> {
    // All four at once, and one question: which of two edges ends where is a guess.
    let [areas, other_areas] = areas([edge, other]);
    let is_tie = (areas[0] == 0) | (areas[1] == 0) | (other_areas[0] == 0) | (other_areas[1] == 0);
    let ([from_right, to_right], [other_from_right, other_to_right]) = if is_tie {
        sides_of_ties([edge, other], [areas, other_areas])
    } else {
        ([areas[0] > 0, areas[1] > 0], [other_areas[0] > 0, other_areas[1] > 0])
    };
    if (from_right == to_right) | (other_from_right == other_to_right) {
        return None;
    }
    let change = |to_right: bool| if to_right { -1 } else { 1 };
    let (change, other_change) = (change(to_right), change(other_to_right));
    let [fraction, other_fraction] = fractions([edge, other], [areas, other_areas]);
    let ([from, to], part) = (edge, fraction.rounded());
    let place = FixedPoint {
        x: from.point.x + part_of(to.point.x - from.point.x, fraction, part),
        y: from.point.y + part_of(to.point.y - from.point.y, fraction, part),
    };
    Some((place, [(part, change), (other_fraction.rounded(), other_change)]))
}

/// Whether the ends of each of two edges lie right of the other, of which some lie on one line with it.
#[cold]
fn sides_of_ties([edge, other]: [Ends; 2], [areas, other_areas]: [[i64; 2]; 2]) -> ([bool; 2], [bool; 2]) {
    let sides = |edge: Ends, [from, to]: Ends, [from_area, to_area]: [i64; 2]| {
        [is_right_of(edge, from, from_area), is_right_of(edge, to, to_area)]
    };
    (sides(other, edge, areas), sides(edge, other, other_areas))
}

/// A part of an edge.
#[derive(Clone, Copy, Debug)]
struct Fraction {
    numerator: i64,
    denominator: i64,
}

/// The parts of two edges before they cross, by the areas of the triangles of each one's corners with the other edge.
#[inline(always)]
fn fractions(edges: [Ends; 2], areas: [[i64; 2]; 2]) -> [Fraction; 2] {
    let fractions =
        areas.map(|[before, after]| Fraction { numerator: before.abs(), denominator: before.abs() + after.abs() });
    let [Fraction { denominator, .. }, _] = fractions;
    if denominator == 0 { fractions_on_one_line(edges) } else { fractions }
}

/// As [`fractions`] for edges on one line: the corner that is moved most turns its edge around the edge's other corner.
#[cold]
fn fractions_on_one_line(edges: [Ends; 2]) -> [Fraction; 2] {
    let [[a, b], [c, d]] = edges;
    let first = a.number.min(b.number).min(c.number.min(d.number));
    let place = match first {
        _ if first == a.number => b,
        _ if first == b.number => a,
        _ if first == c.number => d,
        _ => c,
    };
    edges.map(|[from, to]| {
        let distance = |to: Corner| {
            [to.point.x - from.point.x, to.point.y - from.point.y].map(|distance| i64::from(distance.abs()))
        };
        match (distance(place), distance(to)) {
            ([numerator, _], [denominator, _]) if denominator > 0 => Fraction { numerator, denominator },
            ([_, numerator], [_, denominator]) => Fraction { numerator, denominator },
        }
    })
}

impl Fraction {
    #[inline(always)]
    fn rounded(self) -> f64 {
        self.numerator as f64 / self.denominator as f64
    }

    /// Which of two is smaller.
    #[cold]
    fn compare(self, other: Self) -> Ordering {
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        product(self.numerator, other.denominator).cmp(&product(other.numerator, self.denominator))
    }
}

/// A part of `length`, rounded to nearest, halves upwards.
#[inline(always)]
fn part_of(length: i32, fraction: Fraction, part: f64) -> i32 {
    /// More than the error of what is reckoned below, for lengths up to 2^30.
    const SURE: f64 = 0.5 - 1.0 / (1 << 20) as f64;
    let part = f64::from(length) * part;
    let rounded = round_f64(part);
    if (part - f64::from(rounded)).abs() < SURE { rounded } else { part_exactly(length, fraction) }
}

#[cold]
fn part_exactly(length: i32, Fraction { numerator, denominator }: Fraction) -> i32 {
    let (product, whole) = (i128::from(length) * i128::from(numerator), i128::from(denominator));
    (2 * product + whole).div_euclid(2 * whole) as i32
}

/// Lists the crossings of an edge from its start to its end, of which `head` is one.
#[inline(always)]
fn list_along(corners: &[FixedPoint], crossings: &[Crossing], edge: Numbers, head: u32, along: &mut Vec<(u64, u32)>) {
    /// More than the error of two quotients up to 1.
    const SURE: f64 = 1e-14;
    const FEW: usize = 4;
    along.clear();
    let mut number = head;
    while let Some(crossing) = crossings.get(number as usize) {
        // Parts are not negative: their bits are in the same order.
        along.push((crossing.part.to_bits(), number));
        number = crossing.next;
    }
    if along.len() > FEW {
        along.sort_unstable_by_key(|(part, _)| *part);
    }
    // What follows puts few in order, and those whose parts are nearly the same.
    let is_after = |(part, number): (u64, u32), (other_part, other): (u64, u32)| {
        let distance = f64::from_bits(part) - f64::from_bits(other_part);
        if distance.abs() > SURE {
            return distance > 0.0;
        }
        let others = [number, other].map(|number| crossings.get(number as usize).map(|crossing| crossing.other));
        matches!(others, [Some(first), Some(second)] if compare(corners, edge, first, second).is_gt())
    };
    for end in 1..along.len() {
        let mut place = end;
        while let Some([before, own]) = along.get_mut(place.wrapping_sub(1)..).and_then(|rest| rest.first_chunk_mut())
            && is_after(*before, *own)
        {
            core::mem::swap(before, own);
            place -= 1;
        }
    }
}

/// Which of two others an edge crosses first.
#[cold]
fn compare(corners: &[FixedPoint], edge: Numbers, first: Numbers, second: Numbers) -> Ordering {
    let part = |other: Numbers| {
        let edges = [ends_of(corners, edge)?, ends_of(corners, other)?];
        let [part, _] = fractions(edges, areas(edges));
        Some(part)
    };
    match (part(first), part(second)) {
        (Some(first), Some(second)) => first.compare(second),
        _ => Ordering::Equal,
    }
}

impl Pieces {
    fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
        (self.start, self.way) = (0, 0);
    }

    /// Goes along `points`, which bound the inside in `way`.
    #[inline(always)]
    fn follow(&mut self, points: &[FixedPoint], way: i32) {
        if let Some((first, rest)) = points.split_first() {
            self.turn(*first, way);
            if way != 0 {
                self.points.extend_from_slice(rest);
            }
        }
    }

    /// Goes from a point to another.
    #[inline(always)]
    fn step(&mut self, from: FixedPoint, to: FixedPoint, way: i32) {
        self.turn(from, way);
        if way != 0 && from != to {
            self.points.push(to);
        }
    }

    /// Goes on from a point, where another piece may begin.
    #[inline(always)]
    fn turn(&mut self, at: FixedPoint, way: i32) {
        if way != self.way || way != 0 && self.points.last() != Some(&at) {
            self.finish();
            self.way = way;
            if way != 0 {
                self.points.push(at);
            }
        }
    }

    /// Ends the piece in work.
    #[inline(always)]
    fn finish(&mut self) {
        if self.way < 0
            && let Some(piece) = self.points.get_mut(self.start..)
        {
            piece.reverse();
        }
        if self.start < self.points.len() {
            self.start = self.points.len();
            self.ends.push(self.start as u32);
        }
        self.way = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Point;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::path::flatten::PolygonSink;
    use crate::raster::batch::add_edges;
    use crate::raster::bins::Edges;
    use crate::raster::cell::{Accumulator, FULL};

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

    /// Outlines whose last corners are their first.
    fn polygons(outlines: &[Vec<FixedPoint>]) -> Polygons {
        let mut polygons = Polygons::default();
        for outline in outlines {
            for (index, corner) in outline[..outline.len() - 1].iter().enumerate() {
                let point = Point::new(corner.x as f32 / 256.0, corner.y as f32 / 256.0);
                if index == 0 { polygons.begin(point) } else { polygons.line(point) }
            }
            polygons.end();
        }
        polygons
    }

    /// The pieces that bound outlines.
    fn pieces_of(outlines: &[Vec<FixedPoint>], rule: FillRule) -> Option<Vec<Vec<FixedPoint>>> {
        let polygons = polygons(outlines);
        let found = SimdLevel::available().into_iter().map(|level| {
            let mut resolver = Resolver::default();
            // As if there were corners of another shape.
            let mut corners = vec![FixedPoint { x: 7, y: 9 }];
            let found = dispatch!(level, simd => resolver.resolve(simd, &polygons, rule, &mut corners));
            if found == Resolved::Outlines {
                let listed: Vec<_> = resolver.outlines().map(|outline| corners[1..][outline].to_vec()).collect();
                assert_eq!(listed.concat(), corners[1..]);
            } else {
                assert_eq!(corners.len(), 1);
            }
            (found == Resolved::Pieces).then(|| resolver.pieces().map(<[_]>::to_vec).collect())
        });
        let found: Vec<_> = found.collect();
        assert!(found.windows(2).all(|pair| pair[0] == pair[1]), "levels differ");
        found.into_iter().next().unwrap()
    }

    /// How much of each pixel is inside by summed areas of the pieces.
    fn resolved(level: SimdLevel, outlines: &[Vec<FixedPoint>], rule: FillRule) -> Vec<f64> {
        let pieces = pieces_of(outlines, rule).unwrap_or_else(|| outlines.to_vec());
        let points = pieces.concat();
        let (mut starts, mut first) = (Vec::new(), 0);
        for piece in pieces {
            starts.extend(first..first + piece.len() as u32 - 1);
            first += piece.len() as u32;
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

    /// Convex outlines, of which few cross others, inside of each other and beside each other, either way around; more of them than are asked one by one.
    #[test]
    fn convex_outlines_are_covered_as_by_scanlines() {
        let mut random = Random(5);
        for round in 0..60 {
            let (count, size) = [(1 + round % 6, 7 * 256), (FEW + 5, 300)][round % 2];
            let outlines: Vec<_> = (0..count)
                .map(|_| {
                    let (x, y) = (1800 + random.below(11_000), 1800 + random.below(500));
                    let (across, down) = (40 + random.below(size), 40 + random.below(size));
                    let corners = 4 + random.below(16);
                    let mut outline = closed((0..corners).map(|corner| {
                        let angle = f64::from(corner) / f64::from(corners) * core::f64::consts::TAU;
                        let (sin, cos) = crate::num::trig::sin_cos(angle);
                        (x + (f64::from(across) * cos) as i32, y + (f64::from(down) * sin) as i32)
                    }));
                    if random.below(2) == 0 {
                        outline.reverse();
                    }
                    outline
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
        let outer = [(300, 700), (300, 3000), (9000, 3000), (9000, 700)];
        assert_eq!(nested, Some(vec![closed(outer)]), "with its inside on the left");
        let overlapping = pieces_of(&[frame(0, 0, 512, 1024), frame(256, 512, 768, 2048)], FillRule::NonZero).unwrap();
        let edges = overlapping.iter().flat_map(|piece| piece.windows(2));
        let mut upright: Vec<_> =
            edges.filter(|pair| pair[0].y != pair[1].y).map(|pair| (pair[0].x, pair[0].y, pair[1].y)).collect();
        upright.sort_unstable();
        assert_eq!(upright, [(0, 0, 1024), (256, 1024, 2048), (512, 512, 0), (768, 2048, 512)]);
    }

    /// How often outlines wind around a point that lies on none of them.
    fn winding(outlines: &[Vec<FixedPoint>], (x, y): (f64, f64)) -> i32 {
        let mut winding = 0;
        for pair in outlines.iter().flat_map(|outline| outline.windows(2)) {
            let [a, b] = [pair[0], pair[1]].map(|p| (f64::from(p.x), f64::from(p.y)));
            if (a.1 < y) != (b.1 < y) && a.0 + (b.0 - a.0) * (y - a.1) / (b.1 - a.1) < x {
                winding += if a.1 < b.1 { 1 } else { -1 };
            }
        }
        winding
    }

    /// The distance from a point to the nearest edge.
    fn distance(outlines: &[Vec<FixedPoint>], (x, y): (f64, f64)) -> f64 {
        let edges = outlines.iter().flat_map(|outline| outline.windows(2));
        let to_edge = edges.map(|pair| {
            let [(ax, ay), (bx, by)] = [pair[0], pair[1]].map(|p| (f64::from(p.x), f64::from(p.y)));
            let ((vx, vy), (wx, wy)) = ((bx - ax, by - ay), (x - ax, y - ay));
            let squared = vx * vx + vy * vy;
            let along = if squared > 0.0 { ((vx * wx + vy * wy) / squared).clamp(0.0, 1.0) } else { 0.0 };
            libm::hypot(wx - along * vx, wy - along * vy)
        });
        to_edge.fold(f64::MAX, f64::min)
    }

    /// On few places, so that corners and edges lie on each other, as well as on many, near and far.
    #[test]
    fn pieces_close_and_bound_what_the_rule_says() {
        let mut random = Random(5);
        let (mut whole, mut cut, mut looked) = (0, 0, 0);
        for round in 0..12_000_usize {
            let places = [4, 6, 9, 30, 5000][round % 5];
            let step = [1, 64, 517, 30_000][round / 5 % 4];
            let corners = 3 + round % 11;
            // More than a few are looked at in another way.
            let outlines: Vec<_> = (0..[1, 2, 3, FEW + 3][round % 4])
                .map(|_| closed((0..corners).map(|_| (random.below(places) * step, random.below(places) * step))))
                .collect();
            for rule in [FillRule::NonZero, FillRule::EvenOdd] {
                let pieces = pieces_of(&outlines, rule);
                let bound = pieces.as_ref().unwrap_or(&outlines);
                if pieces.is_some() {
                    cut += 1
                } else {
                    whole += 1
                }
                // As many end in a place as start there.
                let mut ends = std::collections::HashMap::new();
                for piece in bound {
                    *ends.entry((piece[0].x, piece[0].y)).or_insert(0) += 1;
                    let end = piece[piece.len() - 1];
                    *ends.entry((end.x, end.y)).or_insert(0) -= 1;
                }
                assert!(ends.values().all(|open| *open == 0), "round {round}: {outlines:?}");
                for _ in 0..6 {
                    let mut coordinate = || f64::from(random.below(places * step)) + 0.5;
                    let point = (coordinate(), coordinate());
                    if distance(&outlines, point) < 2.0 {
                        continue;
                    }
                    looked += 1;
                    let inside = match rule {
                        FillRule::NonZero => winding(&outlines, point) != 0,
                        FillRule::EvenOdd => winding(&outlines, point) % 2 != 0,
                    };
                    let found = winding(bound, point);
                    // Outlines that are left as they are may all go the other way.
                    let found = if pieces.is_some() { found } else { found.abs() };
                    assert_eq!(found, i32::from(inside), "round {round}, {rule:?}, {point:?}: {outlines:?}");
                }
            }
        }
        assert!(whole > 1000 && cut > 15_000 && looked > 50_000, "{whole} {cut} {looked}");
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
