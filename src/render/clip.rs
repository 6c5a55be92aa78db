//! Clips in one band: coverage of whole strips, intersected.

use fearless_simd::Simd;

use crate::num::lanes::div255;
use crate::raster::sweep::BlockSink;
use crate::surface::block::{BLOCK_HEIGHT, BLOCK_WIDTH, BlockCoverage, MaskBlock};

/// What a clip leaves of a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ClipBlock<'a> {
    /// Nothing.
    Empty,
    /// All of it.
    Full,
    /// Some of it.
    Partial(&'a MaskBlock),
}

/// A clip's coverage in one band.
#[derive(Debug, Default)]
pub(super) struct BandMask {
    /// Blocks per strip.
    blocks: usize,
    /// Per block: 0 for nothing, [`FULL`] for all, else one more than an index into `masks`.
    states: Vec<u32>,
    masks: Vec<MaskBlock>,
}

const FULL: u32 = u32::MAX;

impl BandMask {
    /// An empty clip of the given size.
    pub(super) fn reset(&mut self, blocks: usize, strips: usize) {
        self.blocks = blocks;
        self.states.clear();
        self.states.resize(blocks * strips, 0);
        self.masks.clear();
    }

    #[inline(always)]
    pub(super) fn get(&self, strip: usize, block: usize) -> ClipBlock<'_> {
        match self.states.get(strip * self.blocks + block) {
            None | Some(0) => ClipBlock::Empty,
            Some(&FULL) => ClipBlock::Full,
            Some(index) => self.masks.get(*index as usize - 1).map_or(ClipBlock::Empty, ClipBlock::Partial),
        }
    }

    /// Sets a block's coverage to `mask` times the parent's.
    pub(super) fn set(&mut self, strip: usize, block: usize, mask: &MaskBlock, parent: Option<&BandMask>) {
        if block >= self.blocks {
            return;
        }
        let Some(state) = self.states.get_mut(strip * self.blocks + block) else { return };
        let mut mask = *mask;
        match parent.map_or(ClipBlock::Full, |parent| parent.get(strip, block)) {
            ClipBlock::Empty => return,
            ClipBlock::Full => {}
            ClipBlock::Partial(other) => multiply(&mut mask, other),
        }
        if mask == [[255; BLOCK_WIDTH]; BLOCK_HEIGHT] {
            *state = FULL;
        } else {
            self.masks.push(mask);
            *state = self.masks.len() as u32;
        }
    }
}

/// `mask` times `other`, each product rounded.
#[inline(always)]
pub(super) fn multiply(mask: &mut MaskBlock, other: &MaskBlock) {
    for (row, other) in mask.iter_mut().zip(other) {
        for (value, other) in row.iter_mut().zip(other) {
            *value = div255(u32::from(*value) * u32::from(*other)) as u8;
        }
    }
}

/// Collects the sweep of one strip into a clip.
pub(super) struct ClipSink<'a> {
    pub(super) mask: &'a mut BandMask,
    pub(super) strip: usize,
    pub(super) parent: Option<&'a BandMask>,
}

impl<S: Simd> BlockSink<S> for ClipSink<'_> {
    #[inline(always)]
    fn block(&mut self, _simd: S, index: usize, coverage: BlockCoverage<'_>) {
        self.mask.set(self.strip, index, coverage.mask, self.parent);
    }

    #[inline(always)]
    fn run(&mut self, _simd: S, start: usize, end: usize, rows: &[u8; BLOCK_HEIGHT]) {
        let mask = rows.map(|value| [value; BLOCK_WIDTH]);
        for index in start..end {
            self.mask.set(self.strip, index, &mask, self.parent);
        }
    }
}
