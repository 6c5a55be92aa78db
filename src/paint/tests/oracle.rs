//! What every paint should give, slowly, in `f64`, one pixel at a time.

use crate::color::{Color, unit};
use crate::geom::Transform;
use crate::paint::{FilterQuality, GradientStop, Pattern, Shader, SpreadMode};

/// A premultiplied colour in 0 ..= 255, not rounded.
pub(super) type Exact = [f64; 4];

/// The point of the paint's own space under device point (x, y): Cramer's rule, twice.
fn to_own_space(outer: Transform, inner: Transform, x: f64, y: f64) -> (f64, f64) {
    fn undo(t: Transform, (x, y): (f64, f64)) -> (f64, f64) {
        let [a, b, c, d, e, f] = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
        let (x, y, det) = (x - e, y - f, a * d - b * c);
        ((x * d - c * y) / det, (a * y - b * x) / det)
    }
    undo(inner, undo(outer, (x, y)))
}

fn fold(t: f64, spread: SpreadMode) -> f64 {
    match spread {
        SpreadMode::Pad | SpreadMode::Decal => t,
        SpreadMode::Repeat => t.rem_euclid(1.0),
        SpreadMode::Reflect => {
            let u = t.rem_euclid(2.0);
            if u > 1.0 { 2.0 - u } else { u }
        }
    }
}

/// The colour at position t: the straight mix of its neighbours, premultiplied.
fn color_at(stops: &[GradientStop], t: f64, spread: SpreadMode, opacity: f64) -> Exact {
    if spread == SpreadMode::Decal && !(0.0..=1.0).contains(&t) {
        return [0.0; 4];
    }
    let t = fold(t, spread);
    let straight = |c: Color| [c.r, c.g, c.b, c.a].map(|v| f64::from(unit(v)));
    let mut positions: Vec<f64> = Vec::new();
    for stop in stops {
        let p = f64::from(unit(stop.position));
        positions.push(positions.last().map_or(p, |last| p.max(*last)));
    }
    let before = positions.iter().rposition(|p| *p <= t);
    let color = match before {
        None => straight(stops[0].color),
        Some(k) if k + 1 == stops.len() => straight(stops[k].color),
        Some(k) => {
            let f = (t - positions[k]) / (positions[k + 1] - positions[k]);
            let (a, b) = (straight(stops[k].color), straight(stops[k + 1].color));
            [0, 1, 2, 3].map(|i| a[i] + (b[i] - a[i]) * f)
        }
    };
    let alpha = color[3] * opacity;
    [color[0] * alpha * 255.0, color[1] * alpha * 255.0, color[2] * alpha * 255.0, alpha * 255.0]
}

/// The colour of `shader` at device point (x, y).
pub(super) fn color(shader: &Shader, transform: Transform, opacity: f64, x: f64, y: f64) -> Exact {
    match shader {
        Shader::Solid(color) => {
            let stop = GradientStop::new(0.0, *color);
            color_at(&[stop], 0.0, SpreadMode::Pad, opacity)
        }
        Shader::LinearGradient(g) => {
            let (x, y) = to_own_space(transform, g.transform, x, y);
            let (sx, sy) = (f64::from(g.start.x), f64::from(g.start.y));
            let (dx, dy) = (f64::from(g.end.x) - sx, f64::from(g.end.y) - sy);
            let t = ((x - sx) * dx + (y - sy) * dy) / (dx * dx + dy * dy);
            color_at(&g.stops, t, g.spread, opacity)
        }
        Shader::RadialGradient(g) => {
            let (x, y) = to_own_space(transform, g.transform, x, y);
            let (px, py) = (x - f64::from(g.start_center.x), y - f64::from(g.start_center.y));
            let cx = f64::from(g.end_center.x) - f64::from(g.start_center.x);
            let cy = f64::from(g.end_center.y) - f64::from(g.start_center.y);
            let r0 = f64::from(g.start_radius);
            let dr = f64::from(g.end_radius) - r0;
            // |p − t·c| = r0 + t·dr, squared and sorted by powers of t.
            let qa = cx * cx + cy * cy - dr * dr;
            let qb = -2.0 * (px * cx + py * cy + r0 * dr);
            let qc = px * px + py * py - r0 * r0;
            let mut roots = if qa.abs() < 1e-9 {
                vec![-qc / qb]
            } else {
                let root = (qb * qb - 4.0 * qa * qc).sqrt();
                vec![(-qb + root) / (2.0 * qa), (-qb - root) / (2.0 * qa)]
            };
            roots.retain(|t| r0 + t * dr >= 0.0);
            roots.sort_by(f64::total_cmp);
            roots.last().map_or([0.0; 4], |t| color_at(&g.stops, *t, g.spread, opacity))
        }
        Shader::SweepGradient(g) => {
            let (x, y) = to_own_space(transform, g.transform, x, y);
            let angle = libm::atan2(y - f64::from(g.center.y), x - f64::from(g.center.x)).to_degrees();
            let angle = angle.rem_euclid(360.0);
            let (start, end) = (f64::from(g.start_angle), f64::from(g.end_angle));
            let inside =
                [0, 1, -1, 2, -2].map(|k| angle + 360.0 * f64::from(k)).into_iter().find(|a| (start..=end).contains(a));
            let t = (inside.unwrap_or(angle) - start) / (end - start);
            let spread = if end - start >= 360.0 { SpreadMode::Pad } else { g.spread };
            color_at(&g.stops, t, spread, opacity)
        }
        Shader::Pattern(pattern) => {
            let (x, y) = to_own_space(transform, pattern.transform, x, y);
            sample(pattern, x, y).map(|v| v * opacity)
        }
    }
}

fn wrap(i: i64, size: i64, spread: SpreadMode) -> Option<i64> {
    match spread {
        SpreadMode::Pad => Some(i.clamp(0, size - 1)),
        SpreadMode::Decal => (0..size).contains(&i).then_some(i),
        SpreadMode::Repeat => Some(i.rem_euclid(size)),
        SpreadMode::Reflect => {
            let r = i.rem_euclid(2 * size);
            Some(if r < size { r } else { 2 * size - 1 - r })
        }
    }
}

fn sample(pattern: &Pattern, x: f64, y: f64) -> Exact {
    let image = &pattern.image;
    let pixel = |i: i64, j: i64| -> Exact {
        let i = wrap(i, i64::from(image.width()), pattern.spread_x);
        let j = wrap(j, i64::from(image.height()), pattern.spread_y);
        match (i, j) {
            (Some(i), Some(j)) => image.pixel(i as u32, j as u32).unwrap().map(f64::from),
            _ => [0.0; 4],
        }
    };
    let kernel: fn(f64) -> f64 = match pattern.quality {
        FilterQuality::Nearest => return pixel(x.floor() as i64, y.floor() as i64),
        FilterQuality::Bilinear => |d| (1.0 - d.abs()).max(0.0),
        FilterQuality::Bicubic => |d| {
            let d = d.abs();
            if d < 1.0 {
                (7.0 * d * d * d - 12.0 * d * d + 16.0 / 3.0) / 6.0
            } else if d < 2.0 {
                (-7.0 / 3.0 * d * d * d + 12.0 * d * d - 20.0 * d + 32.0 / 3.0) / 6.0
            } else {
                0.0
            }
        },
    };
    let mut sum = [0.0; 4];
    let (left, top) = (x.floor() as i64, y.floor() as i64);
    for j in top - 3..=top + 3 {
        for i in left - 3..=left + 3 {
            let weight = kernel(x - i as f64 - 0.5) * kernel(y - j as f64 - 0.5);
            for (sum, value) in sum.iter_mut().zip(pixel(i, j)) {
                *sum += weight * value;
            }
        }
    }
    let alpha = sum[3].clamp(0.0, 255.0);
    [sum[0].clamp(0.0, alpha), sum[1].clamp(0.0, alpha), sum[2].clamp(0.0, alpha), alpha]
}
