//! What has to be drawn before the bands: pictures that effects with a footprint make of whole surfaces.

use std::sync::Arc;

use super::{RenderSettings, Renderer};
use crate::display_list::{Command, DisplayList, Shadow};
use crate::error::Result;
use crate::filter::blur;
use crate::geom::{IntRect, Transform};
use crate::num::lanes::div255;
use crate::paint::{FilterQuality, Pattern, PreparedPaint, SpreadMode};
use crate::surface::Pixmap;

/// The pictures that the bands need.
#[derive(Debug, Default)]
pub(crate) struct Plan {
    shadows: Vec<PlannedShadow>,
}

/// A shadow as a picture.
#[derive(Debug)]
pub(crate) struct PlannedShadow {
    command: u32,
    pub(crate) paint: PreparedPaint,
    pub(crate) bounds: IntRect,
}

impl Plan {
    /// The shadow of command `command`, if it has any visible pixel.
    pub(crate) fn shadow(&self, command: u32) -> Option<&PlannedShadow> {
        let index = self.shadows.binary_search_by_key(&command, |shadow| shadow.command).ok()?;
        self.shadows.get(index)
    }
}

/// Draws what `list`'s effects need. Where memory is lacking for one, the others are drawn all the same.
pub(super) fn plan(list: &DisplayList, frame: IntRect, settings: RenderSettings) -> (Plan, Result<()>) {
    let mut plan = Plan::default();
    let mut result = Ok(());
    for (index, command) in list.commands.iter().enumerate() {
        if let Command::Shadow(shadow) = command {
            let bounds = shadow.bounds.intersect(frame);
            if bounds.is_empty() {
                continue;
            }
            match picture(shadow, bounds, settings) {
                Ok(paint) => plan.shadows.push(PlannedShadow { command: index as u32, paint, bounds }),
                Err(error) => result = Err(error),
            }
        }
    }
    (plan, result)
}

/// Draws a shadow's shapes, blurs their alpha and gives it the shadow's colour, in the device pixels `bounds`.
fn picture(shadow: &Shadow, bounds: IntRect, settings: RenderSettings) -> Result<PreparedPaint> {
    let mut shapes = Pixmap::new(shadow.extent.width(), shadow.extent.height())?;
    Renderer::default().render(&shadow.list, &mut shapes.as_mut(), settings)?;
    let alpha: Vec<u8> = shapes.data().as_chunks::<4>().0.iter().map(|[_, _, _, a]| *a).collect();
    let (dx, dy) = shadow.offset;
    let seen = IntRect::from_ltrb(bounds.left - dx, bounds.top - dy, bounds.right - dx, bounds.bottom - dy);
    let alpha = blur::gaussian(&alpha, shadow.extent, seen, shadow.deviation);
    let mut pixmap = Pixmap::new(bounds.width(), bounds.height())?;
    let color = shadow.color.premultiply().map(u32::from);
    for (pixel, alpha) in pixmap.data_mut().as_chunks_mut::<4>().0.iter_mut().zip(alpha) {
        *pixel = color.map(|component| div255(component * u32::from(alpha)) as u8);
    }
    let mut pattern = Pattern::new(Arc::new(pixmap));
    pattern.quality = FilterQuality::Nearest;
    (pattern.spread_x, pattern.spread_y) = (SpreadMode::Decal, SpreadMode::Decal);
    let place = Transform::from_translate(bounds.left as f32, bounds.top as f32);
    Ok(PreparedPaint::new(&pattern.into(), place, 1.0))
}
