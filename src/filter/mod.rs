//! Filters: effects on whole layers, built of SVG's filter primitives.
//!
//! A [`Filter`] is a list of [`Primitive`]s that read what was drawn on a layer ([`Input::SourceGraphic`]), its alpha, or
//! results of primitives before them. A layer begun with it, by
//! [`Canvas::push_layer_with`](crate::Canvas::push_layer_with), is drawn as the last primitive's result.
//!
//! ```
//! use rastrum::filter::{Filter, Input, Kind};
//! use rastrum::{Canvas, Color, LayerOptions};
//!
//! let mut glow = Filter::new();
//! let soft = glow.add(Kind::GaussianBlur { input: Input::SourceGraphic, deviation_x: 3.0, deviation_y: 3.0 });
//! glow.add(Kind::Merge { inputs: vec![soft, Input::SourceGraphic] });
//!
//! let mut canvas = Canvas::new(64, 64)?;
//! canvas.push_layer_with(&LayerOptions::default().with_filter(glow));
//! canvas.fill_circle((32.0, 32.0), 16.0, Color::RED);
//! canvas.pop_layer();
//! let picture = canvas.into_pixmap();
//! assert_eq!(picture.pixel(32, 32), Some([255, 0, 0, 255]));
//! // Two pixels outside the disc.
//! let [r, _, _, a] = picture.pixel(50, 32).unwrap_or_default();
//! assert!(r == a && (20..120).contains(&a));
//! # Ok::<(), rastrum::Error>(())
//! ```
//!
//! Pixels are computed where they can be seen, rows in parallel, in integers or in formulas of one pixel's own position: the
//! same bytes on any number of threads and at any SIMD level.

mod blur;
mod color_matrix;
mod component_transfer;
mod composite;
mod convolve;
mod displacement;
mod drop_shadow;
mod flood;
mod graph;
mod image;
mod light;
mod lighting;
mod lines;
mod morphology;
mod offset;
mod picture;
mod run;
mod source;
mod space;
mod tile;
mod turbulence;

pub(crate) use blur::gaussian;
pub use color_matrix::ColorMatrix;
pub use component_transfer::TransferFunction;
pub use composite::CompositeOperator;
pub use convolve::{ConvolveMatrix, EdgeMode};
pub use displacement::{Channel, DisplacementMap};
pub(crate) use drop_shadow::tint;
pub use graph::{ColorSpace, Filter, Input, Kind, Primitive};
pub(crate) use image::{Image, Work};
pub use light::LightSource;
pub use lighting::{DiffuseLighting, SpecularLighting};
pub use morphology::MorphologyOperator;
pub(crate) use run::{Grid, PlacedFilter};
pub(crate) use source::{ALWAYS_WHOLE, Parts, Source, pixels, widest};
pub use turbulence::Turbulence;
