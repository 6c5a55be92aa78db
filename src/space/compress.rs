//! Lossless compression of tiles, and the tiled order of texels.
//!
//! As graphics hardware stores its buffers: a tile that was cleared, or is of one value, takes one; a tile of depths that one triangle
//! covers is a plane and a few small differences (Hasselgren and Akenine-Möller, *Efficient depth buffer compression*, 2006).

/// A compressed tile of 8 × 8 values, rows top down.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TileCode {
    /// All values are the buffer's clear value: nothing is stored. A fast clear makes every tile this.
    Cleared,
    /// All values are this one.
    Constant(u32),
    /// value = `start` + `right`·x + `down`·y + difference, the differences −8 ..= 7 packed two a byte, row by row. All
    /// sums wrap around.
    Plane {
        /// The value at (0, 0).
        start: u32,
        /// Step to the right.
        right: u32,
        /// Step down.
        down: u32,
        /// The differences plus 8: the even column in the low four bits.
        differences: Box<[u8; 32]>,
    },
    /// Too varied: as it is.
    Raw(Box<[u32; 64]>),
}

impl TileCode {
    /// Compresses a tile; `clear` is the buffer's clear value.
    pub fn compress(tile: &[[u32; 8]; 8], clear: u32) -> Self {
        let first = tile[0][0];
        if tile.iter().flatten().all(|v| *v == first) {
            return if first == clear { Self::Cleared } else { Self::Constant(first) };
        }
        // The plane through three corners, its steps rounded towards the far ones.
        let step = |far: u32| (far.wrapping_sub(first) as i32).div_euclid(7) as u32;
        for (extra_x, extra_y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let right = step(tile[0][7]).wrapping_add(extra_x);
            let down = step(tile[7][0]).wrapping_add(extra_y);
            let mut differences = Box::new([0_u8; 32]);
            let fits = tile.iter().enumerate().all(|(y, row)| {
                row.iter().enumerate().all(|(x, value)| {
                    let plane =
                        first.wrapping_add(right.wrapping_mul(x as u32)).wrapping_add(down.wrapping_mul(y as u32));
                    let difference = value.wrapping_sub(plane).wrapping_add(8);
                    differences[y * 4 + x / 2] |= (difference as u8 & 15) << (4 * (x % 2));
                    difference < 16
                })
            });
            if fits {
                return Self::Plane { start: first, right, down, differences };
            }
        }
        let mut raw = Box::new([0; 64]);
        raw.copy_from_slice(tile.as_flattened());
        Self::Raw(raw)
    }

    /// The tile again, bit for bit.
    pub fn expand(&self, clear: u32) -> [[u32; 8]; 8] {
        match self {
            Self::Cleared => [[clear; 8]; 8],
            Self::Constant(value) => [[*value; 8]; 8],
            Self::Plane { start, right, down, differences } => std::array::from_fn(|y| {
                std::array::from_fn(|x| {
                    let difference = u32::from(differences[y * 4 + x / 2] >> (4 * (x % 2)) & 15);
                    let plane =
                        start.wrapping_add(right.wrapping_mul(x as u32)).wrapping_add(down.wrapping_mul(y as u32));
                    plane.wrapping_add(difference).wrapping_sub(8)
                })
            }),
            Self::Raw(raw) => std::array::from_fn(|y| std::array::from_fn(|x| raw[8 * y + x])),
        }
    }

    /// Bytes that hardware would move for the tile, without the tag.
    pub fn size(&self) -> usize {
        match self {
            Self::Cleared => 0,
            Self::Constant(_) => 4,
            Self::Plane { .. } => 44,
            Self::Raw(_) => 256,
        }
    }
}

/// Where the texel (x, y) of a picture of `width` columns lies in tiled order: 4 × 4 tiles row by row, texels of a tile row by row. Neighbours in
/// either direction then mostly share a cache line.
pub fn tiled_index(x: usize, y: usize, width: usize) -> usize {
    let tiles = width.div_ceil(4);
    ((y / 4) * tiles + x / 4) * 16 + (y % 4) * 4 + x % 4
}

/// Texels in rows to tiled order, the last tiles padded with 0. `None` unless there are width × height of them.
pub fn to_tiled(texels: &[u32], width: usize, height: usize) -> Option<Vec<u32>> {
    if width.checked_mul(height)? != texels.len() {
        return None;
    }
    let mut out = vec![0; width.div_ceil(4) * height.div_ceil(4) * 16];
    for (i, texel) in texels.iter().enumerate() {
        *out.get_mut(tiled_index(i % width, i / width, width))? = *texel;
    }
    Some(out)
}
