//! Reading and writing pixels in the middle of drawing.

use std::sync::Arc;

use super::{Canvas, Target};
use crate::blend::BlendMode;
use crate::display_list::{ClipId, Paint};
use crate::error::Result;
use crate::geom::{IntRect, Transform};
use crate::paint::{FilterQuality, Pattern, SpreadMode};
use crate::surface::{Pixmap, PixmapRef};

impl Canvas<'_> {
    /// A copy of the pixels in `rect` as the canvas stands now; what lies outside the canvas is transparent. Open layers
    /// look as if they were closed here, and stay open.
    ///
    /// # Errors
    /// As [`Pixmap::new`], for the size of `rect`; [`Error::Limit`](crate::Error::Limit) if there is no memory.
    pub fn read_pixels(&mut self, rect: IntRect) -> Result<Pixmap> {
        self.flush()?;
        if self.layers.is_empty() {
            return self.target().crop(rect);
        }
        let mut copy = self.target().crop(self.frame())?;
        let mut list = self.list.clone();
        for layer in self.layers.iter().rev() {
            layer.kind.end_copy(&mut list);
        }
        self.renderer.render(&list, &mut copy.as_mut(), self.settings)?;
        copy.as_ref().crop(rect)
    }

    /// Replaces pixels by those of `source`, its top left corner at device pixel (x, y). Neither the transform nor the clip
    /// matters; an open layer is written to, within its bounds.
    ///
    /// # Errors
    /// As [`Pixmap::new`], for the copy that the recording keeps.
    pub fn write_pixels(&mut self, source: PixmapRef<'_>, x: i32, y: i32) -> Result<()> {
        let copy = source.crop(IntRect::from_xywh(0, 0, source.width(), source.height()))?;
        let (dx, dy) = self.state.origin();
        let rect = IntRect::from_xywh(x.saturating_add(dx), y.saturating_add(dy), source.width(), source.height());
        let mut pattern = Pattern::new(Arc::new(copy));
        pattern.quality = FilterQuality::Nearest;
        (pattern.spread_x, pattern.spread_y) = (SpreadMode::Decal, SpreadMode::Decal);
        pattern.transform = Transform::from_translate(x as f32, y as f32);
        let outer = self.state;
        self.state.transform = Transform::IDENTITY;
        self.state.clip = ClipId::NONE;
        self.state.shadow = None;
        self.state.bounds = self.layer_bounds().intersect(rect);
        self.fill(Paint::new(pattern).with_blend_mode(BlendMode::Source));
        self.state = outer;
        Ok(())
    }

    /// The pixels that the open layer holds, or all.
    fn layer_bounds(&self) -> IntRect {
        self.layers.last().map_or(self.frame(), |layer| layer.kind.bounds())
    }

    fn target(&self) -> PixmapRef<'_> {
        match &self.target {
            Target::Owned(pixmap) => pixmap.as_ref(),
            Target::Borrowed(pixels) => pixels.as_ref(),
        }
    }
}
