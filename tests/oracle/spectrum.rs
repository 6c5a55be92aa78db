//! Convolutions and spectra, straight from their definitions.

#![expect(clippy::disallowed_methods, reason = "compared with a tolerance, so that no machine's last bit matters")]

use std::f64::consts::TAU;

/// A complex number.
pub(crate) type Complex = (f64, f64);

pub(crate) fn product(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

/// The sum over k of signal[k] · e^(∓2πi·jk/n), for each j: − forwards, + backwards.
fn transform(signal: &[Complex], sign: f64) -> Vec<Complex> {
    let n = signal.len();
    let term = |j: usize, k: usize, value: Complex| {
        let angle = sign * TAU * ((j * k) % n) as f64 / n as f64;
        product(value, (angle.cos(), angle.sin()))
    };
    let add = |a: Complex, b: Complex| (a.0 + b.0, a.1 + b.1);
    (0..n).map(|j| signal.iter().enumerate().map(|(k, v)| term(j, k, *v)).fold((0.0, 0.0), add)).collect()
}

/// The discrete Fourier transform.
pub(crate) fn spectrum(signal: &[f64]) -> Vec<Complex> {
    transform(&signal.iter().map(|v| (*v, 0.0)).collect::<Vec<_>>(), -1.0)
}

/// The signal that has a spectrum, its real part.
pub(crate) fn signal(spectrum: &[Complex]) -> Vec<f64> {
    transform(spectrum, 1.0).into_iter().map(|v| v.0 / spectrum.len() as f64).collect()
}

/// The convolution of two signals of one length, which go around.
pub(crate) fn convolve(a: &[f64], b: &[f64]) -> Vec<f64> {
    let n = a.len();
    (0..n).map(|j| (0..n).map(|k| a[k] * b[(j + n - k) % n]).sum()).collect()
}
