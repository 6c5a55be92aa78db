//! From a recording to pixels.
//!
//! [`prepare`] turns the recording's shapes into edges listed by band, [`band`] paints one band from its
//! first command to its last, and [`pool`](crate::pool) hands bands to threads. A band's pixels depend on the recording
//! alone, so that neither the number of threads nor the bands' height shows.

mod band;
mod clip;
mod clip_cache;
mod coverage;
mod hidden;
mod kept;
mod layer;
mod occlusion;
mod painter;
mod parts;
mod plan;
mod prepare;
mod settings;
mod surface;

use std::sync::Mutex;

pub(crate) use parts::Parts;
pub use settings::RenderSettings;

use crate::display_list::DisplayList;
use crate::error::Result;
use crate::geom::IntRect;
use crate::surface::PixmapMut;
use crate::surface::block::BLOCK_WIDTH;

/// Working memory that outlives a frame: after the first, drawing alike frames allocates nothing.
#[derive(Debug, Default)]
pub(crate) struct Renderer {
    chunks: Vec<prepare::Chunk>,
    bands: Mutex<Vec<band::BandScratch>>,
}

impl Renderer {
    /// Draws a recording onto a target. What there is no memory for is left out, and the error says so.
    pub(crate) fn render(
        &mut self,
        list: &DisplayList,
        target: &mut PixmapMut<'_>,
        settings: RenderSettings,
    ) -> Result<()> {
        if list.commands.is_empty() {
            return Ok(());
        }
        let settings = settings.resolved();
        let frame = IntRect::from_xywh(0, 0, target.width(), target.height());
        let (plan, planned) = plan::plan(list, frame, settings);
        self.paint(list, &plan, target, settings);
        planned
    }

    /// Draws a recording whose pictures are made. `settings` are resolved.
    fn paint(&mut self, list: &DisplayList, plan: &plan::Plan, target: &mut PixmapMut<'_>, settings: RenderSettings) {
        let frame = IntRect::from_xywh(0, 0, target.width(), target.height());
        let chunks = self.prepare(list, plan, frame, settings);
        self.paint_part(list, plan, chunks, frame, frame, target, settings);
    }

    /// Lists the edges of a recording's shapes by band of `frame`, and says in how many chunks.
    fn prepare(&mut self, list: &DisplayList, plan: &plan::Plan, frame: IntRect, settings: RenderSettings) -> usize {
        let bands = frame.height().div_ceil(settings.band_height) as usize;
        let chunk_count = prepare::chunk_count(list.commands.len(), settings.threads);
        self.chunks.resize_with(chunk_count.max(self.chunks.len()), prepare::Chunk::default);
        let Some(chunks) = self.chunks.get_mut(..chunk_count) else { return 0 };
        let ranges = prepare::split(list.commands.len(), chunk_count);
        let jobs: Vec<_> = chunks.iter_mut().zip(ranges).collect();
        crate::pool::for_each(settings.threads, jobs, |(chunk, range)| {
            chunk.prepare(list, plan, range, frame, bands, settings.band_height.trailing_zeros(), settings.level);
        });
        chunk_count
    }

    /// Draws what of a prepared frame lies in `area`, which starts with a block and a band and is what `target` holds.
    /// Edges are those of the whole frame, so that no pixel depends on the area.
    #[expect(clippy::too_many_arguments, reason = "the drawing, and where to")]
    fn paint_part(
        &self,
        list: &DisplayList,
        plan: &plan::Plan,
        chunks: usize,
        frame: IntRect,
        area: IntRect,
        target: &mut PixmapMut<'_>,
        settings: RenderSettings,
    ) {
        let drawing = Drawing { list, plan, chunks: self.chunks.get(..chunks).unwrap_or(&[]), frame };
        let band_height = settings.band_height;
        let seen = (area.left as usize / BLOCK_WIDTH, (area.right as usize).div_ceil(BLOCK_WIDTH));
        let first = area.top as usize / band_height as usize;
        let (scratch, stride) = (&self.bands, target.stride());
        let bands = area.height().div_ceil(band_height) as usize;
        let jobs: Vec<_> =
            target.bytes_mut().chunks_mut(stride * band_height as usize).enumerate().take(bands).collect();
        crate::pool::for_each(settings.threads, jobs, |(index, rows)| {
            let mut own = scratch.lock().ok().and_then(|mut all| take_own(&mut all)).unwrap_or_default();
            let offset = index as u32 * band_height;
            let count = band_height.min(area.height() - offset) as usize;
            let surface = surface::Surface::new(rows, stride, seen.0, area.width() as usize, count);
            let band = band::Frame::new(&drawing, first + index, area.top + offset as i32, count, seen);
            band::render(&band, surface, &mut own, settings.level);
            own.user = Some(std::thread::current().id());
            if let Ok(mut all) = scratch.lock() {
                all.push(own);
            }
        });
    }
}

/// The working memory that this thread used last, which its core's cache may hold, or another.
fn take_own(all: &mut Vec<band::BandScratch>) -> Option<band::BandScratch> {
    let user = Some(std::thread::current().id());
    match all.iter().rposition(|scratch| scratch.user == user) {
        Some(own) => Some(all.swap_remove(own)),
        None => all.pop(),
    }
}

/// A recording that is ready to be painted, band by band.
#[derive(Clone, Copy)]
struct Drawing<'a> {
    list: &'a DisplayList,
    plan: &'a plan::Plan,
    chunks: &'a [prepare::Chunk],
    frame: IntRect,
}
