//! A recording drawn part by part, for those who need much of it but never all at a time.

use std::borrow::Cow;

use super::plan::{Plan, plan};
use super::{Drawing, RenderSettings, Renderer};
use crate::display_list::DisplayList;
use crate::error::Result;
use crate::filter::{self, Image};
use crate::geom::IntRect;
use crate::surface::Pixmap;
use crate::surface::block::BLOCK_WIDTH;

/// Rows of a band: parts are whole bands high, and few rows should be drawn in vain.
const BAND_HEIGHT: u32 = 32;

/// A recording with its edges listed and its effects' pictures made.
pub(crate) struct Parts<'a> {
    list: &'a DisplayList,
    plan: Plan,
    renderer: Renderer,
    chunks: usize,
    /// The recording's pixels.
    frame: IntRect,
    /// Where the frame's top left corner lies for those who ask for parts.
    origin: (i32, i32),
    settings: RenderSettings,
}

impl<'a> Parts<'a> {
    /// Prepares a recording of the pixels of `extent`, moved so that that starts at (0, 0).
    pub(crate) fn new(list: &'a DisplayList, extent: IntRect, settings: RenderSettings) -> Result<Self> {
        Self::of(list, extent, IntRect::from_xywh(0, 0, extent.width(), extent.height()), settings)
    }

    /// As [`new`](Self::new); effects are only seen in `seen`, pixels of the recording.
    fn of(list: &'a DisplayList, extent: IntRect, seen: IntRect, settings: RenderSettings) -> Result<Self> {
        let frame = IntRect::from_xywh(0, 0, extent.width(), extent.height());
        let settings = settings.with_band_height(BAND_HEIGHT).resolved(frame);
        // Pictures in it come first, so that effects in each other do not hold one surface for each.
        let (plan, planned) = plan(list, seen, settings);
        planned?;
        let mut renderer = Renderer::default();
        let chunks = renderer.prepare(list, &plan, frame, settings);
        Ok(Self { list, plan, renderer, chunks, frame, origin: (extent.left, extent.top), settings })
    }

    /// What a recording draws in `area`, alone, and where that picture's top left corner lies: not to the right of the
    /// area's, nor below it.
    pub(crate) fn one(list: &'a DisplayList, area: IntRect, settings: RenderSettings) -> Result<(Pixmap, i32, i32)> {
        let frame = IntRect::from_ltrb(0, 0, area.right.max(1), area.bottom.max(1));
        Self::of(list, frame, area, settings)?.draw(area)
    }

    /// Draws what of the frame lies in `area`, in whole blocks and bands.
    fn draw(&self, area: IntRect) -> Result<(Pixmap, i32, i32)> {
        let down_to = |v: i32, step: i32| v - v.rem_euclid(step);
        let area = area.intersect(self.frame);
        let (left, top) = (down_to(area.left, BLOCK_WIDTH as i32), down_to(area.top, BAND_HEIGHT as i32));
        let bottom = area.bottom.saturating_add(BAND_HEIGHT as i32 - 1);
        let bottom = down_to(bottom, BAND_HEIGHT as i32).min(self.frame.bottom);
        let whole = IntRect::from_ltrb(left, top, area.right, bottom);
        let mut pixmap = Pixmap::new(whole.width(), whole.height())?;
        let target = &mut pixmap.as_mut();
        let pieces: Vec<_> = self.renderer.pieces(self.list, self.chunks).collect();
        let drawing = Drawing { list: self.list, plan: &self.plan, pieces: &pieces, frame: self.frame };
        self.renderer.paint_part(&drawing, whole, target, self.settings);
        Ok((pixmap, left, top))
    }
}

impl filter::Parts for Parts<'_> {
    fn bounds(&self) -> IntRect {
        let (x, y) = self.origin;
        IntRect::from_xywh(x, y, self.frame.width(), self.frame.height())
    }

    fn part(&self, area: IntRect) -> Result<Cow<'_, Image>> {
        let (x, y) = self.origin;
        let area = area.intersect(filter::Parts::bounds(self));
        if area.is_empty() {
            return Ok(Cow::Owned(Image::empty()));
        }
        let inside = IntRect::from_ltrb(area.left - x, area.top - y, area.right - x, area.bottom - y);
        let (pixmap, left, top) = self.draw(inside)?;
        Ok(Cow::Owned(Image::from_pixmap(pixmap, left + x, top + y)))
    }

    fn is_whole(&self) -> bool {
        false
    }
}
