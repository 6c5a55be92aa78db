//! Exact coverage where edges meet inside a pixel.
//!
//! Summed areas are exact for a pixel that one edge passes through. Where two do, the sum knows how much
//! each covers, not how much both do: the fill rule then has to be applied to the windings before
//! the areas are added. (Two that follow each other count as one where they meet.)
//!
//! While edges are added, each notes the pixels that it touches ([`touch`](super::touch)). A pixel that was touched twice is looked at again:
//!
//! 1. Touched pixels side by side in a row, one of them twice, are a *cluster* ([`find_clusters`]). The pixel left of it
//!    is touched by no edge, so that its sum is the winding along the whole of the cluster's left side.
//! 2. The parts of edges that lie in clusters are gathered ([`gather`]), and each cluster is walked from left to right.
//! 3. A pixel is cut where parts begin or end in it into slabs ([`Slabs`]); eight or more scanlines, lanes of a vector, are
//!    shared out among the slabs and followed from crossing to crossing, and what of them is inside is added up.
//! 4. The cells of the pixel and of its right neighbour are changed so that the sweep finds that value.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8};

use super::cell::{Column, FULL, Marks, Strip};
use super::edge::Edge;
use super::kernel::{RowParts, STRIP_SHIFT, Slant, for_strip_parts};
use super::sample::inside;
use crate::num::fixed;
use crate::num::lanes::{greater_f32, lesser_f32};
use crate::style::FillRule;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// Pixels with more parts than this are resolved scanline by scanline.
const MOST_CROSSINGS: usize = 16;
/// In rows whose parts touch more pixels than this, counted for each, summed areas stay: at such density, which of them
/// are inside no longer shows, and a row's cost stays within bounds.
const MOST_TOUCHES: usize = 1 << 14;
/// Pixels cut into more slabs than this are cut evenly instead.
const MOST_SLABS: usize = 12;
const EVEN_SLABS: i32 = 8;
/// x of what winds around a pixel's left side: left of all that is in the pixel.
const FAR_LEFT: f32 = 1e9;
/// A pixel is seen along so many scanlines at most: where parts run over more pixels than [`FLAT`] per row, since they
/// sweep it between two of fewer.
const MOST_SCANLINES: usize = 32;
const FLAT: f32 = 2.0;

/// Working memory.
#[derive(Debug, Default)]
pub(crate) struct ExactScratch {
    rows: [Row; BLOCK_HEIGHT],
    window: Window,
}

/// What is to be resolved in one row of a strip.
#[derive(Debug, Default)]
struct Row {
    /// The parts of edges that lie in clusters.
    parts: Vec<Part>,
    /// The clusters' first columns, and the winding left of each.
    clusters: Vec<(i32, i32)>,
    /// Pixels touched twice: their columns and summed areas.
    pixels: Vec<(i32, i32)>,
    /// How many pixels the parts touch, those that several touch counted as often.
    touches: usize,
    /// Whether there were too many.
    crowded: bool,
}

/// The part of an edge in one row. Heights in 1/256 pixel from the row's top.
#[derive(Clone, Copy, Debug)]
struct Part {
    /// The columns that it touches.
    first: i32,
    last: i32,
    /// x at the row's top, in 1/256 pixel right of the left side of column `base`.
    x: f32,
    base: i32,
    /// Change of x per unit of y.
    slope: f32,
    y0: i32,
    y1: i32,
    winding: i32,
}

impl Row {
    fn clear(&mut self) {
        self.parts.clear();
        self.clusters.clear();
        self.pixels.clear();
        self.touches = 0;
        self.crowded = false;
    }

    #[inline(always)]
    fn add(&mut self, part: Part) {
        self.parts.push(part);
        self.touches += part.touches();
        if self.touches > MOST_TOUCHES {
            self.thin();
        }
    }

    /// Gives a row up, unless it has so many parts because they are the same.
    #[cold]
    fn thin(&mut self) {
        self.sort();
        self.touches = self.parts.iter().map(Part::touches).sum();
        self.crowded |= self.touches > MOST_TOUCHES / 2;
    }

    /// Puts the parts in order of their first column; those that are the same become one.
    fn sort(&mut self) {
        self.parts.sort_unstable_by_key(|part| u64::from(part.first as u32) << 32 | u64::from(part.x.to_bits()));
        self.parts.dedup_by(|part, kept| {
            let place = |part: &Part| (part.first, part.base, part.x, part.slope, part.y0, part.y1);
            let same = place(part) == place(kept);
            if same {
                kept.winding = kept.winding.saturating_add(part.winding);
            }
            same
        });
    }
}

impl Part {
    #[inline(always)]
    fn touches(&self) -> usize {
        (self.last - self.first + 1).max(1) as usize
    }
}

/// Resolves the pixels of a strip that were touched twice, and clears the marks. `top` is the strip's top in fixed
/// point; `edges` are all that were added to it.
#[inline(always)]
pub(crate) fn resolve<S: Simd>(
    simd: S,
    cells: &mut Strip,
    edges: &[Edge],
    top: i32,
    rule: FillRule,
    scratch: &mut ExactScratch,
) {
    if find_clusters(cells) {
        scratch.rows.iter_mut().for_each(Row::clear);
        list_pixels(simd, cells, &mut scratch.rows);
        for edge in edges {
            gather(simd, cells, edge, top, &mut scratch.rows);
        }
        for (index, row) in scratch.rows.iter_mut().enumerate() {
            if !row.pixels.is_empty() && !row.crowded {
                row.sort();
                resolve_row(simd, &mut cells.columns, index, row, rule, &mut scratch.window);
            }
        }
    }
    let Strip { marks, occupied, .. } = cells;
    for_occupied(occupied, |block| {
        for marks in block_of(marks, block) {
            *marks = Marks::default();
        }
    });
}

/// The columns of a block.
#[inline(always)]
fn block_of<T>(columns: &mut [T], block: usize) -> &mut [T] {
    columns.get_mut(block * BLOCK_WIDTH..(block + 1) * BLOCK_WIDTH).unwrap_or(&mut [])
}

#[inline(always)]
fn for_occupied(occupied: &[u64], mut f: impl FnMut(usize)) {
    for (index, word) in occupied.iter().enumerate() {
        let mut bits = *word;
        while bits != 0 {
            f(index * 64 + bits.trailing_zeros() as usize);
            bits &= bits - 1;
        }
    }
}

/// Marks the clusters, all rows at a time; false if there is none.
#[inline(always)]
fn find_clusters(cells: &mut Strip) -> bool {
    let Strip { marks, occupied, .. } = cells;
    let mut any = 0;
    for_occupied(occupied, |block| {
        for marks in block_of(marks, block) {
            any |= marks.twice;
        }
    });
    if any == 0 {
        return false;
    }
    // To the right of a pixel touched twice, then to the left of what that found.
    let (mut carry, mut before) = (0, usize::MAX);
    for_occupied(occupied, |block| {
        if block != before.wrapping_add(1) {
            carry = 0;
        }
        for marks in block_of(marks, block) {
            carry = marks.once & (marks.twice | carry);
            marks.cluster = carry;
        }
        before = block;
    });
    let (mut carry, mut before) = (0, usize::MAX);
    for (index, word) in occupied.iter().enumerate().rev() {
        let mut bits = *word;
        while bits != 0 {
            let bit = 63 - bits.leading_zeros() as usize;
            bits ^= 1 << bit;
            let block = index * 64 + bit;
            if block + 1 != before {
                carry = 0;
            }
            for marks in block_of(marks, block).iter_mut().rev() {
                carry = marks.once & (marks.cluster | carry);
                marks.cluster = carry;
            }
            before = block;
        }
    }
    true
}

/// Lists for each row the clusters with the windings left of them, and the pixels with their sums.
#[inline(always)]
fn list_pixels<S: Simd>(simd: S, cells: &mut Strip, rows: &mut [Row; BLOCK_HEIGHT]) {
    let mut sum = i32x8::splat(simd, 0);
    let (mut left, mut before) = (0, usize::MAX);
    let Strip { columns, marks, occupied, wide } = cells;
    let (mut wide_sum, mut wide_end) = ([0_i64; BLOCK_HEIGHT], 0);
    for_occupied(occupied, |block| {
        if block != before.wrapping_add(1) {
            left = 0;
        }
        before = block;
        let start = (block * BLOCK_WIDTH) as i32;
        for (column, (cell, marks)) in (start..).zip(block_of(columns, block).iter().zip(block_of(marks, block))) {
            let old = sum;
            sum += i32x8::load_array_ref(simd, &cell.0);
            if marks.cluster == 0 {
                left = 0;
                continue;
            }
            let starts = marks.cluster & !left;
            left = marks.cluster;
            if starts != 0 {
                let windings = old.to_array();
                while wide_end < column as usize
                    && let Some(values) = wide.get(wide_end)
                {
                    for (sum, value) in wide_sum.iter_mut().zip(values) {
                        *sum += value;
                    }
                    wide_end += 1;
                }
                for_rows(starts, rows, |row, index| {
                    let at = |lanes: &[i32; 8]| i64::from(lanes.get(index).copied().unwrap_or(0));
                    let sum = if wide.is_empty() { at(&windings) } else { wide_sum.get(index).copied().unwrap_or(0) };
                    // Rounded: beside a part that goes on in other rows, sums are right to some 1/2^17 only.
                    let winding = (sum + i64::from(FULL / 2)) >> FULL.ilog2();
                    row.clusters.push((column, winding as i32));
                });
            }
            if marks.twice != 0 {
                let sums = sum.to_array();
                for_rows(marks.twice, rows, |row, index| {
                    row.pixels.push((column, sums.get(index).copied().unwrap_or(0)));
                });
            }
        }
    });
}

#[inline(always)]
fn for_rows(mut bits: u8, rows: &mut [Row; BLOCK_HEIGHT], mut f: impl FnMut(&mut Row, usize)) {
    while bits != 0 {
        let index = bits.trailing_zeros() as usize;
        bits &= bits - 1;
        if let Some(row) = rows.get_mut(index) {
            f(row, index);
        }
    }
}

/// Lists the parts of an edge that lie in clusters of the strip at `top`.
#[inline(always)]
fn gather<S: Simd>(simd: S, cells: &Strip, edge: &Edge, top: i32, rows: &mut [Row; BLOCK_HEIGHT]) {
    let (_, y0, _, y1, winding) = edge.downward();
    if y1 <= top || y0 >= top + (1 << STRIP_SHIFT) || y0 == y1 {
        return;
    }
    let slant = Slant::new(edge.downward());
    for_strip_parts(
        edge.downward(),
        top,
        1,
        #[inline(always)]
        |_, start, end| {
            let (first, last) = RowParts::<S>::columns(start, end);
            let within = cells.marks.get(first..=last).unwrap_or(&[]);
            let mut found = 0;
            for marks in within {
                found |= marks.cluster;
            }
            if found == 0 {
                return;
            }
            let parts = RowParts::new(simd, start, end, slant, top, first);
            let (left, right) = (parts.left.to_array(), parts.right.to_array());
            let (upper, lower) = (parts.upper.to_array(), parts.lower.to_array());
            let y = start.1 - top;
            for_rows(found, rows, |row, index| {
                let at = |lanes: &[i32; 8]| lanes.get(index).copied().unwrap_or(0);
                // Where a strip ends, x was rounded: the last part may end a little beyond.
                let column = |lanes: &[f32; 8]| {
                    ((lanes.get(index).copied().unwrap_or(0.0) * (1.0 / 256.0)) as usize).min(last - first)
                };
                let (from, to) = (column(&left), column(&right));
                let reaches = within.get(from..=to.max(from)).unwrap_or(&[]);
                let bit = 1 << index;
                if !row.crowded && at(&lower) > at(&upper) && reaches.iter().any(|marks| marks.cluster & bit != 0) {
                    let row_top = index as i32 * fixed::ONE;
                    let (y0, y1) = (at(&upper) + y - row_top, at(&lower) + y - row_top);
                    row.add(Part {
                        first: (first + from) as i32,
                        last: (first + to) as i32,
                        x: parts.start + (row_top - y) as f32 * parts.slope,
                        base: first as i32,
                        slope: parts.slope,
                        y0,
                        y1,
                        winding,
                    });
                }
            });
        },
    );
}

/// The parts in the pixel in work, and what lies left of it.
#[derive(Debug, Default)]
struct Window {
    parts: Vec<Part>,
    /// The winding at the top of the pixel's left side, and how it changes further down: (y, difference).
    winding: i32,
    changes: Vec<(i32, i32)>,
    sides: Sides,
    slabs: Slabs,
    /// Of one scanline: where it is crossed, a float's bits, and in the lower half by what winding.
    crossings: Vec<u64>,
}

impl Window {
    /// Starts a cluster.
    fn start(&mut self, winding: i32) {
        self.parts.clear();
        self.changes.clear();
        self.winding = winding;
    }

    /// Moves on to the pixel in `column`: parts that end left of it wind around it.
    #[inline(always)]
    fn advance(&mut self, column: i32) {
        let mut index = 0;
        while let Some(part) = self.parts.get(index).copied() {
            if part.last >= column {
                index += 1;
                continue;
            }
            self.parts.swap_remove(index);
            self.change(part.y0, part.winding);
            self.change(part.y1, -part.winding);
        }
    }

    #[inline(always)]
    fn change(&mut self, y: i32, winding: i32) {
        if y <= 0 {
            self.winding += winding;
        } else if y < fixed::ONE {
            if let Some(index) = self.changes.iter().position(|(other, _)| *other == y) {
                let Some((_, sum)) = self.changes.get_mut(index) else { return };
                *sum += winding;
                if *sum == 0 {
                    self.changes.swap_remove(index);
                }
            } else {
                self.changes.push((y, winding));
            }
        }
    }

    /// Whether the sum of areas is right all the same: where the rule is linear between the lowest and the highest winding
    /// that the pixel can have, or along every scanline, since [`Sides`] says so.
    #[inline(always)]
    fn is_summed(&mut self, rule: FillRule) -> bool {
        let (mut low, mut high) = (self.winding, self.winding);
        for winding in self.changes.iter().map(|(_, sum)| *sum).chain(self.parts.iter().map(|part| part.winding)) {
            if winding < 0 {
                low = low.saturating_add(winding);
            } else {
                high = high.saturating_add(winding);
            }
        }
        let is_linear = match rule {
            FillRule::EvenOdd => high - low <= 1,
            FillRule::NonZero => low >= 0 && high <= 1 || low >= -1 && high <= 0 || low > 0 || high < 0,
        };
        if is_linear {
            return true;
        }
        // The commonest case, and where two lines cross, answered at once.
        if let [a, b] = &self.parts[..]
            && self.changes.is_empty()
        {
            let (one, other) = (std::slice::from_ref(a), std::slice::from_ref(b));
            return a.winding == -b.winding
                && a.winding.abs() == 1
                && self.winding.abs() <= 1
                && (is_behind(one, other) || is_behind(other, one));
        }
        self.sides.are_in_order(self.winding, &self.parts, &mut self.changes)
    }
}

/// The parts in a pixel: those that wind as edges downwards do, and those that wind as edges upwards.
#[derive(Debug, Default)]
struct Sides {
    down: Vec<Part>,
    up: Vec<Part>,
}

impl Sides {
    /// Whether every scanline crosses nothing, or one part of one kind, or one of that kind and right of it one that winds
    /// against it: windings are then w and w ± 1 throughout, and always the same sign of the two.
    #[inline(never)]
    fn are_in_order(&mut self, winding: i32, parts: &[Part], changes: &mut [(i32, i32)]) -> bool {
        const MOST: usize = 8;
        if parts.len() + changes.len() > MOST || winding.abs() > 1 {
            return false;
        }
        self.down.clear();
        self.up.clear();
        // What winds around the pixel's left side from one height to another is a part there.
        changes.sort_unstable();
        let mut around = 0;
        for (index, (y0, change)) in changes.iter().enumerate() {
            around += change;
            let y1 = changes.get(index + 1).map_or(fixed::ONE, |(y, _)| *y);
            let x = -FAR_LEFT;
            let part = Part { first: 0, last: 0, x, base: 0, slope: 0.0, y0: *y0, y1, winding: around };
            match around {
                0 => {}
                1 => self.down.push(part),
                -1 => self.up.push(part),
                _ => return false,
            }
        }
        for part in parts {
            match part.winding {
                1 => self.down.push(*part),
                -1 => self.up.push(*part),
                _ => return false,
            }
        }
        is_behind(&self.up, &self.down) || is_behind(&self.down, &self.up)
    }
}

/// Whether, on every scanline that crosses one of `second`, one of `first` is crossed left of it, and never two of a kind.
fn is_behind(second: &[Part], first: &[Part]) -> bool {
    let common = |a: &Part, b: &Part| {
        let (top, bottom) = (if a.y0 > b.y0 { a.y0 } else { b.y0 }, if a.y1 < b.y1 { a.y1 } else { b.y1 });
        (top < bottom).then_some((top, bottom))
    };
    let single = |parts: &[Part]| {
        let others = |index: usize| parts.get(index + 1..).unwrap_or(&[]);
        parts.iter().enumerate().all(|(index, a)| others(index).iter().all(|b| common(a, b).is_none()))
    };
    single(first)
        && single(second)
        && second.iter().all(|part| {
            let mut met = 0;
            for before in first {
                let Some((top, bottom)) = common(before, part) else { continue };
                let apart = |y: i32| {
                    let bases = ((before.base - part.base) * fixed::ONE) as f32;
                    (before.x - part.x) + bases + (before.slope - part.slope) * y as f32
                };
                if apart(top) > 0.0 || apart(bottom) > 0.0 {
                    return false;
                }
                met += bottom - top;
            }
            met == part.y1 - part.y0
        })
}

/// The heights between which nothing begins or ends, in 1/256 pixel, and scanlines between them.
#[derive(Debug, Default)]
struct Slabs {
    cuts: Vec<i32>,
    y: [f32; MOST_SCANLINES],
    /// How much of the pixel's height each scanline stands for.
    heights: [f32; MOST_SCANLINES],
}

impl Slabs {
    fn cut(&mut self, parts: &[Part], changes: &[(i32, i32)], column: i32) {
        self.cuts.clear();
        self.cuts.extend([0, fixed::ONE]);
        let ends = parts.iter().flat_map(|part| [part.y0, part.y1]);
        // A flat part comes and goes at the pixel's sides, between two scanlines of any number.
        let sides = parts.iter().filter(|part| part.slope.abs() > FLAT).flat_map(|part| {
            let offset = part.x + ((part.base - column) * fixed::ONE) as f32;
            let at = |side: f32| {
                let y = ((side - offset) / part.slope + 0.5) as i32;
                if y > part.y0 && y < part.y1 { y } else { 0 }
            };
            [at(0.0), at(256.0)]
        });
        for y in changes.iter().map(|(y, _)| *y).chain(ends).chain(sides) {
            if y > 0 && y < fixed::ONE && !self.cuts.contains(&y) {
                self.cuts.push(y);
                if self.cuts.len() > MOST_SLABS {
                    self.cuts.clear();
                    self.cuts.extend((0..=EVEN_SLABS).map(|i| i * fixed::ONE / EVEN_SLABS));
                    return;
                }
            }
        }
        self.cuts.sort_unstable();
    }

    /// Gives each slab one scanline and more by its height, in the middles of equal parts; says in how many eights they are.
    fn place_scanlines(&mut self, is_flat: bool) -> usize {
        let slabs = self.cuts.len() as i32 - 1;
        let eights = match slabs {
            _ if is_flat => MOST_SCANLINES / 8,
            0..=3 => 1,
            _ => 2,
        };
        let spare = 8 * eights as i32 - slabs;
        let mut lanes = self.y.iter_mut().zip(&mut self.heights).take(8 * eights);
        for pair in self.cuts.windows(2) {
            let [top, bottom] = *pair else { break };
            let lines = 1 + (spare * (bottom - top)) / fixed::ONE;
            let height = (bottom - top) as f32 / lines as f32;
            let mut middle = top as f32 + 0.5 * height;
            for (y, part) in lanes.by_ref().take(lines as usize) {
                (*y, *part) = (middle, height);
                middle += height;
            }
        }
        for (_, part) in lanes {
            *part = 0.0;
        }
        eights
    }
}

/// Resolves the pixels of a row, whose parts are sorted by their first column.
#[inline(always)]
fn resolve_row<S: Simd>(simd: S, columns: &mut [Column], index: usize, row: &Row, rule: FillRule, window: &mut Window) {
    let mut parts = &row.parts[..];
    let mut clusters = &row.clusters[..];
    for (column, sum) in &row.pixels {
        while let [(start, winding), rest @ ..] = clusters
            && start <= column
        {
            window.start(*winding);
            clusters = rest;
            while let [part, rest @ ..] = parts
                && part.last < *start
            {
                parts = rest;
            }
        }
        while let [part, rest @ ..] = parts
            && part.first <= *column
        {
            window.parts.push(*part);
            parts = rest;
        }
        window.advance(*column);
        if window.is_summed(rule) {
            continue;
        }
        let covered = match rule {
            FillRule::NonZero => coverage::<S, false>(simd, window, *column),
            FillRule::EvenOdd => coverage::<S, true>(simd, window, *column),
        };
        let covered = covered.unwrap_or_else(|| crowded_coverage(window, *column, rule));
        if let Some([here, next]) = columns.get_mut(*column as usize..).and_then(|rest| rest.first_chunk_mut::<2>())
            && let (Some(here), Some(next)) = (here.0.get_mut(index), next.0.get_mut(index))
        {
            *here = here.wrapping_add(covered - sum);
            *next = next.wrapping_sub(covered - sum);
        }
    }
}

/// The covered area of the pixel in `column`, in 1/[`FULL`]; `None` if too many parts lie in it.
///
/// Scanlines are lanes; each slab gets some, all of it together at most [`MOST_SCANLINES`]. Between crossings, the middle of
/// what a scanline stands for is exact.
#[inline(always)]
fn coverage<S: Simd, const EVEN_ODD: bool>(simd: S, window: &mut Window, column: i32) -> Option<i32> {
    let Window { parts, winding, changes, slabs, .. } = window;
    if parts.len() > MOST_CROSSINGS {
        return None;
    }
    slabs.cut(parts, changes, column);
    let is_flat = parts.iter().any(|part| part.slope.abs() > FLAT);
    let eights = slabs.place_scanlines(is_flat);
    let mut area = f32x8::splat(simd, 0.0);
    for (y, height) in slabs.y.as_chunks::<8>().0.iter().zip(slabs.heights.as_chunks::<8>().0).take(eights) {
        let y = f32x8::load_array_ref(simd, y);
        let mut around = i32x8::splat(simd, *winding);
        for (from, change) in changes.iter() {
            around += y.simd_gt(*from as f32).select(i32x8::splat(simd, *change), i32x8::splat(simd, 0));
        }
        // Few crossings stay in registers.
        let inside = match parts.len() {
            0..=2 => inside_along::<S, EVEN_ODD, 2>(simd, y, around, parts, column),
            3..=4 => inside_along::<S, EVEN_ODD, 4>(simd, y, around, parts, column),
            _ => inside_along::<S, EVEN_ODD, MOST_CROSSINGS>(simd, y, around, parts, column),
        };
        area += inside * f32x8::load_array_ref(simd, height);
    }
    let [a, b, c, d, e, f, g, h] = area.to_array();
    let area = ((a + e) + (c + g)) + ((b + f) + (d + h));
    Some((area * (FULL as f32 / 65_536.0) + 0.5) as i32)
}

/// How much of eight scanlines of the pixel in `column`, in 1/256 of its width, is inside; `parts` are at most `N`, and
/// `around` is the winding along the pixel's left side.
#[inline(always)]
fn inside_along<S: Simd, const EVEN_ODD: bool, const N: usize>(
    simd: S,
    y: f32x8<S>,
    mut around: i32x8<S>,
    parts: &[Part],
    column: i32,
) -> f32x8<S> {
    let zero = f32x8::splat(simd, 0.0);
    let side = f32x8::splat(simd, 256.0);
    let nothing = i32x8::splat(simd, 0);
    let is_inside = |around: i32x8<S>| {
        let residue = if EVEN_ODD { around & 1 } else { around };
        residue.simd_eq(nothing)
    };
    // Where the scanlines are crossed, in order, and by what winding: each new crossing sinks to its place.
    let mut places = [side; N];
    let mut windings = [nothing; N];
    for (count, part) in parts.iter().take(N).enumerate() {
        let offset = part.x + ((part.base - column) * fixed::ONE) as f32;
        let crosses = y.simd_gt(part.y0 as f32) & y.simd_lt(part.y1 as f32);
        let place = lesser_f32(greater_f32(y * part.slope + offset, zero), side);
        let mut place = crosses.select(place, side);
        let mut crossing = crosses.select(i32x8::splat(simd, part.winding), nothing);
        for (other, winding) in places.iter_mut().zip(&mut windings).take(count) {
            let before = place.simd_lt(*other);
            let (p, w) = (before.select(*other, place), before.select(*winding, crossing));
            (*other, *winding) = (before.select(place, *other), before.select(crossing, *winding));
            (place, crossing) = (p, w);
        }
        if let (Some(other), Some(winding)) = (places.get_mut(count), windings.get_mut(count)) {
            (*other, *winding) = (place, crossing);
        }
    }
    let (mut inside, mut at) = (zero, zero);
    for (place, winding) in places.iter().zip(&windings).take(parts.len()) {
        inside += is_inside(around).select(zero, *place - at);
        around += *winding;
        at = *place;
    }
    inside + is_inside(around).select(zero, side - at)
}

/// The covered area of a pixel with any number of parts, in 1/[`FULL`].
#[inline(never)]
fn crowded_coverage(window: &mut Window, column: i32, rule: FillRule) -> i32 {
    const SCANLINES: i32 = 16;
    let Window { parts, winding, changes, crossings, .. } = window;
    let mut area = 0.0;
    for scanline in 0..SCANLINES {
        let y = (2 * scanline + 1) * fixed::ONE / (2 * SCANLINES);
        crossings.clear();
        crossings.extend(parts.iter().filter(|part| part.y0 <= y && y < part.y1).map(|part| {
            let x = part.x + ((part.base - column) * fixed::ONE) as f32 + part.slope * y as f32;
            // What is not below 0 has the order of its bits.
            let x = if x > 0.0 { x } else { 0.0 };
            u64::from((if x < 256.0 { x } else { 256.0 }).to_bits()) << 32 | u64::from(part.winding as u32)
        }));
        crossings.sort_unstable();
        let mut around = *winding + changes.iter().map(|(from, sum)| if *from <= y { *sum } else { 0 }).sum::<i32>();
        let mut at = 0.0;
        for crossing in crossings.iter() {
            let (x, winding) = (f32::from_bits((crossing >> 32) as u32), *crossing as u32 as i32);
            if inside(around, rule) {
                area += x - at;
            }
            around = around.wrapping_add(winding);
            at = x;
        }
        if inside(around, rule) {
            area += 256.0 - at;
        }
    }
    (area * (FULL as f32 / (256 * SCANLINES) as f32) + 0.5) as i32
}
