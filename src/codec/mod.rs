//! Pictures to bytes and back.

mod encode;
mod replace;

use std::fs;
use std::io::Cursor;
use std::path::Path;

use image::{ImageDecoder as _, ImageFormat, ImageReader, RgbaImage};

use crate::error::{Error, Result};
use crate::surface::{Limits, Pixmap};

impl Pixmap {
    /// The picture as a PNG file: 8-bit RGBA, straight alpha, sRGB as stored.
    ///
    /// # Errors
    /// [`Error::Limit`] if memory is not to be had.
    pub fn encode_png(&self) -> Result<Vec<u8>> {
        let mut bytes = Vec::new();
        encode::png(self, &mut bytes)
            .map_err(|error| Error::Limit(format!("the picture cannot be encoded as PNG: {error}")))?;
        Ok(bytes)
    }

    /// Writes the picture to `path` as [`Pixmap::encode_png`] encodes it.
    ///
    /// The file is written beside the target and renamed, so that a failure leaves what was there. A target
    /// that is not a regular file (a pipe, a device) is written in place; a symbolic link is followed. Rows are written as they
    /// are encoded, so that it takes no memory to speak of.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be written.
    pub fn save_png(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        replace::replace(path, |file| encode::png(self, file))
            .map_err(|source| Error::Io { path: path.to_owned(), source })
    }

    /// The picture in a PNG file's bytes, at 8 bits a channel; of an animation, the first frame.
    ///
    /// # Errors
    /// [`Error::Format`] if the bytes are not a whole PNG file; [`Error::Limit`] if the picture is over
    /// [`Limits::default`].
    pub fn decode_png(bytes: &[u8]) -> Result<Self> {
        decode(bytes, ImageFormat::Png, Limits::default(), u64::MAX)
    }

    /// The picture in a PNG, JPEG, GIF or WebP file's bytes, told apart by how they begin; of an
    /// animation, the first frame.
    ///
    /// # Errors
    /// As [`Pixmap::decode_png`].
    pub fn decode(bytes: &[u8]) -> Result<Self> {
        Self::decode_within(bytes, u64::MAX)
    }

    /// The same for pictures that take at most so many bytes while they are decoded.
    pub(crate) fn decode_within(bytes: &[u8], max_bytes: u64) -> Result<Self> {
        let format = image::guess_format(bytes)
            .map_err(|_| Error::Format("the data is not a PNG, JPEG, GIF or WebP picture".to_owned()))?;
        decode(bytes, format, Limits::default(), max_bytes)
    }

    /// The picture in a PNG file.
    ///
    /// # Errors
    /// [`Error::Io`] if the file cannot be read; else as [`Pixmap::decode_png`].
    pub fn load_png(path: impl AsRef<Path>) -> Result<Self> {
        let path = path.as_ref();
        let bytes = fs::read(path).map_err(|source| Error::Io { path: path.to_owned(), source })?;
        Self::decode_png(&bytes)
    }
}

fn decode(bytes: &[u8], format: ImageFormat, limits: Limits, max_bytes: u64) -> Result<Pixmap> {
    let name = || format!("{format:?}").to_uppercase();
    // The header's size is checked first: a file of a few bytes may claim a picture of gigabytes.
    let decoder = ImageReader::with_format(Cursor::new(bytes), format)
        .into_decoder()
        .map_err(|error| Error::Format(format!("the {} data is broken: {error}", name())))?;
    let ((width, height), color) = (decoder.dimensions(), decoder.color_type());
    limits.check(width, height)?;
    // Other pixels than the pixmap's own are held beside it.
    let others = if color == image::ColorType::Rgba8 { 0 } else { u64::from(color.bytes_per_pixel()) };
    let held = u64::from(width) * u64::from(height) * (4 + others);
    if held > max_bytes {
        let (held, max) = (held >> 20, max_bytes >> 20);
        return Err(Error::Limit(format!(
            "a picture of {width} × {height} pixels takes {held} MiB, of which {max} MiB are left"
        )));
    }
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut decoder_limits = image::Limits::no_limits();
    // Sixteen bits a channel while decoding, and the decoder's own buffers.
    decoder_limits.max_alloc = Some(limits.max_pixels.saturating_mul(16));
    reader.limits(decoder_limits);
    let picture = reader.decode().map_err(|error| match error {
        image::ImageError::Limits(error) => Error::Limit(format!("the {} picture is too large: {error}", name())),
        error => Error::Format(format!("the {} data is broken: {error}", name())),
    })?;
    Pixmap::try_from(picture.into_rgba8())
}

impl TryFrom<RgbaImage> for Pixmap {
    type Error = Error;

    /// Premultiplies each pixel, rounded to nearest.
    fn try_from(image: RgbaImage) -> Result<Self> {
        let (width, height) = image.dimensions();
        Self::from_straight(width, height, image.into_raw())
    }
}

impl TryFrom<&RgbaImage> for Pixmap {
    type Error = Error;

    /// Premultiplies each pixel, rounded to nearest.
    fn try_from(image: &RgbaImage) -> Result<Self> {
        let (width, height) = image.dimensions();
        Self::from_straight(width, height, image.as_raw().clone())
    }
}

impl From<&Pixmap> for RgbaImage {
    /// Divides each pixel by its alpha, rounded to nearest.
    fn from(pixmap: &Pixmap) -> Self {
        // The buffer's length is the size's by construction, so that the default is never taken.
        Self::from_raw(pixmap.width(), pixmap.height(), pixmap.to_straight()).unwrap_or_default()
    }
}

impl From<Pixmap> for RgbaImage {
    /// Divides each pixel by its alpha, rounded to nearest.
    fn from(pixmap: Pixmap) -> Self {
        Self::from(&pixmap)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;

    fn two_pixels() -> Pixmap {
        Pixmap::from_straight(2, 1, vec![255, 128, 0, 255, 0, 255, 255, 51]).unwrap()
    }

    #[test]
    fn png_keeps_every_pixel_that_straight_alpha_can_hold() {
        let pixmap = two_pixels();
        let bytes = pixmap.encode_png().unwrap();
        assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
        assert_eq!(Pixmap::decode_png(&bytes).unwrap(), pixmap);
        assert_eq!(Pixmap::decode(&bytes).unwrap(), pixmap);
    }

    #[test]
    fn an_image_crate_picture_goes_in_and_out() {
        let image = RgbaImage::from(&two_pixels());
        assert_eq!(image.get_pixel(1, 0).0, [0, 255, 255, 51]);
        assert_eq!(Pixmap::try_from(&image).unwrap(), two_pixels());
        assert_eq!(Pixmap::try_from(image).unwrap(), two_pixels());
        assert!(Pixmap::try_from(RgbaImage::new(0, 5)).is_err());
    }

    #[test]
    fn broken_bytes_are_an_error_at_every_length() {
        let bytes = two_pixels().encode_png().unwrap();
        for length in 0..bytes.len() - 12 {
            assert!(Pixmap::decode_png(&bytes[..length]).is_err(), "{length}");
        }
        assert!(matches!(Pixmap::decode(b"no picture at all"), Err(Error::Format(_))));
    }

    #[test]
    fn a_header_that_claims_gigabytes_is_refused_by_its_size() {
        let mut bytes = two_pixels().encode_png().unwrap();
        bytes[16..24].copy_from_slice(&[0, 0, 0x7f, 0xff, 0, 0, 0x7f, 0xff]);
        // The header's checksum no longer fits; a decoder that reads the size first says so or refuses it.
        assert!(Pixmap::decode_png(&bytes).is_err());
        let huge = png_header(32_767, 32_767);
        assert!(matches!(Pixmap::decode_png(&huge), Err(Error::Limit(_))));
    }

    /// A PNG file's signature, header chunk and empty data chunk, with right checksums.
    fn png_header(width: u32, height: u32) -> Vec<u8> {
        let mut header = b"IHDR".to_vec();
        header.extend(width.to_be_bytes());
        header.extend(height.to_be_bytes());
        header.extend([8, 6, 0, 0, 0]);
        let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
        for (length, chunk) in [(13_u32, header), (0, b"IDAT".to_vec()), (0, b"IEND".to_vec())] {
            bytes.extend(length.to_be_bytes());
            bytes.extend(&chunk);
            bytes.extend(checksum(&chunk).to_be_bytes());
        }
        bytes
    }

    fn checksum(bytes: &[u8]) -> u32 {
        !bytes.iter().fold(u32::MAX, |sum, byte| {
            (0..8).fold(sum ^ u32::from(*byte), |v, _| if v & 1 == 1 { (v >> 1) ^ 0xedb8_8320 } else { v >> 1 })
        })
    }

    #[test]
    fn saving_replaces_the_file_and_leaves_nothing_beside_it() {
        let folder = std::env::temp_dir().join(format!("rastrum-codec-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("a.png");
        fs::write(&path, b"old").unwrap();
        two_pixels().save_png(&path).unwrap();
        assert_eq!(Pixmap::load_png(&path).unwrap(), two_pixels());
        let mut red = Pixmap::new(1, 1).unwrap();
        red.fill(Color::RED);
        assert!(matches!(red.save_png(folder.join("none/b.png")), Err(Error::Io { .. })));
        assert!(red.save_png(&folder).is_err(), "a folder is no target");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
        fs::remove_dir_all(&folder).unwrap();
    }
}
