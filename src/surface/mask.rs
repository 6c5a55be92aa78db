//! A coverage mask: one byte a pixel.

use super::aligned::allocate;
use super::pixmap::{Limits, PixmapRef};
use crate::error::{Error, Result};

/// What of a picture becomes the mask's coverage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MaskKind {
    /// The alpha channel.
    #[default]
    Alpha,
    /// The luminance of the colour times its alpha, with the coefficients of linear RGB that SVG's
    /// `luminanceToAlpha` uses on stored values: 0.2126 R + 0.7152 G + 0.0722 B.
    Luminance,
}

impl MaskKind {
    /// The coverage of one premultiplied pixel, in 16-bit fixed point: the weights add up to 65536.
    #[inline(always)]
    pub(crate) fn coverage(self, [r, g, b, a]: [u8; 4]) -> u8 {
        match self {
            Self::Alpha => a,
            Self::Luminance => {
                ((u32::from(r) * 13_933 + u32::from(g) * 46_871 + u32::from(b) * 4_732 + 32_768) >> 16) as u8
            }
        }
    }
}

/// A rectangle of coverage values: 0 hides, 255 shows. Rows top down, no padding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    width: u32,
    height: u32,
    data: Vec<u8>,
}

impl Mask {
    /// A mask of the given size that hides everything.
    ///
    /// # Errors
    /// As [`Pixmap::new`](super::Pixmap::new).
    pub fn new(width: u32, height: u32) -> Result<Self> {
        Limits::default().check(width, height)?;
        Ok(Self { width, height, data: allocate(width as usize * height as usize)? })
    }

    /// A mask that holds `data`, rows top down.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `data` holds width × height bytes; else as [`Mask::new`].
    pub fn from_vec(width: u32, height: u32, data: Vec<u8>) -> Result<Self> {
        Limits::default().check(width, height)?;
        if data.len() != width as usize * height as usize {
            return Err(Error::Parameter(format!(
                "a mask of {width} × {height} pixels needs {} bytes, not {}",
                width as usize * height as usize,
                data.len()
            )));
        }
        Ok(Self { width, height, data })
    }

    /// The mask that a picture gives, by alpha or by luminance.
    ///
    /// # Errors
    /// As [`Mask::new`].
    pub fn from_pixmap(pixmap: PixmapRef<'_>, kind: MaskKind) -> Result<Self> {
        let mut mask = Self::new(pixmap.width(), pixmap.height())?;
        for (out, row) in mask.data.chunks_exact_mut(pixmap.width() as usize).zip(pixmap.rows()) {
            for (coverage, pixel) in out.iter_mut().zip(row.as_chunks::<4>().0) {
                *coverage = kind.coverage(*pixel);
            }
        }
        Ok(mask)
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The coverage values, rows top down.
    pub fn data(&self) -> &[u8] {
        &self.data
    }

    /// The coverage values, rows top down.
    pub fn data_mut(&mut self) -> &mut [u8] {
        &mut self.data
    }

    /// Replaces each value by 255 minus it.
    pub fn invert(&mut self) {
        for value in &mut self.data {
            *value = 255 - *value;
        }
    }
}
