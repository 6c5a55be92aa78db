//! Rectangles: one of real numbers, one of whole pixels.

use super::Point;
use crate::num::fixed;

/// An axis-aligned rectangle. A rectangle whose edges are swapped (negative width or height) covers
/// the same area as the swapped one; one with a non-finite edge covers nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rect {
    /// The edge at the smaller x.
    pub left: f32,
    /// The edge at the smaller y.
    pub top: f32,
    /// The edge at the larger x.
    pub right: f32,
    /// The edge at the larger y.
    pub bottom: f32,
}

impl Rect {
    /// The rectangle with the given edges.
    pub const fn from_ltrb(left: f32, top: f32, right: f32, bottom: f32) -> Self {
        Self { left, top, right, bottom }
    }

    /// The rectangle at (x, y) with the given width and height.
    pub const fn from_xywh(x: f32, y: f32, width: f32, height: f32) -> Self {
        Self { left: x, top: y, right: x + width, bottom: y + height }
    }

    /// The smallest rectangle that holds every point, or `None` for no point or a non-finite one.
    pub fn from_points(points: &[Point]) -> Option<Self> {
        let first = points.first()?;
        // Four points at a time, lane by lane: compilers make vectors of it.
        let start = [first.x, first.y, first.x, first.y, first.x, first.y, first.x, first.y];
        let (mut low, mut high, mut finite) = (start, start, [0.0; 8]);
        let mut add = |block: [f32; 8]| {
            for (((low, high), finite), v) in low.iter_mut().zip(&mut high).zip(&mut finite).zip(block) {
                *low = if v < *low { v } else { *low };
                *high = if v > *high { v } else { *high };
                *finite += v * 0.0;
            }
        };
        let (blocks, rest) = points.as_chunks::<4>();
        for block in blocks {
            add(bytemuck::cast(*block));
        }
        let mut last = [*first; 4];
        for (last, p) in last.iter_mut().zip(rest) {
            *last = *p;
        }
        add(bytemuck::cast(last));
        let [mut rect, others @ ..]: [Self; 4] = std::array::from_fn(|i| {
            let at = |lanes: &[f32; 8], lane: usize| lanes.get(lane).copied().unwrap_or(0.0);
            Self::from_ltrb(at(&low, 2 * i), at(&low, 2 * i + 1), at(&high, 2 * i), at(&high, 2 * i + 1))
        });
        for other in others {
            rect = rect.union(other);
        }
        (finite == [0.0; 8]).then_some(rect)
    }

    /// Right minus left.
    pub fn width(self) -> f32 {
        self.right - self.left
    }

    /// Bottom minus top.
    pub fn height(self) -> f32 {
        self.bottom - self.top
    }

    /// The point in the middle.
    pub fn center(self) -> Point {
        Point::new(self.left * 0.5 + self.right * 0.5, self.top * 0.5 + self.bottom * 0.5)
    }

    /// Whether all four edges are finite.
    pub fn is_finite(self) -> bool {
        self.left.is_finite() && self.top.is_finite() && self.right.is_finite() && self.bottom.is_finite()
    }

    /// The same area with left ≤ right and top ≤ bottom.
    #[must_use]
    pub fn normalized(self) -> Self {
        let (left, right) = if self.left <= self.right { (self.left, self.right) } else { (self.right, self.left) };
        let (top, bottom) = if self.top <= self.bottom { (self.top, self.bottom) } else { (self.bottom, self.top) };
        Self { left, top, right, bottom }
    }

    /// The corners, clockwise on the canvas from the top left.
    pub fn corners(self) -> [Point; 4] {
        [
            Point::new(self.left, self.top),
            Point::new(self.right, self.top),
            Point::new(self.right, self.bottom),
            Point::new(self.left, self.bottom),
        ]
    }

    /// This rectangle grown by `amount` on each side (shrunk, if negative).
    #[must_use]
    pub fn outset(self, amount: f32) -> Self {
        Self::from_ltrb(self.left - amount, self.top - amount, self.right + amount, self.bottom + amount)
    }

    /// The smallest rectangle that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let min = |a: f32, b: f32| if a < b { a } else { b };
        let max = |a: f32, b: f32| if a > b { a } else { b };
        Self {
            left: min(self.left, other.left),
            top: min(self.top, other.top),
            right: max(self.right, other.right),
            bottom: max(self.bottom, other.bottom),
        }
    }

    /// The smallest rectangle of whole pixels that holds this one; edges beyond ±2^30 stop there. Empty
    /// if an edge is not a number.
    pub fn round_out(self) -> IntRect {
        if self.left.is_nan() || self.top.is_nan() || self.right.is_nan() || self.bottom.is_nan() {
            return IntRect::EMPTY;
        }
        let limit = 1_073_741_824.0_f32;
        // Without the instruction set for it, `floor` and `ceil` are calls.
        let low = |v: f32| {
            let v = v.clamp(-limit, limit);
            v as i32 - i32::from((v as i32) as f32 > v)
        };
        let high = |v: f32| -low(-v);
        IntRect { left: low(self.left), top: low(self.top), right: high(self.right), bottom: high(self.bottom) }
    }
}

/// A rectangle in 1/256 device pixel. Empty where an edge is not below its opposite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FixedRect {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) right: i32,
    pub(crate) bottom: i32,
}

impl FixedRect {
    /// A finite rectangle with left ≤ right and top ≤ bottom, each edge rounded to nearest; edges beyond the range of
    /// fixed point stop there.
    #[inline(always)]
    pub(crate) fn new(rect: Rect) -> Self {
        let fixed = |v: f32| fixed::from_f32(v.clamp(-fixed::LIMIT, fixed::LIMIT));
        Self { left: fixed(rect.left), top: fixed(rect.top), right: fixed(rect.right), bottom: fixed(rect.bottom) }
    }

    /// A rectangle of whole pixels within ±2^23.
    pub(crate) fn of_pixels(pixels: IntRect) -> Self {
        Self {
            left: pixels.left << fixed::SHIFT,
            top: pixels.top << fixed::SHIFT,
            right: pixels.right << fixed::SHIFT,
            bottom: pixels.bottom << fixed::SHIFT,
        }
    }

    /// The part inside of `pixels`, which must lie within ±2^23.
    pub(crate) fn intersect(self, pixels: IntRect) -> Self {
        Self {
            left: self.left.max(pixels.left << fixed::SHIFT),
            top: self.top.max(pixels.top << fixed::SHIFT),
            right: self.right.min(pixels.right << fixed::SHIFT),
            bottom: self.bottom.min(pixels.bottom << fixed::SHIFT),
        }
    }

    /// The pixels that it touches.
    #[inline(always)]
    pub(crate) fn pixels(self) -> IntRect {
        let up = |v: i32| (v + fixed::ONE - 1) >> fixed::SHIFT;
        IntRect::from_ltrb(self.left >> fixed::SHIFT, self.top >> fixed::SHIFT, up(self.right), up(self.bottom))
    }

    /// The pixels that it covers whole.
    pub(crate) fn whole_pixels(self) -> IntRect {
        let up = |v: i32| (v + fixed::ONE - 1) >> fixed::SHIFT;
        IntRect::from_ltrb(up(self.left), up(self.top), self.right >> fixed::SHIFT, self.bottom >> fixed::SHIFT)
    }

    /// The same rectangle moved by whole pixels.
    pub(crate) fn moved(self, dx: i32, dy: i32) -> Self {
        let (dx, dy) = (dx << fixed::SHIFT, dy << fixed::SHIFT);
        Self { left: self.left + dx, top: self.top + dy, right: self.right + dx, bottom: self.bottom + dy }
    }

    /// The same rectangle in pixels.
    pub(crate) fn to_rect(self) -> Rect {
        let pixels = |v: i32| v as f32 / fixed::ONE as f32;
        Rect::from_ltrb(pixels(self.left), pixels(self.top), pixels(self.right), pixels(self.bottom))
    }
}

/// A rectangle of whole pixels: `left ≤ x < right`, `top ≤ y < bottom`. Empty where an edge is not
/// below its opposite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct IntRect {
    /// The first column.
    pub left: i32,
    /// The first row.
    pub top: i32,
    /// One past the last column.
    pub right: i32,
    /// One past the last row.
    pub bottom: i32,
}

impl IntRect {
    /// A rectangle without pixels.
    pub const EMPTY: Self = Self { left: 0, top: 0, right: 0, bottom: 0 };

    /// The rectangle with the given edges.
    pub const fn from_ltrb(left: i32, top: i32, right: i32, bottom: i32) -> Self {
        Self { left, top, right, bottom }
    }

    /// The rectangle at (x, y) with the given size; edges saturate at the ends of `i32`.
    pub fn from_xywh(x: i32, y: i32, width: u32, height: u32) -> Self {
        Self { left: x, top: y, right: x.saturating_add_unsigned(width), bottom: y.saturating_add_unsigned(height) }
    }

    /// Whether it holds no pixel.
    pub fn is_empty(self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }

    /// The number of columns; 0 where empty.
    pub fn width(self) -> u32 {
        if self.is_empty() { 0 } else { self.right.abs_diff(self.left) }
    }

    /// The number of rows; 0 where empty.
    pub fn height(self) -> u32 {
        if self.is_empty() { 0 } else { self.bottom.abs_diff(self.top) }
    }

    /// The pixels in both; [`IntRect::EMPTY`] where there are none.
    #[must_use]
    pub fn intersect(self, other: Self) -> Self {
        let rect = Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        };
        if rect.is_empty() { Self::EMPTY } else { rect }
    }

    /// Whether every pixel of `other` is in this rectangle.
    pub fn contains(self, other: Self) -> bool {
        other.is_empty()
            || (self.left <= other.left
                && self.top <= other.top
                && self.right >= other.right
                && self.bottom >= other.bottom)
    }

    /// The same rectangle in real numbers.
    pub fn to_rect(self) -> Rect {
        Rect::from_ltrb(self.left as f32, self.top as f32, self.right as f32, self.bottom as f32)
    }
}
