//! What a filter is made of: primitives, their inputs and their parameters.

use std::sync::Arc;

use super::color_matrix::ColorMatrix;
use super::component_transfer::TransferFunction;
use super::composite::CompositeOperator;
use super::convolve::ConvolveMatrix;
use super::displacement::DisplacementMap;
use super::lighting::{DiffuseLighting, SpecularLighting};
use super::morphology::MorphologyOperator;
use super::turbulence::Turbulence;
use crate::blend::BlendMode;
use crate::color::Color;
use crate::geom::Rect;
use crate::surface::Pixmap;

/// A filter: what becomes of a layer before it is drawn. See the [module](crate::filter) for an example.
///
/// Lengths are in the user space in which the layer was begun. Where that space is turned or skewed against the
/// canvas, the filter works along the axes of its own space and the result is turned with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Filter {
    /// The part of user space that the filter reads and writes; widened to whole pixels. `None`, the default, is all
    /// that is visible and what of its surroundings the filter brings into view.
    pub region: Option<Rect>,
    /// The primitives, in order. The last one's result is what is drawn; without any, nothing is.
    pub primitives: Vec<Primitive>,
}

impl Filter {
    /// A filter without primitives.
    pub fn new() -> Self {
        Self::default()
    }

    /// The same with the given region, in user space.
    #[must_use]
    pub fn with_region(self, region: Rect) -> Self {
        Self { region: Some(region), ..self }
    }

    /// Adds a primitive; the answer names its result as an input of later ones.
    pub fn add(&mut self, primitive: impl Into<Primitive>) -> Input {
        self.primitives.push(primitive.into());
        Input::Result(self.primitives.len() - 1)
    }
}

/// One step of a filter.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// What it does.
    pub kind: Kind,
    /// The part of user space outside of which its result is transparent; widened to whole pixels. `None`, the
    /// default, is the filter's region. [`Kind::Offset`] is not cut by it.
    pub subregion: Option<Rect>,
    /// The space in which it computes with colours. The default is [`ColorSpace::Srgb`].
    pub color_space: ColorSpace,
}

impl Primitive {
    /// The same with the given subregion, in user space.
    #[must_use]
    pub fn with_subregion(self, subregion: Rect) -> Self {
        Self { subregion: Some(subregion), ..self }
    }

    /// The same with the given colour space.
    #[must_use]
    pub fn with_color_space(self, color_space: ColorSpace) -> Self {
        Self { color_space, ..self }
    }
}

impl From<Kind> for Primitive {
    fn from(kind: Kind) -> Self {
        Self { kind, subregion: None, color_space: ColorSpace::Srgb }
    }
}

/// Where a primitive's pixels come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Input {
    /// What was drawn on the layer.
    #[default]
    SourceGraphic,
    /// Its alpha; the colour is black.
    SourceAlpha,
    /// The result of the primitive with this index in [`Filter::primitives`]. One that does not come before the
    /// primitive which asks for it stands for [`Input::SourceGraphic`].
    Result(usize),
}

/// The space in which colours are computed with. Results are kept with 8 bits a component in either.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorSpace {
    /// sRGB, as the canvas stores it.
    #[default]
    Srgb,
    /// sRGB's primaries with components proportional to light. SVG's default.
    LinearRgb,
}

/// What a filter primitive does. Parameters that are not finite make it transparent.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Kind {
    /// One picture over another, by a blend mode.
    Blend {
        /// The upper picture.
        top: Input,
        /// The lower one.
        bottom: Input,
        /// How they meet.
        mode: BlendMode,
    },
    /// Each pixel's straight components, multiplied by a matrix.
    ColorMatrix {
        /// What it applies to.
        input: Input,
        /// The matrix.
        matrix: ColorMatrix,
    },
    /// Each straight component by a function of its own.
    ComponentTransfer {
        /// What it applies to.
        input: Input,
        /// The functions of red, green, blue and alpha.
        functions: [TransferFunction; 4],
    },
    /// Two pictures, by a Porter–Duff operator or arithmetic.
    Composite {
        /// The upper picture.
        top: Input,
        /// The lower one.
        bottom: Input,
        /// How they are combined.
        operator: CompositeOperator,
    },
    /// Weighted sums of a pixel's neighbourhood.
    ConvolveMatrix {
        /// What it applies to.
        input: Input,
        /// The weights.
        matrix: ConvolveMatrix,
    },
    /// The picture's alpha as a surface that scatters light.
    DiffuseLighting {
        /// Whose alpha it is.
        input: Input,
        /// Surface and light.
        lighting: DiffuseLighting,
    },
    /// The picture's alpha as a surface that reflects light.
    SpecularLighting {
        /// Whose alpha it is.
        input: Input,
        /// Surface and light.
        lighting: SpecularLighting,
    },
    /// Pixels moved by another picture's colours.
    DisplacementMap {
        /// What is moved.
        input: Input,
        /// The picture that says how far.
        map: Input,
        /// How to read it.
        displacement: DisplacementMap,
    },
    /// The picture over a blurred, tinted and moved copy of its alpha.
    DropShadow {
        /// What casts the shadow.
        input: Input,
        /// How far to the right it falls, in user space; whole pixels of it count.
        dx: f32,
        /// How far down it falls.
        dy: f32,
        /// Standard deviation of the blur across, in user space; see [`Kind::GaussianBlur`].
        deviation_x: f32,
        /// Standard deviation of the blur down.
        deviation_y: f32,
        /// The shadow's colour.
        color: Color,
    },
    /// One colour everywhere.
    Flood {
        /// The colour.
        color: Color,
    },
    /// A Gaussian blur.
    ///
    /// Below a standard deviation of three pixels it is the Gaussian itself, cut off at three deviations; above,
    /// three box blurs in a row, whose cost does not depend on the deviation. In a filter with a region, what leaves that on
    /// the way does not come back.
    GaussianBlur {
        /// What is blurred.
        input: Input,
        /// Standard deviation across, in user space; 0, or less than 1/20 pixel, is no blur in that direction.
        deviation_x: f32,
        /// Standard deviation down.
        deviation_y: f32,
    },
    /// A picture from elsewhere.
    Image {
        /// The picture.
        image: Arc<Pixmap>,
        /// Where it goes, in user space; it is stretched to fit, and sampled bilinearly where that takes sampling.
        destination: Rect,
    },
    /// Pictures over each other.
    Merge {
        /// The pictures, the lowest first.
        inputs: Vec<Input>,
    },
    /// Shapes made thinner or fatter.
    Morphology {
        /// What it applies to.
        input: Input,
        /// Which of the two.
        operator: MorphologyOperator,
        /// By how much across, in user space; whole pixels of it count, rounded. Where either radius is not above 0 the
        /// result is transparent.
        radius_x: f32,
        /// By how much down.
        radius_y: f32,
    },
    /// The picture, moved.
    Offset {
        /// What is moved.
        input: Input,
        /// How far to the right, in user space; whole pixels of it count.
        dx: f32,
        /// How far down.
        dy: f32,
    },
    /// The input's subregion, repeated.
    Tile {
        /// What is repeated.
        input: Input,
    },
    /// Perlin noise.
    Turbulence(Turbulence),
}

impl Kind {
    /// What it reads.
    pub(super) fn inputs(&self) -> Vec<Input> {
        match self {
            Self::Blend { top, bottom, .. } | Self::Composite { top, bottom, .. } => vec![*top, *bottom],
            Self::DisplacementMap { input, map, .. } => vec![*input, *map],
            Self::Merge { inputs } => inputs.clone(),
            Self::Flood { .. } | Self::Image { .. } | Self::Turbulence(_) => Vec::new(),
            Self::ColorMatrix { input, .. }
            | Self::ComponentTransfer { input, .. }
            | Self::ConvolveMatrix { input, .. }
            | Self::DiffuseLighting { input, .. }
            | Self::SpecularLighting { input, .. }
            | Self::DropShadow { input, .. }
            | Self::GaussianBlur { input, .. }
            | Self::Morphology { input, .. }
            | Self::Offset { input, .. }
            | Self::Tile { input } => vec![*input],
        }
    }
}
