//! The pictures that pass between primitives: transparent but for a rectangle of pixels.

use crate::color::{demultiply_u8, premultiply_u8};
use crate::error::Result;
use crate::geom::IntRect;
use crate::num::level::SimdLevel;
use crate::pool;
use crate::surface::Pixmap;

/// How to compute: none of it changes a pixel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Work {
    pub(crate) threads: usize,
    pub(crate) level: SimdLevel,
}

/// Premultiplied RGBA8 pixels in `bounds`, rows top down; transparent elsewhere.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Image {
    bounds: IntRect,
    data: Vec<u8>,
}

/// Jobs of fewer pixels than this are not worth a thread of their own.
const PIXELS_PER_JOB: usize = 1 << 14;

impl Image {
    pub(crate) fn empty() -> Self {
        Self { bounds: IntRect::EMPTY, data: Vec::new() }
    }

    /// A transparent picture with memory for `bounds`.
    pub(super) fn new(bounds: IntRect) -> Result<Self> {
        if bounds.is_empty() {
            return Ok(Self::empty());
        }
        Ok(Self { bounds, data: Pixmap::new(bounds.width(), bounds.height())?.into_vec() })
    }

    /// The pixels of a pixmap whose top left corner lies at (x, y).
    pub(crate) fn from_pixmap(pixmap: Pixmap, x: i32, y: i32) -> Self {
        let bounds = IntRect::from_xywh(x, y, pixmap.width(), pixmap.height());
        Self { bounds, data: pixmap.into_vec() }
    }

    /// The pixels; `None` if there are none.
    pub(crate) fn into_pixmap(self) -> Option<Pixmap> {
        Pixmap::from_vec(self.bounds.width(), self.bounds.height(), self.data).ok()
    }

    /// The pixels that may be other than transparent.
    pub(crate) fn bounds(&self) -> IntRect {
        self.bounds
    }

    pub(super) fn pixels(&self) -> &[[u8; 4]] {
        self.data.as_chunks().0
    }

    pub(super) fn pixels_mut(&mut self) -> &mut [[u8; 4]] {
        self.data.as_chunks_mut().0
    }

    /// The pixels of row `y`, from the left side of the bounds on; none outside.
    pub(super) fn row(&self, y: i32) -> &[[u8; 4]] {
        let width = self.bounds.width() as usize;
        let Some(row) = y.checked_sub(self.bounds.top).and_then(|row| usize::try_from(row).ok()) else { return &[] };
        self.pixels().get(row * width..(row + 1) * width).unwrap_or(&[])
    }

    /// The pixels of row `y` in the columns `left..right`, those that exist, and the column of the first.
    pub(super) fn part(&self, y: i32, left: i32, right: i32) -> (i32, &[[u8; 4]]) {
        let start = left.max(self.bounds.left);
        let end = right.min(self.bounds.right).max(start);
        let at = |x: i32| x.abs_diff(self.bounds.left) as usize;
        (start, self.row(y).get(at(start)..at(end)).unwrap_or(&[]))
    }

    /// Calls `f` with the number of each row and its pixels, on several threads where that pays.
    pub(super) fn for_rows(&mut self, work: Work, f: impl Fn(i32, &mut [[u8; 4]]) + Sync) {
        self.for_rows_of(self.bounds, work, f);
    }

    /// The same with the rows of `band` alone, which the picture has.
    pub(super) fn for_rows_of(&mut self, band: IntRect, work: Work, f: impl Fn(i32, &mut [[u8; 4]]) + Sync) {
        let (bounds, width) = (self.bounds, self.bounds.width() as usize);
        if width == 0 {
            return;
        }
        let rows = PIXELS_PER_JOB.div_ceil(width);
        let first = band.top.abs_diff(bounds.top) as usize * width;
        let pixels = self.pixels_mut().get_mut(first..first + band.height() as usize * width).unwrap_or(&mut []);
        let jobs: Vec<_> = pixels.chunks_mut(width * rows).enumerate().collect();
        pool::for_each(work.threads, jobs, |(job, pixels)| {
            let first = band.top + (job * rows) as i32;
            for (y, row) in (first..).zip(pixels.chunks_mut(width)) {
                f(y, row);
            }
        });
    }

    /// Calls `f` with all pixels, a part at a time.
    pub(super) fn for_pixels(&mut self, work: Work, f: impl Fn(&mut [[u8; 4]]) + Sync) {
        self.for_rows(work, |_, row| f(row));
    }

    /// The same picture with exactly the pixels of `area`.
    pub(super) fn crop(&self, area: IntRect) -> Result<Self> {
        let mut out = Self::new(area)?;
        out.copy_from(self, 0, 0);
        Ok(out)
    }

    /// Copies `source`, moved by (dx, dy), over the pixels.
    pub(super) fn copy_from(&mut self, source: &Self, dx: i32, dy: i32) {
        let bounds = self.bounds;
        let from = moved(source.bounds, dx, dy).intersect(bounds);
        let width = bounds.width() as usize;
        for y in from.top..from.bottom {
            let (start, pixels) = source.part(y - dy, from.left - dx, from.right - dx);
            let at = y.abs_diff(bounds.top) as usize * width + (start + dx).abs_diff(bounds.left) as usize;
            if let Some(target) = self.pixels_mut().get_mut(at..at + pixels.len()) {
                target.copy_from_slice(pixels);
            }
        }
    }

    /// Without what lies outside `area`. It takes no memory: rows move up within the picture's own.
    pub(super) fn within(mut self, area: IntRect) -> Self {
        let (from, to) = (self.bounds, self.bounds.intersect(area));
        if to == from {
            return self;
        }
        if to.is_empty() {
            return Self::empty();
        }
        let (width, stride) = (to.width() as usize, from.width() as usize);
        let first = to.top.abs_diff(from.top) as usize * stride + to.left.abs_diff(from.left) as usize;
        let rows = to.height() as usize;
        for row in 0..rows {
            let (source, target) = (first + row * stride, row * width);
            if let Some(pixels) = self.pixels_mut().get_mut(target..source + width) {
                pixels.copy_within(source - target.., 0);
            }
        }
        self.data.truncate(rows * width * 4);
        self.data.shrink_to_fit();
        self.bounds = to;
        self
    }

    /// The same picture with exactly the pixels of `bounds`; in its own memory, if it has these.
    pub(super) fn with_bounds(self, bounds: IntRect) -> Result<Self> {
        if self.bounds.contains(bounds) { Ok(self.within(bounds)) } else { self.crop(bounds) }
    }

    /// Moved by (dx, dy).
    pub(super) fn moved(self, dx: i32, dy: i32) -> Self {
        Self { bounds: moved(self.bounds, dx, dy), ..self }
    }

    /// Applies a function of straight pixels to each pixel.
    pub(super) fn map_straight(&mut self, work: Work, f: impl Fn([u8; 4]) -> [u8; 4] + Sync) {
        self.for_pixels(work, |pixels| {
            // Pictures have large areas of one colour.
            let mut last = ([0; 4], premultiply_u8(f([0; 4])));
            for pixel in pixels {
                if *pixel != last.0 {
                    last = (*pixel, premultiply_u8(f(demultiply_u8(*pixel))));
                }
                *pixel = last.1;
            }
        });
    }
}

/// `rect` moved by (dx, dy).
pub(super) fn moved(rect: IntRect, dx: i32, dy: i32) -> IntRect {
    if rect.is_empty() {
        return IntRect::EMPTY;
    }
    IntRect::from_ltrb(
        rect.left.saturating_add(dx),
        rect.top.saturating_add(dy),
        rect.right.saturating_add(dx),
        rect.bottom.saturating_add(dy),
    )
}

/// `rect` with so many pixels more before and after it, across and down.
pub(super) fn grown(rect: IntRect, (before_x, before_y): (i32, i32), (after_x, after_y): (i32, i32)) -> IntRect {
    if rect.is_empty() {
        return IntRect::EMPTY;
    }
    IntRect::from_ltrb(
        rect.left.saturating_sub(before_x),
        rect.top.saturating_sub(before_y),
        rect.right.saturating_add(after_x),
        rect.bottom.saturating_add(after_y),
    )
}

/// The smallest rectangle around both.
pub(super) fn union(a: IntRect, b: IntRect) -> IntRect {
    if a.is_empty() {
        return b;
    }
    if b.is_empty() {
        return a;
    }
    IntRect::from_ltrb(a.left.min(b.left), a.top.min(b.top), a.right.max(b.right), a.bottom.max(b.bottom))
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::filter) const WORK: Work = Work { threads: 2, level: SimdLevel::Scalar };

    /// A picture from rows of letters: `.` is transparent, `#` opaque white, a digit that many tenths of white.
    pub(in crate::filter) fn image(left: i32, top: i32, rows: &[&str]) -> Image {
        let bounds = IntRect::from_xywh(left, top, rows[0].len() as u32, rows.len() as u32);
        let mut image = Image::new(bounds).unwrap();
        let values = rows.iter().flat_map(|row| row.chars()).map(|c| match c {
            '.' => 0,
            '#' => 255,
            c => (c.to_digit(10).unwrap() * 255 / 10) as u8,
        });
        for (pixel, value) in image.pixels_mut().iter_mut().zip(values) {
            *pixel = [value; 4];
        }
        image
    }

    /// Alpha at (x, y).
    pub(in crate::filter) fn alpha(image: &Image, x: i32, y: i32) -> u8 {
        image.part(y, x, x + 1).1.first().map_or(0, |pixel| pixel[3])
    }

    /// Pixels of no pattern in `bounds`, valid as premultiplied ones.
    pub(in crate::filter) fn noise(bounds: IntRect, mut seed: u32) -> Image {
        let mut image = Image::new(bounds).unwrap();
        for pixel in image.pixels_mut() {
            *pixel = premultiply_u8([0; 4].map(|_: u8| {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (seed >> 24) as u8
            }));
        }
        image
    }

    #[test]
    fn cropping_pads_with_transparency() {
        let source = image(2, 3, &["12", "34"]);
        let out = source.crop(IntRect::from_ltrb(1, 4, 4, 6)).unwrap();
        assert_eq!(out, image(1, 4, &[".34", "..."]));
        assert_eq!(out.row(3), &[] as &[[u8; 4]]);
        assert_eq!(out.row(6), &[] as &[[u8; 4]]);
    }

    #[test]
    fn cutting_in_place_is_cropping() {
        let source = noise(IntRect::from_ltrb(-3, 5, 9, 14), 4);
        for area in [
            IntRect::from_ltrb(-3, 5, 9, 14),
            IntRect::from_ltrb(-20, -20, 50, 50),
            IntRect::from_ltrb(0, 6, 4, 9),
            IntRect::from_ltrb(-3, 13, 50, 14),
            IntRect::from_ltrb(8, 0, 9, 6),
            IntRect::from_ltrb(20, 20, 30, 30),
        ] {
            let inside = area.intersect(source.bounds());
            assert_eq!(source.clone().within(area), source.crop(inside).unwrap(), "{area:?}");
            assert_eq!(source.clone().with_bounds(area).unwrap(), source.crop(area).unwrap(), "{area:?}");
        }
    }

    #[test]
    fn copies_are_cut_at_both_pictures_sides() {
        let mut target = image(0, 0, &["...", "...", "..."]);
        target.copy_from(&image(0, 0, &["12", "34"]), 2, -1);
        assert_eq!(target, image(0, 0, &["..3", "...", "..."]));
    }
}
