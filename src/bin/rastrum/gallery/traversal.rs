//! In which order pixels are looked at.

use rastrum::space::State;
use rastrum::{Color, Result};

use super::board::{AMBER, BLUE, Board, GREY, INK, MINT, PALE, RED, ROSE, SKY, mix};
use super::stage::{self, Triangle};
use super::triangles::{edge, inside, middle, oriented, sides, snap, top_left};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        53,
        "Visit every pixel",
        "The plain way, and the judge of the others: every pixel of the picture is tested, in reading order. Numbers are the order of visits, blue the pixels inside.",
        every,
    ),
    row(
        54,
        "Bounding box",
        "Only the box of the corners is visited (numbered), still in reading order. Grey pixels were tested for nothing.",
        bounding_box,
    ),
    row(
        55,
        "Backtrack",
        "Each row starts where the one above did and steps back to the left until it is outside. Almost nothing left of the triangle is visited.",
        backtrack,
    ),
    row(
        56,
        "Zigzag",
        "Rows by turns from left to right and from right to left: no way back at the end of a row.",
        zigzag,
    ),
    row(
        57,
        "Tiles",
        "4 × 4 tiles that meet the triangle, numbered in their order, pixels inside each tile in reading order. Pale tiles were rejected whole.",
        tiled,
    ),
    row(
        58,
        "Pineda's walk",
        "One edge function, evaluated once, then by increments alone: a for each step to the right, b for each step down. Numbers are its value in pixels².",
        pineda,
    ),
    row(
        59,
        "Tile against triangle",
        "For each edge the tile's corner farthest inside (dot) is tested. Outside of one edge: rejected (pale). Green tiles lie inside of all edges, amber ones are cut.",
        overlap,
    ),
    row(
        64,
        "Conservative rasterization",
        "Blue: pixels whose centre is inside. Amber: pixels that the triangle touches anywhere, which conservative rasterization adds.",
        conservative,
    ),
];

const COLUMNS: i32 = 18;
const ROWS_OF_GRID: i32 = 11;
const T: Triangle = [(3.7, 1.2), (15.4, 4.6), (6.2, 9.7)];

type Pixel = (i32, i32);

/// Columns and rows of the box, first and last.
fn bounds() -> (i32, i32, i32, i32) {
    let (xs, ys) = (T.map(|p| p.0.floor() as i32), T.map(|p| p.1.floor() as i32));
    let least = |v: [i32; 3]| v[0].min(v[1]).min(v[2]);
    let most = |v: [i32; 3]| v[0].max(v[1]).max(v[2]);
    (least(xs), most(xs), least(ys), most(ys))
}

fn hit(pixel: Pixel) -> bool {
    inside(snap(T), middle(pixel), top_left)
}

/// Visits in their order, on the triangle.
fn walk(board: &mut Board, visited: &[Pixel]) {
    let whole = board.whole();
    let grid = board.grid(whole, COLUMNS as u32, ROWS_OF_GRID as u32);
    for pixel in visited {
        board.cell(&grid, *pixel, if hit(*pixel) { SKY } else { PALE });
    }
    board.lines(&grid);
    for pair in visited.windows(2) {
        let at = |p: Pixel| grid.map(p.0 as f32 + 0.5, p.1 as f32 + 0.5);
        let near = (pair[0].0 - pair[1].0).abs() + (pair[0].1 - pair[1].1).abs() <= 1;
        if near {
            board.segment(at(pair[0]), at(pair[1]), 1.2, mix(AMBER, Color::WHITE, 0.3));
        }
    }
    board.outline(&grid, &T, 1.6, BLUE);
    board.order(&grid, visited, INK);
}

fn every(board: &mut Board) -> Result<()> {
    let all: Vec<Pixel> = (0..ROWS_OF_GRID).flat_map(|y| (0..COLUMNS).map(move |x| (x, y))).collect();
    walk(board, &all);
    Ok(())
}

fn bounding_box(board: &mut Board) -> Result<()> {
    let (x0, x1, y0, y1) = bounds();
    let all: Vec<Pixel> = (y0..=y1).flat_map(|y| (x0..=x1).map(move |x| (x, y))).collect();
    walk(board, &all);
    Ok(())
}

/// Whether a pixel lies beyond an edge on the left (one that goes up), or on the right.
fn beyond(pixel: Pixel, left: bool) -> bool {
    sides(oriented(snap(T)))
        .iter()
        .any(|(p, q)| (if left { q.1 < p.1 } else { q.1 > p.1 }) && edge(*p, *q, middle(pixel)) < 0)
}

fn backtrack(board: &mut Board) -> Result<()> {
    let (x0, x1, y0, y1) = bounds();
    let mut visited = Vec::new();
    let mut start = x0;
    for y in y0..=y1 {
        let mut x = start;
        while x > x0 && !beyond((x, y), true) {
            x -= 1;
        }
        let mut first = None;
        while x <= x1 {
            visited.push((x, y));
            if hit((x, y)) {
                first.get_or_insert(x);
            } else if beyond((x, y), false) {
                break;
            }
            x += 1;
        }
        start = first.unwrap_or(start);
    }
    walk(board, &visited);
    Ok(())
}

fn zigzag(board: &mut Board) -> Result<()> {
    let (x0, x1, y0, y1) = bounds();
    let step = |y: i32, i: i32| if (y - y0) % 2 == 0 { x0 + i } else { x1 - i };
    let all: Vec<Pixel> = (y0..=y1).flat_map(|y| (0..=x1 - x0).map(move |i| (step(y, i), y))).collect();
    walk(board, &all);
    Ok(())
}

/// Whether some part of a tile may be inside: for each edge, its corner farthest inside, and farthest outside.
fn corners_of(tile: Pixel, side: i32) -> [((f32, f32), bool, bool); 3] {
    let (left, top) = (i64::from(tile.0 * side) * 256, i64::from(tile.1 * side) * 256);
    let size = i64::from(side) * 256;
    sides(oriented(snap(T))).map(|(p, q)| {
        let normal = (p.1 - q.1, q.0 - p.0);
        let far = |inner: bool| {
            (
                if (normal.0 > 0) == inner { left + size } else { left },
                if (normal.1 > 0) == inner { top + size } else { top },
            )
        };
        let corner = far(true);
        ((corner.0 as f32 / 256.0, corner.1 as f32 / 256.0), edge(p, q, corner) >= 0, edge(p, q, far(false)) > 0)
    })
}

fn tiles() -> impl Iterator<Item = Pixel> {
    (0..3).flat_map(|y| (0..5).map(move |x| (x, y)))
}

fn tiled(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 20, 12);
    let mut visited = Vec::new();
    for tile in tiles() {
        let taken = corners_of(tile, 4).iter().all(|(_, some, _)| *some);
        for pixel in (0..4).flat_map(|y| (0..4).map(move |x| (tile.0 * 4 + x, tile.1 * 4 + y))) {
            board.cell(
                &grid,
                pixel,
                if !taken {
                    PALE
                } else if hit(pixel) {
                    SKY
                } else {
                    Color::WHITE
                },
            );
            if taken {
                visited.push(pixel);
            }
        }
    }
    board.lines(&grid);
    for (x, y) in tiles() {
        let (x, y) = (x as f32 * 4.0, y as f32 * 4.0);
        board.outline(&grid, &[(x, y), (x + 4.0, y), (x + 4.0, y + 4.0), (x, y + 4.0)], 1.6, GREY);
    }
    board.outline(&grid, &T, 1.6, BLUE);
    board.order(&grid, &visited, INK);
    Ok(())
}

fn pineda(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, COLUMNS as u32, ROWS_OF_GRID as u32);
    let (x0, x1, y0, y1) = bounds();
    let (p, q) = sides(oriented(snap(T)))[1];
    let (a, b) = ((p.1 - q.1) * 256, (q.0 - p.0) * 256);
    let mut row = edge(p, q, middle((x0, y0)));
    let mut values = Vec::new();
    for y in y0..=y1 {
        let mut value = row;
        for x in x0..=x1 {
            values.push(((x, y), value));
            value += a;
        }
        row += b;
    }
    for (pixel, value) in &values {
        board.cell(
            &grid,
            *pixel,
            if hit(*pixel) {
                SKY
            } else if *value < 0 {
                ROSE
            } else {
                PALE
            },
        );
    }
    board.lines(&grid);
    board.outline(&grid, &T, 1.6, BLUE);
    for (pixel, value) in values {
        board.mark(&grid, pixel, &((value as f32 / 65_536.0).round() as i32).to_string(), INK);
    }
    let (left, top) = (x0 as f32, y0 as f32);
    board.arrow(grid.map(left + 0.5, top - 0.35), grid.map(left + 3.5, top - 0.35), RED);
    board.middle(grid.map(left + 4.8, top - 0.4), 12.0, "+ A", RED);
    board.arrow(grid.map(left - 0.4, top + 0.5), grid.map(left - 0.4, top + 3.5), RED);
    board.middle(grid.map(left - 0.8, top + 4.1), 12.0, "+ B", RED);
    Ok(())
}

fn overlap(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 18, 12);
    let side = 2;
    for tile in (0..6).flat_map(|y| (0..9).map(move |x| (x, y))) {
        let tests = corners_of(tile, side);
        let color = if !tests.iter().all(|test| test.1) {
            PALE
        } else if tests.iter().all(|test| test.2) {
            MINT
        } else {
            mix(AMBER, Color::WHITE, 0.4)
        };
        board.cells(
            &grid,
            (0..side).flat_map(|y| (0..side).map(move |x| (tile.0 * side + x, tile.1 * side + y))),
            color,
        );
    }
    board.lines(&grid);
    board.outline(&grid, &T, 2.0, BLUE);
    for tile in (0..6).flat_map(|y| (0..9).map(move |x| (x, y))) {
        let (x, y) = (tile.0 as f32 * 2.0, tile.1 as f32 * 2.0);
        board.outline(&grid, &[(x, y), (x + 2.0, y), (x + 2.0, y + 2.0), (x, y + 2.0)], 1.4, INK);
        // The corner of the first edge that rejects, or of the first edge.
        let tests = corners_of(tile, side);
        let shown = tests.iter().find(|test| !test.1);
        if let Some(((cx, cy), ..)) = shown {
            let toward = |c: f32, middle: f32| c + (middle - c) * 0.16;
            board.dot(&grid, toward(*cx, x + 1.0), toward(*cy, y + 1.0), 4.0, RED);
        }
    }
    Ok(())
}

fn conservative(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let size = (27, 17);
    let t = [(3.3, 13.7), (22.2, 2.4), (24.6, 10.1)];
    let grid = board.grid(whole, size.0, size.1);
    board.cells(
        &grid,
        stage::covered(t, size, State { conservative: true, ..State::default() })?,
        mix(AMBER, Color::WHITE, 0.3),
    );
    board.cells(&grid, stage::covered(t, size, State::default())?, SKY);
    board.lines(&grid);
    board.centers(&grid);
    board.outline(&grid, &t, 1.8, INK);
    Ok(())
}
