//! Coverage that was found while the band was searched for hidden blocks, kept until its shape is painted.
//!
//! The search goes front to back, painting back to front: what was kept last is painted first.

use fearless_simd::Simd;

use super::occlusion::Occlusion;
use crate::raster::sweep::BlockSink;
use crate::surface::block::{BLOCK_HEIGHT, BlockCoverage, MaskBlock, Rows};

/// At most so many masks are kept in a band: 1 MiB.
const MOST_MASKS: usize = 8192;

/// A stack of shapes' coverage.
#[derive(Debug, Default)]
pub(super) struct Kept {
    /// Each shape's place in the band, and where its pieces and masks start; the front shape's first.
    shapes: Vec<(u32, usize, usize)>,
    pieces: Vec<Piece>,
    masks: Vec<MaskBlock>,
}

/// Coverage of visible blocks of a strip.
#[derive(Clone, Copy, Debug)]
struct Piece {
    strip: u32,
    start: u32,
    end: u32,
    coverage: PieceCoverage,
}

#[derive(Clone, Copy, Debug)]
enum PieceCoverage {
    /// One block's: an index into the masks, and the rows that are covered somewhere and whole.
    Mask(u32, Rows, Rows),
    /// The same along each row of all blocks.
    Rows([u8; BLOCK_HEIGHT]),
}

impl Kept {
    pub(super) fn clear(&mut self) {
        self.shapes.clear();
        self.pieces.clear();
        self.masks.clear();
    }

    /// Whether no more should be kept.
    pub(super) fn is_full(&self) -> bool {
        self.masks.len() >= MOST_MASKS
    }

    /// Starts the shape at place `order`, which lies behind those before.
    pub(super) fn begin(&mut self, order: u32) {
        self.shapes.push((order, self.pieces.len(), self.masks.len()));
    }

    /// Whether the shape at place `order` was kept; those in front of it must not have been taken yet.
    #[inline(always)]
    pub(super) fn holds(&self, order: u32) -> bool {
        self.shapes.last().is_some_and(|(last, ..)| *last == order)
    }

    /// Drops the shape at place `order` if it was kept and nothing of it can be seen, and says so.
    #[inline(always)]
    pub(super) fn drop_hidden(&mut self, order: u32) -> bool {
        self.shapes.pop_if(|(last, first_piece, _)| *last == order && *first_piece == self.pieces.len()).is_some()
    }

    /// Reports what was kept last, strip by strip from left to right, and drops it.
    #[inline(always)]
    pub(super) fn take(&mut self, mut f: impl FnMut(Place, KeptCoverage<'_>)) {
        let Some((_, first_piece, first_mask)) = self.shapes.pop() else { return };
        for piece in self.pieces.get(first_piece..).unwrap_or(&[]) {
            let place = Place { strip: piece.strip as usize, start: piece.start as usize, end: piece.end as usize };
            match piece.coverage {
                PieceCoverage::Mask(index, covered, full) => {
                    if let Some(mask) = self.masks.get(index as usize) {
                        f(place, KeptCoverage::Mask(BlockCoverage { mask, covered, full }));
                    }
                }
                PieceCoverage::Rows(rows) => f(place, KeptCoverage::Rows(rows)),
            }
        }
        self.pieces.truncate(first_piece);
        self.masks.truncate(first_mask);
    }
}

/// What was kept of some blocks.
#[derive(Clone, Copy, Debug)]
pub(super) enum KeptCoverage<'a> {
    /// Of one block.
    Mask(BlockCoverage<'a>),
    /// The same along each row of all blocks.
    Rows([u8; BLOCK_HEIGHT]),
}

/// Blocks `start..end` of a strip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) strip: usize,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// Keeps the coverage of an opaque shape in one strip where it can be seen, and claims the blocks, and halves of blocks, that it covers
/// whole.
pub(super) struct KeepSink<'a> {
    pub(super) kept: &'a mut Kept,
    pub(super) occlusion: &'a mut Occlusion,
    pub(super) order: u32,
    pub(super) strip: usize,
    /// Rows of the strip that exist.
    pub(super) rows: usize,
}

impl KeepSink<'_> {
    fn keep(&mut self, start: usize, end: usize, coverage: PieceCoverage) {
        self.kept.pieces.push(Piece { strip: self.strip as u32, start: start as u32, end: end as u32, coverage });
    }

    /// Claims the halves of a block that its coverage covers whole.
    #[inline(never)]
    fn claim_halves(&mut self, index: usize, mask: &MaskBlock) {
        let all = mask.iter().take(self.rows).fold(u128::MAX, |all, row| all & u128::from_le_bytes(*row));
        for (half, columns) in [(2 * index, all as u64), (2 * index + 1, (all >> 64) as u64)] {
            if columns == u64::MAX {
                self.occlusion.claim(self.order, self.strip..self.strip + 1, half..half + 1);
            }
        }
    }
}

impl<S: Simd> BlockSink<S> for KeepSink<'_> {
    #[inline(always)]
    fn wants(&self, index: usize) -> bool {
        !self.occlusion.is_hidden(self.strip, index)
    }

    #[inline(always)]
    fn block(&mut self, _simd: S, index: usize, coverage: BlockCoverage<'_>) {
        let BlockCoverage { mask, covered, full } = coverage;
        let rows = Rows::ALL.within(self.rows);
        if full.within(self.rows) == rows {
            self.occlusion.claim(self.order, self.strip..self.strip + 1, 2 * index..2 * index + 2);
            self.keep(index, index + 1, PieceCoverage::Rows([255; BLOCK_HEIGHT]));
            return;
        }
        if covered.within(self.rows) == rows {
            self.claim_halves(index, mask);
        }
        let place = self.kept.masks.len() as u32;
        self.kept.masks.push(*mask);
        self.keep(index, index + 1, PieceCoverage::Mask(place, covered, full));
    }

    #[inline(always)]
    fn run(&mut self, _simd: S, mut start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
        let full = rows.iter().take(self.rows).all(|row| *row == 255);
        while let Some((from, to)) = self.occlusion.visible_run(self.strip, start, end) {
            self.keep(from, to, PieceCoverage::Rows(*rows));
            if full {
                self.occlusion.claim(self.order, self.strip..self.strip + 1, 2 * from..2 * to);
            }
            start = to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};
    use crate::surface::block::BLOCK_WIDTH;

    #[test]
    fn halves_of_blocks_that_are_covered_whole_hide_what_is_beneath() {
        let whole = |columns: std::ops::Range<usize>, rows: usize| {
            let mut mask = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
            mask.iter_mut().take(rows).for_each(|row| row[columns.clone()].fill(255));
            mask
        };
        let mut nearly = whole(0..16, 8);
        (nearly[0][7], nearly[7][8]) = (254, 254);
        let mut left = whole(0..8, 8);
        left[5][12] = 9;
        // The mask, how many rows the strip has, and whether each half is seen.
        let cases = [
            (left, 8, [false, true]),
            (whole(8..16, 8), 8, [true, false]),
            (whole(1..9, 8), 8, [true, true]),
            (whole(0..9, 7), 8, [true, true]),
            (whole(0..9, 7), 7, [false, true]),
            (whole(7..16, 3), 2, [true, false]),
            (nearly, 8, [true, true]),
            (whole(0..16, 8), 8, [false, false]),
        ];
        dispatch!(SimdLevel::Scalar, simd => {
            for (mask, rows, expected) in cases {
                let (mut kept, mut occlusion) = (Kept::default(), Occlusion::default());
                occlusion.reset(10, 2);
                kept.begin(4);
                KeepSink { kept: &mut kept, occlusion: &mut occlusion, order: 4, strip: 1, rows }
                    .block(simd, 3, BlockCoverage::of(&mask));
                let seen = [6, 7].map(|half| occlusion.is_seen(1..2, half..half + 1));
                assert_eq!(seen, expected, "{rows} rows of {mask:?}");
                assert!(occlusion.is_seen(1..2, 5..6) && occlusion.is_seen(1..2, 8..9) && occlusion.is_seen(0..1, 6..8));
                occlusion.release(4);
                assert!(!occlusion.is_some() && kept.holds(4));
            }
        });
    }

    #[test]
    fn shapes_come_back_from_back_to_front_without_what_is_hidden() {
        let (mut kept, mut occlusion) = (Kept::default(), Occlusion::default());
        occlusion.reset(10, 1);
        let mut partial = [[0; BLOCK_WIDTH]; BLOCK_HEIGHT];
        partial[3][4] = 7;
        dispatch!(SimdLevel::Scalar, simd => {
            for (order, start, end) in [(9, 3, 5), (4, 0, 8)] {
                kept.begin(order);
                let mut sink =
                    KeepSink { kept: &mut kept, occlusion: &mut occlusion, order, strip: 0, rows: BLOCK_HEIGHT };
                sink.run(simd, start, end, &[255; BLOCK_HEIGHT]);
                sink.block(simd, 9, BlockCoverage::of(&partial));
            }
        });
        assert!(!kept.holds(9) && kept.holds(4));
        let taken = |kept: &mut Kept| {
            let (mut masks, mut runs) = (Vec::new(), Vec::new());
            kept.take(|place, coverage| match coverage {
                KeptCoverage::Mask(coverage) => masks.push((place.start, coverage.mask[3][4])),
                KeptCoverage::Rows(rows) => runs.push((place.start, place.end, rows[0])),
            });
            (masks, runs)
        };
        assert_eq!(taken(&mut kept), (vec![(9, 7)], vec![(0, 3, 255), (5, 8, 255)]));
        assert!(kept.holds(9) && !kept.is_full());
        assert_eq!(taken(&mut kept), (vec![(9, 7)], vec![(3, 5, 255)]));
        assert!(kept.shapes.is_empty() && kept.pieces.is_empty() && kept.masks.is_empty());
    }
}
