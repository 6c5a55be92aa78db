//! From a recording to pixels.
//!
//! [`prepare`] turns the recording's shapes into edges listed by band, [`band`] paints one band from its
//! first command to its last, and [`pool`](crate::pool) hands bands to threads. A band's pixels depend on the recording
//! alone, so that neither the number of threads nor the bands' height shows.

mod band;
mod bar;
mod clip;
mod clip_cache;
mod coverage;
mod hidden;
mod kept;
mod layer;
mod occlusion;
mod opaque_rect;
mod painter;
mod parts;
mod plan;
mod prepare;
mod section;
mod settings;
mod surface;

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};

pub(crate) use parts::Parts;
pub use settings::RenderSettings;

use prepare::{Chunk, Slice};
use section::Section;

use crate::display_list::DisplayList;
use crate::error::Result;
use crate::geom::IntRect;
use crate::surface::PixmapMut;
use crate::surface::block::BLOCK_WIDTH;

/// Working memory that outlives a frame: after the first, drawing alike frames allocates nothing.
#[derive(Debug, Default)]
pub(crate) struct Renderer {
    /// What was recorded before the list that is being recorded.
    sections: Vec<Arc<Section>>,
    chunks: Vec<Chunk>,
    bands: Mutex<Vec<band::BandScratch>>,
    /// The lists of the last frame, in its order: the next may record the same again.
    spare_lists: VecDeque<DisplayList>,
    spare_chunks: VecDeque<Chunk>,
}

impl Renderer {
    /// Takes over what was recorded for `frame` so far, to be prepared by a thread that has nothing to do, and gives an empty
    /// list to go on with. What sections may hold: [`section`].
    pub(crate) fn take_section(&mut self, list: DisplayList, frame: IntRect, settings: RenderSettings) -> DisplayList {
        let settings = settings.resolved(frame);
        let section = Arc::new(Section::new(list, frame, &mut self.spare_chunks));
        self.sections.push(Arc::clone(&section));
        crate::pool::offer(settings.threads, move || section.prepare(settings));
        self.spare_list()
    }

    /// How many sections there are.
    #[cfg(test)]
    pub(crate) fn section_count(&self) -> usize {
        self.sections.len()
    }

    /// Draws the sections and a recording that follows them onto a target. What there is no memory for is left out, and the error
    /// says so.
    pub(crate) fn render(
        &mut self,
        list: &DisplayList,
        target: &mut PixmapMut<'_>,
        settings: RenderSettings,
    ) -> Result<()> {
        if list.commands.is_empty() && self.sections.is_empty() {
            return Ok(());
        }
        let frame = IntRect::from_xywh(0, 0, target.width(), target.height());
        let settings = settings.resolved(frame);
        let (plan, planned) = plan::plan(list, frame, settings);
        let chunks = self.prepare(list, &plan, frame, settings);
        let sections = self.sections.iter();
        let sections: Vec<_> =
            sections.flat_map(|section| section.edges(settings).map(|edges| (section.list(), edges))).collect();
        let pieces = sections.iter().map(|(list, edges)| Piece { list, chunk: edges.chunk() });
        let pieces: Vec<_> = pieces.chain(self.pieces(list, chunks)).collect();
        self.paint_part(&Drawing { list, plan: &plan, pieces: &pieces, frame }, frame, target, settings);
        planned
    }

    /// Ends a frame with sections: they are forgotten, and their memory, in their order, is what is spare. False if there were none.
    pub(crate) fn end_sections(&mut self) -> bool {
        if self.sections.is_empty() {
            return false;
        }
        self.spare_lists.clear();
        self.spare_chunks.clear();
        for section in self.sections.drain(..) {
            if let Some((list, chunks)) = section.into_memory() {
                self.spare_lists.push_back(list);
                self.spare_chunks.extend(chunks);
            }
        }
        true
    }

    /// Keeps the memory of a list that was drawn.
    pub(crate) fn keep(&mut self, mut list: DisplayList) {
        list.clear();
        self.spare_lists.push_back(list);
    }

    /// An empty list.
    pub(crate) fn spare_list(&mut self) -> DisplayList {
        self.spare_lists.pop_front().unwrap_or_default()
    }

    /// Lists the edges of the shapes of the sections and of `list` by band of `frame`, and says in how many chunks those of `list`
    /// are.
    fn prepare(&mut self, list: &DisplayList, plan: &plan::Plan, frame: IntRect, settings: RenderSettings) -> usize {
        let slices = prepare::slices(list, prepare::chunk_count(list.commands.len(), settings.threads));
        let count = slices.len();
        self.chunks.resize_with(count.max(self.chunks.len()), Chunk::default);
        let sections = self.sections.iter();
        let sections = sections.flat_map(|section| (0..section.parts()).map(move |part| Job::Section(section, part)));
        let chunks = self.chunks.iter_mut().zip(&slices).map(|(chunk, slice)| Job::Chunk(chunk, slice));
        crate::pool::for_each(settings.threads, sections.chain(chunks).collect(), |job| match job {
            Job::Section(section, part) => {
                section.prepare_part(part, settings);
            }
            Job::Chunk(chunk, slice) => chunk.prepare(list, plan, slice, frame, settings),
        });
        count
    }

    /// What the first chunks hold of a recording.
    fn pieces<'a>(&'a self, list: &'a DisplayList, chunks: usize) -> impl Iterator<Item = Piece<'a>> {
        self.chunks.iter().take(chunks).map(move |chunk| Piece { list, chunk })
    }

    /// Draws what of a prepared drawing lies in `area`, which starts with a block and a band and is what `target` holds.
    /// Edges are those of the whole frame, so that no pixel depends on the area.
    fn paint_part(&self, drawing: &Drawing<'_>, area: IntRect, target: &mut PixmapMut<'_>, settings: RenderSettings) {
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
            let band = band::Frame::new(drawing, first + index, area.top + offset as i32, count, seen);
            band::render(&band, surface, &mut own, settings.level);
            own.user = Some(std::thread::current().id());
            if let Ok(mut all) = scratch.lock() {
                all.push(own);
            }
        });
    }
}

/// A step of preparing a frame.
enum Job<'a> {
    /// A part of a section.
    Section(&'a Section, usize),
    Chunk(&'a mut Chunk, &'a Slice),
}

/// The working memory that this thread used last, which its core's cache may hold, or another.
fn take_own(all: &mut Vec<band::BandScratch>) -> Option<band::BandScratch> {
    let user = Some(std::thread::current().id());
    match all.iter().rposition(|scratch| scratch.user == user) {
        Some(own) => Some(all.swap_remove(own)),
        None => all.pop(),
    }
}

/// What is ready to be painted, band by band.
#[derive(Clone, Copy)]
struct Drawing<'a> {
    /// The last recording, which alone may have effects.
    list: &'a DisplayList,
    plan: &'a plan::Plan,
    pieces: &'a [Piece<'a>],
    frame: IntRect,
}

/// A recording and the edges of some of its commands.
#[derive(Clone, Copy)]
struct Piece<'a> {
    list: &'a DisplayList,
    chunk: &'a Chunk,
}
