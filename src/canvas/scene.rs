//! 3D scenes on the canvas.

use std::sync::Arc;

use super::Canvas;
use crate::display_list::ImagePaint;
use crate::error::{Error, Result};
use crate::geom::Rect;
use crate::scene::{Camera, Scene, SceneSettings, SceneStats, render_picture};

impl Canvas<'_> {
    /// Draws a 3D scene, as a camera sees it, into `rect` of user space.
    ///
    /// It takes its turn in paint order and obeys the transform, the clip, open layers and the shadow like an image; what the scene does not
    /// cover lets through what was drawn before. The scene is drawn now, at the resolution that `rect` has on the canvas, and one
    /// pixel of it falls on one of the canvas' where the transform only moves and scales and `rect` lies on whole pixels.
    /// [`Camera::project`] with the same `rect` tells where a point of the scene lands, for labels.
    ///
    /// # Errors
    /// As [`render_picture`]; [`Error::Parameter`] for a rectangle that is empty or not finite. Nothing is drawn then.
    pub fn draw_scene(&mut self, scene: &Scene, camera: &Camera, rect: Rect) -> Result<SceneStats> {
        let settings = SceneSettings {
            threads: self.settings.threads,
            level: self.settings.level,
            antialias: crate::scene::SceneAntialias::Samples(crate::space::Samples::Msaa4),
            ..SceneSettings::default()
        };
        self.draw_scene_with(scene, camera, rect, &settings, &ImagePaint::default())
    }

    /// [`Canvas::draw_scene`], which has four samples a pixel, with other settings, and a paint for opacity and blending.
    ///
    /// # Errors
    /// As [`Canvas::draw_scene`].
    pub fn draw_scene_with(
        &mut self,
        scene: &Scene,
        camera: &Camera,
        rect: Rect,
        settings: &SceneSettings,
        paint: &ImagePaint,
    ) -> Result<SceneStats> {
        let rect = rect.normalized();
        let transform = self.state.transform;
        // Lengths of the rectangle's sides on the canvas.
        let side = |dx: f32, dy: f32| {
            let (x, y) = (transform.sx * dx + transform.kx * dy, transform.ky * dx + transform.sy * dy);
            (x * x + y * y).sqrt()
        };
        let (width, height) = (side(rect.width(), 0.0), side(0.0, rect.height()));
        if !(rect.is_finite() && width > 0.0 && height > 0.0 && width.is_finite() && height.is_finite()) {
            return Err(Error::Parameter("a scene needs a rectangle with an area to be drawn into".to_owned()));
        }
        // Sizes that are whole up to rounding are taken as whole.
        let pixels = |length: f32| (length - 1e-3).ceil().clamp(1.0, 65_536.0) as u32;
        let (width, height) = (pixels(width), pixels(height));
        let (picture, stats) = render_picture(scene, camera, width, height, settings)?;
        let source = Rect::from_xywh(0.0, 0.0, width as f32, height as f32);
        self.draw_image(&Arc::new(picture), source, rect, paint);
        Ok(stats)
    }
}
