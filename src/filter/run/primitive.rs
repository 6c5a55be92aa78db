//! One primitive at work: what it reads, and what it makes of that.

use std::cell::RefCell;
use std::sync::Arc;

use super::super::blur::blur;
use super::super::color_matrix::color_matrix;
use super::super::component_transfer::component_transfer;
use super::super::composite::{blend, composite, merge};
use super::super::convolve::convolve;
use super::super::displacement::displace;
use super::super::drop_shadow::{DropShadow, drop_shadow};
use super::super::flood::flood;
use super::super::graph::{ColorSpace, Input, Kind, Primitive};
use super::super::image::{Image, Work};
use super::super::lighting;
use super::super::morphology::morphology;
use super::super::offset::offset;
use super::super::picture::picture;
use super::super::source::{Converted, Parts, blacken};
use super::super::space::{color_in, convert};
use super::super::tile::tile;
use super::super::turbulence::turbulence;
use super::{PlacedFilter, Step};
use crate::error::Result;
use crate::geom::IntRect;

/// What a primitive finds when its turn comes.
pub(super) struct Inputs<'a> {
    pub(super) placed: &'a PlacedFilter,
    /// The source graphic, if it is drawn where it is read.
    pub(super) parts: Option<&'a dyn Parts>,
    pub(super) pictures: &'a RefCell<Vec<Option<(Arc<Image>, ColorSpace)>>>,
    /// Whether a picture is given away where it is read.
    pub(super) handed_over: &'a dyn Fn(usize) -> bool,
    pub(super) index: usize,
    pub(super) work: Work,
}

impl Inputs<'_> {
    /// The source graphic's parts, if they are what an input names.
    fn parts_of(&self, input: Input) -> Option<&dyn Parts> {
        self.parts.filter(|_| self.placed.place_of(input, self.index) == 0)
    }

    /// An input as it is, and its space. A step asks for each of its inputs once.
    fn raw(&self, input: Input) -> Result<(Arc<Image>, ColorSpace)> {
        let (image, space) = match self.parts_of(input) {
            Some(parts) => {
                let area = self.placed.steps.get(self.index).map_or(IntRect::EMPTY, |step| step.source);
                (Arc::new(parts.part(area)?.into_owned()), ColorSpace::Srgb)
            }
            None => self.picture(input),
        };
        Ok((self.converted(image, input == Input::SourceAlpha, space, space), space))
    }

    /// A picture that was made before.
    fn picture(&self, input: Input) -> (Arc<Image>, ColorSpace) {
        let place = self.placed.place_of(input, self.index);
        let mut pictures = self.pictures.borrow_mut();
        let picture = match pictures.get_mut(place) {
            Some(picture) if (self.handed_over)(place) => picture.take(),
            Some(picture) => picture.clone(),
            None => None,
        };
        picture.unwrap_or_else(|| (Arc::new(Image::empty()), ColorSpace::Srgb))
    }

    /// An input in the given space, shared where possible.
    fn shared(&self, input: Input, space: ColorSpace) -> Result<Arc<Image>> {
        let (image, own) = self.raw(input)?;
        // Black is black in every space.
        Ok(if input == Input::SourceAlpha { image } else { self.converted(image, false, own, space) })
    }

    /// An input in the given space, to change.
    fn owned(&self, input: Input, space: ColorSpace) -> Result<Image> {
        Ok(Arc::unwrap_or_clone(self.shared(input, space)?))
    }

    /// An input in the given space, for a primitive that reads it part by part.
    fn in_parts(&self, input: Input, space: ColorSpace) -> Result<Box<dyn Parts + '_>> {
        let alpha_only = input == Input::SourceAlpha;
        let (to, work) = (space, self.work);
        if let Some(parts) = self.parts_of(input) {
            return Ok(Box::new(Converted { parts, alpha_only, from: ColorSpace::Srgb, to, work }));
        }
        let (image, from) = self.picture(input);
        if Arc::strong_count(&image) > 1 {
            return Ok(Box::new(Converted { parts: image, alpha_only, from, to, work }));
        }
        // Read for the last time: it may change as a whole.
        Ok(Box::new(self.converted(image, alpha_only, from, space)))
    }

    /// A picture as a primitive asks for it.
    fn converted(&self, image: Arc<Image>, alpha_only: bool, from: ColorSpace, to: ColorSpace) -> Arc<Image> {
        if !alpha_only && from == to {
            return image;
        }
        let mut image = Arc::unwrap_or_clone(image);
        if alpha_only {
            blacken(&mut image, self.work);
        } else {
            convert(&mut image, from, to, self.work);
        }
        Arc::new(image)
    }

    /// A primitive's result and its space.
    pub(super) fn step(&self, primitive: &Primitive, step: &Step) -> Result<(Image, ColorSpace)> {
        let Self { placed, work, .. } = *self;
        let (area, space) = (step.wanted, primitive.color_space);
        let (region, grid) = (placed.region, &placed.grid);
        let image = match &primitive.kind {
            Kind::Blend { top, bottom, mode } => {
                blend(&*self.shared(*top, space)?, self.owned(*bottom, space)?, area, *mode, work)?
            }
            Kind::ColorMatrix { input, matrix } if matrix.is_finite() => {
                color_matrix(self.owned(*input, space)?, area, matrix, work)?
            }
            Kind::ColorMatrix { .. } => Image::empty(),
            Kind::ComponentTransfer { input, functions } => {
                component_transfer(self.owned(*input, space)?, area, functions, work)?
            }
            Kind::Composite { top, bottom, operator } => {
                composite(&*self.shared(*top, space)?, self.owned(*bottom, space)?, area, *operator, work)?
            }
            Kind::ConvolveMatrix { input, matrix } => {
                convolve(&*self.shared(*input, space)?, area, region, matrix, work)?
            }
            Kind::DiffuseLighting { input, lighting } => {
                lighting::diffuse(&self.raw(*input)?.0, area, region, lighting, &grid.map(), work)?
            }
            Kind::SpecularLighting { input, lighting } => {
                lighting::specular(&self.raw(*input)?.0, area, region, lighting, &grid.map(), work)?
            }
            Kind::DisplacementMap { input, map, displacement } => {
                let scale = (displacement.scale * grid.scale.0, displacement.scale * grid.scale.1);
                // The picture's own colours are only moved.
                let (image, own) = self.raw(*input)?;
                if !(scale.0.is_finite() && scale.1.is_finite()) {
                    return Ok((Image::empty(), own));
                }
                return Ok((displace(&image, self.shared(*map, space)?, area, displacement, scale, work)?, own));
            }
            Kind::DropShadow { input, dx, dy, deviation_x, deviation_y, color } => {
                let (across, down) = placed.blurs(*deviation_x, *deviation_y);
                let color = color_in(space, *color);
                let shadow = DropShadow { across, down, offset: placed.whole(*dx, *dy), color };
                drop_shadow(&*self.in_parts(*input, space)?, area, placed.cut(), &shadow, work)?
            }
            Kind::Flood { color } => return Ok((flood(area, *color)?, ColorSpace::Srgb)),
            Kind::GaussianBlur { input, deviation_x, deviation_y } => {
                let (across, down) = placed.blurs(*deviation_x, *deviation_y);
                if across.is_nothing() && down.is_nothing() {
                    // Nothing is rounded, then.
                    let (image, own) = self.raw(*input)?;
                    return Ok((Arc::unwrap_or_clone(image).within(area), own));
                }
                blur(&*self.in_parts(*input, space)?, area, placed.cut(), &across, &down, work)?
            }
            Kind::Image { image, destination } => {
                return Ok((picture(image, area, grid.rect(*destination), work)?, ColorSpace::Srgb));
            }
            Kind::Merge { inputs } => merge(inputs.iter().map(|input| self.shared(*input, space)), area, work)?,
            Kind::Morphology { input, operator, radius_x, radius_y } => match placed.radii(*radius_x, *radius_y) {
                Some(radius) => morphology(&*self.shared(*input, space)?, area, region, *operator, radius, work)?,
                None => Image::empty(),
            },
            Kind::Offset { input, dx, dy } => {
                let (image, own) = self.raw(*input)?;
                let (dx, dy) = placed.whole(*dx, *dy);
                return Ok((offset(image, area, dx, dy), own));
            }
            Kind::Tile { input } => {
                let (image, own) = self.raw(*input)?;
                let from = match placed.result_of(*input, self.index) {
                    Some(result) => placed.subregion(result),
                    None => region,
                };
                return Ok((tile(&image, area, from, work)?, own));
            }
            Kind::Turbulence(noise) => turbulence(noise, area, step.subregion, &grid.map(), work)?,
        };
        Ok((image, space))
    }
}
