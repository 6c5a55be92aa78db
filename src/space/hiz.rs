//! Hierarchical depth: whole tiles decided by the nearest and farthest depth stored in them.
//!
//! A triangle's depth over a tile lies between its values at the tile's corners, exactly, since the formula that gives a pixel's
//! depth is monotone in x and in y even when rounded. Zmax culling after Greene, Kass and Miller, *Hierarchical Z-buffer
//! visibility*, 1993; Zmin after Akenine-Möller and Ström, *Graphics for the masses*, 2003.

use super::batch::BatchTriangle;
use super::depth::DepthFormat;
use super::state::{Compare, Depth, DepthMapping};
use super::target::{DepthBounds, TILE};
use crate::num::trig;

/// The depth test of a draw, ready for use.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DepthRule {
    pub(crate) format: DepthFormat,
    pub(crate) compare: Compare,
    pub(crate) write: bool,
    pub(crate) bias_slope: f32,
    pub(crate) bias_units: f32,
    /// For logarithmic depth: log₂ near, and 1 / log₂(far / near).
    pub(crate) logarithm: Option<(f32, f32)>,
    /// Whether tiles are decided as a whole.
    pub(crate) hierarchical: bool,
}

impl DepthRule {
    pub(crate) fn new(depth: &Depth, format: DepthFormat, hierarchical: bool) -> Self {
        let logarithm = match depth.mapping {
            DepthMapping::Logarithmic { near, far } if near > 0.0 && far > 0.0 && near != far => {
                let (near, far) = (trig::log2(f64::from(near)), trig::log2(f64::from(far)));
                let scale = (1.0 / (far - near)) as f32;
                scale.is_finite().then_some((near as f32, scale))
            }
            _ => None,
        };
        Self {
            format,
            compare: depth.compare,
            write: depth.write,
            bias_slope: depth.bias_slope,
            bias_units: depth.bias_units,
            logarithm,
            hierarchical: hierarchical && logarithm.is_none(),
        }
    }

    #[inline(always)]
    pub(crate) fn is_on(&self) -> bool {
        self.write || self.compare != Compare::Always
    }
}

/// What a tile's depth range says about a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// No pixel can pass.
    Hidden,
    /// Every pixel passes.
    InFront,
    /// Each pixel has to be looked at.
    Unknown,
}

/// The least and the greatest key that a triangle has over `tiles` tiles side by side, the first at (x, y).
#[inline(always)]
pub(crate) fn range_over_tiles(
    rule: &DepthRule,
    triangle: &BatchTriangle,
    (x, y): (i32, i32),
    tiles: i32,
    inset: f32,
) -> (i32, i32) {
    let [c, gx, gy] = triangle.z;
    let (width, height) = ((tiles * TILE as i32) as f32 - inset, TILE as f32 - inset);
    let (x, y) = (x as f32, y as f32);
    let (left, right) = (x + inset - triangle.gradients.x0, x + width - triangle.gradients.x0);
    let (top, bottom) = (y + inset - triangle.gradients.y0, y + height - triangle.gradients.y0);
    let (near_x, far_x) = if gx < 0.0 { (right, left) } else { (left, right) };
    let (near_y, far_y) = if gy < 0.0 { (bottom, top) } else { (top, bottom) };
    let key = |dx: f32, dy: f32| {
        let z = (dx * gx + c) + dy * gy;
        rule.format.key(if z > 0.0 { if z < 1.0 { z } else { 1.0 } } else { 0.0 })
    };
    (key(near_x, near_y), key(far_x, far_y))
}

/// Whether no pixel of a row of tiles can pass, for what the triangle has over all of them.
#[inline(always)]
pub(crate) fn all_hidden(compare: Compare, range: (i32, i32), tiles: &[DepthBounds]) -> bool {
    let merged = tiles.iter().fold(DepthBounds { nearest: i32::MAX, farthest: i32::MIN }, |all, one| DepthBounds {
        nearest: all.nearest.min(one.nearest),
        farthest: all.farthest.max(one.farthest),
    });
    verdict(compare, range, &merged) == Verdict::Hidden
}

/// Decides a tile.
#[inline(always)]
pub(crate) fn verdict(compare: Compare, (least, greatest): (i32, i32), bounds: &DepthBounds) -> Verdict {
    let (hidden, in_front) = match compare {
        Compare::Less => (least >= bounds.farthest, greatest < bounds.nearest),
        Compare::LessEqual => (least > bounds.farthest, greatest <= bounds.nearest),
        Compare::Greater => (greatest <= bounds.nearest, least > bounds.farthest),
        Compare::GreaterEqual => (greatest < bounds.nearest, least >= bounds.farthest),
        Compare::Never => (true, false),
        Compare::Always => (false, true),
        Compare::Equal => (least > bounds.farthest || greatest < bounds.nearest, false),
        Compare::NotEqual => (false, least > bounds.farthest || greatest < bounds.nearest),
    };
    if hidden {
        Verdict::Hidden
    } else if in_front {
        Verdict::InFront
    } else {
        Verdict::Unknown
    }
}

/// Keeps a tile's range right after a triangle of the given range stored depths in it; `full` says that every sample
/// of the tile was covered.
#[inline(always)]
pub(crate) fn update(
    compare: Compare,
    (least, greatest): (i32, i32),
    full: bool,
    all_passed: bool,
    bounds: &mut DepthBounds,
) {
    if full && all_passed {
        *bounds = DepthBounds { nearest: least, farthest: greatest };
        return;
    }
    match compare {
        Compare::Less | Compare::LessEqual => {
            bounds.nearest = bounds.nearest.min(least);
            if full {
                // Each depth is now at most the old one and at most the triangle's.
                bounds.farthest = bounds.farthest.min(greatest);
            }
        }
        Compare::Greater | Compare::GreaterEqual => {
            bounds.farthest = bounds.farthest.max(greatest);
            if full {
                bounds.nearest = bounds.nearest.max(least);
            }
        }
        Compare::Never | Compare::Equal => {}
        Compare::Always | Compare::NotEqual => {
            bounds.nearest = bounds.nearest.min(least);
            bounds.farthest = bounds.farthest.max(greatest);
        }
    }
}
