//! Patterns: the tile is drawn once at the resolution of the device and repeated as an image.

use std::sync::Arc;

use super::convert;
use super::render::Renderer;
use super::warning::WarningKind;
use crate::canvas::Canvas;
use crate::geom::Transform;
use crate::paint::Pattern;
use crate::render::RenderSettings;
use crate::surface::Pixmap;

/// The most pixels of a tile: 8192 × 4096, 128 MiB.
const MAX_TILE_PIXELS: f64 = (1_u32 << 25) as f64;

/// The longest side of a tile.
const MAX_TILE_SIDE: f64 = 32_767.0;

/// How many patterns may be drawn inside each other: unlike groups, each has a canvas of its own and takes
/// some of the thread's stack.
const MAX_PATTERN_DEPTH: u32 = 16;

/// A tile that was drawn, and what it was drawn for.
pub(super) struct Tile {
    pattern: Arc<usvg::Pattern>,
    size: (u32, u32),
    image: Arc<Pixmap>,
}

impl Renderer<'_> {
    /// The pattern as a paint for the canvas's current transform. `None` paints nothing.
    pub(super) fn pattern(&mut self, pattern: &Arc<usvg::Pattern>, canvas: &Canvas<'_>) -> Option<Pattern> {
        let own = convert::transform(pattern.transform());
        let rect = convert::rect(pattern.rect());
        let size = self.tile_size(pattern, canvas.current_transform().pre_concat(own))?;
        let image = self.tile(pattern, size, canvas.settings())?;
        // The tile's sides are whole pixels; stretching it back to the rectangle keeps the period exact.
        let (width, height) = (size.0 as f32, size.1 as f32);
        Some(Pattern {
            transform: own
                .pre_concat(Transform::from_translate(rect.left, rect.top))
                .pre_concat(Transform::from_scale(rect.width() / width, rect.height() / height)),
            ..Pattern::new(image)
        })
    }

    /// The size of the tile in pixels, nearest to its size on the device.
    fn tile_size(&mut self, pattern: &usvg::Pattern, transform: Transform) -> Option<(u32, u32)> {
        let length = |x: f32, y: f32| (f64::from(x) * f64::from(x) + f64::from(y) * f64::from(y)).sqrt();
        let rect = pattern.rect();
        let width = f64::from(rect.width()) * length(transform.sx, transform.ky);
        let height = f64::from(rect.height()) * length(transform.kx, transform.sy);
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
        // Both are within 0 ..= MAX_TILE_SIDE.
        let whole = |side: f64| side.round().max(1.0) as u32;
        Some((whole(fit.0), whole(fit.1)))
    }

    fn tile(
        &mut self,
        pattern: &Arc<usvg::Pattern>,
        size: (u32, u32),
        settings: RenderSettings,
    ) -> Option<Arc<Pixmap>> {
        if let Some(tile) = self.tiles.iter().find(|tile| tile.size == size && Arc::ptr_eq(&tile.pattern, pattern)) {
            return Some(tile.image.clone());
        }
        if self.pattern_depth >= MAX_PATTERN_DEPTH {
            self.warnings.add(WarningKind::PatternDepth, pattern.id());
            return None;
        }
        if !self.count_layer() {
            return None;
        }
        let fits = self.count_pixels(size.0, size.1);
        let canvas = fits.then(|| Canvas::with_settings(size.0, size.1, settings).ok());
        let Some(mut canvas) = canvas.flatten() else {
            self.warnings.add(WarningKind::PatternSize, pattern.id());
            return None;
        };
        let rect = pattern.rect();
        canvas.transform(Transform::from_scale(size.0 as f32 / rect.width(), size.1 as f32 / rect.height()));
        self.pattern_depth += 1;
        self.draw_children(pattern.root(), &mut canvas);
        self.pattern_depth -= 1;
        let image = Arc::new(canvas.into_pixmap());
        self.tiles.push(Tile { pattern: pattern.clone(), size, image: image.clone() });
        Some(image)
    }
}
