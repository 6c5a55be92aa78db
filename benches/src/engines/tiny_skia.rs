//! tiny-skia: one pixmap; a clip is a mask, made in each picture anew, the last few kept while it is drawn.

use tiny_skia::{
    Color, FillRule, FilterQuality, GradientStop, LineCap, LineJoin, LinearGradient, Mask, Paint, Path, PathBuilder,
    Pattern, Pixmap, PixmapRef, Point, RadialGradient, Rect, Shader, SpreadMode, Stroke, StrokeDash, Transform,
};

use super::Engine;
use crate::scene::{self, Cap, Join, Rule, Scene, Segment, Shape, Spread, Style};

pub struct Prepared<'s> {
    target: Pixmap,
    items: Vec<Item<'s>>,
    /// Each clip with those that it lies in, outermost first.
    clips: Vec<Vec<Clip>>,
    /// The masks of the clips used last, the latest at the end; those of `None` are of earlier pictures.
    masks: Vec<(Option<usize>, Mask)>,
}

/// Enough for drawings that go back and forth between clips; all masks of a drawing may take a gigabyte.
const MASKS: usize = 8;

struct Item<'s> {
    outline: Outline,
    paint: Paint<'s>,
    transform: Transform,
    clip: Option<usize>,
}

enum Outline {
    Rect(Rect),
    Fill(Path, FillRule),
    Stroke(Path, Stroke),
}

#[derive(Clone)]
struct Clip {
    path: Option<Path>,
    rule: FillRule,
    transform: Transform,
}

impl<'s> Prepared<'s> {
    pub fn new(scene: &'s Scene) -> Self {
        // What tiny-skia cannot represent (a path without extent, say) it would not draw either.
        let items = scene.items.iter().filter_map(|item| {
            Some(Item {
                outline: match (&item.shape, &item.style) {
                    (Shape::Rect([l, t, r, b]), Style::Fill(_)) => Outline::Rect(Rect::from_ltrb(*l, *t, *r, *b)?),
                    (shape, Style::Fill(rule)) => Outline::Fill(path(shape)?, fill_rule(*rule)),
                    (shape, Style::Stroke(stroke)) => Outline::Stroke(path(shape)?, stroke_style(stroke)),
                },
                paint: Paint { shader: shader(&item.paint, scene)?, anti_alias: true, ..Paint::default() },
                transform: transform(item.transform),
                clip: item.clip,
            })
        });
        let items = items.collect();
        let clip = |index: usize| {
            let clip = &scene.clips[index];
            Clip { path: path(&clip.shape), rule: fill_rule(clip.rule), transform: transform(clip.transform) }
        };
        let chains = (0..scene.clips.len()).map(|index| scene.clip_chain(Some(index)));
        let clips: Vec<Vec<Clip>> = chains.map(|chain| chain.into_iter().map(clip).collect()).collect();
        let mut target = Pixmap::new(scene.width, scene.height).expect("the scene has a valid size");
        target.fill(Color::WHITE);
        Self { target, items, masks: Vec::new(), clips }
    }

    /// Makes a clip's mask the last of `masks`.
    fn make_mask(&mut self, clip: usize) {
        if let Some(at) = self.masks.iter().position(|(made_for, _)| *made_for == Some(clip)) {
            self.masks[at..].rotate_left(1);
            return;
        }
        let mut mask = if self.masks.len() < MASKS {
            Mask::new(self.target.width(), self.target.height()).expect("the scene has a valid size")
        } else {
            self.masks.remove(0).1
        };
        mask.clear();
        for (index, clip) in self.clips[clip].iter().enumerate() {
            match &clip.path {
                Some(path) if index == 0 => mask.fill_path(path, clip.rule, true, clip.transform),
                Some(path) => mask.intersect_path(path, clip.rule, true, clip.transform),
                None => mask.clear(),
            }
        }
        self.masks.push((Some(clip), mask));
    }
}

impl Engine for Prepared<'_> {
    fn draw(&mut self) {
        self.target.fill(Color::WHITE);
        for (made_for, _) in &mut self.masks {
            *made_for = None;
        }
        for index in 0..self.items.len() {
            if let Some(clip) = self.items[index].clip {
                self.make_mask(clip);
            }
            let Item { outline, paint, transform, clip } = &self.items[index];
            let mask = clip.and_then(|_| self.masks.last()).map(|(_, mask)| mask);
            match outline {
                Outline::Rect(rect) => self.target.fill_rect(*rect, paint, *transform, mask),
                Outline::Fill(path, rule) => self.target.fill_path(path, paint, *rule, *transform, mask),
                Outline::Stroke(path, stroke) => self.target.stroke_path(path, paint, stroke, *transform, mask),
            }
        }
    }

    fn picture(&mut self) -> Vec<u8> {
        self.target.data().to_vec()
    }
}

fn path(shape: &Shape) -> Option<Path> {
    let mut path = PathBuilder::new();
    for segment in scene::segments(shape) {
        match segment {
            Segment::Move([x, y]) => path.move_to(x, y),
            Segment::Line([x, y]) => path.line_to(x, y),
            Segment::Quad([x1, y1], [x, y]) => path.quad_to(x1, y1, x, y),
            Segment::Cubic([x1, y1], [x2, y2], [x, y]) => path.cubic_to(x1, y1, x2, y2, x, y),
            Segment::Close => path.close(),
        }
    }
    path.finish()
}

fn transform([a, b, c, d, e, f]: scene::Transform) -> Transform {
    Transform::from_row(a, b, c, d, e, f)
}

fn fill_rule(rule: Rule) -> FillRule {
    match rule {
        Rule::NonZero => FillRule::Winding,
        Rule::EvenOdd => FillRule::EvenOdd,
    }
}

fn stroke_style(stroke: &scene::Stroke) -> Stroke {
    Stroke {
        width: stroke.width,
        miter_limit: stroke.miter_limit,
        line_cap: match stroke.cap {
            Cap::Butt => LineCap::Butt,
            Cap::Round => LineCap::Round,
            Cap::Square => LineCap::Square,
        },
        line_join: match stroke.join {
            Join::Miter => LineJoin::Miter,
            Join::Round => LineJoin::Round,
            Join::Bevel => LineJoin::Bevel,
        },
        dash: StrokeDash::new(stroke.dashes.clone(), stroke.dash_offset),
    }
}

fn color([r, g, b, a]: scene::Color) -> Color {
    Color::from_rgba8(r, g, b, a)
}

fn stops(gradient: &scene::Gradient) -> Vec<GradientStop> {
    let stop = |(position, stop): &(f32, scene::Color)| {
        let mut color = color(*stop);
        color.apply_opacity(gradient.opacity);
        GradientStop::new(*position, color)
    };
    gradient.stops.iter().map(stop).collect()
}

fn spread(spread: Spread) -> SpreadMode {
    match spread {
        Spread::Pad => SpreadMode::Pad,
        Spread::Reflect => SpreadMode::Reflect,
        Spread::Repeat => SpreadMode::Repeat,
    }
}

fn shader<'s>(paint: &scene::Paint, scene: &'s Scene) -> Option<Shader<'s>> {
    let point = |[x, y]: scene::Point| Point::from_xy(x, y);
    match paint {
        scene::Paint::Solid(solid) => Some(Shader::SolidColor(color(*solid))),
        scene::Paint::Linear { start, end, gradient } => LinearGradient::new(
            point(*start),
            point(*end),
            stops(gradient),
            spread(gradient.spread),
            transform(gradient.transform),
        ),
        scene::Paint::Radial { focus, focal_radius, center, radius, gradient } => RadialGradient::new(
            point(*focus),
            *focal_radius,
            point(*center),
            *radius,
            stops(gradient),
            spread(gradient.spread),
            transform(gradient.transform),
        ),
        scene::Paint::Image { index, smooth, opacity, transform: to_user } => {
            let image = &scene.images[*index];
            let pixels = PixmapRef::from_bytes(&image.rgba, image.width, image.height)?;
            let quality = if *smooth { FilterQuality::Bilinear } else { FilterQuality::Nearest };
            Some(Pattern::new(pixels, SpreadMode::Pad, quality, *opacity, transform(*to_user)))
        }
    }
}
