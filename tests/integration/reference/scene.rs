//! What a scene is: a description that three painters follow.

use std::sync::Arc;

use rastrum::{BlendMode, Color, FillRule, MaskKind, Paint, Path, Pixmap, Rect, Shader, Stroke, Transform};

use super::limits::Group;

/// Width and height of every scene.
pub(super) const SIZE: u32 = 96;

/// A picture to be drawn by rastrum, by tiny-skia and by the slow truth.
pub(super) struct Scene {
    pub(super) name: String,
    /// Which limits apply.
    pub(super) group: Group,
    /// The colour of every pixel at first.
    pub(super) background: Color,
    pub(super) items: Vec<Item>,
}

/// One thing to do, in order.
#[derive(Clone)]
pub(super) enum Item {
    Draw {
        outline: Outline,
        style: Style,
        paint: Paint,
    },
    /// Items under one more transform.
    Transformed(Transform, Vec<Item>),
    /// Items within one more clip.
    Clipped(Outline, FillRule, Vec<Item>),
    /// Items within the mask that a picture of other items gives. The picture ignores transforms and clips in force.
    Masked {
        kind: MaskKind,
        picture: Vec<Item>,
        items: Vec<Item>,
    },
    /// Items that become one picture first.
    Layer {
        opacity: f32,
        blend_mode: BlendMode,
        items: Vec<Item>,
    },
    /// A layer multiplied by the mask that a picture of other items gives.
    MaskedLayer {
        kind: MaskKind,
        picture: Vec<Item>,
        items: Vec<Item>,
    },
}

/// A shape; each library draws its own rectangle and ellipse.
#[derive(Clone)]
pub(super) enum Outline {
    Path(Path),
    Rect(Rect),
    Ellipse { center: (f32, f32), rx: f32, ry: f32 },
}

#[derive(Clone)]
pub(super) enum Style {
    Fill(FillRule),
    Stroke(Stroke),
}

pub(super) fn scene(group: Group, name: impl Into<String>, items: Vec<Item>) -> Scene {
    Scene { name: name.into(), group, background: Color::WHITE, items }
}

pub(super) fn fill(outline: Outline, rule: FillRule, paint: impl Into<Paint>) -> Item {
    Item::Draw { outline, style: Style::Fill(rule), paint: paint.into() }
}

pub(super) fn stroke(outline: Outline, stroke: Stroke, paint: impl Into<Paint>) -> Item {
    Item::Draw { outline, style: Style::Stroke(stroke), paint: paint.into() }
}

/// Everything, painted.
pub(super) fn flood(paint: impl Into<Paint>) -> Item {
    fill(rect(0.0, 0.0, SIZE as f32, SIZE as f32), FillRule::NonZero, paint)
}

pub(super) fn shade(shader: impl Into<Shader>) -> Paint {
    Paint::new(shader)
}

pub(super) fn rect(x: f32, y: f32, width: f32, height: f32) -> Outline {
    Outline::Rect(Rect::from_xywh(x, y, width, height))
}

pub(super) fn ellipse(x: f32, y: f32, rx: f32, ry: f32) -> Outline {
    Outline::Ellipse { center: (x, y), rx, ry }
}

pub(super) fn polygon(points: &[(f32, f32)]) -> Outline {
    let mut path = chain(points);
    path.close();
    Outline::Path(path)
}

pub(super) fn polyline(points: &[(f32, f32)]) -> Outline {
    Outline::Path(chain(points))
}

fn chain(points: &[(f32, f32)]) -> Path {
    let mut path = Path::new();
    for (index, point) in points.iter().enumerate() {
        if index == 0 {
            path.move_to(*point)
        } else {
            path.line_to(*point)
        };
    }
    path
}

/// A path written by calls.
pub(super) fn path(build: impl FnOnce(&mut Path)) -> Outline {
    let mut path = Path::new();
    build(&mut path);
    Outline::Path(path)
}

/// A picture of 16 × 12 pixels in which every pixel differs from its neighbours, half of them not opaque.
pub(super) fn picture() -> Arc<Pixmap> {
    small_picture(|x, y| if (x / 4 + y / 4) % 2 == 0 { 255 } else { 60 + 10 * x })
}

/// The same picture's colours, opaque.
pub(super) fn opaque() -> Arc<Pixmap> {
    small_picture(|_, _| 255)
}

fn small_picture(alpha: impl Fn(u32, u32) -> u32) -> Arc<Pixmap> {
    let data = (0..16 * 12_u32).flat_map(|index| {
        let (x, y) = (index % 16, index / 16);
        [x * 17, y * 23, (x * 53 + y * 91) % 256, alpha(x, y)].map(|v| v as u8)
    });
    Arc::new(Pixmap::from_straight(16, 12, data.collect()).unwrap())
}
