//! Shapes to edges, listed by band.

use std::ops::Range;

use fearless_simd::Simd;

use super::RenderSettings;
use super::plan::Plan;
use crate::blend::BlendMode;
use crate::display_list::{ClipId, ClipKind, Command, DisplayList, Draw, Geometry};
use crate::geom::{FixedRect, IntRect, Point, Rect};
use crate::num::level::dispatch;
use crate::paint::PreparedPaint;
use crate::path::flatten::{PolygonSink, TOLERANCE, flatten_fill};
use crate::path::polygons::Polygons;
use crate::path::round_rect::{may_be_round_rect, round_rect};
use crate::path::stroke::{StrokeScratch, stroke};
use crate::raster::bins::{BandItem, BandList, Boundary, EdgeBins, Role, extent};
use crate::raster::round_rect::RoundRect;
use crate::style::{Antialias, FillRule};

/// The edges of a range of commands. Chunks are prepared independently of each other; a band reads them
/// one after another.
#[derive(Debug, Default)]
pub(crate) struct Chunk {
    bins: EdgeBins,
    /// The shape in work: its outline's points in device space, and what it is flattened to.
    mapped: Vec<Point>,
    polygons: Polygons,
    stroke: StrokeScratch,
}

/// How many chunks to prepare `commands` in: several per thread, so that a costly one does not hold
/// up the rest.
pub(super) fn chunk_count(commands: usize, threads: usize) -> usize {
    if threads <= 1 { 1 } else { commands.min(8 * threads).max(1) }
}

/// `commands` cut into `chunks` ranges of nearly equal length.
pub(super) fn split(commands: usize, chunks: usize) -> impl Iterator<Item = Range<usize>> {
    (0..chunks).map(move |chunk| commands * chunk / chunks..commands * (chunk + 1) / chunks)
}

impl Chunk {
    /// What the chunk has for band `index`.
    pub(super) fn band(&self, index: usize) -> Option<&BandList> {
        self.bins.band(index)
    }

    /// What bounds one of its items.
    #[inline(always)]
    pub(super) fn boundary<'a>(&'a self, band: &'a BandList, item: BandItem) -> Boundary<'a> {
        self.bins.boundary(band, item)
    }

    /// Lists the edges of `range` of the list's commands for the bands of `frame`. `settings` are resolved.
    pub(super) fn prepare(
        &mut self,
        list: &DisplayList,
        plan: &Plan,
        range: Range<usize>,
        frame: IntRect,
        settings: RenderSettings,
    ) {
        let RenderSettings { level, band_height, .. } = settings;
        self.bins.reset(frame.height().div_ceil(band_height) as usize, band_height.trailing_zeros());
        self.stroke.level = level;
        dispatch!(level, simd => self.prepare_with(simd, list, plan, range, frame));
    }

    #[inline(always)]
    fn prepare_with<S: Simd>(&mut self, simd: S, list: &DisplayList, plan: &Plan, range: Range<usize>, frame: IntRect) {
        for index in range {
            let Some(command) = list.commands.get(index) else { break };
            let number = index as u32;
            match command {
                Command::Draw(draw) => {
                    let role = role(draw);
                    match solid_rect(list, draw) {
                        Some((rect, color)) => self.bins.list_rect(number, role, rect.intersect(frame), color),
                        None => {
                            let (antialias, bounds) = (draw.antialias, draw.bounds);
                            self.shape(simd, list, (number, role), &draw.geometry, antialias, bounds, frame);
                        }
                    }
                }
                Command::Clip(id) => {
                    if let Some(clip) = list.clip(*id)
                        && let ClipKind::Geometry { geometry, antialias } = &clip.kind
                    {
                        let item = (number, Role::Plain);
                        self.shape(simd, list, item, geometry, *antialias, clip.bounds, frame);
                    }
                }
                Command::BeginLayer(layer) => self.bins.list(number, Role::Bracket, layer.bounds.intersect(frame)),
                Command::EndLayer(layer) => self.bins.list(number, Role::Bracket, layer.bounds.intersect(frame)),
                Command::BeginMask(bounds) | Command::EndMask(bounds, _) => {
                    self.bins.list(number, Role::Bracket, bounds.intersect(frame));
                }
                Command::Effect(_) => {
                    if let Some(picture) = plan.picture(number) {
                        self.bins.list(number, Role::Plain, picture.bounds.intersect(frame));
                    }
                }
            }
        }
    }

    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a command's facts, from the only place that knows them")]
    fn shape<S: Simd>(
        &mut self,
        simd: S,
        list: &DisplayList,
        item: (u32, Role),
        geometry: &Geometry,
        antialias: Antialias,
        bounds: IntRect,
        frame: IntRect,
    ) {
        let bounds = bounds.intersect(frame);
        if bounds.is_empty() {
            return;
        }
        self.polygons.clear();
        match geometry {
            Geometry::Fill { outline, transform, .. } => {
                let (verbs, points) = list.outline(*outline);
                let transform = list.transform(*transform);
                let points = if transform.is_identity() {
                    points
                } else {
                    self.mapped.clear();
                    self.mapped.extend(points.iter().map(|p| transform.map(*p)));
                    &self.mapped
                };
                if is_exact(antialias)
                    && may_be_round_rect(verbs, points)
                    && let Some([left, top, right, bottom]) = extent(simd, points)
                    && let rect = Rect::from_ltrb(left, top, right, bottom)
                    && let Some(radii) = round_rect(simd, verbs, points, rect)
                    && let Some(shape) = RoundRect::new(rect, radii)
                {
                    self.bins.list_round_rect(item, shape, bounds);
                    return;
                }
                flatten_fill(simd, verbs, points, &mut self.polygons);
            }
            Geometry::Stroke { outline, transform, style } => {
                let (verbs, points) = list.outline(*outline);
                if let Some(style) = list.strokes.get(*style as usize) {
                    let visible = bounds.to_rect();
                    let transform = list.transform(*transform);
                    stroke(verbs, points, style, transform, TOLERANCE, visible, &mut self.stroke, &mut self.polygons);
                }
            }
            // What has no slanted edges is covered without a list of them, unless it is sampled.
            Geometry::Rect(rect) if !is_exact(antialias) => {
                rectangle(rect.intersect(bounds).to_rect(), &mut self.polygons);
            }
            Geometry::Rect(_) | Geometry::Bounds | Geometry::Spans(_) => {
                self.bins.list(item.0, item.1, bounds);
                return;
            }
        }
        let crossings = (antialias == Antialias::Exact).then_some(match geometry {
            Geometry::Fill { rule, .. } => *rule,
            _ => FillRule::NonZero,
        });
        self.bins.add(simd, item, &self.polygons, bounds, bounds.right >= frame.right, crossings);
    }
}

/// What a draw may mean for those before it.
#[inline(always)]
fn role(draw: &Draw) -> Role {
    let hides = draw.opaque
        && draw.clip == ClipId::NONE
        && matches!(draw.blend_mode, BlendMode::SourceOver | BlendMode::Source)
        && matches!(draw.geometry, Geometry::Fill { .. } | Geometry::Rect(_) | Geometry::Bounds);
    if hides { Role::Opaque } else { Role::Plain }
}

/// What a draw covers and in which colour, if it is a rectangle, in one colour, over what is there.
#[inline(always)]
fn solid_rect(list: &DisplayList, draw: &Draw) -> Option<(FixedRect, [u8; 4])> {
    let over = draw.blend_mode == BlendMode::SourceOver || draw.blend_mode == BlendMode::Source && draw.opaque;
    if draw.clip != ClipId::NONE || !over {
        return None;
    }
    let rect = match draw.geometry {
        Geometry::Rect(rect) if is_exact(draw.antialias) => rect.intersect(draw.bounds),
        Geometry::Bounds => FixedRect::of_pixels(draw.bounds),
        _ => return None,
    };
    match list.paints.get(draw.paint as usize) {
        Some(PreparedPaint::Solid(color)) => Some((rect, *color)),
        _ => None,
    }
}

/// Whether coverage is area, not a count of samples.
pub(super) fn is_exact(antialias: Antialias) -> bool {
    matches!(antialias, Antialias::Analytic | Antialias::Exact)
}

fn rectangle<K: PolygonSink>(rect: Rect, sink: &mut K) {
    let [a, b, c, d]: [Point; 4] = rect.corners();
    sink.begin(a);
    sink.line(b);
    sink.line(c);
    sink.line(d);
    sink.end();
}
