//! Fetched blocks against the formulas in `f64`, against tiny-skia, and against themselves at every level.

mod against_oracle;
mod against_tiny_skia;
mod degenerate;
mod oracle;
mod random;

use super::fetch::fetch_block;
use super::prepare::PreparedPaint;
use crate::num::level::{SimdLevel, dispatch};

/// The pixels of width × height from (left, top) on, in blocks aligned to (left, top).
fn render(paint: &PreparedPaint, level: SimdLevel, [left, top]: [i32; 2], [width, height]: [usize; 2]) -> Vec<[u8; 4]> {
    let mut pixels = vec![[0; 4]; width * height];
    let mut block = [[1; 64]; 8];
    for y in (0..height).step_by(8) {
        for x in (0..width).step_by(16) {
            let (block_x, block_y) = (left.wrapping_add(x as i32), top.wrapping_add(y as i32));
            dispatch!(level, simd => fetch_block(simd, paint, block_x, block_y, &mut block));
            for (row, line) in block.iter().enumerate().take(height - y) {
                for (column, pixel) in line.as_chunks::<4>().0.iter().enumerate().take(width - x) {
                    pixels[(y + row) * width + x + column] = *pixel;
                }
            }
        }
    }
    pixels
}
