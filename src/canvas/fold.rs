//! Layers that hold many pictures are drawn so far before they end.
//!
//! A filter's picture is made before the bands are painted, and kept until they are. Within an open layer nothing can be
//! painted yet; but what the layer has recorded can become one picture, which is what the layer would hold: it
//! starts out transparent, and pixels over nothing stay as they are.
//!
//! A layer with a filter that reaches far may be too large for a picture. What lies near to the visible becomes one then, and
//! covers what was recorded there; pictures of effects lie near, too, and go.

use std::sync::Arc;

use super::Canvas;
use super::state::OpenLayerKind;
use crate::blend::BlendMode;
use crate::display_list::{ClipId, Command, Draw, Geometry, LayerStart, PaintRef};
use crate::error::Result;
use crate::geom::{IntRect, Transform};
use crate::paint::PreparedPaint;
use crate::render::Parts;
use crate::style::Antialias;

impl Canvas<'_> {
    /// Replaces what the innermost open layer recorded by one picture of it. Where there is no memory for that, all stays
    /// as it is.
    pub(super) fn fold_layer(&mut self) -> Result<()> {
        let Some(bounds) = self.layers.last().map(|layer| layer.kind.bounds()) else { return Ok(()) };
        let area = self.near().map_or(bounds, |near| bounds.intersect(near));
        if area.is_empty() {
            return Ok(());
        }
        let start = self.innermost_start();
        let inner = self.list.commands.split_off(start);
        let outer = std::mem::take(&mut self.list.commands);
        // Draws inside may name clips from outside, and later ones those from inside.
        let clips = |commands: &[Command]| -> Vec<Command> {
            commands.iter().filter(|command| matches!(command, Command::Clip(_))).cloned().collect()
        };
        let (outer_clips, inner_clips) = (clips(&outer), clips(&inner));
        let first = outer_clips.len() + 1;
        // Within a layer, as masks apply to one.
        let layer = LayerStart::plain(bounds);
        self.list.commands = outer_clips;
        self.list.commands.push(Command::BeginLayer(layer.clone()));
        self.list.commands.extend(inner);
        self.list.commands.push(Command::EndLayer(layer));
        let drawn = self.picture_of(area);
        self.list.commands.pop();
        let mut inner = self.list.commands.split_off(first);
        self.list.commands = outer;
        let paint = match drawn {
            Ok(paint) => paint,
            Err(error) => {
                self.list.commands.extend(inner);
                return Err(error);
            }
        };
        if area != bounds {
            self.drop_within(area, &mut inner);
            self.list.commands.extend(inner);
            self.draw_picture(paint, area, BlendMode::Source);
            return Ok(());
        }
        // Each draw that is not in one colour has a paint of its own, later ones after earlier ones: those of what was replaced are
        // not needed any more, pictures of earlier folds among them.
        let last_outer = self.list.commands.iter().rev().find_map(|command| match command {
            Command::Draw(draw) => draw.paint.index(),
            _ => None,
        });
        let index = last_outer.map_or(0, |last| last + 1);
        self.list.paints.truncate(index as usize);
        self.list.commands.extend(inner_clips);
        self.draw_picture(paint, area, BlendMode::SourceOver);
        Ok(())
    }

    /// Removes from `commands` the effects, and the draws that touch nothing outside of `area`, with their paints.
    fn drop_within(&mut self, area: IntRect, commands: &mut Vec<Command>) {
        let paints = &mut self.list.paints;
        commands.retain(|command| match command {
            Command::Effect(_) => false,
            Command::Draw(draw) if area.contains(draw.bounds) => {
                // Other paints keep their places.
                if let Some(paint) = draw.paint.index().and_then(|index| paints.get_mut(index as usize)) {
                    *paint = PreparedPaint::Nothing;
                }
                false
            }
            _ => true,
        });
    }

    /// Records a picture of `area`.
    fn draw_picture(&mut self, picture: PreparedPaint, area: IntRect, blend_mode: BlendMode) {
        let paint = PaintRef::of_index(self.list.paints.len() as u32);
        let opaque = picture.is_opaque();
        self.list.paints.push(picture);
        self.list.commands.push(Command::Draw(Draw {
            geometry: Geometry::Bounds,
            paint,
            antialias: Antialias::None,
            blend_mode,
            clip: ClipId::NONE,
            bounds: area,
            opaque,
        }));
    }

    /// What the recording draws within `area`, as a paint.
    fn picture_of(&mut self, area: IntRect) -> Result<PreparedPaint> {
        let (pixmap, x, y) = Parts::one(&self.list, area, self.settings)?;
        Ok(PreparedPaint::picture(Arc::new(pixmap), Transform::from_translate(x as f32, y as f32), 1.0))
    }

    /// Where the commands of the innermost open layer start: a filter's have a recording of their own.
    fn innermost_start(&self) -> usize {
        if matches!(self.layers.last().map(|layer| &layer.kind), Some(OpenLayerKind::Filter(_))) {
            return 0;
        }
        let mut closed = 0_usize;
        for (index, command) in self.list.commands.iter().enumerate().rev() {
            match command {
                Command::EndLayer(_) | Command::EndMask(..) => closed += 1,
                Command::BeginLayer(_) | Command::BeginMask(_) if closed == 0 => return index + 1,
                Command::BeginLayer(_) | Command::BeginMask(_) => closed -= 1,
                _ => {}
            }
        }
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Color;
    use crate::display_list::Paint;
    use crate::geom::Rect;
    use crate::surface::MaskKind;

    /// A picture whose open layers and masks are folded now and then, or never.
    fn picture(fold: bool) -> Vec<u8> {
        let mut canvas = Canvas::new(80, 60).unwrap();
        let fold_now = |canvas: &mut Canvas<'_>| {
            if fold {
                canvas.fold_layer().unwrap();
                let last = canvas.list.commands.last();
                assert!(matches!(last, Some(Command::Draw(Draw { geometry: Geometry::Bounds, .. }))));
            }
        };
        let color = |r: f32, g: f32, b: f32, a: f32| Color { r, g, b, a };
        canvas.fill(color(0.9, 0.8, 0.3, 1.0));
        let mut round = crate::path::Path::new();
        round.circle((40.0, 30.0), 27.3);
        canvas.clip_path(&round, crate::style::FillRule::NonZero, Antialias::Analytic);
        canvas.push_layer(0.7, BlendMode::Multiply);
        canvas.fill_rect(Rect::from_xywh(10.5, 5.25, 40.0, 30.0), color(0.1, 0.4, 0.8, 0.6));
        canvas.fill_circle((50.0, 30.0), 14.2, color(0.9, 0.1, 0.2, 0.8));
        fold_now(&mut canvas);
        canvas.clip_path(&round, crate::style::FillRule::EvenOdd, Antialias::Analytic);
        canvas.fill_circle(
            (30.0, 35.0),
            13.7,
            Paint::new(color(0.2, 0.9, 0.5, 0.7)).with_blend_mode(BlendMode::Screen),
        );
        canvas.push_layer(0.5, BlendMode::SourceOver);
        canvas.fill_circle((35.0, 25.0), 9.0, color(0.0, 0.0, 0.0, 0.9));
        fold_now(&mut canvas);
        canvas.fill_circle((42.0, 25.0), 9.0, color(1.0, 1.0, 1.0, 0.4));
        canvas.pop_layer();
        fold_now(&mut canvas);
        canvas.push_mask(MaskKind::Luminance);
        canvas.fill(color(1.0, 1.0, 1.0, 0.8));
        canvas.fill_circle((40.0, 20.0), 8.5, color(0.1, 0.1, 0.1, 1.0));
        fold_now(&mut canvas);
        canvas.fill_circle((28.0, 40.0), 6.5, color(0.4, 0.1, 0.1, 1.0));
        canvas.pop_mask();
        // The mask applies to what the layer holds, and to nothing that comes after.
        fold_now(&mut canvas);
        canvas.fill_circle((60.0, 20.0), 5.5, color(0.4, 0.1, 0.9, 0.3));
        canvas.pop_layer();
        canvas.fill_circle((20.0, 20.0), 5.5, color(0.4, 0.1, 0.9, 0.3));
        canvas.into_pixmap().data().to_vec()
    }

    #[test]
    fn folded_layers_look_the_same() {
        assert!(picture(true) == picture(false));
    }

    #[test]
    fn what_is_folded_near_the_visible_looks_the_same_around_it() {
        let color = |r: f32, g: f32, b: f32, a: f32| Color { r, g, b, a };
        let picture = |fold: bool| {
            let mut canvas = Canvas::new(80, 60).unwrap();
            let mut soft = crate::filter::Filter::new();
            let input = crate::filter::Input::SourceGraphic;
            soft.add(crate::filter::Kind::GaussianBlur { input, deviation_x: 6.0, deviation_y: 6.0 });
            let soft = crate::LayerOptions::default().with_filter(soft);
            let fold_now = |canvas: &mut Canvas<'_>| {
                if fold {
                    canvas.fold_layer().unwrap();
                    let effects = canvas.list.commands.iter().filter(|c| matches!(c, Command::Effect(_))).count();
                    assert_eq!(effects, 0);
                }
            };
            canvas.push_layer_with(&soft);
            if let Some(OpenLayerKind::Filter(layer)) = canvas.layers.last_mut().map(|layer| &mut layer.kind) {
                assert_eq!(layer.near, IntRect::from_xywh(0, 0, layer.extent.width(), layer.extent.height()));
                layer.near = IntRect::from_ltrb(23, 19, 85, 71);
            }
            canvas.fill_circle((40.0, 30.0), 44.2, color(0.1, 0.4, 0.8, 0.6));
            canvas.push_layer_with(&soft);
            canvas.fill_rect(Rect::from_xywh(10.5, 5.25, 40.0, 30.0), color(0.9, 0.4, 0.1, 0.7));
            canvas.pop_layer();
            fold_now(&mut canvas);
            canvas.fill_circle((30.0, 30.0), 5.2, color(0.1, 0.9, 0.8, 0.9));
            canvas.push_layer(0.5, BlendMode::Multiply);
            canvas.fill_rect(Rect::from_xywh(-9.5, 25.25, 100.0, 10.0), color(0.4, 0.4, 0.1, 0.7));
            canvas.push_layer_with(&soft);
            canvas.fill_circle((40.0, 10.0), 34.2, color(0.1, 0.4, 0.3, 0.6));
            canvas.pop_layer();
            fold_now(&mut canvas);
            canvas.pop_layer();
            canvas.push_mask(MaskKind::Alpha);
            canvas.fill_circle((40.0, 20.0), 38.5, color(0.1, 0.1, 0.1, 0.9));
            canvas.pop_mask();
            fold_now(&mut canvas);
            canvas.fill_circle((70.0, 30.0), 15.2, color(0.1, 0.9, 0.8, 0.2));
            fold_now(&mut canvas);
            canvas.pop_layer();
            canvas.into_pixmap().data().to_vec()
        };
        assert!(picture(true) == picture(false));
    }
}
