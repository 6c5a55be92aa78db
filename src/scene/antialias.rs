//! Antialiasing of whole pictures: averages, FXAA, and where samples go from frame to frame.

use crate::error::{Error, Result};
use crate::num::lanes::div255;
use crate::surface::Pixmap;

/// The mean of each n × n pixels, rounded to nearest: supersampling's second half.
///
/// # Errors
/// [`Error::Parameter`] unless both sides are multiples of `n`, which is 1 ..= 16.
pub fn box_average(picture: &Pixmap, n: u32) -> Result<Pixmap> {
    if !(1..=16).contains(&n) || !picture.width().is_multiple_of(n) || !picture.height().is_multiple_of(n) {
        return Err(Error::Parameter(format!(
            "{} × {} pixels are not whole blocks of {n} × {n}, or {n} is not 1 to 16",
            picture.width(),
            picture.height()
        )));
    }
    gather(picture, picture.width() / n, picture.height() / n, |x, y| (x * n, y * n), n, n)
}

/// Shared samples: six for two pixels instead of eight. `samples` has one column more than the picture and twice its rows: the samples
/// lie on the vertical sides of pixels, two a side, so that neighbours share them; each pixel is the mean of its four.
///
/// # Errors
/// [`Error::Parameter`] unless `samples` has at least 2 columns and an even number of rows.
pub fn shared_samples(samples: &Pixmap) -> Result<Pixmap> {
    if samples.width() < 2 || !samples.height().is_multiple_of(2) {
        return Err(Error::Parameter("shared samples need at least 2 columns and an even number of rows".to_owned()));
    }
    gather(samples, samples.width() - 1, samples.height() / 2, |x, y| (x, 2 * y), 2, 2)
}

/// Each pixel as the mean of a block of another picture.
fn gather(
    from: &Pixmap,
    width: u32,
    height: u32,
    start: impl Fn(u32, u32) -> (u32, u32),
    columns: u32,
    rows: u32,
) -> Result<Pixmap> {
    let mut out = Pixmap::new(width, height)?;
    let count = columns * rows;
    for (i, pixel) in out.data_mut().as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let (x, y) = start(i as u32 % width, i as u32 / width);
        let mut sums = [0_u32; 4];
        for (j, k) in (0..rows).flat_map(|j| (0..columns).map(move |k| (j, k))) {
            for (sum, v) in sums.iter_mut().zip(from.pixel(x + k, y + j).unwrap_or_default()) {
                *sum += u32::from(v);
            }
        }
        *pixel = sums.map(|sum| ((2 * sum + count) / (2 * count)) as u8);
    }
    Ok(out)
}

/// Fast approximate antialiasing (after Lottes, *FXAA*, 2009): where brightness changes sharply, the pixel is mixed with its neighbours across the
/// edge, by how far along the edge its ends are. Pixels whose neighbourhood differs by less than a sixteenth, and by less than an eighth of its
/// brightest, stay bit for bit.
///
/// # Errors
/// [`Error::Limit`] where memory is not to be had.
pub fn fxaa(picture: &Pixmap) -> Result<Pixmap> {
    let mut out = Pixmap::new(picture.width(), picture.height())?;
    let (width, height) = (picture.width() as i32, picture.height() as i32);
    let pixels = picture.data().as_chunks::<4>().0;
    let at = |x: i32, y: i32| {
        let (x, y) = (x.clamp(0, width - 1), y.clamp(0, height - 1));
        pixels.get((y * width + x) as usize).copied().unwrap_or_default()
    };
    // Brightness with alpha, so that silhouettes on a transparent ground count, in sums of 1/256.
    let luma = |x: i32, y: i32| {
        let [r, g, b, a] = at(x, y).map(i32::from);
        (r * 54 + g * 183 + b * 19 + a * 64) / 5
    };
    for (i, pixel) in out.data_mut().as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let (x, y) = (i as i32 % width, i as i32 / width);
        let (m, n, s, w, e) = (luma(x, y), luma(x, y - 1), luma(x, y + 1), luma(x - 1, y), luma(x + 1, y));
        let (least, most) = (m.min(n).min(s).min(w).min(e), m.max(n).max(s).max(w).max(e));
        let own = at(x, y);
        *pixel = own;
        if most - least < (most / 8).max(255 * 64 / 16) {
            continue;
        }
        let (nw, ne, sw, se) = (luma(x - 1, y - 1), luma(x + 1, y - 1), luma(x - 1, y + 1), luma(x + 1, y + 1));
        let level = 2 * (n + s - 2 * m).abs() + (nw + sw - 2 * w).abs() + (ne + se - 2 * e).abs();
        let upright = 2 * (w + e - 2 * m).abs() + (nw + ne - 2 * n).abs() + (sw + se - 2 * s).abs();
        let horizontal = level >= upright;
        // The side across which the change is larger.
        let (before, after) = if horizontal { (n, s) } else { (w, e) };
        let side = if (before - m).abs() >= (after - m).abs() { -1 } else { 1 };
        let step = |k: i32, across: i32| if horizontal { (x + k, y + across) } else { (x + across, y + k) };
        let pair = |k: i32| {
            let ((ax, ay), (bx, by)) = (step(k, 0), step(k, side));
            luma(ax, ay) + luma(bx, by)
        };
        let (middle, contrast) = (pair(0), (if side < 0 { before } else { after } - m).abs());
        // Along the edge both ways until its pair of pixels differs.
        let mut ends = [(0, 0); 2];
        for (end, sign) in ends.iter_mut().zip([-1, 1]) {
            for k in 1..=16 {
                let difference = pair(sign * k) - middle;
                *end = (k, difference);
                if 2 * difference.abs() >= contrast {
                    break;
                }
            }
        }
        let (near, length) = (if ends[0].0 <= ends[1].0 { ends[0] } else { ends[1] }, ends[0].0 + ends[1].0);
        // Only where the nearer end bends to the other side is this pixel on the part that the edge crosses.
        let inner = (near.1 < 0) != (2 * m - middle < 0);
        let mut share = if inner { 128 - 256 * near.0 / (2 * length).max(1) } else { 0 };
        // Single bright or dark pixels: by the contrast with all neighbours.
        let around = (2 * (n + s + w + e) + nw + ne + sw + se) / 12;
        let lonely = (256 * (around - m).abs() / (most - least).max(1)).min(256);
        let lonely = lonely * lonely / 256 * 3 / 4 / 2;
        share = share.max(lonely).clamp(0, 128);
        let (ox, oy) = step(0, side);
        let other = at(ox, oy);
        let weight = (share * 255 / 256) as u32;
        *pixel =
            std::array::from_fn(|c| div255(u32::from(own[c]) * (255 - weight) + u32::from(other[c]) * weight) as u8);
    }
    Ok(out)
}

/// Where the camera's picture is moved to, in pixels, for frame `index` of a jittered sequence: Halton's points of bases 2 and 3,
/// −½ ..= ½ each way.
pub fn jitter(index: u32) -> (f32, f32) {
    let radical = |base: u32| {
        let (mut value, mut scale, mut rest) = (0.0, 1.0 / f64::from(base), index.wrapping_add(1));
        while rest > 0 {
            value += f64::from(rest % base) * scale;
            scale /= f64::from(base);
            rest /= base;
        }
        (value - 0.5) as f32
    };
    (radical(2), radical(3))
}
