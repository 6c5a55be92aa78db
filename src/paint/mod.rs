//! Paints: what colour each pixel of a shape gets.

mod shader;

pub use shader::{
    FilterQuality, GradientStop, LinearGradient, Pattern, RadialGradient, Shader, SpreadMode, SweepGradient,
};
