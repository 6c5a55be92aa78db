//! Whether engines drew the same thing: without that their times mean nothing.

use std::path::Path;

/// Engines differ along edges: that averages out over squares of so many pixels a side.
const BLOCK: usize = 16;

/// A square whose averages lie further apart than this was drawn otherwise.
const BLOCK_LIMIT: f64 = 32.0;

/// The share of such squares that is borne: supersamplers and signed areas part where many edges cross in each pixel.
const SHARE_LIMIT: f64 = 0.01;

/// The mean difference of all channels that is borne: where edges lie closer than pixels it is large, and the squares' averages
/// decide.
const MEAN_LIMIT: f64 = 16.0;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Of all channels of all pixels, in 1/255.
    pub mean: f64,
    pub max: u8,
    /// The share of squares whose averages are far apart.
    pub blocks: f64,
}

impl Difference {
    /// Of two pictures of premultiplied RGBA8 with the given width.
    pub fn between(one: &[u8], other: &[u8], width: usize) -> Self {
        if one.len() != other.len() || one.is_empty() {
            return Self { mean: 255.0, max: 255, blocks: 1.0 };
        }
        let (mut sum, mut max) = (0_u64, 0);
        let columns = width.div_ceil(BLOCK);
        let rows = (one.len() / 4).div_ceil(width * BLOCK);
        let mut blocks = vec![[0_i64; 4]; columns * rows];
        let mut sizes = vec![0_i64; columns * rows];
        for (index, (a, b)) in one.as_chunks::<4>().0.iter().zip(other.as_chunks::<4>().0).enumerate() {
            let block = index / width / BLOCK * columns + index % width / BLOCK;
            sizes[block] += 1;
            for channel in 0..4 {
                let difference = a[channel].abs_diff(b[channel]);
                sum += u64::from(difference);
                max = max.max(difference);
                blocks[block][channel] += i64::from(a[channel]) - i64::from(b[channel]);
            }
        }
        let far = blocks
            .iter()
            .zip(&sizes)
            .filter(|(block, size)| block.iter().any(|channel| channel.abs() as f64 > BLOCK_LIMIT * **size as f64));
        Self { mean: sum as f64 / one.len() as f64, max, blocks: far.count() as f64 / blocks.len() as f64 }
    }

    pub fn is_the_same_thing(self) -> bool {
        self.mean <= MEAN_LIMIT && self.blocks <= SHARE_LIMIT
    }
}

/// Writes a picture of premultiplied RGBA8 over white as a PNG.
pub fn write(folder: &Path, name: &str, picture: &[u8], width: u32, height: u32) -> Result<(), String> {
    let rgb: Vec<u8> = picture
        .as_chunks::<4>()
        .0
        .iter()
        .flat_map(|[r, g, b, a]| [r, g, b].map(|channel| channel.saturating_add(255 - a)))
        .collect();
    let file = folder.join(format!("{name}.png"));
    std::fs::create_dir_all(folder)
        .map_err(|error| error.to_string())
        .and_then(|()| {
            image::save_buffer(&file, &rgb, width, height, image::ExtendedColorType::Rgb8)
                .map_err(|error| error.to_string())
        })
        .map_err(|error| format!("{}: {error}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::Difference;

    #[test]
    fn a_moved_square_is_another_picture_and_a_soft_edge_is_not() {
        let picture = |left: usize, edge: u8| -> Vec<u8> {
            let column = |x: usize| match x {
                _ if x == left => edge,
                _ if (left..left + 64).contains(&x) => 0,
                _ => 255,
            };
            (0..128 * 128).flat_map(|index| [column(index % 128), 255, 255, 255]).collect()
        };
        let soft = Difference::between(&picture(10, 100), &picture(10, 110), 128);
        assert_eq!(soft.max, 10);
        assert!(soft.is_the_same_thing(), "{soft:?}");
        assert!(!Difference::between(&picture(10, 0), &picture(20, 0), 128).is_the_same_thing());
        assert!(!Difference::between(&picture(10, 0), &[255; 4], 128).is_the_same_thing());
    }
}
