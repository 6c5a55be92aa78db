//! Which blocks of a band are painted over: found front to back, before the band is painted back to front.
//!
//! An opaque shape that covers a whole block, or half of one, hides what is drawn there before it. Such shapes *claim* what they
//! cover, the last shape first; what lies beneath a claimed block is neither swept nor painted. When the painting
//! comes to the shape itself, it gives its claims back and paints them. No pixel differs: each is overwritten whole.

use std::ops::Range;

use crate::geom::IntRect;
use crate::raster::kernel::Reach;
use crate::surface::block::BLOCK_WIDTH;

/// The hidden blocks of one band.
#[derive(Debug, Default)]
pub(super) struct Occlusion {
    /// What of 64 blocks is hidden, strip after strip.
    hidden: Vec<Halves>,
    /// Words of `hidden` per strip.
    words: usize,
    /// The front shape's first.
    claims: Vec<Claim>,
    /// How many halves shapes hide.
    count: usize,
    /// One bit an item of the band: of those that are known to be hidden as a whole.
    gone: Vec<u64>,
}

/// Columns of half a block: what shapes hide is known in these, though it is drawn in whole blocks.
pub(super) const HALF_WIDTH: usize = BLOCK_WIDTH / 2;

/// Halves of up to 64 blocks of a strip: one bit a block for its left half, and one for its right.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Halves {
    left: u64,
    right: u64,
}

impl Halves {
    /// Those of `range`, numbers of halves in a strip, that lie in its word `word`.
    #[inline(always)]
    pub(super) fn of(range: &Range<usize>, word: usize) -> Self {
        Self {
            left: bits(range.start.div_ceil(2)..range.end.div_ceil(2), word),
            right: bits(range.start / 2..range.end / 2, word),
        }
    }

    /// The halves that `bounds` (device pixels) touch.
    #[inline(always)]
    pub(super) fn touched(bounds: IntRect) -> Range<usize> {
        let first = bounds.left.max(0) as usize / HALF_WIDTH;
        first..((bounds.right.max(0) as usize).div_ceil(HALF_WIDTH)).max(first)
    }

    /// The words in which `range` lies.
    #[inline(always)]
    pub(super) fn words(range: &Range<usize>) -> Range<usize> {
        range.start / 128..range.end.div_ceil(128)
    }

    /// Those that are not among `others`.
    #[inline(always)]
    fn without(self, others: Self) -> Self {
        Self { left: self.left & !others.left, right: self.right & !others.right }
    }

    /// Those and `others`.
    #[inline(always)]
    fn with(self, others: Self) -> Self {
        Self { left: self.left | others.left, right: self.right | others.right }
    }

    /// Blocks of which it has one half at least.
    #[inline(always)]
    fn any(self) -> u64 {
        self.left | self.right
    }

    /// Blocks of which it has both.
    #[inline(always)]
    fn whole(self) -> u64 {
        self.left & self.right
    }

    #[inline(always)]
    fn count(self) -> u32 {
        self.left.count_ones() + self.right.count_ones()
    }
}

/// Those of `blocks` that lie in a strip's word `word`, one bit each.
#[inline(always)]
pub(super) fn bits(blocks: Range<usize>, word: usize) -> u64 {
    let start = word * 64;
    let (first, end) = (blocks.start.max(start), blocks.end.min(start + 64));
    if first < end { (u64::MAX << (first - start)) & (u64::MAX >> (start + 64 - end)) } else { 0 }
}

/// The order of claims that are not given back: shapes have lower ones.
const NEVER: u32 = u32::MAX;

/// What a shape claims of one word of `hidden`.
#[derive(Clone, Copy, Debug)]
struct Claim {
    order: u32,
    word: u32,
    halves: Halves,
}

impl Occlusion {
    /// Nothing is hidden.
    pub(super) fn reset(&mut self, blocks: usize, strips: usize) {
        self.claims.clear();
        self.gone.clear();
        self.count = 0;
        self.words = blocks.div_ceil(64);
        self.hidden.clear();
        self.hidden.resize(self.words * strips, Halves::default());
    }

    /// Hides the blocks outside of `first..end` for good: nobody asks for them.
    pub(super) fn hide_outside(&mut self, (first, end): (usize, usize), blocks: usize, strips: usize) {
        self.claim(NEVER, 0..strips, 0..2 * first);
        self.claim(NEVER, 0..strips, 2 * end..2 * blocks);
        // What no shape hides says nothing about whether the search for hidden blocks pays.
        self.count = 0;
    }

    /// Whether something is hidden: if not, nothing needs to ask further.
    pub(super) fn is_some(&self) -> bool {
        !self.claims.is_empty()
    }

    /// How many blocks shapes hide, rounded down.
    pub(super) fn count(&self) -> usize {
        self.count / 2
    }

    #[inline(always)]
    fn word(&self, strip: usize, word: usize) -> Halves {
        self.hidden.get(strip * self.words + word).copied().unwrap_or_default()
    }

    /// Whether all of a block is.
    #[inline(always)]
    pub(super) fn is_hidden(&self, strip: usize, block: usize) -> bool {
        self.word(strip, block / 64).whole() >> (block % 64) & 1 == 1
    }

    /// Those blocks of a strip's word `word` of which one of `asked` is not hidden, one bit each.
    #[inline(always)]
    pub(super) fn seen(&self, strip: usize, word: usize, asked: Halves) -> u64 {
        asked.without(self.word(strip, word)).any()
    }

    /// The first and the end of the blocks of `bounds` (device pixels) in a strip between which all that are
    /// visible lie; empty if none is.
    #[inline(always)]
    pub(super) fn visible(&self, strip: usize, bounds: IntRect) -> (usize, usize) {
        let mut visible = [(0, 0)];
        self.find_visible(strip, bounds, &mut visible);
        visible[0]
    }

    /// The same for all strips from `strip` on of which `visible` has room for the answer; false if nothing is visible.
    #[inline(always)]
    pub(super) fn find_visible(&self, strip: usize, bounds: IntRect, visible: &mut [(usize, usize)]) -> bool {
        let halves = Halves::touched(bounds);
        let end = halves.end.div_ceil(2);
        visible.fill((end, end));
        let mut any = 0;
        // Canvases of up to 1,024 pixels have one word a row.
        for word in Halves::words(&halves) {
            let (asked, start) = (Halves::of(&halves, word), word * 64);
            for (strip, visible) in (strip..).zip(visible.iter_mut()) {
                let seen = self.seen(strip, word, asked);
                if seen != 0 {
                    let first = if visible.0 < visible.1 { visible.0 } else { start + seen.trailing_zeros() as usize };
                    *visible = (first, start + 64 - seen.leading_zeros() as usize);
                }
                any |= seen;
            }
        }
        any != 0
    }

    /// The first of the blocks `start..end` that can be seen, with those right after it: from where to where.
    #[inline(always)]
    pub(super) fn visible_run(&self, strip: usize, mut start: usize, end: usize) -> Option<(usize, usize)> {
        let ones = |word: u64| word.trailing_ones() as usize;
        let word_of = |block: usize| self.word(strip, block / 64).whole();
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

    /// Whether one of `halves` in one of `strips` is not hidden.
    #[inline(always)]
    pub(super) fn is_seen(&self, strips: Range<usize>, halves: Range<usize>) -> bool {
        if self.words == 1 {
            let asked = Halves::of(&halves, 0);
            let words = self.hidden.get(strips).unwrap_or(&[]);
            return words.iter().fold(0, |seen, word| seen | asked.without(*word).any()) != 0;
        }
        self.is_seen_in_words(strips, halves)
    }

    #[inline(never)]
    fn is_seen_in_words(&self, strips: Range<usize>, halves: Range<usize>) -> bool {
        let mut seen = 0;
        for word in Halves::words(&halves) {
            let asked = Halves::of(&halves, word);
            for strip in strips.clone() {
                seen |= self.seen(strip, word, asked);
            }
        }
        seen != 0
    }

    /// The shape at place `order` is about to be painted.
    #[inline(always)]
    pub(super) fn release(&mut self, order: u32) {
        while let Some(claim) = self.claims.pop_if(|claim| claim.order <= order) {
            if let Some(word) = self.hidden.get_mut(claim.word as usize) {
                *word = word.without(claim.halves);
            }
        }
    }

    /// Claims those of `halves` in each of `strips` that no shape further in front has.
    #[inline(always)]
    pub(super) fn claim(&mut self, order: u32, strips: Range<usize>, halves: Range<usize>) {
        // Canvases of up to 1,024 pixels have one word a row.
        if self.words == 1 {
            let wanted = Halves::of(&halves, 0);
            let words = self.hidden.get_mut(strips.clone()).unwrap_or(&mut []);
            for (place, word) in (strips.start as u32..).zip(words) {
                let halves = wanted.without(*word);
                if halves.any() != 0 {
                    *word = word.with(halves);
                    self.count += halves.count() as usize;
                    self.claims.push(Claim { order, word: place, halves });
                }
            }
            return;
        }
        self.claim_in_words(order, strips, halves);
    }

    #[inline(never)]
    fn claim_in_words(&mut self, order: u32, strips: Range<usize>, halves: Range<usize>) {
        for index in Halves::words(&halves) {
            let wanted = Halves::of(&halves, index);
            for strip in strips.clone() {
                let place = strip * self.words + index;
                if let Some(word) = self.hidden.get_mut(place) {
                    let halves = wanted.without(*word);
                    if halves.any() != 0 {
                        *word = word.with(halves);
                        self.count += halves.count() as usize;
                        self.claims.push(Claim { order, word: place as u32, halves });
                    }
                }
            }
        }
    }
}

/// The part of a strip in which something of a shape can be seen.
pub(super) fn reach((first, end): (usize, usize)) -> Reach {
    if first < end { Reach::columns(first * BLOCK_WIDTH, end * BLOCK_WIDTH) } else { Reach::NOTHING }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The halves of some blocks.
    fn of_blocks(blocks: Range<usize>) -> Range<usize> {
        2 * blocks.start..2 * blocks.end
    }

    #[test]
    fn claims_hide_until_they_are_released() {
        let mut occlusion = Occlusion::default();
        occlusion.reset(70, 2);
        let bounds = IntRect::from_ltrb(17, 0, 70 * 16, 16);
        assert_eq!(occlusion.visible(1, bounds), (1, 70));
        occlusion.claim(9, 1..2, of_blocks(1..2));
        occlusion.claim(9, 1..2, of_blocks(69..70));
        // The one in front keeps it.
        occlusion.claim(4, 1..2, of_blocks(69..70));
        occlusion.claim(4, 1..2, of_blocks(2..3));
        assert_eq!((occlusion.visible(1, bounds), occlusion.visible(0, bounds)), ((3, 69), (1, 70)));
        assert_eq!(occlusion.visible(1, IntRect::from_ltrb(16, 0, 48, 16)), (3, 3));
        occlusion.release(3);
        assert!(occlusion.is_hidden(1, 2));
        occlusion.release(4);
        assert!(!occlusion.is_hidden(1, 2) && occlusion.is_hidden(1, 1) && occlusion.is_hidden(1, 69));
        occlusion.release(9);
        // A run over a word's end.
        occlusion.claim(3, 0..1, of_blocks(60..67));
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
        occlusion.claim(3, 1..2, of_blocks(66..70));
        assert_eq!((occlusion.visible_run(1, 1, 70), occlusion.visible_run(1, 66, 70)), (Some((1, 66)), None));
        occlusion.release(3);
        assert!(!occlusion.is_some() && occlusion.visible(1, bounds) == (1, 70));
    }

    #[test]
    fn items_of_which_nothing_is_seen_are_noted() {
        let mut occlusion = Occlusion::default();
        // Halves, in all over words' ends, or in one word; even and odd; and one or a strip more each way.
        for (blocks, first, end) in [(140, 120, 260), (140, 121, 259), (40, 14, 66), (40, 15, 65), (64, 0, 127)] {
            occlusion.reset(blocks, 4);
            occlusion.claim(9, 1..3, first..end);
            let hidden: Vec<_> = (0..4 * blocks).filter(|at| occlusion.is_hidden(at / blocks, at % blocks)).collect();
            let is_claimed = |half: usize| (first..end).contains(&half);
            let claimed = |at: &usize| {
                let block = at % blocks;
                (1..3).contains(&(at / blocks)) && is_claimed(2 * block) && is_claimed(2 * block + 1)
            };
            assert_eq!(hidden, (0..4 * blocks).filter(claimed).collect::<Vec<_>>());
            assert!(!occlusion.is_seen(1..3, first..end) && !occlusion.is_seen(2..3, first + 4..first + 5));
            assert!(first == 0 || occlusion.is_seen(1..3, first - 1..end));
            assert!(occlusion.is_seen(1..3, first..end + 1));
            assert!(occlusion.is_seen(0..3, first..end) && occlusion.is_seen(1..4, first..end));
            // Each half alone, as it is asked for by pixels.
            for half in 0..2 * blocks {
                let left = (half * HALF_WIDTH) as i32;
                let bounds = IntRect::from_ltrb(left + 3, 0, left + 5, 8);
                assert_eq!(Halves::touched(bounds), half..half + 1);
                let block = half / 2;
                let expected = if is_claimed(half) { (block + 1, block + 1) } else { (block, block + 1) };
                assert_eq!(occlusion.visible(1, bounds), expected);
                let asked = Halves::of(&(half..half + 1), block / 64);
                assert_eq!(occlusion.seen(2, block / 64, asked) == 0, is_claimed(half));
                assert_eq!(occlusion.seen(0, block / 64, asked), 1 << (block % 64));
            }
            // Nothing cannot be seen, and hides nothing.
            assert!(!occlusion.is_seen(2..2, 0..2 * blocks));
            for nothing in [0..0, 5..5, 128..128] {
                assert!(!occlusion.is_seen(0..4, nothing.clone()));
                occlusion.claim(8, 0..4, nothing);
            }
            assert_eq!(occlusion.count(), end - first);
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
        occlusion.claim(3, 1..2, of_blocks(60..67));
        assert_eq!((occlusion.visible(0, bounds), occlusion.visible(1, bounds)), ((66, 128), (67, 128)));
        assert_eq!(occlusion.count(), 1);
        occlusion.release(3);
        occlusion.release(u32::MAX - 1);
        assert!(occlusion.is_some() && occlusion.visible(1, bounds) == (66, 128));
    }
}
