//! The SIMD level: a run-time value, so that one binary can try them all.

use fearless_simd::Level;

/// A SIMD instruction set that the renderer can be asked to use.
///
/// Every level draws the same bytes; they differ in speed alone. The default is the best that the
/// machine has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SimdLevel {
    /// Plain scalar code, on every machine.
    Scalar,
    /// 128-bit SSE2, the baseline of x86-64.
    Sse2,
    /// 256-bit AVX2 (x86-64-v3).
    Avx2,
    /// 512-bit AVX-512, as Ice Lake and Zen 4 have it.
    Avx512,
    /// 128-bit NEON, the baseline of AArch64.
    Neon,
    /// 128-bit WebAssembly SIMD.
    WasmSimd128,
}

impl SimdLevel {
    /// Every level, whether or not this machine has it, worst first.
    const ALL: [Self; 6] = [Self::Scalar, Self::Sse2, Self::WasmSimd128, Self::Neon, Self::Avx2, Self::Avx512];

    /// The best level of this machine.
    pub fn best() -> Self {
        Self::available().last().copied().unwrap_or(Self::Scalar)
    }

    /// The levels that this machine and this build have, worst first; never empty.
    pub fn available() -> Vec<Self> {
        Self::ALL.into_iter().filter(|level| level.is_available()).collect()
    }

    /// The level's name in lower case, as `rastrum info` prints it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "scalar",
            Self::Sse2 => "sse2",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
            Self::Neon => "neon",
            Self::WasmSimd128 => "wasm-simd128",
        }
    }

    /// The level if this machine has it, else the scalar one.
    pub(crate) fn or_scalar(self) -> Self {
        if self.is_available() { self } else { Self::Scalar }
    }

    /// Whether this machine has the level.
    pub fn is_available(self) -> bool {
        let best = Level::new();
        match self {
            Self::Scalar => true,
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Sse2 => best.as_sse2().is_some(),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx2 => best.as_avx2().is_some(),
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            Self::Avx512 => best.as_avx512().is_some(),
            #[cfg(target_arch = "aarch64")]
            Self::Neon => best.as_neon().is_some(),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            Self::WasmSimd128 => best.as_wasm_simd128().is_some(),
            _ => {
                let _ = best;
                false
            }
        }
    }
}

/// Runs `$body` with `$simd` bound to the token of `$level` (a [`SimdLevel`]), in a function compiled
/// for it. Everything called from `$body` that should use the level must be `#[inline(always)]`, or
/// enter `simd.vectorize` itself.
///
/// With `RUSTFLAGS="--cfg rastrum_best_level_only"` SSE2 is left out, so that it builds sooner: for
/// measuring one change after another, not for use.
///
/// SSE4.2 is not listed on purpose: each level is another copy of the renderer, and SSE2 covers what machines between it and
/// AVX2 have.
macro_rules! dispatch {
    ($level:expr, $simd:ident => $body:expr) => {{
        let level: $crate::num::level::SimdLevel = $level;
        match level {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            $crate::num::level::SimdLevel::Avx512 if let Some($simd) = fearless_simd::Level::new().as_avx512() => {
                use fearless_simd::Simd as _;
                $simd.vectorize(
                    #[inline(always)]
                    || $body,
                )
            }
            level => $crate::num::level::dispatch_up_to_avx2!(level, $simd => $body),
        }
    }};
}
pub(crate) use dispatch;

/// [`dispatch`], but AVX-512 is AVX2: for work that gains nothing by it, or that is rare, since each level is another copy.
macro_rules! dispatch_up_to_avx2 {
    ($level:expr, $simd:ident => $body:expr) => {{
        use fearless_simd::Simd as _;
        let level: $crate::num::level::SimdLevel = $level;
        let best = fearless_simd::Level::new();
        match level {
            #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
            $crate::num::level::SimdLevel::Avx512 | $crate::num::level::SimdLevel::Avx2
                if let Some($simd) = best.as_avx2() =>
            {
                $simd.vectorize(
                    #[inline(always)]
                    || $body,
                )
            }
            #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), not(rastrum_best_level_only)))]
            $crate::num::level::SimdLevel::Sse2 if let Some($simd) = best.as_sse2() => $simd.vectorize(
                #[inline(always)]
                || $body,
            ),
            #[cfg(target_arch = "aarch64")]
            $crate::num::level::SimdLevel::Neon if let Some($simd) = best.as_neon() => $simd.vectorize(
                #[inline(always)]
                || $body,
            ),
            #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
            $crate::num::level::SimdLevel::WasmSimd128 if let Some($simd) = best.as_wasm_simd128() => $simd.vectorize(
                #[inline(always)]
                || $body,
            ),
            _ => {
                let _ = best;
                let $simd = fearless_simd::Fallback::new();
                $simd.vectorize(
                    #[inline(always)]
                    || $body,
                )
            }
        }
    }};
}
pub(crate) use dispatch_up_to_avx2;

#[cfg(test)]
mod tests {
    use super::SimdLevel;

    #[test]
    fn scalar_is_always_there_and_the_best_is_last() {
        let levels = SimdLevel::available();
        assert_eq!(levels[0], SimdLevel::Scalar);
        assert_eq!(levels.last().copied(), Some(SimdLevel::best()));
    }

    #[test]
    fn dispatch_runs_at_every_level() {
        use fearless_simd::{SimdBase, u32x8};
        for level in SimdLevel::available() {
            let sum: u32 = dispatch!(level, simd => (u32x8::splat(simd, 3) + 4).to_array().iter().sum());
            assert_eq!(sum, 56, "{level:?}");
        }
    }
}
