//! Edges listed by band.

use fearless_simd::prelude::*;
use fearless_simd::{f32x16, i32x16};

use super::bar::Bar;
use super::cut::Cutter;
use super::edge::{Edge, FixedPoint, append_closed};
use super::exact::{MOST_CORNERS, Resolved, Resolver};
use super::round_rect::RoundRect;
use crate::geom::{FixedRect, IntRect, Point};
use crate::num::fixed;
use crate::num::lanes::{max_f32, min_f32};
use crate::path::polygons::Polygons;
use crate::style::FillRule;

/// Edges that are handed over at once.
pub(super) const LANES: usize = 16;

/// Outlines that reach further, in pixels, are not asked where they cross.
const FARTHEST: f32 = 1e6;

/// What one command is in one band.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BandItem {
    pub(crate) command: u32,
    pub(crate) role: Role,
    pub(crate) content: Content,
}

/// What a command may mean for those before it: known without a look at it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// It leaves them visible.
    Plain,
    /// It hides what it covers whole.
    Opaque,
    /// It begins or ends a layer.
    Bracket,
}

/// What a band needs to know of an item.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Content {
    /// A shape's edges, if it has any: some of the band's.
    Edges { start: u32, end: u32 },
    /// A rectangle in one colour, drawn over what is there: there is no need to look at the command.
    Rect(FixedRect, [u8; 4]),
    /// A shape that has no edges.
    RoundRect(RoundRect),
    /// A thin bar: one of [`EdgeBins::bars`].
    Bar(u32),
}

/// A bar, and how much of it is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BarItem {
    pub(crate) bar: Bar,
    /// The device pixels that may be drawn.
    pub(crate) clip: IntRect,
    /// The colour in which it is drawn over what is there, if it is: there is no need to look at the command.
    pub(crate) color: Option<[u8; 4]>,
}

impl BarItem {
    /// The pixels that it touches of those that may be drawn.
    #[inline(always)]
    pub(crate) fn bounds(&self) -> IntRect {
        self.bar.bounds.intersect(self.clip)
    }
}

impl BandItem {
    /// One whose edges are still to be listed, from `start` on.
    #[inline(always)]
    fn open(command: u32, role: Role, start: usize) -> Self {
        let start = start as u32;
        Self { command, role, content: Content::Edges { start, end: start } }
    }
}

/// What one band has to draw, in the order of the commands.
#[derive(Debug, Default)]
pub(crate) struct BandList {
    /// Each names the point at which an edge starts; it ends at the next point.
    edges: Vec<u32>,
    pub(crate) items: Vec<BandItem>,
}

/// Corners of outlines, and for each band of a frame the edges between them that touch it.
#[derive(Debug, Default)]
pub(crate) struct EdgeBins {
    points: Vec<FixedPoint>,
    bars: Vec<BarItem>,
    bands: Vec<BandList>,
    /// log2 of a band's height in 1/256 pixel.
    band_shift: u32,
    resolver: Resolver,
    /// Those of outlines that are still to be cut.
    uncut: Vec<FixedPoint>,
}

/// What bounds a draw in one band.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Boundary<'a> {
    Edges(Edges<'a>),
    RoundRect(RoundRect),
    Bar(&'a Bar),
}

impl Default for Boundary<'_> {
    fn default() -> Self {
        Self::Edges(Edges::default())
    }
}

impl Boundary<'_> {
    /// How many edges cost as much, to a guess.
    pub(crate) fn cost(self) -> usize {
        match self {
            Self::Edges(edges) => edges.len(),
            Self::RoundRect(_) | Self::Bar(_) => 8,
        }
    }
}

/// The edges of one draw in one band.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Edges<'a> {
    points: &'a [FixedPoint],
    starts: &'a [u32],
}

impl<'a> Edges<'a> {
    /// Those between each of the points numbered by `starts`, which go up, and the next.
    #[cfg(test)]
    pub(super) fn of(points: &'a [FixedPoint], starts: &'a [u32]) -> Self {
        Self { points, starts }
    }
}

impl Edges<'_> {
    /// How many edges there are; some may be horizontal.
    pub(crate) fn len(self) -> usize {
        self.starts.len()
    }

    /// The edges in the order of their outline. Those that lie along a scanline are left out.
    #[inline(always)]
    pub(crate) fn for_each(self, mut f: impl FnMut(Edge)) {
        for start in self.starts {
            if let Some([from, to]) = self.points.get(*start as usize..).and_then(|rest| rest.first_chunk::<2>())
                && from.y != to.y
            {
                f(Edge { x0: from.x, y0: from.y, x1: to.x, y1: to.y });
            }
        }
    }

    /// The edges [`LANES`] at a time: where they start, where they end, and how many there are.
    #[inline(always)]
    pub(super) fn for_batches(self, mut f: impl FnMut(&[FixedPoint; LANES], &[FixedPoint; LANES], usize)) {
        for starts in self.starts.chunks(LANES) {
            let (Some(first), Some(last)) = (starts.first(), starts.last()) else { break };
            let (mut from, mut to) = ([FixedPoint::default(); LANES], [FixedPoint::default(); LANES]);
            // Numbers go up: where the last is as much more than the first as there are, the edges follow each other.
            let near = self.points.get(*first as usize..).and_then(|rest| rest.first_chunk::<{ LANES + 1 }>());
            if let Some(points) = near
                && (last - first) as usize + 1 == starts.len()
            {
                let [start @ .., _] = points;
                let [_, end @ ..] = points;
                (from, to) = (*start, *end);
            } else {
                for (start, (from, to)) in starts.iter().zip(from.iter_mut().zip(&mut to)) {
                    if let Some(points) = self.points.get(*start as usize..).and_then(|rest| rest.first_chunk::<2>()) {
                        [*from, *to] = *points;
                    }
                }
            }
            f(&from, &to, starts.len());
        }
    }

    /// At most `size` edges at a time.
    pub(crate) fn chunks(self, size: usize) -> impl Iterator<Item = Self> {
        self.starts.chunks(size).map(move |starts| Self { starts, ..self })
    }
}

impl EdgeBins {
    /// Empties the bins and sets them up for bands of `1 << height_shift` rows.
    pub(crate) fn reset(&mut self, bands: usize, height_shift: u32) {
        self.band_shift = height_shift + fixed::SHIFT;
        self.points.clear();
        self.bars.clear();
        for band in &mut self.bands {
            band.edges.clear();
            band.items.clear();
        }
        self.bands.resize_with(bands, BandList::default);
    }

    /// What was listed for band `index`.
    pub(crate) fn band(&self, index: usize) -> Option<&BandList> {
        self.bands.get(index)
    }

    /// What bounds one of a band's items.
    #[inline(always)]
    pub(crate) fn boundary<'a>(&'a self, band: &'a BandList, item: BandItem) -> Boundary<'a> {
        match item.content {
            Content::Edges { start, end } => {
                let starts = band.edges.get(start as usize..end as usize).unwrap_or(&[]);
                Boundary::Edges(Edges { points: &self.points, starts })
            }
            Content::RoundRect(shape) => Boundary::RoundRect(shape),
            Content::Bar(index) => self.bar(index).map_or(Boundary::default(), |item| Boundary::Bar(&item.bar)),
            Content::Rect(..) => Boundary::default(),
        }
    }

    /// The bar that an item names.
    #[inline(always)]
    pub(crate) fn bar(&self, index: u32) -> Option<&BarItem> {
        self.bars.get(index as usize)
    }

    /// Lists `command`, which has no edges, for every band that `bounds` (device pixels) touches.
    pub(crate) fn list(&mut self, command: u32, role: Role, bounds: IntRect) {
        for band in self.bands_of(bounds.top << fixed::SHIFT, bounds.bottom << fixed::SHIFT) {
            band.items.push(BandItem::open(command, role, band.edges.len()));
        }
    }

    /// Lists `command`, a rectangle in one colour, for every band that it touches.
    #[inline(always)]
    pub(crate) fn list_rect(&mut self, command: u32, role: Role, rect: FixedRect, color: [u8; 4]) {
        if rect.left < rect.right {
            for band in self.bands_of(rect.top, rect.bottom) {
                band.items.push(BandItem { command, role, content: Content::Rect(rect, color) });
            }
        }
    }

    /// Lists `command`, a shape of which what lies in `clip` (device pixels) is drawn, for every band that it touches.
    #[inline(always)]
    pub(crate) fn list_round_rect(&mut self, (command, role): (u32, Role), shape: RoundRect, clip: IntRect) {
        let seen = shape.rect.intersect(clip);
        if seen.left < seen.right {
            for band in self.bands_of(seen.top, seen.bottom) {
                band.items.push(BandItem { command, role, content: Content::RoundRect(shape) });
            }
        }
    }

    /// Lists `command`, a thin bar, for every band that it touches.
    #[inline(always)]
    pub(crate) fn list_bar(&mut self, command: u32, item: BarItem) {
        let (index, bounds) = (self.bars.len() as u32, item.bounds());
        if bounds.is_empty() {
            return;
        }
        self.bars.push(item);
        for band in self.bands_of(bounds.top << fixed::SHIFT, bounds.bottom << fixed::SHIFT) {
            band.items.push(BandItem { command, role: Role::Plain, content: Content::Bar(index) });
        }
    }

    /// Lists the edges of `polygons` within `clip` (device pixels) as those of a command, for the bands that they touch.
    /// `open_right` says that no pixel right of `clip` can be drawn. If `crossings` are to be resolved, edges that cross are replaced
    /// by what bounds the inside by that rule.
    #[inline(always)]
    pub(crate) fn add<S: Simd>(
        &mut self,
        simd: S,
        (command, role): (u32, Role),
        polygons: &Polygons,
        clip: IntRect,
        open_right: bool,
        crossings: Option<FillRule>,
    ) {
        let extent = extent_of_eights(simd, polygons.eights());
        let crossings = crossings.filter(|_| {
            extent.is_some_and(|extent| extent.iter().all(|v| v.abs() < FARTHEST)) && polygons.count() <= MOST_CORNERS
        });
        match extent {
            Some([left, top, right, bottom])
                if left >= clip.left as f32
                    && top >= clip.top as f32
                    && right <= clip.right as f32
                    && bottom <= clip.bottom as f32 =>
            {
                let (top, bottom) = (fixed::from_f32(top), fixed::from_f32(bottom));
                self.add_inside(simd, (command, role), polygons, crossings, top, bottom);
            }
            _ => {
                // Before they are cut, so that it does not depend on where.
                self.uncut.clear();
                let resolved = match crossings {
                    Some(rule) => self.resolver.resolve(simd, polygons, rule, &mut self.uncut),
                    None => Resolved::Unknown,
                };
                self.add_cut((command, role), polygons, resolved, clip, open_right);
            }
        }
    }

    /// Lists polygons that lie between `top` and `bottom` (fixed point) and need no clipping.
    #[inline(always)]
    fn add_inside<S: Simd>(
        &mut self,
        simd: S,
        (command, role): (u32, Role),
        polygons: &Polygons,
        crossings: Option<FillRule>,
        top: i32,
        bottom: i32,
    ) {
        let Self { points, bands, band_shift, resolver, .. } = self;
        if top == bottom || u32::try_from(points.len() + 2 * polygons.count()).is_err() {
            return;
        }
        let first = points.len();
        let resolved = match crossings {
            Some(rule) => resolver.resolve(simd, polygons, rule, points),
            None => Resolved::Unknown,
        };
        if resolved == Resolved::Pieces && u32::try_from(first + resolver.len()).is_err() {
            return;
        }
        let (first_band, last_band) = (top >> *band_shift, (bottom - 1) >> *band_shift);
        let Some(bands) = bands.get_mut(first_band as usize..=last_band as usize) else { return };
        for band in bands.iter_mut() {
            band.items.push(BandItem::open(command, role, band.edges.len()));
        }
        let first_top = first_band << *band_shift;
        match resolved {
            Resolved::Unknown => {
                for (eights, count) in polygons.iter_eights() {
                    let start = points.len();
                    append_closed(simd, eights, count, points);
                    list_from(simd, bands, points, start, first_top, *band_shift);
                }
            }
            Resolved::Outlines => {
                for outline in resolver.outlines() {
                    let points = points.get(..first + outline.end).unwrap_or(&[]);
                    list_from(simd, bands, points, first + outline.start, first_top, *band_shift);
                }
            }
            Resolved::Pieces => {
                for piece in resolver.pieces() {
                    let start = points.len();
                    points.extend_from_slice(piece);
                    list_from(simd, bands, points, start, first_top, *band_shift);
                }
            }
        }
        let mut empty = true;
        for band in bands {
            empty &= close_item(band);
        }
        if empty {
            points.truncate(first);
        }
    }

    /// Lists what may leave the clip.
    #[inline(never)]
    fn add_cut(
        &mut self,
        (command, role): (u32, Role),
        polygons: &Polygons,
        resolved: Resolved,
        clip: IntRect,
        open_right: bool,
    ) {
        let Self { points, bands, band_shift, resolver, uncut, .. } = self;
        let Some(bands) = touched(bands, clip.top << fixed::SHIFT, clip.bottom << fixed::SHIFT, *band_shift) else {
            return;
        };
        let first_top = (clip.top.max(0) << fixed::SHIFT) >> *band_shift << *band_shift;
        for band in bands.iter_mut() {
            band.items.push(BandItem::open(command, role, band.edges.len()));
        }
        let mut cutter = Cutter::new(
            clip,
            open_right,
            #[inline(always)]
            |edge| {
                if u32::try_from(points.len() + 2).is_ok() {
                    let (from, to) = (FixedPoint { x: edge.x0, y: edge.y0 }, FixedPoint { x: edge.x1, y: edge.y1 });
                    // Most edges go on where the last one ended.
                    if points.last() != Some(&from) {
                        points.push(from);
                    }
                    let start = points.len() as u32 - 1;
                    points.push(to);
                    let (top, bottom) = if from.y < to.y { (from.y, to.y) } else { (to.y, from.y) };
                    let (first, last) = ((top - first_top) >> *band_shift, (bottom - 1 - first_top) >> *band_shift);
                    for band in bands.get_mut(first as usize..=last as usize).unwrap_or(&mut []) {
                        band.edges.push(start);
                    }
                }
            },
        );
        let polyline = |points: &[FixedPoint]| {
            for pair in points.windows(2) {
                if let [from, to] = pair {
                    cutter.edge((from.x, from.y), (to.x, to.y));
                }
            }
        };
        match resolved {
            Resolved::Unknown => polygons.iter().for_each(|polygon| cutter.polygon(polygon)),
            Resolved::Outlines => resolver.outlines().filter_map(|outline| uncut.get(outline)).for_each(polyline),
            Resolved::Pieces => resolver.pieces().for_each(polyline),
        }
        for band in bands {
            close_item(band);
        }
    }

    fn bands_of(&mut self, top: i32, bottom: i32) -> &mut [BandList] {
        touched(&mut self.bands, top, bottom, self.band_shift).unwrap_or(&mut [])
    }
}

/// The bands between `top` and `bottom` (fixed point).
fn touched(bands: &mut [BandList], top: i32, bottom: i32, band_shift: u32) -> Option<&mut [BandList]> {
    let top = top.max(0);
    if top >= bottom {
        return None;
    }
    let last = ((bottom - 1) >> band_shift) as usize + 1;
    let last = last.min(bands.len());
    bands.get_mut((top >> band_shift) as usize..last)
}

/// Ends the band's last item; drops it if it has no edges, and says whether it has none.
#[inline(always)]
fn close_item(band: &mut BandList) -> bool {
    let end = band.edges.len() as u32;
    let Some(BandItem { content: Content::Edges { start, end: item_end }, .. }) = band.items.last_mut() else {
        return true;
    };
    *item_end = end;
    let empty = *start == end;
    if empty {
        band.items.pop();
    }
    empty
}

/// Lists the edges between the points from `start` on for each of `bands` that they touch; the first band's top is
/// at `first_top`.
#[inline(always)]
fn list_from<S: Simd>(
    simd: S,
    bands: &mut [BandList],
    points: &[FixedPoint],
    start: usize,
    first_top: i32,
    band_shift: u32,
) {
    if let [band] = bands {
        band.edges.extend(start as u32..(points.len() as u32).saturating_sub(1));
    } else {
        list_by_band(simd, bands, points, start, first_top, band_shift);
    }
}

/// As [`list_from`] for several bands.
#[inline(always)]
fn list_by_band<S: Simd>(
    simd: S,
    bands: &mut [BandList],
    points: &[FixedPoint],
    start: usize,
    first_top: i32,
    band_shift: u32,
) {
    let band_of = |y: i32| ((y - first_top) >> band_shift) as usize;
    let Some(([first, ..], mut rest)) = points.get(start..).and_then(|points| points.split_first_chunk::<1>()) else {
        return;
    };
    // Outlines stay in a band for a while: what lies between two changes is listed in one go.
    let (mut run, mut end, mut band, mut last_y) = (start as u32, start as u32, band_of(first.y), first.y);
    let mut list = |band: usize, run: u32, end: u32| {
        if let Some(band) = bands.get_mut(band) {
            band.edges.extend(run..end);
        }
    };
    loop {
        while let Some((eight, after)) = rest.split_first_chunk::<8>() {
            let y = i32x16::load_array(simd, bytemuck::cast(*eight));
            // x, in every other lane, does not matter.
            let here = ((y - first_top) >> band_shift).simd_eq(band as i32).to_bitmask() as u32 | 0x5555;
            let stay = here.trailing_ones() as usize / 2;
            if stay < 8 {
                if let Some(last) = stay.checked_sub(1).and_then(|last| eight.get(last)) {
                    (rest, end, last_y) = (rest.get(stay..).unwrap_or(&[]), end + stay as u32, last.y);
                }
                break;
            }
            (rest, end, last_y) = (after, end + 8, eight[7].y);
        }
        let Some(([point], after)) = rest.split_first_chunk::<1>() else { break };
        let next = band_of(point.y);
        if next != band {
            list(band, run, end);
            // The edge that leaves it; an end on a band's top is not in that band.
            let (low, high) = if last_y < point.y { (last_y, point.y) } else { (point.y, last_y) };
            for crossed in band_of(low)..=band_of(high - 1) {
                list(crossed, end, end + 1);
            }
            (run, band) = (end + 1, next);
        }
        (rest, end, last_y) = (after, end + 1, point.y);
    }
    list(band, run, end);
}

/// The smallest and greatest x and y of some points, as left, top, right, bottom; `None` if there is no point, or one
/// that is not finite.
#[inline(always)]
pub(crate) fn extent<S: Simd>(simd: S, points: &[Point]) -> Option<[f32; 4]> {
    let first = *points.first()?;
    let (eights, rest) = points.as_chunks::<8>();
    let mut last = [first; 8];
    for (last, p) in last.iter_mut().zip(rest) {
        *last = *p;
    }
    extent_of(simd, first, eights.iter().chain(std::iter::once(&last)))
}

/// As [`extent`], of points in eights.
#[inline(always)]
fn extent_of_eights<S: Simd>(simd: S, eights: &[[Point; 8]]) -> Option<[f32; 4]> {
    let [first, ..] = eights.first()?;
    extent_of(simd, *first, eights.iter())
}

/// As [`extent`], of points one of which is `first`.
#[inline(always)]
fn extent_of<'a, S: Simd>(simd: S, first: Point, eights: impl Iterator<Item = &'a [Point; 8]>) -> Option<[f32; 4]> {
    let start = f32x16::load_array(simd, bytemuck::cast([first; 8]));
    let (mut low, mut high, mut finite) = (start, start, start * 0.0);
    for block in eights {
        let v = f32x16::load_array(simd, bytemuck::cast(*block));
        low = min_f32(v, low);
        high = max_f32(v, high);
        finite += v * 0.0;
    }
    if finite.to_array() != [0.0; 16] {
        return None;
    }
    let ((low, low_too), (high, high_too)) = (low.split(), high.split());
    let (low, high) = (min_f32(low, low_too), max_f32(high, high_too));
    // Written out: iterators over every second lane are calls.
    let smaller = |a: f32, b: f32| if b < a { b } else { a };
    let [a, b, c, d, e, f, g, h] = low.to_array();
    let (left, top) = (smaller(smaller(a, c), smaller(e, g)), smaller(smaller(b, d), smaller(f, h)));
    let larger = |a: f32, b: f32| if b > a { b } else { a };
    let [a, b, c, d, e, f, g, h] = high.to_array();
    let (right, bottom) = (larger(larger(a, c), larger(e, g)), larger(larger(b, d), larger(f, h)));
    Some([left, top, right, bottom])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::path::flatten::PolygonSink;

    fn bins_of(points: &[(f32, f32)], clip: IntRect, open_right: bool, bands: usize, height_shift: u32) -> EdgeBins {
        let mut polygons = Polygons::default();
        polygons.begin(points[0].into());
        for p in &points[1..] {
            polygons.line((*p).into());
        }
        polygons.end();
        let mut bins = EdgeBins::default();
        bins.reset(bands, height_shift);
        dispatch!(SimdLevel::best(), simd => bins.add(simd, (7, Role::Plain), &polygons, clip, open_right, None));
        bins
    }

    fn edges_of(points: &[(f32, f32)], clip: IntRect, open_right: bool) -> Vec<Edge> {
        let bins = bins_of(points, clip, open_right, 1, 12);
        let band = bins.band(0).unwrap();
        let mut edges = Vec::new();
        for item in &band.items {
            if let Boundary::Edges(listed) = bins.boundary(band, *item) {
                listed.for_each(|edge| edges.push(edge));
            }
        }
        edges
    }

    /// The winding of a clipped outline at a pixel's centre, by the edges left of it.
    fn winding(edges: &[Edge], x: f64, y: f64) -> i32 {
        edges
            .iter()
            .map(|e| {
                let (x0, y0, x1, y1, s) = e.downward();
                let (x0, y0, x1, y1) =
                    (f64::from(x0) / 256.0, f64::from(y0) / 256.0, f64::from(x1) / 256.0, f64::from(y1) / 256.0);
                if y0 <= y && y < y1 && x0 + (x1 - x0) * (y - y0) / (y1 - y0) <= x { s } else { 0 }
            })
            .sum()
    }

    #[test]
    fn clipping_keeps_windings_inside_and_clears_them_outside() {
        let clip = IntRect::from_ltrb(10, 10, 30, 30);
        let far = 3e7;
        for points in [
            vec![(-5.0, 0.0), (50.0, 20.0), (0.0, 45.0)],
            vec![(0.0, 0.0), (40.0, 0.0), (40.0, 40.0), (0.0, 40.0)],
            vec![(-far, -far), (far, -far), (far, far), (-far, far)],
            vec![(15.0, -1e30), (25.0, -1e30), (20.0, 1e30)],
            vec![(-1e30, 15.0), (1e30, 15.5), (1e30, 25.3), (-1e30, 24.3)],
            vec![(12.0, 12.0), (f32::MAX, 20.0), (12.0, 28.0)],
        ] {
            for open_right in [false, true] {
                let edges = edges_of(&points, clip, open_right);
                for e in &edges {
                    assert!(e.y0 != e.y1 && [e.x0, e.x1].iter().all(|x| (2560..=7680).contains(x)), "{e:?}");
                    assert!([e.y0, e.y1].iter().all(|y| (2560..=7680).contains(y)), "{e:?}");
                }
                for y in 0..40 {
                    for x in 0..40 {
                        let (px, py) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
                        let inside = (10..30).contains(&x) && (10..30).contains(&y);
                        if !inside && open_right && x >= 30 {
                            continue;
                        }
                        let n = points.len();
                        let mut nearest = f64::MAX;
                        let expected: i32 = (0..n)
                            .map(|i| {
                                let (x0, y0) = (f64::from(points[i].0), f64::from(points[i].1));
                                let (x1, y1) = (f64::from(points[(i + 1) % n].0), f64::from(points[(i + 1) % n].1));
                                let crosses = (y0 <= py) != (y1 <= py);
                                let t = (py - y0) / (y1 - y0);
                                let at = x0 * (1.0 - t) + x1 * t;
                                if crosses {
                                    nearest = nearest.min((at - px).abs());
                                }
                                if crosses && at <= px { if y1 > y0 { 1 } else { -1 } } else { 0 }
                            })
                            .sum();
                        if nearest > 0.02 {
                            let expected = if inside { expected } else { 0 };
                            assert_eq!(winding(&edges, px, py), expected, "({x}, {y}) of {points:?}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn an_edge_is_listed_in_each_band_that_it_touches() {
        let clip = IntRect::from_ltrb(0, 0, 32, 32);
        for far in [9.0, 90.0] {
            // With a corner outside of the clip, the outline goes the other way through the code.
            let bins = bins_of(&[(1.0, 8.0), (1.0, 24.0), (far, 24.0)], clip, true, 4, 3);
            let counts: Vec<_> = (0..4).map(|b| bins.band(b).unwrap().edges.len()).collect();
            let items: Vec<_> = (0..4).map(|b| bins.band(b).unwrap().items.len()).collect();
            assert_eq!(items, [0, 1, 1, 0], "bands without edges do not list the command");
            assert_eq!(counts[1], 2);
            assert_eq!((counts[0], counts[3]), (0, 0));
        }
    }

    #[test]
    fn points_are_rounded_as_one_by_one_and_their_extent_is_found() {
        let points: Vec<Point> =
            (0..29).map(|i| Point::new(i as f32 * 1.7 - 20.0 + 0.5 / 256.0, 16_383.3 - i as f32 * 0.9)).collect();
        for level in SimdLevel::available() {
            for count in 1..points.len() {
                let points = &points[..count];
                let mut polygons = Polygons::default();
                polygons.begin(points[0]);
                points[1..].iter().for_each(|p| polygons.line(*p));
                polygons.end();
                let (eights, own) = polygons.iter_eights().next().unwrap();
                let mut out = vec![FixedPoint { x: 7, y: 7 }];
                dispatch!(level, simd => append_closed(simd, eights, own, &mut out));
                let expected: Vec<_> =
                    points.iter().map(|p| FixedPoint { x: fixed::from_f32(p.x), y: fixed::from_f32(p.y) }).collect();
                assert_eq!((&out[1..=count], &out[count + 1..]), (&expected[..], &expected[..1]), "{level:?}");
                let last = points[count - 1];
                for found in [
                    dispatch!(level, simd => extent(simd, points)),
                    dispatch!(level, simd => extent_of_eights(simd, polygons.eights())),
                ] {
                    assert_eq!(found, Some([points[0].x, last.y, last.x, points[0].y]), "{level:?}");
                }
            }
            let bad = [Point::ZERO, Point::new(f32::NAN, 1.0), Point::ZERO];
            assert_eq!(dispatch!(level, simd => extent(simd, &bad)), None);
            assert_eq!(dispatch!(level, simd => extent(simd, &[])), None);
        }
    }
}
