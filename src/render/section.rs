//! A recording that is not over, prepared so far.
//!
//! One thread records while the others have nothing to do. What it has recorded it hands over, section by section: a helper
//! that comes in time prepares it, and what none has begun when the picture is asked for is prepared with the rest.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::RenderSettings;
use super::plan::Plan;
use super::prepare::{Chunk, Slice, slices};
use crate::display_list::DisplayList;
use crate::geom::IntRect;

/// Work of a part, some 100 to 200 µs. Each has a list for each band, so that smaller ones cost more than the wait for the last
/// of them.
const WORK: usize = 16_384;
/// A section has at most so many parts.
const MOST_PARTS: usize = 32;

/// Commands that need nothing of those before and after them: without effects, and with the layers that they begin ended, the clips that
/// they set given up.
#[derive(Debug)]
pub(super) struct Section {
    list: DisplayList,
    frame: IntRect,
    parts: Vec<Part>,
}

/// Some of a section's commands, prepared by one thread.
#[derive(Debug)]
struct Part {
    slice: Slice,
    edges: Mutex<Edges>,
}

/// What the bands read of a part.
#[derive(Debug)]
pub(super) struct Edges {
    chunk: Chunk,
    /// The bands' height that they were listed for.
    band_height: Option<u32>,
}

impl Section {
    /// A section of a recording for `frame`; its edges will use the memory of `spare` chunks.
    pub(super) fn new(list: DisplayList, frame: IntRect, spare: &mut VecDeque<Chunk>) -> Self {
        let count = (list.work() / WORK).clamp(1, MOST_PARTS);
        let parts = slices(&list, count).into_iter().map(|slice| {
            let chunk = spare.pop_front().unwrap_or_default();
            Part { slice, edges: Mutex::new(Edges { chunk, band_height: None }) }
        });
        let parts = parts.collect();
        Self { list, frame, parts }
    }

    pub(super) fn list(&self) -> &DisplayList {
        &self.list
    }

    /// How many parts it has.
    pub(super) fn parts(&self) -> usize {
        self.parts.len()
    }

    /// Lists the edges of all parts that no thread has begun, and says whether there was any. `settings` are resolved.
    pub(super) fn prepare(&self, settings: RenderSettings) -> bool {
        (0..self.parts.len()).filter(|part| self.prepare_part(*part, settings)).count() > 0
    }

    /// Lists the edges of a part, unless that is done or another thread is at it, and says whether it did.
    pub(super) fn prepare_part(&self, part: usize, settings: RenderSettings) -> bool {
        let Some(part) = self.parts.get(part) else { return false };
        part.edges.try_lock().is_ok_and(|mut edges| self.list_edges(&mut edges, part, settings))
    }

    /// The edges of each part, as soon as they are listed.
    pub(super) fn edges(&self, settings: RenderSettings) -> impl Iterator<Item = MutexGuard<'_, Edges>> {
        self.parts.iter().map(move |part| {
            let mut edges = part.edges.lock().unwrap_or_else(PoisonError::into_inner);
            self.list_edges(&mut edges, part, settings);
            edges
        })
    }

    /// Lists the edges of a part for the bands of `settings`, if they are not.
    fn list_edges(&self, edges: &mut Edges, part: &Part, settings: RenderSettings) -> bool {
        if edges.band_height == Some(settings.band_height) {
            return false;
        }
        // Only effects are planned.
        edges.chunk.prepare(&self.list, &Plan::default(), &part.slice, self.frame, settings);
        edges.band_height = Some(settings.band_height);
        true
    }

    /// The memory of a section that nobody needs any more: its list, emptied, and its chunks. `None` where a thread still looks at it.
    pub(super) fn into_memory(self: Arc<Self>) -> Option<(DisplayList, impl Iterator<Item = Chunk>)> {
        let Self { mut list, parts, .. } = Arc::into_inner(self)?;
        list.clear();
        let edges = parts.into_iter().map(|part| part.edges.into_inner().unwrap_or_else(PoisonError::into_inner));
        Some((list, edges.map(|edges| edges.chunk)))
    }
}

impl Edges {
    pub(super) fn chunk(&self) -> &Chunk {
        &self.chunk
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::display_list::{ClipId, Command, Draw, Geometry, PaintRef};
    use crate::style::Antialias;

    /// One rectangle over rows 3 to 40.
    const FRAME: IntRect = IntRect { left: 0, top: 0, right: 64, bottom: 64 };

    fn section() -> Section {
        let mut list = DisplayList::default();
        let bounds = IntRect::from_ltrb(0, 3, 10, 40);
        list.commands.push(Command::Draw(Draw {
            geometry: Geometry::Bounds,
            paint: PaintRef::of_color([9, 9, 9, 255]),
            antialias: Antialias::Analytic,
            blend_mode: crate::BlendMode::SourceOver,
            clip: ClipId::NONE,
            bounds,
            opaque: true,
        }));
        Section::new(list, FRAME, &mut VecDeque::new())
    }

    /// How many items each band has, of each part.
    fn bands(section: &Section, settings: RenderSettings) -> Vec<Vec<usize>> {
        let count = |edges: MutexGuard<'_, Edges>| {
            (0..9).map_while(|band| edges.chunk().band(band)).map(|band| band.items.len()).collect()
        };
        section.edges(settings).map(count).collect()
    }

    #[test]
    fn edges_are_listed_once_for_each_height_of_bands() {
        let (section, settings) = (section(), RenderSettings::default());
        let (lower, higher) =
            (settings.with_band_height(16).resolved(FRAME), settings.with_band_height(32).resolved(FRAME));
        assert!(section.prepare(lower) && !section.prepare(lower));
        assert_eq!(bands(&section, lower), [[1, 1, 1, 0]]);
        assert_eq!(bands(&section, higher), [[1, 1]]);
        assert!(!section.prepare(higher));
    }

    #[test]
    fn what_another_thread_has_is_left_to_it() {
        let (section, settings) = (Arc::new(section()), RenderSettings::default().resolved(FRAME));
        let held = section.parts[0].edges.lock().unwrap();
        assert!(!section.prepare(settings));
        drop(held);
        let other = Arc::clone(&section);
        assert!(section.into_memory().is_none());
        assert!(other.prepare(settings));
        let (list, _) = other.into_memory().unwrap();
        assert!(list.commands.is_empty() && list.commands.capacity() > 0);
    }
}
