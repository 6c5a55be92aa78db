//! A tile, repeated.

use std::borrow::Cow;

use super::image::{Image, Work};
use crate::error::Result;
use crate::geom::IntRect;

/// `area` filled with copies of what the picture has in `tile`.
pub(super) fn tile(image: &Image, area: IntRect, tile: IntRect, work: Work) -> Result<Image> {
    if tile.is_empty() || image.bounds().intersect(tile).is_empty() {
        return Ok(Image::empty());
    }
    let source = if image.bounds().contains(tile) { Cow::Borrowed(image) } else { Cow::Owned(image.crop(tile)?) };
    let mut out = Image::new(area)?;
    let width = tile.width() as usize;
    let first = (area.left - tile.left).rem_euclid(tile.right - tile.left) as usize;
    out.for_rows(work, |y, mut row| {
        let y = tile.top + (y - tile.top).rem_euclid(tile.bottom - tile.top);
        let (_, pixels) = source.part(y, tile.left, tile.right);
        let mut start = first;
        while !row.is_empty() {
            let count = (width - start).min(row.len());
            let (part, rest) = row.split_at_mut(count);
            part.copy_from_slice(pixels.get(start..start + count).unwrap_or(&[]));
            (row, start) = (rest, 0);
        }
    });
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, image};
    use super::*;

    #[test]
    fn copies_line_up_with_the_tile() {
        let source = image(1, 1, &["12", "34"]);
        // The tile has an empty column and row.
        let out = tile(&source, IntRect::from_ltrb(-1, -1, 6, 3), IntRect::from_ltrb(0, 1, 3, 4), WORK).unwrap();
        assert_eq!(out, image(-1, -1, &["4.34.34", ".......", "2.12.12", "4.34.34"]));
    }

    #[test]
    fn an_empty_tile_is_nothing() {
        let source = image(1, 1, &["12"]);
        let area = IntRect::from_ltrb(0, 0, 6, 6);
        assert_eq!(tile(&source, area, IntRect::EMPTY, WORK).unwrap(), Image::empty());
        assert_eq!(tile(&source, area, IntRect::from_ltrb(4, 4, 5, 5), WORK).unwrap(), Image::empty());
    }
}
