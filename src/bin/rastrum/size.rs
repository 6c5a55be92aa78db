//! How large the picture is.

use crate::args::RenderArguments;

/// The picture's size in pixels, and the scale from the drawing's units to them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) scale: f32,
}

impl Size {
    /// The size at which a drawing of the given size (in CSS pixels, above 0) is drawn.
    pub(crate) fn of(arguments: &RenderArguments, width: f32, height: f32) -> Self {
        fit(arguments.width, arguments.height, arguments.zoom, f64::from(width), f64::from(height))
    }
}

fn fit(to_width: Option<u32>, to_height: Option<u32>, zoom: Option<f32>, width: f64, height: f64) -> Size {
    let across = to_width.map(|pixels| f64::from(pixels) / width);
    let down = to_height.map(|pixels| f64::from(pixels) / height);
    let scale = match (across, down) {
        (Some(across), Some(down)) => across.min(down),
        (Some(scale), None) | (None, Some(scale)) => scale,
        (None, None) => f64::from(zoom.unwrap_or(1.0)),
    };
    // A begun pixel counts, but not one that only rounding began.
    let whole = |length: f64| (length * scale - 1e-3).ceil().clamp(1.0, f64::from(u32::MAX)) as u32;
    Size { width: whole(width), height: whole(height), scale: scale as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(to_width: Option<u32>, to_height: Option<u32>, zoom: Option<f32>, width: f64, height: f64) -> (u32, u32) {
        let size = fit(to_width, to_height, zoom, width, height);
        (size.width, size.height)
    }

    #[test]
    fn the_aspect_is_kept() {
        assert_eq!(pixels(None, None, None, 30.0, 20.0), (30, 20));
        assert_eq!(pixels(Some(300), None, None, 30.0, 20.0), (300, 200));
        assert_eq!(pixels(None, Some(10), None, 30.0, 20.0), (15, 10));
        assert_eq!(pixels(Some(300), Some(100), None, 30.0, 20.0), (150, 100));
        assert_eq!(pixels(Some(100), Some(300), None, 30.0, 20.0), (100, 67));
        assert_eq!(pixels(None, None, Some(2.5), 30.0, 20.0), (75, 50));
    }

    #[test]
    fn a_begun_pixel_counts_unless_rounding_began_it() {
        assert_eq!(pixels(None, None, None, 30.2, 20.000_000_1), (31, 20));
        assert_eq!(pixels(None, None, Some(1e-9), 30.0, 20.0), (1, 1));
        for width in 1..500 {
            // A third and back again.
            assert_eq!(pixels(Some(width), None, None, 3.0, 3.0), (width, width));
        }
    }
}
