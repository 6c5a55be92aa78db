//! The drawing API: calls record, [`Canvas::flush`] renders.

mod aliased;
mod clip;
mod drawing;
mod filter;
mod fold;
mod image;
mod pixels;
mod scene;
mod section;
mod state;

pub use filter::LayerOptions;
pub use state::{SaveGuard, Shadow};

use crate::display_list::DisplayList;
use crate::error::{Error, Result};
use crate::geom::IntRect;
use crate::path::Path;
use crate::render::{RenderSettings, Renderer};
use crate::surface::{Limits, Pixmap, PixmapMut};

use section::Sections;
use state::{OpenLayer, Saves, State};

/// A canvas: drawing calls are recorded and become pixels together, band by band, when the picture is asked
/// for.
///
/// Coordinates are pixels with y pointing down; pixel (0, 0) covers the unit square at the origin, so its centre is
/// (0.5, 0.5). Drawing cannot fail: degenerate and non-finite geometry draws nothing.
///
/// ```
/// use rastrum::{Canvas, Color, Rect};
///
/// let mut canvas = Canvas::new(64, 64)?;
/// canvas.clear(Color::WHITE);
/// canvas.fill_rect(Rect::from_xywh(16.0, 16.0, 32.0, 32.0), Color::RED);
/// let pixmap = canvas.into_pixmap();
/// assert_eq!(pixmap.pixel(32, 32), Some([255, 0, 0, 255]));
/// # Ok::<(), rastrum::Error>(())
/// ```
#[derive(Debug)]
pub struct Canvas<'a> {
    target: Target<'a>,
    settings: RenderSettings,
    /// What was recorded since the last section.
    list: DisplayList,
    sections: Sections,
    renderer: Renderer,
    state: State,
    saves: Saves,
    layers: Vec<OpenLayer>,
    /// Bytes of the pictures that effects recorded since the last flush will take.
    pictures: u64,
    /// What a flush that nobody asked for could not draw.
    failed: Option<Error>,
    /// For the outlines of simple shapes.
    scratch: Path,
}

#[derive(Debug)]
enum Target<'a> {
    Owned(Pixmap),
    Borrowed(PixmapMut<'a>),
}

impl Canvas<'static> {
    /// A transparent canvas with pixels of its own.
    ///
    /// # Errors
    /// As [`Pixmap::new`].
    pub fn new(width: u32, height: u32) -> Result<Self> {
        Ok(Self::from_pixmap(Pixmap::new(width, height)?))
    }

    /// A transparent canvas with pixels of its own, rendered with `settings`.
    ///
    /// # Errors
    /// As [`Pixmap::new`].
    pub fn with_settings(width: u32, height: u32, settings: RenderSettings) -> Result<Self> {
        let mut canvas = Self::new(width, height)?;
        canvas.settings = settings;
        Ok(canvas)
    }

    /// A transparent canvas with pixels of its own, of a size checked against `limits`.
    ///
    /// # Errors
    /// As [`Pixmap::with_limits`].
    pub fn with_limits(width: u32, height: u32, limits: Limits) -> Result<Self> {
        Ok(Self::from_pixmap(Pixmap::with_limits(width, height, limits)?))
    }

    /// A canvas that draws over a picture.
    pub fn from_pixmap(pixmap: Pixmap) -> Self {
        Self::with_target(Target::Owned(pixmap))
    }
}

impl<'a> Canvas<'a> {
    /// A canvas that draws into pixels that someone else owns. They are complete after
    /// [`flush`](Self::flush) or when the canvas is dropped.
    pub fn on(pixels: PixmapMut<'a>) -> Self {
        Self::with_target(Target::Borrowed(pixels))
    }

    fn with_target(target: Target<'a>) -> Self {
        let mut canvas = Self {
            target,
            settings: RenderSettings::default(),
            list: DisplayList::default(),
            sections: Sections::default(),
            renderer: Renderer::default(),
            state: State::default(),
            saves: Saves::default(),
            layers: Vec::new(),
            pictures: 0,
            failed: None,
            scratch: Path::new(),
        };
        canvas.state.bounds = canvas.frame();
        canvas
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        match &self.target {
            Target::Owned(pixmap) => pixmap.width(),
            Target::Borrowed(pixels) => pixels.width(),
        }
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        match &self.target {
            Target::Owned(pixmap) => pixmap.height(),
            Target::Borrowed(pixels) => pixels.height(),
        }
    }

    /// How the canvas renders.
    pub fn settings(&self) -> RenderSettings {
        self.settings
    }

    /// Changes how the canvas renders what is not rendered yet. No setting changes a pixel.
    pub fn set_settings(&mut self, settings: RenderSettings) {
        self.settings = settings;
    }

    /// Renders what was recorded. While a layer is open nothing happens: what it will look like is known
    /// when it closes.
    ///
    /// # Errors
    /// [`Error::Limit`](crate::Error::Limit) if there is no memory for a shadow or a filter; all else is drawn.
    pub fn flush(&mut self) -> Result<()> {
        if !self.layers.is_empty() {
            return Ok(());
        }
        let mut target = match &mut self.target {
            Target::Owned(pixmap) => pixmap.as_mut(),
            Target::Borrowed(pixels) => pixels.reborrow(),
        };
        let result = self.renderer.render(&self.list, &mut target, self.settings);
        self.pictures = 0;
        self.sections.restart();
        if self.renderer.end_sections() {
            let first = self.renderer.spare_list();
            let last = std::mem::replace(&mut self.list, first);
            self.carry_clips(&last);
            self.renderer.keep(last);
        } else if self.is_clipped() {
            let old = std::mem::take(&mut self.list);
            self.carry_clips(&old);
        } else {
            self.list.clear();
        }
        match self.failed.take() {
            Some(error) => Err(error),
            None => result,
        }
    }

    /// The finished picture. Layers that are still open are closed first.
    pub fn into_pixmap(mut self) -> Pixmap {
        self.finish();
        match &mut self.target {
            Target::Owned(pixmap) => std::mem::replace(pixmap, Pixmap::placeholder()),
            Target::Borrowed(pixels) => {
                let all = IntRect::from_xywh(0, 0, pixels.width(), pixels.height());
                pixels.as_ref().crop(all).unwrap_or_else(|_| Pixmap::placeholder())
            }
        }
    }

    fn frame(&self) -> IntRect {
        IntRect::from_xywh(0, 0, self.width(), self.height())
    }

    fn finish(&mut self) {
        while !self.layers.is_empty() {
            self.close_layer();
        }
        // Without memory for a shadow the rest of the picture is still the best answer; callers who need to
        // know call `flush` themselves.
        let _ = self.flush();
    }
}

impl Drop for Canvas<'_> {
    fn drop(&mut self) {
        if matches!(self.target, Target::Borrowed(_)) {
            self.finish();
        }
    }
}
