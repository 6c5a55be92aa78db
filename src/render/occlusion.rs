//! Which blocks of a band are painted over: found front to back, before the band is painted back to front.
//!
//! An opaque shape that covers a whole block hides what is drawn there before it. Such shapes *claim* their
//! blocks, the last shape first; what lies beneath a claimed block is neither swept nor painted. When the painting
//! comes to the shape itself, it gives its claims back and paints them. No pixel differs: each is overwritten whole.

use std::ops::Range;

use crate::geom::IntRect;
use crate::raster::kernel::Reach;
use crate::surface::block::BLOCK_WIDTH;

/// The hidden blocks of one band.
#[derive(Debug, Default)]
pub(super) struct Occlusion {
    /// One bit a block, strip after strip.
    hidden: Vec<u64>,
    /// Words of `hidden` per strip.
    words: usize,
    /// The front shape's first.
    claims: Vec<Claim>,
    /// How many blocks shapes hide.
    count: usize,
    /// One bit an item of the band: of those that are known to be hidden as a whole.
    gone: Vec<u64>,
}

/// The order of claims that are not given back: shapes have lower ones.
const NEVER: u32 = u32::MAX;

/// Blocks of one word of `hidden` that a shape claims.
#[derive(Clone, Copy, Debug)]
struct Claim {
    order: u32,
    word: u32,
    blocks: u64,
}

impl Occlusion {
    /// Nothing is hidden.
    pub(super) fn reset(&mut self, blocks: usize, strips: usize) {
        self.claims.clear();
        self.gone.clear();
        self.count = 0;
        self.words = blocks.div_ceil(64);
        self.hidden.clear();
        self.hidden.resize(self.words * strips, 0);
    }

    /// Hides the blocks outside of `first..end` for good: nobody asks for them.
    pub(super) fn hide_outside(&mut self, (first, end): (usize, usize), blocks: usize, strips: usize) {
        self.claim(NEVER, 0..strips, 0..first);
        self.claim(NEVER, 0..strips, end..blocks);
        // What no shape hides says nothing about whether the search for hidden blocks pays.
        self.count = 0;
    }

    /// Whether some block is hidden: if not, nothing needs to ask further.
    pub(super) fn is_some(&self) -> bool {
        !self.claims.is_empty()
    }

    /// How many blocks shapes hide.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    #[inline(always)]
    pub(super) fn is_hidden(&self, strip: usize, block: usize) -> bool {
        self.hidden.get(strip * self.words + block / 64).is_some_and(|word| word >> (block % 64) & 1 == 1)
    }

    /// The first and the end of the blocks of `bounds` (device pixels) in a strip between which all that are
    /// visible lie; empty if none is.
    #[inline(always)]
    pub(super) fn visible(&self, strip: usize, bounds: IntRect) -> (usize, usize) {
        let first = bounds.left.max(0) as usize / BLOCK_WIDTH;
        let end = (bounds.right.max(0) as usize).div_ceil(BLOCK_WIDTH);
        if first >= end {
            return (end, end);
        }
        let first_word = first / 64;
        if first_word != (end - 1) / 64 {
            return self.visible_in_words(strip, first, end);
        }
        // Canvases of up to 1,024 pixels have one word a row.
        let word = self.hidden.get(strip * self.words + first_word).copied().unwrap_or(0);
        let seen = !word & between(first, end, first_word * 64);
        if seen == 0 {
            return (end, end);
        }
        let start = first_word * 64;
        (start + seen.trailing_zeros() as usize, start + 64 - seen.leading_zeros() as usize)
    }

    #[inline(never)]
    fn visible_in_words(&self, strip: usize, first: usize, end: usize) -> (usize, usize) {
        let words = self.hidden.get(strip * self.words..(strip + 1) * self.words).unwrap_or(&[]);
        let (mut seen_first, mut seen_end) = (end, end);
        let mut any = false;
        for (index, word) in words.iter().enumerate().take(end.div_ceil(64)).skip(first / 64) {
            let start = index * 64;
            let visible = !word & between(first, end, start);
            if visible != 0 {
                if !any {
                    seen_first = start + visible.trailing_zeros() as usize;
                    any = true;
                }
                seen_end = start + 64 - visible.leading_zeros() as usize;
            }
        }
        (seen_first, seen_end)
    }

    /// The first of the blocks `start..end` that can be seen, with those right after it: from where to where.
    #[inline(always)]
    pub(super) fn visible_run(&self, strip: usize, mut start: usize, end: usize) -> Option<(usize, usize)> {
        let ones = |word: u64| word.trailing_ones() as usize;
        let word_of = |block: usize| self.hidden.get(strip * self.words + block / 64).copied().unwrap_or(0);
        let limit_of = |block: usize| end.min((block / 64 + 1) * 64);
        while start < end {
            let (word, limit) = (word_of(start), limit_of(start));
            let from = start + ones(word >> (start % 64));
            if from < limit {
                let mut to = limit.min(from + ones(!word >> (from % 64)));
                // Rows are written in one go, beyond a word's end.
                while to % 64 == 0 && to < end {
                    let run = ones(!word_of(to));
                    if run == 0 {
                        break;
                    }
                    to = limit_of(to).min(to + run);
                }
                return Some((from, to));
            }
            start = limit;
        }
        None
    }

    /// Notes that nothing of the item at place `order` can be seen.
    #[inline(always)]
    pub(super) fn set_gone(&mut self, order: u32) {
        let index = order as usize / 64;
        if index >= self.gone.len() {
            self.gone.resize(index + 1, 0);
        }
        if let Some(word) = self.gone.get_mut(index) {
            *word |= 1 << (order % 64);
        }
    }

    /// Whether that was noted: the item then has no claims, either.
    #[inline(always)]
    pub(super) fn is_gone(&self, order: u32) -> bool {
        self.gone.get(order as usize / 64).is_some_and(|word| word >> (order % 64) & 1 == 1)
    }

    /// Whether some of `blocks` in one of `strips` is not hidden.
    #[inline(always)]
    pub(super) fn is_seen(&self, strips: Range<usize>, blocks: Range<usize>) -> bool {
        if self.words == 1 {
            let asked = in_first_word(&blocks);
            let words = self.hidden.get(strips).unwrap_or(&[]);
            return words.iter().fold(0, |seen, word| seen | asked & !word) != 0;
        }
        self.is_seen_in_words(strips, blocks)
    }

    #[inline(never)]
    fn is_seen_in_words(&self, strips: Range<usize>, blocks: Range<usize>) -> bool {
        let mut seen = 0;
        for index in blocks.start / 64..blocks.end.div_ceil(64) {
            let asked = between(blocks.start, blocks.end, index * 64);
            for strip in strips.clone() {
                seen |= self.hidden.get(strip * self.words + index).map_or(0, |word| asked & !word);
            }
        }
        seen != 0
    }

    /// The shape at place `order` is about to be painted.
    #[inline(always)]
    pub(super) fn release(&mut self, order: u32) {
        while let Some(claim) = self.claims.pop_if(|claim| claim.order <= order) {
            if let Some(word) = self.hidden.get_mut(claim.word as usize) {
                *word &= !claim.blocks;
            }
        }
    }

    /// Claims those of `blocks` in each of `strips` that no shape further in front has.
    #[inline(always)]
    pub(super) fn claim(&mut self, order: u32, strips: Range<usize>, blocks: Range<usize>) {
        // Canvases of up to 1,024 pixels have one word a row.
        if self.words == 1 {
            let wanted = in_first_word(&blocks);
            let words = self.hidden.get_mut(strips.clone()).unwrap_or(&mut []);
            for (place, word) in (strips.start as u32..).zip(words) {
                let blocks = wanted & !*word;
                if blocks != 0 {
                    *word |= blocks;
                    self.count += blocks.count_ones() as usize;
                    self.claims.push(Claim { order, word: place, blocks });
                }
            }
            return;
        }
        self.claim_in_words(order, strips, blocks);
    }

    #[inline(never)]
    fn claim_in_words(&mut self, order: u32, strips: Range<usize>, blocks: Range<usize>) {
        for index in blocks.start / 64..blocks.end.div_ceil(64) {
            let wanted = between(blocks.start, blocks.end, index * 64);
            for strip in strips.clone() {
                let place = strip * self.words + index;
                if let Some(word) = self.hidden.get_mut(place) {
                    let blocks = wanted & !*word;
                    if blocks != 0 {
                        *word |= blocks;
                        self.count += blocks.count_ones() as usize;
                        self.claims.push(Claim { order, word: place as u32, blocks });
                    }
                }
            }
        }
    }
}

/// The blocks `first..end`, of which some lie in the word whose first block is `start`, as bits of it.
#[inline(always)]
fn between(first: usize, end: usize, start: usize) -> u64 {
    (u64::MAX << first.saturating_sub(start).min(63)) & (u64::MAX >> (start + 64).saturating_sub(end).min(63))
}

/// Those of `blocks` that lie in a strip's first word, as bits of it.
#[inline(always)]
fn in_first_word(blocks: &Range<usize>) -> u64 {
    let end = blocks.end.min(64);
    if blocks.start < end { between(blocks.start, end, 0) } else { 0 }
}

/// The part of a strip in which something of a shape can be seen.
pub(super) fn reach((first, end): (usize, usize)) -> Reach {
    if first < end { Reach::columns(first * BLOCK_WIDTH, end * BLOCK_WIDTH) } else { Reach::NOTHING }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn claims_hide_until_they_are_released() {
        let mut occlusion = Occlusion::default();
        occlusion.reset(70, 2);
        let bounds = IntRect::from_ltrb(17, 0, 70 * 16, 16);
        assert_eq!(occlusion.visible(1, bounds), (1, 70));
        occlusion.claim(9, 1..2, 1..2);
        occlusion.claim(9, 1..2, 69..70);
        // The one in front keeps it.
        occlusion.claim(4, 1..2, 69..70);
        occlusion.claim(4, 1..2, 2..3);
        assert_eq!((occlusion.visible(1, bounds), occlusion.visible(0, bounds)), ((3, 69), (1, 70)));
        assert_eq!(occlusion.visible(1, IntRect::from_ltrb(16, 0, 48, 16)), (3, 3));
        occlusion.release(3);
        assert!(occlusion.is_hidden(1, 2));
        occlusion.release(4);
        assert!(!occlusion.is_hidden(1, 2) && occlusion.is_hidden(1, 1) && occlusion.is_hidden(1, 69));
        occlusion.release(9);
        // A run over a word's end.
        occlusion.claim(3, 0..1, 60..67);
        assert_eq!((occlusion.visible(0, bounds), occlusion.count()), ((1, 70), 10));
        assert!((0..70).all(|block| occlusion.is_hidden(0, block) == (60..67).contains(&block)));
        assert_eq!(
            (occlusion.visible_run(0, 3, 70), occlusion.visible_run(0, 60, 70)),
            (Some((3, 60)), Some((67, 70)))
        );
        assert_eq!((occlusion.visible_run(0, 60, 67), occlusion.visible_run(0, 68, 69)), (None, Some((68, 69))));
        assert_eq!(
            (occlusion.visible_run(1, 0, 70), occlusion.visible_run(1, 64, 70)),
            (Some((0, 70)), Some((64, 70)))
        );
        occlusion.claim(3, 1..2, 66..70);
        assert_eq!((occlusion.visible_run(1, 1, 70), occlusion.visible_run(1, 66, 70)), (Some((1, 66)), None));
        occlusion.release(3);
        assert!(!occlusion.is_some() && occlusion.visible(1, bounds) == (1, 70));
    }

    #[test]
    fn items_of_which_nothing_is_seen_are_noted() {
        let mut occlusion = Occlusion::default();
        // All over words' ends, or in one word; and a block or a strip more each way.
        for (blocks, first, end) in [(140, 60, 130), (40, 7, 33), (64, 0, 63)] {
            occlusion.reset(blocks, 4);
            occlusion.claim(9, 1..3, first..end);
            let hidden: Vec<_> = (0..4 * blocks).filter(|at| occlusion.is_hidden(at / blocks, at % blocks)).collect();
            let claimed = |at: &usize| (1..3).contains(&(at / blocks)) && (first..end).contains(&(at % blocks));
            assert_eq!(hidden, (0..4 * blocks).filter(claimed).collect::<Vec<_>>());
            assert!(!occlusion.is_seen(1..3, first..end) && !occlusion.is_seen(2..3, first + 4..first + 5));
            assert!(first == 0 || occlusion.is_seen(1..3, first - 1..end));
            assert!(occlusion.is_seen(1..3, first..end + 1));
            assert!(occlusion.is_seen(0..3, first..end) && occlusion.is_seen(1..4, first..end));
            // Nothing cannot be seen, and hides nothing.
            assert!(!occlusion.is_seen(2..2, 0..blocks));
            for nothing in [0..0, 5..5, 64..64] {
                assert!(!occlusion.is_seen(0..4, nothing.clone()));
                occlusion.claim(8, 0..4, nothing);
            }
            assert_eq!(occlusion.count(), 2 * (end - first));
        }
        for order in [0, 63, 64, 200] {
            assert!(!occlusion.is_gone(order));
            occlusion.set_gone(order);
        }
        let gone: Vec<u32> = (0..300).filter(|order| occlusion.is_gone(*order)).collect();
        assert_eq!(gone, [0, 63, 64, 200]);
        occlusion.reset(140, 4);
        assert!(!occlusion.is_gone(63));
    }

    #[test]
    fn what_nobody_asks_for_stays_hidden() {
        let mut occlusion = Occlusion::default();
        occlusion.reset(140, 2);
        let bounds = IntRect::from_ltrb(0, 0, 140 * 16, 16);
        occlusion.hide_outside((0, 140), 140, 2);
        assert!(!occlusion.is_some());
        occlusion.hide_outside((66, 128), 140, 2);
        occlusion.claim(3, 1..2, 60..67);
        assert_eq!((occlusion.visible(0, bounds), occlusion.visible(1, bounds)), ((66, 128), (67, 128)));
        assert_eq!(occlusion.count(), 1);
        occlusion.release(3);
        occlusion.release(u32::MAX - 1);
        assert!(occlusion.is_some() && occlusion.visible(1, bounds) == (66, 128));
    }
}
