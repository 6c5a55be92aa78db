//! Circles from their equations.

use super::Pixel;

/// The pixels with F(x, y) = x² + y² − r² < 0, by looking at every one.
pub(crate) fn implicit_disc(center: Pixel, radius: i32) -> Vec<Pixel> {
    let side = -radius - 2..=radius + 2;
    side.clone()
        .flat_map(|y| side.clone().map(move |x| (x, y)))
        .filter(|(x, y)| x * x + y * y - radius * radius < 0)
        .map(|(x, y)| (center.0 + x, center.1 + y))
        .collect()
}

/// The square-root circle's upper half: y = round(√(r² − x²)) for each x from −r to r.
pub(crate) fn square_root(radius: i32) -> Vec<Pixel> {
    (-radius..=radius).map(|x| (x, f64::from(radius * radius - x * x).sqrt().round() as i32)).collect()
}

/// The eight images of a pixel.
pub(crate) fn reflections((x, y): Pixel) -> [Pixel; 8] {
    [(x, y), (y, x), (y, -x), (x, -y), (-x, -y), (-y, -x), (-y, x), (-x, y)]
}
