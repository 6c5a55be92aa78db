//! Clipping.

use rastrum::space::{ClipPlane, ClipVertex, Depth, Samples, State, camera, clip_polygon, clip_triangle};
use rastrum::{Color, FillRule, Point, Result};

use super::board::{AMBER, BLUE, Board, GREY, INK, MINT, PALE, RED, ROSE, SKY};
use super::stage::{self, Vertex};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        87,
        "Clipping against six planes",
        "Left: triangles that leave the view are cut to its sides; colours are the pieces. Right: a road that runs on below and behind the viewer, where w is negative, drawn without harm.",
        six_planes,
    ),
    row(
        88,
        "The four cases",
        "All corners inside: kept. All outside: dropped. One inside: one triangle. Two inside: a quadrilateral, two triangles. Blue is what is left.",
        four_cases,
    ),
];

fn six_planes(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["IN NDC", "W BELOW 0"]);
    let grid = board.grid(left, 4, 4);
    let view = [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)];
    let view_points = view.map(|(x, y)| grid.map(x, y));
    board.canvas.fill_polygon(&view_points, FillRule::NonZero, PALE);
    let place = |p: [f32; 4]| grid.map(2.0 + p[0] / p[3], 2.0 - p[1] / p[3]);
    for (corners, color) in [
        ([(-1.7, -0.4), (0.1, 1.6), (0.3, -0.3)], [SKY, MINT, SKY, MINT]),
        ([(-0.6, -1.8), (1.8, -0.7), (0.6, 0.1)], [ROSE, AMBER, ROSE, AMBER]),
        ([(1.3, 1.8), (1.8, 0.6), (0.5, 0.7)], [SKY, ROSE, SKY, ROSE]),
    ] {
        let vertices = corners.map(|(x, y)| ClipVertex::new([x, y, 0.0, 1.0], &[]));
        let polygon = clip_triangle(vertices);
        for (i, pair) in polygon.windows(2).skip(1).enumerate() {
            let points: Vec<Point> = [&polygon[0], &pair[0], &pair[1]].map(|v| place(v.position)).to_vec();
            board.canvas.fill_polygon(&points, FillRule::NonZero, color[i % 4]);
            board.canvas.stroke_polygon(&points, &rastrum::Stroke::new(1.2), INK);
        }
        let before = vertices.map(|v| place(v.position));
        board.canvas.stroke_polygon(&before, &rastrum::Stroke::new(1.6), RED);
    }
    board.outline(&grid, &view, 2.4, BLUE);
    road(board, right)
}

fn road(board: &mut Board, rect: rastrum::Rect) -> Result<()> {
    let size = (rect.width() as u32, rect.height() as u32);
    let m = camera::perspective(1.1, size.0 as f32 / size.1 as f32, 0.05, 200.0);
    let view = camera::product(&m, &camera::look_at([0.3, 1.0, 0.0], [0.0, 0.75, -4.0], [0.0, 1.0, 0.0]));
    let mut target = stage::paper(size.0, size.1, Samples::Msaa4)?;
    target.clear_color(SKY);
    let corner =
        |x: f32, z: f32| Vertex { position: camera::transform(&view, [x, 0.0, z, 1.0]), values: [x, z, 0.0, 1.0] };
    let strip = |half: f32| {
        let [a, b, c, d] = [corner(-half, 40.0), corner(half, 40.0), corner(half, -120.0), corner(-half, -120.0)];
        [a, b, c, a, c, d]
    };
    let pipeline = stage::pipeline(size.0, size.1, State { depth: Depth::OFF, ..State::default() });
    stage::draw(&mut target, &pipeline, &strip(60.0), &|fragment| {
        let z = fragment.varyings[1];
        Some(stage::components(if (z * 0.35).rem_euclid(2.0) < 1.0 { MINT } else { super::board::GREEN }))
    });
    stage::draw(&mut target, &pipeline, &strip(1.0), &|fragment| {
        let [x, z, ..] = fragment.varyings;
        let dash = x.abs() < 0.06 && (z * 0.7).rem_euclid(2.0) < 1.0;
        Some(stage::components(if dash || (x.abs() - 0.9).abs() < 0.04 { Color::WHITE } else { GREY }))
    });
    board.picture(rect, target.to_pixmap()?);
    Ok(())
}

fn four_cases(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["ALL IN", "ALL OUT", "ONE IN: 1 TRIANGLE", "TWO IN: 2 TRIANGLES"]);
    // Inside is left of x = 0.6 · w.
    let plane = ClipPlane([-1.0, 0.0, 0.0, 0.6]);
    let cases = [
        [(-0.9, -0.6), (0.4, -0.5), (-0.2, 0.7)],
        [(0.75, -0.7), (1.6, -0.1), (0.9, 0.8)],
        [(-0.7, 0.1), (1.5, -0.7), (1.3, 0.8)],
        [(-0.8, -0.6), (-0.5, 0.8), (1.5, 0.2)],
    ];
    for (rect, corners) in panels.into_iter().zip(cases) {
        let place = |x: f32, y: f32| {
            Point::new(rect.left + (x + 1.2) / 3.0 * rect.width(), rect.top + (1.0 - y) / 2.0 * rect.height())
        };
        let inside = rastrum::Rect::from_ltrb(rect.left, rect.top, place(0.6, 0.0).x, rect.bottom);
        board.bar(inside, PALE);
        let polygon = clip_polygon(&corners.map(|(x, y)| ClipVertex::new([x, y, 0.0, 1.0], &[])), &[plane]);
        let at: Vec<Point> = polygon.iter().map(|v| place(v.position[0], v.position[1])).collect();
        board.canvas.fill_polygon(&at, FillRule::NonZero, SKY);
        for i in 2..at.len() {
            board.canvas.stroke_polygon(&[at[0], at[i - 1], at[i]], &rastrum::Stroke::new(2.0), BLUE);
        }
        board.canvas.stroke_polygon(&corners.map(|(x, y)| place(x, y)), &rastrum::Stroke::new(1.4), RED);
        board.segment(Point::new(inside.right, rect.top), Point::new(inside.right, rect.bottom), 2.5, INK);
        for p in at {
            board.canvas.fill_circle(p, 4.5, BLUE);
        }
    }
    Ok(())
}
