//! A quick proof that outlines neither cross nor touch, themselves or each other, and wind around what is inside once: that of
//! letters, rings, and most of what is drawn.
//!
//! Edges are compared by their boxes, eight at a time; only of those whose boxes meet is it asked whether they do. Then each
//! outline is a simple polygon, and how often they wind follows from which lie in which. Where outlines are many or long, or touch,
//! the proof is not found, and a sweep looks closer ([`simple`](super::simple)).

use fearless_simd::i32x8;
use fearless_simd::prelude::*;

use super::batch::coordinates;
use super::edge::FixedPoint;
use crate::num::lanes::{max_i32, min_i32};

/// Outlines of more corners are not looked at: comparisons grow with their square.
const MOST_CORNERS: usize = 384;
/// So many of them at most.
const MOST_OUTLINES: usize = 32;
/// A sweep is quicker over what goes down and up so few times.
const FEW_TURNS: usize = 5;
/// Nor those with corners further out: sums of products of distances must fit 64 bits.
const FARTHEST: u32 = 1 << 24;

/// Boxes of up to eight edges that follow each other. Where there are fewer, the others are empty.
#[derive(Clone, Copy, Debug)]
struct Eight {
    left: [i32; 8],
    top: [i32; 8],
    right: [i32; 8],
    bottom: [i32; 8],
    around: Bounds,
    /// The first edge: from that corner to the next.
    first: usize,
    /// The first and the last edge of their outline, which meet as well.
    ends: (usize, usize),
    /// Whether all go the same way across and the same way down, and so do not meet each other. Not known of fewer than eight.
    is_monotone: bool,
}

/// A box with its sides.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    left: i32,
    top: i32,
    right: i32,
    bottom: i32,
}

/// An outline whose edges are listed.
#[derive(Clone, Copy, Debug)]
struct Outline {
    bounds: Bounds,
    /// Its corners, the first one once more at the end.
    first: usize,
    last: usize,
    clockwise: bool,
}

/// The proof's working memory.
#[derive(Debug, Default)]
pub(super) struct Apart {
    corners: Vec<FixedPoint>,
    eights: Vec<Eight>,
    outlines: Vec<Outline>,
}

impl Apart {
    /// Whether closed outlines are simple polygons that do not touch, and wind once around all that is inside, all the same way.
    /// False where that is not found out. Each outline's last corner is its first; `ends` says where they end.
    #[inline(always)]
    pub(super) fn wind_once<S: Simd>(&mut self, simd: S, points: &[FixedPoint], ends: &[usize]) -> bool {
        if points.len() > MOST_CORNERS || ends.len() > MOST_OUTLINES {
            return false;
        }
        self.corners.clear();
        self.eights.clear();
        self.outlines.clear();
        let mut start = 0;
        for end in ends {
            if !self.list(simd, points.get(start..*end).unwrap_or(&[])) {
                return false;
            }
            start = *end;
        }
        self.are_apart(simd) && self.alternate()
    }

    /// Lists the edges of an outline; false if it lies too far out.
    #[inline(always)]
    fn list<S: Simd>(&mut self, simd: S, points: &[FixedPoint]) -> bool {
        let Some(origin) = points.first() else { return true };
        let mut far = false;
        for point in points {
            far |= point.x.unsigned_abs() > FARTHEST || point.y.unsigned_abs() > FARTHEST;
        }
        if far {
            return false;
        }
        let first = self.corners.len();
        let mut area = 0_i64;
        let mut before = *origin;
        self.corners.push(before);
        for point in points {
            if *point != before {
                area += cross(*origin, before, *point);
                self.corners.push(*point);
                before = *point;
            }
        }
        let last = self.corners.len() - 1;
        if last == first {
            self.corners.truncate(first);
            return true;
        }
        // There and back again covers nothing, but may cross others.
        if last - first < 3 {
            return false;
        }
        let mut bounds = Bounds::EMPTY;
        let corners = self.corners.get(first..).unwrap_or(&[]);
        for (index, edges) in (first..).step_by(8).zip(corners.windows(9).step_by(8).chain(rest_of(corners))) {
            let eight = match edges.first_chunk::<9>() {
                Some(edges) => Eight::whole(simd, edges, index, (first, last - 1)),
                None => Eight::new(edges, index, (first, last - 1)),
            };
            bounds = bounds.with(eight.around);
            self.eights.push(eight);
        }
        self.outlines.push(Outline { bounds, first, last, clockwise: area > 0 });
        area != 0
    }

    /// Whether no two edges meet but those that follow each other, and these in their corner alone.
    #[inline(always)]
    fn are_apart<S: Simd>(&self, simd: S) -> bool {
        let Self { corners, eights, .. } = self;
        for (index, own) in eights.iter().enumerate() {
            for (distance, others) in eights.get(index..).unwrap_or(&[]).iter().enumerate() {
                if distance == 0 && own.is_monotone || !own.around.meets(others.around) {
                    continue;
                }
                let mut lanes = own.near(simd, others.around);
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    let mut near = others.near(simd, own.bounds(lane));
                    // Edges that follow each other meet in their corner. If one went back along the other, it would end on it, or pass
                    // over its start: then it meets the edge after or before the two.
                    if distance == 0 {
                        near &= !3 << lane;
                    } else if distance == 1 && lane == 7 && own.ends == others.ends {
                        near &= !1;
                    }
                    while near != 0 {
                        let (edge, other) = (own.first + lane, others.first + near.trailing_zeros() as usize);
                        near &= near - 1;
                        if (edge, other) != own.ends && meet(corners, edge, other) {
                            return false;
                        }
                    }
                }
            }
        }
        true
    }

    /// Whether outlines that lie in each other go round by turns, the outermost all the same way.
    #[inline(always)]
    fn alternate(&self) -> bool {
        let Self { corners, outlines, .. } = self;
        let mut way = None;
        outlines.iter().enumerate().all(|(index, outline)| {
            let Some(corner) = corners.get(outline.first) else { return false };
            let around = |other: &Outline| {
                other.bounds.holds(*corner) && contains(corners.get(other.first..=other.last).unwrap_or(&[]), *corner)
            };
            let depth =
                outlines.iter().enumerate().filter(|(other, outline)| *other != index && around(outline)).count();
            let outermost = outline.clockwise == depth.is_multiple_of(2);
            *way.get_or_insert(outermost) == outermost
        })
    }
}

/// How often outlines in a row begin to go up or down.
#[inline(always)]
fn turns(points: &[FixedPoint]) -> usize {
    let (mut turns, mut direction) = (0, false);
    for pair in points.windows(2) {
        let [a, b] = pair else { break };
        let down = if a.y == b.y { direction } else { a.y < b.y };
        turns += usize::from(down != direction);
        direction = down;
    }
    turns
}

/// Whether to look for the proof here first.
#[inline(always)]
pub(super) fn is_quicker(points: &[FixedPoint]) -> bool {
    points.len() <= MOST_CORNERS && turns(points) > FEW_TURNS
}

/// What is left of corners after windows of nine.
#[inline(always)]
fn rest_of(corners: &[FixedPoint]) -> Option<&[FixedPoint]> {
    let rest = corners.get((corners.len() - 1) / 8 * 8..)?;
    (rest.len() > 1).then_some(rest)
}

impl Eight {
    /// Those between `corners`, at most nine, of which the first is number `first`.
    #[inline(always)]
    fn new(corners: &[FixedPoint], first: usize, ends: (usize, usize)) -> Self {
        let mut eight = Self {
            left: [i32::MAX; 8],
            top: [i32::MAX; 8],
            right: [i32::MIN; 8],
            bottom: [i32::MIN; 8],
            around: Bounds::EMPTY,
            first,
            ends,
            is_monotone: false,
        };
        let Self { left, top, right, bottom, around, .. } = &mut eight;
        let sides = left.iter_mut().zip(top).zip(right.iter_mut().zip(bottom));
        for (pair, ((left, top), (right, bottom))) in corners.windows(2).zip(sides) {
            let [a, b] = pair else { break };
            (*left, *right) = if a.x < b.x { (a.x, b.x) } else { (b.x, a.x) };
            (*top, *bottom) = if a.y < b.y { (a.y, b.y) } else { (b.y, a.y) };
            *around = around.with(Bounds { left: *left, top: *top, right: *right, bottom: *bottom });
        }
        eight
    }

    /// Those between nine corners.
    #[inline(always)]
    fn whole<S: Simd>(simd: S, corners: &[FixedPoint; 9], first: usize, ends: (usize, usize)) -> Self {
        let [start @ .., _] = corners;
        let [_, end @ ..] = corners;
        let ((from_x, from_y), (to_x, to_y)) = (coordinates(simd, start), coordinates(simd, end));
        let (left, right) = (min_i32(from_x, to_x), max_i32(from_x, to_x));
        let (top, bottom) = (min_i32(from_y, to_y), max_i32(from_y, to_y));
        let same = |a: i32x8<S>, b: i32x8<S>| matches!(a.simd_ge(b).to_bitmask() as u32, 0 | 0xff);
        let is_monotone = same(to_x, from_x) && same(to_y, from_y);
        let (left, right, top, bottom) = (left.to_array(), right.to_array(), top.to_array(), bottom.to_array());
        let least = |[a, b, c, d, e, f, g, h]: [i32; 8]| a.min(b).min(c.min(d)).min(e.min(f).min(g.min(h)));
        let greatest = |[a, b, c, d, e, f, g, h]: [i32; 8]| a.max(b).max(c.max(d)).max(e.max(f).max(g.max(h)));
        let around = Bounds { left: least(left), top: least(top), right: greatest(right), bottom: greatest(bottom) };
        Self { left, top, right, bottom, around, first, ends, is_monotone }
    }

    /// The box of edge `lane`.
    #[inline(always)]
    fn bounds(&self, lane: usize) -> Bounds {
        let at = |lanes: &[i32; 8]| lanes.get(lane).copied().unwrap_or(0);
        Bounds { left: at(&self.left), top: at(&self.top), right: at(&self.right), bottom: at(&self.bottom) }
    }

    /// Which edges have a box that meets another, as bits.
    #[inline(always)]
    fn near<S: Simd>(&self, simd: S, other: Bounds) -> u32 {
        let splat = |v: i32| i32x8::splat(simd, v);
        let load = |lanes: &[i32; 8]| i32x8::load_array_ref(simd, lanes);
        let apart = splat(other.left).simd_gt(load(&self.right))
            | load(&self.left).simd_gt(splat(other.right))
            | splat(other.top).simd_gt(load(&self.bottom))
            | load(&self.top).simd_gt(splat(other.bottom));
        !(apart.to_bitmask() as u32) & 0xff
    }
}

impl Bounds {
    const EMPTY: Self = Self { left: i32::MAX, top: i32::MAX, right: i32::MIN, bottom: i32::MIN };

    #[inline(always)]
    fn with(self, other: Self) -> Self {
        Self {
            left: self.left.min(other.left),
            top: self.top.min(other.top),
            right: self.right.max(other.right),
            bottom: self.bottom.max(other.bottom),
        }
    }

    #[inline(always)]
    fn meets(self, other: Self) -> bool {
        self.left <= other.right && other.left <= self.right && self.top <= other.bottom && other.top <= self.bottom
    }

    #[inline(always)]
    fn holds(self, point: FixedPoint) -> bool {
        self.meets(Self { left: point.x, top: point.y, right: point.x, bottom: point.y })
    }
}

/// Above 0 where the way from `a` by `b` to `c` turns clockwise on the canvas.
#[inline(always)]
fn cross(a: FixedPoint, b: FixedPoint, c: FixedPoint) -> i64 {
    let [bx, by, cx, cy] = [b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y].map(i64::from);
    bx * cy - by * cx
}

/// Whether two edges have a point in common, or lie on one line.
#[inline(always)]
fn meet(corners: &[FixedPoint], edge: usize, other: usize) -> bool {
    let ends_of = |edge: usize| corners.get(edge..).and_then(|rest| rest.first_chunk::<2>());
    let (Some([a, b]), Some([c, d])) = (ends_of(edge), ends_of(other)) else { return true };
    let one_side = |a, b, c, d| {
        let (c, d) = (cross(a, b, c), cross(a, b, d));
        c > 0 && d > 0 || c < 0 && d < 0
    };
    !(one_side(*a, *b, *c, *d) || one_side(*c, *d, *a, *b))
}

/// Whether a point that is not on a closed outline lies inside of it.
fn contains(outline: &[FixedPoint], point: FixedPoint) -> bool {
    let mut inside = false;
    for pair in outline.windows(2) {
        let [a, b] = pair else { break };
        if (a.y <= point.y) != (b.y <= point.y) {
            let (upper, lower) = if a.y < b.y { (*a, *b) } else { (*b, *a) };
            inside ^= cross(upper, lower, point) > 0;
        }
    }
    inside
}
