//! What save and restore keep: the transform, the clip and the shadow.

use std::ops::{Deref, DerefMut};

use super::Canvas;
use crate::blend::BlendMode;
use crate::color::Color;
use crate::display_list::{ClipId, Command, DisplayList, Effect, EffectKind, LayerStart};
use crate::filter::PlacedFilter;
use crate::geom::{IntRect, Transform};

/// A shadow that shapes cast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shadow {
    /// How far to the right it falls, in device pixels, rounded to whole ones.
    pub offset_x: f32,
    /// How far down it falls, in device pixels, rounded to whole ones.
    pub offset_y: f32,
    /// The standard deviation of its Gaussian blur, in device pixels (half of an HTML canvas's
    /// `shadowBlur`); at most 1,000. 0 is sharp.
    pub deviation: f32,
    /// Its colour, whose alpha is multiplied by the shape's.
    pub color: Color,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct State {
    /// From user space to device pixels.
    pub(super) transform: Transform,
    /// From device pixels to those of the recording, if they differ: where it is for an effect's own picture.
    to_list: Option<Transform>,
    pub(super) clip: ClipId,
    /// The recording's pixels that the clip can let through.
    pub(super) bounds: IntRect,
    pub(super) shadow: Option<Shadow>,
}

impl Default for State {
    fn default() -> Self {
        Self { transform: Transform::IDENTITY, to_list: None, clip: ClipId::NONE, bounds: IntRect::EMPTY, shadow: None }
    }
}

impl State {
    /// From user space to the recording's pixels.
    #[inline(always)]
    pub(super) fn to_pixels(self) -> Transform {
        match self.to_list {
            None => self.transform,
            Some(to_list) => self.through(to_list),
        }
    }

    /// The same by way of the device, for an effect's own picture.
    #[cold]
    fn through(&self, to_list: Transform) -> Transform {
        let mut all = to_list.pre_concat(self.transform);
        // Turned there and back again, what is left of a turn is rounding.
        let least = (all.sx.abs() + all.sy.abs()) * 1e-6;
        if all.kx.abs() < least && all.ky.abs() < least {
            (all.kx, all.ky) = (0.0, 0.0);
        }
        all
    }

    /// How far the recording's pixels lie from the device's, where no effect turns them.
    pub(super) fn origin(&self) -> (i32, i32) {
        self.to_list.map_or((0, 0), |to_list| (to_list.tx as i32, to_list.ty as i32))
    }

    /// Moves, scales and turns the recording's pixels.
    pub(super) fn move_list(&mut self, then: Transform) {
        let moved = self.to_list.unwrap_or(Transform::IDENTITY).post_concat(then);
        self.to_list = (!moved.is_identity()).then_some(moved);
    }
}

/// Saved states. Equal ones on top of each other are counted: a million saves in a row cost nothing.
#[derive(Debug, Default)]
pub(super) struct Saves {
    stack: Vec<(State, u64)>,
}

impl Saves {
    fn push(&mut self, state: State) {
        match self.stack.last_mut() {
            Some((top, count)) if *top == state => *count += 1,
            _ => self.stack.push((state, 1)),
        }
    }

    fn pop(&mut self) -> Option<State> {
        let (state, count) = self.stack.last_mut()?;
        let state = *state;
        *count -= 1;
        if *count == 0 {
            self.stack.pop();
        }
        Some(state)
    }

    /// The saved states.
    pub(super) fn states(&self) -> impl Iterator<Item = &State> {
        self.stack.iter().map(|(state, _)| state)
    }

    /// The saved states, to change.
    pub(super) fn states_mut(&mut self) -> impl Iterator<Item = &mut State> {
        self.stack.iter_mut().map(|(state, _)| state)
    }
}

/// A layer that is being drawn.
#[derive(Debug)]
pub(super) struct OpenLayer {
    /// The state to return to.
    pub(super) outer: State,
    /// The saves made before it; a restore inside the layer does not reach them.
    pub(super) outer_saves: Saves,
    pub(super) kind: OpenLayerKind,
}

#[derive(Debug)]
pub(super) enum OpenLayerKind {
    Layer(LayerStart),
    Mask(IntRect, crate::surface::MaskKind),
    Filter(Box<FilterLayer>),
}

/// A layer that becomes a picture of its own.
#[derive(Debug)]
pub(super) struct FilterLayer {
    /// The recording around it.
    pub(super) outer_list: DisplayList,
    pub(super) filter: PlacedFilter,
    /// From the filter's pixels to those of the recording around it.
    pub(super) to_outer: Transform,
    /// The filter's pixels that the layer holds.
    pub(super) extent: IntRect,
    /// The pixels of the layer's recording outside of which nothing is computed, in layers inside it either.
    pub(super) limit: IntRect,
    /// The pixels of the layer's recording of which pictures can be made: all, unless these would be too many.
    pub(super) near: IntRect,
    /// How many pixels one of them may have.
    pub(super) most: u64,
    pub(super) opacity: f32,
    pub(super) blend_mode: BlendMode,
    pub(super) clip: ClipId,
    /// The outer recording's pixels that it may touch.
    pub(super) bounds: IntRect,
}

impl FilterLayer {
    /// The effect that draws what `list` recorded.
    fn effect(&self, mut list: DisplayList) -> Effect {
        if list.commands.iter().any(|command| matches!(command, Command::EndMask(..))) {
            // A mask applies to a layer, which the filter's own surface is not.
            let layer = LayerStart::plain(IntRect::from_xywh(0, 0, self.extent.width(), self.extent.height()));
            list.commands.insert(0, Command::BeginLayer(layer.clone()));
            list.commands.push(Command::EndLayer(layer));
        }
        Effect {
            list,
            extent: self.extent,
            kind: EffectKind::Filter { filter: self.filter.clone(), to_device: self.to_outer, opacity: self.opacity },
            blend_mode: self.blend_mode,
            clip: self.clip,
            bounds: self.bounds,
        }
    }
}

impl OpenLayerKind {
    /// Ends it in a recording: `list` is the one around it then.
    pub(super) fn end(self, list: &mut DisplayList) {
        match self {
            Self::Layer(layer) => list.commands.push(Command::EndLayer(layer)),
            Self::Mask(bounds, kind) => list.commands.push(Command::EndMask(bounds, kind)),
            Self::Filter(mut layer) => {
                let outer = std::mem::take(&mut layer.outer_list);
                let inner = std::mem::replace(list, outer);
                if !layer.bounds.is_empty() {
                    list.add_effect(layer.effect(inner));
                }
            }
        }
    }

    /// As [`end`](Self::end), of a copy.
    pub(super) fn end_copy(&self, list: &mut DisplayList) {
        match self {
            Self::Layer(layer) => list.commands.push(Command::EndLayer(layer.clone())),
            Self::Mask(bounds, kind) => list.commands.push(Command::EndMask(*bounds, *kind)),
            Self::Filter(layer) => {
                let inner = std::mem::replace(list, layer.outer_list.clone());
                if !layer.bounds.is_empty() {
                    list.add_effect(layer.effect(inner));
                }
            }
        }
    }

    /// The recording's pixels that it holds.
    pub(super) fn bounds(&self) -> IntRect {
        match self {
            Self::Layer(layer) => layer.bounds,
            Self::Mask(bounds, _) => *bounds,
            Self::Filter(layer) => IntRect::from_xywh(0, 0, layer.extent.width(), layer.extent.height()),
        }
    }
}

impl<'a> Canvas<'a> {
    /// Saves the transform, the clip and the shadow.
    pub fn save(&mut self) {
        self.saves.push(self.state);
    }

    /// Goes back to the state at the last [`save`](Self::save) that was not restored yet. Without one, or with the last
    /// one outside the open layer, nothing happens.
    pub fn restore(&mut self) {
        if let Some(state) = self.saves.pop() {
            self.state = state;
        }
    }

    /// Saves the state until the guard is dropped; draw through the guard.
    ///
    /// ```
    /// # use rastrum::{Canvas, Color, Rect};
    /// # let mut canvas = Canvas::new(32, 32)?;
    /// {
    ///     let mut canvas = canvas.saved();
    ///     canvas.translate(16.0, 16.0);
    ///     canvas.fill_rect(Rect::from_xywh(-4.0, -4.0, 8.0, 8.0), Color::BLUE);
    /// }
    /// assert!(canvas.current_transform().is_identity());
    /// # Ok::<(), rastrum::Error>(())
    /// ```
    pub fn saved(&mut self) -> SaveGuard<'_, 'a> {
        self.save();
        SaveGuard { canvas: self }
    }

    /// Moves the origin.
    pub fn translate(&mut self, x: f32, y: f32) {
        self.transform(Transform::from_translate(x, y));
    }

    /// Scales what is drawn from here on about the origin.
    pub fn scale(&mut self, x: f32, y: f32) {
        self.transform(Transform::from_scale(x, y));
    }

    /// Rotates what is drawn from here on about the origin, clockwise, in degrees.
    pub fn rotate(&mut self, degrees: f32) {
        self.transform(Transform::from_rotate(degrees));
    }

    /// Applies `transform` to what is drawn from here on, before the current transform.
    pub fn transform(&mut self, transform: Transform) {
        self.state.transform = self.state.transform.pre_concat(transform);
    }

    /// Replaces the transform from user space to device pixels.
    pub fn set_transform(&mut self, transform: Transform) {
        // Mostly it is the one that is set. What was just written in parts is slow to be read in others.
        if self.state.transform != transform {
            self.state.transform = transform;
        }
    }

    /// The transform from user space to device pixels.
    pub fn current_transform(&self) -> Transform {
        self.state.transform
    }

    /// The device pixels that the current clip can let through.
    pub fn clip_bounds(&self) -> IntRect {
        let Some(to_list) = self.state.to_list else { return self.state.bounds };
        let back = to_list.invert().and_then(|back| back.map_rect(self.state.bounds.to_rect()));
        back.map_or(IntRect::EMPTY, |bounds| bounds.round_out())
    }

    /// Lets what is drawn from here on cast a shadow, or none.
    pub fn set_shadow(&mut self, shadow: impl Into<Option<Shadow>>) {
        self.state.shadow = shadow.into();
    }
}

/// A saved state of a canvas, restored when the guard is dropped.
#[derive(Debug)]
pub struct SaveGuard<'c, 'a> {
    canvas: &'c mut Canvas<'a>,
}

impl<'a> Deref for SaveGuard<'_, 'a> {
    type Target = Canvas<'a>;
    fn deref(&self) -> &Self::Target {
        self.canvas
    }
}

impl DerefMut for SaveGuard<'_, '_> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        self.canvas
    }
}

impl Drop for SaveGuard<'_, '_> {
    fn drop(&mut self) {
        self.canvas.restore();
    }
}
