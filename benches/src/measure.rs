//! Times: engines take turns within each round, so that what slows the machine slows them alike.

use std::time::{Duration, Instant};

use crate::engines::Engine;

/// A turn is as many pictures as fit in this time, and at least one.
const TURN: Duration = Duration::from_millis(20);

/// The times of one engine: one for each round, the mean of its turn, in milliseconds and in order.
#[derive(Clone, Debug, Default)]
pub struct Times(Vec<f64>);

impl Times {
    pub fn new(mut times: Vec<f64>) -> Self {
        times.sort_by(f64::total_cmp);
        Self(times)
    }

    pub fn median(&self) -> f64 {
        self.quantile(0.5)
    }

    pub fn minimum(&self) -> f64 {
        self.0.first().copied().unwrap_or(f64::NAN)
    }

    /// The distance between the quartiles as a share of the median.
    pub fn spread(&self) -> f64 {
        (self.quantile(0.75) - self.quantile(0.25)) / self.median()
    }

    fn quantile(&self, share: f64) -> f64 {
        let Some(last) = self.0.len().checked_sub(1) else { return f64::NAN };
        let at = share * last as f64;
        let (low, high) = (self.0[at.floor() as usize], self.0[at.ceil() as usize]);
        low + (high - low) * at.fract()
    }
}

/// Times each engine once a round. Each round starts with the next engine, so that none always follows the same
/// other. The engines have drawn before.
pub fn take_turns(engines: &mut [Box<dyn Engine + '_>], rounds: usize) -> Vec<Times> {
    let count = engines.len();
    let pictures: Vec<u32> = engines
        .iter_mut()
        .map(|engine| {
            let time = time(engine.as_mut(), 1);
            (TURN.as_secs_f64() * 1e3 / time).clamp(1.0, 100.0) as u32
        })
        .collect();
    let mut times = vec![Vec::with_capacity(rounds); count];
    for round in 0..rounds {
        for turn in 0..count {
            let index = (round + turn) % count;
            times[index].push(time(engines[index].as_mut(), pictures[index]));
        }
    }
    times.into_iter().map(Times::new).collect()
}

/// Milliseconds for one picture, the mean of so many.
pub fn time(engine: &mut dyn Engine, pictures: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..pictures {
        engine.draw();
    }
    start.elapsed().as_secs_f64() * 1e3 / f64::from(pictures)
}

#[cfg(test)]
mod tests {
    use super::Times;

    #[test]
    fn quantiles_of_five_times() {
        let times = Times::new(vec![5.0, 1.0, 3.0, 2.0, 4.0]);
        assert_eq!((times.minimum(), times.median()), (1.0, 3.0));
        assert!((times.spread() - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(Times::new(vec![1.0, 2.0]).median(), 1.5);
    }
}
