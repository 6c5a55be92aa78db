//! The seed checklist's aliased polygons: rows 13 and 39 to 43.

use std::collections::BTreeSet;

use rastrum::raster::line::outline;
use rastrum::raster::polygon::{self, Polygon};
use rastrum::raster::triangulate::triangulate;
use rastrum::{FillRule, IntRect, Point};

use crate::oracle::polygon::{self as oracle, Vertex, grid, to_point};
use crate::oracle::{Pixel, Random, picture, spans};

const SIZE: i32 = 32;
const CLIP: IntRect = IntRect::from_ltrb(0, 0, SIZE, SIZE);

/// The pixels that the library fills.
fn filled(contours: &[&[Vertex]], rule: FillRule) -> BTreeSet<Pixel> {
    let mut polygon = Polygon::new();
    for contour in contours {
        polygon.add(&contour.iter().copied().map(to_point).collect::<Vec<Point>>());
    }
    spans(|span| polygon.fill(rule, CLIP, span))
}

/// A vertex in and around the grid: anywhere, or (half of the time) on a corner or centre of a pixel, where
/// the ties are.
fn vertex(random: &mut Random) -> Vertex {
    let step = [1, 1, 128, 256][random.within(0..4) as usize];
    let mut coordinate = || random.within(-2 * 256..(i64::from(SIZE) + 2) * 256).div_euclid(step) * step;
    (coordinate(), coordinate())
}

fn triangle(random: &mut Random) -> [Vertex; 3] {
    [vertex(random), vertex(random), vertex(random)]
}

/// A star of five points with its notches as corners of their own, in pixels.
const STAR: [(i64, i64); 10] =
    [(16, 1), (20, 12), (31, 12), (22, 19), (26, 30), (16, 23), (6, 30), (10, 19), (1, 12), (12, 12)];

#[test]
fn s013_polygons_to_triangles() {
    let check = |contour: &[Vertex]| {
        let points: Vec<Point> = contour.iter().copied().map(to_point).collect();
        let mut union = BTreeSet::new();
        for corners in triangulate(&points) {
            let piece = filled(&[&corners.map(|i| contour[i as usize])], FillRule::NonZero);
            assert!(union.is_disjoint(&piece), "triangles overlap in {contour:?}");
            union.extend(piece);
        }
        assert_eq!(union, filled(&[contour], FillRule::EvenOdd), "{contour:?}");
    };
    check(&STAR.map(|(x, y)| (x * 256, y * 256)));
    check(&STAR.map(|(x, y)| (x * 256 + 128, y * 256 + 128)));
    // Outlines that cannot cross themselves: one chain from left to right, another below it back.
    let mut random = Random::new(13);
    for _ in 0..300 {
        let columns = random.within(2..12);
        let width = i64::from(SIZE) * 256 / columns;
        let step = [1, 128, 256][random.within(0..3) as usize];
        let mut upper = Vec::new();
        let mut lower = Vec::new();
        for i in 0..columns {
            let x = i * width / step * step;
            let middle = i64::from(SIZE) * 128;
            upper.push((x, random.within(0..middle) / step * step));
            lower.push((x, (middle + 256 + random.within(0..middle - 256)) / step * step));
        }
        upper.extend(lower.into_iter().rev());
        check(&upper);
        let transposed: Vec<_> = upper.iter().map(|&(x, y)| (y, x)).collect();
        check(&transposed);
    }
}

#[test]
fn s039_scanline_fill() {
    let star = STAR.map(|(x, y)| (x * 256, y * 256));
    assert_eq!(filled(&[&star], FillRule::EvenOdd), in_polygon(&[&star], FillRule::EvenOdd));
    // Pairs of crossings: below the notch at (16, 23) every row of the star has four, hence two spans. In row 1
    // the tip is too thin to hold a centre.
    let points = star.map(to_point);
    let mut rows = vec![0; SIZE as usize];
    polygon::fill(&points, FillRule::EvenOdd, CLIP, |y, _| rows[y as usize] += 1);
    assert_eq!(rows[1..30], [[0].as_slice(), &[1; 21], &[2; 7]].concat());

    let mut random = Random::new(39);
    for corners in (3..13).cycle().take(400) {
        let first: Vec<_> = (0..corners).map(|_| vertex(&mut random)).collect();
        let second = triangle(&mut random);
        for contours in [&[first.as_slice()][..], &[&first, &second]] {
            for rule in [FillRule::EvenOdd, FillRule::NonZero] {
                assert_eq!(filled(contours, rule), in_polygon(contours, rule), "{rule:?} {contours:?}");
            }
        }
    }
}

fn in_polygon(contours: &[&[Vertex]], rule: FillRule) -> BTreeSet<Pixel> {
    grid(SIZE).filter(|&pixel| oracle::inside(contours, rule, pixel)).collect()
}

#[test]
fn s040_edge_flip() {
    let mut random = Random::new(40);
    for corners in (3..13).cycle().take(300) {
        let contour: Vec<_> = (0..corners).map(|_| vertex(&mut random)).collect();
        assert_eq!(filled(&[&contour], FillRule::EvenOdd), oracle::edge_flip(&contour, SIZE), "{contour:?}");
    }
}

#[test]
fn s041_leftmost_and_rightmost() {
    let mut random = Random::new(41);
    for _ in 0..2000 {
        let triangle = triangle(&mut random);
        let expected = oracle::edge_functions(triangle, SIZE);
        assert_eq!(oracle::leftmost_rightmost(triangle, SIZE), expected, "{triangle:?}");
        assert_eq!(filled(&[&triangle], FillRule::NonZero), expected, "{triangle:?}");
    }
}

#[test]
fn s042_flat_top_and_flat_bottom() {
    let mut random = Random::new(42);
    let mut pixels = 0;
    for _ in 0..10_000 {
        let triangle = triangle(&mut random);
        let expected = oracle::edge_functions(triangle, SIZE);
        assert_eq!(oracle::flat_split(triangle, SIZE), expected, "{triangle:?}");
        assert_eq!(filled(&[&triangle], FillRule::NonZero), expected, "{triangle:?}");
        pixels += expected.len();
    }
    assert!(pixels > 500_000, "hardly any triangle covers a pixel");
}

#[test]
fn s043_outline_and_interior() {
    let draw = |corners: &[Pixel]| spans(|span| polygon::fill_with_outline(corners, FillRule::NonZero, CLIP, span));
    assert_eq!(
        picture(&draw(&[(0, 0), (12, 3), (4, 9), (5, 4)]), 13),
        [
            "###..........",
            ".######......",
            "..#########..",
            "....#########",
            ".....#######.",
            ".....######..",
            ".....####....",
            "....####.....",
            "....###......",
            "....#........",
        ]
    );
    let mut random = Random::new(43);
    for corners in (1..7).cycle().take(600) {
        let corners: Vec<_> = (0..corners).map(|_| random.pixel(-6..i64::from(SIZE) + 6)).collect();
        let drawn = draw(&corners);
        let border: BTreeSet<_> = outline(&corners).clipped(CLIP).collect();
        assert!(border.is_subset(&drawn), "{corners:?}");
        // What is neither outline nor inside is not drawn; what is inside leaves no hole.
        let centers: Vec<_> =
            corners.iter().map(|&(x, y)| (i64::from(x) * 256 + 128, i64::from(y) * 256 + 128)).collect();
        assert_eq!(drawn, &border | &in_polygon(&[&centers], FillRule::NonZero), "{corners:?}");
        if corners.len() == 3 {
            // A triangle's outside is of one piece: whoever goes around it gets everywhere.
            let mut outside = BTreeSet::new();
            let mut todo = vec![(-1, -1)];
            while let Some((x, y)) = todo.pop() {
                let here = (-1..=SIZE).contains(&x) && (-1..=SIZE).contains(&y) && !drawn.contains(&(x, y));
                if here && outside.insert((x, y)) {
                    todo.extend([(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]);
                }
            }
            assert_eq!(outside.len() + drawn.len(), ((SIZE + 2) * (SIZE + 2)) as usize, "{corners:?}");
        }
    }
}
