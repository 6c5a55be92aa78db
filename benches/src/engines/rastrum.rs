//! rastrum: one canvas that owns its pixels and is used again and again; recording is part of the time.

use std::sync::Arc;

use rastrum::{
    Antialias, Canvas, Color, Dash, FillRule, FilterQuality, GradientStop, LineCap, LineJoin, LinearGradient, Paint,
    Path, Pattern, Pixmap, RadialGradient, Rect, RenderSettings, SpreadMode, Stroke, Transform,
};

use super::Engine;
use crate::scene::{self, Cap, Join, Rule, Scene, Segment, Shape, Spread, Style};

pub struct Prepared {
    canvas: Canvas<'static>,
    items: Vec<Item>,
    /// Each clip with those that it lies in, outermost first.
    clips: Vec<Vec<Clip>>,
    antialias: Antialias,
}

struct Item {
    outline: Outline,
    style: Filling,
    paint: Paint,
    transform: Transform,
    clip: Option<usize>,
}

enum Filling {
    Fill(FillRule),
    Stroke(Stroke),
}

#[derive(Clone)]
struct Clip {
    outline: Outline,
    rule: FillRule,
    transform: Transform,
}

#[derive(Clone)]
enum Outline {
    Rect(Rect),
    Path(Path),
}

impl Prepared {
    pub fn new(scene: &Scene, threads: usize, antialias: Antialias) -> Self {
        let settings = RenderSettings::default().with_threads(threads);
        let mut target = Pixmap::new(scene.width, scene.height).expect("the scene has a valid size");
        target.fill(Color::WHITE);
        let mut canvas = Canvas::from_pixmap(target);
        canvas.set_settings(settings);
        let images: Vec<Arc<Pixmap>> = scene.images.iter().map(|image| Arc::new(pixmap(image))).collect();
        let items = scene.items.iter().map(|item| Item {
            // A stroked rectangle is a path to every engine.
            outline: match (&item.shape, &item.style) {
                (Shape::Rect(_), Style::Stroke(_)) => Outline::Path(path(&scene::segments(&item.shape))),
                (shape, _) => outline(shape),
            },
            style: match &item.style {
                Style::Fill(rule) => Filling::Fill(fill_rule(*rule)),
                Style::Stroke(stroke) => Filling::Stroke(stroke_style(stroke)),
            },
            paint: paint(&item.paint, &images).with_antialias(antialias),
            transform: transform(item.transform),
            clip: item.clip,
        });
        let items = items.collect();
        let clip = |index: usize| {
            let clip = &scene.clips[index];
            Clip { outline: outline(&clip.shape), rule: fill_rule(clip.rule), transform: transform(clip.transform) }
        };
        let chains = (0..scene.clips.len()).map(|index| scene.clip_chain(Some(index)));
        let clips = chains.map(|chain| chain.into_iter().map(clip).collect()).collect();
        Self { canvas, items, clips, antialias }
    }

    fn enter(&mut self, clip: usize) {
        self.canvas.save();
        for clip in &self.clips[clip] {
            self.canvas.set_transform(clip.transform);
            match &clip.outline {
                Outline::Rect(rect) => self.canvas.clip_rect(*rect, self.antialias),
                Outline::Path(path) => self.canvas.clip_path(path, clip.rule, self.antialias),
            }
        }
    }
}

impl Engine for Prepared {
    fn draw(&mut self) {
        self.canvas.clear(Color::WHITE);
        let mut inside = None;
        for index in 0..self.items.len() {
            let clip = self.items[index].clip;
            if clip != inside {
                if inside.is_some() {
                    self.canvas.restore();
                }
                if let Some(clip) = clip {
                    self.enter(clip);
                }
                inside = clip;
            }
            let item = &self.items[index];
            self.canvas.set_transform(item.transform);
            match (&item.style, &item.outline) {
                (Filling::Fill(_), Outline::Rect(rect)) => self.canvas.fill_rect(*rect, &item.paint),
                (Filling::Fill(rule), Outline::Path(path)) => self.canvas.fill_path(path, *rule, &item.paint),
                (Filling::Stroke(stroke), Outline::Path(path)) => self.canvas.stroke_path(path, stroke, &item.paint),
                (Filling::Stroke(stroke), Outline::Rect(rect)) => self.canvas.stroke_rect(*rect, stroke, &item.paint),
            }
        }
        if inside.is_some() {
            self.canvas.restore();
        }
        self.canvas.set_transform(Transform::IDENTITY);
        self.canvas.flush().expect("there is memory for the picture");
    }

    fn picture(&mut self) -> Vec<u8> {
        let all = self.canvas.clip_bounds();
        self.canvas.read_pixels(all).expect("there is memory for a copy").into_vec()
    }
}

pub fn path(segments: &[Segment]) -> Path {
    let mut path = Path::new();
    for segment in segments {
        match *segment {
            Segment::Move(p) => path.move_to(p),
            Segment::Line(p) => path.line_to(p),
            Segment::Quad(c, p) => path.quad_to(c, p),
            Segment::Cubic(c1, c2, p) => path.cubic_to(c1, c2, p),
            Segment::Close => path.close(),
        };
    }
    path
}

fn outline(shape: &Shape) -> Outline {
    match shape {
        Shape::Rect([l, t, r, b]) => Outline::Rect(Rect::from_ltrb(*l, *t, *r, *b)),
        Shape::Path(segments) => Outline::Path(path(segments)),
    }
}

fn transform([a, b, c, d, e, f]: scene::Transform) -> Transform {
    Transform::from_row(a, b, c, d, e, f)
}

fn fill_rule(rule: Rule) -> FillRule {
    match rule {
        Rule::NonZero => FillRule::NonZero,
        Rule::EvenOdd => FillRule::EvenOdd,
    }
}

fn stroke_style(stroke: &scene::Stroke) -> Stroke {
    let dash = Dash { intervals: stroke.dashes.clone().into(), offset: stroke.dash_offset };
    Stroke {
        width: stroke.width,
        cap: match stroke.cap {
            Cap::Butt => LineCap::Butt,
            Cap::Round => LineCap::Round,
            Cap::Square => LineCap::Square,
        },
        join: match stroke.join {
            Join::Miter => LineJoin::Miter,
            Join::Round => LineJoin::Round,
            Join::Bevel => LineJoin::Bevel,
        },
        miter_limit: stroke.miter_limit,
        dash: (!stroke.dashes.is_empty()).then_some(dash),
    }
}

fn pixmap(image: &scene::Image) -> Pixmap {
    Pixmap::from_vec(image.width, image.height, image.rgba.clone()).expect("an image has a valid size")
}

fn color([r, g, b, a]: scene::Color) -> Color {
    Color::from_rgba8(r, g, b, a)
}

fn stops(gradient: &scene::Gradient) -> Vec<GradientStop> {
    gradient.stops.iter().map(|(position, stop)| GradientStop::new(*position, color(*stop))).collect()
}

fn spread(spread: Spread) -> SpreadMode {
    match spread {
        Spread::Pad => SpreadMode::Pad,
        Spread::Reflect => SpreadMode::Reflect,
        Spread::Repeat => SpreadMode::Repeat,
    }
}

fn paint(paint: &scene::Paint, images: &[Arc<Pixmap>]) -> Paint {
    match paint {
        scene::Paint::Solid(solid) => Paint::new(color(*solid)),
        scene::Paint::Linear { start, end, gradient } => {
            let shader = LinearGradient::new(*start, *end, stops(gradient))
                .with_spread(spread(gradient.spread))
                .with_transform(transform(gradient.transform));
            Paint::new(shader).with_opacity(gradient.opacity)
        }
        scene::Paint::Radial { focus, focal_radius, center, radius, gradient } => {
            let shader = RadialGradient::two_point(*focus, *focal_radius, *center, *radius, stops(gradient))
                .with_spread(spread(gradient.spread))
                .with_transform(transform(gradient.transform));
            Paint::new(shader).with_opacity(gradient.opacity)
        }
        scene::Paint::Image { index, smooth, opacity, transform: to_user } => {
            let shader = Pattern::new(Arc::clone(&images[*index]))
                .with_quality(if *smooth { FilterQuality::Bilinear } else { FilterQuality::Nearest })
                .with_spread(SpreadMode::Pad)
                .with_transform(transform(*to_user));
            Paint::new(shader).with_opacity(*opacity)
        }
    }
}
