//! What save and restore keep: the transform, the clip and the shadow.

use std::ops::{Deref, DerefMut};

use super::Canvas;
use crate::color::Color;
use crate::display_list::{ClipId, Command, LayerStart};
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
    pub(super) transform: Transform,
    pub(super) clip: ClipId,
    /// The device pixels that the clip can let through.
    pub(super) bounds: IntRect,
    pub(super) shadow: Option<Shadow>,
}

impl Default for State {
    fn default() -> Self {
        Self { transform: Transform::IDENTITY, clip: ClipId::NONE, bounds: IntRect::EMPTY, shadow: None }
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
}

impl OpenLayerKind {
    /// The command that ends it.
    pub(super) fn end(&self) -> Command {
        match self {
            Self::Layer(layer) => Command::EndLayer(layer.clone()),
            Self::Mask(bounds, kind) => Command::EndMask(*bounds, *kind),
        }
    }

    /// The device pixels that it holds.
    pub(super) fn bounds(&self) -> IntRect {
        match self {
            Self::Layer(layer) => layer.bounds,
            Self::Mask(bounds, _) => *bounds,
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
        self.state.transform = transform;
    }

    /// The transform from user space to device pixels.
    pub fn current_transform(&self) -> Transform {
        self.state.transform
    }

    /// The device pixels that the current clip can let through.
    pub fn clip_bounds(&self) -> IntRect {
        self.state.bounds
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
