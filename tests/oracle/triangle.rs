//! The lectures' ways to rasterize a triangle, each as the lecture writes it.
//!
//! Vertices are in 1/256 of a pixel, y down; the centre of pixel (x, y) lies at (256·x + 128, 256·y + 128).

use super::Pixel;

/// A vertex in 1/256 pixels.
pub(crate) type Vertex = (i64, i64);
pub(crate) type Triangle = [Vertex; 3];

/// The edge function of p → q at r: positive to the right of it on the screen (y down).
pub(crate) fn edge(p: Vertex, q: Vertex, r: Vertex) -> i64 {
    (q.0 - p.0) * (r.1 - p.1) - (q.1 - p.1) * (r.0 - p.0)
}

pub(crate) fn center((x, y): Pixel) -> Vertex {
    (i64::from(x) * 256 + 128, i64::from(y) * 256 + 128)
}

/// The triangle clockwise on the screen, or `None` without area.
pub(crate) fn oriented([a, b, c]: Triangle) -> Option<Triangle> {
    match edge(a, b, c) {
        0 => None,
        area if area > 0 => Some([a, b, c]),
        _ => Some([a, c, b]),
    }
}

pub(crate) fn sides([a, b, c]: Triangle) -> [(Vertex, Vertex); 3] {
    [(a, b), (b, c), (c, a)]
}

/// The top-left rule: an edge that goes up, or level to the right, owns the points on it.
pub(crate) fn top_left(p: Vertex, q: Vertex) -> bool {
    q.1 < p.1 || (q.1 == p.1 && q.0 > p.0)
}

/// McCool's rule on an edge a·x + b·y + c: owns its points if a > 0, or a = 0 and b > 0.
pub(crate) fn mccool(a: i64, b: i64) -> bool {
    a > 0 || (a == 0 && b > 0)
}

/// Whether a point is inside, points on an edge by `owns`.
pub(crate) fn inside(triangle: Triangle, at: Vertex, owns: impl Fn(Vertex, Vertex) -> bool) -> bool {
    oriented(triangle).is_some_and(|triangle| {
        sides(triangle).iter().all(|(p, q)| {
            let e = edge(*p, *q, at);
            e > 0 || (e == 0 && owns(*p, *q))
        })
    })
}

/// Whether the pixel's centre is inside, by the top-left rule.
pub(crate) fn covers(triangle: Triangle, pixel: Pixel) -> bool {
    inside(triangle, center(pixel), top_left)
}

/// The alternative tie rule: an edge owns its points if a point far off the screen, in general position, is on its inner side.
pub(crate) fn off_screen(p: Vertex, q: Vertex) -> bool {
    edge(p, q, (10_000_019, 7_000_003_001)) > 0
}

/// What a traversal drew and which pixels it looked at, in order.
#[derive(Default)]
pub(crate) struct Walk {
    pub(crate) drawn: Vec<Pixel>,
    pub(crate) visited: Vec<Pixel>,
}

impl Walk {
    fn visit(&mut self, triangle: Triangle, pixel: Pixel) -> bool {
        self.visited.push(pixel);
        let hit = covers(triangle, pixel);
        if hit {
            self.drawn.push(pixel);
        }
        hit
    }
}

/// The pixels of the triangle's bounding box, as first and last column and row.
pub(crate) fn bounds(triangle: Triangle) -> (i32, i32, i32, i32) {
    let xs = triangle.map(|v| v.0);
    let ys = triangle.map(|v| v.1);
    let pixel = |v: i64| v.div_euclid(256) as i32;
    let (least, most) = (|v: [i64; 3]| v.into_iter().min().unwrap(), |v: [i64; 3]| v.into_iter().max().unwrap());
    (pixel(least(xs)), pixel(most(xs)), pixel(least(ys)), pixel(most(ys)))
}

/// Every pixel of a square grid.
pub(crate) fn every_pixel(triangle: Triangle, size: i32) -> Walk {
    let mut walk = Walk::default();
    for y in 0..size {
        for x in 0..size {
            walk.visit(triangle, (x, y));
        }
    }
    walk
}

pub(crate) fn bounding_box(triangle: Triangle) -> Walk {
    let (x0, x1, y0, y1) = bounds(triangle);
    let mut walk = Walk::default();
    for y in y0..=y1 {
        for x in x0..=x1 {
            walk.visit(triangle, (x, y));
        }
    }
    walk
}

/// Backtrack: in each row back to the left until outside on that side, then to the right until outside on the other; nothing left of
/// the triangle is looked at but where its side moved to the right.
pub(crate) fn backtrack(triangle: Triangle) -> Walk {
    let (x0, x1, y0, y1) = bounds(triangle);
    let mut walk = Walk::default();
    let Some(clockwise) = oriented(triangle) else { return walk };
    // Outside of an edge that bounds the triangle on the left (it goes up), or on the right.
    let beyond = |pixel: Pixel, left: bool| {
        let at = center(pixel);
        sides(clockwise).iter().any(|(p, q)| (if left { q.1 < p.1 } else { q.1 > p.1 }) && edge(*p, *q, at) < 0)
    };
    let mut start = x0;
    for y in y0..=y1 {
        let mut x = start;
        while x > x0 && !beyond((x, y), true) {
            x -= 1;
        }
        let mut first = None;
        while x <= x1 {
            if walk.visit(triangle, (x, y)) {
                first.get_or_insert(x);
            } else if beyond((x, y), false) {
                break;
            }
            x += 1;
        }
        start = first.unwrap_or(start);
    }
    walk
}

/// Zigzag: rows by turns to the right and to the left.
pub(crate) fn zigzag(triangle: Triangle) -> Walk {
    let (x0, x1, y0, y1) = bounds(triangle);
    let mut walk = Walk::default();
    for (row, y) in (y0..=y1).enumerate() {
        for i in 0..=x1 - x0 {
            let x = if row % 2 == 0 { x0 + i } else { x1 - i };
            walk.visit(triangle, (x, y));
        }
    }
    walk
}

/// Tile by tile; tiles that do not overlap the triangle are not looked into.
pub(crate) fn tiled(triangle: Triangle, tile: i32) -> Walk {
    let (x0, x1, y0, y1) = bounds(triangle);
    let mut walk = Walk::default();
    for ty in y0.div_euclid(tile)..=y1.div_euclid(tile) {
        for tx in x0.div_euclid(tile)..=x1.div_euclid(tile) {
            let (left, top) = (tx * tile, ty * tile);
            if !tile_overlaps(triangle, (left, top), tile) {
                continue;
            }
            for y in top..top + tile {
                for x in left..left + tile {
                    walk.visit(triangle, (x, y));
                }
            }
        }
    }
    walk
}

/// Haines and Wallace: a tile is rejected if, for some edge, the corner that is farthest inside is outside.
pub(crate) fn tile_overlaps(triangle: Triangle, (left, top): Pixel, tile: i32) -> bool {
    let Some(triangle) = oriented(triangle) else { return false };
    let (left, top) = (i64::from(left) * 256, i64::from(top) * 256);
    let size = i64::from(tile) * 256;
    sides(triangle).iter().all(|(p, q)| {
        let normal = (p.1 - q.1, q.0 - p.0);
        let corner = (if normal.0 > 0 { left + size } else { left }, if normal.1 > 0 { top + size } else { top });
        edge(*p, *q, corner) >= 0
    })
}

/// Pineda's walk over the box with increments alone: three values, one addition a step.
pub(crate) fn pineda(triangle: Triangle) -> Walk {
    let (x0, x1, y0, y1) = bounds(triangle);
    let mut walk = Walk::default();
    let Some(clockwise) = oriented(triangle) else { return walk };
    let edges = sides(clockwise);
    let mut row = edges.map(|(p, q)| edge(p, q, center((x0, y0))));
    for y in y0..=y1 {
        let mut e = row;
        for x in x0..=x1 {
            walk.visited.push((x, y));
            if e.iter().zip(edges).all(|(e, (p, q))| *e > 0 || (*e == 0 && top_left(p, q))) {
                walk.drawn.push((x, y));
            }
            for (e, (p, q)) in e.iter_mut().zip(edges) {
                *e += (p.1 - q.1) * 256;
            }
        }
        for (e, (p, q)) in row.iter_mut().zip(edges) {
            *e += (q.0 - p.0) * 256;
        }
    }
    walk
}
