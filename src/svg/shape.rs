//! Paths: fill, stroke and their paints.

use super::render::Renderer;
use super::{Settings, convert};
use crate::blend::BlendMode;
use crate::canvas::Canvas;
use crate::color::Color;
use crate::display_list::Paint;
use crate::geom::{Point, Transform};
use crate::paint::{GradientStop, LinearGradient, RadialGradient, Shader};
use crate::style::Antialias;

/// What groups around a shape do to it, where its paint can do it.
pub(super) struct Effects {
    pub(super) opacity: f32,
    pub(super) blend_mode: BlendMode,
}

impl Default for Effects {
    fn default() -> Self {
        Self { opacity: 1.0, blend_mode: BlendMode::SourceOver }
    }
}

/// Whether drawing the path paints each pixel at most once.
pub(super) fn paints_once(path: &usvg::Path) -> bool {
    path.fill().is_none() || path.stroke().is_none()
}

/// Whether a stroke of the path covers itself: a line there and back. Coverage summed edge by edge would count it twice.
fn doubles_back(path: &usvg::Path) -> bool {
    use usvg::tiny_skia_path::PathVerb::{Close, Line, Move};
    path.data().verbs().windows(3).any(|verbs| verbs == [Move, Line, Close])
}

/// Without antialiasing, a pixel whose centre lies on an edge belongs to what is above it or to its left: the canvas has it the
/// other way round, but this is what browsers and resvg draw, and what lies on edges are mostly lines that ask to be crisp.
pub(super) fn nudge(antialias: Antialias, canvas: &mut Canvas<'_>) {
    if antialias == Antialias::None {
        let least = 1.0 / 256.0;
        canvas.set_transform(canvas.current_transform().post_concat(Transform::from_translate(least, least)));
    }
}

/// How the path is antialiased.
pub(super) fn antialias(path: &usvg::Path, settings: &Settings) -> Antialias {
    if path.rendering_mode().use_shape_antialiasing() { settings.antialias } else { Antialias::None }
}

impl Renderer<'_> {
    pub(super) fn draw_path(&mut self, path: &usvg::Path, effects: &Effects, canvas: &mut Canvas<'_>) {
        if !path.is_visible() {
            return;
        }
        let outline = convert::path(path.data());
        let transform = canvas.current_transform();
        nudge(antialias(path, self.settings), canvas);
        let fill = |renderer: &mut Self, canvas: &mut Canvas<'_>| {
            if let Some(fill) = path.fill()
                && let Some(paint) = renderer.paint(fill.paint(), fill.opacity(), path, effects, canvas)
            {
                canvas.fill_path(&outline, convert::fill_rule(fill.rule()), paint);
            }
        };
        let stroke = |renderer: &mut Self, canvas: &mut Canvas<'_>| {
            if let Some(stroke) = path.stroke()
                && let Some(mut paint) = renderer.paint(stroke.paint(), stroke.opacity(), path, effects, canvas)
            {
                if paint.antialias == Antialias::Analytic && doubles_back(path) {
                    paint.antialias = Antialias::Exact;
                }
                canvas.stroke_path(&outline, &convert::stroke(stroke), paint);
            }
        };
        match path.paint_order() {
            usvg::PaintOrder::FillAndStroke => {
                fill(self, canvas);
                stroke(self, canvas);
            }
            usvg::PaintOrder::StrokeAndFill => {
                stroke(self, canvas);
                fill(self, canvas);
            }
        }
        canvas.set_transform(transform);
    }

    fn paint(
        &mut self,
        paint: &usvg::Paint,
        opacity: usvg::Opacity,
        path: &usvg::Path,
        effects: &Effects,
        canvas: &Canvas<'_>,
    ) -> Option<Paint> {
        let shader = match paint {
            usvg::Paint::Color(color) => Shader::Solid(Color::from_rgb8(color.red, color.green, color.blue)),
            usvg::Paint::LinearGradient(gradient) => Shader::LinearGradient(LinearGradient {
                spread: convert::spread(gradient.spread_method()),
                transform: convert::transform(gradient.transform()),
                ..LinearGradient::new(
                    Point::new(gradient.x1(), gradient.y1()),
                    Point::new(gradient.x2(), gradient.y2()),
                    stops(gradient),
                )
            }),
            usvg::Paint::RadialGradient(gradient) => Shader::RadialGradient(RadialGradient {
                spread: convert::spread(gradient.spread_method()),
                transform: convert::transform(gradient.transform()),
                ..RadialGradient::two_point(
                    Point::new(gradient.fx(), gradient.fy()),
                    gradient.fr().get(),
                    Point::new(gradient.cx(), gradient.cy()),
                    gradient.r().get(),
                    stops(gradient),
                )
            }),
            usvg::Paint::Pattern(pattern) => Shader::Pattern(self.pattern(pattern, canvas)?),
        };
        Some(
            Paint::new(shader)
                .with_opacity(opacity.get() * effects.opacity)
                .with_blend_mode(effects.blend_mode)
                .with_antialias(antialias(path, self.settings)),
        )
    }
}

fn stops(gradient: &usvg::BaseGradient) -> Vec<GradientStop> {
    gradient
        .stops()
        .iter()
        .map(|stop| {
            let color = Color::from_rgb8(stop.color().red, stop.color().green, stop.color().blue);
            GradientStop::new(stop.offset().get(), color.with_opacity(stop.opacity().get()))
        })
        .collect()
}
