//! Exact coverage where outlines cross.
//!
//! Sums of areas are coverage as long as windings are 0 and 1. In a strip where they are not, edges are cut where they
//! cross each other, and of the pieces only those are added that have the inside on one side and the outside on the other,
//! each winding so that what is inside is wound around once:
//!
//! 1. Edges whose columns overlap, and theirs, are a *group* ([`Resolver::groups`]). No edge comes between two groups, so that the winding
//!    there is the same in all of the strip's rows.
//! 2. A group is walked from top to bottom, from one y at which an edge starts, ends or crosses another to the next: between two of
//!    them (a *scanbeam*, after Vatti, *A generic solution to polygon clipping*, 1992) edges have an order from left to
//!    right, and by the windings between them the fill rule says of each whether it bounds the inside ([`Walk::count`]).
//! 3. What an edge bounds from one change to the next is a piece, and added as any edge is ([`kernel`](super::kernel)).
//!
//! Crossings are rounded to 1/256 pixel, as corners are. The order is that in the middle between two such heights, so
//! that windings always add up: what rounding changes is some 2^-17 of a pixel, never a row.

use fearless_simd::Simd;

use super::bins::Edges;
use super::cell::Accumulator;
use super::edge::{Edge, FineLine};
use super::kernel::{Reach, STRIP_SHIFT, Slant, add_strip_part};
use crate::num::fixed;
use crate::style::FillRule;

/// So many looks at edges in one strip are too many: areas stay as they are summed. At such density, which of them are
/// inside no longer shows, and a strip's cost stays within bounds.
const MOST_LOOKS: usize = 1 << 20;

/// Pieces that bound the inside of a shape, and working memory.
#[derive(Debug, Default)]
pub(crate) struct Resolver {
    /// The edges of each strip.
    strips: Vec<Vec<Line>>,
    pieces: Vec<Piece>,
    /// The lines of the strip in work by where they start: from the left, then, of a group, from the top.
    order: Vec<u64>,
    active: Vec<Active>,
}

/// An edge in one strip. Heights in 1/256 pixel from the strip's top, x in 20.12 fixed point.
#[derive(Clone, Copy, Debug)]
struct Line {
    x: FineLine,
    /// Where the edge starts, which may be above the strip.
    start: i32,
    /// Where it ends, which may be below.
    end: (i32, i32),
    /// What of it lies in the strip; the same where it is level.
    top: i32,
    bottom: i32,
    left: i32,
    right: i32,
    slant: Slant,
    /// How it winds around the inside from `since` on: 1 or -1, or 0 where it does not bound it.
    bounds: i32,
    since: i32,
}

/// A line that the scanbeam in work crosses.
#[derive(Clone, Copy, Debug)]
struct Active {
    /// x in 1/4096 pixel, just below the scanbeam's top.
    x: f64,
    line: u32,
}

/// A piece of an edge in one strip: where it starts and ends, x in 20.12 and y in 24.8 fixed point.
#[derive(Clone, Copy, Debug)]
struct Piece {
    strip: u32,
    start: (i32, i32),
    end: (i32, i32),
    slant: Slant,
}

impl Line {
    /// x between two heights: `half` is twice the one below.
    #[inline(always)]
    fn x_within(&self, half: i32) -> f64 {
        self.x.x + self.x.slope * (0.5 * f64::from(half - 2 * self.start))
    }

    /// x at a height within the strip.
    #[inline(always)]
    fn x_at(&self, y: i32) -> i32 {
        if y == self.end.1 { self.end.0 } else { self.x.x_at(y - self.start) }
    }
}

impl Resolver {
    /// Finds the pieces that bound what of a shape lies in the strips below `top` (fixed point) that are `wanted`. A strip in
    /// which there are too many gets none, and is not wanted any more. `edges` are with the level ones.
    pub(crate) fn resolve(&mut self, edges: Edges<'_>, top: i32, wanted: &mut [bool], rule: FillRule) {
        self.pieces.clear();
        self.strips.resize_with(wanted.len().max(self.strips.len()), Vec::new);
        self.strips.iter_mut().for_each(Vec::clear);
        edges.for_all(
            #[inline(always)]
            |edge| list(&mut self.strips, edge, top, wanted),
        );
        for (strip, wanted) in wanted.iter_mut().enumerate() {
            let before = self.pieces.len();
            *wanted &= match rule {
                FillRule::NonZero => self.walk::<false>(strip, top),
                FillRule::EvenOdd => self.walk::<true>(strip, top),
            };
            if !*wanted {
                self.pieces.truncate(before);
            }
        }
    }

    /// Adds the pieces.
    #[inline(always)]
    pub(crate) fn add<S: Simd>(&self, simd: S, cells: &mut Accumulator, top: i32, reaches: &[Reach]) {
        for Piece { strip, start, end, slant } in &self.pieces {
            add_strip_part(simd, cells, *strip as usize, *start, *end, *slant, top, reaches);
        }
    }

    /// Walks the groups of a strip; false if that takes too long.
    fn walk<const EVEN_ODD: bool>(&mut self, strip: usize, top: i32) -> bool {
        let Self { strips, pieces, order, active } = self;
        let Some(lines) = strips.get_mut(strip) else { return true };
        order.clear();
        order.extend((0..).zip(&*lines).map(|(index, line)| entry(line.left, index)));
        order.sort_unstable();
        let highest = lines.iter().fold(i32::MAX, |highest, line| lesser(highest, line.top));
        let top = top + ((strip as i32) << STRIP_SHIFT);
        let mut walk = Walk { lines, pieces, active, strip: strip as u32, top, looks: 0 };
        let (mut rest, mut winding) = (&mut order[..], 0);
        while let [first, more @ ..] = &*rest {
            let Some(line) = walk.line(*first) else { break };
            // Below the top of what the shape has in the strip, the winding between groups is the same everywhere.
            let change =
                |line: &Line| if line.top == highest && line.bottom > highest { line.slant.winding } else { 0 };
            let (mut reach, mut next) = (line.right, winding + change(line));
            let more = more.iter().map_while(|entry| {
                let line = walk.line(*entry)?;
                (line.left <= reach).then(|| {
                    reach = greater(reach, line.right);
                    next += change(line);
                })
            });
            let count = 1 + more.count();
            let Some((group, others)) = std::mem::take(&mut rest).split_at_mut_checked(count) else { break };
            match group {
                [only] => walk.lone::<EVEN_ODD>(*only, winding),
                _ => walk.group::<EVEN_ODD>(group, winding),
            }
            if walk.looks > MOST_LOOKS {
                return false;
            }
            (rest, winding) = (others, next);
        }
        true
    }
}

/// A walk through the lines of one strip.
struct Walk<'a> {
    lines: &'a mut [Line],
    pieces: &'a mut Vec<Piece>,
    active: &'a mut Vec<Active>,
    strip: u32,
    /// The strip's top in fixed point.
    top: i32,
    looks: usize,
}

impl Walk<'_> {
    /// The line that an entry names.
    #[inline(always)]
    fn line(&self, entry: u64) -> Option<&Line> {
        self.lines.get(entry as u32 as usize)
    }

    /// Finds the piece of a line that is a group by itself, left of which the winding is `winding`.
    #[inline(always)]
    fn lone<const EVEN_ODD: bool>(&mut self, entry: u64, winding: i32) {
        let Self { lines, pieces, strip, top, .. } = self;
        if let Some(line) = lines.get_mut(entry as u32 as usize)
            && line.bottom > line.top
        {
            line.bounds = inside::<EVEN_ODD>(winding + line.slant.winding) - inside::<EVEN_ODD>(winding);
            finish(line, line.bottom, *strip, *top, pieces);
        }
    }

    /// Finds the pieces of a group, left of which the winding is `winding`. Puts it in another order.
    fn group<const EVEN_ODD: bool>(&mut self, group: &mut [u64], winding: i32) {
        for place in group.iter_mut() {
            if let Some(line) = self.line(*place) {
                *place = entry(line.top, *place as u32);
            }
        }
        group.sort_unstable();
        let mut pending = &*group;
        self.active.clear();
        while let [first, ..] = pending {
            let mut y = place_of(*first);
            loop {
                while let [first, rest @ ..] = pending
                    && place_of(*first) == y
                {
                    if self.line(*first).is_some_and(|line| line.bottom > y) {
                        self.active.push(Active { x: 0.0, line: *first as u32 });
                    }
                    pending = rest;
                }
                if self.active.is_empty() {
                    break;
                }
                let start = pending.first().map_or(i32::MAX, |first| place_of(*first));
                let (end, crossing) = self.arrange(y, start);
                self.apply::<EVEN_ODD>(y, winding);
                self.looks += self.active.len();
                if self.looks > MOST_LOOKS {
                    return;
                }
                y = lesser(lesser(start, end), crossing);
                if y == end {
                    self.retire(y);
                }
            }
        }
    }

    /// Puts the lines in their order just below `y`, and says where the first one ends, and where the first two cross each
    /// other, if that is above `start` and that end.
    #[inline(always)]
    fn arrange(&mut self, y: i32, start: i32) -> (i32, i32) {
        let Self { lines, active, .. } = self;
        let mut end = i32::MAX;
        let mut sorted = f64::MIN;
        for index in 0..active.len() {
            let (done, rest) = active.split_at_mut(index);
            let Some(moved) = rest.first_mut() else { break };
            let Some(line) = lines.get(moved.line as usize) else { break };
            end = lesser(end, line.bottom);
            moved.x = line.x_within(2 * y + 1);
            if moved.x >= sorted {
                sorted = moved.x;
                continue;
            }
            // It goes to where those left of it are not right of it.
            let moved = *moved;
            let place = done.iter().rposition(|other| other.x <= moved.x).map_or(0, |place| place + 1);
            if let Some(part) = active.get_mut(place..=index) {
                part.rotate_right(1);
            }
        }
        let bottom = lesser(start, end);
        let mut crossing = bottom;
        if bottom - y >= 2 {
            // The first two that cross each other are neighbours.
            let height = f64::from(bottom - y - 1);
            let mut before = (f64::MIN, f64::MIN);
            for active in &**active {
                let Some(line) = lines.get(active.line as usize) else { break };
                let (x, low) = (active.x, line.x_within(2 * bottom - 1));
                if low < before.1 {
                    let (gap, overlap) = (x - before.0, before.1 - low);
                    crossing = lesser(crossing, (f64::from(y + 1) + height * (gap / (gap + overlap))) as i32);
                }
                before = (x, low);
            }
        }
        (end, crossing)
    }

    /// Applies the fill rule to the windings between the lines from `y` on.
    #[inline(always)]
    fn apply<const EVEN_ODD: bool>(&mut self, y: i32, mut winding: i32) {
        let Self { lines, active, pieces, strip, top, .. } = self;
        let mut left = inside::<EVEN_ODD>(winding);
        for active in &**active {
            let Some(line) = lines.get_mut(active.line as usize) else { break };
            winding += line.slant.winding;
            let right = inside::<EVEN_ODD>(winding);
            let bounds = right - left;
            left = right;
            if bounds != line.bounds {
                finish(line, y, *strip, *top, pieces);
                (line.bounds, line.since) = (bounds, y);
            }
        }
    }

    /// Ends the lines that end at `y`.
    #[inline(always)]
    fn retire(&mut self, y: i32) {
        let Self { lines, active, pieces, strip, top, .. } = self;
        active.retain(
            #[inline(always)]
            |active| {
                let Some(line) = lines.get(active.line as usize) else { return false };
                let ends = line.bottom == y;
                if ends {
                    finish(line, y, *strip, *top, pieces);
                }
                !ends
            },
        );
    }
}

/// 1 if what winds so is inside, or else 0.
#[inline(always)]
fn inside<const EVEN_ODD: bool>(winding: i32) -> i32 {
    if EVEN_ODD { winding & 1 } else { (winding != 0) as i32 }
}

/// Lists the piece of a line that ends at `y`, if it bounds anything.
#[inline(always)]
fn finish(line: &Line, y: i32, strip: u32, top: i32, pieces: &mut Vec<Piece>) {
    if line.bounds != 0 {
        let slant = if line.bounds == line.slant.winding { line.slant } else { line.slant.reversed() };
        // Mostly it is all of the line.
        let (from, to) = if line.x.slope < 0.0 { (line.right, line.left) } else { (line.left, line.right) };
        let from = if line.since == line.top { from } else { line.x_at(line.since) };
        let to = if y == line.bottom { to } else { line.x_at(y) };
        pieces.push(Piece { strip, start: (from, top + line.since), end: (to, top + y), slant });
    }
}

/// Lists an edge in the wanted strips that it crosses.
#[inline(always)]
fn list(strips: &mut [Vec<Line>], edge: Edge, top: i32, wanted: &[bool]) {
    const HEIGHT: i32 = 1 << STRIP_SHIFT;
    const FINER: u32 = FineLine::SHIFT - fixed::SHIFT;
    let (x0, y0, x1, y1, winding) = edge.downward();
    let (y0, y1) = (y0 - top, y1 - top);
    let level = y0 == y1;
    // A level one at a strip's top is not in it.
    let first = if y0 > 0 { y0 >> STRIP_SHIFT } else { 0 };
    let last = (y1 - 1) >> STRIP_SHIFT;
    let wanted = wanted.get(first as usize..).unwrap_or(&[]);
    let mut line: Option<Line> = None;
    for (strip, wanted) in (first..=last).zip(wanted) {
        let Some(lines) = strips.get_mut(strip as usize).filter(|_| *wanted) else { continue };
        let above = strip * HEIGHT;
        let mut here = *line.get_or_insert_with(|| {
            let (x, slant) = if level {
                (FineLine { x: 0.0, slope: 0.0 }, Slant { slope: 0.0, steep: 0.0, winding })
            } else {
                (FineLine::new(x0, x1, y1 - y0), Slant::new((x0, y0, x1, y1, winding)))
            };
            let (left, right) = if x0 < x1 { (x0, x1) } else { (x1, x0) };
            Line {
                x,
                slant,
                start: 0,
                end: (0, 0),
                top: 0,
                bottom: 0,
                left: left << FINER,
                right: right << FINER,
                bounds: 0,
                since: 0,
            }
        });
        (here.start, here.end) = (y0 - above, (x1 << FINER, y1 - above));
        here.top = greater(here.start, 0);
        here.bottom = lesser(here.end.1, HEIGHT);
        if !level {
            let (from, to) = (if here.start >= 0 { x0 << FINER } else { here.x_at(0) }, here.x_at(here.bottom));
            (here.left, here.right) = if from < to { (from, to) } else { (to, from) };
        }
        here.since = here.top;
        lines.push(here);
    }
}

/// What sorts by a place, and names a line.
#[inline(always)]
fn entry(place: i32, index: u32) -> u64 {
    u64::from(place.cast_unsigned() ^ 1 << 31) << 32 | u64::from(index)
}

#[inline(always)]
fn place_of(entry: u64) -> i32 {
    ((entry >> 32) as u32 ^ 1 << 31).cast_signed()
}

#[inline(always)]
fn lesser(a: i32, b: i32) -> i32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn greater(a: i32, b: i32) -> i32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::raster::cell::FULL;
    use crate::raster::edge::FixedPoint;

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

    /// The same by pieces.
    fn resolved(level: SimdLevel, outlines: &[Vec<FixedPoint>], rule: FillRule) -> Vec<f64> {
        let points: Vec<FixedPoint> = outlines.concat();
        let mut starts = Vec::new();
        let mut first = 0;
        for outline in outlines {
            starts.extend(first..first + outline.len() as u32 - 1);
            first += outline.len() as u32;
        }
        let mut cells = Accumulator::default();
        cells.resize(WIDTH, 2);
        let mut resolver = Resolver::default();
        let mut wanted = [true; 2];
        resolver.resolve(Edges::of(&points, &starts), 0, &mut wanted, rule);
        assert_eq!(wanted, [true; 2]);
        dispatch!(level, simd => resolver.add(simd, &mut cells, 0, &[]));
        let mut covered = Vec::new();
        for row in 0..16 {
            let mut sum = 0;
            for column in &cells.strip(row / 8).unwrap().columns[..WIDTH] {
                sum += column.0[row % 8];
                covered.push(f64::from(sum) / f64::from(FULL));
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
    fn too_many_edges_are_given_up() {
        let mut random = Random(3);
        let outline = closed((0..4000).map(|_| (random.below(60 * 256), random.below(8 * 256))));
        let starts: Vec<u32> = (0..outline.len() as u32 - 1).collect();
        let mut resolver = Resolver::default();
        let mut wanted = [true, true];
        resolver.resolve(Edges::of(&outline, &starts), 0, &mut wanted, FillRule::NonZero);
        assert_eq!(wanted, [false, true], "the second strip has nothing to give up");
        assert!(resolver.pieces.is_empty());
    }
}
