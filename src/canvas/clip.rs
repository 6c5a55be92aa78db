//! Clips, layers and masks.

use std::sync::Arc;

use super::Canvas;
use super::state::{OpenLayer, OpenLayerKind};
use crate::blend::BlendMode;
use crate::color::unit;
use crate::display_list::{ClipId, ClipKind, ClipNode, Command, DisplayList, Geometry, LayerStart};
use crate::filter::pixels;
use crate::geom::{IntRect, Rect};
use crate::path::Path;
use crate::style::{Antialias, FillRule};
use crate::surface::{Mask, MaskKind};

impl Canvas<'_> {
    /// Clips what is drawn from here on to the inside of `path`, within the current clip.
    pub fn clip_path(&mut self, path: &Path, rule: FillRule, antialias: Antialias) {
        match self.record_fill(path, rule) {
            Some((geometry, bounds)) => self.push_clip(ClipKind::Geometry { geometry, antialias }, bounds),
            None => self.state.bounds = IntRect::EMPTY,
        }
    }

    /// Clips what is drawn from here on to `rect`, within the current clip.
    pub fn clip_rect(&mut self, rect: Rect, antialias: Antialias) {
        let transform = self.state.to_pixels();
        if transform.is_scale_translate()
            && let Some(device) = transform.map_rect(rect)
        {
            // An edge that lies on pixel boundaries, or is rounded to them, needs no coverage.
            let device = match antialias {
                // A pixel belongs to the rectangle by its centre.
                Antialias::None => {
                    let snap = |v: f32| (v - 0.5).ceil();
                    Rect::from_ltrb(snap(device.left), snap(device.top), snap(device.right), snap(device.bottom))
                }
                _ => device,
            };
            let whole = device.round_out();
            if whole.to_rect() == device {
                self.state.bounds = self.state.bounds.intersect(whole);
                return;
            }
        }
        let mut path = Path::new();
        path.rect(rect);
        self.clip_path(&path, FillRule::NonZero, antialias);
    }

    /// Multiplies what is drawn from here on by a mask whose top left corner lies at device pixel (x, y), within
    /// the current clip. Nothing is drawn outside the mask.
    pub fn clip_mask(&mut self, mask: impl Into<Arc<Mask>>, x: i32, y: i32) {
        let mask = mask.into();
        let (dx, dy) = self.state.origin();
        let (x, y) = (x.saturating_add(dx), y.saturating_add(dy));
        let bounds = IntRect::from_xywh(x, y, mask.width(), mask.height());
        self.push_clip(ClipKind::Mask { mask, x, y }, bounds);
    }

    fn push_clip(&mut self, kind: ClipKind, bounds: IntRect) {
        let bounds = self.state.bounds.intersect(bounds);
        self.state.bounds = bounds;
        if bounds.is_empty() {
            return;
        }
        let id = ClipId(self.list.clips.len() as u32);
        self.list.clips.push(ClipNode { parent: self.state.clip, kind, bounds });
        self.list.commands.push(Command::Clip(id));
        self.state.clip = id;
    }

    /// Starts a layer: what is drawn up to [`pop_layer`](Self::pop_layer) becomes one picture, which is then drawn with
    /// `opacity` (0 ..= 1), `blend_mode` and the current clip. The transform goes on; the state is saved. Layers may
    /// nest to any depth; those with pixels of their own take memory for the bands in work.
    pub fn push_layer(&mut self, opacity: f32, blend_mode: BlendMode) {
        let layer = LayerStart {
            bounds: self.state.bounds,
            opacity: (unit(opacity) * 255.0 + 0.5) as u8,
            blend_mode,
            clip: self.state.clip,
        };
        self.list.commands.push(Command::BeginLayer(layer.clone()));
        self.open_layer(OpenLayerKind::Layer(layer));
        // The clip is applied once, to the finished layer.
        self.state.clip = ClipId::NONE;
        self.state.shadow = None;
    }

    /// Ends the layer that the last [`push_layer`](Self::push_layer) or [`push_layer_with`](Self::push_layer_with) started and
    /// draws it; the state is the one before it. Without a layer, or with a mask open inside it, nothing happens.
    pub fn pop_layer(&mut self) {
        let kind = self.layers.last().map(|layer| &layer.kind);
        if matches!(kind, Some(OpenLayerKind::Layer(_) | OpenLayerKind::Filter(_))) {
            self.close_layer();
        }
    }

    /// Starts a mask for the open layer: what is drawn up to [`pop_mask`](Self::pop_mask) is not shown, but multiplies the
    /// layer as drawn so far by its alpha or luminance. Where nothing is drawn the layer is cleared. Without
    /// an open layer there is nothing to mask, and what is drawn up to [`pop_mask`](Self::pop_mask) is dropped.
    pub fn push_mask(&mut self, kind: MaskKind) {
        let bounds = self.layers.last().map_or(self.state.bounds, |layer| layer.kind.bounds());
        self.list.commands.push(Command::BeginMask(bounds));
        self.open_layer(OpenLayerKind::Mask(bounds, kind));
        self.state.bounds = bounds;
        self.state.clip = ClipId::NONE;
        self.state.shadow = None;
    }

    /// Ends the mask that the last [`push_mask`](Self::push_mask) started. Without one nothing happens.
    pub fn pop_mask(&mut self) {
        if matches!(self.layers.last(), Some(OpenLayer { kind: OpenLayerKind::Mask(..), .. })) {
            self.close_layer();
        }
    }

    pub(super) fn open_layer(&mut self, kind: OpenLayerKind) {
        let outer_saves = std::mem::take(&mut self.saves);
        self.layers.push(OpenLayer { outer: self.state, outer_saves, kind });
    }

    /// Ends the innermost layer or mask.
    pub(super) fn close_layer(&mut self) {
        let Some(OpenLayer { outer, outer_saves, kind }) = self.layers.pop() else { return };
        self.state = outer;
        self.saves = outer_saves;
        let size = match &kind {
            OpenLayerKind::Filter(layer) => pixels(layer.bounds) * 4,
            _ => 0,
        };
        kind.end(&mut self.list);
        self.count_pictures(size);
    }

    /// Whether a state names a clip.
    pub(super) fn is_clipped(&self) -> bool {
        std::iter::once(&self.state).chain(self.saves.states()).any(|state| state.clip != ClipId::NONE)
    }

    /// Carries the clips that states still name over from a rendered recording to the new one.
    pub(super) fn carry_clips(&mut self, old: &DisplayList) {
        let mut kept: Vec<u32> = Vec::new();
        for state in std::iter::once(&mut self.state).chain(self.saves.states_mut()) {
            let mut id = state.clip;
            while let Some(node) = old.clip(id) {
                kept.push(id.0);
                id = node.parent;
            }
        }
        kept.sort_unstable();
        kept.dedup();
        let renamed = |id: ClipId| kept.binary_search(&id.0).map_or(ClipId::NONE, |index| ClipId(index as u32));
        for id in &kept {
            let Some(node) = old.clip(ClipId(*id)) else { continue };
            let mut node = node.clone();
            node.parent = renamed(node.parent);
            if let ClipKind::Geometry { geometry: Geometry::Fill { outline, transform, .. }, .. } = &mut node.kind {
                *outline = self.list.add_outline_of(old, *outline);
                *transform = self.list.add_transform(old.transform(*transform));
            }
            self.list.commands.push(Command::Clip(ClipId(self.list.clips.len() as u32)));
            self.list.clips.push(node);
        }
        for state in std::iter::once(&mut self.state).chain(self.saves.states_mut()) {
            state.clip = renamed(state.clip);
        }
    }
}
