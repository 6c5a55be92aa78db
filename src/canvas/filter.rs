//! Layers with options: filters.

use std::sync::Arc;

use super::Canvas;
use super::state::{FilterLayer, OpenLayerKind};
use crate::blend::BlendMode;
use crate::display_list::{ClipId, DisplayList};
use crate::filter::{ALWAYS_WHOLE, Filter, Grid, PlacedFilter, pixels, widest};
use crate::geom::{IntRect, Rect, Transform};

/// How a layer is drawn.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct LayerOptions {
    /// What its alpha is multiplied by, in 0 ..= 1. The default is 1.
    pub opacity: f32,
    /// How it meets what is there. The default is [`BlendMode::SourceOver`].
    pub blend_mode: BlendMode,
    /// What becomes of it before it is drawn. The default is nothing.
    pub filter: Option<Arc<Filter>>,
    /// The part of user space that will be drawn on it, if that is known: a filter then need not look at the rest.
    /// What is drawn outside may be cut off.
    pub content: Option<Rect>,
}

impl Default for LayerOptions {
    fn default() -> Self {
        Self { opacity: 1.0, blend_mode: BlendMode::SourceOver, filter: None, content: None }
    }
}

impl LayerOptions {
    /// The same with the given opacity.
    #[must_use]
    pub fn with_opacity(self, opacity: f32) -> Self {
        Self { opacity, ..self }
    }

    /// The same with the given blend mode.
    #[must_use]
    pub fn with_blend_mode(self, blend_mode: BlendMode) -> Self {
        Self { blend_mode, ..self }
    }

    /// The same with the given filter.
    #[must_use]
    pub fn with_filter(self, filter: impl Into<Arc<Filter>>) -> Self {
        Self { filter: Some(filter.into()), ..self }
    }

    /// The same with the given bounds of what will be drawn, in user space.
    #[must_use]
    pub fn with_content(self, content: Rect) -> Self {
        Self { content: Some(content), ..self }
    }
}

/// How many layers with filters may lie in each other: each is drawn by a renderer of its own.
const MAX_DEPTH: usize = 64;

/// How far a filter looks beyond what is visible, in widths and heights of the canvas. Blurs wider than that draw on less
/// than they should.
///
/// That holds for what is drawn part by part. Pictures in between, those of a blur's blur or of a filter inside a filter, have
/// at most the canvas's pixels and [`MORE_PIXELS`], or [`ALWAYS_WHOLE`], and hold no more of the surroundings than fits.
const SURROUNDINGS: i32 = 2;

/// How many pixels more than the canvas a picture of its surroundings may have: 8 MiB.
const MORE_PIXELS: u64 = 2 << 20;

/// The longest side of a filter's pictures.
const MAX_SIDE: i32 = 32_767;

/// Pictures of effects are made before anything is drawn. When so many bytes of them have come together, what
/// was recorded is drawn, so that they need not be kept.
const MAX_PICTURES: u64 = 16 << 20;

impl Canvas<'_> {
    /// Starts a layer with options, as [`push_layer`](Self::push_layer) does; [`pop_layer`](Self::pop_layer) ends it.
    ///
    /// A filter works along the axes of the current user space, at the resolution that the transform gives it: under a
    /// rotation or skew its result is turned with the rest of the drawing, and pixels of the device
    /// ([`draw_pixel_line`](Self::draw_pixel_line) and the like) are those of the filter. Parts of the canvas far outside of
    /// what is visible (two widths or heights of the canvas) do not exist for it. What one primitive gives to the next has at
    /// most 6,250,000 pixels, or two million more than the canvas, whichever is more: it is cut off around what is visible
    /// where a filter asks for more. The same goes for what a layer with a filter gives to one around it, and for shadows in
    /// such a layer. Canvases of up to 500 × 500 pixels do not meet that limit, unless user space is turned. Where layers
    /// with filters lie in each other more than 64 deep, the innermost are drawn without them.
    pub fn push_layer_with(&mut self, options: &LayerOptions) {
        let filter_depth = self.layers.iter().filter(|layer| matches!(layer.kind, OpenLayerKind::Filter(_))).count();
        match &options.filter {
            Some(filter) if filter_depth < MAX_DEPTH => self.push_filter(filter, options),
            _ => self.push_layer(options.opacity, options.blend_mode),
        }
    }

    fn push_filter(&mut self, filter: &Arc<Filter>, options: &LayerOptions) {
        let visible = self.near_bounds();
        let Some(FilterSpace { to_grid, to_outer, grid, seen, limit, most }) = self.filter_space() else {
            // Nothing of it can be seen.
            let outer = self.state.bounds;
            self.state.bounds = IntRect::EMPTY;
            self.push_layer(options.opacity, options.blend_mode);
            if let Some(layer) = self.layers.last_mut() {
                layer.outer.bounds = outer;
            }
            return;
        };
        let placed = PlacedFilter::new(Arc::clone(filter), Grid::new(grid), seen, limit, most);
        let mut extent = placed.source();
        if let Some(content) = options.content {
            // Soft edges, and a pixel against rounding.
            let content = grid.map_rect(content).map(|content| content.outset(2.0).round_out());
            extent = extent.intersect(content.unwrap_or(IntRect::EMPTY));
        }
        let bounds = to_outer.map_rect(placed.result().to_rect()).map_or(IntRect::EMPTY, |result| {
            let faded = if to_outer.is_translate() { result } else { result.outset(1.0) };
            faded.round_out().intersect(visible)
        });
        let inside = |rect: IntRect| {
            IntRect::from_ltrb(
                rect.left - extent.left,
                rect.top - extent.top,
                rect.right - extent.left,
                rect.bottom - extent.top,
            )
        };
        let layer = FilterLayer {
            outer_list: std::mem::take(&mut self.list),
            filter: placed,
            to_outer,
            extent,
            limit: inside(limit),
            near: inside(widest(seen, extent, most)),
            most,
            opacity: options.opacity,
            blend_mode: options.blend_mode,
            clip: self.state.clip,
            bounds,
        };
        self.open_layer(OpenLayerKind::Filter(Box::new(layer)));
        self.list = DisplayList::default();
        let shift = Transform::from_translate(-(extent.left as f32), -(extent.top as f32));
        self.state.move_list(to_grid);
        self.state.move_list(shift);
        self.state.bounds = IntRect::from_xywh(0, 0, extent.width(), extent.height());
        self.state.clip = ClipId::NONE;
        self.state.shadow = None;
    }

    /// The pixels on which a filter would work in a layer begun here; `None` if nothing of it can be seen.
    pub(crate) fn filter_space(&self) -> Option<FilterSpace> {
        let visible = self.near_bounds();
        let Axes { to_grid, to_outer, grid } = Axes::new(self.state.to_pixels()).filter(|_| !visible.is_empty())?;
        let map = |rect: IntRect| to_grid.map_rect(rect.to_rect()).map_or(IntRect::EMPTY, |rect| rect.round_out());
        let seen = map(visible);
        let margin = |side: u32, own: u32| {
            (side as i32).saturating_mul(SURROUNDINGS).min((MAX_SIDE - own.min(MAX_SIDE as u32) as i32) / 2)
        };
        let (across, down) = (margin(self.width(), seen.width()), margin(self.height(), seen.height()));
        let mut limit =
            IntRect::from_ltrb(seen.left - across, seen.top - down, seen.right + across, seen.bottom + down);
        let own = u64::from(self.width()) * u64::from(self.height());
        // Turned, a canvas has a larger box.
        let mut most = (own.max(pixels(seen)) + MORE_PIXELS).max(ALWAYS_WHOLE);
        // The surroundings of surroundings would have no end.
        if let Some(outer) = self.filter_layer() {
            limit = limit.intersect(map(outer.limit));
            most = outer.most;
        }
        Some(FilterSpace { to_grid, to_outer, grid, seen, limit, most })
    }

    /// The innermost layer with a filter.
    fn filter_layer(&self) -> Option<&FilterLayer> {
        self.layers.iter().rev().find_map(|layer| match &layer.kind {
            OpenLayerKind::Filter(layer) => Some(&**layer),
            _ => None,
        })
    }

    /// The recording's pixels that the clip can let through and that pictures can be made of: in a layer with a filter that
    /// reaches far, those near to what is visible.
    pub(super) fn near_bounds(&self) -> IntRect {
        self.near().map_or(self.state.bounds, |near| self.state.bounds.intersect(near))
    }

    /// The recording's pixels of which pictures can be made, if it is that of a layer with a filter.
    pub(super) fn near(&self) -> Option<IntRect> {
        self.filter_layer().map(|layer| layer.near)
    }

    /// Notes that pictures of so many bytes were recorded, and draws them when they are too many.
    pub(super) fn count_pictures(&mut self, bytes: u64) {
        self.pictures = self.pictures.saturating_add(bytes);
        if self.pictures <= MAX_PICTURES {
            return;
        }
        if self.layers.is_empty() {
            self.failed = self.flush().err();
        } else {
            // Where there is no memory for it, the pictures may still find theirs, or say so when they are made.
            let _ = self.fold_layer();
            self.pictures = 0;
        }
    }
}

/// Where a filter works.
pub(crate) struct FilterSpace {
    to_grid: Transform,
    to_outer: Transform,
    /// From user space to the filter's pixels: positive scales and a move.
    pub(crate) grid: Transform,
    /// The pixels that can be seen.
    seen: IntRect,
    /// The pixels outside of which nothing is computed.
    limit: IntRect,
    /// How many pixels a picture of what is seen and its surroundings may have.
    most: u64,
}

impl FilterSpace {
    /// The pixels of which a single picture can be made.
    pub(crate) fn near(&self) -> IntRect {
        widest(self.seen, self.limit, self.most)
    }
}

/// A filter's own pixels: along the axes of user space, as fine as the device's.
struct Axes {
    /// From the recording's pixels to the filter's.
    to_grid: Transform,
    /// And back: without scales.
    to_outer: Transform,
    /// From user space to the filter's pixels: scales and a move.
    grid: Transform,
}

impl Axes {
    /// The axes of a transform from user space to pixels; `None` if it has no inverse or none that is finite.
    fn new(transform: Transform) -> Option<Self> {
        if !transform.is_finite() || transform.is_singular() {
            return None;
        }
        if transform.is_scale_translate() && transform.sx > 0.0 && transform.sy > 0.0 {
            return Some(Self { to_grid: Transform::IDENTITY, to_outer: Transform::IDENTITY, grid: transform });
        }
        let length = |x: f32, y: f32| {
            let (x, y) = (f64::from(x), f64::from(y));
            (x * x + y * y).sqrt() as f32
        };
        let scale = (length(transform.sx, transform.ky), length(transform.kx, transform.sy));
        let to_outer = Transform::from_row(
            transform.sx / scale.0,
            transform.ky / scale.0,
            transform.kx / scale.1,
            transform.sy / scale.1,
            0.0,
            0.0,
        );
        let to_grid = to_outer.invert()?;
        let origin = to_grid.pre_concat(transform);
        let grid = Transform::from_row(scale.0, 0.0, 0.0, scale.1, origin.tx, origin.ty);
        grid.is_finite().then_some(Self { to_grid, to_outer, grid })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;
    use crate::filter::{Input, Kind};
    use crate::surface::MaskKind;

    #[test]
    fn a_part_is_what_the_whole_has_there() {
        use crate::display_list::Paint;
        use crate::filter::Parts as _;
        use crate::geom::Point;
        use crate::paint::{GradientStop, LinearGradient};
        use crate::style::{Antialias, FillRule};

        let (width, height) = (1200, 100);
        let mut canvas = Canvas::new(width, height).unwrap();
        let mut seed = 9_u32;
        let mut random = |most: f32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32 * most
        };
        let modes = [Antialias::Analytic, Antialias::Exact, Antialias::Supersample(4), Antialias::None];
        for shape in 0..120 {
            let color = Color { r: random(1.0), g: random(1.0), b: random(1.0), a: [1.0, 0.5][shape % 2] };
            let paint = Paint::new(color).with_antialias(modes[shape / 2 % 4]);
            let mut path = crate::path::Path::new();
            path.move_to((random(1400.0) - 100.0, random(140.0) - 20.0));
            for _ in 0..4 {
                path.line_to((random(1400.0) - 100.0, random(140.0) - 20.0));
            }
            path.close();
            match shape % 12 {
                3 => canvas.push_layer(0.7, BlendMode::Multiply),
                5 => canvas.push_mask(MaskKind::Luminance),
                6 => canvas.pop_mask(),
                7 => canvas.pop_layer(),
                8 => {
                    canvas.save();
                    canvas.clip_path(&path, FillRule::EvenOdd, Antialias::Analytic);
                }
                10 => canvas.restore(),
                _ => {}
            }
            match shape % 5 {
                0 => canvas.fill_rect(Rect::from_xywh(random(1200.0), random(90.0), random(700.0), 30.5), paint),
                1 => canvas.stroke_path(&path, &crate::path::Stroke::new(3.0), paint),
                2 => {
                    let stops = [(0.0, color), (1.0, Color::WHITE)].map(|(at, color)| GradientStop::new(at, color));
                    let ends = (Point::new(100.0, 0.0), Point::new(1100.0, 60.0));
                    canvas.fill_path(&path, FillRule::NonZero, LinearGradient::new(ends.0, ends.1, stops));
                }
                _ => canvas.fill_path(&path, FillRule::NonZero, paint),
            }
        }
        let list = canvas.list.clone();
        let whole = IntRect::from_xywh(0, 0, width, height);
        let pixmap = canvas.into_pixmap();
        let extent = IntRect::from_xywh(-7, 50, width, height);
        let parts = crate::render::Parts::new(&list, extent, crate::RenderSettings::default()).unwrap();
        for area in [
            whole,
            IntRect::from_ltrb(16, 32, 32, 64),
            IntRect::from_ltrb(700, 0, 1100, 100),
            IntRect::from_ltrb(1023, 33, 1200, 34),
            IntRect::from_ltrb(5, 60, 1030, 99),
        ] {
            let moved = IntRect::from_ltrb(area.left - 7, area.top + 50, area.right - 7, area.bottom + 50);
            let part = parts.part(moved).unwrap().into_owned();
            let bounds = part.bounds();
            assert!(bounds.contains(moved) && extent.contains(bounds));
            let place = IntRect::from_ltrb(bounds.left + 7, bounds.top - 50, bounds.right + 7, bounds.bottom - 50);
            assert!(part.into_pixmap().unwrap() == pixmap.as_ref().crop(place).unwrap(), "{area:?}");
        }
    }

    #[test]
    fn masks_apply_to_filtered_layers() {
        let drawn = |filter: bool| {
            let mut canvas = Canvas::new(24, 16).unwrap();
            // A filter that changes nothing.
            let mut offset = Filter::new();
            offset.add(Kind::Offset { input: Input::SourceGraphic, dx: 0.0, dy: 0.0 });
            let options = LayerOptions { filter: filter.then(|| Arc::new(offset)), ..LayerOptions::default() };
            canvas.push_layer_with(&options);
            canvas.fill_rect(Rect::from_xywh(2.0, 2.0, 20.0, 12.0), Color { r: 0.2, g: 0.4, b: 0.8, a: 1.0 });
            canvas.push_mask(MaskKind::Alpha);
            canvas.fill_circle((12.0, 8.0), 5.0, Color { r: 0.0, g: 0.0, b: 0.0, a: 0.7 });
            canvas.pop_mask();
            canvas.pop_layer();
            canvas.into_pixmap().data().to_vec()
        };
        assert!(drawn(true) == drawn(false));
    }
}
