//! Gaussian blur.

use super::image::{Image, Work, grown};
use super::lines::{COLUMNS, Columns, Lanes, copy};
use super::source::{PART, Parts, bands, strips};
use crate::error::Result;
use crate::geom::IntRect;
use crate::num::level::dispatch_up_to_avx2;
use crate::num::trig;

/// Deviations in pixels below this are no blur: their kernel's neighbours round to nothing.
const LEAST: f32 = 0.05;

/// From this deviation on, three box blurs stand for the Gaussian. Along a sharp edge they are off by at most 2.7 of 255 at
/// a deviation of 3, by 1.4 from 8 on; at a deviation of 2 it would be 5.
const BOXES_FROM: f32 = 3.0;

/// How far the three boxes reach together, for a deviation of 1: found by minimizing the largest difference that a sharp
/// edge shows, over deviations from 2 to 200. (The specification's widths, 5.64, err by up to 2.3, widths of the Gaussian's
/// own variance, 6, by up to 3.)
const BOXES_LENGTH: f64 = 5.865;

/// No picture is so large that a wider blur would show.
const MOST: f32 = 30_000.0;

/// A blur in one direction.
pub(super) struct Blur {
    passes: Vec<Pass>,
    /// The same, box by box, for pictures that are cut off in between.
    singles: Vec<Pass>,
}

enum Pass {
    /// Weights from the centre outwards, of 65,536.
    Kernel(Vec<i32>),
    /// Box blurs in one go; see [`Boxes`].
    Boxes(Boxes),
}

/// Box blurs after each other, without rounding between them.
///
/// A box of width d is (1 − z^d) / (1 − z), so that several are a few differences of the line (`taps`), summed up as often
/// as there are boxes. Sums wrap around, which does no harm: in the end the true value is back in range.
struct Boxes {
    /// Distances backwards and factors.
    taps: Vec<(usize, i16)>,
    count: usize,
    /// How far before a pixel and after it the pixels lie that it takes.
    before: usize,
    after: usize,
    /// One divided by the product of the widths.
    scale: f32,
}

impl Blur {
    /// A blur with this deviation, in pixels.
    pub(super) fn new(deviation: f32) -> Self {
        let (passes, singles) = match deviation {
            deviation if !(deviation >= LEAST) => (Vec::new(), Vec::new()),
            deviation if deviation < BOXES_FROM => {
                let kernel = kernel(deviation);
                (vec![Pass::Kernel(kernel.clone())], vec![Pass::Kernel(kernel)])
            }
            deviation => {
                let [a, b, c] = widths(if deviation < MOST { deviation } else { MOST });
                // What is summed thrice must fit 31 bits.
                let fused = match 255_u64 * a as u64 * b as u64 * c as u64 {
                    product if product < 1 << 31 => boxes(&[&[a, b, c]]),
                    _ if 255_u64 * (a as u64) * (b as u64) < 1 << 31 => boxes(&[&[a, b], &[c]]),
                    _ => boxes(&[&[a], &[b], &[c]]),
                };
                (fused, boxes(&[&[a], &[b], &[c]]))
            }
        };
        Self { passes, singles }
    }

    /// Whether it leaves every pixel as it is.
    pub(super) fn is_nothing(&self) -> bool {
        self.passes.is_empty()
    }

    /// How far a pixel spreads, to either side.
    pub(super) fn reach(&self) -> i32 {
        self.passes.iter().map(|pass| pass.reach() as i32).sum()
    }

    /// Blurs a line. `sides` are the positions of the source, if any, at which the picture is cut off in between.
    fn run(&self, work: Work, source: &[Lanes], offset: isize, target: &mut [Lanes], sides: Option<(isize, isize)>) {
        let passes = if sides.is_some() { &self.singles } else { &self.passes };
        let Some((last, others)) = passes.split_last() else {
            copy(source, offset, target);
            return;
        };
        // In between: all that is not zero, and the position of its first in the source.
        let mut between: Option<(Vec<Lanes>, isize)> = None;
        for pass in others {
            let (line, start) = between.as_ref().map_or((source, 0), |(line, start)| (line.as_slice(), *start));
            let (low, high) = sides.unwrap_or((isize::MIN, isize::MAX));
            let reach = pass.reach() as isize;
            let next_start = (start - reach).max(low);
            let next_end = (start + line.len() as isize + reach).min(high);
            let mut next = vec![[0; 64]; usize::try_from(next_end - next_start).unwrap_or(0)];
            pass.run(work, line, next_start - start, &mut next);
            between = Some((next, next_start));
        }
        let (line, start) = between.as_ref().map_or((source, 0), |(line, start)| (line.as_slice(), *start));
        last.run(work, line, offset - start, target);
    }
}

/// Box blurs in groups. One of an even width takes a pixel more on one side; over all, they lie evenly.
fn boxes(groups: &[&[usize]]) -> Vec<Pass> {
    let all: usize = groups.iter().map(|widths| widths.iter().sum::<usize>() - widths.len()).sum();
    let (mut sum, mut before) = (0, 0);
    let mut passes = Vec::new();
    for widths in groups {
        sum += widths.iter().sum::<usize>() - widths.len();
        // Half of what has come together so far, rounded; the last time there is nothing to round.
        let own = if sum == all { all / 2 } else { sum.div_ceil(2) } - before;
        passes.push(Pass::Boxes(Boxes::new(widths, own)));
        before += own;
    }
    passes
}

/// How much memory a blur takes while it works, beside what it reads and gives.
#[derive(Clone, Copy, Debug)]
struct Room {
    /// Bytes of what is blurred downwards only. Of more, the rows are blurred in bands.
    columns: usize,
    /// Bytes of a part of the picture, where it is drawn in parts.
    part: usize,
}

/// Bands that are low beside the blur's reach have its surroundings drawn again and again:
/// a deviation of 1,000 at 2000² takes a quarter more time than with 32 MiB, for which a blur inside a blur has no room.
const ROOM: Room = Room { columns: COLUMNS, part: PART };

/// Blurs a picture; the answer holds what of it lies in `area`.
///
/// With a `region` each of three boxes blurs what the one before it left inside of that, as SVG renderers do that work on a
/// surface of the region's size; without, nothing is lost in between.
pub(super) fn blur(
    image: &dyn Parts,
    area: IntRect,
    region: Option<IntRect>,
    across_by: &Blur,
    down_by: &Blur,
    work: Work,
) -> Result<Image> {
    blur_within(ROOM, image, area, region, (across_by, down_by), work)
}

/// As [`blur`]. The room that it has changes no pixel.
fn blur_within(
    room: Room,
    image: &dyn Parts,
    area: IntRect,
    region: Option<IntRect>,
    (across_by, down_by): (&Blur, &Blur),
    work: Work,
) -> Result<Image> {
    let reach = (across_by.reach(), down_by.reach());
    let area = grown(image.bounds(), reach, reach).intersect(area);
    // What lies further away than the blur reaches is not worth blurring downwards.
    let from = grown(area, reach, reach).intersect(image.bounds());
    let mut out = Image::new(area)?;
    let sides = |low: i32, high: i32, start: i32| (low as isize - start as isize, high as isize - start as isize);
    let columns_at = region.map(|region| sides(region.left, region.right, from.left));
    for band in bands(area, room.columns / Columns::bytes_of_a_row(from.width()).max(1)) {
        let lines = grown(band, (0, reach.1), (0, reach.1));
        let read = IntRect { top: lines.top.max(from.top), bottom: lines.bottom.min(from.bottom), ..from };
        let rows_at = region.map(|region| sides(region.top, region.bottom, read.top));
        let mut columns = Columns::new(IntRect { left: from.left, right: from.right, ..band })?;
        for strip in strips(read, if image.is_whole() { usize::MAX } else { room.part }) {
            columns.fill(&*image.part(strip)?, strip, work, |source, offset, target| {
                down_by.run(work, source, offset, target, rows_at);
            });
        }
        columns.write(&mut out, work, |source, offset, target| {
            across_by.run(work, source, offset, target, columns_at);
        });
    }
    Ok(out)
}

/// Blurs a picture by the same deviation in both directions, in pixels; the answer holds what of it lies in `area`.
pub(crate) fn gaussian(image: &dyn Parts, area: IntRect, deviation: f32, work: Work) -> Result<Image> {
    let both = Blur::new(deviation);
    blur(image, area, None, &both, &both, work)
}

impl Pass {
    fn reach(&self) -> usize {
        match self {
            Self::Kernel(weights) => weights.len().saturating_sub(1),
            Self::Boxes(boxes) => boxes.before.max(boxes.after),
        }
    }

    fn run(&self, work: Work, source: &[Lanes], offset: isize, target: &mut [Lanes]) {
        match self {
            Self::Kernel(weights) => dispatch_up_to_avx2!(work.level, simd => {
                let _ = simd;
                convolve(weights, source, offset, target);
            }),
            Self::Boxes(boxes) => match boxes.count {
                1 => dispatch_up_to_avx2!(work.level, simd => {
                    let _ = simd;
                    boxes.run::<1>(source, offset, target);
                }),
                2 => dispatch_up_to_avx2!(work.level, simd => {
                    let _ = simd;
                    boxes.run::<2>(source, offset, target);
                }),
                _ => dispatch_up_to_avx2!(work.level, simd => {
                    let _ = simd;
                    boxes.run::<3>(source, offset, target);
                }),
            },
        }
    }
}

const NOTHING: Lanes = [0; 64];

fn at(line: &[Lanes], index: isize) -> &Lanes {
    usize::try_from(index).ok().and_then(|index| line.get(index)).unwrap_or(&NOTHING)
}

#[inline(always)]
fn convolve(weights: &[i32], source: &[Lanes], offset: isize, target: &mut [Lanes]) {
    let Some((centre, others)) = weights.split_first() else { return };
    for (index, target) in (offset..).zip(target) {
        let mut sums = [32_768_i32; 64];
        for (sum, value) in sums.iter_mut().zip(at(source, index)) {
            *sum += centre * i32::from(*value);
        }
        for (distance, weight) in (1..).zip(others) {
            let (before, after) = (at(source, index - distance), at(source, index + distance));
            for (sum, (before, after)) in sums.iter_mut().zip(before.iter().zip(after)) {
                *sum += weight * (i32::from(*before) + i32::from(*after));
            }
        }
        for (value, sum) in target.iter_mut().zip(sums) {
            *value = (sum >> 16) as u8;
        }
    }
}

impl Boxes {
    fn new(widths: &[usize], before: usize) -> Self {
        let mut taps: Vec<(usize, i16)> = vec![(0, 1)];
        for width in widths {
            let mut product = taps.clone();
            for (distance, factor) in &taps {
                match product.iter_mut().find(|(other, _)| *other == distance + width) {
                    Some((_, other)) => *other -= factor,
                    None => product.push((distance + width, -factor)),
                }
            }
            taps = product;
        }
        taps.retain(|(_, factor)| *factor != 0);
        let product: f64 = widths.iter().map(|width| *width as f64).product();
        Self {
            taps,
            count: widths.len(),
            before,
            after: widths.iter().sum::<usize>() - widths.len() - before,
            scale: (1.0 / product) as f32,
        }
    }

    #[inline(always)]
    fn run<const N: usize>(&self, source: &[Lanes], offset: isize, target: &mut [Lanes]) {
        let reach = self.after as isize;
        let mut sums = [[0_i32; 64]; N];
        // From the first position that the source reaches, so that nothing has been summed before it.
        let start = -reach;
        for index in start.min(offset)..offset + target.len() as isize {
            let mut difference = [0_i16; 64];
            for (distance, factor) in &self.taps {
                let Some(lanes) =
                    usize::try_from(index + reach - *distance as isize).ok().and_then(|index| source.get(index))
                else {
                    continue;
                };
                for (difference, value) in difference.iter_mut().zip(lanes) {
                    *difference = difference.wrapping_add(factor.wrapping_mul(i16::from(*value)));
                }
            }
            let mut carry = [0_i32; 64];
            for (carry, difference) in carry.iter_mut().zip(difference) {
                *carry = i32::from(difference);
            }
            for sums in &mut sums {
                for (sum, carry) in sums.iter_mut().zip(&mut carry) {
                    *sum = sum.wrapping_add(*carry);
                    *carry = *sum;
                }
            }
            let place = usize::try_from(index - offset).ok().and_then(|place| target.get_mut(place));
            if let Some(place) = place {
                for (value, sum) in place.iter_mut().zip(carry) {
                    // Adding 1.5 · 2^23 leaves the rounded integer in the mantissa's low bits.
                    *value = (sum as f32 * self.scale + 12_582_912.0).to_bits() as u8;
                }
            }
        }
    }
}

fn kernel(deviation: f32) -> Vec<i32> {
    let deviation = f64::from(deviation);
    let reach = (deviation * 3.0).ceil() as usize;
    let raw: Vec<f64> = (0..=reach).map(|x| trig::exp(-((x * x) as f64) / (2.0 * deviation * deviation))).collect();
    let total = raw.iter().sum::<f64>() * 2.0 - 1.0;
    let mut weights: Vec<i32> = raw.iter().map(|w| (w / total * 65_536.0 + 0.5) as i32).collect();
    let others: i32 = weights.iter().skip(1).sum();
    if let Some(first) = weights.first_mut() {
        *first = 65_536 - 2 * others;
    }
    weights
}

/// Three widths as equal as can be; an odd sum makes them lie evenly around the centre.
fn widths(deviation: f32) -> [usize; 3] {
    let length = (f64::from(deviation) * BOXES_LENGTH / 2.0).floor() as usize * 2 + 1;
    [0, 1, 2].map(|more| (length + more) / 3)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, noise};
    use super::super::source::tests::InParts;
    use super::*;
    use crate::num::level::SimdLevel;

    /// Box blurs one after another, each by its definition, in real numbers.
    fn slow_boxes(line: &[f64], widths: &[usize]) -> Vec<f64> {
        let mut line = line.to_vec();
        // All of the shifts by half pixels to one side, then to the other.
        let mut shift = false;
        for width in widths {
            let before = if width % 2 == 0 {
                shift = !shift;
                width / 2 - usize::from(shift)
            } else {
                width / 2
            };
            let value = |x: isize| usize::try_from(x).ok().and_then(|x| line.get(x)).copied().unwrap_or(0.0);
            line = (0..line.len() as isize)
                .map(|x| (0..*width as isize).map(|k| value(x - before as isize + k)).sum::<f64>() / *width as f64)
                .collect();
        }
        line
    }

    #[test]
    fn boxes_are_their_definition_rounded_once() {
        let mut source = vec![[0; 64]; 60];
        let image = noise(IntRect::from_xywh(0, 0, 16, 20), 3);
        for y in 0..20 {
            source[20 + y as usize] = *image.row(y).as_flattened().first_chunk().unwrap();
        }
        for widths in [vec![3, 4, 4], vec![5, 5, 5], vec![4, 4], vec![7], vec![9, 10, 10], vec![31, 31, 33]] {
            let boxes = Boxes::new(&widths, (widths.iter().sum::<usize>() - widths.len()) / 2);
            let mut found = vec![[0; 64]; 60];
            boxes.run_any(&source, 0, &mut found);
            for lane in 0..64 {
                // Room for what leaves the line and comes back.
                let mut line = vec![0.0; 100];
                line.extend(source.iter().map(|lanes| f64::from(lanes[lane])));
                line.extend([0.0; 100]);
                let expected = slow_boxes(&line, &widths);
                for x in 0..60 {
                    let (found, expected) = (f64::from(found[x][lane]), expected[100 + x]);
                    assert!((found - expected).abs() < 0.5001, "{widths:?} at {x}: {found}, {expected}");
                }
            }
        }
    }

    impl Boxes {
        fn run_any(&self, source: &[Lanes], offset: isize, target: &mut [Lanes]) {
            match self.count {
                1 => self.run::<1>(source, offset, target),
                2 => self.run::<2>(source, offset, target),
                _ => self.run::<3>(source, offset, target),
            }
        }
    }

    /// The normal distribution's share below `x` deviations, by summing the density finely.
    fn normal(x: f64) -> f64 {
        let steps = 20_000;
        let from = -8.0;
        let width = (x - from) / f64::from(steps);
        let density = |t: f64| trig::exp(-t * t / 2.0) / std::f64::consts::TAU.sqrt();
        (0..steps).map(|i| density(from + (f64::from(i) + 0.5) * width) * width).sum()
    }

    #[test]
    fn a_sharp_edge_becomes_the_normal_distribution() {
        for deviation in [0.3_f32, 0.8, 1.5, 2.0, 2.9, 3.0, 4.0, 7.7, 20.0, 60.0, 110.0, 150.0, 900.0] {
            let size = (deviation * 4.0).ceil() as i32 + 4;
            let mut image = Image::new(IntRect::from_ltrb(0, 0, size, 1)).unwrap();
            image.pixels_mut().fill([255; 4]);
            let blur_across = Blur::new(deviation);
            let area = IntRect::from_ltrb(-size, 0, size / 2, 1);
            let out = blur(&image, area, None, &blur_across, &Blur::new(0.0), WORK).unwrap();
            for x in [-2.5, -1.5, -1.0, -0.5, -0.1, 0.0, 0.1, 0.5, 1.0] {
                let x = (x * deviation).round() as i32;
                // The pixel's centre is half a pixel to the right of its number.
                let expected = 255.0 * normal((f64::from(x) + 0.5) / f64::from(deviation));
                let found = f64::from(out.part(0, x, x + 1).1.first().map_or(0, |p| p[3]));
                // Below a deviation of 1 a pixel's own width shows.
                let allowed = if deviation < 1.0 { 16.0 } else { 4.0 };
                assert!((found - expected).abs() < allowed, "{deviation} at {x}: {found}, not {expected}");
            }
        }
    }

    #[test]
    fn a_part_is_what_the_whole_has_there_at_every_level() {
        let source = noise(IntRect::from_ltrb(40, 30, 62, 49), 5);
        let all = IntRect::from_ltrb(-20, -20, 130, 120);
        for deviation in [0.0, 0.7, 1.9, 2.0, 3.3, 8.0, 120.0] {
            let whole = gaussian(&source, all, deviation, WORK).unwrap();
            assert!(whole.pixels().iter().any(|pixel| *pixel != [0; 4]));
            for level in SimdLevel::available() {
                for area in [
                    all,
                    IntRect::from_ltrb(42, 31, 50, 35),
                    IntRect::from_ltrb(30, 20, 46, 70),
                    IntRect::from_ltrb(50, 10, 99, 34),
                    IntRect::from_ltrb(0, 0, 3, 3),
                ] {
                    let part = gaussian(&source, area, deviation, Work { threads: 3, level }).unwrap();
                    let expected = whole.crop(part.bounds()).unwrap();
                    assert_eq!(part, expected, "{area:?} {deviation} {level:?}");
                    let outside = whole.crop(area).unwrap();
                    assert_eq!(part.crop(area).unwrap(), outside, "{area:?} {deviation}");
                }
            }
        }
    }

    #[test]
    fn neither_bands_nor_parts_change_a_pixel() {
        let source = noise(IntRect::from_ltrb(-30, -40, 61, 97), 7);
        let parts = InParts(source.clone());
        for (deviation, size) in [(0.7, 200), (3.3, 200), (24.0, 200), (120.0, 600), (1000.0, 2000)] {
            let (across_by, down_by) = (Blur::new(deviation), Blur::new(deviation * 0.8));
            let both = (&across_by, &down_by);
            for region in [None, Some(IntRect::from_ltrb(-25, -38, size / 3, 90))] {
                let area = IntRect::from_ltrb(-21, -size / 3, 40, size / 2).intersect(region.unwrap_or(LARGE));
                let whole = blur(&source, area, region, &across_by, &down_by, WORK).unwrap();
                for (columns, part) in [(1, 1), (40_000, 9_000), (20_000, 1 << 20), (1 << 20, 20_000)] {
                    for image in [&source as &dyn Parts, &parts] {
                        let found = blur_within(Room { columns, part }, image, area, region, both, WORK).unwrap();
                        assert!(found == whole, "{deviation} {region:?} {columns} {part} {}", image.is_whole());
                    }
                }
            }
        }
    }

    const LARGE: IntRect = IntRect::from_ltrb(-5000, -5000, 5000, 5000);

    #[test]
    fn with_a_region_boxes_are_cut_off_in_between() {
        // Deviation 3: boxes of 5, 6 and 6 pixels. Everything but the region is transparent all along.
        let region = IntRect::from_ltrb(0, 0, 30, 1);
        let mut image = Image::new(region).unwrap();
        image.pixels_mut().fill([255; 4]);
        let by = Blur::new(3.0);
        assert_eq!(widths(3.0), [5, 6, 6]);
        let out = blur(&image, region, Some(region), &by, &Blur::new(0.0), WORK).unwrap();
        let mut line = vec![255.0; 30];
        for (width, before) in [(5, 2), (6, 3), (6, 2)] {
            let value = |x: isize| usize::try_from(x).ok().and_then(|x| line.get(x)).copied().unwrap_or(0.0_f64);
            line = (0..30).map(|x| (0..width).map(|k| value(x - before + k)).sum::<f64>() / width as f64).collect();
        }
        for (x, expected) in line.iter().enumerate() {
            let found = f64::from(out.pixels()[x][3]);
            // Three roundings.
            assert!((found - expected).abs() < 1.6, "{x}: {found}, {expected}");
        }
        // A part of it is the same.
        let area = IntRect::from_ltrb(2, 0, 5, 1);
        let part = blur(&image, area, Some(region), &by, &Blur::new(0.0), WORK).unwrap();
        assert_eq!(part, out.crop(area).unwrap());
    }

    #[test]
    fn wide_blurs_do_not_move_the_picture() {
        for deviation in [100.0, 104.0, 105.0, 106.0, 107.0, 108.0, 1200.0, 1201.0, 1202.0] {
            let size = (deviation * 3.2) as i32;
            let mut image = Image::new(IntRect::from_ltrb(-9, 0, 10, 1)).unwrap();
            image.pixels_mut().fill([255; 4]);
            // Enough of them that something is left.
            let area = IntRect::from_ltrb(-size, 0, size + 1, 1);
            let mut wide = image.crop(IntRect::from_ltrb(-size / 2, 0, size / 2 + 1, 1)).unwrap();
            wide.pixels_mut().fill([255; 4]);
            for region in [None, Some(area)] {
                let out = blur(&wide, area, region, &Blur::new(deviation), &Blur::new(0.0), WORK).unwrap();
                for x in 0..size {
                    let (left, right) = (out.part(0, -x, 1 - x).1, out.part(0, x, x + 1).1);
                    let value = |part: &[[u8; 4]]| part.first().map_or(0, |pixel| pixel[3]);
                    assert!(value(left).abs_diff(value(right)) <= 1, "{deviation} {region:?} at {x}");
                }
            }
        }
    }

    #[test]
    fn colours_stay_below_alpha_and_extremes_end() {
        let source = noise(IntRect::from_ltrb(0, 0, 64, 64), 9);
        for deviation in [0.6, 2.5, 5.0, 1000.0, 1e9, f32::INFINITY] {
            let out = gaussian(&source, source.bounds(), deviation, WORK).unwrap();
            assert!(out.pixels().iter().all(|[r, g, b, a]| r <= a && g <= a && b <= a), "{deviation}");
        }
        let out = gaussian(&source, source.bounds(), f32::NAN, WORK).unwrap();
        assert_eq!(out, source);
    }
}
