//! A grid of free and blocked cells, a path planned on it and a robot's footprints along the path:
//! `cargo run --example robot_path` writes robot_path.png.
//!
//! The same pixels decide and are shown: a cell belongs to a straight move if the supercover line passes through it.

use rastrum::{Canvas, Color, FillRule, IntRect, LineCap, LineJoin, Path, Point, Rect, Stroke, raster};

const CELL: f32 = 20.0;
const WIDTH: i32 = 24;
const HEIGHT: i32 = 14;

fn main() -> rastrum::Result<()> {
    // Two walls and an obstacle with a slanting outline, rasterized into the grid.
    let mut blocked = vec![false; (WIDTH * HEIGHT) as usize];
    let whole = IntRect::from_xywh(0, 0, WIDTH as u32, HEIGHT as u32);
    for outline in [
        vec![Point::new(5.0, 0.0), Point::new(7.0, 0.0), Point::new(7.0, 8.0), Point::new(5.0, 8.0)],
        vec![Point::new(11.0, 5.0), Point::new(16.0, 7.5), Point::new(12.5, 14.0), Point::new(11.0, 14.0)],
        vec![Point::new(18.0, 0.0), Point::new(20.0, 0.0), Point::new(20.0, 6.0), Point::new(18.0, 6.0)],
    ] {
        raster::polygon::fill(&outline, FillRule::NonZero, whole, |y, row| {
            for x in row {
                blocked[(y * WIDTH + x) as usize] = true;
            }
        });
    }
    let way = [(1, 2), (4, 10), (9, 10), (9, 3), (17, 8), (22, 9), (22, 2)];
    let collides = |a, b| raster::line::supercover(a, b).any(|(x, y)| blocked[(y * WIDTH + x) as usize]);

    let mut canvas = Canvas::new((WIDTH as f32 * CELL) as u32, (HEIGHT as f32 * CELL) as u32)?;
    canvas.clear(Color::WHITE);
    canvas.scale(CELL, CELL);
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let cell = Rect::from_xywh(x as f32 + 0.03, y as f32 + 0.03, 0.94, 0.94);
            let free = !blocked[(y * WIDTH + x) as usize];
            canvas.fill_rect(cell, if free { Color::from_rgb8(238, 241, 244) } else { Color::from_rgb8(52, 62, 74) });
        }
    }
    let center = |(x, y): (i32, i32)| Point::new(x as f32 + 0.5, y as f32 + 0.5);
    let mut hits = 0;
    for leg in way.windows(2) {
        let bad = collides(leg[0], leg[1]);
        hits += u32::from(bad);
        let color = if bad { Color::from_rgb8(214, 50, 60) } else { Color::from_rgb8(30, 140, 110) };
        for (x, y) in raster::line::supercover(leg[0], leg[1]) {
            canvas.fill_rect(Rect::from_xywh(x as f32, y as f32, 1.0, 1.0), color.with_opacity(0.2));
        }
        let mut line = Path::new();
        line.move_to(center(leg[0])).line_to(center(leg[1]));
        let stroke = Stroke::new(0.22).with_cap(LineCap::Round).with_join(LineJoin::Round);
        canvas.stroke_path(&line, &stroke, color);
    }
    for point in way {
        canvas.fill_circle(center(point), 0.3, Color::WHITE);
        canvas.stroke_circle(center(point), 0.3, &Stroke::new(0.1), Color::from_rgb8(30, 60, 90));
    }
    canvas.into_pixmap().save_png("robot_path.png")?;
    println!("robot_path.png: {hits} of {} moves pass through a blocked cell", way.len() - 1);
    Ok(())
}
