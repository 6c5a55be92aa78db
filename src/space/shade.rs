//! From a batch to colours: planes, shader, late tests, blending, attachments.

use fearless_simd::prelude::*;
use fearless_simd::{mask32x8, u8x32, u16x16, u32x8};

use super::batch::Batch;
use super::bin::Vertices;
use super::counters::Counters;
use super::fragment::{FragmentShader, Fragments, Planes};
use super::state::{Blend, Compare};
use super::target::{BandMut, TILE, over};
use super::test::{Tests, test_group};
use crate::num::lanes::{div255, div255_u16};
use crate::num::level::{SimdLevel, dispatch_up_to_avx2};

/// What happens to a fragment after its shader.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Output {
    pub(crate) tests: Tests,
    /// Whether the shader may drop pixels.
    pub(crate) discards: bool,
    pub(crate) early: bool,
    pub(crate) alpha_test: Option<(Compare, u8)>,
    pub(crate) blend: Blend,
    /// The bits of a pixel that are written.
    pub(crate) color_mask: u32,
    /// Nothing but colours to store, one sample a pixel: groups may be whole tiles.
    pub(crate) plain: bool,
}

/// Shades the queued pixels in their order, at a SIMD level. Not part of its caller, so that it is compiled once for each fragment
/// shader and not once more for each vertex shader.
#[inline(never)]
pub(crate) fn flush<F: FragmentShader>(
    level: SimdLevel,
    shader: &F,
    output: &Output,
    batch: &Batch,
    vertices: Vertices<'_>,
    band: &mut BandMut<'_>,
    counters: &mut Counters,
) {
    dispatch_up_to_avx2!(level, simd => shade_batch(simd, shader, output, batch, vertices, band, counters));
}

#[inline(always)]
fn shade_batch<S: Simd, F: FragmentShader>(
    simd: S,
    shader: &F,
    output: &Output,
    batch: &Batch,
    vertices: Vertices<'_>,
    band: &mut BandMut<'_>,
    counters: &mut Counters,
) {
    let mut planes = Planes::new();
    let mut loaded = usize::MAX;
    if output.plain {
        // The common case apart, so that its loop is short.
        let mut passed = 0;
        for group in &batch.groups {
            if usize::from(group.triangle) != loaded {
                loaded = usize::from(group.triangle);
                let Some(triangle) = batch.triangles.get(loaded) else { continue };
                planes.load(simd, triangle, vertices);
            }
            passed += u64::from(group.masks[0].count_ones());
            let (x, y) = (usize::from(group.x), usize::from(group.y));
            let tile = (y / TILE - band.first) * band.tiles_x + x / TILE;
            let Some(tile) = band.color.get_mut(tile) else { continue };
            let mask = group.masks[0] as u8;
            // One row, or all of the tile, in which case what depends on the column alone is reckoned once.
            let first = y % TILE;
            let last = if group.is_tile() { TILE } else { first + 1 };
            for (row, y) in tile[first..last].iter_mut().zip(group.y..) {
                let color = shader.shade(&Fragments::new(simd, &planes, group.x, y, mask)).color;
                if mask == !0 {
                    color.store_array(row);
                } else {
                    let mask = mask32x8::from_bitmask(simd, u64::from(mask));
                    mask.select(color, u32x8::load_array_ref(simd, row)).store_array(row);
                }
            }
        }
        counters.fragments += passed;
        counters.samples_passed += passed;
        return;
    }
    for group in &batch.groups {
        if usize::from(group.triangle) != loaded {
            loaded = usize::from(group.triangle);
            let Some(triangle) = batch.triangles.get(loaded) else { continue };
            planes.load(simd, triangle, vertices);
        }
        let pixels = group.pixels();
        let fragments = Fragments::new(simd, &planes, group.x, group.y, pixels);
        counters.fragments += u64::from(pixels.count_ones());
        let shade = shader.shade(&fragments);
        let mut keep = if output.discards { shade.keep } else { !0 };
        if let Some((compare, reference)) = output.alpha_test {
            for (i, color) in shade.color.to_array().into_iter().enumerate() {
                if !compare.passes((color >> 24) as u8, reference) {
                    keep &= !(1 << i);
                }
            }
        }
        let kept = u64::from(keep) * 0x0101_0101_0101_0101;
        let mut masks = [group.masks[0] & kept, group.masks[1] & kept];
        if masks == [0; 2] {
            continue;
        }
        if !output.early {
            masks = test_group(simd, &output.tests, &planes.triangle, band, (group.x, group.y), masks);
            if masks == [0; 2] {
                continue;
            }
        }
        counters.samples_passed += u64::from(masks[0].count_ones() + masks[1].count_ones());
        write_group(simd, output, band, (group.x, group.y), masks, shade.color);
        let (x, y) = (usize::from(group.x), usize::from(group.y));
        let tile = (y / TILE - band.first) * band.tiles_x + x / TILE;
        for (i, attachment) in band.attachments.iter_mut().enumerate() {
            let value = shader.attachment(&fragments, i);
            let Some(tile) = attachment.get_mut(tile) else { continue };
            let row = &mut tile[y % TILE];
            let mask = mask32x8::from_bitmask(simd, masks[0] & 255);
            mask.select(value, u32x8::load_array_ref(simd, row)).store_array(row);
        }
    }
}

/// Blends eight colours into the samples of `masks`.
#[inline(always)]
fn write_group<S: Simd>(
    simd: S,
    output: &Output,
    band: &mut BandMut<'_>,
    (x, y): (u16, u16),
    masks: [u64; 2],
    color: u32x8<S>,
) {
    let (x, y) = (usize::from(x), usize::from(y));
    let tile = (y / TILE - band.first) * band.tiles_x + x / TILE;
    if band.samples.is_coverage_rich() {
        write_coverage_rich(output, band, tile, (x, y), masks, color.to_array());
        return;
    }
    let samples = band.samples.coverage();
    let Some(tiles) = band.color.get_mut(tile * samples..(tile + 1) * samples) else { return };
    if output.blend == Blend::Replace && output.color_mask == !0 {
        for (sample, tile) in tiles.iter_mut().enumerate() {
            let bits = masks[(sample / 8) & 1] >> (8 * (sample & 7)) & 255;
            let row = &mut tile[y % TILE];
            if bits == 255 {
                color.store_array(row);
            } else if bits != 0 {
                mask32x8::from_bitmask(simd, bits).select(color, u32x8::load_array_ref(simd, row)).store_array(row);
            }
        }
        return;
    }
    for (sample, tile) in tiles.iter_mut().enumerate() {
        let bits = masks[(sample / 8) & 1] >> (8 * (sample & 7)) & 255;
        if bits == 0 {
            continue;
        }
        let row = &mut tile[y % TILE];
        let below = u32x8::load_array_ref(simd, row);
        let blended = match output.blend {
            Blend::Replace => color,
            Blend::SourceOver => blend_over(simd, color, below),
            Blend::Additive => color.bitcast::<u8x32<S>>().saturating_add(below.bitcast::<u8x32<S>>()).bitcast(),
            Blend::Min => least(color, below),
            Blend::Max => greatest(color, below),
            Blend::Multiply => multiply(color, below),
        };
        let blended = if output.color_mask == !0 {
            blended
        } else {
            (blended & output.color_mask) | (below & !output.color_mask)
        };
        mask32x8::from_bitmask(simd, bits).select(blended, below).store_array(row);
    }
}

/// s + d · (1 − sa), each product rounded to nearest, saturating.
#[inline(always)]
fn blend_over<S: Simd>(simd: S, s: u32x8<S>, d: u32x8<S>) -> u32x8<S> {
    let rest: u32x8<S> = u32x8::splat(simd, 255) - (s >> 24);
    // The factor in both 16-bit halves of its pixel.
    let rest: u16x16<S> = (rest | rest << 16).bitcast();
    let below: u16x16<S> = d.bitcast();
    let even = div255_u16((below & 255) * rest);
    let odd = div255_u16((below >> 8) * rest);
    let scaled: u8x32<S> = (even | odd << 8).bitcast();
    s.bitcast::<u8x32<S>>().saturating_add(scaled).bitcast()
}

#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer minimum is the same at every level")]
fn least<S: Simd>(s: u32x8<S>, d: u32x8<S>) -> u32x8<S> {
    s.bitcast::<u8x32<S>>().min(d.bitcast::<u8x32<S>>()).bitcast()
}

#[inline(always)]
#[expect(clippy::disallowed_methods, reason = "integer maximum is the same at every level")]
fn greatest<S: Simd>(s: u32x8<S>, d: u32x8<S>) -> u32x8<S> {
    s.bitcast::<u8x32<S>>().max(d.bitcast::<u8x32<S>>()).bitcast()
}

#[inline(always)]
fn multiply<S: Simd>(s: u32x8<S>, d: u32x8<S>) -> u32x8<S> {
    let (s, d): (u16x16<S>, u16x16<S>) = (s.bitcast(), d.bitcast());
    let even = div255_u16((s & 255) * (d & 255));
    let odd = div255_u16((s >> 8) * (d >> 8));
    (even | odd << 8).bitcast()
}

/// One pixel's blending, for coverage-rich samples: the same results as the vectors'.
fn blend_pixel(blend: Blend, s: u32, d: u32) -> u32 {
    let each = |f: fn(u8, u8) -> u8| {
        let (s, d) = (s.to_le_bytes(), d.to_le_bytes());
        u32::from_le_bytes([0, 1, 2, 3].map(|i| f(s[i], d[i])))
    };
    match blend {
        Blend::Replace => s,
        Blend::SourceOver => over(s, d),
        Blend::Additive => each(u8::saturating_add),
        Blend::Min => each(|s, d| s.min(d)),
        Blend::Max => each(|s, d| s.max(d)),
        Blend::Multiply => each(|s, d| div255(u32::from(s) * u32::from(d)) as u8),
    }
}

/// Colours into pixels with more coverage samples than colours.
///
/// Each coverage sample names one of the pixel's colours. A fragment takes a colour that no other sample names; if there is
/// none, the colour with the fewest samples is given up and its samples count as unknown (15) until they are drawn again: they are left out
/// when the pixel is resolved, as in EQAA.
#[inline(never)]
fn write_coverage_rich(
    output: &Output,
    band: &mut BandMut<'_>,
    tile: usize,
    (_, y): (usize, usize),
    masks: [u64; 2],
    colors: [u32; 8],
) {
    let (samples, count) = (band.samples.coverage(), band.samples.colors());
    let Some(tiles) = band.color.get_mut(tile * count..(tile + 1) * count) else { return };
    let Some(slots) = band.slots.get_mut(tile) else { return };
    let row = y % TILE;
    for (lane, color) in colors.into_iter().enumerate() {
        let covered: Vec<usize> =
            (0..samples).filter(|s| masks[(s / 8) & 1] >> (8 * (s & 7) + lane) & 1 == 1).collect();
        if covered.is_empty() {
            continue;
        }
        let packed = &mut slots[row][lane];
        let slot_of = |packed: u64, sample: usize| (packed >> (4 * sample)) as usize & 15;
        // Each colour that is drawn onto gives one result; without blending that is one in all.
        let mut sources: Vec<Option<usize>> = covered.iter().map(|s| Some(slot_of(*packed, *s))).collect();
        if output.blend == Blend::Replace && output.color_mask == !0 {
            sources.fill(None);
        }
        let before: Vec<u32> = tiles.iter().map(|tile| tile[row][lane]).collect();
        let mut kinds = sources.clone();
        kinds.sort_unstable();
        kinds.dedup();
        let mut writes = Vec::new();
        for kind in kinds {
            let members: Vec<usize> =
                covered.iter().zip(&sources).filter(|(_, source)| **source == kind).map(|(s, _)| *s).collect();
            let below = kind.and_then(|slot| before.get(slot)).copied().unwrap_or(0);
            let blended = blend_pixel(output.blend, color, below);
            writes.push((members, (blended & output.color_mask) | (below & !output.color_mask)));
        }
        // The drawn samples let go of their colours first.
        for s in &covered {
            *packed |= 15 << (4 * s);
        }
        for (members, value) in writes {
            let used = |packed: u64, slot: usize| (0..samples).filter(|s| slot_of(packed, *s) == slot).count();
            // The same colour again shares its place.
            let alike = tiles.iter().take(count).position(|tile| tile[row][lane] == value);
            let alike = alike.filter(|slot| used(*packed, *slot) > 0);
            let fewest = || (0..count).min_by_key(|slot| used(*packed, *slot));
            let Some(slot) = alike.or_else(fewest) else { continue };
            for s in 0..samples {
                if alike.is_none() && slot_of(*packed, s) == slot {
                    *packed |= 15 << (4 * s);
                }
            }
            if let Some(tile) = tiles.get_mut(slot) {
                tile[row][lane] = value;
            }
            for s in members {
                *packed = (*packed & !(15 << (4 * s))) | (slot as u64) << (4 * s);
            }
        }
    }
}
