//! Everything that is tested through the public surface, in one binary.

#[cfg(feature = "cli")]
mod cli;
#[cfg(all(feature = "svg", feature = "codec"))]
mod svg;
