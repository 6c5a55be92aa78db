//! Pixels: owned, borrowed, and borrowed to write.

use super::aligned::AlignedBytes;
use crate::color::{Color, demultiply_u8, premultiply_u8};
use crate::error::{Error, Result};
use crate::geom::IntRect;

/// How large a picture may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The largest width and height, in pixels; at most 32,767 whatever is asked for, which is as far
    /// as the rasterizer's 24.8 positions reach. The default is 32,767.
    pub max_side: u32,
    /// The most pixels. The default is 2^28 (1 GiB of RGBA8).
    pub max_pixels: u64,
}

impl Limits {
    const SIDE: u32 = 32_767;

    /// Refuses a size of 0, or one over the limits.
    ///
    /// # Errors
    /// [`Error::Parameter`] for an empty size, [`Error::Limit`] for one too large.
    pub fn check(&self, width: u32, height: u32) -> Result<()> {
        if width == 0 || height == 0 {
            return Err(Error::Parameter(format!(
                "a picture of {width} × {height} pixels has none: both sides must be at least 1"
            )));
        }
        let side = self.max_side.min(Self::SIDE);
        if width > side || height > side {
            return Err(Error::Limit(format!(
                "a picture of {width} × {height} pixels is over the limit of {side} a side"
            )));
        }
        if u64::from(width) * u64::from(height) > self.max_pixels {
            return Err(Error::Limit(format!(
                "a picture of {width} × {height} pixels is over the limit of {} pixels",
                self.max_pixels
            )));
        }
        Ok(())
    }
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_side: Self::SIDE, max_pixels: 1 << 28 }
    }
}

/// A picture that owns its pixels: premultiplied RGBA8, rows top down, no padding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixmap {
    width: u32,
    height: u32,
    data: AlignedBytes,
}

impl Pixmap {
    /// A transparent picture.
    ///
    /// # Errors
    /// [`Error::Parameter`] if a side is 0; [`Error::Limit`] if it is over [`Limits::default`] or
    /// memory is not to be had. Nothing is allocated in the first two cases.
    pub fn new(width: u32, height: u32) -> Result<Self> {
        Self::with_limits(width, height, Limits::default())
    }

    /// One transparent pixel: what is left where a picture was moved out.
    pub(crate) fn placeholder() -> Self {
        Self { width: 1, height: 1, data: vec![0; 4].into() }
    }

    /// A transparent picture of a size checked against `limits`.
    ///
    /// # Errors
    /// As [`Pixmap::new`].
    pub fn with_limits(width: u32, height: u32, limits: Limits) -> Result<Self> {
        limits.check(width, height)?;
        Ok(Self { width, height, data: AlignedBytes::zeros(width as usize * height as usize * 4)? })
    }

    /// A picture that holds `data`: premultiplied RGBA8, rows top down. Pixels whose colour exceeds
    /// their alpha are kept as they are; blending clamps them.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless `data` holds 4 × width × height bytes; else as [`Pixmap::new`].
    pub fn from_vec(width: u32, height: u32, data: Vec<u8>) -> Result<Self> {
        Limits::default().check(width, height)?;
        check_length(width, height, data.len())?;
        Ok(Self { width, height, data: data.into() })
    }

    /// A picture from straight-alpha RGBA8, rows top down; each pixel is premultiplied, rounded to nearest.
    ///
    /// # Errors
    /// As [`Pixmap::from_vec`].
    pub fn from_straight(width: u32, height: u32, mut data: Vec<u8>) -> Result<Self> {
        for pixel in data.as_chunks_mut::<4>().0 {
            *pixel = premultiply_u8(*pixel);
        }
        Self::from_vec(width, height, data)
    }

    /// The pixels with straight alpha, rounded to nearest; transparent ones are 0, 0, 0, 0.
    pub fn to_straight(&self) -> Vec<u8> {
        let mut data = self.data.to_vec();
        for pixel in data.as_chunks_mut::<4>().0 {
            *pixel = demultiply_u8(*pixel);
        }
        data
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels: premultiplied RGBA8, rows top down, 4 × width bytes a row.
    pub fn data(&self) -> &[u8] {
        &self.data
    }

    /// The pixels to write; a colour component above its alpha is clamped where it is blended.
    pub fn data_mut(&mut self) -> &mut [u8] {
        &mut self.data
    }

    /// The pixels, without another allocation: as they came, or moved by less than 64 bytes, since those of a picture made here begin at a
    /// cache line.
    pub fn into_vec(self) -> Vec<u8> {
        self.data.into_vec()
    }

    /// The premultiplied pixel at (x, y), or `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        self.as_ref().pixel(x, y)
    }

    /// Sets every pixel.
    pub fn fill(&mut self, color: Color) {
        self.data.as_chunks_mut::<4>().0.fill(color.premultiply());
    }

    /// A view to read.
    pub fn as_ref(&self) -> PixmapRef<'_> {
        PixmapRef { width: self.width, height: self.height, stride: self.width as usize * 4, data: &self.data }
    }

    /// A view to write.
    pub fn as_mut(&mut self) -> PixmapMut<'_> {
        PixmapMut { width: self.width, height: self.height, stride: self.width as usize * 4, data: &mut self.data }
    }
}

/// A view of pixels that someone else owns: premultiplied RGBA8, rows top down.
#[derive(Clone, Copy, Debug)]
pub struct PixmapRef<'a> {
    width: u32,
    height: u32,
    stride: usize,
    data: &'a [u8],
}

impl<'a> PixmapRef<'a> {
    /// A view of a caller's buffer of 4 × width × height bytes.
    ///
    /// # Errors
    /// As [`Pixmap::from_vec`].
    pub fn from_bytes(data: &'a [u8], width: u32, height: u32) -> Result<Self> {
        Limits::default().check(width, height)?;
        check_length(width, height, data.len())?;
        Ok(Self { width, height, stride: width as usize * 4, data })
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The rows, top down, 4 × width bytes each.
    pub fn rows(&self) -> impl Iterator<Item = &'a [u8]> + use<'a> {
        let length = self.width as usize * 4;
        self.data.chunks(self.stride).map(move |row| row.get(..length).unwrap_or(row))
    }

    /// The premultiplied pixel at (x, y), or `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width {
            return None;
        }
        let start = y as usize * self.stride + x as usize * 4;
        self.data.get(start..)?.first_chunk().copied()
    }

    /// A copy of the pixels in `rect`; what lies outside is transparent.
    ///
    /// # Errors
    /// As [`Pixmap::new`], for the size of `rect`.
    pub fn crop(&self, rect: IntRect) -> Result<Pixmap> {
        let mut out = Pixmap::new(rect.width(), rect.height())?;
        let inside = rect.intersect(IntRect::from_xywh(0, 0, self.width, self.height));
        let stride = out.width as usize * 4;
        for y in inside.top..inside.bottom {
            let from = y as usize * self.stride + inside.left as usize * 4;
            let to = y.abs_diff(rect.top) as usize * stride + inside.left.abs_diff(rect.left) as usize * 4;
            let length = inside.width() as usize * 4;
            if let (Some(source), Some(target)) =
                (self.data.get(from..from + length), out.data.get_mut(to..to + length))
            {
                target.copy_from_slice(source);
            }
        }
        Ok(out)
    }
}

/// A view of pixels that someone else owns, to write: premultiplied RGBA8, rows top down.
#[derive(Debug)]
pub struct PixmapMut<'a> {
    width: u32,
    height: u32,
    stride: usize,
    data: &'a mut [u8],
}

impl<'a> PixmapMut<'a> {
    /// A view of a caller's buffer of 4 × width × height bytes, without copying.
    ///
    /// # Errors
    /// As [`Pixmap::from_vec`].
    pub fn from_bytes(data: &'a mut [u8], width: u32, height: u32) -> Result<Self> {
        Limits::default().check(width, height)?;
        check_length(width, height, data.len())?;
        Ok(Self { width, height, stride: width as usize * 4, data })
    }

    /// A view of a caller's buffer whose rows start `stride` bytes apart; bytes between rows are left
    /// alone.
    ///
    /// # Errors
    /// [`Error::Parameter`] if `stride` is less than 4 × width or the buffer ends before the last
    /// row does; else as [`Pixmap::new`].
    pub fn from_bytes_with_stride(data: &'a mut [u8], width: u32, height: u32, stride: usize) -> Result<Self> {
        Limits::default().check(width, height)?;
        let row = width as usize * 4;
        if stride < row {
            return Err(Error::Parameter(format!("a stride of {stride} bytes is less than a row of {row}")));
        }
        let needed = stride.checked_mul(height as usize - 1).and_then(|v| v.checked_add(row)).unwrap_or(usize::MAX);
        if data.len() < needed {
            return Err(Error::Parameter(format!(
                "{width} × {height} pixels with a stride of {stride} need {needed} bytes, not {}",
                data.len()
            )));
        }
        Ok(Self { width, height, stride, data })
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The same view, for a shorter time.
    pub fn reborrow(&mut self) -> PixmapMut<'_> {
        PixmapMut { width: self.width, height: self.height, stride: self.stride, data: self.data }
    }

    /// Bytes from one row to the next.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// A view to read.
    pub fn as_ref(&self) -> PixmapRef<'_> {
        PixmapRef { width: self.width, height: self.height, stride: self.stride, data: self.data }
    }

    /// The bytes, row after row, `stride` bytes from one to the next; the last may be shorter.
    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        self.data
    }

    /// Copies `source` to (x, y), replacing what is there; parts outside are left out.
    pub fn write(&mut self, source: PixmapRef<'_>, x: i32, y: i32) {
        let bounds = IntRect::from_xywh(0, 0, self.width, self.height);
        let inside = IntRect::from_xywh(x, y, source.width, source.height).intersect(bounds);
        for row in inside.top..inside.bottom {
            let from = row.abs_diff(y) as usize * source.stride + inside.left.abs_diff(x) as usize * 4;
            let to = row as usize * self.stride + inside.left as usize * 4;
            let length = inside.width() as usize * 4;
            if let (Some(read), Some(write)) =
                (source.data.get(from..from + length), self.data.get_mut(to..to + length))
            {
                write.copy_from_slice(read);
            }
        }
    }
}

fn check_length(width: u32, height: u32, length: usize) -> Result<()> {
    let needed = width as usize * height as usize * 4;
    if length != needed {
        return Err(Error::Parameter(format!("{width} × {height} pixels are {needed} bytes of RGBA8, not {length}")));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_checked_before_memory_is_taken() {
        assert!(matches!(Pixmap::new(0, 5), Err(Error::Parameter(_))));
        assert!(matches!(Pixmap::new(65_536, 65_536), Err(Error::Limit(_))));
        assert!(matches!(Pixmap::new(32_767, 32_767), Err(Error::Limit(_))));
        assert!(Pixmap::new(32_767, 1).is_ok());
        let wide = Limits { max_side: u32::MAX, max_pixels: u64::MAX };
        assert!(matches!(Pixmap::with_limits(40_000, 1, wide), Err(Error::Limit(_))));
    }

    #[test]
    fn a_view_with_a_stride_needs_no_bytes_after_its_last_row() {
        let mut buffer = vec![0; 12 + 8];
        assert!(PixmapMut::from_bytes_with_stride(&mut buffer, 2, 2, 12).is_ok());
        assert!(PixmapMut::from_bytes_with_stride(&mut buffer, 2, 2, 13).is_err());
        assert!(PixmapMut::from_bytes_with_stride(&mut buffer, 2, 2, 7).is_err());
    }

    #[test]
    fn write_and_crop_clip_at_the_edges() {
        let mut pixmap = Pixmap::new(3, 3).unwrap();
        let mut red = Pixmap::new(2, 2).unwrap();
        red.fill(Color::RED);
        pixmap.as_mut().write(red.as_ref(), -1, 2);
        assert_eq!(pixmap.pixel(0, 2), Some([255, 0, 0, 255]));
        assert_eq!(pixmap.pixel(1, 2), Some([0; 4]));
        let crop = pixmap.as_ref().crop(IntRect::from_ltrb(-1, 1, 2, 4)).unwrap();
        assert_eq!(crop.pixel(1, 1), Some([255, 0, 0, 255]));
        assert_eq!(crop.data().iter().filter(|v| **v != 0).count(), 2);
    }
}
