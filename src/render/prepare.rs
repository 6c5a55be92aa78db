//! Shapes to edges, listed by band.

use std::ops::Range;

use fearless_simd::Simd;

use super::RenderSettings;
use super::plan::Plan;
use crate::blend::BlendMode;
use crate::display_list::{ClipId, ClipKind, Command, DisplayList, Draw, Geometry};
use crate::geom::{FixedRect, IntRect, Point, Rect};
use crate::num::level::dispatch;
use crate::path::flatten::{PolygonSink, TOLERANCE, flatten_fill};
use crate::path::polygons::Polygons;
use crate::path::round_rect::{may_be_round_rect, round_rect};
use crate::path::stretch::Stretch;
use crate::path::stroke::{StrokeScratch, stroke, stroke_stretch};
use crate::raster::bar::Bar;
use crate::raster::bins::{BandItem, BandList, BarItem, Boundary, EdgeBins, Role, extent};
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
    /// If it holds but a stretch of one command: which.
    stretch: Option<Stretch>,
}

/// What of a recording is prepared in one go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Slice {
    commands: Range<usize>,
    /// Not all of the one command, but a stretch of it.
    stretch: Option<Stretch>,
}

/// How many chunks to prepare `commands` in: several per thread, so that a costly one does not hold
/// up the rest.
pub(super) fn chunk_count(commands: usize, threads: usize) -> usize {
    if threads <= 1 { 1 } else { commands.min(8 * threads).max(1) }
}

/// A recording cut into `chunks` slices of nearly as many commands, and those further where strokes are long. The stretches of one
/// follow each other.
pub(super) fn slices(list: &DisplayList, chunks: usize) -> Vec<Slice> {
    let commands = list.commands.len();
    let mut slices = Vec::with_capacity(chunks);
    let mut long_strokes = list.long_strokes().peekable();
    for chunk in 0..chunks {
        let (mut start, end) = (commands * chunk / chunks, commands * (chunk + 1) / chunks);
        while let Some(long) = long_strokes.next_if(|long| (long.command as usize) < end) {
            let (command, count) = (long.command as usize, long.stretches);
            if start < command {
                slices.push(Slice { commands: start..command, stretch: None });
            }
            let stretch = |index| Slice { commands: command..command + 1, stretch: Some(Stretch { index, count }) };
            slices.extend((0..count).map(stretch));
            start = command + 1;
        }
        if start < end {
            slices.push(Slice { commands: start..end, stretch: None });
        }
    }
    slices
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

    /// The bar that an item names.
    #[inline(always)]
    pub(super) fn bar(&self, index: u32) -> Option<&BarItem> {
        self.bins.bar(index)
    }

    /// If it holds but a stretch of one command: which.
    pub(super) fn stretch(&self) -> Option<Stretch> {
        self.stretch
    }

    /// Lists the edges of a slice of the list for the bands of `frame`. `settings` are resolved.
    pub(super) fn prepare(
        &mut self,
        list: &DisplayList,
        plan: &Plan,
        slice: &Slice,
        frame: IntRect,
        settings: RenderSettings,
    ) {
        let RenderSettings { level, band_height, .. } = settings;
        self.bins.reset(frame.height().div_ceil(band_height) as usize, band_height.trailing_zeros());
        self.stroke.level = level;
        self.stretch = slice.stretch;
        dispatch!(level, simd => self.prepare_with(simd, list, plan, slice.commands.clone(), frame));
    }

    #[inline(always)]
    fn prepare_with<S: Simd>(&mut self, simd: S, list: &DisplayList, plan: &Plan, range: Range<usize>, frame: IntRect) {
        for index in range {
            let Some(command) = list.commands.get(index) else { break };
            let number = index as u32;
            match command {
                Command::Draw(draw) => {
                    let role = role(draw);
                    match solid_rect(draw) {
                        Some((rect, color)) => self.bins.list_rect(number, role, rect.intersect(frame), color),
                        None => {
                            let (antialias, bounds) = (draw.antialias, draw.bounds);
                            let color = solid(draw);
                            self.shape(simd, list, (number, role), &draw.geometry, antialias, bounds, color, frame);
                        }
                    }
                }
                Command::Clip(id) => {
                    if let Some(clip) = list.clip(*id)
                        && let ClipKind::Geometry { geometry, antialias } = &clip.kind
                    {
                        let item = (number, Role::Plain);
                        self.shape(simd, list, item, geometry, *antialias, clip.bounds, None, frame);
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
        color: Option<[u8; 4]>,
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
                    let transform = list.transform(*transform);
                    let (scratch, polygons) = (&mut self.stroke, &mut self.polygons);
                    if let Some(stretch) = self.stretch {
                        stroke_stretch(verbs, points, style, transform, TOLERANCE, stretch, scratch, polygons);
                    } else {
                        stroke(verbs, points, style, transform, TOLERANCE, bounds.to_rect(), scratch, polygons);
                    }
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
        if is_exact(antialias)
            && self.stretch.is_none()
            && let Some(polygon) = self.polygons.only()
        {
            // Such as lines along the axes.
            if let Some(color) = color
                && let Some(rect) = upright_rect(polygon)
            {
                self.bins.list_rect(item.0, item.1, FixedRect::new(rect).intersect(bounds), color);
                return;
            }
            if let Some(bar) = Bar::new(polygon) {
                self.bins.list_bar(item.0, BarItem { bar, clip: bounds, color });
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
fn solid_rect(draw: &Draw) -> Option<(FixedRect, [u8; 4])> {
    let rect = match draw.geometry {
        Geometry::Rect(rect) if is_exact(draw.antialias) => rect.intersect(draw.bounds),
        Geometry::Bounds => FixedRect::of_pixels(draw.bounds),
        _ => return None,
    };
    solid(draw).map(|color| (rect, color))
}

/// In which colour a draw is, if it is one, over what is there, within its bounds.
#[inline(always)]
fn solid(draw: &Draw) -> Option<[u8; 4]> {
    let over = draw.blend_mode == BlendMode::SourceOver || draw.blend_mode == BlendMode::Source && draw.opaque;
    draw.paint.color().filter(|_| draw.clip == ClipId::NONE && over)
}

/// Whether coverage is area, not a count of samples.
pub(super) fn is_exact(antialias: Antialias) -> bool {
    matches!(antialias, Antialias::Analytic | Antialias::Exact)
}

/// The rectangle that a polygon is, if its sides lie along the axes.
fn upright_rect(polygon: &[Point]) -> Option<Rect> {
    let [a, b, c, d]: &[Point; 4] = polygon.try_into().ok()?;
    let is_upright =
        a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y || a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x;
    is_upright.then(|| Rect::from_points(polygon)).flatten()
}

fn rectangle<K: PolygonSink>(rect: Rect, sink: &mut K) {
    let [a, b, c, d]: [Point; 4] = rect.corners();
    sink.begin(a);
    sink.line(b);
    sink.line(c);
    sink.line(d);
    sink.end();
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display_list::PaintRef;
    use crate::geom::Transform;
    use crate::path::{Path, Stroke};

    /// Lines and, where `long` says so, strokes of so many stretches. The last of them is not there in the end.
    fn list(commands: usize, long: &[(usize, usize)]) -> DisplayList {
        let mut list = DisplayList::default();
        let mut path = Path::new();
        path.move_to((1.0, 2.0)).line_to((30.0, 40.0));
        for index in 0..commands {
            let stretches = long.iter().find(|(command, _)| *command == index).map_or(1, |(_, stretches)| *stretches);
            let (outline, transform) = (list.add_path(&path), list.add_transform(Transform::IDENTITY));
            let style = list.add_stroke(&Stroke::new(1.0), stretches);
            list.commands.push(Command::Draw(Draw {
                geometry: Geometry::Stroke { outline, transform, style },
                paint: PaintRef::of_color([9, 9, 9, 255]),
                antialias: if stretches == 7 { Antialias::Exact } else { Antialias::Analytic },
                blend_mode: BlendMode::SourceOver,
                clip: ClipId::NONE,
                bounds: IntRect::from_xywh(0, 0, 50, 50),
                opaque: true,
            }));
        }
        list.add_stroke(&Stroke::new(1.0), 3);
        list
    }

    fn of(list: &DisplayList, chunks: usize) -> Vec<(Range<usize>, usize)> {
        let slices = slices(list, chunks).into_iter();
        slices
            .map(|slice| (slice.commands, slice.stretch.map_or(0, |stretch| 10 * stretch.index + stretch.count)))
            .collect()
    }

    #[test]
    fn slices_are_chunks_but_for_long_strokes() {
        assert_eq!(of(&list(10, &[]), 3), [(0..3, 0), (3..6, 0), (6..10, 0)]);
        assert_eq!(of(&list(10, &[(4, 2)]), 1), [(0..4, 0), (4..5, 2), (4..5, 12), (5..10, 0)]);
        assert_eq!(of(&list(2, &[(0, 2), (1, 2)]), 1), [(0..1, 2), (0..1, 12), (1..2, 2), (1..2, 12)]);
        let at_an_end = of(&list(4, &[(1, 2)]), 2);
        assert_eq!(at_an_end, [(0..1, 0), (1..2, 2), (1..2, 12), (2..4, 0)]);
        // `Exact` takes it as a whole.
        assert_eq!(of(&list(3, &[(1, 7)]), 1), [(0..3, 0)]);
        assert_eq!(of(&DisplayList::default(), 1), []);
    }
}
