//! Polygons to triangles.

use std::cmp::Ordering;
use std::collections::VecDeque;

use crate::geom::Point;

/// Cuts a simple polygon, convex or concave, into triangles by clipping ears (Meisters 1975): indices into
/// `points`, three for each triangle, wound as the polygon is.
///
/// The polygon must not cross itself; its last point is joined to its first, and it may run either
/// way round. n corners give n − 2 triangles, less one for every corner that repeats its neighbour
/// or lies on the line between its neighbours. The triangles overlap nowhere and leave nothing out: decisions
/// are exact in integers of 45 bits, scaled to the largest coordinate. An outline that crosses itself gives
/// triangles, too, but not those of its fill; points that are not finite, or fewer than three, give none.
///
/// The time grows with the corners times the concave ones nearby: meant for outlines of up to some
/// ten thousand points.
pub fn triangulate(points: &[Point]) -> Vec<[u32; 3]> {
    let Some(mut ring) = Ring::new(points) else { return Vec::new() };
    ring.clip_ears();
    ring.triangles
}

/// A corner on the integer grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Corner {
    x: i64,
    y: i64,
}

/// Twice the signed area of a triangle; the sum of 2^32 of them stays below 2^127.
fn cross(a: Corner, b: Corner, c: Corner) -> i128 {
    i128::from(b.x - a.x) * i128::from(c.y - a.y) - i128::from(b.y - a.y) * i128::from(c.x - a.x)
}

/// Whether `p` lies in the closed triangle a, b, c, whose area is positive.
fn holds(a: Corner, b: Corner, c: Corner, p: Corner) -> bool {
    cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0
}

/// The corners not yet cut off, linked both ways.
struct Ring {
    corners: Vec<Corner>,
    next: Vec<u32>,
    previous: Vec<u32>,
    present: Vec<bool>,
    /// The corners that were concave, in order of x: only those can lie in an ear.
    concave: Vec<u32>,
    /// At how many corners left `concave` is swept of those gone or convex by now.
    next_sweep: usize,
    remaining: usize,
    triangles: Vec<[u32; 3]>,
}

impl Ring {
    /// `None` where there is nothing to cut.
    fn new(points: &[Point]) -> Option<Self> {
        let count = u32::try_from(points.len()).ok().filter(|&count| count >= 3)?;
        let mut corners = to_grid(points)?;
        turn_lengthways(&mut corners);
        let origin = *corners.first()?;
        let area: i128 = corners.windows(2).map(|pair| cross(origin, pair[0], pair[1])).sum();
        match area.cmp(&0) {
            Ordering::Less => corners.iter_mut().for_each(|corner| corner.x = -corner.x),
            Ordering::Equal => return None,
            Ordering::Greater => {}
        }
        let mut ring = Self {
            corners,
            next: (1..count).chain([0]).collect(),
            previous: [count - 1].into_iter().chain(0..count - 1).collect(),
            present: vec![true; points.len()],
            concave: Vec::new(),
            next_sweep: points.len() / 2,
            remaining: points.len(),
            triangles: Vec::with_capacity(points.len() - 2),
        };
        let mut concave: Vec<u32> = (0..count).filter(|&i| ring.turn(i) <= 0).collect();
        concave.sort_unstable_by_key(|&i| ring.corner(i).x);
        ring.concave = concave;
        Some(ring)
    }

    fn corner(&self, i: u32) -> Corner {
        self.corners[i as usize]
    }

    fn neighbours(&self, i: u32) -> (u32, u32) {
        (self.previous[i as usize], self.next[i as usize])
    }

    /// Positive where the ring turns inwards at `i`.
    fn turn(&self, i: u32) -> i128 {
        let (before, after) = self.neighbours(i);
        cross(self.corner(before), self.corner(i), self.corner(after))
    }

    fn clip_ears(&mut self) {
        // Cutting an ear can only make ears of its neighbours, so that a corner is looked at again when
        // one next to it goes, and not before. First in, first out keeps the triangles from
        // fanning out of one corner.
        let mut queue: VecDeque<u32> = (0..self.corners.len() as u32).collect();
        let mut strict = true;
        while self.remaining >= 3 {
            let Some(i) = queue.pop_front() else {
                // Not a simple polygon (two pieces touch or cross): a second look at all, then any
                // convex corner will do.
                if !self.relax(&mut strict, &mut queue) {
                    return;
                }
                continue;
            };
            if !self.present[i as usize] {
                continue;
            }
            let turn = self.turn(i);
            if turn == 0 || (turn > 0 && self.is_ear(i)) {
                self.cut(i, turn != 0, &mut queue);
            }
        }
    }

    /// What to do when no corner is an ear. Returns whether anything is left to do.
    fn relax(&mut self, strict: &mut bool, queue: &mut VecDeque<u32>) -> bool {
        let present = || (0..self.corners.len() as u32).filter(|&i| self.present[i as usize]);
        if std::mem::replace(strict, false) {
            queue.extend(present());
            return true;
        }
        let convex: Vec<u32> = present().filter(|&i| self.turn(i) > 0).collect();
        for &i in &convex {
            if self.remaining >= 3 && self.turn(i) > 0 {
                self.cut(i, true, queue);
            }
        }
        !convex.is_empty()
    }

    /// Whether no other corner lies in the triangle at `i`, which turns inwards.
    fn is_ear(&self, i: u32) -> bool {
        let (before, after) = self.neighbours(i);
        let (a, b, c) = (self.corner(before), self.corner(i), self.corner(after));
        let (low, high) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let first = self.concave.partition_point(|&j| self.corner(j).x < low);
        self.concave.iter().skip(first).take_while(|&&j| self.corner(j).x <= high).all(|&j| {
            let p = self.corner(j);
            // Corners at the same place are bridges to a hole: they do not stand in the way.
            !self.present[j as usize] || p == a || p == b || p == c || !holds(a, b, c, p)
        })
    }

    fn cut(&mut self, i: u32, draw: bool, queue: &mut VecDeque<u32>) {
        let (before, after) = self.neighbours(i);
        if draw {
            self.triangles.push([before, i, after]);
        }
        self.next[before as usize] = after;
        self.previous[after as usize] = before;
        self.present[i as usize] = false;
        self.remaining -= 1;
        if self.remaining < self.next_sweep {
            self.next_sweep = self.remaining / 2;
            let mut concave = std::mem::take(&mut self.concave);
            concave.retain(|&j| self.present[j as usize] && self.turn(j) <= 0);
            self.concave = concave;
        }
        queue.extend([before, after]);
    }
}

/// Turns corners that lie in an upright box by 90°, so that few of them share a piece of the x axis.
fn turn_lengthways(corners: &mut [Corner]) {
    let extent = |of: fn(&Corner) -> i64| {
        let (low, high) = corners.iter().map(of).fold((i64::MAX, i64::MIN), |(a, b), v| (a.min(v), b.max(v)));
        high.saturating_sub(low)
    };
    if extent(|corner| corner.y) > extent(|corner| corner.x) {
        corners.iter_mut().for_each(|corner| *corner = Corner { x: corner.y, y: -corner.x });
    }
}

/// The points as integers of at most 45 bits, all scaled by the same power of two, which changes no turn.
/// `None` if one is not finite or all are 0.
fn to_grid(points: &[Point]) -> Option<Vec<Corner>> {
    let mut largest = 0.0_f64;
    for v in points.iter().flat_map(|p| [p.x, p.y]) {
        if !v.is_finite() {
            return None;
        }
        largest = largest.max(f64::from(v).abs());
    }
    if largest == 0.0 {
        return None;
    }
    // 2^44 ≤ largest·scale < 2^45. The exponents of `f32`, subnormals included, are normal ones here.
    let exponent = (largest.to_bits() >> 52) as i64 - 1023;
    let scale = f64::from_bits(((1023 + 44 - exponent) as u64) << 52);
    let to_int = |v: f32| (f64::from(v) * scale + 0.5).floor() as i64;
    Some(points.iter().map(|p| Corner { x: to_int(p.x), y: to_int(p.y) }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(list: &[(f32, f32)]) -> Vec<Point> {
        list.iter().map(|&p| p.into()).collect()
    }

    fn area(points: &[Point], triangles: &[[u32; 3]]) -> f64 {
        let doubled = |[a, b, c]: [Point; 3]| {
            let (ab, ac) = (b - a, c - a);
            f64::from(ab.x) * f64::from(ac.y) - f64::from(ab.y) * f64::from(ac.x)
        };
        triangles.iter().map(|t| doubled(t.map(|i| points[i as usize])) / 2.0).sum()
    }

    #[test]
    fn an_arrow_head_has_one_way_to_be_cut() {
        // The notch at 3 leaves the diagonal 1–3 only.
        let arrow = points(&[(0.0, 0.0), (4.0, 3.0), (0.0, 6.0), (1.0, 3.0)]);
        let mut cut = triangulate(&arrow);
        cut.iter_mut().for_each(|t| t.sort_unstable());
        cut.sort_unstable();
        assert_eq!(cut, [[0, 1, 3], [1, 2, 3]]);
    }

    #[test]
    fn both_ways_round_keep_their_winding() {
        let mut l_shape = points(&[(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (1.0, 1.0), (1.0, 5.0), (0.0, 5.0)]);
        assert_eq!((triangulate(&l_shape).len(), area(&l_shape, &triangulate(&l_shape))), (4, 8.0));
        l_shape.reverse();
        assert_eq!(area(&l_shape, &triangulate(&l_shape)), -8.0);
    }

    #[test]
    fn corners_that_turn_nowhere_add_no_triangle() {
        let square = points(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)]);
        assert_eq!((triangulate(&square).len(), area(&square, &triangulate(&square))), (2, 4.0));
    }

    #[test]
    fn scale_changes_nothing() {
        let base = [(0.0, 0.0), (5.0, 1.0), (2.0, 2.0), (6.0, 5.0), (1.0, 3.0)];
        let expected = triangulate(&points(&base));
        assert_eq!(expected.len(), 3);
        for scale in [1e-40_f32, 1e-30, 1e30, 6e37] {
            // Powers of two, so that the corners stay where they are.
            let scale = f32::from_bits(scale.to_bits() & 0xff80_0000).max(f32::from_bits(1 << 20));
            let scaled = base.map(|(x, y)| (x * scale, y * scale));
            assert_eq!(triangulate(&points(&scaled)), expected, "{scale:e}");
        }
    }

    #[test]
    fn a_spiral_of_two_thousand_corners() {
        // Two arms, one inside the other, each on a square spiral with steps of 2 and a gap of 1.
        let mut arm = vec![(0.0, 0.0)];
        let mut inner = vec![(0.5, 0.5)];
        let (mut x, mut y) = (0.0_f32, 0.0_f32);
        for turn in 0..1000 {
            let length = (2 + turn / 2 * 2) as f32;
            let (dx, dy) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][turn % 4];
            (x, y) = (x + dx * length, y + dy * length);
            arm.push((x, y));
            let (ix, iy) = [(-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5), (0.5, 0.5)][turn % 4];
            inner.push((x + ix, y + iy));
        }
        arm.extend(inner.into_iter().rev());
        let spiral = points(&arm);
        let shoelace: f64 = (0..spiral.len())
            .map(|i| {
                let (a, b) = (spiral[i], spiral[(i + 1) % spiral.len()]);
                (f64::from(a.x) * f64::from(b.y) - f64::from(a.y) * f64::from(b.x)) / 2.0
            })
            .sum();
        let cut = triangulate(&spiral);
        assert_eq!(area(&spiral, &cut), shoelace);
        // Every triangle is wound alike, so that none can make up for another.
        assert!(cut.iter().all(|t| area(&spiral, &[*t]).signum() == shoelace.signum()));
    }

    #[test]
    fn what_is_no_polygon_ends() {
        assert!(triangulate(&[]).is_empty());
        assert!(triangulate(&points(&[(0.0, 0.0), (1.0, 1.0)])).is_empty());
        assert!(triangulate(&points(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)])).is_empty());
        assert!(triangulate(&points(&[(0.0, 0.0), (1.0, f32::NAN), (2.0, 0.0)])).is_empty());
        assert!(triangulate(&points(&[(0.0, 0.0); 5])).is_empty());
        // A star drawn in one stroke, and scribble.
        assert!(triangulate(&points(&[(0.0, 0.0), (4.0, 3.0), (-1.0, 3.0), (3.0, 0.0), (1.5, 5.0)])).len() <= 3);
        let mut seed = 1_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 20) as f32
        };
        let scribble: Vec<Point> = (0..2000).map(|_| Point::new(random(), random())).collect();
        assert!(triangulate(&scribble).len() <= 1998);
    }
}
