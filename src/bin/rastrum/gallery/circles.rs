//! Circles.

use std::collections::BTreeSet;

use rastrum::raster::circle::{circle, disc};
use rastrum::{Result, Stroke};

use super::board::{AMBER, BLUE, Board, Grid, INK, MINT, RED, ROSE, SKY, VIOLET, mix};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        34,
        "Implicit circle",
        "F(x, y) = x² + y² − r² at each pixel: negative (blue, filled) inside, positive outside. Numbers are F.",
        implicit,
    ),
    row(
        35,
        "Square-root circle",
        "y = round(√(r² − x²)) lights one pixel per column. Near the left and right ends the circle is steep and the gaps show; the midpoint circle has none.",
        square_root,
    ),
    row(
        36,
        "Eight-way symmetry",
        "One octant (numbered) is computed. Seven reflections give the rest of the circle.",
        symmetry,
    ),
    row(
        37,
        "Midpoint circle",
        "r = 8 starts from p = 1 − r; the octant's pixels are numbered in their order. It has 44 pixels in all.",
        midpoint,
    ),
    row(
        38,
        "Circle off the origin",
        "The circle is computed around (0, 0) and moved: all copies are the same set of pixels.",
        moved,
    ),
];

/// The circle's true outline.
fn ring(board: &mut Board, grid: &Grid, (x, y): (i32, i32), radius: f32) {
    let center = grid.map(x as f32 + 0.5, y as f32 + 0.5);
    board.canvas.stroke_circle(center, radius * grid.cell, &Stroke::new(1.6), INK);
}

fn implicit(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 13, 11);
    let f = |x: i32, y: i32| (x - 6) * (x - 6) + (y - 5) * (y - 5) - 20;
    for y in 0..11 {
        for x in 0..13 {
            let value = f(x, y);
            let color = if value < 0 {
                mix(SKY, BLUE, -value as f32 / 60.0)
            } else {
                mix(rastrum::Color::WHITE, ROSE, value as f32 / 60.0)
            };
            board.cell(&grid, (x, y), color);
        }
    }
    board.lines(&grid);
    for y in 0..11 {
        for x in 0..13 {
            board.mark(&grid, (x, y), &f(x, y).to_string(), INK);
        }
    }
    ring(board, &grid, (6, 5), 20.0_f32.sqrt());
    Ok(())
}

fn square_root(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["SQUARE ROOT, R = 20", "MIDPOINT, R = 20"]);
    let upper: BTreeSet<(i32, i32)> =
        (-20..=20_i32).map(|x| (x, f64::from(400 - x * x).sqrt().round() as i32)).collect();
    let all: BTreeSet<_> = upper.iter().flat_map(|(x, y)| [(22 + x, 22 + y), (22 + x, 22 - y)]).collect();
    board.pixels(left, (45, 45), all, RED);
    board.pixels(right, (45, 45), circle((22, 22), 20), BLUE);
    Ok(())
}

/// The octant from (0, −r) clockwise to the diagonal.
fn octant(radius: i32) -> Vec<(i32, i32)> {
    let mut pixels: Vec<_> = circle((0, 0), radius as u32).filter(|(x, y)| *x >= 0 && -*y >= *x).collect();
    pixels.sort_unstable();
    pixels.dedup();
    pixels
}

fn symmetry(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 23, 23);
    let first = octant(10);
    let colors = [AMBER, SKY, MINT, ROSE, SKY, MINT, ROSE, SKY];
    let images = |(x, y): (i32, i32)| [(x, y), (-y, x), (-x, -y), (y, -x), (-x, y), (-y, -x), (x, -y), (y, x)];
    for i in (0..8).rev() {
        board.cells(&grid, first.iter().map(|p| images(*p)[i]).map(|(x, y)| (x + 11, y + 11)), colors[i]);
    }
    board.lines(&grid);
    for (dx, dy) in [(11.0, 0.0), (0.0, 11.0), (8.5, 8.5), (8.5, -8.5)] {
        board.segment(grid.map(11.5 - dx, 11.5 - dy), grid.map(11.5 + dx, 11.5 + dy), 1.0, VIOLET);
    }
    let placed: Vec<_> = first.iter().map(|(x, y)| (x + 11, y + 11)).collect();
    board.order(&grid, &placed, INK);
    Ok(())
}

fn midpoint(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 19, 19);
    board.cells(&grid, circle((9, 9), 8), SKY);
    let first: Vec<_> = octant(8).iter().map(|(x, y)| (x + 9, y + 9)).collect();
    board.cells(&grid, first.iter().copied(), AMBER);
    board.lines(&grid);
    ring(board, &grid, (9, 9), 8.0);
    board.order(&grid, &first, INK);
    Ok(())
}

fn moved(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 38, 23);
    for (center, color) in [((7, 7), SKY), ((19, 14), MINT), ((30, 8), ROSE)] {
        let inside = disc(center, 5).flat_map(|(y, span)| span.map(move |x| (x, y)));
        board.cells(&grid, inside, mix(color, rastrum::Color::WHITE, 0.6));
        board.cells(&grid, circle(center, 6), color);
    }
    board.lines(&grid);
    for center in [(7, 7), (19, 14), (30, 8)] {
        board.dot(&grid, center.0 as f32 + 0.5, center.1 as f32 + 0.5, 3.5, RED);
    }
    board.arrow(grid.map(7.5, 7.5), grid.map(19.0, 14.2), INK);
    board.arrow(grid.map(19.5, 14.5), grid.map(30.0, 8.8), INK);
    Ok(())
}
