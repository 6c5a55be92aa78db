//! Slow, obvious versions that the fast code is held against, and what the tests share to do so.

pub(crate) mod area;
pub(crate) mod circle;
pub(crate) mod line;
pub(crate) mod patch;
pub(crate) mod polygon;
pub(crate) mod rays;
pub(crate) mod spectrum;
pub(crate) mod triangle;

use std::collections::BTreeSet;
use std::ops::Range;

/// A pixel by its column and row.
pub(crate) type Pixel = (i32, i32);

/// The set of some pixels; panics on one that comes twice.
pub(crate) fn once(pixels: impl IntoIterator<Item = Pixel>) -> BTreeSet<Pixel> {
    let mut set = BTreeSet::new();
    for pixel in pixels {
        assert!(set.insert(pixel), "{pixel:?} comes twice");
    }
    set
}

/// The pixels of spans given to a callback, none of which may come twice.
pub(crate) fn spans(draw: impl FnOnce(&mut dyn FnMut(i32, Range<i32>))) -> BTreeSet<Pixel> {
    let mut pixels = Vec::new();
    draw(&mut |y, xs| pixels.extend(xs.map(|x| (x, y))));
    once(pixels)
}

/// Pixels as text, `#` for those in the set, from (0, 0); panics on one that falls outside.
pub(crate) fn picture<const H: usize>(pixels: &BTreeSet<Pixel>, width: usize) -> [String; H] {
    let mut rows = [const { String::new() }; H];
    for (y, row) in rows.iter_mut().enumerate() {
        *row = (0..width).map(|x| if pixels.contains(&(x as i32, y as i32)) { '#' } else { '.' }).collect();
    }
    let shown = rows.iter().map(|row| row.matches('#').count()).sum::<usize>();
    assert_eq!(shown, pixels.len(), "pixels outside the picture");
    rows
}

/// Random numbers that are the same on every machine and every run (splitmix64).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// 64 random bits.
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A whole number of the range, which is not empty.
    pub(crate) fn within(&mut self, range: Range<i64>) -> i64 {
        range.start + (self.bits() % (range.end - range.start) as u64) as i64
    }

    /// A pixel with both coordinates in the range.
    pub(crate) fn pixel(&mut self, range: Range<i64>) -> Pixel {
        (self.within(range.clone()) as i32, self.within(range) as i32)
    }
}
