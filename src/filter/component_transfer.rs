//! Each straight component by a function of its own.

use super::image::{Image, Work};
use crate::color::unit;
use crate::error::Result;
use crate::geom::IntRect;
use crate::num::trig;

/// A function of one component in 0 ..= 1; results are clamped to that.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum TransferFunction {
    /// The component itself.
    #[default]
    Identity,
    /// Straight lines between values at equal distances. None is the identity.
    Table(Vec<f32>),
    /// As many steps as there are values. None is the identity.
    Discrete(Vec<f32>),
    /// slope · C + intercept.
    Linear {
        /// How steep the line is.
        slope: f32,
        /// The result at 0.
        intercept: f32,
    },
    /// amplitude · C ^ exponent + offset.
    Gamma {
        /// The factor.
        amplitude: f32,
        /// The exponent.
        exponent: f32,
        /// What is added.
        offset: f32,
    },
}

impl TransferFunction {
    fn apply(&self, c: f64) -> f64 {
        match self {
            Self::Identity => c,
            Self::Table(values) => {
                let position = c * values.len().saturating_sub(1) as f64;
                let index = position.floor();
                let value = |i: usize| values.get(i).or(values.last()).copied().map_or(c, f64::from);
                let (low, high) = (value(index as usize), value(index as usize + 1));
                low + (high - low) * (position - index)
            }
            Self::Discrete(values) => {
                let index = (c * values.len() as f64).floor() as usize;
                values.get(index).or(values.last()).copied().map_or(c, f64::from)
            }
            Self::Linear { slope, intercept } => f64::from(*slope) * c + f64::from(*intercept),
            Self::Gamma { amplitude, exponent, offset } => {
                f64::from(*amplitude) * trig::pow(c, f64::from(*exponent)) + f64::from(*offset)
            }
        }
    }

    /// The result for each of the 256 values of a component; a result that is not a number is 0.
    fn table(&self) -> [u8; 256] {
        std::array::from_fn(|v| (unit(self.apply(v as f64 / 255.0) as f32) * 255.0 + 0.5) as u8)
    }
}

/// The functions of red, green, blue and alpha applied to a picture, in `area`.
pub(super) fn component_transfer(
    image: Image,
    area: IntRect,
    functions: &[TransferFunction; 4],
    work: Work,
) -> Result<Image> {
    let tables = functions.each_ref().map(TransferFunction::table);
    // Whether transparent pixels become visible.
    let fills = tables[3][0] > 0;
    let mut image = if fills { image.with_bounds(area)? } else { image.within(area) };
    image.map_straight(work, |pixel| std::array::from_fn(|c| tables[c][usize::from(pixel[c])]));
    Ok(image)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(function: TransferFunction, values: [usize; 4]) -> [u8; 4] {
        let table = function.table();
        values.map(|v| table[v])
    }

    #[test]
    fn functions_of_the_specification() {
        use TransferFunction as F;
        assert_eq!(at(F::Identity, [0, 1, 100, 255]), [0, 1, 100, 255]);
        assert_eq!(at(F::Table(vec![]), [0, 1, 100, 255]), [0, 1, 100, 255]);
        assert_eq!(at(F::Table(vec![0.4]), [0, 1, 100, 255]), [102; 4]);
        // Down to 0 in the middle and up again: 51 is a fifth of the way, so 1 − 2/5.
        assert_eq!(at(F::Table(vec![1.0, 0.0, 1.0]), [0, 51, 204, 255]), [255, 153, 153, 255]);
        assert_eq!(at(F::Discrete(vec![0.2, 0.8]), [0, 127, 128, 255]), [51, 51, 204, 204]);
        assert_eq!(at(F::Linear { slope: 2.0, intercept: -0.2 }, [0, 51, 102, 255]), [0, 51, 153, 255]);
        let gamma = F::Gamma { amplitude: 0.5, exponent: 2.0, offset: 0.2 };
        // 51 is 0.2: 0.5 · 0.04 + 0.2 = 0.22.
        assert_eq!(at(gamma, [0, 51, 255, 255]), [51, 56, 179, 179]);
    }

    #[test]
    fn what_is_no_number_is_nothing() {
        let endless = TransferFunction::Gamma { amplitude: 0.0, exponent: -1.0, offset: 0.0 };
        assert_eq!(endless.table()[0], 0);
        assert_eq!(TransferFunction::Table(vec![f32::NAN, 1.0]).table()[255], 255);
        let _ = TransferFunction::Discrete(vec![f32::INFINITY]).table();
    }
}
