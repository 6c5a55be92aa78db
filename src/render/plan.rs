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

/// Draws what `list`'s effects need.
pub(super) fn plan(list: &DisplayList, frame: IntRect, settings: RenderSettings) -> Result<Plan> {
    let mut plan = Plan::default();
    for (index, command) in list.commands.iter().enumerate() {
        if let Command::Shadow(shadow) = command {
            let bounds = shadow.bounds.intersect(frame);
            if !bounds.is_empty() {
                plan.shadows.push(PlannedShadow { command: index as u32, paint: picture(shadow, settings)?, bounds });
            }
        }
    }
    Ok(plan)
}

/// Draws a shadow's shapes, blurs their alpha and gives it the shadow's colour.
fn picture(shadow: &Shadow, settings: RenderSettings) -> Result<PreparedPaint> {
    let mut pixmap = Pixmap::new(shadow.region.width(), shadow.region.height())?;
    Renderer::default().render(&shadow.list, &mut pixmap.as_mut(), settings)?;
    let mut alpha: Vec<u8> = pixmap.data().as_chunks::<4>().0.iter().map(|[_, _, _, a]| *a).collect();
    blur::gaussian(&mut alpha, shadow.region.width() as usize, shadow.deviation);
    let color = shadow.color.premultiply().map(u32::from);
    for (pixel, alpha) in pixmap.data_mut().as_chunks_mut::<4>().0.iter_mut().zip(alpha) {
        *pixel = color.map(|component| div255(component * u32::from(alpha)) as u8);
    }
    let mut pattern = Pattern::new(Arc::new(pixmap));
    pattern.quality = FilterQuality::Nearest;
    (pattern.spread_x, pattern.spread_y) = (SpreadMode::Decal, SpreadMode::Decal);
    let (x, y) = (shadow.region.left + shadow.offset.0, shadow.region.top + shadow.offset.1);
    Ok(PreparedPaint::new(&pattern.into(), Transform::from_translate(x as f32, y as f32), 1.0))
}
