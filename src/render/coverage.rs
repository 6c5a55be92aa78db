//! Which pixels: a shape's edges into cells, and cells into blocks of coverage.

use core::ops::Range;

use fearless_simd::Simd;

use super::Piece;
use super::band::{BandScratch, Frame};
use super::occlusion::reach;
use super::prepare::is_exact;
use crate::display_list::{Geometry, Span};
use crate::geom::{FixedRect, IntRect};
use crate::num::fixed;
use crate::raster::bar::add_bar;
use crate::raster::batch::add_edges;
use crate::raster::bins::{Boundary, Edges};
use crate::raster::cell::Accumulator;
use crate::raster::edge::Edge;
use crate::raster::kernel::Reach;
use crate::raster::rect::sweep_rect;
use crate::raster::round_rect::add_round_rect;
use crate::raster::sweep::{BlockSink, CoverageRule, sweep};
use crate::raster::{kernel, sample};
use crate::style::{Antialias, FillRule};
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// Where a shape's coverage is.
#[derive(Clone, Copy, Debug)]
pub(super) enum Coverage {
    /// In the cells, to be read by a rule.
    Cells(CoverageRule),
    /// It is that of a rectangle, which needs no cells.
    Rect(FixedRect),
}

impl Coverage {
    /// Whether a strip has none.
    #[inline(always)]
    pub(super) fn is_empty(self, frame: &Frame<'_>, cells: &Accumulator, strip: usize) -> bool {
        match self {
            Self::Cells(_) => !cells.is_occupied(strip),
            Self::Rect(rect) => {
                let top = frame.strip_top(strip) << fixed::SHIFT;
                rect.top >= top + ((BLOCK_HEIGHT as i32) << fixed::SHIFT) || rect.bottom <= top
            }
        }
    }

    /// Reports a strip's coverage in blocks `..end` and leaves its cells zero.
    #[inline(always)]
    pub(super) fn sweep<S: Simd, K: BlockSink<S>>(
        self,
        simd: S,
        frame: &Frame<'_>,
        cells: &mut Accumulator,
        strip: usize,
        end: usize,
        sink: &mut K,
    ) {
        match self {
            Self::Cells(rule) => {
                if let Some(mut cells) = cells.strip(strip) {
                    sweep(simd, &mut cells, end, rule, sink);
                }
            }
            Self::Rect(rect) => sweep_rect(simd, rect, frame.strip_top(strip) << fixed::SHIFT, end, sink),
        }
    }
}

/// What a shape covers of the band's blocks, if that is a rectangle.
#[inline(always)]
pub(super) fn rectangle(
    frame: &Frame<'_>,
    geometry: &Geometry,
    antialias: Antialias,
    bounds: IntRect,
) -> Option<FixedRect> {
    let bounds = bounds.intersect(frame.area());
    match geometry {
        Geometry::Rect(rect) if is_exact(antialias) => Some(rect.intersect(bounds)),
        Geometry::Bounds => Some(FixedRect::of_pixels(bounds)),
        _ => None,
    }
}

/// Brings a shape, of which only what lies in `bounds` (device pixels) is drawn, into the cells, and says how to read
/// them.
#[inline(never)]
pub(super) fn accumulate<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    geometry: &Geometry,
    antialias: Antialias,
    bounds: IntRect,
    boundary: Boundary<'_>,
) -> Coverage {
    simd.vectorize(
        #[inline(always)]
        || accumulate_inner(simd, frame, scratch, geometry, antialias, bounds, boundary),
    )
}

#[inline(always)]
fn accumulate_inner<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    geometry: &Geometry,
    antialias: Antialias,
    bounds: IntRect,
    boundary: Boundary<'_>,
) -> Coverage {
    let rule = match geometry {
        Geometry::Fill { rule, .. } => *rule,
        _ => FillRule::NonZero,
    };
    if let Geometry::Spans(range) = geometry {
        add_spans(
            frame,
            &mut scratch.cells,
            bounds,
            frame.list.spans.get(range.0 as usize..range.1 as usize).unwrap_or(&[]),
        );
        return Coverage::Cells(CoverageRule::NonZero);
    }
    if let Some(rect) = rectangle(frame, geometry, antialias, bounds) {
        return Coverage::Rect(rect);
    }
    let strips = frame.strips_of(bounds);
    let BandScratch { cells, reaches, visible, .. } = scratch;
    set_reaches(reaches, visible, &strips);
    let (area, top) = (bounds.intersect(frame.area()), frame.strip_top(strips.start));
    cells.set_base(strips.start);
    let added = match boundary {
        Boundary::RoundRect(shape) => {
            add_round_rect(simd, cells, &shape, area, top << fixed::SHIFT, strips.len(), reaches);
            Ok(CoverageRule::NonZero)
        }
        Boundary::Bar(bar) => {
            add_bar(simd, cells, bar, area, top, reaches);
            Ok(CoverageRule::NonZero)
        }
        Boundary::Edges(edges) => match antialias {
            // Sums by the even-odd rule may wrap around: what is lost is even.
            Antialias::Analytic | Antialias::Exact if edges.len() >= kernel::CROWD && rule == FillRule::NonZero => {
                let mut edges = std::iter::once(edges);
                kernel::add_crowds(simd, cells, &mut edges, top << fixed::SHIFT, strips.len(), reaches);
                Ok(rule.into())
            }
            Antialias::Analytic | Antialias::Exact => {
                add_edges(simd, cells, edges, top << fixed::SHIFT, strips.len(), reaches);
                Ok(rule.into())
            }
            Antialias::Supersample(grid) => Err((edges, grid.clamp(1, 16))),
            Antialias::None => Err((edges, 1)),
        },
    };
    cells.set_base(0);
    let (edges, grid) = match added {
        Ok(rule) => return Coverage::Cells(rule),
        Err(sampled) => sampled,
    };
    let edges = &*listed(&mut scratch.edges, edges);
    for strip in strips {
        if let Some(mut cells) = scratch.cells.strip(strip) {
            let strip_top = frame.strip_top(strip) << fixed::SHIFT;
            sample::add_samples(&mut cells, edges, strip_top, grid, rule, &mut scratch.sample);
        }
    }
    Coverage::Cells(CoverageRule::Samples(u16::from(grid) * u16::from(grid)))
}

/// Brings a stroke into the cells whose edges are those of `stretches`, and says how to read them.
#[inline(never)]
pub(super) fn accumulate_stretches<S: Simd>(
    simd: S,
    frame: &Frame<'_>,
    scratch: &mut BandScratch,
    bounds: IntRect,
    stretches: &[Piece<'_>],
) -> Coverage {
    let strips = frame.strips_of(bounds);
    let BandScratch { cells, reaches, visible, .. } = scratch;
    set_reaches(reaches, visible, &strips);
    let mut edges = stretches.iter().filter_map(|stretch| {
        let band = stretch.chunk.band(frame.index)?;
        match stretch.chunk.boundary(band, *band.items.first()?) {
            Boundary::Edges(edges) => Some(edges),
            Boundary::RoundRect(_) | Boundary::Bar(_) => None,
        }
    });
    cells.set_base(strips.start);
    kernel::add_crowds(simd, cells, &mut edges, frame.strip_top(strips.start) << fixed::SHIFT, strips.len(), reaches);
    cells.set_base(0);
    Coverage::Cells(CoverageRule::NonZero)
}

/// Sets where in each of a shape's strips coverage matters.
#[inline(always)]
fn set_reaches(reaches: &mut Vec<Reach>, visible: &[(usize, usize)], strips: &Range<usize>) {
    reaches.clear();
    reaches.extend(visible.get(strips.clone()).unwrap_or(&[]).iter().map(|blocks| reach(*blocks)));
}

/// Edges side by side, for steps that look at them more than once.
fn listed<'a>(list: &'a mut Vec<Edge>, edges: Edges<'_>) -> &'a mut Vec<Edge> {
    list.clear();
    edges.for_each(|edge| list.push(edge));
    list
}

/// Adds the whole pixels of `spans` (in order of rows) that lie in rows of this band and of `bounds`.
fn add_spans(frame: &Frame<'_>, cells: &mut Accumulator, bounds: IntRect, spans: &[Span]) {
    let IntRect { top, bottom, .. } = bounds.intersect(frame.area());
    let first = spans.partition_point(|span| span.y < top);
    let end = spans.partition_point(|span| span.y < bottom);
    for span in spans.get(first..end).unwrap_or(&[]) {
        let row = (span.y - frame.top) as usize;
        let Some(mut strip) = cells.strip(row / BLOCK_HEIGHT) else { continue };
        let limit = (frame.blocks * BLOCK_WIDTH) as i32;
        let (start, end) = (span.start.clamp(0, limit), span.end.clamp(0, limit));
        if start < end {
            let row = row % BLOCK_HEIGHT;
            strip.add_row_piece(row, start << 8, start << 8, 256);
            strip.add_row_piece(row, end << 8, end << 8, -256);
        }
    }
}

impl From<FillRule> for CoverageRule {
    fn from(rule: FillRule) -> Self {
        match rule {
            FillRule::NonZero => Self::NonZero,
            FillRule::EvenOdd => Self::EvenOdd,
        }
    }
}
