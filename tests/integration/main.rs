//! Tests through the public API alone, against slow and obvious versions of the same.

#[path = "../oracle/mod.rs"]
mod oracle;

mod seeds_lines;
mod seeds_polygons;
