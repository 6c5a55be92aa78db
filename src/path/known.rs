//! What is known of a path for as long as it does not change: a path is often drawn more than once.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use super::Verb;
use crate::geom::{Point, Rect};

/// Outlines of fewer points are copied faster than shared.
const FEWEST_POINTS: usize = 32;

/// The segments of a path as it was.
#[derive(Debug)]
pub(crate) struct Outline {
    verbs: Box<[Verb]>,
    points: Box<[Point]>,
}

impl Outline {
    /// The verbs, and the points of all of them.
    pub(crate) fn parts(&self) -> (&[Verb], &[Point]) {
        (&self.verbs, &self.points)
    }
}

/// It says nothing new of the path, and so does not count when paths are compared.
#[derive(Debug, Default)]
pub(super) struct Known {
    /// The bounds of the points, once somebody asked.
    bounds: OnceLock<Option<Rect>>,
    /// Whether the path was drawn.
    drawn: AtomicBool,
    /// A copy that recordings share.
    outline: OnceLock<Arc<Outline>>,
}

impl Known {
    /// To be called wherever the path changes.
    #[inline(always)]
    pub(super) fn forget(&mut self) {
        if self.bounds.get().is_some() || *self.drawn.get_mut() {
            *self = Self::default();
        }
    }

    /// The bounding box of `points`, which are the path's.
    pub(super) fn bounds(&self, points: &[Point]) -> Option<Rect> {
        *self.bounds.get_or_init(|| Rect::from_points(points))
    }

    /// The path's outline for a recording to share, from the second drawing on: what is drawn once is not worth a copy of
    /// its own.
    pub(super) fn outline(&self, verbs: &[Verb], points: &[Point]) -> Option<&Arc<Outline>> {
        if points.len() < FEWEST_POINTS {
            return None;
        }
        if !self.drawn.load(Ordering::Relaxed) {
            self.drawn.store(true, Ordering::Relaxed);
            return None;
        }
        Some(self.outline.get_or_init(|| Arc::new(Outline { verbs: verbs.into(), points: points.into() })))
    }
}

impl Clone for Known {
    fn clone(&self) -> Self {
        let drawn = AtomicBool::new(self.drawn.load(Ordering::Relaxed));
        Self { bounds: self.bounds.clone(), drawn, outline: self.outline.clone() }
    }
}

impl PartialEq for Known {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
