//! Scenes of colour: gradients and images.

use std::sync::Arc;

use rastrum::{
    Color, FillRule, FilterQuality, GradientStop, LinearGradient, Paint, Pattern, RadialGradient, SpreadMode,
    SweepGradient, Transform,
};

use super::limits::Group;
use super::scene::{Item, Outline, Scene, ellipse, fill, flood, opaque, picture, polygon, rect, scene, shade};

const SPREADS: [SpreadMode; 3] = [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect];

fn stop(position: f32, rgba: [u8; 4]) -> GradientStop {
    let [r, g, b, a] = rgba;
    GradientStop::new(position, Color::from_rgba8(r, g, b, a))
}

pub(super) fn two_stops() -> Vec<GradientStop> {
    vec![stop(0.0, [220, 40, 10, 255]), stop(1.0, [20, 90, 240, 255])]
}

/// Stops at uneven places, one of them double, of differing alpha.
fn many_stops() -> Vec<GradientStop> {
    vec![
        stop(0.08, [255, 0, 0, 255]),
        stop(0.2, [250, 200, 0, 128]),
        stop(0.35, [0, 180, 60, 255]),
        stop(0.35, [240, 240, 255, 200]),
        stop(0.5, [0, 0, 0, 255]),
        stop(0.71, [120, 0, 200, 0]),
        stop(0.93, [30, 220, 220, 230]),
    ]
}

/// A slanted panel that leaves pixels inside and outside.
fn panel() -> Outline {
    polygon(&[(5.3, 12.1), (85.7, 4.6), (91.2, 83.9), (11.1, 91.4)])
}

fn painted(group: Group, name: impl Into<String>, paint: impl Into<Paint>) -> Scene {
    scene(group, name, vec![fill(panel(), FillRule::NonZero, paint)])
}

pub(super) fn gradients() -> Vec<Scene> {
    let mut scenes = Vec::new();
    for spread in SPREADS {
        let name = |kind: &str| format!("a {kind} gradient, {spread:?}");
        let linear = LinearGradient::new((30.2, 40.3), (62.7, 55.1), two_stops());
        let radial = RadialGradient::new((45.2, 50.3), 20.6, two_stops());
        let two_point = RadialGradient::two_point((40.2, 44.3), 6.2, (52.1, 50.9), 30.6, two_stops());
        let sweep = SweepGradient::new((45.2, 50.3), two_stops()).with_angles(40.0, 130.0);
        scenes.extend([
            painted(Group::Straight, name("linear"), linear.with_spread(spread)),
            painted(Group::Straight, name("radial"), radial.with_spread(spread)),
            painted(Group::Straight, name("two-point"), two_point.with_spread(spread)),
            painted(Group::Straight, name("sweep"), sweep.with_spread(spread)),
        ]);
    }
    let turned = Transform::from_rotate_at(35.0, (48.0, 48.0)).pre_concat(Transform::from_scale(1.3, 0.6));
    scenes.extend([
        painted(Group::Straight, "a horizontal gradient", LinearGradient::new((9.0, 0.0), (88.0, 0.0), two_stops())),
        painted(Group::Straight, "a vertical gradient", LinearGradient::new((0.0, 9.0), (0.0, 88.0), two_stops())),
        painted(Group::Straight, "a linear gradient of many stops", {
            LinearGradient::new((10.0, 20.0), (88.0, 71.0), many_stops())
        }),
        painted(Group::Straight, "a linear gradient of many stops, repeated", {
            LinearGradient::new((30.0, 40.0), (58.0, 51.0), many_stops()).with_spread(SpreadMode::Repeat)
        }),
        painted(Group::Straight, "a radial gradient of many stops", {
            RadialGradient::new((48.0, 46.0), 44.0, many_stops())
        }),
        painted(Group::Straight, "a sweep of many stops", SweepGradient::new((48.2, 46.1), many_stops())),
        painted(Group::Straight, "a ring between concentric circles", {
            RadialGradient::two_point((48.0, 46.0), 12.0, (48.0, 46.0), 40.0, two_stops())
        }),
        painted(Group::Straight, "a cone between circles apart", {
            RadialGradient::two_point((30.0, 46.0), 8.0, (70.0, 50.0), 20.0, two_stops())
        }),
        painted(Group::Straight, "a strip between equal circles", {
            RadialGradient::two_point((30.0, 46.0), 18.0, (70.0, 50.0), 18.0, two_stops())
        }),
        painted(Group::Straight, "a linear gradient with a transform", {
            LinearGradient::new((30.0, 20.0), (60.0, 50.0), two_stops()).with_transform(turned)
        }),
        painted(Group::Straight, "a radial gradient with a transform", {
            RadialGradient::new((40.0, 50.0), 30.0, two_stops()).with_transform(turned)
        }),
        painted(Group::Straight, "a sweep with a transform", {
            SweepGradient::new((40.3, 50.2), many_stops()).with_transform(turned)
        }),
        painted(Group::Straight, "a gradient at half opacity", {
            shade(LinearGradient::new((10.0, 20.0), (88.0, 71.0), many_stops())).with_opacity(0.5)
        }),
        scene(
            Group::Curved,
            "a gradient under the canvas's transform",
            vec![Item::Transformed(
                turned,
                vec![fill(
                    ellipse(40.0, 60.0, 28.0, 44.0),
                    FillRule::NonZero,
                    RadialGradient::new((35.0, 50.0), 40.0, many_stops()),
                )],
            )],
        ),
    ]);
    scenes
}

pub(super) fn images() -> Vec<Scene> {
    use Group::{FadedImage, Image, OvershootingImage};
    let image = picture();
    let pattern = |quality, spread, transform| {
        Pattern::new(Arc::clone(&image)).with_quality(quality).with_spread(spread).with_transform(transform)
    };
    // No pixel's centre falls on a border between pixels of the image, where rounding would decide.
    let enlarged = Transform::from_translate(21.3137, 17.6011).pre_concat(Transform::from_scale(3.7071, 4.1093));
    let reduced = Transform::from_translate(1.3137, 2.6011).pre_concat(Transform::from_scale(0.8071, 0.7093));
    let turned = Transform::from_translate(40.3, 13.6)
        .pre_concat(Transform::from_rotate(31.0))
        .pre_concat(Transform::from_scale(3.3, 2.7));
    let mut scenes = Vec::new();
    for quality in [FilterQuality::Nearest, FilterQuality::Bilinear, FilterQuality::Bicubic] {
        let group = if quality == FilterQuality::Bicubic { OvershootingImage } else { Image };
        let name = |what: &str| format!("a {quality:?} image {what}");
        for spread in SPREADS {
            let (opaque, pattern) = (opaque(), pattern(quality, spread, enlarged));
            scenes.push(painted(group, name(&format!("enlarged, {spread:?}")), pattern.clone()));
            let opaque = Pattern { image: opaque, ..pattern };
            scenes.push(painted(Image, name(&format!("enlarged, opaque, {spread:?}")), opaque));
        }
        scenes.extend([
            painted(group, name("reduced"), pattern(quality, SpreadMode::Repeat, reduced)),
            painted(group, name("turned"), pattern(quality, SpreadMode::Reflect, turned)),
            painted(FadedImage, name("at 0.4 opacity"), {
                shade(pattern(quality, SpreadMode::Pad, turned)).with_opacity(0.4)
            }),
        ]);
    }
    scenes.push(painted(Image, "an image on whole pixels", {
        pattern(FilterQuality::Bilinear, SpreadMode::Repeat, Transform::from_translate(5.0, 9.0))
    }));
    scenes.push(scene(
        Image,
        "an image under the canvas's transform",
        vec![Item::Transformed(
            turned,
            vec![fill(
                rect(0.5, 1.25, 14.0, 10.0),
                FillRule::NonZero,
                pattern(FilterQuality::Bilinear, SpreadMode::Pad, Transform::IDENTITY),
            )],
        )],
    ));
    // Each blends with what lies under it.
    for scene in &mut scenes {
        scene.items.insert(0, flood(LinearGradient::new((0.0, 0.0), (96.0, 96.0), two_stops())));
    }
    scenes
}
