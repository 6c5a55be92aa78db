//! How a path is stroked.

use std::sync::Arc;

/// The ends of open subpaths and of dashes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LineCap {
    /// Ends flush with the end point.
    #[default]
    Butt,
    /// A half disc around the end point.
    Round,
    /// Half a square: the line goes on for half its width.
    Square,
}

/// The corners where two segments meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LineJoin {
    /// The outer edges meet in a point; over the miter limit, a bevel.
    #[default]
    Miter,
    /// The outer edges meet in a point, cut off at the miter limit.
    MiterClip,
    /// A disc around the corner.
    Round,
    /// The outer ends are joined by a straight line.
    Bevel,
}

/// A dash pattern.
///
/// The ends of dashes have the stroke's caps; a dash without length is a dot or a square in the path's
/// direction, and nothing under butt caps. A gap without length is none. On a closed subpath a last dash
/// that reaches the start is joined to the first. A pattern of which more than a million dashes and gaps
/// would be seen is drawn solid.
#[derive(Clone, Debug, PartialEq)]
pub struct Dash {
    /// Lengths of dashes and gaps in turn, in user space; an odd number of them is repeated once, as
    /// in SVG. A negative or non-finite length, or a sum of zero, makes the line solid.
    pub intervals: Arc<[f32]>,
    /// How far into the pattern each subpath starts, in user space; a non-finite one counts as 0.
    pub offset: f32,
}

/// How a path is stroked.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// The line's width in user space. 0 is a hairline: one device pixel at any transform. Negative
    /// and non-finite widths draw nothing. The default is 1.
    pub width: f32,
    /// The ends. The default is [`LineCap::Butt`].
    pub cap: LineCap,
    /// The corners. The default is [`LineJoin::Miter`].
    pub join: LineJoin,
    /// The longest miter as a multiple of half the line's width, measured from the corner to the
    /// miter's tip; below 1 it is taken as 1. The default is 4.
    pub miter_limit: f32,
    /// Dashes; the default is none.
    pub dash: Option<Dash>,
}

impl Default for Stroke {
    fn default() -> Self {
        Self { width: 1.0, cap: LineCap::Butt, join: LineJoin::Miter, miter_limit: 4.0, dash: None }
    }
}

impl Stroke {
    /// A solid line of the given width with butt caps and miter joins.
    pub fn new(width: f32) -> Self {
        Self { width, ..Self::default() }
    }

    /// The same with the given caps.
    #[must_use]
    pub fn with_cap(self, cap: LineCap) -> Self {
        Self { cap, ..self }
    }

    /// The same with the given joins.
    #[must_use]
    pub fn with_join(self, join: LineJoin) -> Self {
        Self { join, ..self }
    }

    /// The same with the given miter limit.
    #[must_use]
    pub fn with_miter_limit(self, miter_limit: f32) -> Self {
        Self { miter_limit, ..self }
    }

    /// The same with the given dash lengths and offset.
    #[must_use]
    pub fn with_dash(self, intervals: impl Into<Arc<[f32]>>, offset: f32) -> Self {
        Self { dash: Some(Dash { intervals: intervals.into(), offset }), ..self }
    }
}
