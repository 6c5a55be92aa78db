//! How to render: none of it changes a pixel.

use crate::num::level::SimdLevel;
use crate::pool;

/// How a canvas renders. None of the settings changes a byte of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderSettings {
    /// The SIMD level; one that the machine lacks falls back to the scalar level. The default is
    /// [`SimdLevel::best`].
    pub level: SimdLevel,
    /// The most threads to use; 0 (the default) stands for one per core. Without the feature
    /// `parallel` it is always one.
    pub threads: usize,
    /// Rows of the bands that threads work on: rounded up to a power of two in 8 ..= 1024. The default is 32.
    pub band_height: u32,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self { level: SimdLevel::best(), threads: 0, band_height: 32 }
    }
}

impl RenderSettings {
    /// The same with the given number of threads.
    #[must_use]
    pub fn with_threads(self, threads: usize) -> Self {
        Self { threads, ..self }
    }

    /// The same with the given SIMD level.
    #[must_use]
    pub fn with_level(self, level: SimdLevel) -> Self {
        Self { level, ..self }
    }

    /// The same with the given height of bands.
    #[must_use]
    pub fn with_band_height(self, band_height: u32) -> Self {
        Self { band_height, ..self }
    }

    /// Whether there may be more than one thread.
    pub(crate) fn is_parallel(self) -> bool {
        pool::threads(self.threads) > 1
    }

    /// The settings with every default and range applied.
    pub(super) fn resolved(self) -> Self {
        Self {
            level: self.level.or_scalar(),
            threads: pool::threads(self.threads),
            band_height: self.band_height.clamp(8, 1024).next_power_of_two(),
        }
    }
}
