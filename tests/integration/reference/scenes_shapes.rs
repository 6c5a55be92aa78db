//! Scenes of coverage alone: fills and strokes in black on white.

use rastrum::{Color, FillRule, LineCap, LineJoin, Stroke, Transform};

use super::limits::Group;
use super::scene::{Item, Outline, Scene, ellipse, fill, path, polygon, polyline, rect, scene, stroke};
use crate::oracle::Random;

/// A black shape on white.
fn shape(group: Group, name: impl Into<String>, outline: Outline, rule: FillRule) -> Scene {
    scene(group, name, vec![fill(outline, rule, Color::BLACK)])
}

fn line(group: Group, name: impl Into<String>, outline: Outline, style: Stroke) -> Scene {
    scene(group, name, vec![stroke(outline, style, Color::BLACK)])
}

/// A polygon with corners anywhere on the grid of 1/256 pixel, where no library rounds them, but for odd eighths of a
/// pixel: there lie the samples, and the libraries give a sample on an edge to different sides.
fn random_polygon(seed: u64, corners: usize) -> Outline {
    let mut random = Random::new(seed);
    let mut coordinate = || loop {
        let v = random.within(2 * 256..94 * 256);
        if v % 64 != 32 {
            break v as f32 / 256.0;
        }
    };
    let points: Vec<(f32, f32)> = (0..corners).map(|_| (coordinate(), coordinate())).collect();
    polygon(&points)
}

/// A star of straight lines that cross each other, around (48, 48), on the grid of 1/256 pixel and a step beside the
/// samples.
#[expect(clippy::disallowed_methods, reason = "a corner elsewhere makes another star, as good as this one")]
fn star(corners: u32, step: u32, radius: f32) -> Outline {
    let on = |k: u32| {
        let angle = f64::from(k * step) / f64::from(corners) * std::f64::consts::TAU;
        let snap = |v: f64| ((v * 256.0).round() / 256.0 + 1.0 / 256.0) as f32;
        (snap(48.0 + f64::from(radius) * angle.sin()), snap(48.0 - f64::from(radius) * angle.cos()))
    };
    polygon(&(0..corners).map(on).collect::<Vec<_>>())
}

pub(super) fn fills() -> Vec<Scene> {
    use FillRule::{EvenOdd, NonZero};
    use Group::{Crossing, Curved, Straight};
    let mut scenes = vec![
        shape(Straight, "a rectangle on pixel boundaries", rect(8.0, 16.0, 70.0, 53.0), NonZero),
        shape(Straight, "a rectangle on quarter pixels", rect(8.25, 16.5, 70.5, 53.25), NonZero),
        shape(Straight, "a rectangle between samples", rect(7.3, 16.1, 70.3, 53.3), NonZero),
        shape(Straight, "a rectangle thinner than a pixel", rect(20.1, 3.0, 0.55, 88.0), NonZero),
        shape(Straight, "a rectangle cut by the canvas", rect(-10.3, 60.2, 60.0, 80.0), NonZero),
        shape(Straight, "a triangle", polygon(&[(10.3, 80.6), (50.7, 7.1), (88.2, 71.9)]), NonZero),
        shape(Straight, "a sliver", polygon(&[(3.1, 10.3), (93.3, 52.2), (93.1, 53.8)]), NonZero),
        shape(
            Straight,
            "a triangle cut by the canvas",
            polygon(&[(-30.3, 20.6), (50.7, -40.1), (130.2, 141.9)]),
            NonZero,
        ),
        shape(Crossing, "a pentagram, nonzero", star(5, 2, 42.0), NonZero),
        shape(Crossing, "a pentagram, even-odd", star(5, 2, 42.0), EvenOdd),
        shape(Crossing, "a star of eleven rays, even-odd", star(11, 5, 44.0), EvenOdd),
        shape(Crossing, "a star of eleven rays, nonzero", star(11, 5, 44.0), NonZero),
        shape(Straight, "a decagon", star(10, 1, 40.0), NonZero),
        shape(Crossing, "a random polygon, even-odd", random_polygon(1, 9), EvenOdd),
        shape(Crossing, "a random polygon, nonzero", random_polygon(2, 9), NonZero),
        shape(Crossing, "a random polygon of 24 corners", random_polygon(3, 24), EvenOdd),
        shape(
            Straight,
            "a frame wound the same way, even-odd",
            path(|p| {
                p.rect(rastrum::Rect::from_ltrb(10.2, 10.3, 80.7, 80.6));
                p.move_to((30.3, 28.4)).line_to((70.6, 33.1)).line_to((52.2, 66.9)).close();
            }),
            EvenOdd,
        ),
        shape(
            Straight,
            "a hole wound the other way, nonzero",
            path(|p| {
                p.rect(rastrum::Rect::from_ltrb(10.2, 10.3, 80.7, 80.6));
                p.move_to((30.3, 28.4)).line_to((52.2, 66.9)).line_to((70.6, 33.1)).close();
            }),
            NonZero,
        ),
        shape(Curved, "a circle", ellipse(48.3, 47.8, 36.6, 36.6), NonZero),
        shape(Curved, "a small circle", ellipse(48.3, 47.8, 2.6, 2.6), NonZero),
        shape(Curved, "a wide ellipse", ellipse(48.3, 47.8, 44.1, 9.7), NonZero),
        shape(Curved, "an ellipse cut by the canvas", ellipse(3.3, 90.8, 44.1, 39.7), NonZero),
        shape(
            Curved,
            "a quadratic leaf",
            path(|p| {
                p.move_to((8.3, 80.2)).quad_to((20.1, 5.3), (88.4, 12.6)).quad_to((80.2, 84.1), (8.3, 80.2)).close();
            }),
            NonZero,
        ),
        shape(Curved, "a cubic loop, even-odd", cubic_loop(), EvenOdd),
        shape(Curved, "a cubic loop, nonzero", cubic_loop(), NonZero),
        shape(
            Curved,
            "a cubic wave with a cusp",
            path(|p| {
                p.move_to((6.2, 70.4)).cubic_to((90.3, 5.1), (5.6, 5.2), (90.1, 70.7)).line_to((48.0, 92.2)).close();
            }),
            NonZero,
        ),
        shape(
            Curved,
            "a rounded rectangle",
            path(|p| {
                p.round_rect(rastrum::Rect::from_xywh(9.4, 15.7, 77.3, 60.2), 14.3);
            }),
            NonZero,
        ),
        shape(
            Curved,
            "a ring",
            path(|p| {
                p.circle((47.6, 48.2), 40.3).circle((47.6, 48.2), 31.2);
            }),
            EvenOdd,
        ),
    ];
    let moved = |name: &str, transform: Transform, outline: Outline| {
        let group = if matches!(outline, Outline::Ellipse { .. }) { Curved } else { Straight };
        let items = vec![fill(outline, NonZero, Color::BLACK)];
        scene(group, name, vec![Item::Transformed(transform, items)])
    };
    let square = || rect(-25.0, -25.0, 50.0, 50.0);
    let centre = Transform::from_translate(48.2, 47.7);
    scenes.extend([
        moved("a square turned by 17 degrees", centre.pre_concat(Transform::from_rotate(17.0)), square()),
        moved("a square turned by 90 degrees", centre.pre_concat(Transform::from_rotate(90.0)), square()),
        moved("a skewed square", centre.pre_concat(Transform::from_skew(25.0, -10.0)), square()),
        moved("a mirrored triangle", Transform::from_row(-1.0, 0.0, 0.0, 1.0, 96.0, 0.0), {
            polygon(&[(10.3, 80.6), (50.7, 7.1), (88.2, 71.9)])
        }),
        moved("a circle made an ellipse", centre.pre_concat(Transform::from_scale(1.7, 0.6)), {
            ellipse(0.0, 0.0, 25.0, 25.0)
        }),
        moved(
            "an ellipse turned in two steps",
            centre.pre_concat(Transform::from_rotate(33.0)).pre_concat(Transform::from_scale(0.5, 2.0)),
            ellipse(2.0, 1.0, 25.0, 20.0),
        ),
    ]);
    scenes
}

fn cubic_loop() -> Outline {
    path(|p| {
        p.move_to((10.3, 85.2)).cubic_to((120.1, -10.3), (-25.4, -10.6), (86.2, 85.1)).close();
    })
}

pub(super) fn strokes() -> Vec<Scene> {
    use Group::{CurvedStroke, Hairline, Straight};
    let zigzag = || polyline(&[(10.2, 75.3), (30.6, 18.4), (52.3, 70.1), (84.9, 22.7), (86.1, 80.2)]);
    let curve = || {
        path(|p| {
            p.move_to((9.7, 70.3)).cubic_to((30.2, -20.6), (60.4, 120.9), (88.1, 21.2));
        })
    };
    let triangle = || polygon(&[(15.3, 78.6), (48.7, 15.1), (82.2, 70.9)]);
    let mut scenes = Vec::new();
    for width in [1.5, 3.0, 12.0] {
        scenes.push(line(Straight, format!("a zigzag {width} wide"), zigzag(), Stroke::new(width)));
        scenes.push(line(CurvedStroke, format!("a cubic {width} wide"), curve(), Stroke::new(width)));
    }
    for cap in [LineCap::Butt, LineCap::Round, LineCap::Square] {
        let open = || polyline(&[(20.3, 62.4), (70.6, 33.1)]);
        let group = if cap == LineCap::Round { CurvedStroke } else { Straight };
        scenes.push(line(group, format!("a line with {cap:?} caps"), open(), Stroke::new(14.0).with_cap(cap)));
        scenes.push(line(CurvedStroke, format!("a cubic with {cap:?} caps"), curve(), Stroke::new(9.0).with_cap(cap)));
    }
    for join in [LineJoin::Miter, LineJoin::MiterClip, LineJoin::Round, LineJoin::Bevel] {
        let style = Stroke::new(9.0).with_join(join);
        let group = if join == LineJoin::Round { CurvedStroke } else { Straight };
        scenes.push(line(group, format!("a zigzag with {join:?} joins"), zigzag(), style.clone()));
        scenes.push(line(group, format!("a triangle with {join:?} joins"), triangle(), style.with_miter_limit(2.5)));
    }
    scenes.extend([
        line(CurvedStroke, "a circle 5 wide", ellipse(48.3, 47.6, 35.2, 35.2), Stroke::new(5.0)),
        line(CurvedStroke, "an ellipse 3 wide", ellipse(48.3, 47.6, 42.2, 15.2), Stroke::new(3.0)),
        line(Straight, "a rectangle 4 wide", rect(14.3, 20.2, 66.4, 50.1), Stroke::new(4.0)),
        line(Straight, "a miter of 8", polyline(&[(15.1, 50.2), (70.3, 42.3), (15.2, 34.6)]), {
            Stroke::new(4.0).with_miter_limit(8.0)
        }),
        scene(
            CurvedStroke,
            "a stroke stretched with its path",
            vec![Item::Transformed(
                Transform::from_translate(48.0, 48.0)
                    .pre_concat(Transform::from_rotate(20.0))
                    .pre_concat(Transform::from_scale(2.0, 0.7)),
                vec![stroke(ellipse(0.0, 0.0, 18.0, 40.0), Stroke::new(6.0), Color::BLACK)],
            )],
        ),
    ]);
    for (cap, name) in [(LineCap::Butt, "butt"), (LineCap::Round, "round"), (LineCap::Square, "square")] {
        let style = Stroke::new(5.0).with_cap(cap).with_dash(vec![13.0, 9.5], 0.0);
        let group = if cap == LineCap::Round { CurvedStroke } else { Group::Crossing };
        scenes.push(line(group, format!("a zigzag in {name} dashes"), zigzag(), style));
    }
    scenes.extend([
        line(CurvedStroke, "a cubic in dashes", curve(), Stroke::new(4.0).with_dash(vec![9.0, 5.0], 3.5)),
        line(CurvedStroke, "a cubic in dashes and dots", curve(), {
            Stroke::new(3.0).with_dash(vec![12.0, 5.0, 3.0, 5.0], -4.0)
        }),
        line(CurvedStroke, "a triangle in dashes with an offset", triangle(), {
            Stroke::new(6.0).with_join(LineJoin::Round).with_dash(vec![21.0, 11.0], 7.0)
        }),
        line(CurvedStroke, "a circle in dashes", ellipse(48.3, 47.6, 35.2, 35.2), {
            Stroke::new(5.0).with_dash(vec![11.0, 7.0], 2.0)
        }),
        line(Hairline, "a hairline zigzag", zigzag(), Stroke::new(0.0)),
        line(Hairline, "a hairline cubic", curve(), Stroke::new(0.0)),
        line(Hairline, "a line half a pixel wide", polyline(&[(5.3, 20.2), (90.1, 61.7)]), Stroke::new(0.5)),
    ]);
    scenes
}
