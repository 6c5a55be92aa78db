//! A digital straight line as a function: the arithmetic under every aliased line.

/// The staircase `level(i) = floor((2·rise·i + offset) / (2·run))`.
///
/// Every line algorithm here is this function with its own offset, which is what makes clipping
/// exact: any step can be entered at once, and the steps that reach a given level are known
/// without walking to them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stair {
    two_rise: i64,
    two_run: i64,
    offset: i128,
    /// The level at the current step.
    pub(super) level: i64,
    /// What the division leaves at the current step, `0 ≤ rest < 2·run`.
    rest: i64,
}

impl Stair {
    /// The stair at step 0. `0 ≤ rise ≤ run < 2^32`; a run of 0 stands for 1.
    pub(super) fn new(rise: i64, run: i64, offset: i128) -> Self {
        let mut stair = Self { two_rise: 2 * rise, two_run: 2 * run.max(1), offset, level: 0, rest: 0 };
        stair.seek(0);
        stair
    }

    /// Goes to step `i`, `0 ≤ i ≤ 2^33`.
    pub(super) fn seek(&mut self, i: i64) {
        let value = i128::from(self.two_rise) * i128::from(i) + self.offset;
        let run = i128::from(self.two_run);
        self.level = value.div_euclid(run) as i64;
        self.rest = value.rem_euclid(run) as i64;
    }

    /// Goes to the next step.
    #[inline]
    pub(super) fn advance(&mut self) {
        self.rest += self.two_rise;
        // rise ≤ run, so that one level a step is enough.
        if self.rest >= self.two_run {
            self.rest -= self.two_run;
            self.level += 1;
        }
    }

    /// The first step, from 0 on, whose level is `level` or more; `i64::MAX` if there is none so early.
    pub(super) fn first_reaching(&self, level: i64) -> i64 {
        let missing = i128::from(level) * i128::from(self.two_run) - self.offset;
        if missing <= 0 {
            return 0;
        }
        if self.two_rise == 0 {
            return i64::MAX;
        }
        let rise = i128::from(self.two_rise);
        i64::try_from((missing + rise - 1) / rise).unwrap_or(i64::MAX)
    }

    /// How much is left to the next level after one more step, as Bresenham's decision value for a
    /// stair that rounds halves down: positive where the next step goes up.
    pub(super) fn decision(&self) -> i64 {
        self.rest + self.two_rise - self.two_run + 1
    }
}

#[cfg(test)]
mod tests {
    use super::Stair;

    #[test]
    fn walking_seeking_and_searching_agree() {
        for (rise, run) in [(0, 7), (1, 7), (3, 7), (7, 7), (5, 12), (0, 0)] {
            for offset in [-40_i128, -1, 0, 3, 6, 7, 25] {
                let mut walked = Stair::new(rise, run, offset);
                let whole = 2 * run.max(1);
                for i in 0..40_i64 {
                    let expected = (2 * rise * i + offset as i64).div_euclid(whole);
                    let mut sought = Stair::new(rise, run, offset);
                    sought.seek(i);
                    assert_eq!((walked.level, sought.level), (expected, expected));
                    walked.advance();
                }
                for level in -8..12 {
                    let first = (0..1000).find(|i| (2 * rise * i + offset as i64).div_euclid(whole) >= level);
                    assert_eq!(Stair::new(rise, run, offset).first_reaching(level), first.unwrap_or(i64::MAX));
                }
            }
        }
    }
}
