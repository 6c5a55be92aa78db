//! Lines.

use rastrum::raster::line::{self, bresenham};
use rastrum::raster::polygon;
use rastrum::{FillRule, IntRect, Point, Rect, Result};

use super::board::{AMBER, BLUE, Board, GREEN, GREY, Grid, INK, MINT, RED, ROSE, SKY, VIOLET, mix};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        21,
        "Bresenham's line",
        "Left: one line in each octant, from the middle outwards. Right: where the ideal line passes exactly between two pixels, the tie goes to E, the pixel that goes straight on; both directions light the same pixels.",
        bresenham_line,
    ),
    row(
        22,
        "Bresenham, step by step",
        "The lecture's example from (20, 10) to (30, 18). The decision value under each column says whether the next pixel steps down: it does where the value is above 0.",
        worked_example,
    ),
    row(
        23,
        "Low and high slopes",
        "Two loops, one that steps along x and one that steps along y. Blue lines are flatter than 45°, red ones steeper: each has one pixel per column or per row.",
        low_high,
    ),
    row(
        24,
        "Bresenham with a float error",
        "The error that the variant with floats carries along, as bars: it grows by the slope and falls by one where the line steps down. The pixels are those of the integer form.",
        float_error,
    ),
    row(
        25,
        "y = m x + b, rounded",
        "Each column's y is computed and rounded to the nearest pixel. The rings mark ties, where rounding up (red) differs from Bresenham's choice (blue).",
        slope_intercept,
    ),
    row(
        26,
        "DDA",
        "x and y advance in equal steps; dots are the exact places, squares the pixels they are rounded to.",
        dda,
    ),
    row(
        27,
        "Midpoint line",
        "Whether the midpoint between E and SE lies above or below the line decides. Numbers are twice F at that point: above 0, the next pixel is SE.",
        midpoint,
    ),
    row(
        28,
        "The ideal line",
        "0°, 45° and 90° come out exactly, and both end points are lit at any angle: the ideal lines are drawn over their pixels.",
        ideal,
    ),
    row(
        29,
        "A line as a rectangle",
        "Pixels whose centre is inside a rectangle of width 1. Columns have one pixel or two: the uneven width is what sampling does to thin shapes.",
        rectangle,
    ),
    row(
        30,
        "Width along the grid",
        "Width counted in pixels of a column or row. All three lines count three pixels a column, but the one at 45° is thinner, by 1/√2, across its own direction.",
        grid_width,
    ),
    row(
        31,
        "A line as two triangles",
        "Blue and green are the two triangles of a thick line. No pixel of the diagonal is drawn by both, and none is left out.",
        two_triangles,
    ),
    row(
        32,
        "An attribute along a line",
        "α runs from 0 to 1 along the line: the projection of each pixel onto it. Numbers are percent.",
        attribute,
    ),
    row(
        33,
        "Linear interpolation",
        "Values between two ends: (1 − t)·a + t·b gives both ends exactly, and equal steps between.",
        interpolation,
    ),
];

fn octants() -> impl Iterator<Item = ((i32, i32), usize)> {
    [(11, 4), (4, 11), (-4, 11), (-11, 4), (-11, -4), (-4, -11), (4, -11), (11, -4)].into_iter().zip(0..)
}

/// The ideal line between two pixels' centres.
fn ideal_line(board: &mut Board, grid: &Grid, from: (i32, i32), to: (i32, i32)) {
    let at = |(x, y): (i32, i32)| grid.map(x as f32 + 0.5, y as f32 + 0.5);
    board.segment(at(from), at(to), 1.8, INK);
}

fn bresenham_line(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["EIGHT OCTANTS", "TIES GO TO E"]);
    let grid = board.grid(left, 23, 23);
    for ((x, y), i) in octants() {
        board.cells(&grid, bresenham((11, 11), (11 + x, 11 + y)), if i % 2 == 0 { SKY } else { MINT });
    }
    board.cell(&grid, (11, 11), AMBER);
    board.lines(&grid);
    for ((x, y), _) in octants() {
        ideal_line(board, &grid, (11, 11), (11 + x, 11 + y));
    }
    let grid = board.grid(right, 11, 11);
    for (from, to) in [((1, 1), (9, 5)), ((1, 9), (9, 7))] {
        board.cells(&grid, bresenham(from, to), SKY);
    }
    board.lines(&grid);
    for (from, to) in [((1, 1), (9, 5)), ((1, 9), (9, 7))] {
        ideal_line(board, &grid, from, to);
    }
    for x in [2, 4, 6, 8] {
        let y = 1.5 + (x - 1) as f32 * 0.5;
        board.dot(&grid, x as f32 + 0.5, y, 5.0, RED);
    }
    Ok(())
}

fn worked_example(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 13, 11);
    let (from, to) = ((20, 10), (30, 18));
    let mut walk = bresenham(from, to);
    let mut steps = Vec::new();
    loop {
        let decision = walk.decision();
        let Some(pixel) = walk.next() else { break };
        steps.push((pixel, decision));
    }
    let place = |(x, y): (i32, i32)| (x - 18, y - 9);
    board.cells(&grid, steps.iter().map(|(pixel, _)| place(*pixel)), SKY);
    board.lines(&grid);
    ideal_line(board, &grid, place(from), place(to));
    for x in 20..=30 {
        board.mark(&grid, (x - 18, 0), &x.to_string(), GREY);
    }
    for y in 10..=18 {
        board.mark(&grid, (0, y - 9), &y.to_string(), GREY);
    }
    for (pixel, decision) in steps.iter().take(10) {
        let (x, _) = place(*pixel);
        board.mark(&grid, (x, 10), &decision.to_string(), if *decision > 0 { RED } else { BLUE });
    }
    board.mark(&grid, (0, 10), "P", GREY);
    Ok(())
}

fn low_high(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 36, 21);
    let from = (1, 1);
    for to in [(34, 1), (34, 7), (34, 14), (21, 19), (12, 19), (5, 19), (1, 19)] {
        let low = (to.0 - from.0) > (to.1 - from.1);
        board.cells(&grid, bresenham(from, to), if low { SKY } else { ROSE });
    }
    board.lines(&grid);
    for to in [(34, 1), (34, 7), (34, 14), (21, 19), (12, 19), (5, 19), (1, 19)] {
        ideal_line(board, &grid, from, to);
    }
    let at = grid.map(23.5, 16.5);
    board.label(at.x, at.y, 12.0, "LOW: X STEPS", BLUE);
    board.label(at.x, at.y + 24.0, 12.0, "HIGH: Y STEPS", RED);
    Ok(())
}

fn float_error(board: &mut Board) -> Result<()> {
    let rect = Rect::from_xywh(16.0, 14.0, 608.0, 205.0);
    let (from, to) = ((0, 1), (18, 6));
    let grid = board.pixels(rect, (19, 8), bresenham(from, to), SKY);
    ideal_line(board, &grid, from, to);
    let base = 330.0;
    let slope = 5.0 / 18.0_f32;
    let mut error = 0.0_f32;
    board.segment(Point::new(grid.left, base), Point::new(grid.rect().right, base), 1.5, INK);
    board.segment(Point::new(grid.left, base - 45.0), Point::new(grid.rect().right, base - 45.0), 1.0, RED);
    for x in 0..19 {
        let p = grid.map(x as f32, 0.0);
        let height = error * 90.0;
        let bar = Rect::from_xywh(p.x + 4.0, base, grid.cell - 8.0, -height).normalized();
        board.bar(bar, if error > 0.0 { BLUE } else { VIOLET });
        error += slope;
        if error > 0.5 {
            error -= 1.0;
        }
    }
    board.label(grid.left, base - 66.0, 11.0, "ERROR, STEP DOWN ABOVE 1/2", RED);
    Ok(())
}

fn slope_intercept(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 19, 11);
    let (from, to) = ((1, 1), (17, 9));
    let exact = |x: i32| 1.0 + (x - 1) as f32 * 0.5;
    board.cells(&grid, (1..=17).map(|x| (x, exact(x).round() as i32)), ROSE);
    board.cells(&grid, bresenham(from, to), SKY);
    board.lines(&grid);
    ideal_line(board, &grid, from, to);
    for x in (2..17).step_by(2) {
        let p = grid.map(x as f32 + 0.5, exact(x) + 0.5);
        board.canvas.stroke_circle(p, 7.0, &rastrum::Stroke::new(2.0), RED);
    }
    Ok(())
}

fn dda(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 19, 11);
    let places: Vec<(f32, f32)> = (0..=16).map(|i| (1.0 + i as f32, 1.0 + i as f32 * 7.0 / 16.0)).collect();
    board.cells(&grid, places.iter().map(|(x, y)| (x.round() as i32, y.round() as i32)), MINT);
    board.lines(&grid);
    board.segment(grid.map(1.5, 1.5), grid.map(17.5, 8.5), 1.4, INK);
    for (x, y) in places {
        board.dot(&grid, x + 0.5, y + 0.5, 4.0, RED);
    }
    Ok(())
}

fn midpoint(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let (dx, dy) = (12, 5);
    let grid = board.pixels(whole, (14, 8), bresenham((1, 1), (1 + dx, 1 + dy)), SKY);
    ideal_line(board, &grid, (1, 1), (1 + dx, 1 + dy));
    let mut y = 0;
    for x in 0..dx {
        let value = 2 * dy * (x + 1) - dx * (2 * y + 1);
        let color = if value > 0 { RED } else { BLUE };
        board.dot(&grid, x as f32 + 2.5, y as f32 + 2.0, 4.0, color);
        let at = grid.map(x as f32 + 2.5, y as f32 + 2.0);
        board.middle(Point::new(at.x, at.y - 14.0), 11.0, &value.to_string(), INK);
        if value > 0 {
            y += 1;
        }
    }
    Ok(())
}

fn ideal(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 31, 19);
    let lines = [((1, 17), (29, 17)), ((1, 17), (1, 1)), ((1, 17), (17, 1)), ((1, 17), (29, 9)), ((1, 17), (8, 1))];
    for (i, (from, to)) in lines.iter().enumerate() {
        board.cells(&grid, bresenham(*from, *to), if i < 3 { MINT } else { SKY });
        board.cell(&grid, *to, AMBER);
    }
    board.cell(&grid, (1, 17), AMBER);
    board.lines(&grid);
    for (from, to) in lines {
        ideal_line(board, &grid, from, to);
    }
    Ok(())
}

/// Spans of a polygon as pixels.
pub(super) fn filled(points: &[Point], columns: u32, rows: u32) -> Vec<(i32, i32)> {
    let mut pixels = Vec::new();
    polygon::fill(points, FillRule::EvenOdd, IntRect::from_xywh(0, 0, columns, rows), |y, span| {
        pixels.extend(span.map(|x| (x, y)));
    });
    pixels
}

/// The corners of a line of some width.
fn band(from: (f32, f32), to: (f32, f32), width: f32) -> [(f32, f32); 4] {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let length = (dx * dx + dy * dy).sqrt();
    let (nx, ny) = (-dy / length * width / 2.0, dx / length * width / 2.0);
    [(from.0 + nx, from.1 + ny), (to.0 + nx, to.1 + ny), (to.0 - nx, to.1 - ny), (from.0 - nx, from.1 - ny)]
}

fn points(corners: &[(f32, f32)]) -> Vec<Point> {
    corners.iter().map(|(x, y)| Point::new(*x, *y)).collect()
}

fn rectangle(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 26, 15);
    let corners = [band((1.5, 2.5), (24.5, 6.0), 1.0), band((2.0, 5.6), (24.0, 13.3), 1.0)];
    for corners in corners {
        let pixels = filled(&points(&corners), 26, 15);
        for pixel in &pixels {
            let twice = pixels.iter().filter(|other| other.0 == pixel.0).count() > 1;
            board.cell(&grid, *pixel, if twice { ROSE } else { SKY });
        }
    }
    board.lines(&grid);
    board.centers(&grid);
    for corners in corners {
        board.outline(&grid, &corners, 1.8, INK);
    }
    Ok(())
}

fn grid_width(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 32, 19);
    let lines = [((2, 3), (28, 3)), ((2, 7), (13, 17)), ((14, 7), (29, 14))];
    for ((from, to), color) in lines.into_iter().zip([MINT, ROSE, SKY]) {
        board.cells(&grid, line::wide(from, to, 3), color);
    }
    board.lines(&grid);
    for (from, to) in lines {
        ideal_line(board, &grid, from, to);
    }
    Ok(())
}

fn two_triangles(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 26, 15);
    let [a, b, c, d] = band((3.0, 3.5), (23.0, 11.5), 4.4);
    let first = filled(&points(&[a, b, c]), 26, 15);
    let second = filled(&points(&[a, c, d]), 26, 15);
    for pixel in &first {
        board.cell(&grid, *pixel, if second.contains(pixel) { RED } else { SKY });
    }
    board.cells(&grid, second.into_iter().filter(|pixel| !first.contains(pixel)), MINT);
    board.lines(&grid);
    board.centers(&grid);
    board.outline(&grid, &[a, b, c], 1.8, BLUE);
    board.outline(&grid, &[a, c, d], 1.8, GREEN);
    Ok(())
}

fn attribute(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 15, 9);
    let (from, to) = ((1, 1), (13, 7));
    let pixels: Vec<_> = bresenham(from, to).collect();
    for pixel in &pixels {
        board.cell(&grid, *pixel, mix(SKY, ROSE, line::parameter(from, to, *pixel)));
    }
    board.lines(&grid);
    for pixel in pixels {
        let percent = (line::parameter(from, to, pixel) * 100.0).round() as i32;
        board.mark(&grid, pixel, &percent.to_string(), INK);
    }
    Ok(())
}

fn interpolation(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let axes = board.axes(whole, (-0.08, 1.08), (0.0, 10.0), ("T", "VALUE"));
    let value = |t: f32| line::interpolate(2.0, 9.0, t);
    board.curve(&axes, [(0.0, value(0.0)), (1.0, value(1.0))], BLUE);
    for i in 0..=8 {
        let t = i as f32 / 8.0;
        let p = axes.map(t, value(t));
        board.canvas.fill_circle(p, if i % 8 == 0 { 8.0 } else { 5.0 }, if i % 8 == 0 { RED } else { BLUE });
        board.middle(Point::new(p.x, p.y - 20.0), 11.0, &format!("{:.2}", value(t)), INK);
    }
    let a = axes.map(0.0, 2.0);
    let b = axes.map(1.0, 9.0);
    board.label(a.x - 6.0, a.y + 16.0, 13.0, "A", RED);
    board.label(b.x - 6.0, b.y + 16.0, 13.0, "B", RED);
    Ok(())
}
