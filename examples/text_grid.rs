//! Aliased primitives on a grid of one's own, here of letters: `cargo run --example text_grid`.

use rastrum::{FillRule, IntRect, Point, raster};

fn main() {
    let (width, height) = (48, 15);
    let whole = IntRect::from_xywh(0, 0, width, height);
    let mut grid = vec![vec!['.'; width as usize]; height as usize];
    let star = [(24.0, 0.6), (28.35, 14.0), (16.95, 5.7), (31.05, 5.7), (19.65, 14.0)].map(Point::from);
    raster::polygon::fill(&star, FillRule::EvenOdd, whole, |y, row| {
        for x in row {
            grid[y as usize][x as usize] = '*';
        }
    });
    for (x, y) in raster::circle::circle((8, 7), 6).clipped(whole) {
        grid[y as usize][x as usize] = 'o';
    }
    for (x, y) in raster::line::bresenham((33, 13), (46, 2)).clipped(whole) {
        grid[y as usize][x as usize] = '#';
    }
    for row in grid {
        println!("{}", row.into_iter().collect::<String>());
    }
}
