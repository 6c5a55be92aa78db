//! A filter at work: which pixels each primitive has to give, then the pixels.

mod primitive;

use std::cell::RefCell;
use std::sync::Arc;

use self::primitive::Inputs;
use super::blur::Blur;
use super::convolve::EdgeMode;
use super::graph::{ColorSpace, Filter, Input, Kind, Primitive};
use super::image::{Image, Work, grown, moved, union};
use super::lighting::Map;
use super::offset::whole_pixels;
use super::source::{ALWAYS_WHOLE, Source, last_that, pixels};
use super::space::convert;
use crate::error::Result;
use crate::geom::{IntRect, Rect, Transform};

/// A filter on a grid of pixels, with what is wanted of every primitive.
#[derive(Clone, Debug)]
pub(crate) struct PlacedFilter {
    filter: Arc<Filter>,
    grid: Grid,
    /// The pixels of the filter's region.
    region: IntRect,
    /// The pixels outside of which pictures in between are transparent: all, unless these would be too large.
    kept: IntRect,
    /// How many pixels a picture in between may have.
    most: u64,
    steps: Vec<Step>,
    /// The pixels of the source graphic that matter.
    source: IntRect,
}

/// From user space to pixels: a scale and a move.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    scale: (f32, f32),
    origin: (f32, f32),
}

impl Grid {
    /// The grid of a transform that neither turns nor skews; the scales are positive.
    pub(crate) fn new(transform: Transform) -> Self {
        Self { scale: (transform.sx, transform.sy), origin: (transform.tx, transform.ty) }
    }

    /// The whole pixels of a rectangle in user space. As SVG renderers have it, width and height are rounded up for
    /// themselves, and at least a pixel.
    pub(crate) fn pixels(&self, rect: Rect) -> IntRect {
        let rect = rect.normalized();
        let left = rect.left * self.scale.0 + self.origin.0;
        let top = rect.top * self.scale.1 + self.origin.1;
        let right = rect.right * self.scale.0 + self.origin.0;
        let bottom = rect.bottom * self.scale.1 + self.origin.1;
        if !Rect::from_ltrb(left, top, right, bottom).is_finite() {
            return IntRect::EMPTY;
        }
        let most = 1e9;
        let length = |v: f32| v.ceil().clamp(1.0, most) as u32;
        let start = |v: f32| v.floor().clamp(-most, most) as i32;
        IntRect::from_xywh(start(left), start(top), length(right - left), length(bottom - top))
    }

    fn map(&self) -> Map {
        Map { scale: self.scale, origin: self.origin }
    }

    fn rect(&self, rect: Rect) -> Rect {
        Rect::from_ltrb(
            rect.left * self.scale.0 + self.origin.0,
            rect.top * self.scale.1 + self.origin.1,
            rect.right * self.scale.0 + self.origin.0,
            rect.bottom * self.scale.1 + self.origin.1,
        )
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Step {
    /// The pixels outside of which the result is transparent; what a tile is.
    subregion: IntRect,
    /// The pixels of the result that later steps ask for.
    wanted: IntRect,
    /// The pixels of the source graphic that it reads at once.
    source: IntRect,
}

impl PlacedFilter {
    /// Places a filter. `visible` is what of its result can be seen; nothing outside `limit` is computed, however far a
    /// filter reaches.
    ///
    /// Pictures in between have `most` pixels, or as many as `visible` or [`ALWAYS_WHOLE`]: where they would have more, they
    /// hold less of the surroundings. The source graphic does not need to, where it is only blurred.
    pub(crate) fn new(filter: Arc<Filter>, grid: Grid, visible: IntRect, limit: IntRect, most: u64) -> Self {
        let region = filter.region.map_or(limit, |region| grid.pixels(region)).intersect(limit);
        let most = most.max(ALWAYS_WHOLE).max(pixels(visible));
        let (steps, source) = (Vec::new(), IntRect::EMPTY);
        let mut placed = Self { filter, grid, region, kept: region, most, steps, source };
        placed.find_subregions();
        placed.find_wanted(visible);
        if !placed.fits() {
            placed.keep_less(visible);
        }
        placed
    }

    /// Whether no picture in between is too large.
    fn fits(&self) -> bool {
        self.steps.iter().all(|step| pixels(step.wanted) <= self.most && pixels(step.source) <= self.most)
    }

    /// Keeps as much of the surroundings as fits, on each side the same share of what is asked for.
    fn keep_less(&mut self, visible: IntRect) {
        const PARTS: i64 = 256;
        let asked = self.steps.iter().fold(visible, |all, step| union(all, union(step.wanted, step.source)));
        let kept = |parts: i64| {
            let side = |from: i32, to: i32| from + ((i64::from(to) - i64::from(from)) * parts / PARTS) as i32;
            IntRect::from_ltrb(
                side(visible.left, asked.left),
                side(visible.top, asked.top),
                side(visible.right, asked.right),
                side(visible.bottom, asked.bottom),
            )
        };
        let place = |placed: &mut Self, parts: i64| {
            placed.kept = kept(parts).intersect(placed.region);
            placed.find_wanted(visible);
        };
        let mut trial = self.clone();
        let parts = last_that(PARTS, |parts| {
            place(&mut trial, parts);
            trial.fits()
        });
        place(self, parts);
    }

    /// How many pixels the source graphic may have to be drawn as a whole; of more, it is drawn where it is read.
    ///
    /// For a single blur it makes no difference how it is drawn, and a shadow has a picture of its own while it draws the
    /// source; others would have parts drawn for each of them.
    pub(crate) fn most_of_source(&self) -> u64 {
        let reads_source = |(index, primitive): &(usize, &Primitive)| {
            primitive.kind.inputs().into_iter().any(|input| self.result_of(input, *index).is_none())
        };
        let mut readers = self.filter.primitives.iter().enumerate().filter(reads_source);
        match (readers.next(), readers.next()) {
            (Some((_, Primitive { kind: Kind::GaussianBlur { .. } | Kind::DropShadow { .. }, .. })), None) => {
                ALWAYS_WHOLE
            }
            _ => self.most,
        }
    }

    /// The pixels of the source graphic that the filter reads.
    pub(crate) fn source(&self) -> IntRect {
        self.source
    }

    /// The subregion of a primitive, in pixels.
    pub(crate) fn subregion(&self, primitive: usize) -> IntRect {
        self.steps.get(primitive).map_or(IntRect::EMPTY, |step| step.subregion)
    }

    /// The pixels that the result can have.
    pub(crate) fn result(&self) -> IntRect {
        self.steps.last().map_or(IntRect::EMPTY, |step| step.wanted)
    }

    fn find_subregions(&mut self) {
        let filter = Arc::clone(&self.filter);
        for (index, primitive) in filter.primitives.iter().enumerate() {
            let own = primitive.subregion.map_or(self.region, |rect| self.grid.pixels(rect).intersect(self.region));
            let subregion = match primitive.kind {
                // It has no subregion of its own, but that of what it moves, which is moved for a tile only.
                Kind::Offset { input, .. } => match self.result_of(input, index) {
                    Some(input) => self.steps.get(input).map_or(own, |step| step.subregion),
                    None => own,
                },
                _ => own,
            };
            self.steps.push(Step { subregion, ..Step::default() });
        }
    }

    /// The index of the primitive that an input of primitive `index` names; `None` for the source.
    fn result_of(&self, input: Input, index: usize) -> Option<usize> {
        match input {
            Input::Result(result) if result < index => Some(result),
            _ => None,
        }
    }

    /// Where an input of primitive `index` is among the source graphic, which is the first, and the primitives' results.
    fn place_of(&self, input: Input, index: usize) -> usize {
        self.result_of(input, index).map_or(0, |result| result + 1)
    }

    fn find_wanted(&mut self, visible: IntRect) {
        let filter = Arc::clone(&self.filter);
        self.source = IntRect::EMPTY;
        for step in &mut self.steps {
            (step.wanted, step.source) = (IntRect::EMPTY, IntRect::EMPTY);
        }
        if let (Some(last), Some(primitive)) = (self.steps.last_mut(), filter.primitives.last()) {
            last.wanted = match primitive.kind {
                Kind::Offset { .. } => visible.intersect(self.region),
                _ => visible.intersect(last.subregion),
            };
        }
        for (index, primitive) in filter.primitives.iter().enumerate().rev() {
            let Some(Step { wanted, .. }) = self.steps.get(index).copied() else { continue };
            if wanted.is_empty() {
                continue;
            }
            for (place, input) in primitive.kind.inputs().into_iter().enumerate() {
                let area = self.read(&primitive.kind, place, input, index, wanted).intersect(self.region);
                let kept = area.intersect(self.kept);
                let in_parts = self.reads_in_parts(&primitive.kind);
                let result = self.result_of(input, index);
                let is_offset = result
                    .and_then(|result| filter.primitives.get(result))
                    .is_some_and(|primitive| matches!(primitive.kind, Kind::Offset { .. }));
                match result.and_then(|result| self.steps.get_mut(result)) {
                    Some(step) => {
                        let area = if is_offset { kept } else { kept.intersect(step.subregion) };
                        step.wanted = union(step.wanted, area);
                    }
                    None if in_parts => self.source = union(self.source, area),
                    None => {
                        self.source = union(self.source, kept);
                        if let Some(step) = self.steps.get_mut(index) {
                            step.source = union(step.source, kept);
                        }
                    }
                }
            }
        }
    }

    /// Whether a primitive reads its input part by part.
    fn reads_in_parts(&self, kind: &Kind) -> bool {
        match kind {
            Kind::GaussianBlur { deviation_x, deviation_y, .. } => {
                let (across, down) = self.blurs(*deviation_x, *deviation_y);
                !(across.is_nothing() && down.is_nothing())
            }
            Kind::DropShadow { .. } => true,
            _ => false,
        }
    }

    /// What a primitive reads of its input for the pixels `wanted`.
    fn read(&self, kind: &Kind, place: usize, input: Input, index: usize, wanted: IntRect) -> IntRect {
        match kind {
            Kind::GaussianBlur { deviation_x, deviation_y, .. } => {
                let reach = self.blurs(*deviation_x, *deviation_y);
                let reach = (reach.0.reach(), reach.1.reach());
                grown(wanted, reach, reach)
            }
            Kind::DropShadow { dx, dy, deviation_x, deviation_y, .. } => {
                let reach = self.blurs(*deviation_x, *deviation_y);
                let reach = (reach.0.reach(), reach.1.reach());
                let (dx, dy) = self.whole(*dx, *dy);
                union(wanted, grown(moved(wanted, -dx, -dy), reach, reach))
            }
            Kind::Offset { dx, dy, .. } => {
                let (dx, dy) = self.whole(*dx, *dy);
                moved(wanted, -dx, -dy)
            }
            Kind::Tile { .. } => match self.result_of(input, index) {
                Some(result) => self.subregion(result),
                None => self.region,
            },
            Kind::ConvolveMatrix { matrix, .. } => match matrix.edge_mode {
                EdgeMode::Wrap => self.region,
                _ => {
                    let (before, after) = matrix.reach();
                    grown(wanted, before, after)
                }
            },
            Kind::Morphology { radius_x, radius_y, .. } => {
                let radius = self.radii(*radius_x, *radius_y).unwrap_or((0, 0));
                grown(wanted, radius, radius)
            }
            Kind::DisplacementMap { displacement, .. } if place == 0 => {
                let reach = |scale: f32| whole_pixels((displacement.scale * scale).abs() * 0.5).saturating_add(1);
                let reach = (reach(self.grid.scale.0), reach(self.grid.scale.1));
                grown(wanted, reach, reach)
            }
            Kind::DiffuseLighting { .. } | Kind::SpecularLighting { .. } => grown(wanted, (1, 1), (1, 1)),
            _ => wanted,
        }
    }

    /// The region, if the filter has one.
    fn cut(&self) -> Option<IntRect> {
        self.filter.region.map(|_| self.region)
    }

    fn blurs(&self, deviation_x: f32, deviation_y: f32) -> (Blur, Blur) {
        (Blur::new(deviation_x * self.grid.scale.0), Blur::new(deviation_y * self.grid.scale.1))
    }

    fn whole(&self, dx: f32, dy: f32) -> (i32, i32) {
        (whole_pixels(dx * self.grid.scale.0), whole_pixels(dy * self.grid.scale.1))
    }

    /// A morphology's radii in pixels; `None` where it makes everything transparent.
    fn radii(&self, radius_x: f32, radius_y: f32) -> Option<(i32, i32)> {
        let (x, y) = (radius_x * self.grid.scale.0, radius_y * self.grid.scale.1);
        // At most so that windows do not overflow; a picture is smaller.
        let whole = |v: f32| v.round().min(1e6) as i32;
        (x > 0.0 && y > 0.0).then(|| (whole(x), whole(y)))
    }

    /// What the filter makes of the source graphic; in sRGB.
    pub(crate) fn run(&self, source: Source<'_>, work: Work) -> Result<Image> {
        let (whole, parts) = match source {
            Source::Picture(image) => (Some((Arc::new(image), ColorSpace::Srgb)), None),
            Source::Parts(parts) => (None, Some(parts)),
        };
        // The source graphic, if it is a picture, then the results of the primitives so far.
        let pictures = RefCell::new(vec![whole]);
        // The last primitive that reads each of them: it may change it, and after it the picture is dropped.
        let mut last_use = vec![0; self.steps.len() + 1];
        for (index, primitive) in self.filter.primitives.iter().enumerate() {
            for input in primitive.kind.inputs() {
                if let Some(last) = last_use.get_mut(self.place_of(input, index)) {
                    *last = index;
                }
            }
        }
        for (index, primitive) in self.filter.primitives.iter().enumerate() {
            let Some(step) = self.steps.get(index) else { break };
            let result = if step.wanted.is_empty() {
                None
            } else {
                // What is read for the last time, and once.
                let handed_over = |place: usize| {
                    let reads =
                        primitive.kind.inputs().into_iter().filter(|i| self.place_of(*i, index) == place).count();
                    reads == 1 && last_use.get(place) == Some(&index)
                };
                let parts = parts.as_deref();
                let inputs =
                    Inputs { placed: self, parts, pictures: &pictures, handed_over: &handed_over, index, work };
                let (image, space) = inputs.step(primitive, step)?;
                Some((Arc::new(image), space))
            };
            let mut pictures = pictures.borrow_mut();
            for (picture, last) in pictures.iter_mut().zip(&last_use) {
                if *last == index {
                    *picture = None;
                }
            }
            pictures.push(result);
        }
        let mut pictures = pictures.into_inner();
        if pictures.len() == 1 {
            return Ok(Image::empty());
        }
        let Some((image, space)) = pictures.pop().flatten() else { return Ok(Image::empty()) };
        let mut image = Arc::unwrap_or_clone(image);
        convert(&mut image, space, ColorSpace::Srgb, work);
        Ok(image)
    }
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::{WORK, image, noise};
    use super::super::source::tests::InParts;
    use super::super::{Channel, ColorMatrix, CompositeOperator, ConvolveMatrix, DisplacementMap, MorphologyOperator};
    use super::*;
    use crate::blend::BlendMode;
    use crate::color::Color;

    const LIMIT: IntRect = IntRect::from_ltrb(-500, -500, 500, 500);

    fn place(filter: &Filter, visible: IntRect) -> PlacedFilter {
        PlacedFilter::new(Arc::new(filter.clone()), Grid::new(Transform::IDENTITY), visible, LIMIT, 0)
    }

    fn run(filter: &Filter, source: &Image, visible: IntRect) -> Image {
        let placed = place(filter, visible);
        placed.run(Source::Picture(source.crop(placed.source()).unwrap()), WORK).unwrap().crop(visible).unwrap()
    }

    #[test]
    fn inputs_name_results_and_what_is_unknown_is_the_source() {
        let area = IntRect::from_ltrb(0, 0, 3, 1);
        let mut filter = Filter::new().with_region(area.to_rect());
        let moved = filter.add(Kind::Offset { input: Input::SourceGraphic, dx: 1.0, dy: 0.0 });
        filter.add(Kind::Merge { inputs: vec![moved, Input::Result(7)] });
        assert_eq!(run(&filter, &image(0, 0, &["#.."]), area), image(0, 0, &["##."]));
        assert_eq!(run(&Filter::new(), &image(0, 0, &["#.."]), area), image(0, 0, &["..."]));
    }

    #[test]
    fn subregions_cut_results_and_are_tiles() {
        let area = IntRect::from_ltrb(0, 0, 6, 2);
        let mut filter = Filter::new().with_region(area.to_rect());
        let flood = Primitive::from(Kind::Flood { color: Color::WHITE });
        let flood = filter.add(flood.with_subregion(Rect::from_xywh(1.0, 0.0, 1.0, 1.0)));
        assert_eq!(run(&filter, &Image::empty(), area), image(0, 0, &[".#....", "......"]));
        let moved = filter.add(Kind::Offset { input: flood, dx: 1.0, dy: 1.0 });
        assert_eq!(run(&filter, &Image::empty(), area), image(0, 0, &["......", "..#..."]));
        let _ = moved;
        let cell = Primitive::from(Kind::Merge { inputs: vec![flood] });
        let cell = filter.add(cell.with_subregion(Rect::from_xywh(0.0, 0.0, 2.0, 2.0)));
        filter.add(Kind::Tile { input: cell });
        assert_eq!(run(&filter, &Image::empty(), area), image(0, 0, &[".#.#.#", "......"]));
    }

    #[test]
    fn linear_light_is_converted_there_and_back() {
        let area = IntRect::from_ltrb(0, 0, 1, 1);
        let mut filter = Filter::new();
        let half = CompositeOperator::Arithmetic { k1: 0.0, k2: 0.5, k3: 0.5, k4: 0.0 };
        let white = filter.add(Kind::Flood { color: Color::WHITE });
        let black = filter.add(Kind::Flood { color: Color::BLACK });
        let mean = Primitive::from(Kind::Composite { top: white, bottom: black, operator: half });
        filter.add(mean.clone());
        // Arithmetic rounds down.
        assert_eq!(run(&filter, &Image::empty(), area).pixels(), [[127, 127, 127, 255]]);
        filter.primitives.pop();
        filter.add(mean.with_color_space(ColorSpace::LinearRgb));
        // 127 of 255 of the light is 187.2 in sRGB.
        assert_eq!(run(&filter, &Image::empty(), area).pixels(), [[187, 187, 187, 255]]);
    }

    /// Every kind, each reading what the last one gave.
    fn everything() -> Filter {
        let mut filter = Filter::new().with_region(Rect::from_xywh(-20.0, -10.0, 120.0, 90.0));
        let blurred =
            filter.add(Kind::GaussianBlur { input: Input::SourceGraphic, deviation_x: 2.0, deviation_y: 4.0 });
        let shadow = filter.add(Kind::DropShadow {
            input: blurred,
            dx: 5.0,
            dy: -3.5,
            deviation_x: 1.0,
            deviation_y: 6.0,
            color: Color::from_rgba(0.9, 0.3, 0.1, 0.7),
        });
        let fat = filter.add(
            Primitive::from(Kind::Morphology {
                input: shadow,
                operator: MorphologyOperator::Dilate,
                radius_x: 3.0,
                radius_y: 1.0,
            })
            .with_color_space(ColorSpace::LinearRgb),
        );
        let thin = filter.add(Kind::Morphology {
            input: fat,
            operator: MorphologyOperator::Erode,
            radius_x: 1.0,
            radius_y: 2.0,
        });
        let sharp = filter.add(Kind::ConvolveMatrix {
            input: thin,
            matrix: ConvolveMatrix {
                columns: 3,
                rows: 3,
                weights: vec![0.0, -1.0, 0.0, -1.0, 6.0, -1.0, 0.0, -2.0, 0.0],
                target_x: 0,
                target_y: 2,
                divisor: 1.0,
                bias: 0.1,
                edge_mode: EdgeMode::Duplicate,
                preserve_alpha: false,
            },
        });
        let grey = filter.add(Kind::ColorMatrix { input: sharp, matrix: ColorMatrix::hue_rotate(40.0) });
        let map = DisplacementMap { scale: 12.0, x_channel: Channel::Red, y_channel: Channel::Alpha };
        let moved = filter.add(Kind::DisplacementMap { input: grey, map: blurred, displacement: map });
        let away = filter.add(Kind::Offset { input: moved, dx: -4.0, dy: 7.0 });
        filter.add(Kind::Blend { top: away, bottom: sharp, mode: BlendMode::Multiply });
        filter
    }

    #[test]
    fn what_is_seen_does_not_depend_on_how_much_is_seen() {
        let filter = everything();
        let source = noise(IntRect::from_ltrb(-30, 5, 70, 60), 3);
        let whole = run(&filter, &source, LIMIT);
        assert!(whole.pixels().iter().filter(|pixel| **pixel != [0; 4]).count() > 2000);
        for visible in [
            IntRect::from_ltrb(0, 0, 40, 30),
            IntRect::from_ltrb(33, 20, 34, 21),
            IntRect::from_ltrb(-100, -100, -10, 100),
            IntRect::from_ltrb(60, -40, 130, 50),
            IntRect::from_ltrb(200, 200, 210, 210),
        ] {
            assert_eq!(run(&filter, &source, visible), whole.crop(visible).unwrap(), "{visible:?}");
        }
    }

    #[test]
    fn a_source_in_parts_gives_the_same_pixels() {
        let source = noise(IntRect::from_ltrb(-30, 5, 70, 60), 3);
        let input = Input::SourceGraphic;
        let one = |primitive: Primitive| {
            let mut filter = Filter::new();
            filter.add(primitive);
            filter
        };
        let blur = |input| Kind::GaussianBlur { input, deviation_x: 4.0, deviation_y: 7.0 };
        let shadow = |input| Kind::DropShadow {
            input,
            dx: 30.0,
            dy: -4.0,
            deviation_x: 5.0,
            deviation_y: 0.0,
            color: Color::from_rgba(0.9, 0.3, 0.1, 0.7),
        };
        let mut glow = Filter::new();
        let soft = glow.add(blur(Input::SourceAlpha));
        let fat = Kind::Morphology { input, operator: MorphologyOperator::Dilate, radius_x: 3.0, radius_y: 1.0 };
        let fat = glow.add(Primitive::from(fat).with_color_space(ColorSpace::LinearRgb));
        glow.add(Kind::Merge { inputs: vec![soft, fat, input] });
        let mut cast = everything();
        cast.add(Kind::Tile { input: Input::SourceAlpha });
        for (name, filter) in [
            ("blur", one(blur(input).into())),
            ("linear", one(Primitive::from(blur(input)).with_color_space(ColorSpace::LinearRgb))),
            ("alpha", one(blur(Input::SourceAlpha).into())),
            ("region", one(blur(input).into()).with_region(Rect::from_xywh(-20.0, 0.0, 80.0, 50.0))),
            ("no blur", one(Kind::GaussianBlur { input, deviation_x: 0.0, deviation_y: 0.0 }.into())),
            ("shadow", one(shadow(input).into())),
            (
                "shadow of alpha",
                one(Primitive::from(shadow(Input::SourceAlpha)).with_color_space(ColorSpace::LinearRgb)),
            ),
            ("glow", glow),
            ("everything", everything()),
            ("tile", cast),
        ] {
            for visible in [IntRect::from_ltrb(0, 0, 40, 30), IntRect::from_ltrb(-60, -40, 130, 90)] {
                let placed = place(&filter, visible);
                let parts = Source::Parts(Box::new(InParts(source.crop(placed.source()).unwrap())));
                let found = placed.run(parts, WORK).unwrap().crop(visible).unwrap();
                assert!(found == run(&filter, &source, visible), "{name} {visible:?}");
            }
        }
    }

    #[test]
    fn what_is_worked_on_in_bands_is_what_it_is_as_a_whole() {
        // 33 MiB: three bands of pictures, two of columns.
        let all = IntRect::from_ltrb(-1500, -1400, 1500, 1500);
        let input = Input::SourceGraphic;
        let weights = vec![0.0, 1.0, 2.0, -1.0, 0.5, 0.0, 1.0, 1.0, -3.0];
        let matrix = ConvolveMatrix {
            columns: 3,
            rows: 3,
            weights,
            divisor: 2.5,
            bias: 0.1,
            target_x: 1,
            target_y: 0,
            edge_mode: EdgeMode::Duplicate,
            preserve_alpha: true,
        };
        for kind in [
            Kind::DropShadow { input, dx: -30.0, dy: 9.0, deviation_x: 7.0, deviation_y: 2.0, color: Color::BLUE },
            Kind::Morphology { input, operator: MorphologyOperator::Erode, radius_x: 2.0, radius_y: 70.0 },
            Kind::Morphology { input, operator: MorphologyOperator::Dilate, radius_x: 30.0, radius_y: 1.0 },
            Kind::ConvolveMatrix { input, matrix },
        ] {
            let mut filter = Filter::new();
            filter.add(kind.clone());
            let place = |visible| {
                PlacedFilter::new(Arc::new(filter.clone()), Grid::new(Transform::IDENTITY), visible, all, u64::MAX)
            };
            let source = noise(all, 5);
            let whole = place(all).run(Source::Picture(source.clone()), WORK).unwrap();
            let placed = place(all);
            let parts = Source::Parts(Box::new(InParts(source.clone())));
            assert!(placed.run(parts, WORK).unwrap() == whole, "{kind:?}");
            // Of what is seen here there is one band.
            for top in [-1400, -900, -450, 0, 20, 500, 950, 1400] {
                let visible = IntRect::from_ltrb(-1500, top, 1500, top + 100);
                let placed = place(visible);
                let found = placed.run(Source::Picture(source.crop(placed.source()).unwrap()), WORK).unwrap();
                assert!(found.crop(visible).unwrap() == whole.crop(visible).unwrap(), "{kind:?} {top}");
            }
        }
    }

    #[test]
    fn pictures_in_between_are_as_wide_as_fits() {
        let visible = IntRect::from_ltrb(0, 0, 3000, 3000);
        let limit = IntRect::from_ltrb(-6000, -6000, 9000, 9000);
        let place = |filter: &Filter| {
            PlacedFilter::new(Arc::new(filter.clone()), Grid::new(Transform::IDENTITY), visible, limit, 11_000_000)
        };
        let blur = |input| Kind::GaussianBlur { input, deviation_x: 500.0, deviation_y: 500.0 };
        // A single blur's source may be as large as it likes.
        let mut filter = Filter::new();
        let first = filter.add(blur(Input::SourceGraphic));
        let single = place(&filter);
        assert!(single.source().width() > 5900 && single.kept == limit);
        assert_eq!(single.most_of_source(), ALWAYS_WHOLE);
        // What a second one reads may not; what the first reads for that may.
        filter.add(blur(first));
        let double = place(&filter);
        let between = double.steps[0].wanted;
        assert!(between.contains(visible) && (10_500_000..=11_000_000).contains(&pixels(between)), "{between:?}");
        assert_eq!((double.source().left, double.result()), (between.left - (0 - single.source().left), visible));
        // Nor may what others read.
        let mut filter = Filter::new();
        let input = Input::SourceGraphic;
        filter.add(Kind::Morphology { input, operator: MorphologyOperator::Erode, radius_x: 2000.0, radius_y: 2000.0 });
        let source = place(&filter).source();
        assert!(source.contains(visible) && (10_500_000..=11_000_000).contains(&pixels(source)), "{source:?}");
        // An offset asks for no more pixels than it gives.
        let mut filter = Filter::new();
        let first = filter.add(blur(Input::SourceGraphic));
        filter.add(Kind::Offset { input: first, dx: 2000.0, dy: 0.0 });
        assert_eq!(place(&filter).steps[0].wanted.left, -2000);
    }

    #[test]
    fn only_what_matters_of_the_source_is_asked_for() {
        let mut filter = Filter::new();
        let blurred =
            filter.add(Kind::GaussianBlur { input: Input::SourceGraphic, deviation_x: 1.0, deviation_y: 0.0 });
        filter.add(Kind::Offset { input: blurred, dx: 10.0, dy: 0.0 });
        let placed = place(&filter, IntRect::from_ltrb(0, 0, 5, 5));
        assert_eq!(placed.source(), IntRect::from_ltrb(-13, 0, -2, 5));
        // Far away, and nothing.
        let placed = place(&filter.clone().with_region(Rect::from_xywh(50.0, 0.0, 9.0, 9.0)), placed.source());
        assert!(placed.source().is_empty() && placed.result().is_empty());
    }
}
