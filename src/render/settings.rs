//! How to render: none of it changes a pixel.

use crate::geom::IntRect;
use crate::num::level::SimdLevel;
use crate::pool;

/// The heights among which a picture's bands have theirs: what bands share is done once for each, but there should be enough of
/// them for the threads, and memory for the pixels of one in the core's own cache.
const BAND_HEIGHTS: (u32, u32) = (32, 128);
/// Pixels of a band that is higher than it must be, 512 KiB: half of a second-level cache of 1 MiB.
const BAND_PIXELS: u32 = 1 << 17;
/// Bands for each thread, where there are several: the last ones to be drawn keep few of them waiting.
const BANDS_PER_THREAD: u32 = 6;

/// How a canvas renders. None of the settings changes a byte of the result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderSettings {
    /// The SIMD level; one that the machine lacks falls back to the scalar level. The default is
    /// [`SimdLevel::best`].
    pub level: SimdLevel,
    /// The most threads to use; 0 (the default) stands for one per core. Without the feature
    /// `parallel` it is always one.
    pub threads: usize,
    /// Rows of the bands that threads work on: rounded up to a power of two in 8 ..= 1024. 0 (the default) stands for 32 to 128,
    /// the fewer, the wider the picture is and the more threads there are.
    pub band_height: u32,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self { level: SimdLevel::best(), threads: 0, band_height: 0 }
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

    /// The settings with every default and range applied, for a picture of the pixels of `frame`.
    pub(super) fn resolved(self, frame: IntRect) -> Self {
        let threads = pool::threads(self.threads);
        let band_height = match self.band_height {
            0 => band_height(frame, threads),
            height => height.clamp(8, 1024).next_power_of_two(),
        };
        Self { level: self.level.or_scalar(), threads, band_height }
    }
}

/// How high the bands of a picture are if nobody says so: a power of two.
fn band_height(frame: IntRect, threads: usize) -> u32 {
    let (least, most) = BAND_HEIGHTS;
    let of_cache = BAND_PIXELS / frame.width().max(1);
    let of_thread = if threads > 1 { frame.height() / BANDS_PER_THREAD / threads as u32 } else { most };
    let rows = of_cache.min(of_thread).clamp(least, most);
    1 << rows.ilog2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_higher_where_few_threads_draw_a_narrow_picture() {
        let height = |width: u32, height: u32, threads: usize, wanted: u32| {
            let settings = RenderSettings::default().with_threads(threads).with_band_height(wanted);
            settings.resolved(IntRect::from_xywh(0, 0, width, height)).band_height
        };
        for (width, rows, threads, expected) in [
            (1024, 1024, 1, 128),
            (1024, 16, 1, 128),
            (1025, 1024, 1, 64),
            (2048, 2048, 1, 64),
            (4096, 4096, 1, 32),
            (100_000, 10, 1, 32),
            (1024, 1024, 2, 64),
            (1024, 768, 2, 64),
            (1024, 767, 2, 32),
            (1024, 2048, 2, 128),
            (1024, 1024, 4, 32),
            (16, 100_000, 1024, 32),
            (0, 0, 1, 128),
            (0, 0, 2, 32),
        ] {
            assert_eq!(height(width, rows, threads, 0), expected, "{width} × {rows} on {threads}");
        }
        for (wanted, expected) in [(1, 8), (8, 8), (9, 16), (1000, 1024), (5000, 1024)] {
            assert_eq!(height(1024, 1024, 1, wanted), expected);
        }
    }
}
