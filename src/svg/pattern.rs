//! Patterns: the tile is drawn once at the resolution of the device and repeated as an image.

use std::sync::Arc;

use super::convert;
use super::render::Renderer;
use super::warning::WarningKind;
use crate::canvas::Canvas;
use crate::geom::Transform;
use crate::paint::{FilterQuality, Pattern};
use crate::render::RenderSettings;
use crate::surface::Pixmap;

/// The most pixels of a tile: 8192 × 4096, 128 MiB.
const MAX_TILE_PIXELS: f64 = (1_u32 << 25) as f64;

/// The longest side of a tile.
const MAX_TILE_SIDE: f64 = 32_767.0;

/// A tile that was drawn, and what it was drawn for.
pub(super) struct Tile {
    pattern: Arc<usvg::Pattern>,
    grid: Grid,
    image: Arc<Pixmap>,
}

/// The pixels of a tile.
#[derive(Clone, Copy, PartialEq)]
struct Grid {
    /// Columns and rows.
    size: (u32, u32),
    /// Pixels per unit of the pattern's space, across and down.
    scale: (f32, f32),
}

/// The whole pixels of a tile's side, and the length that they show. The two differ by the rounding of a side of
/// two pixels or more: the tile is then repeated by whole pixels, as resvg does, and none is resampled. A shorter
/// side, whose period this might change by half, is stretched to whole pixels instead.
fn whole(side: f64) -> (u32, f64) {
    // At most MAX_TILE_SIDE.
    let pixels = side.round().max(1.0);
    (pixels as u32, if side < 2.0 { pixels } else { side })
}

/// How a tile's pixels are sampled.
fn quality(to_device: Transform, grid: Grid) -> FilterQuality {
    let near = |a: f32, b: f32| (a - b).abs() < 1e-5 * b;
    if !to_device.is_scale_translate() {
        // Turned pixels lie between the device's, where bilinear sampling would soften lines and text.
        FilterQuality::Bicubic
    } else if near(grid.scale.0, to_device.sx) && near(grid.scale.1, to_device.sy) {
        // As large as the device's, they are moved to them, by half a pixel at most.
        FilterQuality::Nearest
    } else {
        FilterQuality::Bilinear
    }
}

impl Renderer<'_> {
    /// The pattern as a paint for the canvas's current transform. `None` paints nothing.
    pub(super) fn pattern(&mut self, pattern: &Arc<usvg::Pattern>, canvas: &Canvas<'_>) -> Option<Pattern> {
        let own = convert::transform(pattern.transform());
        let rect = convert::rect(pattern.rect());
        let to_device = canvas.current_transform().pre_concat(own);
        let grid = self.grid(pattern, to_device)?;
        let image = self.tile(pattern, grid, canvas.settings())?;
        Some(Pattern {
            transform: own
                .pre_concat(Transform::from_translate(rect.left, rect.top))
                .pre_concat(Transform::from_scale(1.0 / grid.scale.0, 1.0 / grid.scale.1)),
            quality: quality(to_device, grid),
            ..Pattern::new(image)
        })
    }

    /// The tile's pixels, nearest to its size on the device.
    fn grid(&mut self, pattern: &usvg::Pattern, transform: Transform) -> Option<Grid> {
        let length = |x: f32, y: f32| (f64::from(x) * f64::from(x) + f64::from(y) * f64::from(y)).sqrt();
        let rect = pattern.rect();
        // Under a skew resvg takes the rows' lengths, not the columns', and the rounding below makes that visible.
        let width = f64::from(rect.width()) * length(transform.sx, transform.kx);
        let height = f64::from(rect.height()) * length(transform.ky, transform.sy);
        if !(width > 0.0 && height > 0.0 && width.is_finite() && height.is_finite()) {
            return None;
        }
        let shrink = |width: f64, height: f64| {
            let area = (MAX_TILE_PIXELS / (width * height)).sqrt();
            if area < 1.0 { (width * area, height * area) } else { (width, height) }
        };
        let fit = shrink(width.min(MAX_TILE_SIDE), height.min(MAX_TILE_SIDE));
        if fit != (width, height) {
            self.warnings.add(WarningKind::PatternSize, pattern.id());
        }
        let (columns, mut across) = whole(fit.0);
        let (rows, mut down) = whole(fit.1);
        if fit != (width, height) {
            // Its pixels are resampled anyway.
            (across, down) = (f64::from(columns), f64::from(rows));
        }
        let scale = ((across / f64::from(rect.width())) as f32, (down / f64::from(rect.height())) as f32);
        (scale.0.is_normal() && scale.1.is_normal()).then_some(Grid { size: (columns, rows), scale })
    }

    fn tile(&mut self, pattern: &Arc<usvg::Pattern>, grid: Grid, settings: RenderSettings) -> Option<Arc<Pixmap>> {
        if let Some(tile) = self.tiles.iter().find(|tile| tile.grid == grid && Arc::ptr_eq(&tile.pattern, pattern)) {
            return Some(tile.image.clone());
        }
        if !self.enter_canvas(pattern.id()) {
            return None;
        }
        let Grid { size, scale } = grid;
        let fits = self.count_pixels(size.0, size.1);
        let canvas = fits.then(|| Canvas::with_settings(size.0, size.1, settings).ok());
        let Some(mut canvas) = canvas.flatten() else {
            self.leave_canvas();
            self.warnings.add(WarningKind::PatternSize, pattern.id());
            return None;
        };
        canvas.transform(Transform::from_scale(scale.0, scale.1));
        self.draw_children(pattern.root(), &mut canvas);
        self.leave_canvas();
        let image = Arc::new(canvas.into_pixmap());
        self.tiles.push(Tile { pattern: pattern.clone(), grid, image: image.clone() });
        Some(image)
    }
}
