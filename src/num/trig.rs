//! Transcendental functions that give the same bits on every machine.
//!
//! The standard library calls the platform's C library, whose last bits differ. These come from the
//! `libm` crate, are evaluated in `f64` and are used at set-up only, never per pixel.

/// Sine and cosine of an angle in radians.
pub(crate) fn sin_cos(radians: f64) -> (f64, f64) {
    (libm::sin(radians), libm::cos(radians))
}

/// Tangent of an angle in radians.
pub(crate) fn tan(radians: f64) -> f64 {
    libm::tan(radians)
}

/// The angle of the vector (x, y) in radians, in −π ..= π.
pub(crate) fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// The angle in 0 ..= π whose cosine is `x`.
pub(crate) fn acos(x: f64) -> f64 {
    libm::acos(x)
}

/// e to the power of `x`.
pub(crate) fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// `base` to the power of `exponent`.
pub(crate) fn pow(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// The logarithm of `x` to base 2.
pub(crate) fn log2(x: f64) -> f64 {
    libm::log2(x)
}
