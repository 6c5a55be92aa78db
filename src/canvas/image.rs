//! Images on the canvas.

use std::sync::Arc;

use super::Canvas;
use crate::display_list::{ImagePaint, Paint};
use crate::geom::{IntRect, Point, Rect, Transform};
use crate::paint::{Pattern, SpreadMode};
use crate::surface::Pixmap;

impl Canvas<'_> {
    /// Draws the part `source` (in the image's pixels) of an image into `destination` (in user space), stretched to fit.
    /// Parts of `source` outside the image are transparent, and an empty `source` or `destination` draws nothing; one
    /// with swapped edges counts as if they were not. Pixels outside `source` do not bleed in.
    pub fn draw_image(&mut self, image: &Arc<Pixmap>, source: Rect, destination: Rect, paint: &ImagePaint) {
        let (source, destination) = (source.normalized(), destination.normalized());
        let all = Rect::from_xywh(0.0, 0.0, image.width() as f32, image.height() as f32);
        // The part of the source that exists, and where it goes.
        let scale = Point::new(destination.width() / source.width(), destination.height() / source.height());
        let inside = Rect::from_ltrb(
            source.left.max(all.left),
            source.top.max(all.top),
            source.right.min(all.right),
            source.bottom.min(all.bottom),
        );
        if !(scale.is_finite() && inside.left < inside.right && inside.top < inside.bottom) {
            return;
        }
        let to_user = Transform::from_row(
            scale.x,
            0.0,
            0.0,
            scale.y,
            destination.left - source.left * scale.x,
            destination.top - source.top * scale.y,
        );
        let Some(covered) = to_user.map_rect(inside) else { return };
        // Padding keeps the borders of the part sharp; it ends at the image's own borders unless the part
        // is cut out of the middle, which then is copied out.
        let whole = inside.round_out();
        let (image, to_user) = if whole.to_rect() == all {
            (Arc::clone(image), to_user)
        } else {
            let Ok(part) = image.as_ref().as_ref().crop(whole) else { return };
            (Arc::new(part), to_user.pre_concat(Transform::from_translate(whole.left as f32, whole.top as f32)))
        };
        let mut pattern = Pattern::new(image);
        pattern.quality = paint.quality;
        (pattern.spread_x, pattern.spread_y) = (SpreadMode::Pad, SpreadMode::Pad);
        pattern.transform = to_user;
        let fill = Paint {
            shader: pattern.into(),
            opacity: paint.opacity,
            blend_mode: paint.blend_mode,
            antialias: paint.antialias,
        };
        self.fill_rect(covered, fill);
    }

    /// Draws a whole image with its top left corner at a point of user space, one image pixel per unit.
    pub fn draw_image_at(&mut self, image: &Arc<Pixmap>, at: impl Into<Point>, paint: &ImagePaint) {
        let at = at.into();
        let (width, height) = (image.width(), image.height());
        let source = IntRect::from_xywh(0, 0, width, height).to_rect();
        self.draw_image(image, source, Rect::from_xywh(at.x, at.y, width as f32, height as f32), paint);
    }
}
