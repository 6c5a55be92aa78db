//! Scenes of pixels that meet: blend modes, clips, masks and layers.

use rastrum::{
    BlendMode, Color, FillRule, FilterQuality, GradientStop, LinearGradient, MaskKind, Paint, Pattern, Pixmap,
    RadialGradient, Stroke, Transform,
};

use super::limits::Group;
use super::scene::{Item, Outline, SIZE, Scene, ellipse, fill, flood, path, polygon, rect, scene, stroke};
use super::scenes_paints::two_stops;

const NON_ZERO: FillRule = FillRule::NonZero;

/// From one colour to another along x, or along y.
fn ramp(vertical: bool, from: [u8; 4], to: [u8; 4]) -> LinearGradient {
    let stop = |position, [r, g, b, a]: [u8; 4]| GradientStop::new(position, Color::from_rgba8(r, g, b, a));
    let end = if vertical { (0.0, 96.0) } else { (96.0, 0.0) };
    LinearGradient::new((0.0, 0.0), end, vec![stop(0.0, from), stop(1.0, to)])
}

/// As [`ramp`], as an image: both libraries then blend the same 8-bit colours. The dividing modes make much of half a
/// level.
fn ramp_image(vertical: bool, from: [u8; 4], to: [u8; 4]) -> Pattern {
    let data = (0..SIZE * SIZE).flat_map(|index| {
        let step = if vertical { index / SIZE } else { index % SIZE };
        let mix = |c: usize| (u32::from(from[c]) * (SIZE - 1 - step) + u32::from(to[c]) * step) / (SIZE - 1);
        [0, 1, 2, 3].map(|c| mix(c) as u8)
    });
    let image = Pixmap::from_straight(SIZE, SIZE, data.collect()).unwrap();
    Pattern::new(image).with_quality(FilterQuality::Nearest)
}

fn triangle() -> Outline {
    polygon(&[(6.3, 88.6), (44.7, 5.1), (91.2, 81.9)])
}

pub(super) fn blends() -> Vec<Scene> {
    let mut scenes = Vec::new();
    for mode in BlendMode::ALL {
        let group = if mode == BlendMode::Color { Group::ClippedColor } else { Group::Straight };
        // Colours and alphas of the destination change from left to right, those of the source from top to bottom.
        let below = ramp_image(false, [250, 30, 90, 40], [20, 200, 160, 255]);
        let above = ramp_image(true, [40, 60, 240, 255], [240, 220, 0, 70]);
        let items = vec![flood(below), fill(triangle(), NON_ZERO, Paint::new(above).with_blend_mode(mode))];
        scenes.push(Scene {
            background: Color::TRANSPARENT,
            ..scene(group, format!("a triangle blended by {mode:?}"), items)
        });
    }
    scenes
}

pub(super) fn clips() -> Vec<Scene> {
    let paint = || LinearGradient::new((10.0, 10.0), (80.0, 90.0), two_stops());
    let turned = Transform::from_rotate_at(28.0, (48.0, 48.0));
    let scenes = [
        ("a clip to a circle", vec![Item::Clipped(ellipse(48.2, 46.7, 36.3, 36.3), NON_ZERO, vec![flood(paint())])]),
        (
            "a triangle within a rectangle between pixels",
            vec![Item::Clipped(rect(20.3, 25.4, 50.1, 47.3), NON_ZERO, vec![fill(triangle(), NON_ZERO, Color::BLACK)])],
        ),
        (
            "a clip on pixel boundaries",
            vec![Item::Clipped(rect(20.0, 25.0, 50.0, 47.0), NON_ZERO, vec![fill(triangle(), NON_ZERO, Color::BLACK)])],
        ),
        (
            "a turned rectangle as a clip",
            vec![Item::Transformed(
                turned,
                vec![Item::Clipped(rect(20.3, 25.4, 50.1, 47.3), NON_ZERO, vec![flood(paint())])],
            )],
        ),
        (
            "two circles' intersection",
            vec![Item::Clipped(
                ellipse(37.2, 46.7, 30.3, 30.3),
                NON_ZERO,
                vec![Item::Clipped(ellipse(58.2, 50.7, 30.3, 30.3), NON_ZERO, vec![flood(paint())])],
            )],
        ),
        (
            "three clips of different kinds",
            vec![Item::Clipped(
                rect(10.4, 12.7, 75.2, 70.6),
                NON_ZERO,
                vec![Item::Transformed(
                    turned,
                    vec![Item::Clipped(
                        rect(15.1, 20.6, 66.2, 58.7),
                        NON_ZERO,
                        vec![Item::Clipped(
                            triangle(),
                            NON_ZERO,
                            vec![
                                flood(paint()),
                                stroke(ellipse(48.0, 50.0, 30.0, 20.0), Stroke::new(6.0), Color::BLACK),
                            ],
                        )],
                    )],
                )],
            )],
        ),
        (
            "an even-odd clip of a star",
            vec![Item::Clipped(
                polygon(&[(48.1, 4.3), (73.6, 88.2), (5.4, 36.1), (90.7, 36.2), (22.3, 87.9)]),
                FillRule::EvenOdd,
                vec![flood(paint())],
            )],
        ),
        (
            "a translucent blend within a clip",
            vec![
                flood(ramp(true, [250, 30, 90, 255], [20, 200, 160, 255])),
                Item::Clipped(
                    ellipse(48.2, 46.7, 36.3, 36.3),
                    NON_ZERO,
                    vec![fill(
                        triangle(),
                        NON_ZERO,
                        Paint::new(Color::from_rgba8(30, 80, 220, 150)).with_blend_mode(BlendMode::Multiply),
                    )],
                ),
            ],
        ),
    ];
    scenes.into_iter().map(|(name, items)| scene(Group::Curved, name, items)).collect()
}

pub(super) fn masks() -> Vec<Scene> {
    let glow = || {
        let stops = vec![
            GradientStop::new(0.0, Color::from_rgba8(255, 250, 240, 255)),
            GradientStop::new(1.0, Color::from_rgba8(180, 0, 60, 0)),
        ];
        RadialGradient::new((48.0, 48.0), 44.0, stops)
    };
    let mut scenes = Vec::new();
    for kind in [MaskKind::Alpha, MaskKind::Luminance] {
        let striped = || {
            let bar = |x: f32, color| fill(rect(x, 6.3, 13.4, 80.2), NON_ZERO, color);
            vec![
                bar(8.3, Color::WHITE),
                bar(24.6, Color::from_rgba8(0, 255, 0, 255)),
                bar(40.2, Color::from_rgba8(120, 130, 40, 200)),
                bar(56.8, Color::from_rgba8(0, 0, 255, 255)),
                bar(72.1, Color::from_rgba8(255, 0, 0, 90)),
            ]
        };
        let items = || vec![flood(Color::from_rgba8(20, 60, 160, 255))];
        let layered =
            |picture| Item::MaskedLayer { kind, picture, items: vec![fill(triangle(), NON_ZERO, Color::BLACK)] };
        scenes.extend([
            scene(
                Group::Straight,
                format!("{kind:?} mask of stripes"),
                vec![Item::Masked { kind, picture: striped(), items: items() }],
            ),
            scene(
                Group::Straight,
                format!("{kind:?} mask of a glow"),
                vec![Item::Masked { kind, picture: vec![flood(glow())], items: items() }],
            ),
            scene(
                Group::Straight,
                format!("a triangle in a layer under {kind:?} mask of stripes"),
                vec![layered(striped())],
            ),
            scene(
                Group::Straight,
                format!("a triangle in a layer under {kind:?} mask of a glow"),
                vec![layered(vec![flood(glow())])],
            ),
            scene(
                Group::Curved,
                format!("{kind:?} mask within a clip"),
                vec![Item::Clipped(
                    ellipse(48.2, 46.7, 36.3, 36.3),
                    NON_ZERO,
                    vec![Item::Masked { kind, picture: vec![flood(glow())], items: items() }],
                )],
            ),
        ]);
    }
    scenes
}

pub(super) fn layers() -> Vec<Scene> {
    let disc = |x: f32, y: f32, color| fill(ellipse(x, y, 24.3, 24.3), NON_ZERO, color);
    let discs = || {
        vec![
            disc(36.2, 38.4, Color::from_rgba8(220, 40, 30, 255)),
            disc(60.1, 40.3, Color::from_rgba8(30, 200, 60, 255)),
            disc(47.4, 60.2, Color::from_rgba8(20, 60, 230, 180)),
        ]
    };
    let below = || flood(ramp(false, [250, 230, 190, 255], [20, 100, 160, 255]));
    let layer = |opacity, blend_mode, items| Item::Layer { opacity, blend_mode, items };
    let frame = || {
        path(|p| {
            p.rect(rastrum::Rect::from_ltrb(15.3, 18.2, 80.4, 78.8));
        })
    };
    let mut scenes = Vec::new();
    for opacity in [1.0, 0.6, 0.2] {
        let items = vec![below(), layer(opacity, BlendMode::SourceOver, discs())];
        scenes.push(scene(Group::Curved, format!("a layer at opacity {opacity}"), items));
    }
    for mode in [BlendMode::Multiply, BlendMode::Screen, BlendMode::DestinationOut, BlendMode::Luminosity] {
        let items = vec![below(), layer(0.8, mode, discs())];
        scenes.push(scene(Group::Curved, format!("a layer blended by {mode:?}"), items));
    }
    scenes.extend([
        scene(
            Group::Curved,
            "a layer within a layer",
            vec![
                below(),
                layer(
                    0.8,
                    BlendMode::SourceOver,
                    vec![disc(30.3, 30.4, Color::BLACK), layer(0.4, BlendMode::Difference, discs())],
                ),
            ],
        ),
        scene(
            Group::Curved,
            "a layer within a clip",
            vec![below(), Item::Clipped(frame(), NON_ZERO, vec![layer(0.6, BlendMode::SourceOver, discs())])],
        ),
        scene(
            Group::Curved,
            "a clip within a layer",
            vec![below(), layer(0.6, BlendMode::SourceOver, vec![Item::Clipped(frame(), NON_ZERO, discs())])],
        ),
        scene(
            Group::Straight,
            "a turned layer",
            vec![
                below(),
                Item::Transformed(
                    Transform::from_rotate_at(40.0, (48.0, 48.0)),
                    vec![layer(
                        0.6,
                        BlendMode::SourceOver,
                        vec![
                            fill(frame(), NON_ZERO, Color::from_rgba8(200, 30, 60, 255)),
                            stroke(frame(), Stroke::new(7.0), Color::BLACK),
                        ],
                    )],
                ),
            ],
        ),
    ]);
    scenes
}
