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
mod plan;
mod prepare;
mod settings;
mod surface;

use std::sync::Mutex;

pub use settings::RenderSettings;

use crate::display_list::DisplayList;
use crate::error::Result;
use crate::geom::IntRect;
use crate::surface::PixmapMut;

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
        let (width, height) = (target.width(), target.height());
        let frame = IntRect::from_xywh(0, 0, width, height);
        let band_height = settings.band_height;
        let bands = height.div_ceil(band_height) as usize;

        let chunk_count = prepare::chunk_count(list.commands.len(), settings.threads);
        self.chunks.resize_with(chunk_count.max(self.chunks.len()), prepare::Chunk::default);
        let Some(chunks) = self.chunks.get_mut(..chunk_count) else { return };
        let ranges = prepare::split(list.commands.len(), chunk_count);
        let jobs: Vec<_> = chunks.iter_mut().zip(ranges).collect();
        crate::pool::for_each(settings.threads, jobs, |(chunk, range)| {
            chunk.prepare(list, plan, range, frame, bands, band_height.trailing_zeros(), settings.level);
        });

        let chunks: &[prepare::Chunk] = chunks;
        let scratch = &self.bands;
        let stride = target.stride();
        let jobs: Vec<_> =
            target.bytes_mut().chunks_mut(stride * band_height as usize).enumerate().take(bands).collect();
        crate::pool::for_each(settings.threads, jobs, |(index, rows)| {
            let mut own = scratch.lock().ok().and_then(|mut all| all.pop()).unwrap_or_default();
            let top = index as u32 * band_height;
            let surface =
                surface::Surface::new(rows, stride, 0, width as usize, band_height.min(height - top) as usize);
            band::render(list, plan, chunks, index, top as i32, surface, &mut own, settings.level);
            if let Ok(mut all) = scratch.lock() {
                all.push(own);
            }
        });
    }
}
