//! Filling and stroking.

use super::Canvas;
use crate::blend::BlendMode;
use crate::color::Color;
use crate::display_list::{ClipId, Command, Draw, Effect, EffectKind, Geometry, Paint, PaintRef, Span, ToPaint};
use crate::filter::pixels;
use crate::geom::{FixedRect, IntRect, Point, Rect, Transform};
use crate::paint::{PreparedPaint, Shader};
use crate::path::stretch::stretches;
use crate::path::{LineCap, LineJoin, Path, Radii, Stroke};
use crate::style::{Antialias, FillRule};

/// Blurs wider than this many pixels of standard deviation are cut to it.
const MAX_DEVIATION: f32 = 1000.0;

impl Canvas<'_> {
    /// Replaces every pixel within the clip by `color`, transparent ones included.
    pub fn clear(&mut self, color: Color) {
        let shadow = self.state.shadow.take();
        self.fill(Paint::new(color).with_blend_mode(BlendMode::Source));
        self.state.shadow = shadow;
    }

    /// Paints every pixel within the clip.
    pub fn fill(&mut self, paint: impl ToPaint) {
        self.draw(&paint.to_paint(), |canvas| Some((Geometry::Bounds, canvas.state.bounds)));
    }

    /// Fills the inside of a path.
    pub fn fill_path(&mut self, path: &Path, rule: FillRule, paint: impl ToPaint) {
        self.draw(&paint.to_paint(), |canvas| canvas.record_fill(path, rule));
    }

    /// Strokes a path.
    pub fn stroke_path(&mut self, path: &Path, stroke: &Stroke, paint: impl ToPaint) {
        let paint = paint.to_paint();
        if stroke.width == 0.0 && paint.antialias == Antialias::None && stroke.dash.is_none() {
            self.draw(&paint, |canvas| canvas.record_pixel_outline(path));
        } else {
            self.draw(&paint, |canvas| canvas.record_stroke(path, stroke));
        }
    }

    /// Fills a rectangle; one with negative width or height as if its edges were swapped.
    pub fn fill_rect(&mut self, rect: Rect, paint: impl ToPaint) {
        self.draw(&paint.to_paint(), |canvas| canvas.record_rect(rect));
    }

    /// Strokes a rectangle's outline.
    pub fn stroke_rect(&mut self, rect: Rect, stroke: &Stroke, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.rect(rect);
        self.stroke_path(&path, stroke, paint);
        self.keep_scratch(path);
    }

    /// Makes the pixels of a rectangle transparent.
    pub fn clear_rect(&mut self, rect: Rect) {
        let shadow = self.state.shadow.take();
        self.fill_rect(rect, Paint::new(Color::TRANSPARENT).with_blend_mode(BlendMode::Clear));
        self.state.shadow = shadow;
    }

    /// Fills a rectangle with rounded corners.
    pub fn fill_round_rect(&mut self, rect: Rect, radii: impl Into<Radii>, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.round_rect(rect, radii);
        self.fill_path(&path, FillRule::NonZero, paint);
        self.keep_scratch(path);
    }

    /// Strokes a rectangle with rounded corners.
    pub fn stroke_round_rect(&mut self, rect: Rect, radii: impl Into<Radii>, stroke: &Stroke, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.round_rect(rect, radii);
        self.stroke_path(&path, stroke, paint);
        self.keep_scratch(path);
    }

    /// Fills a circle.
    pub fn fill_circle(&mut self, center: impl Into<Point>, radius: f32, paint: impl ToPaint) {
        self.fill_ellipse(center, radius, radius, paint);
    }

    /// Strokes a circle.
    pub fn stroke_circle(&mut self, center: impl Into<Point>, radius: f32, stroke: &Stroke, paint: impl ToPaint) {
        self.stroke_ellipse(center, radius, radius, stroke, paint);
    }

    /// Fills an ellipse with the given horizontal and vertical radius.
    pub fn fill_ellipse(&mut self, center: impl Into<Point>, radius_x: f32, radius_y: f32, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.ellipse(center, radius_x, radius_y);
        self.fill_path(&path, FillRule::NonZero, paint);
        self.keep_scratch(path);
    }

    /// Strokes an ellipse with the given horizontal and vertical radius.
    pub fn stroke_ellipse(
        &mut self,
        center: impl Into<Point>,
        radius_x: f32,
        radius_y: f32,
        stroke: &Stroke,
        paint: impl ToPaint,
    ) {
        let mut path = self.take_scratch();
        path.ellipse(center, radius_x, radius_y);
        self.stroke_path(&path, stroke, paint);
        self.keep_scratch(path);
    }

    /// Strokes a line.
    pub fn draw_line(&mut self, from: impl Into<Point>, to: impl Into<Point>, stroke: &Stroke, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.move_to(from).line_to(to);
        self.stroke_path(&path, stroke, paint);
        self.keep_scratch(path);
    }

    /// Strokes an open chain of lines.
    pub fn draw_polyline(&mut self, points: &[Point], stroke: &Stroke, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.polyline(points);
        self.stroke_path(&path, stroke, paint);
        self.keep_scratch(path);
    }

    /// Fills a polygon; it is closed by a line from its last to its first point.
    pub fn fill_polygon(&mut self, points: &[Point], rule: FillRule, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.polygon(points);
        self.fill_path(&path, rule, paint);
        self.keep_scratch(path);
    }

    /// Strokes a closed polygon.
    pub fn stroke_polygon(&mut self, points: &[Point], stroke: &Stroke, paint: impl ToPaint) {
        let mut path = self.take_scratch();
        path.polygon(points);
        self.stroke_path(&path, stroke, paint);
        self.keep_scratch(path);
    }

    /// Whether a device point lies inside a path under the current transform. The clip does not matter.
    pub fn is_point_in_path(&self, path: &Path, rule: FillRule, point: impl Into<Point>) -> bool {
        self.state.transform.invert().is_some_and(|inverse| path.contains(inverse.map(point.into()), rule))
    }

    /// Whether a device point lies on a path's stroke under the current transform. The clip does not matter.
    pub fn is_point_in_stroke(&self, path: &Path, stroke: &Stroke, point: impl Into<Point>) -> bool {
        self.state.transform.invert().is_some_and(|inverse| path.stroke_contains(inverse.map(point.into()), stroke))
    }

    /// Records what `geometry` records, with its shadow before it.
    #[inline(always)]
    pub(super) fn draw(&mut self, paint: &Paint, geometry: impl FnMut(&mut Self) -> Option<(Geometry, IntRect)>) {
        let mut geometry = geometry;
        if self.state.bounds.is_empty() || paint.blend_mode == BlendMode::Destination {
            return;
        }
        let shadow = self.state.shadow.map_or(0, |shadow| self.draw_shadow(shadow, paint, &mut geometry));
        if let Some((geometry, bounds)) = geometry(self) {
            self.record(paint, geometry, bounds);
        }
        if shadow > 0 {
            self.count_pictures(shadow);
        }
        if self.sections.is_next(self.list.commands.len(), self.list.points.len()) {
            self.end_section();
        }
    }

    /// Records a draw under the current state.
    ///
    /// A part of each call that gets here: a geometry that is handed on in memory, written field by field and read as a
    /// whole, has to wait for itself.
    #[inline(always)]
    fn record(&mut self, paint: &Paint, geometry: Geometry, bounds: IntRect) {
        let clip = self.clip_of(bounds);
        let bounds = bounds.intersect(self.state.bounds);
        if bounds.is_empty() {
            return;
        }
        let (reference, opaque) = match &paint.shader {
            Shader::Solid(color) => {
                let color = color.with_opacity(paint.opacity).premultiply();
                (PaintRef::of_color(color), color[3] == u8::MAX)
            }
            shader => match PreparedPaint::new(shader, self.state.to_pixels(), paint.opacity) {
                PreparedPaint::Nothing if paint.blend_mode == BlendMode::SourceOver => return,
                // Such as a gradient between equal colours.
                PreparedPaint::Solid(color) => (PaintRef::of_color(color), color[3] == u8::MAX),
                prepared => {
                    let (index, opaque) = (self.list.paints.len() as u32, prepared.is_opaque());
                    self.list.paints.push(prepared);
                    (PaintRef::of_index(index), opaque)
                }
            },
        };
        self.list.commands.push(Command::Draw(Draw {
            geometry,
            paint: reference,
            antialias: paint.antialias,
            blend_mode: paint.blend_mode,
            clip,
            bounds,
            opaque,
        }));
    }

    /// The current clip for what lies within `bounds`: that around it, where it is a rectangle that leaves all of them whole, as the
    /// viewports of drawings inside drawings mostly do.
    #[inline(always)]
    fn clip_of(&self, bounds: IntRect) -> ClipId {
        let mut clip = self.state.clip;
        while clip != ClipId::NONE
            && let Some(node) = self.list.clip(clip)
            && node.leaves_whole(bounds)
        {
            clip = node.parent;
        }
        clip
    }

    /// Records the shadow of a draw: the same draw in a recording of its own, on a surface that holds what of it the
    /// blur brings into view. Gives the bytes that its picture will take.
    fn draw_shadow(
        &mut self,
        shadow: super::Shadow,
        paint: &Paint,
        geometry: &mut dyn FnMut(&mut Self) -> Option<(Geometry, IntRect)>,
    ) -> u64 {
        let finite = shadow.offset_x.is_finite() && shadow.offset_y.is_finite() && shadow.deviation.is_finite();
        if !finite || shadow.color.a <= 0.0 || shadow.color.a.is_nan() {
            return 0;
        }
        let deviation = shadow.deviation.clamp(0.0, MAX_DEVIATION);
        let offset = |v: f32| v.round().clamp(-1e6, 1e6) as i32;
        let (dx, dy) = (offset(shadow.offset_x), offset(shadow.offset_y));
        let margin = (deviation * 3.0).ceil() as i32 + 1;
        let visible = self.near_bounds();
        let outer = self.state;
        let outer_list = std::mem::take(&mut self.list);
        // Where the draw itself lies, without the clip.
        self.state.clip = ClipId::NONE;
        self.state.shadow = None;
        let reach = IntRect::from_ltrb(
            visible.left - dx - margin,
            visible.top - dy - margin,
            visible.right - dx + margin,
            visible.bottom - dy + margin,
        );
        self.state.bounds = reach;
        let mut extent = IntRect::EMPTY;
        if let Some((mut geometry, bounds)) = geometry(self) {
            extent = bounds.intersect(reach);
            self.move_geometry(&mut geometry, -extent.left, -extent.top);
            let shift = Transform::from_translate(-(extent.left as f32), -(extent.top as f32));
            self.state.move_list(shift);
            self.state.bounds = IntRect::from_xywh(0, 0, extent.width(), extent.height());
            let plain = Paint { blend_mode: BlendMode::SourceOver, ..paint.clone() };
            self.record(&plain, geometry, self.state.bounds);
        }
        let list = std::mem::replace(&mut self.list, outer_list);
        self.state = outer;
        let bounds = IntRect::from_ltrb(
            extent.left + dx - margin,
            extent.top + dy - margin,
            extent.right + dx + margin,
            extent.bottom + dy + margin,
        )
        .intersect(visible);
        if list.commands.is_empty() || bounds.is_empty() {
            return 0;
        }
        self.list.add_effect(Effect {
            list,
            extent,
            kind: EffectKind::Shadow { offset: (dx, dy), deviation, color: shadow.color },
            blend_mode: paint.blend_mode,
            clip: self.state.clip,
            bounds,
        });
        pixels(bounds) * 4
    }

    /// Moves a recorded geometry by whole device pixels.
    fn move_geometry(&mut self, geometry: &mut Geometry, dx: i32, dy: i32) {
        match geometry {
            Geometry::Fill { transform, .. } | Geometry::Stroke { transform, .. } => {
                let moved = self.list.transform(*transform);
                *transform =
                    self.list.add_transform(moved.post_concat(Transform::from_translate(dx as f32, dy as f32)));
            }
            Geometry::Rect(rect) => *rect = rect.moved(dx, dy),
            Geometry::Spans((first, end)) => {
                for span in self.list.spans.get_mut(*first as usize..*end as usize).unwrap_or(&mut []) {
                    *span = Span { y: span.y + dy, start: span.start + dx, end: span.end + dx };
                }
            }
            Geometry::Bounds => {}
        }
    }

    /// Stores a path's outline, with the device pixels that filling it can touch. A singular transform leaves no area,
    /// and nothing is filled: not even the slivers that rounding would make of it.
    #[inline(always)]
    pub(super) fn record_fill(&mut self, path: &Path, rule: FillRule) -> Option<(Geometry, IntRect)> {
        let transform = self.state.to_pixels();
        if transform.is_singular() {
            return None;
        }
        if transform.is_axis_aligned()
            && let Some(rect) = path.as_rect()
        {
            return self.record_device_rect(rect);
        }
        let bounds = self.device_bounds(path, 0.0)?;
        let outline = self.list.add_path(path);
        let transform = self.list.add_transform(transform);
        Some((Geometry::Fill { outline, transform, rule }, bounds))
    }

    /// As [`record_fill`](Self::record_fill) of a rectangle.
    #[inline(always)]
    fn record_rect(&mut self, rect: Rect) -> Option<(Geometry, IntRect)> {
        if !rect.is_finite() {
            return None;
        }
        if self.state.to_pixels().is_axis_aligned() {
            return self.record_device_rect(rect);
        }
        let mut path = self.take_scratch();
        path.rect(rect);
        let recorded = self.record_fill(&path, FillRule::NonZero);
        self.keep_scratch(path);
        recorded
    }

    /// A rectangle of user space that is one in device space, too: it needs no outline.
    #[inline(always)]
    fn record_device_rect(&self, rect: Rect) -> Option<(Geometry, IntRect)> {
        let transform = self.state.to_pixels();
        let corner = transform.map(Point::new(rect.left, rect.top));
        let opposite = transform.map(Point::new(rect.right, rect.bottom));
        let device = Rect::from_ltrb(corner.x, corner.y, opposite.x, opposite.y).normalized();
        if !device.is_finite() {
            return None;
        }
        let fixed = FixedRect::new(device);
        Some((Geometry::Rect(fixed), fixed.pixels()))
    }

    fn record_stroke(&mut self, path: &Path, stroke: &Stroke) -> Option<(Geometry, IntRect)> {
        if !(stroke.width >= 0.0 && stroke.width.is_finite()) {
            return None;
        }
        // As for fills; but a hairline is a pixel wide at any transform.
        let transform = self.state.to_pixels();
        if stroke.width > 0.0 && transform.is_singular() {
            return None;
        }
        // How far from the path the pen reaches: half its width, more at mitres and square caps.
        let mut reach = 1.0_f32;
        if matches!(stroke.join, LineJoin::Miter | LineJoin::MiterClip) {
            // Written so that a limit that is not a number counts as 1.
            reach = if stroke.miter_limit > reach { stroke.miter_limit } else { reach };
        }
        if stroke.cap == LineCap::Square && reach < std::f32::consts::SQRT_2 {
            reach = std::f32::consts::SQRT_2;
        }
        // A hairline's width is in device pixels.
        let reach = if stroke.width == 0.0 { reach } else { stroke.width * reach };
        let bounds = self.device_bounds(path, reach)?;
        let outline = self.list.add_path(path);
        let transform = self.list.add_transform(transform);
        let stretches = stretches(path, stroke, self.state.to_pixels());
        let style = self.list.add_stroke(stroke, stretches);
        Some((Geometry::Stroke { outline, transform, style }, bounds))
    }

    /// The device pixels that a path can touch when it is drawn with a pen that reaches so far in user space;
    /// `None` if that is not finite or outside the clip.
    pub(super) fn device_bounds(&self, path: &Path, reach: f32) -> Option<IntRect> {
        let transform = self.state.to_pixels();
        if !transform.is_finite() {
            return None;
        }
        let scale = if reach > 0.0 { transform.scale_range().0 } else { 1.0 };
        let margin = if scale > 1.0 { reach * scale } else { reach };
        let device = transform.map_rect(path.control_bounds()?)?;
        // One pixel more: flattening and 24.8 rounding move points by less.
        let bounds = device.outset(margin + 1.0).round_out();
        (!bounds.intersect(self.state.bounds).is_empty()).then_some(bounds)
    }

    fn take_scratch(&mut self) -> Path {
        let mut path = std::mem::take(&mut self.scratch);
        path.clear();
        path
    }

    fn keep_scratch(&mut self, path: Path) {
        self.scratch = path;
    }
}
