//! The Porter–Duff operators and the two sums and products beside them, in integers.
//!
//! Source: T. Porter, T. Duff, *Compositing Digital Images*, SIGGRAPH 1984; W3C Compositing and Blending
//! Level 1, section 9. Each operator is a numerator over 255, at most 255², that is rounded once.

use fearless_simd::prelude::*;
use fearless_simd::{u8x64, u16x16, u32x8};

use super::words::{RowWords, Words, clamped, div255, mix_block};
use crate::num::lanes::doubled_row;
use crate::surface::block::{MaskBlock, PixelBlock};

/// What an integer formula may use: lanes of 8 pixels, colour and alpha alike, all in 0 ..= 255.
#[derive(Clone, Copy)]
pub(super) struct Operands<S: Simd> {
    /// Source components, at most their alpha.
    pub(super) s: u16x16<S>,
    /// Destination components, at most their alpha.
    pub(super) d: u16x16<S>,
    /// The source's alpha.
    pub(super) sa: u16x16<S>,
    /// The destination's alpha.
    pub(super) da: u16x16<S>,
    /// All ones in lanes of alpha, zero in lanes of colour.
    pub(super) is_alpha: u16x16<S>,
}

impl<S: Simd> Operands<S> {
    /// 0: nothing of either.
    #[inline(always)]
    pub(super) fn nothing(self) -> u16x16<S> {
        u16x16::splat(self.s.simd, 0)
    }

    /// The source outside the destination: s·(255 − da).
    #[inline(always)]
    pub(super) fn source_outside(self) -> u16x16<S> {
        self.s * (self.da ^ 255)
    }

    /// The destination outside the source: d·(255 − sa).
    #[inline(always)]
    pub(super) fn destination_outside(self) -> u16x16<S> {
        self.d * (self.sa ^ 255)
    }

    /// Both of them.
    #[inline(always)]
    pub(super) fn outside(self) -> u16x16<S> {
        self.source_outside() + self.destination_outside()
    }
}

/// Composites by a formula that gives 255 times the result, in 0 ..= 255² wherever no component exceeds
/// its alpha. The formula sees alpha as one more component.
#[inline(always)]
pub(super) fn composite<S: Simd>(
    simd: S,
    dst: &mut PixelBlock,
    src: &PixelBlock,
    mask: &MaskBlock,
    formula: impl Fn(Operands<S>) -> u16x16<S>,
) {
    mix_block(
        simd,
        dst,
        src,
        mask,
        #[inline(always)]
        |dst, src| {
            let color = u16x16::splat(simd, 0);
            let alpha: u16x16<S> = u32x8::splat(simd, 0xffff_0000).bitcast();
            let ((d, da), (s, sa)) = (clamped(dst), clamped(src));
            Words {
                even: div255(formula(Operands { s: s.even, d: d.even, sa, da, is_alpha: color })),
                odd: div255(formula(Operands { s: s.odd, d: d.odd, sa, da, is_alpha: alpha })),
            }
        },
    );
}

/// s·da
#[inline(always)]
pub(super) fn source_in<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.s * o.da
}

/// d·sa
#[inline(always)]
pub(super) fn destination_in<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.d * o.sa
}

/// d + s·(1 − da)
#[inline(always)]
pub(super) fn destination_over<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.d * 255 + o.source_outside()
}

/// s·da + d·(1 − sa)
#[inline(always)]
pub(super) fn source_atop<S: Simd>(o: Operands<S>) -> u16x16<S> {
    source_in(o) + o.destination_outside()
}

/// d·sa + s·(1 − da)
#[inline(always)]
pub(super) fn destination_atop<S: Simd>(o: Operands<S>) -> u16x16<S> {
    destination_in(o) + o.source_outside()
}

/// s·d
#[inline(always)]
pub(super) fn modulate<S: Simd>(o: Operands<S>) -> u16x16<S> {
    o.s * o.d
}

/// min(1, s·m + d). The mask scales the source: mixing a clamped sum would lose what the clamp cut off.
#[inline(never)]
pub(super) fn plus<S: Simd>(simd: S, dst: &mut PixelBlock, src: &PixelBlock, mask: &MaskBlock) {
    simd.vectorize(
        #[inline(always)]
        || {
            for ((dst, src), mask) in dst.iter_mut().zip(src).zip(mask) {
                let source = RowWords::from_bytes(u8x64::load_array_ref(simd, src)).times(doubled_row(simd, mask));
                let source = source.quotients_255().to_bytes();
                u8x64::load_array_ref(simd, dst).saturating_add(source).store_array(dst);
            }
        },
    );
}
