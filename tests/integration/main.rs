//! Tests through the public API alone, against slow and obvious versions of the same.

#![allow(clippy::unwrap_used, reason = "a failed unwrap is a failed test")]

#[path = "../oracle/mod.rs"]
mod oracle;

mod accuracy;
mod architecture;
mod bad_input;
mod canvas;
mod canvas_pixels;
#[cfg(feature = "cli")]
mod cli;
mod determinism;
#[cfg(all(feature = "svg", feature = "codec"))]
mod fixtures;
#[cfg(feature = "cli")]
mod gallery;
#[cfg(all(feature = "svg", feature = "codec"))]
mod golden;
#[cfg(feature = "cli")]
mod hostile;
#[cfg(feature = "mesh")]
mod models;
mod reference;
mod scene_on_canvas;
mod seeds_culling;
mod seeds_fragments;
mod seeds_interpolation;
mod seeds_lines;
mod seeds_pipeline;
mod seeds_polygons;
mod seeds_sampling;
mod seeds_scene;
mod seeds_shadows;
mod seeds_triangles;
mod space_support;
#[cfg(all(feature = "text", feature = "codec"))]
mod suite;
#[cfg(all(feature = "svg", feature = "codec"))]
mod svg;
