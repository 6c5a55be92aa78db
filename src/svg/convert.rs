//! usvg's types as the canvas's own.

use crate::blend::BlendMode;
use crate::geom::{Point, Rect, Transform};
use crate::paint::SpreadMode;
use crate::path::{LineCap, LineJoin, Path, Stroke};
use crate::style::FillRule;
use crate::surface::MaskKind;
use usvg::tiny_skia_path::PathSegment;

pub(super) fn transform(t: usvg::Transform) -> Transform {
    Transform::from_row(t.sx, t.ky, t.kx, t.sy, t.tx, t.ty)
}

pub(super) fn rect(r: usvg::NonZeroRect) -> Rect {
    Rect::from_ltrb(r.left(), r.top(), r.right(), r.bottom())
}

pub(super) fn bounds(r: usvg::Rect) -> Rect {
    Rect::from_ltrb(r.left(), r.top(), r.right(), r.bottom())
}

pub(super) fn path(path: &usvg::tiny_skia_path::Path) -> Path {
    let point = |p: usvg::tiny_skia_path::Point| Point::new(p.x, p.y);
    let mut out = Path::new();
    let mut last = Point::ZERO;
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => out.move_to(point(p)),
            PathSegment::LineTo(p) => out.line_to(point(p)),
            PathSegment::QuadTo(c, p) => out.quad_to(point(c), point(p)),
            PathSegment::CubicTo(c1, c2, p) => {
                let (c1, c2) = clear_ends(last, point(c1), point(c2), point(p));
                out.cubic_to(c1, c2, point(p))
            }
            PathSegment::Close => out.close(),
        };
        if let PathSegment::MoveTo(p)
        | PathSegment::LineTo(p)
        | PathSegment::QuadTo(_, p)
        | PathSegment::CubicTo(.., p) = segment
        {
            last = point(p);
        }
    }
    out
}

/// A cubic's control points; one that is only rounding away from its end lies on it: a stroke would take its direction
/// from nothing else.
fn clear_ends(start: Point, c1: Point, c2: Point, end: Point) -> (Point, Point) {
    let distance = |a: Point, b: Point| (a.x - b.x).abs() + (a.y - b.y).abs();
    let length = distance(start, end);
    // Both so near make a line of it, to a five-thousandth of its length.
    if distance(start, c1) < length * 4e-4 && distance(end, c2) < length * 4e-4 {
        return (start, end);
    }
    let least = length * 1e-5;
    (if distance(start, c1) < least { start } else { c1 }, if distance(end, c2) < least { end } else { c2 })
}

/// The rectangle that a path is, with edges along the axes: usvg makes paths of them all.
pub(super) fn rectangle(path: &usvg::tiny_skia_path::Path) -> Option<Rect> {
    use usvg::tiny_skia_path::PathVerb::{Close, Line, Move};
    let (&[Move, Line, Line, Line, Close], &[a, b, c, d]) = (path.verbs(), path.points()) else { return None };
    let across = a.y == b.y && b.x == c.x && c.y == d.y && d.x == a.x;
    let down = a.x == b.x && b.y == c.y && c.x == d.x && d.y == a.y;
    (across || down).then(|| Rect::from_ltrb(a.x, a.y, c.x, c.y).normalized())
}

pub(super) fn fill_rule(rule: usvg::FillRule) -> FillRule {
    match rule {
        usvg::FillRule::NonZero => FillRule::NonZero,
        usvg::FillRule::EvenOdd => FillRule::EvenOdd,
    }
}

pub(super) fn stroke(stroke: &usvg::Stroke) -> Stroke {
    let out = Stroke::new(stroke.width().get())
        .with_miter_limit(stroke.miterlimit().get())
        .with_cap(match stroke.linecap() {
            usvg::LineCap::Butt => LineCap::Butt,
            usvg::LineCap::Round => LineCap::Round,
            usvg::LineCap::Square => LineCap::Square,
        })
        .with_join(match stroke.linejoin() {
            usvg::LineJoin::Miter => LineJoin::Miter,
            usvg::LineJoin::MiterClip => LineJoin::MiterClip,
            usvg::LineJoin::Round => LineJoin::Round,
            usvg::LineJoin::Bevel => LineJoin::Bevel,
        });
    match stroke.dasharray() {
        Some(lengths) => out.with_dash(lengths, stroke.dashoffset()),
        None => out,
    }
}

pub(super) fn spread(method: usvg::SpreadMethod) -> SpreadMode {
    match method {
        usvg::SpreadMethod::Pad => SpreadMode::Pad,
        usvg::SpreadMethod::Reflect => SpreadMode::Reflect,
        usvg::SpreadMethod::Repeat => SpreadMode::Repeat,
    }
}

pub(super) fn blend_mode(mode: usvg::BlendMode) -> BlendMode {
    match mode {
        usvg::BlendMode::Normal => BlendMode::SourceOver,
        usvg::BlendMode::Multiply => BlendMode::Multiply,
        usvg::BlendMode::Screen => BlendMode::Screen,
        usvg::BlendMode::Overlay => BlendMode::Overlay,
        usvg::BlendMode::Darken => BlendMode::Darken,
        usvg::BlendMode::Lighten => BlendMode::Lighten,
        usvg::BlendMode::ColorDodge => BlendMode::ColorDodge,
        usvg::BlendMode::ColorBurn => BlendMode::ColorBurn,
        usvg::BlendMode::HardLight => BlendMode::HardLight,
        usvg::BlendMode::SoftLight => BlendMode::SoftLight,
        usvg::BlendMode::Difference => BlendMode::Difference,
        usvg::BlendMode::Exclusion => BlendMode::Exclusion,
        usvg::BlendMode::Hue => BlendMode::Hue,
        usvg::BlendMode::Saturation => BlendMode::Saturation,
        usvg::BlendMode::Color => BlendMode::Color,
        usvg::BlendMode::Luminosity => BlendMode::Luminosity,
        usvg::BlendMode::PlusLighter => BlendMode::Plus,
    }
}

pub(super) fn mask_kind(kind: usvg::MaskType) -> MaskKind {
    match kind {
        usvg::MaskType::Luminance => MaskKind::Luminance,
        usvg::MaskType::Alpha => MaskKind::Alpha,
    }
}
