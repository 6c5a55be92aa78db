//! The fixed-function state of a draw: what the stages do besides running shaders.

use crate::geom::IntRect;

/// Which triangles are dropped by the side that faces the viewer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Cull {
    /// None: both sides are drawn.
    #[default]
    None,
    /// Those seen from the front.
    Front,
    /// Those seen from the back.
    Back,
}

/// The winding, as the viewer sees it, of a triangle's front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrontFace {
    /// Counter-clockwise, as in OpenGL.
    #[default]
    CounterClockwise,
    /// Clockwise.
    Clockwise,
}

/// A comparison of the incoming value with the stored or reference one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Compare {
    /// Never passes.
    Never,
    /// incoming < stored
    #[default]
    Less,
    /// incoming = stored
    Equal,
    /// incoming ≤ stored
    LessEqual,
    /// incoming > stored
    Greater,
    /// incoming ≠ stored
    NotEqual,
    /// incoming ≥ stored
    GreaterEqual,
    /// Always passes.
    Always,
}

impl Compare {
    /// All eight, in order of declaration.
    pub const ALL: [Self; 8] = [
        Self::Never,
        Self::Less,
        Self::Equal,
        Self::LessEqual,
        Self::Greater,
        Self::NotEqual,
        Self::GreaterEqual,
        Self::Always,
    ];

    /// Whether `incoming` passes against `stored`.
    #[inline(always)]
    pub fn passes<T: PartialOrd>(self, incoming: T, stored: T) -> bool {
        match self {
            Self::Never => false,
            Self::Less => incoming < stored,
            Self::Equal => incoming == stored,
            Self::LessEqual => incoming <= stored,
            Self::Greater => incoming > stored,
            Self::NotEqual => incoming != stored,
            Self::GreaterEqual => incoming >= stored,
            Self::Always => true,
        }
    }
}

/// The depth test, depth writes, and what is done to depths before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Depth {
    /// How an incoming depth is compared with the stored one; [`Compare::Always`] turns the test off.
    pub compare: Compare,
    /// Whether passing fragments store their depth.
    pub write: bool,
    /// Polygon offset: added is `bias_slope` · m + `bias_units` · r, where m is the larger of |∂z/∂x| and |∂z/∂y| per
    /// pixel and r the smallest step that the depth format resolves at the triangle's largest depth. Default 0.
    pub bias_slope: f32,
    /// See [`Depth::bias_slope`]. Default 0.
    pub bias_units: f32,
    /// Instead of clipping at the near and far planes, clamps depths to the viewport's depth range. Default false.
    pub clamp: bool,
    /// What is stored: depth as projected, or its logarithm.
    pub mapping: DepthMapping,
}

impl Default for Depth {
    fn default() -> Self {
        Self {
            compare: Compare::Less,
            write: true,
            bias_slope: 0.0,
            bias_units: 0.0,
            clamp: false,
            mapping: DepthMapping::Projected,
        }
    }
}

impl Depth {
    /// No test and no write.
    pub const OFF: Self = Self {
        compare: Compare::Always,
        write: false,
        bias_slope: 0.0,
        bias_units: 0.0,
        clamp: false,
        mapping: DepthMapping::Projected,
    };

    /// The default with another comparison.
    pub fn compare(compare: Compare) -> Self {
        Self { compare, ..Self::default() }
    }
}

/// How a fragment's depth follows from its place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum DepthMapping {
    /// The projected depth z / w, moved to the viewport's depth range: linear in screen space.
    #[default]
    Projected,
    /// log₂(w / near) / log₂(far / near), per fragment, where w is the clip-space w (the distance along the view axis
    /// for the perspective matrices here): an even relative resolution between `near` and `far`, which are both
    /// above 0 and differ. Anything else is taken as [`DepthMapping::Projected`].
    Logarithmic {
        /// The w that maps to 0.
        near: f32,
        /// The w that maps to 1.
        far: f32,
    },
}

/// What becomes of a stencil value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum StencilOp {
    /// It stays.
    #[default]
    Keep,
    /// 0
    Zero,
    /// The reference value.
    Replace,
    /// One more, up to 255.
    IncrementClamp,
    /// One less, down to 0.
    DecrementClamp,
    /// All bits turned over.
    Invert,
    /// One more; 255 becomes 0.
    IncrementWrap,
    /// One less; 0 becomes 255.
    DecrementWrap,
}

impl StencilOp {
    /// All eight, in order of declaration.
    pub const ALL: [Self; 8] = [
        Self::Keep,
        Self::Zero,
        Self::Replace,
        Self::IncrementClamp,
        Self::DecrementClamp,
        Self::Invert,
        Self::IncrementWrap,
        Self::DecrementWrap,
    ];

    /// The new value for the stored one.
    #[inline(always)]
    pub fn apply(self, stored: u8, reference: u8) -> u8 {
        match self {
            Self::Keep => stored,
            Self::Zero => 0,
            Self::Replace => reference,
            Self::IncrementClamp => stored.saturating_add(1),
            Self::DecrementClamp => stored.saturating_sub(1),
            Self::Invert => !stored,
            Self::IncrementWrap => stored.wrapping_add(1),
            Self::DecrementWrap => stored.wrapping_sub(1),
        }
    }
}

/// The stencil test of one side of triangles.
///
/// The test compares `reference & read_mask` (the incoming value) with `stored & read_mask`; the operation changes
/// the bits of `write_mask` alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StencilFace {
    /// The comparison, with the reference as the incoming value.
    pub compare: Compare,
    /// The reference value.
    pub reference: u8,
    /// The bits that are compared.
    pub read_mask: u8,
    /// The bits that may change.
    pub write_mask: u8,
    /// Where the stencil test fails.
    pub fail: StencilOp,
    /// Where it passes and the depth test fails.
    pub depth_fail: StencilOp,
    /// Where both pass.
    pub pass: StencilOp,
}

impl Default for StencilFace {
    /// Always passes and keeps what is stored.
    fn default() -> Self {
        Self {
            compare: Compare::Always,
            reference: 0,
            read_mask: 255,
            write_mask: 255,
            fail: StencilOp::Keep,
            depth_fail: StencilOp::Keep,
            pass: StencilOp::Keep,
        }
    }
}

impl StencilFace {
    /// Whether the test passes against a stored value.
    #[inline(always)]
    pub fn passes(&self, stored: u8) -> bool {
        self.compare.passes(self.reference & self.read_mask, stored & self.read_mask)
    }

    /// The value that replaces `stored`.
    #[inline(always)]
    pub fn update(&self, op: StencilOp, stored: u8) -> u8 {
        let new = op.apply(stored, self.reference);
        (stored & !self.write_mask) | (new & self.write_mask)
    }
}

/// The stencil tests of both sides.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stencil {
    /// Triangles seen from the front, lines and points.
    pub front: StencilFace,
    /// Triangles seen from the back.
    pub back: StencilFace,
}

impl Stencil {
    /// The same test on both sides.
    pub fn both(face: StencilFace) -> Self {
        Self { front: face, back: face }
    }
}

/// How a fragment's colour meets the stored one. Colours are premultiplied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Blend {
    /// The fragment replaces what is there.
    #[default]
    Replace,
    /// s + d · (1 − sa), rounded to nearest.
    SourceOver,
    /// min(s + d, 255)
    Additive,
    /// min(s, d) of each component.
    Min,
    /// max(s, d) of each component.
    Max,
    /// s · d, rounded to nearest.
    Multiply,
}

/// What is drawn of a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fill {
    /// All of it.
    #[default]
    Solid,
    /// Its three sides, one pixel wide.
    Wireframe,
    /// Its three corners.
    Points,
}

/// The state of a draw. The default draws opaque triangles, both sides, with a depth test.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Which side is dropped. Default: none.
    pub cull: Cull,
    /// Which winding is the front. Default: counter-clockwise as seen.
    pub front_face: FrontFace,
    /// Depth test and writes.
    pub depth: Depth,
    /// The stencil test; `None` (the default) leaves stencil values alone.
    pub stencil: Option<Stencil>,
    /// Device pixels outside are not drawn. Default: `None`.
    pub scissor: Option<IntRect>,
    /// Fragments whose alpha (0 ..= 255) fails against the value are dropped, before stencil and depth. Default: `None`.
    pub alpha_test: Option<(Compare, u8)>,
    /// Blending.
    pub blend: Blend,
    /// Which of red, green, blue and alpha are written. Default: all.
    pub color_mask: [bool; 4],
    /// What is drawn of triangles.
    pub fill: Fill,
    /// The side in pixels of points, 1 ..= 4096. Default 1.
    pub point_size: f32,
    /// The bits after the binary point of screen positions, 1 ..= 8: coarser ones round to a coarser grid, which
    /// shows what snapping does. Default 8.
    pub subpixel_bits: u32,
    /// Every pixel that a triangle touches is drawn instead of those whose centre is inside: a superset, by moving
    /// each edge outwards by half a pixel's extent. Default false.
    pub conservative: bool,
    /// Whether tiles are skipped by their nearest and farthest depth. The picture is the same. Default true.
    pub hierarchical_depth: bool,
}

impl Default for State {
    fn default() -> Self {
        Self {
            cull: Cull::None,
            front_face: FrontFace::CounterClockwise,
            depth: Depth::default(),
            stencil: None,
            scissor: None,
            alpha_test: None,
            blend: Blend::Replace,
            color_mask: [true; 4],
            fill: Fill::Solid,
            point_size: 1.0,
            subpixel_bits: 8,
            conservative: false,
            hierarchical_depth: true,
        }
    }
}
