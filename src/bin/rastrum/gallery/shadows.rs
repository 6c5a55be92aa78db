//! Shadow maps.

use rastrum::glam::Mat4;
use rastrum::scene::{Camera, Light, Mesh, Projection, Scene, ShadowSettings, light_depths};
use rastrum::{Color, Pixmap, Point, Rect, Result, Stroke};

use super::board::{AMBER, BLUE, Board, GREY, INK, MINT, RED, grey};
use super::stage;
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        127,
        "Shadow map, pass 1",
        "What the light sees, as depths (near is dark), and the camera's picture of the same scene.",
        first_pass,
    ),
    row(
        128,
        "Shadow map, pass 2",
        "From above: where the map has something nearer to the light, only ambient light is left. The red outline is the shadow's exact polygon.",
        second_pass,
    ),
    row(
        129,
        "Acne and its cure",
        "Without a bias the surface shadows itself in stripes, as one texel of the map holds one depth for all of its place (left). A bias by slope cures it (right).",
        bias,
    ),
    row(
        130,
        "Resolution",
        "Maps of 32, 64, 128 and 256 texels a side: each doubling halves the error of the shadow's edge.",
        resolution,
    ),
    row(
        131,
        "Soft shadows",
        "Percentage-closer filtering over 1, 3 × 3, 7 × 7 and 17 × 17 texels: the edge becomes a penumbra.",
        soft,
    ),
];

const SUN: [f32; 3] = [1.0, 1.6, 0.5];

fn scene(shadows: ShadowSettings) -> Scene {
    let mut scene = stage::scene(vec![
        (stage::floor(3.0, 0.0), stage::matte(MINT), Mat4::IDENTITY),
        (Mesh::cuboid([-0.5, 0.8, -0.5], [0.5, 1.8, 0.5], 0), stage::matte(BLUE), Mat4::IDENTITY),
        (Mesh::sphere(0.5, 40, 20, 0), stage::matte(AMBER), stage::at(1.4, 0.5, 1.2)),
    ]);
    scene.lights = vec![Light { shadows: true, ..Light::directional(SUN) }];
    scene.ambient = 0.3;
    scene.shadows = shadows;
    scene
}

fn hard(resolution: u32) -> ShadowSettings {
    ShadowSettings { resolution, radius: 0, ..ShadowSettings::default() }
}

fn from_the_side() -> Camera {
    Camera { near: 1.0, far: 30.0, ..Camera::look_at([2.4, 3.6, 4.9], [-0.1, 0.3, 0.1], [0.0, 1.0, 0.0]) }
}

fn from_above(height: f32) -> Camera {
    let projection = Projection::Orthographic(height);
    Camera {
        near: 1.0,
        far: 50.0,
        projection,
        ..Camera::look_at([-0.4, 20.0, -0.1], [-0.4, 0.0, -0.1], [0.0, 0.0, -1.0])
    }
}

fn first_pass(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["THE LIGHT'S DEPTHS", "THE CAMERA'S PICTURE"]);
    let scene = scene(hard(256));
    if let Some((side, depths, _)) = light_depths(&scene, &from_the_side(), 0)? {
        let drawn = || depths.iter().copied().filter(|depth| *depth < 1.0);
        let (near, far) = (drawn().fold(1.0, f32::min), drawn().fold(0.0, f32::max));
        let shade = |depth: f32| {
            if depth < 1.0 { grey(0.15 + 0.7 * (depth - near) / (far - near).max(1e-6)) } else { Color::WHITE }
        };
        let data: Vec<u8> = depths.iter().flat_map(|depth| shade(*depth).premultiply()).collect();
        board.picture(left, Pixmap::from_vec(side, side, data)?);
    }
    stage::show(board, right, &scene, &from_the_side(), &stage::settings())?;
    Ok(())
}

fn second_pass(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["LIT ALONE", "WITH THE MAP"]);
    let scene = scene(hard(1024));
    let mut lit = scene.clone();
    lit.lights.iter_mut().for_each(|light| light.shadows = false);
    stage::show(board, left, &lit, &from_above(5.2), &stage::settings())?;
    stage::show(board, right, &scene, &from_above(5.2), &stage::settings())?;
    // The box's corners, cast along the light onto the floor; the outline of the upper and the lower face together.
    let cast = |x: f32, y: f32, z: f32| [x - y * SUN[0] / SUN[1], 0.0, z - y * SUN[2] / SUN[1]];
    let (low, high) = (0.8, 1.8);
    let outline = [
        cast(0.5, low, -0.5),
        cast(0.5, low, 0.5),
        cast(-0.5, low, 0.5),
        cast(-0.5, high, 0.5),
        cast(-0.5, high, -0.5),
        cast(0.5, high, -0.5),
    ];
    let size = Rect::from_xywh(right.left, right.top, right.width().floor(), right.height().floor());
    let points: Vec<Point> = outline.iter().filter_map(|p| from_above(5.2).project(*p, size)).map(|(p, _)| p).collect();
    board.canvas.stroke_polygon(&points, &Stroke::new(2.0), RED);
    Ok(())
}

fn bias(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["NO BIAS", "BIAS BY SLOPE"]);
    let none = ShadowSettings { bias: 0.0, bias_slope: 0.0, ..hard(160) };
    stage::show(board, left, &scene(none), &from_the_side(), &stage::settings())?;
    stage::show(board, right, &scene(hard(160)), &from_the_side(), &stage::settings())?;
    Ok(())
}

/// A near view of the box's shadow.
fn edge() -> Camera {
    from_above(2.6)
}

fn resolution(board: &mut Board) -> Result<()> {
    let panels = board.tiles(4, &["32", "64", "128", "256"]);
    for (rect, side) in panels.into_iter().zip([32, 64, 128, 256]) {
        stage::show(board, rect, &scene(hard(side)), &edge(), &stage::settings())?;
        board.frame(rect, GREY);
    }
    Ok(())
}

fn soft(board: &mut Board) -> Result<()> {
    let panels = board.tiles(4, &["1", "3 X 3", "7 X 7", "17 X 17"]);
    for (rect, radius) in panels.into_iter().zip([0, 1, 3, 8]) {
        let settings = ShadowSettings { radius, ..hard(256) };
        stage::show(board, rect, &scene(settings), &edge(), &stage::settings())?;
        board.frame(rect, INK);
    }
    Ok(())
}
