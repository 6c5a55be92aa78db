//! Paints: what colour each pixel of a shape gets.

mod bicubic;
mod bilinear;
pub(crate) mod fetch;
mod gradient;
mod pattern;
mod plane;
pub(crate) mod prepare;
mod ramp;
mod shader;
mod taps;
#[cfg(test)]
mod tests;

pub(crate) use fetch::fetch_block;
pub(crate) use prepare::PreparedPaint;
pub use shader::{
    FilterQuality, GradientStop, LinearGradient, Pattern, RadialGradient, Shader, SpreadMode, SweepGradient,
};
