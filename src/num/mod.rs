//! Numbers and machinery: fixed point, reproducible trigonometry, SIMD lanes and levels, threads.

pub(crate) mod fixed;
pub(crate) mod lanes;
pub(crate) mod level;
pub(crate) mod trig;
