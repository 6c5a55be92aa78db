//! Gaussian blur of one channel.

use crate::num::trig;

/// Blurs `data` (rows of `width` bytes) with a Gaussian of standard deviation `deviation` pixels; beyond the
/// edges it is zero.
///
/// Below a deviation of 2 the kernel is the Gaussian itself, cut off at three deviations, in 16-bit
/// weights that sum to one. Above, three box blurs stand for it, with the widths that the SVG
/// specification gives for `feGaussianBlur`; they cost the same at every deviation. All sums are integers.
pub(crate) fn gaussian(data: &mut [u8], width: usize, deviation: f32) {
    if width == 0 || !(deviation > 0.0 && deviation.is_finite()) {
        return;
    }
    let height = data.len() / width;
    let pass: Pass = if deviation < 2.0 { Pass::Kernel(kernel(deviation)) } else { Pass::Boxes(boxes(deviation)) };
    let mut line = vec![0; width.max(height)];
    let mut out = vec![0; width.max(height)];
    for row in data.chunks_exact_mut(width) {
        pass.apply(row, &mut out);
    }
    for x in 0..width {
        let Some(line) = line.get_mut(..height) else { return };
        for (value, source) in line.iter_mut().zip(data.iter().skip(x).step_by(width)) {
            *value = *source;
        }
        pass.apply(line, &mut out);
        for (value, target) in line.iter().zip(data.iter_mut().skip(x).step_by(width)) {
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
            gaussian(&mut data, size, deviation);
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
    fn an_extreme_deviation_ends() {
        let mut data = vec![255; 64 * 64];
        gaussian(&mut data, 64, 1000.0);
        assert!(data.iter().all(|v| *v < 8));
        let mut data = vec![7; 16];
        gaussian(&mut data, 4, f32::NAN);
        assert_eq!(data, [7; 16]);
    }
}
