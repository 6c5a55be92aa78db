//! The walk over a tree.
//!
//! What is still to do lies on a stack of its own, not on the thread's: the depth of a tree is the
//! file's choice.

use super::image::Picture;
use super::pattern::Tile;
use super::shape::Effects;
use super::warning::{Warning, WarningKind, Warnings};
use super::{Settings, convert, group};
use crate::canvas::Canvas;
use crate::surface::MaskKind;

/// The most elements that one call draws. A million elements, the most that usvg parses, are shown
/// by a `use` or a pattern any number of times.
const MAX_ELEMENTS: u32 = 1 << 24;

/// The most layers and masks that one call draws: each costs a pass over its pixels. Ten masks of
/// ten masks of ten masks … would otherwise take for ever.
const MAX_LAYERS: u32 = 1 << 16;

/// How many patterns and filters' pictures may be drawn inside each other.
const MAX_CANVAS_DEPTH: u32 = 16;

/// The most pixels of all tiles, and of all embedded pictures, that one call keeps: 1 GiB.
const MAX_PIXELS: u64 = 1 << 28;

/// The most bytes that embedded pictures take, the one that is being decoded included: 1 GiB holds them and the rest.
const MAX_PICTURE_BYTES: u64 = 896 << 20;

/// What is to do next.
#[derive(Clone, Copy)]
pub(super) enum Step<'t> {
    /// Draw the group's children from this one on.
    Children(&'t usvg::Group, usize),
    /// Fill the outlines of a clip path's group, from this child on.
    Outlines(&'t usvg::Group, usize),
    /// Multiply the layer by a clip path.
    Clip(&'t usvg::ClipPath),
    /// Multiply the layer by a mask.
    Mask(&'t usvg::Mask),
    /// End what was begun.
    PopMask,
    PopLayer,
    Restore,
}

/// Draws trees and gathers what goes wrong.
pub(super) struct Renderer<'s> {
    pub(super) settings: &'s Settings,
    pub(super) warnings: Warnings,
    /// Patterns drawn so far: a pattern that fills a thousand shapes is drawn once.
    pub(super) tiles: Vec<Tile>,
    /// Embedded pictures decoded so far.
    pub(super) pictures: Vec<Picture>,
    /// How many canvases of patterns and filters' pictures are being drawn inside each other.
    canvas_depth: u32,
    elements: u32,
    layers: u32,
    pixels: u64,
}

impl<'s> Renderer<'s> {
    pub(super) fn new(settings: &'s Settings) -> Self {
        Self {
            settings,
            warnings: Warnings::default(),
            tiles: Vec::new(),
            pictures: Vec::new(),
            canvas_depth: 0,
            elements: 0,
            layers: 0,
            pixels: 0,
        }
    }

    pub(super) fn into_warnings(self) -> Vec<Warning> {
        self.warnings.into_vec()
    }

    /// Draws what is in a group, without its transform and effects.
    pub(super) fn draw_children(&mut self, group: &usvg::Group, canvas: &mut Canvas<'_>) {
        self.run(vec![Step::Children(group, 0)], canvas);
    }

    /// Draws one node.
    pub(super) fn draw_node(&mut self, node: &usvg::Node, canvas: &mut Canvas<'_>) {
        let mut steps = Vec::new();
        self.node(node, &mut steps, canvas);
        self.run(steps, canvas);
    }

    fn run<'t>(&mut self, mut steps: Vec<Step<'t>>, canvas: &mut Canvas<'_>) {
        while let Some(step) = steps.pop() {
            // Over the limit, what was begun is ended and nothing else begun.
            let ends = matches!(step, Step::PopMask | Step::PopLayer | Step::Restore);
            if !ends && (self.elements > MAX_ELEMENTS || self.layers > MAX_LAYERS) {
                continue;
            }
            match step {
                Step::Children(group, index) => {
                    if let Some(node) = group.children().get(index) {
                        steps.push(Step::Children(group, index + 1));
                        self.node(node, &mut steps, canvas);
                    }
                }
                Step::Outlines(group, index) => {
                    if let Some(node) = group.children().get(index) {
                        steps.push(Step::Outlines(group, index + 1));
                        if self.count_element() {
                            self.outline(node, &mut steps, canvas);
                        }
                    }
                }
                Step::Clip(clip) => {
                    steps.extend(clip.clip_path().map(Step::Clip));
                    if self.push_mask(MaskKind::Alpha, &mut steps, canvas) {
                        canvas.transform(convert::transform(clip.transform()));
                        steps.push(Step::Outlines(clip.root(), 0));
                    }
                }
                Step::Mask(mask) => {
                    steps.extend(mask.mask().map(Step::Mask));
                    if self.push_mask(convert::mask_kind(mask.kind()), &mut steps, canvas) {
                        group::clip_to_rect(convert::rect(mask.rect()), mask.root(), self, &mut steps, canvas);
                    }
                }
                Step::PopMask => canvas.pop_mask(),
                Step::PopLayer => canvas.pop_layer(),
                Step::Restore => canvas.restore(),
            }
        }
    }

    fn node<'t>(&mut self, node: &'t usvg::Node, steps: &mut Vec<Step<'t>>, canvas: &mut Canvas<'_>) {
        if !self.count_element() {
            return;
        }
        match node {
            usvg::Node::Group(child) => group::draw(child, self, steps, canvas),
            usvg::Node::Text(text) => group::draw(text.flattened(), self, steps, canvas),
            usvg::Node::Path(path) => self.draw_path(path, &Effects::default(), canvas),
            usvg::Node::Image(image) => self.draw_image(image, &Effects::default(), steps, canvas),
        }
    }

    /// Begins a mask for the current layer, with a saved state; the steps that end both are noted. False where
    /// the limit is reached, and then nothing has begun.
    fn push_mask(&mut self, kind: MaskKind, steps: &mut Vec<Step<'_>>, canvas: &mut Canvas<'_>) -> bool {
        if !self.count_layer() {
            return false;
        }
        canvas.push_mask(kind);
        canvas.save();
        steps.push(Step::PopMask);
        steps.push(Step::Restore);
        true
    }

    /// Whether one more canvas may be begun inside those that there are: unlike groups, each takes some of the
    /// thread's stack. If so, [`leave_canvas`](Self::leave_canvas) ends it.
    pub(super) fn enter_canvas(&mut self, id: &str) -> bool {
        if self.canvas_depth >= MAX_CANVAS_DEPTH {
            self.warnings.add(WarningKind::PatternDepth, id);
            return false;
        }
        let counts = self.count_layer();
        self.canvas_depth += u32::from(counts);
        counts
    }

    pub(super) fn leave_canvas(&mut self) {
        self.canvas_depth = self.canvas_depth.saturating_sub(1);
    }

    /// Whether one more element may be drawn.
    pub(super) fn count_element(&mut self) -> bool {
        self.elements = self.elements.saturating_add(1);
        if self.elements > MAX_ELEMENTS {
            self.warnings.add(WarningKind::TooComplex, "");
        }
        self.elements <= MAX_ELEMENTS
    }

    /// Whether one more layer may be drawn.
    pub(super) fn count_layer(&mut self) -> bool {
        self.layers = self.layers.saturating_add(1);
        if self.layers > MAX_LAYERS {
            self.warnings.add(WarningKind::TooComplex, "");
        }
        self.layers <= MAX_LAYERS
    }

    /// Whether a tile or picture of this size may be kept.
    pub(super) fn count_pixels(&mut self, width: u32, height: u32) -> bool {
        self.pixels = self.pixels.saturating_add(u64::from(width) * u64::from(height));
        self.pixels <= MAX_PIXELS
    }

    /// How many bytes the next embedded picture may take while it is decoded, beside those of the others.
    pub(super) fn bytes_to_decode(&self) -> u64 {
        MAX_PICTURE_BYTES.saturating_sub(4 * self.pixels)
    }
}
