//! How far rastrum may lie from tiny-skia and from the truth: every limit of these tests, in one table.
//!
//! Raising a limit is a decision: its reason belongs beside it. All differences are in 1/255 of a channel of
//! premultiplied pixels. An edge pixel is one that some outline covers in part, or a neighbour of one; all
//! others are interior.

/// What about a scene decides which limits apply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Group {
    /// Straight edges that do not cross.
    Straight,
    /// Straight edges that cross each other.
    Crossing,
    /// Curved edges.
    Curved,
    /// Strokes along curves, and with round caps and joins.
    CurvedStroke,
    /// Strokes at most a pixel wide, which tiny-skia draws by another method.
    Hairline,
    /// Images that are enlarged, reduced or turned.
    Image,
    /// Images under a paint's opacity.
    FadedImage,
    /// Images that are not opaque, by the cubic filter.
    OvershootingImage,
    /// The blend mode `Color`, which often clips colours that its change of luminosity took below 0.
    ClippedColor,
}

pub(super) struct Limits {
    pub(super) group: Group,
    /// The largest difference of an interior pixel from tiny-skia's.
    pub(super) interior: u8,
    /// The share of interior pixels whose difference may exceed 1, where `interior` does.
    pub(super) interior_above_one: f64,
    /// With 4 × 4 samples: the share of edge pixels that may differ from tiny-skia's by more than 2.
    pub(super) sampled_above_two: f64,
    /// With 4 × 4 samples: the largest difference of an edge pixel.
    pub(super) sampled_largest: u8,
    /// With exact areas: the band around tiny-skia's value in which edge pixels lie.
    pub(super) band: u8,
    /// The share of edge pixels that may lie outside the band.
    pub(super) outside_band: f64,
    /// With exact areas: the mean signed difference from the truth, either way, of partly covered pixels.
    pub(super) signed_error: f64,
    /// With exact areas: their mean absolute difference from the truth. That it is less than tiny-skia's is asked of
    /// every scene.
    pub(super) error: f64,
}

/// What is the same for most groups.
///
/// *Interior.* Both libraries round to nearest once or twice, in different places: 1.
///
/// *Sampled.* Both count the same 16 samples. tiny-skia turns n of them into 16 n, less 1 for a whole last row, rastrum
/// into 255 n / 16: at most 1 apart, and 1 for rounding makes 2. More means that a sample fell to the other side of an
/// edge, 16 apart. tiny-skia cuts an edge's x at its first row down to 1/64 of a sample and adds a slope of 16 binary
/// digits from row to row; rastrum's crossings are exact. With about 4 rows of samples and up to 2 edges a pixel, a
/// few in a hundred pixels have a crossing that close to a sample.
///
/// *Band.* 16 samples are off by up to 1/8 at a slanted edge, 32, and by up to 1/4 at one along the rows or
/// columns, 64.
///
/// *Errors.* Rounding to 8 bits errs by ¼ on average, either way.
const COMMON: Limits = Limits {
    group: Group::Straight,
    interior: 1,
    interior_above_one: 0.0,
    sampled_above_two: 0.03,
    sampled_largest: 33,
    band: 64,
    outside_band: 0.0,
    signed_error: 0.15,
    error: 0.35,
};

const TABLE: [Limits; 9] = [
    // Positions are rounded to 1/256 pixel: edges along rows or columns, and both sides of a shape thinner than a
    // pixel, can all err by ½ the same way.
    Limits { group: Group::Straight, signed_error: 1.0, error: 1.0, ..COMMON },
    // Where edges cross inside a pixel, exact areas stand in for the union, and may be off by the whole pixel.
    Limits { group: Group::Crossing, outside_band: 0.01, signed_error: 1.3, error: 3.0, ..COMMON },
    // tiny-skia cuts curves into few pieces, a quarter of a pixel off in places, and its circles are made of
    // quadratics: up to 4 samples a pixel, and its own mean error is up to 19. rastrum's pieces are within 1/20 pixel.
    Limits {
        group: Group::Curved,
        sampled_above_two: 0.27,
        sampled_largest: 65,
        band: 80,
        signed_error: 0.8,
        error: 2.0,
        ..COMMON
    },
    // The same on both sides of the line, and tiny-skia's approximation of the offset curve as well.
    Limits {
        group: Group::CurvedStroke,
        sampled_above_two: 0.28,
        sampled_largest: 112,
        band: 112,
        signed_error: 0.6,
        error: 2.3,
        ..COMMON
    },
    // tiny-skia walks along such lines and shares one pixel between two neighbours a step, whatever the slope: a
    // slanted line is thinner than a pixel by the cosine of its angle.
    Limits { group: Group::Hairline, sampled_above_two: 0.40, sampled_largest: 128, band: 128, error: 1.2, ..COMMON },
    // rastrum's colours have 8 bits before they are blended, and the bilinear filter weights of 1/256, where tiny-skia
    // has `f32` throughout: now and then another half.
    Limits { group: Group::Image, interior: 2, interior_above_one: 0.0015, ..COMMON },
    // In partly covered pixels tiny-skia forgets the opacity: it keeps it where it then puts the coverage
    // (`current_coverage`, which both stages of its pipeline read), and so draws coverage squared.
    Limits {
        group: Group::FadedImage,
        interior: 2,
        interior_above_one: 0.0015,
        sampled_above_two: 0.23,
        sampled_largest: 105,
        band: 110,
        ..COMMON
    },
    // The cubic filter overshoots. tiny-skia clamps components to 1, which leaves them above their alpha (its stage is
    // called `clamp_a`, and clamps to the alpha in its model); rastrum clamps them to the alpha.
    Limits { group: Group::OvershootingImage, interior: 5, interior_above_one: 0.02, ..COMMON },
    // W3C's `ClipColor` pulls a colour towards its grey if its smallest component is below 0. tiny-skia looks at its
    // largest component, and then clamps to 0, which changes the luminosity.
    Limits { group: Group::ClippedColor, interior: 2, interior_above_one: 0.004, ..COMMON },
];

impl Limits {
    pub(super) fn of(group: Group) -> &'static Self {
        TABLE.iter().find(|limits| limits.group == group).unwrap()
    }
}
