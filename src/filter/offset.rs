//! The picture, moved.

use std::sync::Arc;

use super::image::Image;
use crate::geom::IntRect;

/// The whole pixels in a distance, towards zero, but not one less for the sake of rounding. 0 for what is not finite.
pub(super) fn whole_pixels(distance: f32) -> i32 {
    if !distance.is_finite() {
        return 0;
    }
    let nudge = if distance < 0.0 { -1e-3 } else { 1e-3 };
    (distance.clamp(-1e6, 1e6) + nudge) as i32
}

/// The picture moved by whole pixels, in `area`.
pub(super) fn offset(image: Arc<Image>, area: IntRect, dx: i32, dy: i32) -> Image {
    Arc::unwrap_or_clone(image).moved(dx, dy).within(area)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::image;
    use super::*;

    #[test]
    fn whole_pixels_are_cut_off_and_rounding_is_forgiven() {
        for (distance, expected) in
            [(2.7, 2), (-2.7, -2), (0.999_999, 1), (-2.999_99, -3), (f32::NAN, 0), (1e30, 1_000_000)]
        {
            assert_eq!(whole_pixels(distance), expected, "{distance}");
        }
    }

    #[test]
    fn what_moves_out_of_the_area_is_gone() {
        let out = offset(image(0, 0, &["123"]).into(), IntRect::from_ltrb(0, 0, 4, 4), 2, 1);
        assert_eq!(out, image(2, 1, &["12"]));
        let out = offset(image(0, 0, &["123"]).into(), IntRect::from_ltrb(0, 0, 4, 4), 9, 0);
        assert_eq!(out, Image::empty());
    }
}
