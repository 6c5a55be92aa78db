//! Samples of a pixel: how many, and where.

/// The samples of each pixel of a [`Target`](super::Target).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Samples {
    /// One, at the centre: the default.
    #[default]
    One,
    /// Multisampling with 2 samples, each with a colour, a depth and a stencil value.
    Msaa2,
    /// Multisampling with 4 samples.
    Msaa4,
    /// Multisampling with 8 samples.
    Msaa8,
    /// Coverage-rich: 16 coverage samples that share 4 colours (CSAA 16×). Depth and stencil are kept for every coverage sample.
    Csaa16x4,
    /// Coverage-rich: 8 coverage samples that share 4 colours (EQAA 4f/8s).
    Eqaa8x4,
}

/// Positions in 1/16 pixel from the pixel's top left corner.
type Positions = &'static [(u8, u8)];

/// The standard positions of Direct3D 11.1 for 2, 4 and 8 samples (*Direct3D 11.3 Functional Specification*, 19.2.4.1).
const TWO: Positions = &[(12, 12), (4, 4)];
const FOUR: Positions = &[(6, 2), (14, 6), (2, 10), (10, 14)];
const EIGHT: Positions = &[(9, 5), (7, 11), (13, 9), (5, 3), (3, 13), (1, 7), (11, 15), (15, 1)];
const SIXTEEN: Positions = &[
    (9, 9),
    (7, 5),
    (5, 10),
    (12, 7),
    (3, 6),
    (10, 13),
    (13, 11),
    (11, 3),
    (6, 14),
    (8, 1),
    (4, 2),
    (2, 12),
    (0, 8),
    (15, 4),
    (14, 15),
    (1, 0),
];

impl Samples {
    /// Every kind.
    pub const ALL: [Self; 6] = [Self::One, Self::Msaa2, Self::Msaa4, Self::Msaa8, Self::Csaa16x4, Self::Eqaa8x4];

    /// Coverage samples of a pixel.
    pub fn coverage(self) -> usize {
        self.positions().len()
    }

    /// Colours kept for a pixel.
    pub fn colors(self) -> usize {
        match self {
            Self::Csaa16x4 | Self::Eqaa8x4 => 4,
            _ => self.coverage(),
        }
    }

    /// Whether there are fewer colours than coverage samples.
    pub(crate) fn is_coverage_rich(self) -> bool {
        self.colors() < self.coverage()
    }

    /// The number of samples where there are 2, 4 or 8, each with a colour.
    pub(crate) fn even(self) -> Option<usize> {
        matches!(self, Self::Msaa2 | Self::Msaa4 | Self::Msaa8).then_some(self.colors())
    }

    /// Where the coverage samples lie, in 1/16 pixel from the pixel's top left corner, x then y: the standard
    /// positions of Direct3D 11.1.
    pub fn positions(self) -> &'static [(u8, u8)] {
        match self {
            Self::One => &[(8, 8)],
            Self::Msaa2 => TWO,
            Self::Msaa4 => FOUR,
            Self::Msaa8 | Self::Eqaa8x4 => EIGHT,
            Self::Csaa16x4 => SIXTEEN,
        }
    }
}
