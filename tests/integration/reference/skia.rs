//! Scenes drawn by tiny-skia, and rastrum's words in tiny-skia's.

use rastrum::{BlendMode, Color, FillRule, LineCap, LineJoin, MaskKind, Segment, SpreadMode, Stroke, Transform};

use super::scene::{Item, Outline, SIZE, Scene, Style};

/// The picture that tiny-skia gives, antialiased.
///
/// Its 32-bit float pipeline is forced throughout, which its authors offer for tests. The 16-bit one, taken by itself
/// where it can be, divides by 256 where 255 is meant and truncates.
pub(super) fn draw(scene: &Scene) -> tiny_skia::Pixmap {
    let mut target = blank();
    target.fill(color(scene.background));
    Painter { transform: Transform::IDENTITY, mask: None }.draw_items(&mut target, &scene.items);
    target
}

pub(super) fn blank() -> tiny_skia::Pixmap {
    tiny_skia::Pixmap::new(SIZE, SIZE).unwrap()
}

/// What is in force where an item is drawn.
#[derive(Clone)]
struct Painter {
    transform: Transform,
    mask: Option<tiny_skia::Mask>,
}

impl Painter {
    fn draw_items(&self, target: &mut tiny_skia::Pixmap, items: &[Item]) {
        for item in items {
            match item {
                Item::Draw { outline, style, paint } => {
                    let path = path(outline);
                    with_paint(paint, |paint| {
                        let (transform, mask) = (transform(self.transform), self.mask.as_ref());
                        match style {
                            Style::Fill(rule) => target.fill_path(&path, paint, fill_rule(*rule), transform, mask),
                            Style::Stroke(style) => {
                                target.stroke_path(&path, paint, &stroke(style), transform, mask);
                            }
                        }
                    });
                }
                Item::Transformed(inner, items) => {
                    let painter = Self { transform: self.transform.pre_concat(*inner), ..self.clone() };
                    painter.draw_items(target, items);
                }
                Item::Clipped(outline, rule, items) => {
                    let mut inner = self.clone();
                    let (path, rule, transform) = (path(outline), fill_rule(*rule), transform(self.transform));
                    match &mut inner.mask {
                        Some(mask) => mask.intersect_path(&path, rule, true, transform),
                        none => {
                            let mut mask = tiny_skia::Mask::new(SIZE, SIZE).unwrap();
                            mask.fill_path(&path, rule, true, transform);
                            *none = Some(mask);
                        }
                    }
                    inner.draw_items(target, items);
                }
                Item::Masked { kind, picture, items } => {
                    let mut mask = mask(picture, *kind);
                    if let Some(outer) = &self.mask {
                        for (value, outer) in mask.data_mut().iter_mut().zip(outer.data()) {
                            *value = ((u32::from(*value) * u32::from(*outer) + 127) / 255) as u8;
                        }
                    }
                    Self { mask: Some(mask), ..self.clone() }.draw_items(target, items);
                }
                Item::Layer { opacity, blend_mode, items } => {
                    let mut layer = blank();
                    Self { mask: None, ..self.clone() }.draw_items(&mut layer, items);
                    draw_layer(target, &layer, *opacity, *blend_mode, self.mask.as_ref());
                }
                Item::MaskedLayer { kind, picture, items } => {
                    let mut layer = blank();
                    Self { mask: None, ..self.clone() }.draw_items(&mut layer, items);
                    layer.apply_mask(&mask(picture, *kind));
                    draw_layer(target, &layer, 1.0, BlendMode::SourceOver, self.mask.as_ref());
                }
            }
        }
    }
}

fn mask(picture: &[Item], kind: MaskKind) -> tiny_skia::Mask {
    let mut target = blank();
    Painter { transform: Transform::IDENTITY, mask: None }.draw_items(&mut target, picture);
    tiny_skia::Mask::from_pixmap(target.as_ref(), mask_type(kind))
}

/// Composites a finished layer.
pub(super) fn draw_layer(
    target: &mut tiny_skia::Pixmap,
    layer: &tiny_skia::Pixmap,
    opacity: f32,
    mode: BlendMode,
    mask: Option<&tiny_skia::Mask>,
) {
    let paint =
        tiny_skia::PixmapPaint { opacity, blend_mode: blend_mode(mode), quality: tiny_skia::FilterQuality::Nearest };
    target.draw_pixmap(0, 0, layer.as_ref(), &paint, tiny_skia::Transform::identity(), mask);
}

/// Paints every pixel of `target` as an item would that covers it.
pub(super) fn flood(target: &mut tiny_skia::Pixmap, paint: &rastrum::Paint, to_device: Transform) {
    with_paint(paint, |paint| {
        let mut paint = paint.clone();
        paint.shader.transform(transform(to_device));
        paint.anti_alias = false;
        let all = tiny_skia::Rect::from_xywh(0.0, 0.0, SIZE as f32, SIZE as f32).unwrap();
        target.fill_rect(all, &paint, tiny_skia::Transform::identity(), None);
    });
}

/// Calls `draw` with a paint in tiny-skia's words.
fn with_paint(paint: &rastrum::Paint, mut draw: impl FnMut(&tiny_skia::Paint<'_>)) {
    let image = match &paint.shader {
        rastrum::Shader::Pattern(pattern) => {
            let size = tiny_skia::IntSize::from_wh(pattern.image.width(), pattern.image.height()).unwrap();
            tiny_skia::Pixmap::from_vec(pattern.image.data().to_vec(), size)
        }
        _ => None,
    };
    draw(&tiny_skia::Paint {
        shader: shader(&paint.shader, paint.opacity, image.as_ref()),
        blend_mode: blend_mode(paint.blend_mode),
        anti_alias: true,
        force_hq_pipeline: true,
        ..tiny_skia::Paint::default()
    });
}

fn shader<'a>(shader: &rastrum::Shader, opacity: f32, image: Option<&'a tiny_skia::Pixmap>) -> tiny_skia::Shader<'a> {
    let stops = |stops: &[rastrum::GradientStop]| -> Vec<tiny_skia::GradientStop> {
        stops.iter().map(|s| tiny_skia::GradientStop::new(s.position, color(s.color.with_opacity(opacity)))).collect()
    };
    match shader {
        rastrum::Shader::Solid(solid) => tiny_skia::Shader::SolidColor(color(solid.with_opacity(opacity))),
        rastrum::Shader::LinearGradient(g) => tiny_skia::LinearGradient::new(
            point(g.start),
            point(g.end),
            stops(&g.stops),
            spread_mode(g.spread),
            transform(g.transform),
        )
        .unwrap(),
        rastrum::Shader::RadialGradient(g) => tiny_skia::RadialGradient::new(
            point(g.start_center),
            g.start_radius,
            point(g.end_center),
            g.end_radius,
            stops(&g.stops),
            spread_mode(g.spread),
            transform(g.transform),
        )
        .unwrap(),
        rastrum::Shader::SweepGradient(g) => tiny_skia::SweepGradient::new(
            point(g.center),
            g.start_angle,
            g.end_angle,
            stops(&g.stops),
            spread_mode(g.spread),
            transform(g.transform),
        )
        .unwrap(),
        rastrum::Shader::Pattern(p) => {
            assert_eq!(p.spread_x, p.spread_y, "tiny-skia has one spread mode for both axes");
            let quality = match p.quality {
                rastrum::FilterQuality::Nearest => tiny_skia::FilterQuality::Nearest,
                rastrum::FilterQuality::Bilinear => tiny_skia::FilterQuality::Bilinear,
                rastrum::FilterQuality::Bicubic => tiny_skia::FilterQuality::Bicubic,
            };
            let image = image.unwrap().as_ref();
            tiny_skia::Pattern::new(image, spread_mode(p.spread_x), quality, opacity, transform(p.transform))
        }
        other => panic!("{other:?} is not in tiny-skia"),
    }
}

/// An outline by tiny-skia's own path builder.
pub(super) fn path(outline: &Outline) -> tiny_skia::Path {
    match outline {
        Outline::Rect(r) => {
            tiny_skia::PathBuilder::from_rect(tiny_skia::Rect::from_ltrb(r.left, r.top, r.right, r.bottom).unwrap())
        }
        Outline::Ellipse { center: (x, y), rx, ry } => {
            let bounds = tiny_skia::Rect::from_ltrb(x - rx, y - ry, x + rx, y + ry).unwrap();
            tiny_skia::PathBuilder::from_oval(bounds).unwrap()
        }
        Outline::Path(path) => {
            let mut builder = tiny_skia::PathBuilder::new();
            for segment in path.segments() {
                match segment {
                    Segment::MoveTo(p) => builder.move_to(p.x, p.y),
                    Segment::LineTo(p) => builder.line_to(p.x, p.y),
                    Segment::QuadTo(c, p) => builder.quad_to(c.x, c.y, p.x, p.y),
                    Segment::CubicTo(c1, c2, p) => builder.cubic_to(c1.x, c1.y, c2.x, c2.y, p.x, p.y),
                    Segment::Close => builder.close(),
                }
            }
            builder.finish().unwrap()
        }
    }
}

pub(super) fn stroke(stroke: &Stroke) -> tiny_skia::Stroke {
    tiny_skia::Stroke {
        width: stroke.width,
        miter_limit: stroke.miter_limit,
        line_cap: match stroke.cap {
            LineCap::Butt => tiny_skia::LineCap::Butt,
            LineCap::Round => tiny_skia::LineCap::Round,
            LineCap::Square => tiny_skia::LineCap::Square,
        },
        line_join: match stroke.join {
            LineJoin::Miter => tiny_skia::LineJoin::Miter,
            LineJoin::MiterClip => tiny_skia::LineJoin::MiterClip,
            LineJoin::Round => tiny_skia::LineJoin::Round,
            LineJoin::Bevel => tiny_skia::LineJoin::Bevel,
        },
        dash: stroke.dash.as_ref().map(|d| tiny_skia::StrokeDash::new(d.intervals.to_vec(), d.offset).unwrap()),
    }
}

pub(super) fn transform(t: Transform) -> tiny_skia::Transform {
    tiny_skia::Transform::from_row(t.sx, t.ky, t.kx, t.sy, t.tx, t.ty)
}

pub(super) fn fill_rule(rule: FillRule) -> tiny_skia::FillRule {
    match rule {
        FillRule::NonZero => tiny_skia::FillRule::Winding,
        FillRule::EvenOdd => tiny_skia::FillRule::EvenOdd,
    }
}

pub(super) fn color(c: Color) -> tiny_skia::Color {
    tiny_skia::Color::from_rgba(c.r, c.g, c.b, c.a).unwrap()
}

pub(super) fn mask_type(kind: MaskKind) -> tiny_skia::MaskType {
    match kind {
        MaskKind::Alpha => tiny_skia::MaskType::Alpha,
        MaskKind::Luminance => tiny_skia::MaskType::Luminance,
    }
}

fn point(p: rastrum::Point) -> tiny_skia::Point {
    tiny_skia::Point::from_xy(p.x, p.y)
}

fn spread_mode(mode: SpreadMode) -> tiny_skia::SpreadMode {
    match mode {
        SpreadMode::Pad => tiny_skia::SpreadMode::Pad,
        SpreadMode::Repeat => tiny_skia::SpreadMode::Repeat,
        SpreadMode::Reflect => tiny_skia::SpreadMode::Reflect,
        SpreadMode::Decal => panic!("tiny-skia has no decal"),
    }
}

fn blend_mode(mode: BlendMode) -> tiny_skia::BlendMode {
    use tiny_skia::BlendMode as Skia;
    match mode {
        BlendMode::Clear => Skia::Clear,
        BlendMode::Source => Skia::Source,
        BlendMode::Destination => Skia::Destination,
        BlendMode::SourceOver => Skia::SourceOver,
        BlendMode::DestinationOver => Skia::DestinationOver,
        BlendMode::SourceIn => Skia::SourceIn,
        BlendMode::DestinationIn => Skia::DestinationIn,
        BlendMode::SourceOut => Skia::SourceOut,
        BlendMode::DestinationOut => Skia::DestinationOut,
        BlendMode::SourceAtop => Skia::SourceAtop,
        BlendMode::DestinationAtop => Skia::DestinationAtop,
        BlendMode::Xor => Skia::Xor,
        BlendMode::Plus => Skia::Plus,
        BlendMode::Modulate => Skia::Modulate,
        BlendMode::Screen => Skia::Screen,
        BlendMode::Overlay => Skia::Overlay,
        BlendMode::Darken => Skia::Darken,
        BlendMode::Lighten => Skia::Lighten,
        BlendMode::ColorDodge => Skia::ColorDodge,
        BlendMode::ColorBurn => Skia::ColorBurn,
        BlendMode::HardLight => Skia::HardLight,
        BlendMode::SoftLight => Skia::SoftLight,
        BlendMode::Difference => Skia::Difference,
        BlendMode::Exclusion => Skia::Exclusion,
        BlendMode::Multiply => Skia::Multiply,
        BlendMode::Hue => Skia::Hue,
        BlendMode::Saturation => Skia::Saturation,
        BlendMode::Color => Skia::Color,
        BlendMode::Luminosity => Skia::Luminosity,
    }
}
