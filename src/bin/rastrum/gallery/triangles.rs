//! Which pixels are a triangle's.

use rastrum::space::{Blend, Depth, Samples, State};
use rastrum::{Color, FillRule, Point, Rect, Result};

use super::board::{AMBER, BLUE, Board, GREEN, GREY, Grid, INK, MINT, PALE, RED, ROSE, SKY, VIOLET, mix};
use super::stage::{self, Triangle};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        44,
        "Why triangles",
        "Every place in a triangle is one mixture of its corners (left). Four corners can be joined along either diagonal, and mean two surfaces (middle). Without area nothing is drawn (right).",
        why,
    ),
    row(
        45,
        "Sampled at the centre",
        "The triangle (0, 0), (1, 0), (0, 1) meets the centre of pixel 0 with its long side only: the tie rule decides. Its other half owns the pixel's centre or not, never both.",
        center,
    ),
    row(
        46,
        "Fixed-point positions",
        "Corners are rounded to a grid inside the pixel: 4 steps a pixel on the left, 256 on the right. The coarse grid moves the corners (red to blue), and a pixel changes.",
        fixed_point,
    ),
    row(
        47,
        "Edge functions",
        "The value of one edge function at every centre, in units of pixels²: 0 on the edge's line, positive on the inner side, twice the area at the corner across.",
        edge_functions,
    ),
    row(
        48,
        "Inside: all positive",
        "How many of the three edge functions are positive: each alone is a half-plane, and where all three are (green) lies the triangle.",
        all_positive,
    ),
    row(
        49,
        "Three cross products",
        "From each corner along its side, and to the point: the turn is the same way round three times for the inner point (green), not for the outer one (red).",
        cross_products,
    ),
    row(
        50,
        "McCool's tie rule",
        "For an edge a·x + b·y + c the signs of a and b decide whether points on it belong (green). With y down these are the edges on the left and on top.",
        tie_rule,
    ),
    row(
        51,
        "Shared edges exactly once",
        "A fan whose edges pass through many pixel centres, each triangle in its colour. Every pixel is drawn once: the counts at the centres are all 1.",
        shared_edges,
    ),
    row(
        52,
        "Ties by an off-screen point",
        "The other rule: an edge owns its points if a far point lies on its inner side. Left top-left, right off-screen; outlined pixels went to the other neighbour, still exactly one.",
        off_screen,
    ),
];

/// Places in 1/256 pixels.
type Place = (i64, i64);

pub(super) fn snap(t: Triangle) -> [Place; 3] {
    t.map(|(x, y)| ((x * 256.0).round() as i64, (y * 256.0).round() as i64))
}

/// The edge function, positive to the right of p → q with y down.
pub(super) fn edge(p: Place, q: Place, r: Place) -> i64 {
    (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0)
}

pub(super) fn middle((x, y): (i32, i32)) -> Place {
    (i64::from(x) * 256 + 128, i64::from(y) * 256 + 128)
}

/// Clockwise on the screen.
pub(super) fn oriented([a, b, c]: [Place; 3]) -> [Place; 3] {
    if edge(a, b, c) < 0 { [a, c, b] } else { [a, b, c] }
}

pub(super) fn sides([a, b, c]: [Place; 3]) -> [(Place, Place); 3] {
    [(a, b), (b, c), (c, a)]
}

pub(super) fn top_left(p: Place, q: Place) -> bool {
    q.1 < p.1 || (q.1 == p.1 && q.0 > p.0)
}

pub(super) fn inside(t: [Place; 3], at: Place, owns: impl Fn(Place, Place) -> bool) -> bool {
    sides(oriented(t)).iter().all(|(p, q)| {
        let e = edge(*p, *q, at);
        e > 0 || (e == 0 && owns(*p, *q))
    })
}

fn why(board: &mut Board) -> Result<()> {
    let [left, right, none] = board.panels(["ONE MIXTURE", "TWO SURFACES", "NO AREA"]);
    let size = (16, 16);
    let mut vertices = stage::flat([(1.5, 14.5), (7.0, 1.0), (15.0, 12.0)], 0.5, RED, size);
    for (vertex, color) in vertices.iter_mut().zip([RED, GREEN, BLUE]) {
        vertex.values = stage::components(color);
    }
    board.zoomed(left, stage::picture(&vertices, size, Samples::One, State::default())?);
    for (i, top) in [right.top, right.top + right.height() / 2.0].into_iter().enumerate() {
        let rect = Rect::from_xywh(right.left, top, right.width(), right.height() / 2.0 - 8.0);
        let place = |x: f32, y: f32| Point::new(rect.left + x * rect.width(), rect.top + y * rect.height());
        let corners = [place(0.1, 0.75), place(0.45, 0.2), place(0.95, 0.3), place(0.6, 0.95)];
        let halves = if i == 0 { [[0, 1, 2], [0, 2, 3]] } else { [[0, 1, 3], [1, 2, 3]] };
        for (half, color) in halves.into_iter().zip(if i == 0 { [SKY, BLUE] } else { [MINT, GREEN] }) {
            board.canvas.fill_polygon(
                &half.map(|k: usize| corners[k]),
                FillRule::NonZero,
                mix(color, Color::WHITE, 0.3),
            );
        }
        board.canvas.stroke_polygon(&corners, &rastrum::Stroke::new(2.0), INK);
        let [a, b] = if i == 0 { [0, 2] } else { [1, 3] };
        board.segment(corners[a], corners[b], 2.0, RED);
    }
    let flat = [(2.0, 3.0), (8.0, 8.0), (14.0, 13.0)];
    let grid = board.pixels(none, size, stage::covered(flat, size, State::default())?, RED);
    board.outline(&grid, &flat, 1.6, INK);
    for (x, y) in flat {
        board.dot(&grid, x, y, 4.0, INK);
    }
    Ok(())
}

fn center(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["UPPER LEFT HALF", "LOWER RIGHT HALF"]);
    for (rect, t) in [(left, [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]), (right, [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])] {
        let hit = stage::covered(t, (4, 4), State::default())?;
        let grid = board.grid(Rect { bottom: rect.bottom - 30.0, ..rect }, 3, 3);
        // A border of one pixel around pixel 0.
        let moved: Vec<(i32, i32)> = hit.iter().map(|(x, y)| (x + 1, y + 1)).collect();
        board.cells(&grid, moved.iter().copied(), SKY);
        board.lines(&grid);
        board.outline(&grid, &t.map(|(x, y)| (x + 1.0, y + 1.0)), 2.5, RED);
        board.centers(&grid);
        board.dot(&grid, 1.5, 1.5, 5.0, INK);
        let text = if moved.is_empty() { "NOT DRAWN" } else { "DRAWN" };
        board.middle(Point::new(rect.center().x, rect.bottom - 12.0), 13.0, text, INK);
    }
    Ok(())
}

fn fixed_point(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["2 BITS", "8 BITS"]);
    let t = [(0.62, 4.36), (3.9, 0.61), (5.42, 4.88)];
    for (rect, bits) in [(left, 2_u32), (right, 8)] {
        let state = State { subpixel_bits: bits, ..State::default() };
        let grid = board.grid(rect, 6, 6);
        board.cells(&grid, stage::covered(t, (6, 6), state)?, SKY);
        if bits == 2 {
            for i in 0..=24 {
                let v = i as f32 / 4.0;
                board.segment(grid.map(v, 0.0), grid.map(v, 6.0), 0.5, ROSE);
                board.segment(grid.map(0.0, v), grid.map(6.0, v), 0.5, ROSE);
            }
        }
        board.lines(&grid);
        board.centers(&grid);
        let steps = (1_u32 << bits) as f32;
        let snapped = t.map(|(x, y)| ((x * steps).round() / steps, (y * steps).round() / steps));
        board.outline(&grid, &t, 1.5, RED);
        board.outline(&grid, &snapped, 2.0, BLUE);
        for ((x, y), (sx, sy)) in t.into_iter().zip(snapped) {
            board.dot(&grid, x, y, 4.0, RED);
            board.dot(&grid, sx, sy, 4.0, BLUE);
        }
    }
    Ok(())
}

const SMALL: Triangle = [(1.5, 7.5), (5.5, 0.5), (11.5, 6.5)];

fn edge_functions(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 14, 9);
    let [a, b, c] = snap(SMALL);
    let value = |at| edge(a, b, at) as f32 / 65_536.0;
    let top = value(c);
    for (x, y) in (0..9).flat_map(|y| (0..14).map(move |x| (x, y))) {
        let v = value(middle((x, y)));
        let color = if v > 0.0 { mix(Color::WHITE, SKY, v / top) } else { mix(Color::WHITE, ROSE, -v / top) };
        board.cell(&grid, (x, y), color);
    }
    board.lines(&grid);
    board.outline(&grid, &SMALL, 1.4, GREY);
    board.segment(grid.map(SMALL[0].0, SMALL[0].1), grid.map(SMALL[1].0, SMALL[1].1), 3.0, RED);
    for (x, y) in (0..9).flat_map(|y| (0..14).map(move |x| (x, y))) {
        let v = value(middle((x, y))).round() as i32;
        board.mark(&grid, (x, y), &v.to_string(), if v == 0 { RED } else { INK });
    }
    Ok(())
}

fn all_positive(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let grid = board.grid(whole, 28, 18);
    let t = [(5.0, 14.6), (11.6, 2.2), (23.4, 12.3)];
    let corners = oriented(snap(t));
    for at in (0..18).flat_map(|y| (0..28).map(move |x| (x, y))) {
        let positive = sides(corners).iter().filter(|(p, q)| edge(*p, *q, middle(at)) > 0).count();
        board.cell(&grid, at, [ROSE, PALE, mix(SKY, Color::WHITE, 0.4), GREEN][positive]);
    }
    board.lines(&grid);
    for i in 0..3 {
        let (p, q) = (t[i], t[(i + 1) % 3]);
        let (dx, dy) = (q.0 - p.0, q.1 - p.1);
        // The edge's whole line, as far as the grid goes.
        let reach = |s: f32| (p.0 + dx * s, p.1 + dy * s);
        let ends: Vec<(f32, f32)> = (-300..=300)
            .map(|i| reach(i as f32 / 100.0))
            .filter(|(x, y)| (0.0..=28.0).contains(x) && (0.0..=18.0).contains(y))
            .collect();
        if let (Some(first), Some(last)) = (ends.first(), ends.last()) {
            board.segment(grid.map(first.0, first.1), grid.map(last.0, last.1), 1.6, INK);
        }
    }
    for (x, y, n) in
        [(13.5, 9.5, "3"), (3.5, 3.5, "2"), (14.5, 16.5, "2"), (24.5, 4.5, "2"), (11.5, 0.9, "1"), (1.5, 17.0, "1")]
    {
        board.middle(grid.map(x, y), 16.0, n, INK);
    }
    Ok(())
}

fn cross_products(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["INSIDE", "OUTSIDE"]);
    let t = [(1.0, 8.0), (4.5, 1.0), (9.0, 7.0)];
    for (rect, at) in [(left, (4.8, 5.4)), (right, (7.8, 2.4))] {
        let grid = board.grid(rect, 10, 10);
        board.outline(&grid, &t, 2.0, GREY);
        for i in 0..3 {
            let (p, q) = (t[i], t[(i + 1) % 3]);
            let cross = (q.0 - p.0) * (at.1 - p.1) - (q.1 - p.1) * (at.0 - p.0);
            let color = if cross > 0.0 { GREEN } else { RED };
            board.arrow(grid.map(p.0, p.1), grid.map(p.0 + (q.0 - p.0) * 0.5, p.1 + (q.1 - p.1) * 0.5), BLUE);
            board.arrow(grid.map(p.0, p.1), grid.map(p.0 + (at.0 - p.0) * 0.93, p.1 + (at.1 - p.1) * 0.93), color);
            let sign = if cross > 0.0 { "+" } else { "-" };
            board.middle(grid.map(p.0 + (p.0 - 4.8) * 0.12, p.1 + (p.1 - 5.3) * 0.12), 16.0, sign, color);
        }
        board.dot(&grid, at.0, at.1, 6.0, INK);
    }
    Ok(())
}

fn tie_rule(board: &mut Board) -> Result<()> {
    let grid = board.grid(Rect::from_xywh(90.0, 50.0, 460.0, 330.0), 3, 3);
    let signs = [-1_i64, 0, 1];
    for (row, a) in signs.into_iter().enumerate() {
        for (column, b) in signs.into_iter().enumerate() {
            let at = (column as i32, row as i32);
            let (cx, cy) = (column as f32 + 0.5, row as f32 + 0.5);
            let owns = a > 0 || (a == 0 && b > 0);
            board.cell(
                &grid,
                at,
                if a == 0 && b == 0 {
                    PALE
                } else if owns {
                    MINT
                } else {
                    ROSE
                },
            );
            if a == 0 && b == 0 {
                board.middle(grid.map(cx, cy), 12.0, "NO EDGE", GREY);
                continue;
            }
            // Inside is where a·x + b·y grows; the edge runs across.
            let length = ((a * a + b * b) as f32).sqrt();
            let (nx, ny) = (a as f32 / length, b as f32 / length);
            board.segment(grid.map(cx - ny * 0.36, cy + nx * 0.36), grid.map(cx + ny * 0.36, cy - nx * 0.36), 3.0, INK);
            board.arrow(grid.map(cx, cy), grid.map(cx + nx * 0.3, cy + ny * 0.3), BLUE);
            let word = if owns { "OWNS" } else { "NOT" };
            board.middle(grid.map(column as f32 + 0.2, row as f32 + 0.12), 9.0, word, INK);
        }
    }
    board.lines(&grid);
    for (i, sign) in ["-", "0", "+"].into_iter().enumerate() {
        board.middle(Point::new(grid.left - 40.0, grid.map(0.0, i as f32 + 0.5).y), 14.0, &format!("A {sign}"), INK);
        board.middle(Point::new(grid.map(i as f32 + 0.5, 0.0).x, grid.top - 22.0), 14.0, &format!("B {sign}"), INK);
    }
    Ok(())
}

/// A fan around a pixel's centre with edges through centres.
fn fan() -> Vec<Triangle> {
    let ring = [(0.5, 0.5), (9.5, 0.5), (18.5, 0.5), (26.5, 4.5), (26.5, 14.5), (13.5, 16.5), (0.5, 14.5), (0.5, 8.5)];
    let hub = (13.5, 8.5);
    (0..ring.len()).map(|i| [hub, ring[i], ring[(i + 1) % ring.len()]]).collect()
}

const COLORS: [Color; 8] = [SKY, MINT, ROSE, AMBER, SKY, ROSE, MINT, AMBER];

fn shared_edges(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let size = (28, 18);
    let grid = board.grid(whole, size.0, size.1);
    let mut counts = rastrum::space::Target::new(size.0, size.1)?;
    let state = State { depth: Depth::OFF, blend: Blend::Additive, ..State::default() };
    let one = Color::from_rgba(1.0, 1.0, 1.0, 1.0 / 255.0);
    for (t, color) in fan().into_iter().zip(COLORS) {
        board.cells(&grid, stage::covered(t, size, State::default())?, color);
        stage::draw(
            &mut counts,
            &stage::pipeline(size.0, size.1, state),
            &stage::flat(t, 0.5, one, size),
            &stage::carried,
        );
    }
    board.lines(&grid);
    for t in fan() {
        board.outline(&grid, &t, 1.4, INK);
    }
    for (x, y) in (0..size.1).flat_map(|y| (0..size.0).map(move |x| (x, y))) {
        let count = counts.pixel(x, y).map_or(0, |pixel| pixel[3]);
        if count > 0 {
            board.mark(&grid, (x as i32, y as i32), &count.to_string(), if count == 1 { INK } else { RED });
        }
    }
    Ok(())
}

fn off_screen(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["TOP-LEFT", "OFF-SCREEN POINT"]);
    let far = |p: Place, q: Place| edge(p, q, (10_000_019, 7_000_003_001)) > 0;
    let owner = |at: (i32, i32), owns: &dyn Fn(Place, Place) -> bool| {
        fan().iter().position(|t| inside(snap(*t), middle(at), owns))
    };
    let mut draw = |rect: Rect, owns: &dyn Fn(Place, Place) -> bool| -> Grid {
        let grid = board.grid(rect, 28, 18);
        for at in (0..18).flat_map(|y| (0..28).map(move |x| (x, y))) {
            if let Some(i) = owner(at, owns) {
                board.cell(&grid, at, COLORS[i]);
            }
        }
        board.lines(&grid);
        for t in fan() {
            board.outline(&grid, &t, 1.0, INK);
        }
        grid
    };
    let grids = [draw(left, &top_left), draw(right, &far)];
    for at in (0..18).flat_map(|y| (0..28).map(move |x| (x, y))) {
        if owner(at, &top_left) != owner(at, &far) {
            let (x, y) = (at.0 as f32, at.1 as f32);
            for grid in &grids {
                board.outline(grid, &[(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)], 2.2, VIOLET);
            }
        }
    }
    Ok(())
}
