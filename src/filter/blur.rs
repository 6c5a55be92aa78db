//! Gaussian blur of one channel.

use std::ops::Range;

use crate::geom::IntRect;
use crate::num::trig;

/// Blurs a picture of one channel with a Gaussian of standard deviation `deviation` pixels. `source` holds
/// the pixels `from`, rows top down, and all others are zero; the answer holds the pixels `to`.
///
/// Below a deviation of 2 the kernel is the Gaussian itself, cut off at three deviations, in 16-bit
/// weights that sum to one. Above, three box blurs stand for it, with the widths that the SVG
/// specification gives for `feGaussianBlur`; they cost the same at every deviation. All sums are integers.
pub(crate) fn gaussian(source: &[u8], from: IntRect, to: IntRect, deviation: f32) -> Vec<u8> {
    let pass = match deviation {
        deviation if !(deviation > 0.0 && deviation.is_finite()) => Pass::Kernel(vec![65_536]),
        deviation if deviation < 2.0 => Pass::Kernel(kernel(deviation)),
        deviation => Pass::Boxes(boxes(deviation)),
    };
    let (width, from_width) = (to.width() as usize, from.width() as usize);
    let mut out = vec![0; width * to.height() as usize];
    let reach = pass.reach() as i32;
    let columns = Axis { from: (from.left, from.right), to: (to.left, to.right), reach };
    let rows = Axis { from: (from.top, from.bottom), to: (to.top, to.bottom), reach };
    let (Some(columns), Some(rows)) = (columns.line(), rows.line()) else { return out };
    // Along the rows of the source that matter, and only the columns that are asked for are kept.
    let mut along = vec![0; width * rows.read.len()];
    let mut spare = vec![0; columns.length.max(rows.length)];
    let mut line = vec![0; columns.length];
    if width > 0 && from_width > 0 {
        let used = source.chunks_exact(from_width).skip(rows.read.start);
        for (row, out) in used.zip(along.chunks_exact_mut(width)) {
            columns.blur(&pass, row.iter(), out.iter_mut(), &mut line, &mut spare);
        }
    }
    let rows = Line { read: 0..rows.read.len(), ..rows };
    line.resize(rows.length, 0);
    for x in 0..width {
        let values = along.iter().skip(x).step_by(width);
        rows.blur(&pass, values, out.iter_mut().skip(x).step_by(width), &mut line, &mut spare);
    }
    out
}

/// One direction of a blur: where the source lies, what is asked for, how far the kernel reaches.
struct Axis {
    from: (i32, i32),
    to: (i32, i32),
    reach: i32,
}

/// The part of an axis that has to be computed: as far as both the source and what is asked for reach. What lies
/// beyond cannot come back.
struct Line {
    length: usize,
    /// Which pixels of the source are read, and where in the line the first of them lies.
    read: Range<usize>,
    read_at: usize,
    /// Where in the line the pixels lie that are kept, and which of those asked for is the first of them.
    keep: Range<usize>,
    keep_at: usize,
}

impl Axis {
    /// `None` if nothing of the source reaches what is asked for.
    fn line(&self) -> Option<Line> {
        let start = self.from.0.max(self.to.0) - self.reach;
        let end = self.from.1.min(self.to.1) + self.reach;
        if start >= end {
            return None;
        }
        let cut = |(low, high): (i32, i32)| (low.clamp(start, end), high.clamp(start, end));
        let (read, keep) = (cut(self.from), cut(self.to));
        (read.0 < read.1 && keep.0 < keep.1).then_some(Line {
            length: start.abs_diff(end) as usize,
            read: read.0.abs_diff(self.from.0) as usize..read.1.abs_diff(self.from.0) as usize,
            read_at: read.0.abs_diff(start) as usize,
            keep: keep.0.abs_diff(start) as usize..keep.1.abs_diff(start) as usize,
            keep_at: keep.0.abs_diff(self.to.0) as usize,
        })
    }
}

impl Line {
    fn blur<'a>(
        &self,
        pass: &Pass,
        source: impl Iterator<Item = &'a u8>,
        target: impl Iterator<Item = &'a mut u8>,
        line: &mut [u8],
        spare: &mut [u8],
    ) {
        line.fill(0);
        let source = source.skip(self.read.start).take(self.read.len());
        for (value, source) in line.iter_mut().skip(self.read_at).zip(source) {
            *value = *source;
        }
        pass.apply(line, spare);
        let kept = line.get(self.keep.clone()).unwrap_or(&[]);
        for (target, value) in target.skip(self.keep_at).zip(kept) {
            *target = *value;
        }
    }
}

enum Pass {
    /// Weights from the centre outwards, of 65,536.
    Kernel(Vec<u32>),
    /// For each box how many pixels before and after the centre it takes.
    Boxes([(usize, usize); 3]),
}

impl Pass {
    /// How far a pixel spreads, to either side.
    fn reach(&self) -> usize {
        match self {
            Self::Kernel(weights) => weights.len().saturating_sub(1),
            Self::Boxes(boxes) => boxes.iter().map(|(before, after)| (*before).max(*after)).sum(),
        }
    }

    fn apply(&self, line: &mut [u8], out: &mut [u8]) {
        let Some(out) = out.get_mut(..line.len()) else { return };
        match self {
            Self::Kernel(weights) => {
                for (x, out) in out.iter_mut().enumerate() {
                    let mut sum = 32_768;
                    for (distance, weight) in weights.iter().enumerate() {
                        let value = |at: Option<usize>| u32::from(at.and_then(|at| line.get(at)).copied().unwrap_or(0));
                        sum += weight * value(Some(x + distance));
                        if distance > 0 {
                            sum += weight * value(x.checked_sub(distance));
                        }
                    }
                    *out = (sum >> 16) as u8;
                }
                line.copy_from_slice(out);
            }
            Self::Boxes(boxes) => {
                for &(before, after) in boxes {
                    box_blur(line, out, before, after);
                    line.copy_from_slice(out);
                }
            }
        }
    }
}

fn box_blur(line: &[u8], out: &mut [u8], before: usize, after: usize) {
    let size = (before + after + 1) as u32;
    let mut sum: u32 = line.iter().take(after).map(|v| u32::from(*v)).sum();
    for (x, out) in out.iter_mut().enumerate() {
        sum += u32::from(line.get(x + after).copied().unwrap_or(0));
        *out = ((sum + size / 2) / size) as u8;
        if let Some(value) = x.checked_sub(before).and_then(|at| line.get(at)) {
            sum -= u32::from(*value);
        }
    }
}

fn kernel(deviation: f32) -> Vec<u32> {
    let deviation = f64::from(deviation);
    let reach = (deviation * 3.0).ceil() as usize;
    let raw: Vec<f64> = (0..=reach).map(|x| trig::exp(-((x * x) as f64) / (2.0 * deviation * deviation))).collect();
    let total = raw.iter().sum::<f64>() * 2.0 - 1.0;
    let mut weights: Vec<u32> = raw.iter().map(|w| (w / total * 65_536.0 + 0.5) as u32).collect();
    let others: u32 = weights.iter().skip(1).sum();
    if let Some(first) = weights.first_mut() {
        *first = 65_536 - 2 * others;
    }
    weights
}

/// The widths of Filter Effects Module Level 1, `feGaussianBlur`: three boxes of odd size d, or for an
/// even d two that are off-centre to either side and one of d + 1.
fn boxes(deviation: f32) -> [(usize, usize); 3] {
    let d = (f64::from(deviation) * 3.0 * (core::f64::consts::TAU).sqrt() / 4.0 + 0.5).floor() as usize;
    let half = d / 2;
    if d % 2 == 1 { [(half, half); 3] } else { [(half, half - 1), (half - 1, half), (half, half)] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blur_keeps_the_total_and_has_the_deviation_asked_for() {
        for deviation in [0.5, 1.0, 1.9, 2.0, 5.0, 12.0] {
            let size = 129;
            let mut data = vec![0; size * size];
            let start = 55;
            for y in 0..19 {
                for x in 0..19 {
                    data[(start + y) * size + start + x] = 255;
                }
            }
            let all = IntRect::from_xywh(0, 0, size as u32, size as u32);
            let data = gaussian(&data, all, all, deviation);
            let total: f64 = data.iter().map(|v| f64::from(*v)).sum();
            assert!((total / (19.0 * 19.0 * 255.0) - 1.0).abs() < 0.03, "{deviation}: {total}");
            let variance: f64 = (0..size * size)
                .map(|i| f64::from(data[i]) * ((i % size) as f64 - 64.0) * ((i % size) as f64 - 64.0))
                .sum::<f64>()
                / total;
            let own = (19.0 * 19.0 - 1.0) / 12.0;
            let got = (variance - own).max(0.0).sqrt();
            // Three boxes of d = 9 stand for a deviation of 5: √(3 · (81 − 1) / 12) = 4.47, and so on.
            assert!((got - f64::from(deviation)).abs() < 0.12 * f64::from(deviation) + 0.05, "{deviation}: {got}");
        }
    }

    #[test]
    fn a_part_is_what_the_whole_has_there() {
        let from = IntRect::from_ltrb(40, 30, 52, 39);
        let source: Vec<u8> = (0..12 * 9).map(|i| (i * 37 % 256) as u8).collect();
        for deviation in [0.0, 0.7, 1.9, 2.0, 3.3, 8.0] {
            let all = IntRect::from_ltrb(0, 0, 100, 80);
            let whole = gaussian(&source, from, all, deviation);
            assert!(whole.iter().any(|v| *v > 0));
            for part in [
                IntRect::from_ltrb(42, 31, 50, 35),
                IntRect::from_ltrb(30, 20, 46, 70),
                IntRect::from_ltrb(50, 10, 99, 34),
                IntRect::from_ltrb(0, 0, 3, 3),
            ] {
                let found = gaussian(&source, from, part, deviation);
                let expected: Vec<u8> = (part.top..part.bottom)
                    .flat_map(|y| (part.left..part.right).map(move |x| (x, y)))
                    .map(|(x, y)| whole[(y * 100 + x) as usize])
                    .collect();
                assert_eq!(found, expected, "{part:?} {deviation}");
            }
        }
    }

    #[test]
    fn an_extreme_deviation_ends() {
        let all = IntRect::from_xywh(0, 0, 64, 64);
        assert!(gaussian(&[255; 64 * 64], all, all, 1000.0).iter().all(|v| *v < 8));
        let all = IntRect::from_xywh(0, 0, 4, 4);
        assert_eq!(gaussian(&[7; 16], all, all, f32::NAN), [7; 16]);
    }
}
