//! The choices of a drawing call that say how an outline becomes coverage.

/// Which points a self-crossing or nested outline encloses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum FillRule {
    /// Those around which the outline's windings do not add up to zero.
    #[default]
    NonZero,
    /// Those from which a ray crosses the outline an odd number of times.
    EvenOdd,
}

/// How partly covered pixels are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Antialias {
    /// The exact area that the outline covers of the pixel, from signed areas: exact for every pixel
    /// that one outline passes through; where edges cross inside a pixel, the sum of their areas
    /// stands for the union. The default.
    #[default]
    Analytic,
    /// As [`Antialias::Analytic`], with outlines cut where they cross and freed of what lies inside, by the fill rule: within
    /// 4/255 of the true area also where they cross. Takes 1 to 2 times as long, strokes of long noisy lines four times. A shape that crosses itself so often
    /// that it would take far longer (of 8,000 random corners, say, or of more than a million), or that reaches a million pixels far, is drawn as by `Analytic`.
    Exact,
    /// n × n samples a pixel on a regular grid, n in 1 ..= 16 (others are clamped). 4 is
    /// tiny-skia's own sampling.
    Supersample(u8),
    /// A pixel is covered where its centre is inside; a centre on the outline belongs to the pixel to
    /// the right of or below the edge. Strokes of width 0 are Bresenham lines.
    None,
}

impl Antialias {
    /// Where in a pixel the samples lie, from its top left corner, a row after another: of
    /// [`Supersample`](Self::Supersample) the centres of n × n equal squares, of [`None`](Self::None) the pixel's
    /// centre. The other modes compute areas and have none.
    pub fn sample_positions(self) -> Vec<(f32, f32)> {
        let n = match self {
            Self::Analytic | Self::Exact => 0,
            Self::Supersample(n) => n.clamp(1, 16),
            Self::None => 1,
        };
        let at = |i: u8| (f32::from(i) + 0.5) / f32::from(n);
        (0..n).flat_map(|row| (0..n).map(move |column| (at(column), at(row)))).collect()
    }
}
