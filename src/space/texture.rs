//! Textures of one, two and three dimensions, with mipmaps, sampled eight pixels at a time.
//!
//! Each texel is kept beside the one below it, with one more column at the right that repeats the first (or last): the four texels
//! of a bilinear sample are then one load of 16 bytes, whatever the address mode. Fractions are 8 bits, products 16.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, u16x16, u32x8};

use crate::error::{Error, Result};
use crate::num::lanes::{max_f32, min_f32, truncate_f32};
use crate::surface::{Limits, Pixmap};

/// What lies beyond a texture's sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Address {
    /// The texture again: the default.
    #[default]
    Wrap,
    /// The texel at the side.
    Clamp,
    /// The texture mirrored, and so on.
    Mirror,
}

/// How texels become a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The texel that the place is in.
    Nearest,
    /// The four (in 3D eight) texels around, by distance, of the full size.
    Bilinear,
    /// The same of the two mipmap levels whose texels are about as large as a pixel, by their distance: the default.
    #[default]
    Trilinear,
}

/// How a [`Texture`] is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Beyond the sides, for u, v and the third coordinate.
    pub address: [Address; 3],
    /// Between texels.
    pub filter: Filter,
}

impl Sampler {
    /// The same address mode in all directions.
    pub fn new(address: Address, filter: Filter) -> Self {
        Self { address: [address; 3], filter }
    }
}

/// One size of a texture.
#[derive(Clone, Debug)]
struct Level {
    width: i32,
    height: i32,
    depth: i32,
    /// (width + 1) × height pairs a slice: a texel and the one below.
    pairs: Vec<[u32; 2]>,
}

/// A texture of premultiplied RGBA8 texels, with its mipmaps and its sampler.
///
/// u, v and the third coordinate run from 0 to 1 over the texels' outer sides; (0, 0) is the first texel's corner, v grows with rows.
#[derive(Clone, Debug)]
pub struct Texture {
    sampler: Sampler,
    levels: Vec<Level>,
}

/// Texels of one size, plain.
struct Plain {
    size: [usize; 3],
    texels: Vec<u32>,
}

impl Texture {
    /// A texture of `width` × `height` × `depth` texels (premultiplied RGBA8, red lowest), rows of the first slice first. One-dimensional
    /// ones have height and depth 1, two-dimensional ones depth 1. Mipmaps are made for [`Filter::Trilinear`]: each level has half the
    /// size of the one before, rounded down, each texel the mean of what it covers.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a size with a 0 or another number of texels; [`Error::Limit`] for more texels than
    /// [`Limits::default`] allows pixels, or a side over 32,767.
    pub fn new(width: u32, height: u32, depth: u32, texels: Vec<u32>, sampler: Sampler) -> Result<Self> {
        let limits = Limits::default();
        limits.check(width, height)?;
        limits.check(depth, 1)?;
        let count = u64::from(width) * u64::from(height) * u64::from(depth);
        if count > limits.max_pixels / 4 {
            return Err(Error::Limit(format!("a texture of {width} × {height} × {depth} texels is over the limit")));
        }
        if texels.len() as u64 != count {
            return Err(Error::Parameter(format!(
                "a texture of {width} × {height} × {depth} texels needs {count}, not {}",
                texels.len()
            )));
        }
        let mut plain = Plain { size: [width, height, depth].map(|v| v as usize), texels };
        let mut levels = vec![Level::new(&plain, sampler)?];
        if sampler.filter == Filter::Trilinear {
            while plain.size != [1; 3] {
                plain = plain.halved();
                levels.push(Level::new(&plain, sampler)?);
            }
        }
        Ok(Self { sampler, levels })
    }

    /// A two-dimensional texture from a picture.
    ///
    /// # Errors
    /// As [`Texture::new`].
    pub fn from_pixmap(pixmap: &Pixmap, sampler: Sampler) -> Result<Self> {
        let Plain { size: [width, height, _], texels } = Plain::of(pixmap);
        Self::new(width as u32, height as u32, 1, texels, sampler)
    }

    /// The same for textures that take at most so many bytes: half the picture's size, a quarter and so on, where it is larger.
    #[cfg(feature = "mesh")]
    pub(crate) fn within(pixmap: Pixmap, sampler: Sampler, most: usize) -> Result<Self> {
        let mut plain = Plain::of(&pixmap);
        // What it was is as large as what it becomes.
        drop(pixmap);
        while plain.size != [1; 3] && plain.texture_bytes(sampler) > most {
            plain = plain.halved();
        }
        let [width, height, _] = plain.size;
        Self::new(width as u32, height as u32, 1, plain.texels, sampler)
    }

    /// The bytes of its levels.
    #[cfg(feature = "mesh")]
    pub(crate) fn bytes(&self) -> usize {
        self.levels.iter().map(|level| size_of_val(&level.pairs[..])).sum()
    }

    /// The same texels with another filter; mipmaps are made or left out as it needs.
    ///
    /// # Errors
    /// [`Error::Limit`] where memory is not to be had.
    pub fn with_filter(&self, filter: Filter) -> Result<Self> {
        let [width, height, depth] = self.size();
        let rows = self.levels.first().map(|level| level.pairs.chunks(width as usize + 1)).into_iter().flatten();
        let texels = rows.flat_map(|row| row.iter().take(width as usize).map(|pair| pair[0])).collect();
        Self::new(width, height, depth, texels, Sampler { filter, ..self.sampler })
    }

    /// Texels along u, v and the third direction.
    pub fn size(&self) -> [u32; 3] {
        let [level, ..] = &self.levels[..] else { return [1; 3] };
        [level.width, level.height, level.depth].map(|v| v as u32)
    }

    /// Mipmap levels, the full size included.
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// How it is sampled.
    pub fn sampler(&self) -> Sampler {
        self.sampler
    }

    /// A texel of a mipmap level, or `None` outside.
    pub fn texel(&self, level: usize, x: u32, y: u32, z: u32) -> Option<u32> {
        let level = self.levels.get(level)?;
        let inside = x < level.width as u32 && y < level.height as u32 && z < level.depth as u32;
        let row = z as usize * level.height as usize + y as usize;
        inside.then(|| level.pairs.get(row * (level.width as usize + 1) + x as usize).map(|pair| pair[0]))?
    }

    /// Samples the full size at (u, v), by the sampler's filter: packed premultiplied RGBA8.
    #[inline(always)]
    pub fn sample<S: Simd>(&self, u: f32x8<S>, v: f32x8<S>) -> u32x8<S> {
        let Some(level) = self.levels.first() else { return u32x8::splat(u.simd, 0) };
        match self.sampler.filter {
            Filter::Nearest => level.nearest(self.sampler, u, v, 0),
            Filter::Bilinear | Filter::Trilinear => level.bilinear(self.sampler, u, v, 0),
        }
    }

    /// Samples at (u, v) with the derivatives of u and v per pixel, right and down, which choose the mipmap levels for
    /// [`Filter::Trilinear`]: the level is log₂ of the longer side of a pixel in texels, within 0.01.
    #[inline(always)]
    pub fn sample_grad<S: Simd>(
        &self,
        u: f32x8<S>,
        v: f32x8<S>,
        (ux, uy): (f32x8<S>, f32x8<S>),
        (vx, vy): (f32x8<S>, f32x8<S>),
    ) -> u32x8<S> {
        if self.levels.len() <= 1 {
            return self.sample(u, v);
        }
        let [width, height, _] = self.size();
        let (width, height) = (width as f32, height as f32);
        let (ux, uy, vx, vy) = (ux * width, uy * width, vx * height, vy * height);
        let across = ux * ux + vx * vx;
        let down = uy * uy + vy * vy;
        let longest = across.simd_gt(down).select(across, down);
        self.sample_level(u, v, rough_log2(longest) * 0.5)
    }

    /// Samples at (u, v) between the mipmap levels around `lod` (0 is the full size), clamped to those that there are.
    #[inline(always)]
    pub fn sample_level<S: Simd>(&self, u: f32x8<S>, v: f32x8<S>, lod: f32x8<S>) -> u32x8<S> {
        let simd = u.simd;
        let last = self.levels.len().saturating_sub(1);
        // NaN compares false, and becomes 0.
        let lod = max_f32(lod, f32x8::splat(simd, 0.0));
        let lod = min_f32(lod, f32x8::splat(simd, last as f32));
        let fixed = truncate_f32(lod * 256.0);
        let whole = fixed >> 8;
        let fraction: u32x8<S> = (fixed & 255).bitcast();
        let blended = fraction.simd_gt(u32x8::splat(simd, 0)).any_true();
        let values = whole.to_array();
        let (mut first, mut end) = (values[0], values[0]);
        for value in values {
            first = first.min(value);
            end = end.max(value);
        }
        let mut out = u32x8::splat(simd, 0);
        for level in first..=end {
            let (Some(large), Some(small)) =
                (self.levels.get(level as usize), self.levels.get((level as usize + 1).min(last)))
            else {
                continue;
            };
            let a = large.bilinear(self.sampler, u, v, 0);
            // Where texels are enlarged, nothing of the next level is seen.
            let mixed = if blended { mix(a, small.bilinear(self.sampler, u, v, 0), both_halves(fraction)) } else { a };
            out = if first == end { mixed } else { whole.simd_eq(i32x8::splat(simd, level)).select(mixed, out) };
        }
        out
    }

    /// Samples a three-dimensional texture at (u, v, w) in its full size.
    #[inline(always)]
    pub fn sample_3d<S: Simd>(&self, u: f32x8<S>, v: f32x8<S>, w: f32x8<S>) -> u32x8<S> {
        let simd = u.simd;
        let Some(level) = self.levels.first() else { return u32x8::splat(simd, 0) };
        let nearest = self.sampler.filter == Filter::Nearest;
        let address = self.sampler.address[2];
        let (slices, fraction) = if nearest {
            (texel_of(w, level.depth, address), i32x8::splat(simd, 0))
        } else {
            let place = place_of(w, level.depth, address);
            (place >> 8, place & 255)
        };
        let (slices, mut out) = (slices.to_array(), u32x8::splat(simd, 0));
        let mut done = [false; 8];
        for lane in 0..8 {
            if done[lane] {
                continue;
            }
            let slice = slices[lane];
            let above = match address {
                Address::Wrap if slice + 1 >= level.depth => 0,
                _ => (slice + 1).min(level.depth - 1),
            };
            let value = if nearest {
                level.nearest(self.sampler, u, v, slice)
            } else {
                let a = level.bilinear(self.sampler, u, v, slice);
                let b = level.bilinear(self.sampler, u, v, above);
                mix(a, b, both_halves(fraction.bitcast()))
            };
            let (value, out) = (value.to_array(), out.as_mut_array());
            for i in 0..8 {
                if slices[i] == slice {
                    done[i] = true;
                    out[i] = value[i];
                }
            }
        }
        out
    }
}

/// log₂ of positive floats, within 0.01, without a division.
#[inline(always)]
fn rough_log2<S: Simd>(v: f32x8<S>) -> f32x8<S> {
    let bits: i32x8<S> = v.bitcast();
    let exponent: f32x8<S> = ((bits >> 23) - 128).to_float();
    let m: f32x8<S> = ((bits & 0x007f_ffff) | 0x3f80_0000).bitcast();
    exponent + (m * -0.335_828_78 + 2.0) * m - 0.658_718_7
}

/// A coordinate brought into 0 ..= 1 by the address mode. Not a number and beyond ±10⁶: 0 or clamped.
#[inline(always)]
fn folded<S: Simd>(u: f32x8<S>, address: Address) -> f32x8<S> {
    let simd = u.simd;
    let (zero, one) = (f32x8::splat(simd, 0.0), f32x8::splat(simd, 1.0));
    let limit = |u: f32x8<S>| {
        let u = u.simd_gt(f32x8::splat(simd, -1e6)).select(u, f32x8::splat(simd, -1e6));
        u.simd_lt(f32x8::splat(simd, 1e6)).select(u, f32x8::splat(simd, 1e6))
    };
    let floor = |u: f32x8<S>| {
        let whole: f32x8<S> = truncate_f32(u).to_float();
        whole.simd_gt(u).select(whole - 1.0, whole)
    };
    match address {
        Address::Clamp => min_f32(max_f32(u, zero), one),
        Address::Wrap => {
            let u = limit(u);
            u - floor(u)
        }
        Address::Mirror => {
            let u = limit(u);
            let u = u - floor(u * 0.5) * 2.0;
            u.simd_gt(one).select(f32x8::splat(simd, 2.0) - u, u)
        }
    }
}

/// The texel that a coordinate falls in.
#[inline(always)]
fn texel_of<S: Simd>(u: f32x8<S>, size: i32, address: Address) -> i32x8<S> {
    let x = truncate_f32(folded(u, address) * size as f32);
    let last = i32x8::splat(u.simd, size - 1);
    x.simd_gt(last).select(last, x)
}

/// Where a coordinate lies among the centres of texels, in 24.8 fixed point, 0 at the first centre; what is left of it wraps to the
/// last or stays. The whole part is a texel.
#[inline(always)]
fn place_of<S: Simd>(u: f32x8<S>, size: i32, address: Address) -> i32x8<S> {
    let simd = u.simd;
    // One texel more, so that truncation rounds down; ½ of a texel is the centre, ½ of 1/256 rounds to nearest.
    let place = truncate_f32(folded(u, address) * (size as f32 * 256.0) + (256.0 - 128.0 + 0.5)) - 256;
    let end = size << 8;
    let negative = place.simd_lt(i32x8::splat(simd, 0));
    match address {
        Address::Wrap => {
            let place = negative.select(place + end, place);
            place.simd_ge(i32x8::splat(simd, end)).select(place - end, place)
        }
        Address::Clamp | Address::Mirror => {
            let place = negative.select(i32x8::splat(simd, 0), place);
            let last = i32x8::splat(simd, end - 256);
            place.simd_gt(last).select(last, place)
        }
    }
}

/// A factor of each pixel in both 16-bit halves of its lane.
#[inline(always)]
fn both_halves<S: Simd>(factor: u32x8<S>) -> u16x16<S> {
    (factor | factor << 16).bitcast()
}

/// ⌊(a·(256 − f) + b·f + 128) / 256⌋ of each component, f in 0 ..= 255.
#[inline(always)]
fn mix<S: Simd>(a: u32x8<S>, b: u32x8<S>, f: u16x16<S>) -> u32x8<S> {
    let (a, b): (u16x16<S>, u16x16<S>) = (a.bitcast(), b.bitcast());
    let rest = u16x16::splat(f.simd, 256) - f;
    let even = ((a & 255) * rest + (b & 255) * f + 128) >> 8;
    let odd = ((a >> 8) * rest + (b >> 8) * f + 128) & 0xff00;
    (even | odd).bitcast()
}

impl Level {
    fn new(plain: &Plain, sampler: Sampler) -> Result<Self> {
        let [width, height, depth] = plain.size;
        let mut pairs = Vec::new();
        let length = (width + 1) * height * depth;
        pairs.try_reserve_exact(length).map_err(|_| Error::Limit(format!("no memory for {length} texels")))?;
        let beyond = |size: usize, address: Address| if address == Address::Wrap { 0 } else { size - 1 };
        for slice in 0..depth {
            for y in 0..height {
                let below = if y + 1 < height { y + 1 } else { beyond(height, sampler.address[1]) };
                for x in 0..=width {
                    let x = if x < width { x } else { beyond(width, sampler.address[0]) };
                    pairs.push([y, below].map(|y| plain.at(x, y, slice)));
                }
            }
        }
        Ok(Self { width: width as i32, height: height as i32, depth: depth as i32, pairs })
    }

    /// The index of a texel of a slice.
    #[inline(always)]
    fn index<S: Simd>(&self, x: i32x8<S>, y: i32x8<S>, slice: i32) -> [i32; 8] {
        let row = y + slice * self.height;
        (row * (self.width + 1) + x).to_array()
    }

    #[inline(always)]
    fn nearest<S: Simd>(&self, sampler: Sampler, u: f32x8<S>, v: f32x8<S>, slice: i32) -> u32x8<S> {
        let x = texel_of(u, self.width, sampler.address[0]);
        let y = texel_of(v, self.height, sampler.address[1]);
        let texels = self.index(x, y, slice).map(|i| self.pairs.get(i as usize).map_or(0, |pair| pair[0]));
        u32x8::load_array(u.simd, texels)
    }

    #[inline(always)]
    fn bilinear<S: Simd>(&self, sampler: Sampler, u: f32x8<S>, v: f32x8<S>, slice: i32) -> u32x8<S> {
        let simd = u.simd;
        let x = place_of(u, self.width, sampler.address[0]);
        let y = place_of(v, self.height, sampler.address[1]);
        let index = self.index(x >> 8, y >> 8, slice);
        // Each pixel's four texels: left, below it, right, below that.
        let load = |i: usize| {
            let quad = |i: i32| self.pairs.get(i as usize..).and_then(|pairs| pairs.first_chunk::<2>()).copied();
            let [[a, b], [c, d]] = quad(index[i]).unwrap_or_default();
            let [[e, f], [g, h]] = quad(index[i + 1]).unwrap_or_default();
            u32x8::load_array(simd, [a, b, c, d, e, f, g, h])
        };
        let (p01, p23, p45, p67) = (load(0), load(2), load(4), load(6));
        let fy: u32x8<S> = (y & 255).bitcast();
        let fx: u32x8<S> = (x & 255).bitcast();
        // Upper and lower texels of four pixels, left and right by turns.
        let first = mix(p01.unzip_low(p23), p01.unzip_high(p23), both_halves(fy.zip_low(fy)));
        let second = mix(p45.unzip_low(p67), p45.unzip_high(p67), both_halves(fy.zip_high(fy)));
        mix(first.unzip_low(second), first.unzip_high(second), both_halves(fx))
    }
}

impl Plain {
    fn of(pixmap: &Pixmap) -> Self {
        let texels = pixmap.data().as_chunks::<4>().0.iter().map(|pixel| u32::from_le_bytes(*pixel)).collect();
        Self { size: [pixmap.width() as usize, pixmap.height() as usize, 1], texels }
    }

    /// The bytes of a texture of these texels.
    #[cfg(feature = "mesh")]
    fn texture_bytes(&self, sampler: Sampler) -> usize {
        let mut size = self.size;
        let level = |[width, height, depth]: [usize; 3]| (width + 1) * height * depth * size_of::<[u32; 2]>();
        let mut bytes = level(size);
        while sampler.filter == Filter::Trilinear && size != [1; 3] {
            size = size.map(|side| (side / 2).max(1));
            bytes += level(size);
        }
        bytes
    }

    fn at(&self, x: usize, y: usize, z: usize) -> u32 {
        let [width, height, _] = self.size;
        self.texels.get((z * height + y) * width + x).copied().unwrap_or(0)
    }

    /// Half the size, at least 1, each texel the mean of the box that it covers, rounded to nearest.
    fn halved(&self) -> Self {
        let size = self.size.map(|side| (side / 2).max(1));
        // The source texels of an output texel along one direction, with integer weights that add up to the source's side.
        let taps = |side: usize, out: usize| -> Vec<Vec<(usize, u64)>> {
            (0..out)
                .map(|i| {
                    let (start, end) = (i * side, (i + 1) * side);
                    (start / out..end.div_ceil(out))
                        .map(|j| (j, (((j + 1) * out).min(end) - (j * out).max(start)) as u64))
                        .collect()
                })
                .collect()
        };
        let [xs, ys, zs]: [Vec<_>; 3] = std::array::from_fn(|i| taps(self.size[i], size[i]));
        let total = self.size.iter().product::<usize>() as u64;
        let mut texels = Vec::with_capacity(size.iter().product());
        for z in &zs {
            for y in &ys {
                for x in &xs {
                    let mut sums = [0_u64; 4];
                    for (k, wz) in z {
                        for (j, wy) in y {
                            for (i, wx) in x {
                                for (sum, v) in sums.iter_mut().zip(self.at(*i, *j, *k).to_le_bytes()) {
                                    *sum += u64::from(v) * wx * wy * wz;
                                }
                            }
                        }
                    }
                    texels.push(u32::from_le_bytes(sums.map(|sum| ((2 * sum + total) / (2 * total)) as u8)));
                }
            }
        }
        Self { size, texels }
    }
}
