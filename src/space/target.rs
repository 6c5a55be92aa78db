//! The framebuffer: colour, depth and stencil of every sample, in tiles of 8 × 8 pixels.
//!
//! A tile's rows lie one after another, so that a tile is four cache lines and any row of eight pixels is one vector.
//! Beside the tiles stand the smallest and largest depth of each: the hierarchical depth.

use super::depth::DepthFormat;
use super::msaa::Samples;
use crate::color::Color;
use crate::error::{Error, Result};
use crate::geom::IntRect;
use crate::num::lanes::div255;
use crate::surface::{Limits, Pixmap};

/// Side of a tile in pixels.
pub(crate) const TILE: usize = 8;

/// One value for each pixel of a tile, rows top down.
pub(crate) type Tile<T> = [[T; TILE]; TILE];

/// The range of depth keys in a tile; no stored key lies outside.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthBounds {
    pub(crate) nearest: i32,
    pub(crate) farthest: i32,
}

/// A framebuffer that the pipeline draws into.
#[derive(Clone, Debug)]
pub struct Target {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) tiles_x: usize,
    pub(crate) tiles_y: usize,
    pub(crate) samples: Samples,
    pub(crate) format: DepthFormat,
    /// For each tile, its colours, one tile a colour sample.
    pub(crate) color: Vec<Tile<u32>>,
    /// For each tile, its depth keys, one tile a coverage sample.
    pub(crate) depth: Vec<Tile<i32>>,
    /// For each tile, its stencil values, one tile a coverage sample.
    pub(crate) stencil: Vec<Tile<u8>>,
    pub(crate) bounds: Vec<DepthBounds>,
    /// For coverage-rich samples: four bits a coverage sample that name its colour sample.
    pub(crate) slots: Vec<Tile<u64>>,
    /// Further values of each pixel, written by [`super::FragmentShader::attachment`].
    pub(crate) attachments: Vec<Vec<Tile<u32>>>,
}

/// The rows of tiles that one thread draws into.
pub(crate) struct BandMut<'a> {
    pub(crate) tiles_x: usize,
    /// The first row of tiles.
    pub(crate) first: usize,
    /// The pixels that may be drawn.
    pub(crate) area: IntRect,
    pub(crate) samples: Samples,
    pub(crate) color: &'a mut [Tile<u32>],
    pub(crate) depth: &'a mut [Tile<i32>],
    pub(crate) stencil: &'a mut [Tile<u8>],
    pub(crate) bounds: &'a mut [DepthBounds],
    pub(crate) slots: &'a mut [Tile<u64>],
    pub(crate) attachments: Vec<&'a mut [Tile<u32>]>,
}

/// `length` copies of `value`, or an error where the system has no memory for them.
fn filled<T: Copy>(length: usize, value: T) -> Result<Vec<T>> {
    let mut data = Vec::new();
    data.try_reserve_exact(length)
        .map_err(|_| Error::Limit(format!("no memory for {length} tiles of {} bytes", size_of::<T>())))?;
    data.resize(length, value);
    Ok(data)
}

impl Target {
    /// A framebuffer with 32-bit float depth and one sample a pixel: transparent, depth 1, stencil 0.
    ///
    /// # Errors
    /// As [`Target::with_format`].
    pub fn new(width: u32, height: u32) -> Result<Self> {
        Self::with_format(width, height, DepthFormat::default(), Samples::default())
    }

    /// A framebuffer of the given depth format and samples: transparent, depth 1, stencil 0.
    ///
    /// # Errors
    /// [`Error::Parameter`] if a side is 0; [`Error::Limit`] if it is over [`Limits::default`], the samples of all
    /// pixels are more than it allows pixels, or memory is not to be had.
    pub fn with_format(width: u32, height: u32, format: DepthFormat, samples: Samples) -> Result<Self> {
        let limits = Limits::default();
        limits.check(width, height)?;
        let all = u64::from(width) * u64::from(height) * samples.coverage() as u64;
        if all > limits.max_pixels {
            return Err(Error::Limit(format!(
                "{width} × {height} pixels of {} samples are over the limit of {} samples",
                samples.coverage(),
                limits.max_pixels
            )));
        }
        let (tiles_x, tiles_y) = ((width as usize).div_ceil(TILE), (height as usize).div_ceil(TILE));
        let tiles = tiles_x * tiles_y;
        let far = format.key(1.0);
        Ok(Self {
            width,
            height,
            tiles_x,
            tiles_y,
            samples,
            format,
            color: filled(tiles * samples.colors(), [[0; TILE]; TILE])?,
            depth: filled(tiles * samples.coverage(), [[far; TILE]; TILE])?,
            stencil: Vec::new(),
            bounds: filled(tiles, DepthBounds { nearest: far, farthest: far })?,
            slots: if samples.is_coverage_rich() { filled(tiles, [[0; TILE]; TILE])? } else { Vec::new() },
            attachments: Vec::new(),
        })
    }

    /// The same with `count` further 32-bit values a pixel, all 0: a G-buffer. See
    /// [`FragmentShader::attachment`](super::FragmentShader::attachment). At most 8; only with one sample a pixel.
    ///
    /// # Errors
    /// [`Error::Parameter`] for more, or several samples; [`Error::Limit`] where memory is not to be had.
    pub fn with_attachments(mut self, count: usize) -> Result<Self> {
        if count > 8 || self.samples != Samples::One {
            return Err(Error::Parameter(format!(
                "{count} attachments with {} samples: at most 8, with one sample",
                self.samples.coverage()
            )));
        }
        for _ in 0..count {
            self.attachments.push(filled(self.tiles_x * self.tiles_y, [[0; TILE]; TILE])?);
        }
        Ok(self)
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The samples of each pixel.
    pub fn samples(&self) -> Samples {
        self.samples
    }

    /// How depths are stored.
    pub fn depth_format(&self) -> DepthFormat {
        self.format
    }

    /// Sets every sample's colour.
    pub fn clear_color(&mut self, color: Color) {
        self.clear_color_bits(u32::from_le_bytes(color.premultiply()));
    }

    /// Sets every sample's four bytes, red in the lowest.
    pub fn clear_color_bits(&mut self, bits: u32) {
        self.color.fill([[bits; TILE]; TILE]);
        // All samples of a pixel share colour 0 again.
        self.slots.fill([[0; TILE]; TILE]);
    }

    /// Sets every sample's depth. D32F takes any number, −1 and infinity among them; see [`DepthFormat::key`].
    pub fn clear_depth(&mut self, depth: f32) {
        let key = self.format.key(depth);
        self.depth.fill([[key; TILE]; TILE]);
        self.bounds.fill(DepthBounds { nearest: key, farthest: key });
    }

    /// Sets every sample's stencil value.
    pub fn clear_stencil(&mut self, value: u8) {
        if value != 0 {
            self.make_stencil();
        }
        self.stencil.fill([[value; TILE]; TILE]);
    }

    /// Sets every pixel's value of an attachment; no such attachment, no effect.
    pub fn clear_attachment(&mut self, attachment: usize, bits: u32) {
        if let Some(values) = self.attachments.get_mut(attachment) {
            values.fill([[bits; TILE]; TILE]);
        }
    }

    /// Stencil values come into being with the first draw that uses them.
    pub(crate) fn make_stencil(&mut self) {
        if self.stencil.is_empty() {
            self.stencil.resize(self.depth.len(), [[0; TILE]; TILE]);
        }
    }

    fn place(&self, x: u32, y: u32) -> Option<(usize, usize, usize)> {
        let inside = x < self.width && y < self.height;
        let (x, y) = (x as usize, y as usize);
        inside.then_some((y / TILE * self.tiles_x + x / TILE, y % TILE, x % TILE))
    }

    /// The depth of sample 0 of the pixel at (x, y), or `None` outside.
    pub fn depth(&self, x: u32, y: u32) -> Option<f32> {
        self.sample_depth(x, y, 0)
    }

    /// The depth of a coverage sample of the pixel at (x, y), or `None` outside.
    pub fn sample_depth(&self, x: u32, y: u32, sample: usize) -> Option<f32> {
        let (tile, row, column) = self.place(x, y)?;
        let samples = self.samples.coverage();
        let tile = self.depth.get(tile * samples + sample).filter(|_| sample < samples)?;
        Some(self.format.value(tile[row][column]))
    }

    /// The depth of sample 0 of each pixel, rows top down.
    pub fn depths(&self) -> Vec<f32> {
        let rows = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        rows.map(|(x, y)| self.depth(x, y).unwrap_or_default()).collect()
    }

    /// The stencil value of sample 0 of the pixel at (x, y), or `None` outside.
    pub fn stencil(&self, x: u32, y: u32) -> Option<u8> {
        let (tile, row, column) = self.place(x, y)?;
        Some(self.stencil.get(tile * self.samples.coverage()).map_or(0, |tile| tile[row][column]))
    }

    /// The value of an attachment at (x, y), or `None` outside.
    pub fn attachment(&self, attachment: usize, x: u32, y: u32) -> Option<u32> {
        let (tile, row, column) = self.place(x, y)?;
        Some(self.attachments.get(attachment)?.get(tile)?[row][column])
    }

    /// The colour (premultiplied RGBA) of a coverage sample of the pixel at (x, y); `None` outside, and where a
    /// coverage-rich target has forgotten the sample's colour.
    pub fn sample_color(&self, x: u32, y: u32, sample: usize) -> Option<[u8; 4]> {
        let (tile, row, column) = self.place(x, y)?;
        let color = match self.slots.get(tile) {
            _ if sample >= self.samples.coverage() => return None,
            Some(slots) => (slots[row][column] >> (4 * sample)) as usize & 15,
            None => sample,
        };
        let tile = self.color.get(tile * self.samples.colors() + color).filter(|_| color < self.samples.colors())?;
        Some(tile[row][column].to_le_bytes())
    }

    /// The resolved colour (premultiplied RGBA) of the pixel at (x, y), or `None` outside: the mean of its samples,
    /// rounded to nearest.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        let (tile, row, column) = self.place(x, y)?;
        Some(self.resolved(tile, row, column).to_le_bytes())
    }

    /// The mean of a pixel's samples.
    #[inline(always)]
    fn resolved(&self, tile: usize, row: usize, column: usize) -> u32 {
        let colors = self.samples.colors();
        let Some(tiles) = self.color.get(tile * colors..(tile + 1) * colors) else { return 0 };
        if let Some(slots) = self.slots.get(tile) {
            let slots = slots[row][column];
            let known = (0..self.samples.coverage()).map(|s| (slots >> (4 * s)) as usize & 15);
            return mean(known.filter_map(|slot| tiles.get(slot)).map(|tile| tile[row][column]));
        }
        match tiles {
            [one] => one[row][column],
            many => mean(many.iter().map(|tile| tile[row][column])),
        }
    }

    /// The picture: the mean of each pixel's samples.
    ///
    /// # Errors
    /// [`Error::Limit`] where memory is not to be had.
    pub fn to_pixmap(&self) -> Result<Pixmap> {
        let mut pixmap = Pixmap::new(self.width, self.height)?;
        self.write_to(&mut pixmap)?;
        Ok(pixmap)
    }

    /// Writes the picture over `pixmap`, which has the target's size.
    ///
    /// # Errors
    /// [`Error::Parameter`] for another size.
    pub fn write_to(&self, pixmap: &mut Pixmap) -> Result<()> {
        if (pixmap.width(), pixmap.height()) != (self.width, self.height) {
            return Err(Error::Parameter(format!(
                "a target of {} × {} pixels does not fit a picture of {} × {}",
                self.width,
                self.height,
                pixmap.width(),
                pixmap.height()
            )));
        }
        let length = self.width as usize * 4;
        for (y, out) in pixmap.data_mut().chunks_exact_mut(length).enumerate() {
            let (tile_row, row) = (y / TILE * self.tiles_x, y % TILE);
            if self.samples == Samples::One {
                let tiles = self.color.get(tile_row..tile_row + self.tiles_x).unwrap_or_default();
                for (out, tile) in out.chunks_mut(4 * TILE).zip(tiles) {
                    let bytes: &[u8] = bytemuck::cast_slice(&tile[row]);
                    out.copy_from_slice(bytes.get(..out.len()).unwrap_or(bytes));
                }
            } else if let Some(samples) = self.samples.even() {
                let tiles = self.color.chunks_exact(samples).skip(tile_row);
                for (out, tiles) in out.chunks_mut(4 * TILE).zip(tiles) {
                    let means = even_means(tiles, row);
                    let bytes: &[u8] = bytemuck::cast_slice(&means);
                    out.copy_from_slice(bytes.get(..out.len()).unwrap_or(bytes));
                }
            } else {
                for (x, out) in out.as_chunks_mut::<4>().0.iter_mut().enumerate() {
                    *out = self.resolved(tile_row + x / TILE, row, x % TILE).to_le_bytes();
                }
            }
        }
        Ok(())
    }

    /// Replaces the colour of every sample by a picture's pixels.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a picture of another size.
    pub fn load_color(&mut self, pixmap: &Pixmap) -> Result<()> {
        if (pixmap.width(), pixmap.height()) != (self.width, self.height) {
            return Err(Error::Parameter("the picture's size is not the target's".to_owned()));
        }
        let colors = self.samples.colors();
        self.slots.fill([[0; TILE]; TILE]);
        for (i, pixel) in pixmap.data().as_chunks::<4>().0.iter().enumerate() {
            let (x, y) = (i % self.width as usize, i / self.width as usize);
            let tile = (y / TILE * self.tiles_x + x / TILE) * colors;
            for color in self.color.get_mut(tile..tile + colors).unwrap_or_default() {
                color[y % TILE][x % TILE] = u32::from_le_bytes(*pixel);
            }
        }
        Ok(())
    }

    /// The target in bands of `rows` rows of tiles.
    pub(crate) fn bands(&mut self, rows: usize) -> Vec<BandMut<'_>> {
        let (coverage, colors, per_band) = (self.samples.coverage(), self.samples.colors(), rows * self.tiles_x);
        let mut color = self.color.chunks_mut(per_band * colors);
        let mut depth = self.depth.chunks_mut(per_band * coverage);
        let mut stencil = self.stencil.chunks_mut(per_band * coverage);
        let mut bounds = self.bounds.chunks_mut(per_band);
        let mut slots = self.slots.chunks_mut(per_band);
        let mut attachments: Vec<_> = self.attachments.iter_mut().map(|values| values.chunks_mut(per_band)).collect();
        let mut bands = Vec::new();
        let mut first = 0;
        while first < self.tiles_y {
            let bottom = ((first + rows) * TILE).min(self.height as usize);
            bands.push(BandMut {
                tiles_x: self.tiles_x,
                first,
                area: IntRect::from_ltrb(0, (first * TILE) as i32, self.width as i32, bottom as i32),
                samples: self.samples,
                color: color.next().unwrap_or_default(),
                depth: depth.next().unwrap_or_default(),
                stencil: stencil.next().unwrap_or_default(),
                bounds: bounds.next().unwrap_or_default(),
                slots: slots.next().unwrap_or_default(),
                attachments: attachments.iter_mut().map(|values| values.next().unwrap_or_default()).collect(),
            });
            first += rows;
        }
        bands
    }
}

/// The mean of some packed pixels, each component rounded to nearest; 0 of none.
#[inline(always)]
fn mean(pixels: impl Iterator<Item = u32>) -> u32 {
    let (mut even, mut odd, mut count) = (0_u32, 0_u32, 0_u32);
    for pixel in pixels {
        even += pixel & 0x00ff_00ff;
        odd += (pixel >> 8) & 0x00ff_00ff;
        count += 1;
    }
    if count == 0 {
        return 0;
    }
    let divide = |sum: u32| (2 * sum + count) / (2 * count);
    divide(even & 0xffff) | divide(odd & 0xffff) << 8 | divide(even >> 16) << 16 | divide(odd >> 16) << 24
}

/// [`mean`] of the pixels of a row in 2, 4 or 8 tiles.
#[inline(always)]
fn even_means(tiles: &[Tile<u32>], row: usize) -> [u32; TILE] {
    const EVEN: u32 = 0x00ff_00ff;
    let shift = tiles.len().trailing_zeros();
    let half = tiles.len() as u32 / 2 * 0x0001_0001;
    let (mut even, mut odd) = ([half; TILE], [half; TILE]);
    for tile in tiles {
        for (i, pixel) in tile[row].iter().enumerate() {
            even[i] += pixel & EVEN;
            odd[i] += (pixel >> 8) & EVEN;
        }
    }
    std::array::from_fn(|i| ((even[i] >> shift) & EVEN) | ((odd[i] >> shift) & EVEN) << 8)
}

/// Two framebuffers: one is shown while the other is drawn.
#[derive(Clone, Debug)]
pub struct Frames {
    front: Target,
    back: Target,
}

impl Frames {
    /// Two framebuffers like `target`.
    pub fn new(target: Target) -> Self {
        Self { front: target.clone(), back: target }
    }

    /// What is shown.
    pub fn front(&self) -> &Target {
        &self.front
    }

    /// What is drawn next.
    pub fn back(&mut self) -> &mut Target {
        &mut self.back
    }

    /// Shows what was drawn; the frame that was shown so far becomes the back, its pixels as they were.
    pub fn present(&mut self) {
        std::mem::swap(&mut self.front, &mut self.back);
    }
}

/// The accumulation buffer: sums of frames, for motion blur, depth of field and antialiasing over time.
#[derive(Clone, Debug)]
pub struct Accumulation {
    width: u32,
    height: u32,
    sums: Vec<u32>,
    weight: u32,
}

impl Accumulation {
    /// An empty sum of frames of the given size.
    ///
    /// # Errors
    /// As [`Pixmap::new`].
    pub fn new(width: u32, height: u32) -> Result<Self> {
        Limits::default().check(width, height)?;
        Ok(Self { width, height, sums: filled(width as usize * height as usize * 4, 0)?, weight: 0 })
    }

    /// Adds a frame `weight` times.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a frame of another size, or once the weights would add up to more than 2^23.
    pub fn add(&mut self, frame: &Pixmap, weight: u32) -> Result<()> {
        if (frame.width(), frame.height()) != (self.width, self.height) {
            return Err(Error::Parameter("the frame's size is not the accumulation buffer's".to_owned()));
        }
        let total = self.weight.checked_add(weight).filter(|total| *total <= 1 << 23);
        let Some(total) = total else {
            return Err(Error::Parameter("the weights of accumulated frames add up to more than 2^23".to_owned()));
        };
        for (sum, value) in self.sums.iter_mut().zip(frame.data()) {
            *sum += u32::from(*value) * weight;
        }
        self.weight = total;
        Ok(())
    }

    /// The weighted mean of the frames, rounded to nearest; transparent without any.
    ///
    /// # Errors
    /// [`Error::Limit`] where memory is not to be had.
    pub fn average(&self) -> Result<Pixmap> {
        let mut pixmap = Pixmap::new(self.width, self.height)?;
        let weight = u64::from(self.weight.max(1));
        for (out, sum) in pixmap.data_mut().iter_mut().zip(&self.sums) {
            *out = ((2 * u64::from(*sum) + weight) / (2 * weight)) as u8;
        }
        Ok(pixmap)
    }

    /// Empties the sum.
    pub fn clear(&mut self) {
        self.sums.fill(0);
        self.weight = 0;
    }
}

/// s over d for packed premultiplied pixels, each product rounded to nearest.
pub(crate) fn over(s: u32, d: u32) -> u32 {
    let rest = 255 - (s >> 24);
    let [s, d] = [s.to_le_bytes(), d.to_le_bytes()];
    let pixel = [0, 1, 2, 3].map(|i| (u32::from(s[i]) + div255(u32::from(d[i]) * rest)).min(255) as u8);
    u32::from_le_bytes(pixel)
}
