//! What has to be drawn before the bands: pictures that effects with a footprint make of whole surfaces.

use std::sync::Arc;

use super::{Parts, RenderSettings};
use crate::color::Color;
use crate::display_list::{Command, DisplayList, Effect, EffectKind};
use crate::error::Result;
use crate::filter::{self, Image, PlacedFilter, Source, Work};
use crate::geom::{IntRect, Transform};
use crate::paint::PreparedPaint;

/// The pictures that the bands need.
#[derive(Debug, Default)]
pub(crate) struct Plan {
    pictures: Vec<PlannedPicture>,
}

/// An effect as a picture.
#[derive(Debug)]
pub(crate) struct PlannedPicture {
    command: u32,
    pub(crate) paint: PreparedPaint,
    pub(crate) bounds: IntRect,
}

impl Plan {
    /// The picture of command `command`, if it has any visible pixel.
    pub(crate) fn picture(&self, command: u32) -> Option<&PlannedPicture> {
        let index = self.pictures.binary_search_by_key(&command, |picture| picture.command).ok()?;
        self.pictures.get(index)
    }
}

/// Draws what `list`'s effects need. Where memory is lacking for one, the others are drawn all the same.
pub(super) fn plan(list: &DisplayList, frame: IntRect, settings: RenderSettings) -> (Plan, Result<()>) {
    let mut plan = Plan::default();
    let mut result = Ok(());
    for (index, command) in list.commands.iter().enumerate() {
        if let Command::Effect(effect) = command {
            let bounds = effect.bounds.intersect(frame);
            if bounds.is_empty() {
                continue;
            }
            let picture = match &effect.kind {
                EffectKind::Shadow { offset, deviation, color } => {
                    shadow(effect, *offset, *deviation, *color, bounds, settings)
                }
                EffectKind::Filter { filter, to_device, opacity } => {
                    filtered(effect, filter, *to_device, *opacity, bounds, settings)
                }
            };
            match picture {
                Ok(Some((paint, bounds))) => {
                    plan.pictures.push(PlannedPicture { command: index as u32, paint, bounds })
                }
                Ok(None) => {}
                Err(error) => result = Err(error),
            }
        }
    }
    (plan, result)
}

/// What the effect applies to: drawn, if it may take so many pixels, or ready to be.
fn source(effect: &Effect, most: u64, settings: RenderSettings) -> Result<Source<'_>> {
    let Effect { extent, list, .. } = effect;
    if extent.is_empty() || list.commands.is_empty() {
        return Ok(Source::Picture(Image::empty()));
    }
    let parts = Parts::new(list, *extent, settings)?;
    if filter::pixels(*extent) > most {
        return Ok(Source::Parts(Box::new(parts)));
    }
    Ok(Source::Picture(filter::Parts::part(&parts, *extent)?.into_owned()))
}

/// Draws a shadow's shapes, blurs their alpha and gives it the shadow's colour.
fn shadow(
    effect: &Effect,
    (dx, dy): (i32, i32),
    deviation: f32,
    color: Color,
    bounds: IntRect,
    settings: RenderSettings,
) -> Result<Option<(PreparedPaint, IntRect)>> {
    let work = Work { threads: settings.threads, level: settings.level };
    let seen = IntRect::from_ltrb(bounds.left - dx, bounds.top - dy, bounds.right - dx, bounds.bottom - dy);
    let source = source(effect, filter::ALWAYS_WHOLE, settings)?;
    let mut image = filter::gaussian(source.as_parts(), seen, deviation, work)?;
    drop(source);
    filter::tint(&mut image, color, work);
    Ok(paint(image, Transform::from_translate(dx as f32, dy as f32), 1.0, bounds))
}

/// Draws a layer and filters it.
fn filtered(
    effect: &Effect,
    filter: &PlacedFilter,
    to_device: Transform,
    opacity: f32,
    bounds: IntRect,
    settings: RenderSettings,
) -> Result<Option<(PreparedPaint, IntRect)>> {
    let work = Work { threads: settings.threads, level: settings.level };
    let image = filter.run(source(effect, filter.most_of_source(), settings)?, work)?;
    Ok(paint(image, to_device, opacity, bounds))
}

/// A picture as a paint, and the device pixels within `bounds` that it touches.
fn paint(image: Image, to_device: Transform, opacity: f32, bounds: IntRect) -> Option<(PreparedPaint, IntRect)> {
    let place = image.bounds();
    // Sampled between pixels, its borders fade out over one more.
    let touched = to_device.map_rect(place.to_rect())?;
    let touched = if to_device.is_translate() { touched } else { touched.outset(1.0) };
    let bounds = touched.round_out().intersect(bounds);
    let pixmap = image.into_pixmap()?;
    if bounds.is_empty() {
        return None;
    }
    let place = to_device.pre_concat(Transform::from_translate(place.left as f32, place.top as f32));
    Some((PreparedPaint::picture(Arc::new(pixmap), place, opacity), bounds))
}
