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

/// A column of a strip: one value per row. Aligned, so that no vector of it straddles two cache lines.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(crate) struct Column(pub(crate) [i32; BLOCK_HEIGHT]);

/// Accumulators of the strips of one band, one after another; zero between draws.
#[derive(Debug, Default)]
pub(crate) struct Accumulator {
    /// Of each strip the band's columns, rounded up to blocks, and one block to spill into.
    columns: Vec<Column>,
    /// Of each strip one bit for each block of 16 columns that may hold values.
    occupied: Vec<Vec<u64>>,
    /// How many columns a strip has.
    stride: usize,
    /// The strip that has number 0 for those who add to the cells.
    base: usize,
    /// Sums of more edges than `columns` can hold; empty but while a crowd of edges is added.
    wide: Vec<[i64; BLOCK_HEIGHT]>,
}

/// The accumulator of one strip.
#[derive(Debug)]
pub(crate) struct Strip<'a> {
    pub(crate) columns: &'a mut [Column],
    pub(crate) occupied: &'a mut [u64],
}

impl Accumulator {
    /// Makes room for `strips` strips of `width` pixels. All values must be zero, as
    /// [`sweep`](super::sweep) leaves them.
    pub(crate) fn resize(&mut self, width: usize, strips: usize) {
        let blocks = width.div_ceil(BLOCK_WIDTH) + 1;
        self.stride = blocks * BLOCK_WIDTH;
        self.columns.resize(self.stride * strips, Column::default());
        self.occupied.resize_with(strips, Vec::new);
        for words in &mut self.occupied {
            words.resize(blocks.div_ceil(64), 0);
        }
    }

    /// Numbers strips from `base` on for all that adds to the cells, until it is 0 again: edges of a shape that lies in a few of the strips
    /// need not ask about the others.
    pub(crate) fn set_base(&mut self, base: usize) {
        self.base = base;
    }

    /// Whether some block of strip `index`, of all, is occupied.
    pub(crate) fn is_occupied(&self, index: usize) -> bool {
        self.occupied.get(index).is_some_and(|words| words.iter().any(|word| *word != 0))
    }

    /// Moves all values to where there is room for any number of them.
    pub(super) fn set_aside(&mut self) {
        let Self { columns, wide, .. } = self;
        wide.resize(columns.len(), [0; BLOCK_HEIGHT]);
        for (wide, column) in wide.iter_mut().zip(columns) {
            for (wide, value) in wide.iter_mut().zip(&mut column.0) {
                *wide += i64::from(std::mem::take(value));
            }
        }
    }

    /// Brings them back, as values whose sums along x are those set aside, brought into the range in which the rule means
    /// the same. What was set aside stays until [`forget`](Self::forget).
    pub(super) fn bring_back(&mut self, rule: FillRule) {
        let full = i64::from(FULL);
        let stride = self.stride.max(1);
        for (columns, wide) in self.columns.chunks_mut(stride).zip(self.wide.chunks(stride)) {
            let (mut sum, mut before) = ([0_i64; BLOCK_HEIGHT], [0_i64; BLOCK_HEIGHT]);
            for (column, wide) in columns.iter_mut().zip(wide) {
                for (((value, wide), sum), before) in column.0.iter_mut().zip(wide).zip(&mut sum).zip(&mut before) {
                    *sum += *wide;
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

    /// Drops what was set aside.
    pub(crate) fn forget(&mut self) {
        self.wide.clear();
    }

    /// How many columns a strip has.
    #[inline(always)]
    pub(super) fn stride(&self) -> usize {
        self.stride
    }

    /// Whether all strips have that column, and places among [`cells`](Self::cells) are numbers of 32 bits.
    #[inline(always)]
    pub(super) fn holds(&self, column: usize) -> bool {
        column < self.stride && self.columns.len() <= i32::MAX as usize / BLOCK_HEIGHT
    }

    /// All values from the base on: the eight rows of a column, column after column, strip after strip.
    #[inline(always)]
    pub(super) fn cells(&mut self) -> &mut [i32] {
        bytemuck::cast_slice_mut(self.columns.get_mut(self.base * self.stride..).unwrap_or(&mut []))
    }

    /// Marks the blocks that hold columns `first ..= last` of a strip as occupied, if the band has it.
    #[inline(always)]
    pub(super) fn occupy(&mut self, strip: i32, first: usize, last: usize) {
        let Ok(index) = usize::try_from(strip) else { return };
        let (first_block, last_block) = (first / BLOCK_WIDTH, last / BLOCK_WIDTH);
        if first_block / 64 != last_block / 64 {
            if let Some(mut strip) = self.strip(index) {
                strip.occupy(first, last);
            }
        } else if let Some(word) =
            self.occupied.get_mut(self.base + index).and_then(|words| words.get_mut(first_block / 64))
        {
            *word |= (u64::MAX << (first_block % 64)) & (u64::MAX >> (63 - last_block % 64));
        }
    }

    /// The accumulators of strip `index` and the next.
    #[inline(always)]
    pub(super) fn pair(&mut self, index: usize) -> Option<[Strip<'_>; 2]> {
        let index = self.base.wrapping_add(index);
        let columns = self.columns.get_mut(index.wrapping_mul(self.stride)..)?;
        let (above, rest) = columns.split_at_mut_checked(self.stride)?;
        let below = rest.get_mut(..self.stride)?;
        let [first, second] = self.occupied.get_mut(index..)?.first_chunk_mut::<2>()?;
        Some([Strip { columns: above, occupied: first }, Strip { columns: below, occupied: second }])
    }

    /// The accumulator of strip `index`, or `None` past the last.
    #[inline(always)]
    pub(crate) fn strip(&mut self, index: usize) -> Option<Strip<'_>> {
        let index = self.base.wrapping_add(index);
        let occupied = self.occupied.get_mut(index)?;
        let columns = self.columns.get_mut(index.wrapping_mul(self.stride)..)?.get_mut(..self.stride)?;
        Some(Strip { columns, occupied })
    }
}

impl Strip<'_> {
    /// Three columns from `first` on.
    #[inline(always)]
    pub(super) fn three(&mut self, first: usize) -> Option<&mut [Column; 3]> {
        self.columns.get_mut(first..)?.first_chunk_mut::<3>()
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_are_numbered_from_the_base() {
        let mut cells = Accumulator::default();
        cells.resize(60, 4);
        cells.set_base(2);
        cells.strip(1).unwrap().columns[5].0[3] = 7;
        cells.occupy(1, 5, 20);
        cells.occupy(2, 5, 20);
        let stride = cells.stride();
        assert_eq!(cells.cells()[(stride + 5) * BLOCK_HEIGHT + 3], 7);
        assert_eq!(cells.cells().len(), 2 * stride * BLOCK_HEIGHT);
        assert_eq!(cells.pair(0).unwrap()[1].columns[5].0[3], 7);
        assert!(cells.pair(1).is_none() && cells.strip(2).is_none());
        cells.set_base(0);
        assert_eq!(cells.strip(3).unwrap().columns[5].0[3], 7);
        assert_eq!(
            (0..5).map(|strip| cells.is_occupied(strip)).collect::<Vec<_>>(),
            [false, false, false, true, false]
        );
    }
}
