//! Polygons and curves.

use rastrum::raster::line::outline;
use rastrum::raster::polygon::fill_with_outline;
use rastrum::raster::triangulate::triangulate;
use rastrum::scene::{Camera, Mesh};
use rastrum::space::Fill;
use rastrum::{FillRule, IntRect, Path, Point, Result, Stroke};

use super::board::{AMBER, BLUE, Board, GREEN, GREY, Grid, INK, MINT, PALE, RED, ROSE, SKY, VIOLET};
use super::lines::filled;
use super::stage::{self, Triangle};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        39,
        "Scanline fill, even-odd",
        "Each scanline at y + ½ meets the star's edges (dots). Between the first and the second crossing is inside, between the second and the third outside; the middle of the star stays empty.",
        scanline,
    ),
    row(
        40,
        "Edge-flip fill",
        "Edge by edge, all pixels to its right are inverted (the edge just done is red). When all edges are done, the pixels are those of the scanline fill.",
        edge_flip,
    ),
    row(
        41,
        "Leftmost and rightmost pixel",
        "Walking the sides fills a table with the first (L) and the last (R) pixel of every row; the row is drawn between them.",
        leftmost,
    ),
    row(
        42,
        "Flat-bottom and flat-top triangles",
        "A horizontal cut through the middle vertex makes v4 on the long side: above it a flat-bottom triangle (blue), below it a flat-top one (green), each with two straight slopes.",
        split,
    ),
    row(
        43,
        "Outline by Bresenham, interior by scanline",
        "Dark cells are the outline's Bresenham pixels, light ones the interior. The outline reaches beyond the interior's rule, and no hole is left between them.",
        with_outline,
    ),
    row(
        13,
        "Polygons to triangles",
        "A concave outline of 12 corners as 10 triangles, each in its colour, together exactly the polygon's pixels.",
        to_triangles,
    ),
    row(
        14,
        "Curves to segments, surfaces to triangles",
        "The same curve as 2, 4 and 8 segments; and a ball of triangles. Twice the pieces, a quarter of the error.",
        to_segments,
    ),
];

fn star() -> Vec<Point> {
    // A pentagram around (13, 9).
    [(13.0, 0.8), (17.9, 16.2), (5.0, 6.6), (21.0, 6.6), (8.1, 16.2)].map(|(x, y)| Point::new(x, y)).to_vec()
}

fn corners(points: &[Point]) -> Vec<(f32, f32)> {
    points.iter().map(|p| (p.x, p.y)).collect()
}

fn scanline(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let star = star();
    let grid = board.pixels(whole, (27, 17), filled(&star, 27, 17), SKY);
    board.outline(&grid, &corners(&star), 1.6, INK);
    for y in [4, 8, 12] {
        let at = y as f32 + 0.5;
        board.segment(grid.map(0.0, at), grid.map(27.0, at), 1.4, RED);
        for x in crossings(&star, at) {
            board.dot(&grid, x, at, 4.5, RED);
        }
    }
    Ok(())
}

/// Where a horizontal line meets a polygon's edges, from left to right.
fn crossings(points: &[Point], y: f32) -> Vec<f32> {
    let mut out: Vec<f32> = edges(points).filter_map(|(a, b)| crossing(a, b, y)).collect();
    out.sort_by(f32::total_cmp);
    out
}

fn edges(points: &[Point]) -> impl Iterator<Item = (Point, Point)> + '_ {
    points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| (*a, *b))
}

fn crossing(a: Point, b: Point, y: f32) -> Option<f32> {
    ((a.y <= y) != (b.y <= y)).then(|| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
}

fn edge_flip(board: &mut Board) -> Result<()> {
    let shape: Vec<Point> =
        [(2.2, 8.1), (9.5, 1.3), (13.2, 4.9), (11.4, 11.6), (6.0, 7.4)].map(|(x, y)| Point::new(x, y)).to_vec();
    let panels = board.tiles(3, &["EDGE 1", "EDGE 2", "EDGE 3", "EDGE 4", "EDGE 5", "DONE"]);
    let mut lit = [[false; 16]; 13];
    let edges: Vec<_> = edges(&shape).collect();
    for (i, panel) in panels.into_iter().enumerate() {
        if let Some((a, b)) = edges.get(i) {
            for (y, line) in lit.iter_mut().enumerate() {
                if let Some(x) = crossing(*a, *b, y as f32 + 0.5) {
                    line.iter_mut().enumerate().filter(|(i, _)| *i as f32 + 0.5 >= x).for_each(|(_, on)| *on = !*on);
                }
            }
        }
        let on = lit.iter().enumerate().flat_map(|(y, line)| {
            line.iter().enumerate().filter(|(_, on)| **on).map(move |(x, _)| (x as i32, y as i32))
        });
        let grid = board.pixels(panel, (16, 13), on, SKY);
        board.outline(&grid, &corners(&shape), 1.3, INK);
        if let Some((a, b)) = edges.get(i) {
            board.segment(grid.map(a.x, a.y), grid.map(b.x, b.y), 3.0, RED);
        }
    }
    Ok(())
}

const TRIANGLE: Triangle = [(4.3, 1.4), (23.6, 8.2), (10.4, 15.3)];

fn of(triangle: Triangle) -> Vec<Point> {
    triangle.map(|(x, y)| Point::new(x, y)).to_vec()
}

fn leftmost(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let pixels = filled(&of(TRIANGLE), 27, 17);
    let grid = board.grid(whole, 27, 17);
    board.cells(&grid, pixels.iter().copied(), PALE);
    let mut ends = Vec::new();
    for y in 0..17 {
        let line = || pixels.iter().filter(|p| p.1 == y).map(|p| p.0);
        if let (Some(left), Some(right)) = (line().min(), line().max()) {
            ends.push((left, right, y));
        }
    }
    for (left, right, y) in &ends {
        board.cell(&grid, (*right, *y), ROSE);
        board.cell(&grid, (*left, *y), SKY);
    }
    board.lines(&grid);
    board.outline(&grid, &TRIANGLE, 1.6, INK);
    for (left, right, y) in ends {
        board.mark(&grid, (left, y), "L", BLUE);
        if right > left {
            board.mark(&grid, (right, y), "R", RED);
        }
    }
    Ok(())
}

fn split(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let [a, b, c] = TRIANGLE;
    let v4 = (a.0 + (c.0 - a.0) * (b.1 - a.1) / (c.1 - a.1), b.1);
    let grid = board.grid(whole, 27, 17);
    board.cells(&grid, filled(&of([a, b, v4]), 27, 17), SKY);
    board.cells(&grid, filled(&of([v4, b, c]), 27, 17), MINT);
    board.lines(&grid);
    board.outline(&grid, &TRIANGLE, 1.6, INK);
    board.segment(grid.map(v4.0, v4.1), grid.map(b.0, b.1), 1.8, RED);
    board.dot(&grid, v4.0, v4.1, 5.0, RED);
    for (i, (x, y)) in
        [(a.0 - 1.0, a.1), (b.0 + 1.0, b.1), (c.0 - 1.1, c.1), (v4.0 - 1.1, v4.1)].into_iter().enumerate()
    {
        board.middle(grid.map(x, y), 13.0, &format!("V{}", i + 1), if i == 3 { RED } else { INK });
    }
    Ok(())
}

fn with_outline(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let shape = [(3, 13), (7, 2), (13, 9), (19, 1), (23, 12), (14, 15)];
    let grid = board.grid(whole, 27, 17);
    fill_with_outline(&shape, FillRule::EvenOdd, IntRect::from_xywh(0, 0, 27, 17), |y, span| {
        board.cells(&grid, span.map(|x| (x, y)), SKY);
    });
    board.cells(&grid, outline(&shape), BLUE);
    board.lines(&grid);
    let centers: Vec<_> = shape.iter().map(|(x, y)| (*x as f32 + 0.5, *y as f32 + 0.5)).collect();
    board.outline(&grid, &centers, 1.5, INK);
    Ok(())
}

fn to_triangles(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let shape: Vec<Point> = [
        (2.5, 2.0),
        (9.0, 5.5),
        (12.0, 1.5),
        (15.5, 6.0),
        (24.0, 2.5),
        (20.0, 8.0),
        (25.0, 14.0),
        (17.0, 12.0),
        (13.5, 16.0),
        (10.0, 11.0),
        (3.5, 15.0),
        (6.0, 8.5),
    ]
    .map(|(x, y)| Point::new(x, y))
    .to_vec();
    let grid = board.grid(whole, 27, 17);
    let colors = [SKY, MINT, ROSE, AMBER, VIOLET];
    let triangles: Vec<Vec<Point>> = triangulate(&shape)
        .into_iter()
        .map(|t| t.iter().filter_map(|i| shape.get(*i as usize).copied()).collect())
        .collect();
    for (i, triangle) in triangles.iter().enumerate() {
        board.cells(&grid, filled(triangle, 27, 17), super::board::mix(colors[i % 5], rastrum::Color::WHITE, 0.25));
    }
    board.lines(&grid);
    for triangle in &triangles {
        board.outline(&grid, &corners(triangle), 1.2, GREY);
    }
    board.outline(&grid, &corners(&shape), 2.2, INK);
    Ok(())
}

fn to_segments(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["2, 4, 8 SEGMENTS", "A BALL OF TRIANGLES"]);
    let [a, b, c, d] = [(0.05, 0.9), (0.1, -0.5), (0.95, 1.3), (0.95, 0.1)];
    for (i, (pieces, color)) in [(2, RED), (4, AMBER), (8, GREEN)].into_iter().enumerate() {
        let top = left.top + i as f32 * left.height() / 3.0;
        let place = |(x, y): (f32, f32)| {
            Point::new(left.left + x * left.width(), top + (y * 0.72 + 0.12) * left.height() / 3.0)
        };
        let mut path = Path::new();
        path.move_to(place(a)).cubic_to(place(b), place(c), place(d));
        board.canvas.stroke_path(&path, &Stroke::new(5.0), SKY);
        let points: Vec<Point> = (0..=pieces)
            .map(|i| {
                let t = i as f32 / pieces as f32;
                let s = 1.0 - t;
                let (p, q, r, w) = (s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t);
                place((p * a.0 + q * b.0 + r * c.0 + w * d.0, p * a.1 + q * b.1 + r * c.1 + w * d.1))
            })
            .collect();
        board.polyline(&points, 2.0, color);
        for p in points {
            board.canvas.fill_circle(p, 3.6, color);
        }
    }
    let scene = stage::scene(vec![(Mesh::sphere(1.0, 18, 10, 0), stage::matte(BLUE), stage::at(0.0, 0.0, 0.0))]);
    let camera = Camera::look_at([0.4, 0.9, 2.1], [0.0; 3], [0.0, 1.0, 0.0]);
    let size = (right.width() as u32, right.height() as u32);
    let settings = rastrum::scene::SceneSettings {
        fill: Fill::Wireframe,
        shading: Some(rastrum::scene::Shading::Unlit),
        cull: Some(rastrum::space::Cull::Back),
        antialias: rastrum::scene::SceneAntialias::Supersample(2),
        ..stage::settings()
    };
    let (picture, _) = stage::view(&scene, &camera, size, &settings)?;
    let _: Grid = board.picture(right, picture);
    Ok(())
}
