//! Areas by clipping: what part of a pixel a polygon covers.

/// A point in pixels.
pub(crate) type Place = (f64, f64);

/// The signed area of a polygon (the shoelace formula), positive where it runs clockwise on the canvas.
pub(crate) fn area(polygon: &[Place]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| a.0 * b.1 - a.1 * b.0).sum::<f64>() / 2.0
}

/// The part of a polygon where `inside` is not negative; `inside` is linear (Sutherland and Hodgman, 1974).
fn cut(polygon: &[Place], inside: impl Fn(Place) -> f64) -> Vec<Place> {
    let mut out = Vec::new();
    for (a, b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (da, db) = (inside(*a), inside(*b));
        if da >= 0.0 {
            out.push(*a);
        }
        if (da < 0.0) != (db < 0.0) {
            let t = da / (da - db);
            out.push((a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t));
        }
    }
    out
}

/// How much of the pixel at (x, y) a polygon that does not cross itself covers, 0 ..= 1.
pub(crate) fn coverage(polygon: &[Place], x: u32, y: u32) -> f64 {
    let (x, y) = (f64::from(x), f64::from(y));
    let mut part = cut(polygon, |p| p.0 - x);
    part = cut(&part, |p| x + 1.0 - p.0);
    part = cut(&part, |p| p.1 - y);
    part = cut(&part, |p| y + 1.0 - p.1);
    area(&part).abs()
}
