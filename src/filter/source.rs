//! What primitives read: pictures, or what can be drawn part by part where a picture of all would take too much memory.

use std::borrow::Cow;
use std::sync::Arc;

use super::graph::ColorSpace;
use super::image::{Image, Work};
use super::lines::NEIGHBOURS;
use super::space::convert;
use crate::error::Result;
use crate::geom::IntRect;

/// Pictures of so many pixels are made whole on any canvas: all of the surroundings of one of 500 × 500.
pub(crate) const ALWAYS_WHOLE: u64 = 25 * 500 * 500;

/// Bytes of a part of the picture, where it is drawn in parts.
pub(super) const PART: usize = 12 << 20;

/// What can be had part by part.
pub(crate) trait Parts: Sync {
    /// The pixels that may be other than transparent.
    fn bounds(&self) -> IntRect;
    /// A picture that holds at least what of this one lies in `area`.
    fn part(&self, area: IntRect) -> Result<Cow<'_, Image>>;
    /// Whether a part costs nothing, since all of it is there.
    fn is_whole(&self) -> bool;
}

impl Parts for Image {
    fn bounds(&self) -> IntRect {
        Self::bounds(self)
    }

    fn part(&self, _area: IntRect) -> Result<Cow<'_, Image>> {
        Ok(Cow::Borrowed(self))
    }

    fn is_whole(&self) -> bool {
        true
    }
}

impl Parts for &dyn Parts {
    fn bounds(&self) -> IntRect {
        (**self).bounds()
    }

    fn part(&self, area: IntRect) -> Result<Cow<'_, Image>> {
        (**self).part(area)
    }

    fn is_whole(&self) -> bool {
        (**self).is_whole()
    }
}

impl Parts for Arc<Image> {
    fn bounds(&self) -> IntRect {
        Image::bounds(self)
    }

    fn part(&self, area: IntRect) -> Result<Cow<'_, Image>> {
        Parts::part(&**self, area)
    }

    fn is_whole(&self) -> bool {
        true
    }
}

/// The source graphic of a filter.
pub(crate) enum Source<'a> {
    /// All of it.
    Picture(Image),
    /// What draws it.
    Parts(Box<dyn Parts + 'a>),
}

impl<'a> Source<'a> {
    /// It as what can be had part by part.
    pub(crate) fn as_parts(&self) -> &(dyn Parts + 'a) {
        match self {
            Self::Picture(image) => image,
            Self::Parts(parts) => &**parts,
        }
    }
}

/// Parts of a picture as a primitive asks for them: no other is made of all of it.
pub(super) struct Converted<P> {
    pub(super) parts: P,
    /// Whether only its alpha matters.
    pub(super) alpha_only: bool,
    pub(super) from: ColorSpace,
    pub(super) to: ColorSpace,
    pub(super) work: Work,
}

impl<P> Converted<P> {
    fn is_as_it_is(&self) -> bool {
        !self.alpha_only && self.from == self.to
    }
}

impl<P: Parts> Parts for Converted<P> {
    fn bounds(&self) -> IntRect {
        self.parts.bounds()
    }

    fn part(&self, area: IntRect) -> Result<Cow<'_, Image>> {
        let part = self.parts.part(area)?;
        if self.is_as_it_is() {
            return Ok(part);
        }
        let mut image = match part {
            Cow::Borrowed(image) => image.crop(area.intersect(image.bounds()))?,
            Cow::Owned(image) => image,
        };
        if self.alpha_only {
            blacken(&mut image, self.work);
        } else {
            convert(&mut image, self.from, self.to, self.work);
        }
        Ok(Cow::Owned(image))
    }

    fn is_whole(&self) -> bool {
        self.is_as_it_is() && self.parts.is_whole()
    }
}

/// `area` in bands as high as each other, of about so many rows at most.
pub(super) fn bands(area: IntRect, rows: usize) -> impl Iterator<Item = IntRect> {
    let height = area.height() as usize;
    // Whole groups of lines.
    let count = height.div_ceil(rows.max(NEIGHBOURS));
    let rows = height.div_ceil(count.max(1)).next_multiple_of(NEIGHBOURS);
    (0..height.div_ceil(rows.max(1))).map(move |band| {
        let top = area.top + (band * rows) as i32;
        IntRect { top, bottom: area.bottom.min(top.saturating_add(rows as i32)), ..area }
    })
}

/// `area` in bands whose surroundings, so many pixels wide, are pictures of about [`PART`] bytes.
pub(super) fn bands_of_parts(area: IntRect, width: u32) -> impl Iterator<Item = IntRect> {
    bands(area, PART / (width.max(1) as usize * 4))
}

/// `area` in strips of columns, whole blocks, each a picture of about so many bytes at most.
pub(super) fn strips(area: IntRect, bytes: usize) -> impl Iterator<Item = IntRect> {
    let most = bytes / (area.height().max(1) as usize * 4);
    let columns = (most / NEIGHBOURS * NEIGHBOURS).clamp(NEIGHBOURS, 1 << 20);
    (0..(area.width() as usize).div_ceil(columns)).map(move |strip| {
        let left = area.left + (strip * columns) as i32;
        IntRect { left, right: area.right.min(left.saturating_add(columns as i32)), ..area }
    })
}

/// Leaves a picture's alpha. Black is black in every space.
pub(super) fn blacken(image: &mut Image, work: Work) {
    image.for_pixels(work, |pixels| {
        for pixel in pixels {
            *pixel = [0, 0, 0, pixel[3]];
        }
    });
}

/// How many pixels a rectangle has.
pub(crate) fn pixels(rect: IntRect) -> u64 {
    u64::from(rect.width()) * u64::from(rect.height())
}

/// The widest rectangle around `inner`, within `outer`, of at most so many pixels; `inner`'s own if those are more. Its sides
/// keep the same share of their distances.
pub(crate) fn widest(inner: IntRect, outer: IntRect, most: u64) -> IntRect {
    const PARTS: i64 = 1024;
    if pixels(outer) <= most {
        return outer;
    }
    let clamp = |v: i32, low: i32, high: i32| v.clamp(low, high.max(low));
    let inner = IntRect::from_ltrb(
        clamp(inner.left, outer.left, outer.right),
        clamp(inner.top, outer.top, outer.bottom),
        clamp(inner.right, outer.left, outer.right),
        clamp(inner.bottom, outer.top, outer.bottom),
    );
    let side = |from: i32, to: i32, parts: i64| from + ((i64::from(to) - i64::from(from)) * parts / PARTS) as i32;
    let rect = |parts: i64| {
        IntRect::from_ltrb(
            side(inner.left, outer.left, parts),
            side(inner.top, outer.top, parts),
            side(inner.right, outer.right, parts),
            side(inner.bottom, outer.bottom, parts),
        )
    };
    rect(last_that(PARTS, |parts| pixels(rect(parts)) <= most))
}

/// The largest number in 0 ..= `most` that passes a test that larger ones fail; 0 if none does.
pub(super) fn last_that(most: i64, mut passes: impl FnMut(i64) -> bool) -> i64 {
    let (mut low, mut high) = (0, most);
    while low < high {
        let middle = (low + high + 1) / 2;
        if passes(middle) {
            low = middle;
        } else {
            high = middle - 1;
        }
    }
    low
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A picture that is given in parts only.
    pub(in crate::filter) struct InParts(pub(in crate::filter) Image);

    impl Parts for InParts {
        fn bounds(&self) -> IntRect {
            self.0.bounds()
        }

        fn part(&self, area: IntRect) -> Result<Cow<'_, Image>> {
            let area = area.intersect(self.0.bounds());
            if area.is_empty() {
                return Ok(Cow::Owned(Image::empty()));
            }
            // As it is drawn: from whole blocks on.
            let left = area.left - (area.left - self.0.bounds().left) % 16;
            Ok(Cow::Owned(self.0.crop(IntRect { left, ..area })?))
        }

        fn is_whole(&self) -> bool {
            false
        }
    }

    #[test]
    fn the_widest_rectangle_keeps_to_its_pixels() {
        let (inner, outer) = (IntRect::from_ltrb(10, 20, 110, 70), IntRect::from_ltrb(-190, -80, 310, 70));
        assert_eq!(widest(inner, outer, 75_000), outer);
        assert_eq!(widest(inner, outer, 10), inner);
        let found = widest(inner, outer, 20_000);
        assert!(
            outer.contains(found) && found.contains(inner) && (19_000..=20_000).contains(&pixels(found)),
            "{found:?}"
        );
        // Around what lies outside: the side next to it.
        let found = widest(IntRect::from_ltrb(400, 0, 410, 10), outer, 1000);
        assert!(outer.contains(found) && found.right == 310 && (500..=1000).contains(&pixels(found)), "{found:?}");
    }

    #[test]
    fn bands_and_strips_are_all_there_is() {
        let area = IntRect::from_ltrb(-7, 5, 93, 105);
        let found: Vec<_> = bands(area, 40).map(|band| (band.top, band.bottom)).collect();
        assert_eq!(found, [(5, 53), (53, 101), (101, 105)]);
        let found: Vec<_> = strips(area, 100 * 4 * 50).map(|strip| (strip.left, strip.right)).collect();
        assert_eq!(found, [(-7, 41), (41, 89), (89, 93)]);
        assert_eq!((bands(area, 1000).collect(), strips(area, usize::MAX).collect()), (vec![area], vec![area]));
        assert_eq!(bands(IntRect::EMPTY, 0).count() + strips(IntRect::EMPTY, 0).count(), 0);
    }
}
