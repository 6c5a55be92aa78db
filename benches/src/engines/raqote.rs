//! raqote: one draw target; its pixels are ARGB words, turned into RGBA bytes for comparison alone.

use raqote::{
    Color, DrawOptions, DrawTarget, ExtendMode, FilterMode, Gradient, GradientStop, Image, LineCap, LineJoin, Path,
    PathBuilder, Point, SolidSource, Source, Spread, StrokeStyle, Transform, Winding,
};

use super::Engine;
use crate::scene::{self, Cap, Join, Rule, Scene, Segment, Shape, Style};

pub struct Prepared {
    target: DrawTarget,
    items: Vec<Item>,
    /// Each clip with those that it lies in, outermost first.
    clips: Vec<Vec<Clip>>,
    images: Vec<Pixels>,
}

/// An image as ARGB words.
struct Pixels {
    width: i32,
    height: i32,
    data: Vec<u32>,
}

struct Item {
    outline: Outline,
    paint: Paint,
    options: DrawOptions,
    transform: Transform,
    clip: Option<usize>,
}

enum Outline {
    Rect([f32; 4]),
    Fill(Path),
    Stroke(Path, StrokeStyle),
}

enum Paint {
    Source(Source<'static>),
    /// The image, and from user space to its pixels.
    Image(usize, FilterMode, Transform),
}

#[derive(Clone)]
struct Clip {
    path: Path,
    transform: Transform,
}

impl Prepared {
    pub fn new(scene: &Scene) -> Self {
        let items = scene.items.iter().filter_map(|item| {
            let (paint, alpha) = paint(&item.paint)?;
            Some(Item {
                outline: match (&item.shape, &item.style) {
                    (Shape::Rect(rect), Style::Fill(_)) => Outline::Rect(*rect),
                    (shape, Style::Fill(rule)) => Outline::Fill(path(shape, *rule)),
                    (shape, Style::Stroke(stroke)) => Outline::Stroke(path(shape, Rule::NonZero), stroke_style(stroke)),
                },
                paint,
                options: DrawOptions { alpha, ..DrawOptions::new() },
                transform: transform(item.transform),
                clip: item.clip,
            })
        });
        let items = items.collect();
        let clip = |index: usize| {
            let clip = &scene.clips[index];
            Clip { path: path(&clip.shape, clip.rule), transform: transform(clip.transform) }
        };
        let chains = (0..scene.clips.len()).map(|index| scene.clip_chain(Some(index)));
        let images = scene.images.iter().map(|image| {
            let word = |[r, g, b, a]: &[u8; 4]| u32::from_be_bytes([*a, *r, *g, *b]);
            let data = image.rgba.as_chunks().0.iter().map(word).collect();
            Pixels { width: image.width as i32, height: image.height as i32, data }
        });
        let mut target = DrawTarget::new(scene.width as i32, scene.height as i32);
        target.clear(SolidSource { r: 255, g: 255, b: 255, a: 255 });
        Self {
            target,
            items,
            clips: chains.map(|chain| chain.into_iter().map(clip).collect()).collect(),
            images: images.collect(),
        }
    }
}

impl Engine for Prepared {
    fn draw(&mut self) {
        let target = &mut self.target;
        target.clear(SolidSource { r: 255, g: 255, b: 255, a: 255 });
        let mut inside = None;
        for item in &self.items {
            if item.clip != inside {
                for _ in inside.map_or(&[][..], |clip: usize| &self.clips[clip]) {
                    target.pop_clip();
                }
                for clip in item.clip.map_or(&[][..], |clip| &self.clips[clip]) {
                    target.set_transform(&clip.transform);
                    target.push_clip(&clip.path);
                }
                inside = item.clip;
            }
            target.set_transform(&item.transform);
            let from_image;
            let source = match &item.paint {
                Paint::Source(source) => source,
                Paint::Image(index, filter, to_image) => {
                    let Pixels { width, height, data } = &self.images[*index];
                    let image = Image { width: *width, height: *height, data };
                    from_image = Source::Image(image, ExtendMode::Pad, *filter, *to_image);
                    &from_image
                }
            };
            match &item.outline {
                Outline::Rect([l, t, r, b]) => target.fill_rect(*l, *t, r - l, b - t, source, &item.options),
                Outline::Fill(path) => target.fill(path, source, &item.options),
                Outline::Stroke(path, stroke) => target.stroke(path, source, stroke, &item.options),
            }
        }
        for _ in inside.map_or(&[][..], |clip| &self.clips[clip]) {
            target.pop_clip();
        }
    }

    fn picture(&mut self) -> Vec<u8> {
        let bytes = |word: &u32| {
            let [a, r, g, b] = word.to_be_bytes();
            [r, g, b, a]
        };
        self.target.get_data().iter().flat_map(bytes).collect()
    }
}

fn path(shape: &Shape, rule: Rule) -> Path {
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
    let winding = match rule {
        Rule::NonZero => Winding::NonZero,
        Rule::EvenOdd => Winding::EvenOdd,
    };
    Path { winding, ..path.finish() }
}

fn transform([a, b, c, d, e, f]: scene::Transform) -> Transform {
    Transform::new(a, b, c, d, e, f)
}

fn stroke_style(stroke: &scene::Stroke) -> StrokeStyle {
    StrokeStyle {
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
        dash_array: stroke.dashes.clone(),
        dash_offset: stroke.dash_offset,
    }
}

fn gradient(gradient: &scene::Gradient) -> Gradient {
    let stop = |(position, [r, g, b, a]): &(f32, scene::Color)| GradientStop {
        position: *position,
        color: Color::new(*a, *r, *g, *b),
    };
    Gradient { stops: gradient.stops.iter().map(stop).collect() }
}

fn spread(spread: scene::Spread) -> Spread {
    match spread {
        scene::Spread::Pad => Spread::Pad,
        scene::Spread::Reflect => Spread::Reflect,
        scene::Spread::Repeat => Spread::Repeat,
    }
}

/// The paint and its opacity; `None` where its transform cannot be inverted.
fn paint(paint: &scene::Paint) -> Option<(Paint, f32)> {
    let point = |[x, y]: scene::Point| Point::new(x, y);
    Some(match paint {
        scene::Paint::Solid([r, g, b, a]) => {
            (Paint::Source(Source::Solid(SolidSource::from_unpremultiplied_argb(*a, *r, *g, *b))), 1.0)
        }
        scene::Paint::Linear { start, end, gradient: own } => {
            let to_gradient = transform(own.transform).inverse()?;
            let plain = Source::new_linear_gradient(gradient(own), point(*start), point(*end), spread(own.spread));
            let Source::LinearGradient(stops, spread, to_unit) = plain else { return None };
            (Paint::Source(Source::LinearGradient(stops, spread, to_gradient.then(&to_unit))), own.opacity)
        }
        scene::Paint::Radial { focus, focal_radius, center, radius, gradient: own } => {
            let to_gradient = transform(own.transform).inverse()?;
            let source = if focus == center && *focal_radius == 0.0 {
                let plain = Source::new_radial_gradient(gradient(own), point(*center), *radius, spread(own.spread));
                let Source::RadialGradient(stops, spread, to_unit) = plain else { return None };
                Source::RadialGradient(stops, spread, to_gradient.then(&to_unit))
            } else {
                let (from, to) = (point(*focus), point(*center));
                let stops = gradient(own);
                Source::TwoCircleRadialGradient(
                    stops,
                    spread(own.spread),
                    from,
                    *focal_radius,
                    to,
                    *radius,
                    to_gradient,
                )
            };
            (Paint::Source(source), own.opacity)
        }
        scene::Paint::Image { index, smooth, opacity, transform: to_user } => {
            let filter = if *smooth { FilterMode::Bilinear } else { FilterMode::Nearest };
            (Paint::Image(*index, filter, transform(*to_user).inverse()?), *opacity)
        }
    })
}
