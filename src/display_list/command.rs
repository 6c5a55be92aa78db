//! Commands and the arenas that hold their data.

use std::borrow::Cow;
use std::sync::Arc;

use crate::blend::BlendMode;
use crate::color::Color;
use crate::filter::PlacedFilter;
use crate::geom::{FixedRect, IntRect, Point, Transform};
use crate::paint::PreparedPaint;
use crate::path::{Outline, Path, Stroke, Verb};
use crate::style::{Antialias, FillRule};
use crate::surface::{Mask, MaskKind};

/// A run of pixels in one row: y, and columns start ≤ x < end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Span {
    pub(crate) y: i32,
    pub(crate) start: i32,
    pub(crate) end: i32,
}

/// Where a recording has an outline: a range of [`DisplayList::verbs`] and one of [`DisplayList::points`], or one of
/// [`DisplayList::outlines`], which then the points' start indexes. As an `enum` it made recording 5,000 circles half as long
/// again, presumably since what is written in parts and then read at once has to wait.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutlineRef {
    verbs: (u32, u32),
    points: (u32, u32),
}

impl OutlineRef {
    /// The verbs of a shared one: no range starts where the numbers end.
    const SHARED: (u32, u32) = (u32::MAX, u32::MAX);

    /// Which of the recording's shared outlines it is, if it is one.
    #[inline(always)]
    fn shared(self) -> Option<usize> {
        (self.verbs == Self::SHARED).then_some(self.points.0 as usize)
    }
}

/// How a draw's pixels look: in one colour, as most do, or by one of [`DisplayList::paints`]. No `enum`, for the reason that
/// [`OutlineRef`] is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PaintRef {
    value: [u8; 4],
    is_listed: bool,
}

impl PaintRef {
    /// The premultiplied pixel `color` everywhere, a transparent one included.
    #[inline(always)]
    pub(crate) fn of_color(color: [u8; 4]) -> Self {
        Self { value: color, is_listed: false }
    }

    /// The paint of that place in the list.
    #[inline(always)]
    pub(crate) fn of_index(index: u32) -> Self {
        Self { value: index.to_ne_bytes(), is_listed: true }
    }

    /// The colour, if it is one.
    #[inline(always)]
    pub(crate) fn color(self) -> Option<[u8; 4]> {
        (!self.is_listed).then_some(self.value)
    }

    /// The place in the list, if it has one.
    #[inline(always)]
    pub(crate) fn index(self) -> Option<u32> {
        self.is_listed.then_some(u32::from_ne_bytes(self.value))
    }
}

/// What a draw covers.
#[derive(Clone, Debug)]
pub(crate) enum Geometry {
    /// The inside of an outline.
    Fill {
        outline: OutlineRef,
        /// From its space to device pixels: indexes [`DisplayList::transforms`].
        transform: u32,
        rule: FillRule,
    },
    /// The stroke of an outline; `style` indexes [`DisplayList::strokes`].
    Stroke { outline: OutlineRef, transform: u32, style: u32 },
    /// An axis-aligned rectangle in device space.
    Rect(FixedRect),
    /// Whole pixels: a range of [`DisplayList::spans`].
    Spans((u32, u32)),
    /// All pixels within the draw's bounds.
    Bounds,
}

/// Names a clip; [`ClipId::NONE`] clips to the bounds alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ClipId(pub(crate) u32);

impl ClipId {
    pub(crate) const NONE: Self = Self(u32::MAX);
}

/// What a clip lets through.
#[derive(Clone, Debug)]
pub(crate) enum ClipKind {
    /// What a draw of the geometry would cover.
    Geometry { geometry: Geometry, antialias: Antialias },
    /// A mask whose top left lies at a device pixel; nothing outside it.
    Mask { mask: Arc<Mask>, x: i32, y: i32 },
}

/// A clip, on top of another.
#[derive(Clone, Debug)]
pub(crate) struct ClipNode {
    pub(crate) parent: ClipId,
    pub(crate) kind: ClipKind,
    /// The device pixels that it and its parents can let through.
    pub(crate) bounds: IntRect,
}

impl ClipNode {
    /// Whether it leaves all of these pixels as they are, its parents aside: asked without a look at coverage.
    pub(crate) fn leaves_whole(&self, pixels: IntRect) -> bool {
        matches!(&self.kind, ClipKind::Geometry { geometry: Geometry::Rect(rect), .. }
            if rect.whole_pixels().contains(pixels))
    }
}

/// One shape.
#[derive(Clone, Debug)]
pub(crate) struct Draw {
    pub(crate) geometry: Geometry,
    pub(crate) paint: PaintRef,
    pub(crate) antialias: Antialias,
    pub(crate) blend_mode: BlendMode,
    pub(crate) clip: ClipId,
    /// The device pixels that it may touch: the clip's bounds.
    pub(crate) bounds: IntRect,
    /// Whether its paint is opaque.
    pub(crate) opaque: bool,
}

/// The start of a layer.
#[derive(Clone, Debug)]
pub(crate) struct LayerStart {
    /// The device pixels that it holds.
    pub(crate) bounds: IntRect,
    pub(crate) opacity: u8,
    pub(crate) blend_mode: BlendMode,
    /// What clips the layer as a whole, when it is drawn.
    pub(crate) clip: ClipId,
}

impl LayerStart {
    /// One that is drawn as it is.
    pub(crate) fn plain(bounds: IntRect) -> Self {
        Self { bounds, opacity: 255, blend_mode: BlendMode::SourceOver, clip: ClipId::NONE }
    }
}

/// A picture made of what a recording of its own draws, by an effect that needs it whole.
#[derive(Clone, Debug)]
pub(crate) struct Effect {
    /// What it applies to, moved so that `extent` starts at (0, 0).
    pub(crate) list: DisplayList,
    /// The pixels of what it applies to: the device's, or the filter's own.
    pub(crate) extent: IntRect,
    pub(crate) kind: EffectKind,
    pub(crate) blend_mode: BlendMode,
    pub(crate) clip: ClipId,
    /// The device pixels that it may touch.
    pub(crate) bounds: IntRect,
}

/// What becomes of the picture.
#[derive(Clone, Debug)]
pub(crate) enum EffectKind {
    /// A blurred, tinted, moved copy of its alpha.
    Shadow {
        /// In device pixels.
        offset: (i32, i32),
        /// The Gaussian's standard deviation, in device pixels.
        deviation: f32,
        color: Color,
    },
    /// What a filter makes of it.
    Filter {
        filter: PlacedFilter,
        /// From the filter's pixels to the device's.
        to_device: Transform,
        opacity: f32,
    },
}

/// One step of a recording.
#[derive(Clone, Debug)]
pub(crate) enum Command {
    Draw(Draw),
    /// Makes the clip known to the bands; its coverage is computed where a draw uses it.
    Clip(ClipId),
    BeginLayer(LayerStart),
    EndLayer(LayerStart),
    /// What follows becomes a mask for the layer below.
    BeginMask(IntRect),
    EndMask(IntRect, MaskKind),
    /// Far larger than the others and rare: they stay small.
    Effect(Box<Effect>),
}

/// A recording.
#[derive(Clone, Debug, Default)]
pub(crate) struct DisplayList {
    pub(crate) commands: Vec<Command>,
    pub(crate) verbs: Vec<Verb>,
    pub(crate) points: Vec<Point>,
    /// Outlines of paths that are drawn again and again. From `shared` on they are the last recording's: most likely this one
    /// names the same, which then is seen without touching them.
    outlines: Vec<Arc<Outline>>,
    shared: usize,
    /// How many points they have.
    shared_points: usize,
    pub(crate) spans: Vec<Span>,
    pub(crate) strokes: Vec<Stroke>,
    pub(crate) transforms: Vec<Transform>,
    pub(crate) paints: Vec<PreparedPaint>,
    pub(crate) clips: Vec<ClipNode>,
    has_effects: bool,
    /// The long ones among the strokes.
    long_strokes: Vec<LongStroke>,
}

/// A stroke that is worth the work of several threads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LongStroke {
    /// Which command it is, if it was not dropped for a reason of its own: that names the style, too.
    pub(crate) command: u32,
    pub(crate) style: u32,
    /// How many stretches it has.
    pub(crate) stretches: usize,
}

impl DisplayList {
    /// Removes everything and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.commands.clear();
        self.verbs.clear();
        self.points.clear();
        self.outlines.truncate(self.shared);
        self.shared = 0;
        self.shared_points = 0;
        self.spans.clear();
        self.strokes.clear();
        self.transforms.clear();
        self.paints.clear();
        self.clips.clear();
        self.has_effects = false;
        self.long_strokes.clear();
    }

    /// Stores how a path is stroked that the next command will draw.
    pub(crate) fn add_stroke(&mut self, stroke: &Stroke, stretches: usize) -> u32 {
        let style = self.strokes.len() as u32;
        self.strokes.push(stroke.clone());
        if stretches > 1 {
            self.long_strokes.push(LongStroke { command: self.commands.len() as u32, style, stretches });
        }
        style
    }

    /// The strokes that have several stretches, by command.
    pub(crate) fn long_strokes(&self) -> impl Iterator<Item = LongStroke> {
        // What is sampled is not a sum of areas, and `Exact` has to know where any edges cross.
        self.long_strokes.iter().copied().filter(|long| {
            let command = self.commands.get(long.command as usize);
            matches!(command, Some(Command::Draw(Draw { geometry: Geometry::Stroke { style, .. }, antialias: Antialias::Analytic, .. }))
                if *style == long.style)
        })
    }

    /// Adds an effect as a command.
    pub(crate) fn add_effect(&mut self, effect: Effect) {
        self.commands.push(Command::Effect(Box::new(effect)));
        self.has_effects = true;
    }

    /// How much work it is to prepare it, to a guess: as much as so many points.
    pub(crate) fn work(&self) -> usize {
        2 * self.commands.len() + self.points.len() + self.shared_points
    }

    /// Whether there was an effect among the commands.
    pub(crate) fn has_effects(&self) -> bool {
        self.has_effects
    }

    /// Stores the outline of a path, or shares it.
    pub(crate) fn add_path(&mut self, path: &Path) -> OutlineRef {
        match path.shared_outline() {
            Some(outline) => self.share_outline(outline, path.points().len()),
            None => self.copy_outline(path.verbs(), path.points()),
        }
    }

    /// Stores an outline that another recording has.
    pub(crate) fn add_outline_of(&mut self, other: &Self, outline: OutlineRef) -> OutlineRef {
        match outline.shared().and_then(|index| other.outlines.get(index)) {
            Some(outline) => self.share_outline(outline, outline.parts().1.len()),
            None => {
                let (verbs, points) = other.outline(outline);
                self.copy_outline(verbs, points)
            }
        }
    }

    fn share_outline(&mut self, outline: &Arc<Outline>, points: usize) -> OutlineRef {
        let index = self.shared;
        self.shared_points += points;
        match self.outlines.get_mut(index) {
            Some(last) if Arc::ptr_eq(last, outline) => {}
            Some(last) => *last = Arc::clone(outline),
            None => self.outlines.push(Arc::clone(outline)),
        }
        self.shared += 1;
        OutlineRef { verbs: OutlineRef::SHARED, points: (index as u32, 0) }
    }

    /// Beyond 2^32 verbs or points, an empty outline.
    fn copy_outline(&mut self, verbs: &[Verb], points: &[Point]) -> OutlineRef {
        let ends = (self.verbs.len() + verbs.len(), self.points.len() + points.len());
        if u32::try_from(ends.0).is_err() || u32::try_from(ends.1).is_err() {
            return OutlineRef { verbs: (0, 0), points: (0, 0) };
        }
        let starts = (self.verbs.len() as u32, self.points.len() as u32);
        self.verbs.extend_from_slice(verbs);
        self.points.extend_from_slice(points);
        OutlineRef { verbs: (starts.0, ends.0 as u32), points: (starts.1, ends.1 as u32) }
    }

    /// Stores a transform. Shapes in a row mostly share theirs, so that commands only name it.
    pub(crate) fn add_transform(&mut self, transform: Transform) -> u32 {
        if self.transforms.last() != Some(&transform) {
            self.transforms.push(transform);
        }
        self.transforms.len() as u32 - 1
    }

    /// The transform of a geometry.
    pub(crate) fn transform(&self, index: u32) -> Transform {
        self.transforms.get(index as usize).copied().unwrap_or(Transform::IDENTITY)
    }

    /// How a draw's pixels look.
    #[inline(always)]
    pub(crate) fn paint(&self, paint: PaintRef) -> Option<Cow<'_, PreparedPaint>> {
        match paint.color() {
            Some(color) => Some(Cow::Owned(PreparedPaint::Solid(color))),
            None => self.paints.get(paint.index()? as usize).map(Cow::Borrowed),
        }
    }

    /// The clip with the given name; `None` for [`ClipId::NONE`].
    pub(crate) fn clip(&self, id: ClipId) -> Option<&ClipNode> {
        self.clips.get(id.0 as usize)
    }

    /// The verbs and points of an outline.
    pub(crate) fn outline(&self, outline: OutlineRef) -> (&[Verb], &[Point]) {
        if let Some(index) = outline.shared() {
            return self.outlines.get(index).map_or((&[], &[]), |outline| outline.parts());
        }
        let OutlineRef { verbs, points } = outline;
        (
            self.verbs.get(verbs.0 as usize..verbs.1 as usize).unwrap_or(&[]),
            self.points.get(points.0 as usize..points.1 as usize).unwrap_or(&[]),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_small() {
        // They are read anew for every band: at most a cache line each.
        let size = size_of::<Command>();
        assert!(size <= 64, "{size} bytes");
    }
}
