//! vello_cpu in its fast mode (u8): one context that is reset for each picture; the clear is that of rendering.

use std::sync::Arc;

use vello_cpu::color::{AlphaColor, Srgb};
use vello_cpu::kurbo::{Affine, BezPath, Cap, Join, Point, Rect, Stroke};
use vello_cpu::peniko::{
    ColorStop, Extend, Fill, Gradient, ImageAlphaType, ImageQuality, ImageSampler, InterpolationAlphaSpace,
};
use vello_cpu::{
    Image, ImageSource, PaintType, PixelMetadata, Pixmap, RasterizerSettings, RenderContext, RenderMode,
    RenderSettings, Resources, TargetInit,
};

use super::Engine;
use crate::scene::{self, Rule, Scene, Segment, Shape, Spread, Style};

pub struct Prepared {
    context: RenderContext,
    resources: Resources,
    target: Pixmap,
    items: Vec<Item>,
    /// Each clip with those that it lies in, outermost first.
    clips: Vec<Vec<Clip>>,
}

struct Item {
    outline: Outline,
    style: Filling,
    paint: PaintType,
    /// From the paint's space to the item's.
    paint_transform: Affine,
    transform: Affine,
    clip: Option<usize>,
}

enum Filling {
    Fill(Fill),
    Stroke(Stroke),
}

#[derive(Clone)]
struct Clip {
    outline: Outline,
    rule: Fill,
    transform: Affine,
}

#[derive(Clone)]
enum Outline {
    Rect(Rect),
    Path(BezPath),
}

/// The workers that vello_cpu takes beside the calling thread unless told otherwise; one where that would be none.
pub fn default_workers() -> u16 {
    RenderSettings::default().num_threads.max(1)
}

impl Prepared {
    /// With so many threads beside the calling one.
    pub fn new(scene: &Scene, workers: u16) -> Self {
        let (width, height) = (scene.width as u16, scene.height as u16);
        let settings = RenderSettings { num_threads: workers, ..RenderSettings::default() };
        let images: Vec<Arc<Pixmap>> = scene.images.iter().map(|image| Arc::new(pixmap(image))).collect();
        let items = scene.items.iter().map(|item| {
            let (paint, paint_transform) = paint(&item.paint, &images);
            Item {
                outline: outline(&item.shape),
                style: match &item.style {
                    Style::Fill(rule) => Filling::Fill(fill_rule(*rule)),
                    Style::Stroke(stroke) => Filling::Stroke(stroke_style(stroke)),
                },
                paint,
                paint_transform,
                transform: affine(item.transform),
                clip: item.clip,
            }
        });
        let clip = |index: usize| {
            let clip = &scene.clips[index];
            Clip { outline: outline(&clip.shape), rule: fill_rule(clip.rule), transform: affine(clip.transform) }
        };
        let chains = (0..scene.clips.len()).map(|index| scene.clip_chain(Some(index)));
        let mut target = Pixmap::new(width, height);
        target.data_as_u8_slice_mut().fill(255);
        Self {
            context: RenderContext::new_with(width, height, settings),
            resources: Resources::new(),
            target,
            items: items.collect(),
            clips: chains.map(|chain| chain.into_iter().map(clip).collect()).collect(),
        }
    }
}

impl Engine for Prepared {
    fn draw(&mut self) {
        let context = &mut self.context;
        context.reset();
        let mut inside = None;
        for item in &self.items {
            if item.clip != inside {
                for _ in inside.map_or(&[][..], |clip: usize| &self.clips[clip]) {
                    context.pop_clip();
                }
                for clip in item.clip.map_or(&[][..], |clip| &self.clips[clip]) {
                    context.set_transform(clip.transform);
                    context.set_fill_rule(clip.rule);
                    match &clip.outline {
                        Outline::Rect(rect) => context.push_clip_rect(rect),
                        Outline::Path(path) => context.push_clip_path(path),
                    }
                }
                inside = item.clip;
            }
            context.set_transform(item.transform);
            context.set_paint_transform(item.paint_transform);
            context.set_paint(item.paint.clone());
            match (&item.style, &item.outline) {
                (Filling::Fill(_), Outline::Rect(rect)) => context.fill_rect(rect),
                (Filling::Fill(rule), Outline::Path(path)) => {
                    context.set_fill_rule(*rule);
                    context.fill_path(path);
                }
                (Filling::Stroke(stroke), outline) => {
                    context.set_stroke(stroke.clone());
                    match outline {
                        Outline::Rect(rect) => context.stroke_rect(rect),
                        Outline::Path(path) => context.stroke_path(path),
                    }
                }
            }
        }
        for _ in inside.map_or(&[][..], |clip| &self.clips[clip]) {
            context.pop_clip();
        }
        context.flush();
        let settings = RasterizerSettings {
            render_mode: RenderMode::OptimizeSpeed,
            target_init: TargetInit::Clear(AlphaColor::WHITE),
            ..RasterizerSettings::default()
        };
        context.render_with(&mut self.target, &mut self.resources, settings);
    }

    fn picture(&mut self) -> Vec<u8> {
        self.target.data_as_u8_slice().to_vec()
    }
}

fn point([x, y]: scene::Point) -> Point {
    Point::new(f64::from(x), f64::from(y))
}

fn affine(transform: scene::Transform) -> Affine {
    Affine::new(transform.map(f64::from))
}

fn outline(shape: &Shape) -> Outline {
    let segments = match shape {
        Shape::Rect([l, t, r, b]) => {
            return Outline::Rect(Rect::new(f64::from(*l), f64::from(*t), f64::from(*r), f64::from(*b)));
        }
        Shape::Path(segments) => segments,
    };
    let mut path = BezPath::new();
    for segment in segments {
        match *segment {
            Segment::Move(p) => path.move_to(point(p)),
            Segment::Line(p) => path.line_to(point(p)),
            Segment::Quad(c, p) => path.quad_to(point(c), point(p)),
            Segment::Cubic(c1, c2, p) => path.curve_to(point(c1), point(c2), point(p)),
            Segment::Close => path.close_path(),
        }
    }
    Outline::Path(path)
}

fn fill_rule(rule: Rule) -> Fill {
    match rule {
        Rule::NonZero => Fill::NonZero,
        Rule::EvenOdd => Fill::EvenOdd,
    }
}

fn stroke_style(stroke: &scene::Stroke) -> Stroke {
    let cap = match stroke.cap {
        scene::Cap::Butt => Cap::Butt,
        scene::Cap::Round => Cap::Round,
        scene::Cap::Square => Cap::Square,
    };
    let join = match stroke.join {
        scene::Join::Miter => Join::Miter,
        scene::Join::Round => Join::Round,
        scene::Join::Bevel => Join::Bevel,
    };
    let style = Stroke::new(f64::from(stroke.width))
        .with_caps(cap)
        .with_join(join)
        .with_miter_limit(f64::from(stroke.miter_limit));
    if stroke.dashes.is_empty() {
        return style;
    }
    style.with_dashes(f64::from(stroke.dash_offset), stroke.dashes.iter().map(|length| f64::from(*length)))
}

fn pixmap(image: &scene::Image) -> Pixmap {
    let metadata =
        PixelMetadata { may_have_transparency: !image.is_opaque(), alpha_type: ImageAlphaType::AlphaPremultiplied };
    Pixmap::from_parts(image.rgba.clone(), image.width as u16, image.height as u16, metadata)
}

fn paint(paint: &scene::Paint, images: &[Arc<Pixmap>]) -> (PaintType, Affine) {
    let finish = |plain: Gradient, gradient: &scene::Gradient| {
        let stops: Vec<ColorStop> =
            gradient.stops.iter().map(|(offset, stop)| ColorStop::from((*offset, color(*stop)))).collect();
        let extend = match gradient.spread {
            Spread::Pad => Extend::Pad,
            Spread::Reflect => Extend::Reflect,
            Spread::Repeat => Extend::Repeat,
        };
        // SVG interpolates straight colours.
        let plain = plain
            .with_stops(stops.as_slice())
            .with_extend(extend)
            .with_interpolation_alpha_space(InterpolationAlphaSpace::Unpremultiplied)
            .multiply_alpha(gradient.opacity);
        (PaintType::Gradient(plain), affine(gradient.transform))
    };
    match paint {
        scene::Paint::Solid(solid) => (PaintType::Solid(color(*solid)), Affine::IDENTITY),
        scene::Paint::Linear { start, end, gradient } => {
            finish(Gradient::new_linear(point(*start), point(*end)), gradient)
        }
        scene::Paint::Radial { focus, focal_radius, center, radius, gradient } => {
            let plain = Gradient::new_two_point_radial(point(*focus), *focal_radius, point(*center), *radius);
            finish(plain, gradient)
        }
        scene::Paint::Image { index, smooth, opacity, transform } => {
            let sampler = ImageSampler::new()
                .with_extend(Extend::Pad)
                .with_quality(if *smooth { ImageQuality::Medium } else { ImageQuality::Low })
                .with_alpha(*opacity);
            let image = ImageSource::Pixmap(Arc::clone(&images[*index]));
            (PaintType::Image(Image { image, sampler }), affine(*transform))
        }
    }
}

fn color([r, g, b, a]: scene::Color) -> AlphaColor<Srgb> {
    AlphaColor::from_rgba8(r, g, b, a)
}
