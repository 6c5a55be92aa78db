//! Pictures as PNG files, row by row.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use crate::color::demultiply_u8;
use crate::surface::Pixmap;

/// Bytes of compressed rows in a chunk.
const CHUNK: usize = 1 << 16;

/// Writes a picture as a PNG file: 8-bit RGBA, straight alpha. Neither the straight pixels nor the file are ever in memory as
/// a whole.
pub(super) fn png(pixmap: &Pixmap, output: &mut impl Write) -> io::Result<()> {
    write(pixmap, output).map_err(|error| match error {
        EncodingError::IoError(error) => error,
        error => io::Error::other(error),
    })
}

fn write(pixmap: &Pixmap, output: &mut impl Write) -> Result<(), EncodingError> {
    let mut encoder = Encoder::new(output, pixmap.width(), pixmap.height());
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer_with_size(CHUNK)?;
    let row_bytes = pixmap.width() as usize * 4;
    let mut straight = vec![0; row_bytes];
    for row in pixmap.data().chunks_exact(row_bytes) {
        if row.as_chunks::<4>().0.iter().all(|pixel| pixel[3] == 255) {
            stream.write_all(row)?;
            continue;
        }
        for (straight, pixel) in straight.as_chunks_mut::<4>().0.iter_mut().zip(row.as_chunks::<4>().0) {
            *straight = demultiply_u8(*pixel);
        }
        stream.write_all(&straight)?;
    }
    stream.finish()?;
    writer.finish()
}
