//! The seed checklist's lines and circles: rows 21 to 38.

use std::collections::{BTreeMap, BTreeSet};

use rastrum::raster::circle::{circle, disc};
use rastrum::raster::line::{bresenham, interpolate, parameter, wide};
use rastrum::raster::polygon;
use rastrum::{FillRule, IntRect, Point};

use crate::oracle::circle as circle_oracle;
use crate::oracle::{Pixel, Random, line as oracle, once, picture, spans};

/// Lines from one pixel to all others nearby, and some hundred long ones anywhere.
fn lines() -> Vec<(Pixel, Pixel)> {
    let from = (3, -2);
    let mut lines: Vec<_> = (-14..=14).flat_map(|x| (-14..=14).map(move |y| (from, (3 + x, y - 2)))).collect();
    let mut random = Random::new(21);
    lines.extend((0..300).map(|_| (random.pixel(-400..400), random.pixel(-400..400))));
    lines
}

fn line(from: Pixel, to: Pixel) -> BTreeSet<Pixel> {
    once(bresenham(from, to))
}

#[test]
fn s021_bresenham() {
    for (from, to) in lines() {
        assert_eq!(line(from, to), once(oracle::nearest(from, to)), "{from:?} to {to:?}");
        assert_eq!(line(from, to), line(to, from), "{from:?} to {to:?} and back");
        let walk: Vec<_> = bresenham(from, to).collect();
        assert_eq!((walk.first(), walk.last()), (Some(&from), Some(&to)));
    }
    // A tie in each octant: the second pixel, seen from the left (the upper) end, stays in the row (column).
    let expected = [((8, 4), (1, 0)), ((8, -4), (1, 0)), ((4, 8), (0, 1)), ((-4, 8), (0, 1))];
    for (to, second) in expected {
        assert_eq!(bresenham((0, 0), to).nth(1), Some(second), "to {to:?}");
        assert_eq!(bresenham((0, 0), to).decision(), 0);
        let mut back: Vec<_> = bresenham(to, (0, 0)).collect();
        back.reverse();
        assert_eq!(back[1], second, "from {to:?}");
    }
    assert_eq!(
        picture(&line((0, 1), (9, 4)), 10),
        [
            "..........",
            "##........", //
            "..###.....",
            ".....###..",
            "........##",
        ]
    );
}

#[test]
fn s022_bresenham_worked_example() {
    let mut line = bresenham((20, 10), (30, 18));
    let (mut pixels, mut decisions) = (Vec::new(), Vec::new());
    loop {
        let decision = line.decision();
        let Some(pixel) = line.next() else { break };
        pixels.push(pixel);
        decisions.push(decision);
    }
    let rows = [10, 11, 12, 12, 13, 14, 15, 16, 16, 17, 18];
    assert_eq!(pixels, (20..=30).zip(rows).collect::<Vec<_>>());
    assert_eq!(decisions[..10], [6, 2, -2, 14, 10, 6, 2, -2, 14, 10]);
}

#[test]
fn s023_low_high_split() {
    for (from, to) in lines() {
        assert_eq!(line(from, to), once(oracle::low_high(from, to)), "{from:?} to {to:?}");
    }
    assert_eq!(line((5, 9), (5, 3)), (3..=9).map(|y| (5, y)).collect());
}

#[test]
fn s024_float_error_variant() {
    for (from, to) in lines() {
        assert_eq!(line(from, to), once(oracle::float_error(from, to)), "{from:?} to {to:?}");
    }
}

#[test]
fn s025_slope_and_intercept() {
    let mut compared = 0;
    for (from, to) in lines().into_iter().filter(|&(from, to)| !oracle::has_tie(from, to)) {
        assert_eq!(line(from, to), once(oracle::slope_intercept(from, to)), "{from:?} to {to:?}");
        compared += 1;
    }
    assert!(compared > 500, "only {compared} lines without a tie");
}

#[test]
fn s026_dda() {
    let mut compared = 0;
    for (from, to) in lines().into_iter().filter(|&(from, to)| !oracle::has_tie(from, to)) {
        let dda = once(oracle::dda(from, to));
        assert_eq!(dda, once(oracle::midpoint(from, to).into_iter().map(|(pixel, _)| pixel)), "{from:?} to {to:?}");
        assert_eq!(dda, line(from, to), "{from:?} to {to:?}");
        compared += 1;
    }
    assert!(compared > 500, "only {compared} lines without a tie");
}

#[test]
fn s027_midpoint() {
    for (from, to) in lines() {
        // From the end from which lines are reckoned.
        let steep = (to.1 - from.1).abs() > (to.0 - from.0).abs();
        let backward = if steep { to.1 < from.1 } else { to.0 < from.0 };
        let (from, to) = if backward { (to, from) } else { (from, to) };
        let mut line = bresenham(from, to);
        for (pixel, doubled_f) in oracle::midpoint(from, to) {
            // A line of no length has no step to decide on.
            if from != to {
                assert_eq!(line.decision(), doubled_f, "at {pixel:?} of {from:?} to {to:?}");
            }
            assert_eq!(line.next(), Some(pixel));
        }
        assert_eq!(line.next(), None);
    }
}

#[test]
fn s028_ideal_line() {
    for (from, to) in lines() {
        let line = line(from, to);
        assert!(line.contains(&from) && line.contains(&to), "{from:?} to {to:?}");
    }
    assert_eq!(picture(&line((1, 1), (7, 1)), 9), [".........", ".#######.", "........."]);
    assert_eq!(
        picture(&line((5, 0), (1, 4)), 7),
        [
            ".....#.", //
            "....#..", "...#...", "..#....", ".#.....",
        ]
    );
    assert_eq!(picture(&line((1, 3), (1, 1)), 3), ["...", ".#.", ".#.", ".#."]);
}

/// The rectangle of `width` around the segment, whose direction is (4, 3)/5 so that all of it is exact.
fn rectangle(from: Point, length: f32, width: f32) -> [Point; 4] {
    let along = Point::new(0.8 * length, 0.6 * length);
    let half = Point::new(-0.3 * width, 0.4 * width);
    [from - half, from + along - half, from + along + half, from + half]
}

fn filled(points: &[Point]) -> BTreeSet<Pixel> {
    spans(|span| polygon::fill(points, FillRule::NonZero, IntRect::from_ltrb(-200, -200, 200, 200), span))
}

#[test]
fn s029_line_as_rectangle() {
    let (from, length) = (Point::new(3.25, 4.125), 25.0);
    for (width, half_width) in [(1.25_f32, 5_i32), (3.75, 15)] {
        let expected: BTreeSet<_> = (0..40)
            .flat_map(|y| (0..40).map(move |x| (x, y)))
            .filter(|(x, y)| {
                let (dx, dy): (i32, i32) = (8 * x + 4 - 26, 8 * y + 4 - 33);
                // In 1/8 pixels, five times the distance along the line and across it.
                let (along, across) = (4 * dx + 3 * dy, 4 * dy - 3 * dx);
                assert!(across.abs() != 5 * half_width && along != 0 && along != 1000, "a tie decides");
                (0..=5 * 8 * 25).contains(&along) && across.abs() <= 5 * half_width
            })
            .collect();
        let drawn = filled(&rectangle(from, length, width));
        assert_eq!(drawn, expected);
        // The uneven width: columns of the same line hold different numbers of pixels.
        let columns: BTreeSet<_> = (8..18).map(|x| drawn.iter().filter(|pixel| pixel.0 == x).count()).collect();
        assert!(columns.len() > 1, "every column holds {columns:?} pixels");
    }
}

#[test]
fn s030_width_along_the_grid() {
    for (from, to) in lines() {
        let steep = (to.1 - from.1).abs() > (to.0 - from.0).abs();
        assert_eq!(once(wide(from, to, 1)), line(from, to));
        for width in 2..6 {
            let mut runs = BTreeMap::<i32, Vec<i32>>::new();
            for (x, y) in once(wide(from, to, width)) {
                let (column, level) = if steep { (y, x) } else { (x, y) };
                runs.entry(column).or_default().push(level);
            }
            assert_eq!(runs.len(), line(from, to).len());
            for run in runs.values() {
                assert_eq!(run.len(), width as usize);
                assert!(run.windows(2).all(|pair| pair[1] == pair[0] + 1));
            }
        }
    }
    // How far apart the outermost centres lie across the line: less by √2 at 45°.
    let across = |dx: i32, dy: i32| {
        let distances: Vec<_> = wide((0, 0), (60 * dx, 60 * dy), 9).map(|(x, y)| dx * y - dy * x).collect();
        let extent = distances.iter().max().unwrap() - distances.iter().min().unwrap();
        f64::from(extent) / f64::from(dx * dx + dy * dy).sqrt()
    };
    assert_eq!((across(1, 0), across(0, 1)), (8.0, 8.0));
    assert!((across(1, 1) - 8.0 / std::f64::consts::SQRT_2).abs() < 1e-12);
}

#[test]
fn s031_line_as_two_triangles() {
    let mut random = Random::new(31);
    for _ in 0..500 {
        // Corners on the centres' own grid now and then, so that the diagonal passes through many.
        let unit = [1.0, 0.5, 0.125][random.within(0..3) as usize];
        let mut coordinate = |range| random.within(range) as f32 * unit;
        let from = Point::new(coordinate(-40..40), coordinate(-40..40));
        let along = Point::new(coordinate(-80..80), coordinate(-80..80));
        let half = Point::new(-along.y, along.x) * 0.125;
        let [a, b, c, d] = [from - half, from + along - half, from + along + half, from + half];
        let (first, second) = (filled(&[a, b, c]), filled(&[a, c, d]));
        assert!(first.is_disjoint(&second), "the diagonal {a:?} to {c:?} is drawn twice");
        assert_eq!(&first | &second, filled(&[a, b, c, d]));
    }
}

#[test]
fn s032_attribute_along_a_line() {
    for (from, to) in lines().into_iter().filter(|(from, to)| from != to) {
        assert_eq!((parameter(from, to, from), parameter(from, to, to)), (0.0, 1.0));
        let walk: Vec<_> = bresenham(from, to).collect();
        for (&pixel, alpha) in walk.iter().zip(oracle::attribute(from, to, &walk)) {
            let error = (f64::from(parameter(from, to, pixel)) - alpha).abs();
            assert!(error < 1e-5, "{error:e} at {pixel:?} of {from:?} to {to:?}");
        }
    }
}

#[test]
fn s033_interpolation_in_one_dimension() {
    let mut random = Random::new(33);
    let mut naive_missed = false;
    for _ in 0..10_000 {
        let (a, b) = (f32::from_bits(random.bits() as u32), f32::from_bits(random.bits() as u32));
        if !a.is_finite() || !b.is_finite() {
            continue;
        }
        assert_eq!((interpolate(a, b, 0.0), interpolate(a, b, 1.0)), (a, b));
        assert_eq!(interpolate(a, a, random.within(0..257) as f32 / 256.0), a);
        naive_missed |= a + (b - a) * 1.0 != b;
    }
    assert!(naive_missed, "the test does not tell the exact form from a + (b − a)·t");
    assert_eq!([0.0, 0.25, 0.5, 0.75, 1.0].map(|t| interpolate(-2.0, 6.0, t)), [-2.0, 0.0, 2.0, 4.0, 6.0]);
}

#[test]
fn s034_implicit_disc() {
    for radius in 0..40 {
        let drawn = spans(|span| disc((4, -7), radius as u32).for_each(|(y, xs)| span(y, xs)));
        assert_eq!(drawn, once(circle_oracle::implicit_disc((4, -7), radius)), "radius {radius}");
    }
    let eight = spans(|span| disc((7, 7), 8).for_each(|(y, xs)| span(y, xs)));
    assert_eq!(
        picture(&eight, 15),
        [
            "....#######....",
            "..###########..",
            ".#############.",
            ".#############.",
            "###############",
            "###############",
            "###############",
            "###############",
            "###############",
            "###############",
            "###############",
            ".#############.",
            ".#############.",
            "..###########..",
            "....#######....",
        ]
    );
}

#[test]
fn s035_square_root_circle() {
    let upper = circle_oracle::square_root(20);
    let right_half: Vec<_> = upper.iter().filter(|p| p.0 >= 14).map(|p| p.1).collect();
    assert_eq!(right_half, [14, 13, 12, 11, 9, 6, 0], "by hand: √204, √175, √144, √111, √76, √39, 0");
    let gaps = upper.windows(2).filter(|pair| (pair[0].1 - pair[1].1).abs() > 1).count();
    assert_eq!(gaps, 6, "three steps of more than a pixel at either side");
    // Where the circle is flat, |x| ≤ y, it is the midpoint circle.
    for radius in 0..200 {
        let flat = |&(x, y): &Pixel| x.abs() <= y;
        let drawn: BTreeSet<_> = circle((0, 0), radius as u32).filter(flat).collect();
        let expected: BTreeSet<_> = circle_oracle::square_root(radius).into_iter().filter(flat).collect();
        assert_eq!(drawn, expected, "radius {radius}");
    }
}

#[test]
fn s036_eight_way_symmetry() {
    for radius in 0..200 {
        let set = once(circle((0, 0), radius));
        for &pixel in &set {
            for image in circle_oracle::reflections(pixel) {
                assert!(set.contains(&image), "radius {radius}: {pixel:?} without {image:?}");
            }
        }
    }
}

#[test]
fn s037_midpoint_circle() {
    // The lecture's octant runs from (0, r) with y up; on the canvas that is (0, −r).
    let octant: Vec<_> = circle((0, 0), 8).take_while(|&(x, y)| x <= -y).map(|(x, y)| (x, -y)).collect();
    assert_eq!(octant, [(0, 8), (1, 8), (2, 8), (3, 7), (4, 7), (5, 6)]);
    assert_eq!([8, 10, 20].map(|radius| once(circle((0, 0), radius)).len()), [44, 56, 112]);
    assert_eq!(
        picture(&once(circle((8, 8), 8)), 17),
        [
            "......#####......",
            "....##.....##....",
            "...#.........#...",
            "..#...........#..",
            ".#.............#.",
            ".#.............#.",
            "#...............#",
            "#...............#",
            "#...............#",
            "#...............#",
            "#...............#",
            ".#.............#.",
            ".#.............#.",
            "..#...........#..",
            "...#.........#...",
            "....##.....##....",
            "......#####......",
        ]
    );
}

#[test]
fn s038_circle_centre_offset() {
    let mut random = Random::new(38);
    for radius in 0..60 {
        let (dx, dy) = random.pixel(-1_000_000_000..1_000_000_000);
        let moved: Vec<_> = circle((0, 0), radius).map(|(x, y)| (x + dx, y + dy)).collect();
        assert_eq!(circle((dx, dy), radius).collect::<Vec<_>>(), moved);
    }
}
