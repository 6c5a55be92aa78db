//! Images: embedded pictures and nested SVG files.

use std::sync::Arc;

use super::group;
use super::render::{Renderer, Step};
use super::shape::Effects;
use super::warning::WarningKind;
use crate::canvas::Canvas;
use crate::display_list::ImagePaint;
use crate::geom::Rect;
use crate::paint::FilterQuality;
use crate::surface::Pixmap;

/// An embedded picture that was decoded.
pub(super) struct Picture {
    /// The file that it is in; one file is shared by all that show it.
    bytes: Arc<Vec<u8>>,
    /// `None` where decoding failed.
    image: Option<Arc<Pixmap>>,
}

impl Renderer<'_> {
    pub(super) fn draw_image<'t>(
        &mut self,
        image: &'t usvg::Image,
        effects: &Effects,
        steps: &mut Vec<Step<'t>>,
        canvas: &mut Canvas<'_>,
    ) {
        if !image.is_visible() {
            return;
        }
        let bytes = match image.kind() {
            usvg::ImageKind::SVG(tree) => {
                canvas.save();
                steps.push(Step::Restore);
                let size = Rect::from_xywh(0.0, 0.0, tree.size().width(), tree.size().height());
                group::clip_to_rect(size, tree.root(), self, steps, canvas);
                return;
            }
            usvg::ImageKind::PNG(bytes)
            | usvg::ImageKind::JPEG(bytes)
            | usvg::ImageKind::GIF(bytes)
            | usvg::ImageKind::WEBP(bytes) => bytes,
        };
        let Some(picture) = self.picture(bytes, image.id()) else { return };
        let whole = Rect::from_xywh(0.0, 0.0, picture.width() as f32, picture.height() as f32);
        let paint = ImagePaint {
            quality: quality(image.rendering_mode()),
            opacity: effects.opacity,
            blend_mode: effects.blend_mode,
            antialias: self.settings.antialias,
        };
        canvas.draw_image(&picture, whole, whole, &paint);
    }

    /// The picture in a file's bytes, decoded once however often it is shown.
    fn picture(&mut self, bytes: &Arc<Vec<u8>>, id: &str) -> Option<Arc<Pixmap>> {
        if let Some(picture) = self.pictures.iter().find(|picture| Arc::ptr_eq(&picture.bytes, bytes)) {
            return picture.image.clone();
        }
        let image = match decode(bytes, self.bytes_to_decode()) {
            Ok(picture) if self.count_pixels(picture.width(), picture.height()) => Some(Arc::new(picture)),
            Ok(_) => {
                self.warnings.add(WarningKind::Image("the pictures are too large together".to_owned()), id);
                None
            }
            Err(reason) => {
                self.warnings.add(WarningKind::Image(reason), id);
                None
            }
        };
        self.pictures.push(Picture { bytes: bytes.clone(), image: image.clone() });
        image
    }
}

#[cfg(feature = "codec")]
fn decode(bytes: &[u8], max_bytes: u64) -> Result<Pixmap, String> {
    Pixmap::decode_within(bytes, max_bytes).map_err(|error| error.to_string())
}

#[cfg(not(feature = "codec"))]
fn decode(_: &[u8], _: u64) -> Result<Pixmap, String> {
    Err("this build has no picture decoders (feature `codec`)".to_owned())
}

fn quality(mode: usvg::ImageRendering) -> FilterQuality {
    use usvg::ImageRendering as Mode;
    match mode {
        Mode::OptimizeQuality | Mode::HighQuality => FilterQuality::Bicubic,
        Mode::Smooth => FilterQuality::Bilinear,
        Mode::OptimizeSpeed | Mode::CrispEdges | Mode::Pixelated => FilterQuality::Nearest,
    }
}
