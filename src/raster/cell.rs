//! Cells: signed area and cover of edges, accumulated eight rows at a time.
//!
//! The accumulation is the exact-area method that FreeType and AGG made known, laid out anew: a strip
//! is eight rows high, each pixel column of it is one vector whose lanes are the rows, and the sum along
//! x is one vector addition per column. Summed from the left, a pixel holds 2 · 256² = [`FULL`] times the area that
//! the edges added so far cover of it ([`kernel`](super::kernel)). What is added up are integers: the order of edges does
//! not matter.

use crate::style::FillRule;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH};

/// The accumulated value of a fully covered pixel.
pub(crate) const FULL: i32 = 1 << 17;

/// A column of a strip: one value per row.
pub(crate) type Column = [i32; BLOCK_HEIGHT];

/// Accumulators of the strips of one band.
#[derive(Debug, Default)]
pub(crate) struct Accumulator {
    /// Columns of strip after strip; zero between draws.
    columns: Vec<Column>,
    /// For each column which rows edges pass through. Kept for exact antialiasing only.
    marks: Vec<Marks>,
    /// One bit for each block of 16 columns that may hold values, strip after strip.
    occupied: Vec<u64>,
    /// Sums of more edges than `columns` can hold; empty but while a crowd of edges is added.
    wide: Vec<[i64; BLOCK_HEIGHT]>,
    /// Columns per strip: the band's, rounded up to blocks, and one block to spill into.
    stride: usize,
    /// Words of `occupied` per strip.
    words: usize,
}

impl Accumulator {
    /// Makes room for `strips` strips of `width` pixels. All values must be zero, as
    /// [`sweep`](super::sweep) leaves them.
    pub(crate) fn resize(&mut self, width: usize, strips: usize) {
        let blocks = width.div_ceil(BLOCK_WIDTH) + 1;
        self.stride = blocks * BLOCK_WIDTH;
        self.words = blocks.div_ceil(64);
        self.columns.resize(self.stride * strips, [0; BLOCK_HEIGHT]);
        self.marks.resize(self.stride * strips, Marks::default());
        self.occupied.resize(self.words * strips, 0);
    }

    /// Whether some block of strip `index` is occupied.
    pub(crate) fn is_occupied(&self, index: usize) -> bool {
        self.occupied
            .get(index * self.words..(index + 1) * self.words)
            .is_some_and(|words| words.iter().any(|word| *word != 0))
    }

    /// Moves all values to where there is room for any number of them.
    pub(super) fn set_aside(&mut self) {
        self.wide.resize(self.columns.len(), [0; BLOCK_HEIGHT]);
        for (wide, column) in self.wide.iter_mut().zip(&mut self.columns) {
            for (wide, value) in wide.iter_mut().zip(column) {
                *wide += i64::from(std::mem::take(value));
            }
        }
    }

    /// Brings them back, as values whose sums along x are those set aside, brought into the range in which the rule means
    /// the same. What was set aside stays until [`forget`](Self::forget).
    pub(super) fn bring_back(&mut self, rule: FillRule) {
        let full = i64::from(FULL);
        for (columns, wide) in self.columns.chunks_mut(self.stride.max(1)).zip(self.wide.chunks(self.stride.max(1))) {
            let (mut sum, mut before) = ([0_i64; BLOCK_HEIGHT], [0_i64; BLOCK_HEIGHT]);
            for (column, wide) in columns.iter_mut().zip(wide) {
                for (row, value) in column.iter_mut().enumerate() {
                    if let (Some(sum), Some(before), Some(wide)) =
                        (sum.get_mut(row), before.get_mut(row), wide.get(row))
                    {
                        *sum += wide;
                        let cut = match rule {
                            FillRule::NonZero => (*sum).clamp(-full, full),
                            FillRule::EvenOdd => sum.rem_euclid(2 * full),
                        };
                        *value = (cut - *before) as i32;
                        *before = cut;
                    }
                }
            }
        }
    }

    /// Drops what was set aside.
    pub(crate) fn forget(&mut self) {
        self.wide.clear();
    }

    /// The marks of a pixel's column.
    #[inline(always)]
    pub(super) fn marks(&mut self, pixel: BandPixel) -> Option<&mut Marks> {
        self.marks.get_mut(pixel.strip * self.stride..(pixel.strip + 1) * self.stride)?.get_mut(pixel.column)
    }

    /// The accumulator of strip `index`, or `None` past the last.
    #[inline(always)]
    pub(crate) fn strip(&mut self, index: usize) -> Option<StripCells<'_>> {
        Some(StripCells {
            columns: self.columns.get_mut(index * self.stride..(index + 1) * self.stride)?,
            marks: self.marks.get_mut(index * self.stride..(index + 1) * self.stride)?,
            occupied: self.occupied.get_mut(index * self.words..(index + 1) * self.words)?,
            wide: self.wide.get(index * self.stride..(index + 1) * self.stride).unwrap_or(&[]),
        })
    }
}

/// The accumulator of one strip.
pub(crate) struct StripCells<'a> {
    pub(crate) columns: &'a mut [Column],
    pub(crate) marks: &'a mut [Marks],
    pub(crate) occupied: &'a mut [u64],
    /// What was set aside of a crowd of edges; else empty.
    pub(super) wide: &'a [[i64; BLOCK_HEIGHT]],
}

/// Rows of a column, as bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Marks {
    /// An edge touches the pixel.
    pub(super) once: u8,
    /// A second one does.
    pub(super) twice: u8,
    /// The pixel is one of several side by side that are touched, one of them twice.
    pub(super) cluster: u8,
}

impl Marks {
    #[inline(always)]
    pub(super) fn touch(&mut self, rows: u8) {
        self.twice |= self.once & rows;
        self.once |= rows;
    }
}

/// A pixel of a band.
#[derive(Clone, Copy)]
pub(super) struct BandPixel {
    pub(super) strip: usize,
    pub(super) column: usize,
    pub(super) row: usize,
}

impl StripCells<'_> {
    /// Marks the blocks that hold two columns as occupied: all between, if they are at most a block apart.
    #[inline(always)]
    pub(crate) fn occupy_pair(&mut self, first: usize, last: usize) {
        for column in [first, last] {
            let block = column / BLOCK_WIDTH;
            if let Some(word) = self.occupied.get_mut(block / 64) {
                *word |= 1 << (block % 64);
            }
        }
    }

    /// Marks the blocks that hold columns `first ..= last` as occupied.
    #[inline(always)]
    pub(crate) fn occupy(&mut self, first: usize, last: usize) {
        let (first, last) = (first / BLOCK_WIDTH, last / BLOCK_WIDTH);
        let (first_word, last_word) = (first / 64, last / 64);
        // Edges that cross a strip within one word of 1,024 columns need one OR.
        let low = u64::MAX << (first % 64);
        let high = u64::MAX >> (63 - last % 64);
        if first_word == last_word {
            if let Some(word) = self.occupied.get_mut(first_word) {
                *word |= low & high;
            }
        } else if let Some(words) = self.occupied.get_mut(first_word..=last_word) {
            for (index, word) in words.iter_mut().enumerate() {
                let index = first_word + index;
                *word |= if index == first_word {
                    low
                } else if index == last_word {
                    high
                } else {
                    u64::MAX
                };
            }
        }
    }
}
