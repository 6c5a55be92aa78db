//! The lectures' ways to draw a line, each as the lecture writes it.
//!
//! Lines are reckoned from the left end, steep ones from the upper end, with the tie to E.

use super::Pixel;

/// The line as it is defined: in each column (each row, if it is steep) the pixel whose centre is
/// nearest to the ideal line, found by trying all of them; of two as near, the one nearer to the start.
pub(crate) fn nearest(from: Pixel, to: Pixel) -> Vec<Pixel> {
    oriented(from, to, |dx, dy| {
        let up = dy.signum();
        (0..=dx)
            .map(|x| {
                // |y − x·dy/dx|, times dx.
                let distance = |k: &i64| (k * up * dx - x * dy).abs();
                (x, up * (0..=dy.abs()).min_by_key(distance).unwrap_or(0))
            })
            .collect()
    })
}

/// Whether the ideal line passes exactly between two pixels somewhere.
pub(crate) fn has_tie(from: Pixel, to: Pixel) -> bool {
    let (dx, dy) = (i64::from(to.0 - from.0).abs(), i64::from(to.1 - from.1).abs());
    let (long, short) = (dx.max(dy), dx.min(dy));
    (0..=long).any(|i| long > 0 && (2 * i * short) % (2 * long) == long)
}

/// Bresenham split in two: one loop for the low slopes, one for the high ones, each from its own end.
pub(crate) fn low_high(from: Pixel, to: Pixel) -> Vec<Pixel> {
    let (dx, dy) = ((to.0 - from.0).abs(), (to.1 - from.1).abs());
    if dy < dx {
        if from.0 > to.0 { low(to, from) } else { low(from, to) }
    } else if from.1 > to.1 {
        high(to, from)
    } else {
        high(from, to)
    }
}

fn low((x0, y0): Pixel, (x1, y1): Pixel) -> Vec<Pixel> {
    let dx = x1 - x0;
    let (dy, yi) = if y1 < y0 { (y0 - y1, -1) } else { (y1 - y0, 1) };
    let mut d = 2 * dy - dx;
    let mut y = y0;
    let mut pixels = Vec::new();
    for x in x0..=x1 {
        pixels.push((x, y));
        if d > 0 {
            y += yi;
            d += 2 * (dy - dx);
        } else {
            d += 2 * dy;
        }
    }
    pixels
}

fn high((x0, y0): Pixel, (x1, y1): Pixel) -> Vec<Pixel> {
    let dy = y1 - y0;
    let (dx, xi) = if x1 < x0 { (x0 - x1, -1) } else { (x1 - x0, 1) };
    let mut d = 2 * dx - dy;
    let mut x = x0;
    let mut pixels = Vec::new();
    for y in y0..=y1 {
        pixels.push((x, y));
        if d > 0 {
            x += xi;
            d += 2 * (dx - dy);
        } else {
            d += 2 * dx;
        }
    }
    pixels
}

/// Bresenham with a floating error: add the slope at every step, step up once it is over a half.
pub(crate) fn float_error(from: Pixel, to: Pixel) -> Vec<Pixel> {
    oriented(from, to, |dx, dy| {
        let slope = if dx == 0 { 0.0 } else { (dy as f64 / dx as f64).abs() };
        let (mut y, mut error) = (0, 0.0);
        let mut pixels = Vec::new();
        for x in 0..=dx {
            pixels.push((x, y));
            error += slope;
            // The sum is off by its roundings: what is this near to a half is a tie.
            if error > 0.5 + 1e-9 {
                y += dy.signum();
                error -= 1.0;
            }
        }
        pixels
    })
}

/// y = m·x + b, rounded.
pub(crate) fn slope_intercept(from: Pixel, to: Pixel) -> Vec<Pixel> {
    if from == to {
        return vec![from];
    }
    let along = |(a0, b0): (i32, i32), (a1, b1): (i32, i32)| {
        let m = f64::from(b1 - b0) / f64::from(a1 - a0);
        let b = f64::from(b0) - m * f64::from(a0);
        (a0.min(a1)..=a0.max(a1)).map(move |a| (a, (m * f64::from(a) + b).round() as i32))
    };
    if (to.1 - from.1).abs() > (to.0 - from.0).abs() {
        along((from.1, from.0), (to.1, to.0)).map(|(y, x)| (x, y)).collect()
    } else {
        along(from, to).collect()
    }
}

/// The digital differential analyser: equal steps of a floating x and y.
pub(crate) fn dda(from: Pixel, to: Pixel) -> Vec<Pixel> {
    let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let steps = dx.abs().max(dy.abs());
    let (mut x, mut y) = (f64::from(from.0), f64::from(from.1));
    let mut pixels = vec![from];
    for _ in 0..steps as i64 {
        x += dx / steps;
        y += dy / steps;
        pixels.push((x.round() as i32, y.round() as i32));
    }
    pixels
}

/// The midpoint line: each pixel with twice the implicit function F(x + 1, y + ½) at it, evaluated from
/// nothing: E where it is at most 0, the diagonal step where it is more.
pub(crate) fn midpoint(from: Pixel, to: Pixel) -> Vec<(Pixel, i64)> {
    let mut values = Vec::new();
    let pixels = oriented(from, to, |dx, dy| {
        let mut y = 0;
        let mut pixels = Vec::new();
        for x in 0..=dx {
            pixels.push((x, y * dy.signum()));
            // F(x, y) = dy·x − dx·y, times two, at (x + 1, y + ½).
            let doubled = 2 * dy.abs() * (x + 1) - dx * (2 * y + 1);
            values.push(doubled);
            if doubled > 0 {
                y += 1;
            }
        }
        pixels
    });
    pixels.into_iter().zip(values).collect()
}

/// α along a line by differential analysis: pixels that a walk visits get the sum of what each step
/// adds, v.x/L to the right and v.y/L down, with v the line's direction and L its length.
pub(crate) fn attribute(from: Pixel, to: Pixel, walk: &[Pixel]) -> Vec<f64> {
    let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let length = (dx * dx + dy * dy).sqrt();
    let (right, down) = (dx / length / length, dy / length / length);
    let (mut alpha, mut at) = (0.0, from);
    walk.iter()
        .map(|&pixel| {
            alpha += f64::from(pixel.0 - at.0) * right + f64::from(pixel.1 - at.1) * down;
            at = pixel;
            alpha
        })
        .collect()
}

/// Draws in the half-plane dx ≥ |dy| from (0, 0), and carries the pixels back to where the line lies.
fn oriented(from: Pixel, to: Pixel, draw: impl FnOnce(i64, i64) -> Vec<(i64, i64)>) -> Vec<Pixel> {
    let steep = (to.1 - from.1).abs() > (to.0 - from.0).abs();
    let swap = |(x, y): (i32, i32)| if steep { (y, x) } else { (x, y) };
    let (a, b) = (swap(from), swap(to));
    let (a, b) = if a.0 > b.0 { (b, a) } else { (a, b) };
    draw(i64::from(b.0 - a.0), i64::from(b.1 - a.1))
        .into_iter()
        .map(|(x, y)| swap((a.0 + x as i32, a.1 + y as i32)))
        .collect()
}
