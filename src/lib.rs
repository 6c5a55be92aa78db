//! A CPU canvas: vector graphics with exact-area antialiasing, aliased primitives exact to the pixel, and the same
//! bytes at every SIMD level, thread count and machine. No `unsafe`, and no call panics, whatever it is given.
//!
//! # A first picture
//!
//! A [`Canvas`] records drawing calls and renders them together. Coordinates are pixels, y points down, pixel (0, 0) covers the
//! unit square at the origin.
//!
//! ```
//! use rastrum::{Canvas, Color, FillRule, Path, Rect, Stroke};
//!
//! let mut canvas = Canvas::new(200, 100)?;
//! canvas.clear(Color::WHITE);
//! canvas.fill_rect(Rect::from_xywh(10.0, 10.0, 80.0, 80.0), Color::from_rgb8(200, 60, 40));
//!
//! let mut hill = Path::new();
//! hill.move_to((110.0, 90.0)).quad_to((150.0, -30.0), (190.0, 90.0)).close();
//! canvas.fill_path(&hill, FillRule::NonZero, Color::from_rgb8(40, 90, 200));
//! canvas.stroke_path(&hill, &Stroke::new(3.0), Color::BLACK);
//!
//! let picture = canvas.into_pixmap();
//! assert_eq!(picture.pixel(50, 50), Some([200, 60, 40, 255]));
//! # Ok::<(), rastrum::Error>(())
//! ```
//!
//! # Paints
//!
//! Wherever a colour is taken, a [`Paint`] is: a colour, a gradient ([`LinearGradient`], [`RadialGradient`],
//! [`SweepGradient`]) or an image ([`Pattern`]), with an opacity, one of 29 [`BlendMode`]s and a way of antialiasing.
//!
//! ```
//! use rastrum::{BlendMode, Canvas, Color, GradientStop, LinearGradient, Paint, Rect};
//!
//! let mut canvas = Canvas::new(100, 20)?;
//! let stops = [GradientStop::new(0.0, Color::BLACK), GradientStop::new(1.0, Color::WHITE)];
//! canvas.fill(LinearGradient::new((0.0, 0.0), (100.0, 0.0), stops));
//! let red = Paint::new(Color::RED).with_blend_mode(BlendMode::Multiply);
//! canvas.fill_rect(Rect::from_xywh(0.0, 0.0, 100.0, 10.0), red);
//!
//! let picture = canvas.into_pixmap();
//! let ([r, _, b, _], [_, g, _, _]) = (picture.pixel(99, 5).unwrap_or_default(), picture.pixel(50, 15).unwrap_or_default());
//! assert!(r > 250 && b == 0 && g.abs_diff(128) < 3);
//! # Ok::<(), rastrum::Error>(())
//! ```
//!
//! # State, clips and layers
//!
//! [`save`](Canvas::save) and [`restore`](Canvas::restore), or the guard [`saved`](Canvas::saved), keep the transform, the
//! clip and the shadow. A layer is drawn on its own and then onto what is below, with an opacity and a blend mode.
//!
//! ```
//! use rastrum::{Antialias, BlendMode, Canvas, Color, FillRule, Path, Rect};
//!
//! let mut canvas = Canvas::new(64, 64)?;
//! {
//!     let mut canvas = canvas.saved();
//!     canvas.translate(32.0, 32.0);
//!     let mut disc = Path::new();
//!     disc.circle((0.0, 0.0), 30.0);
//!     canvas.clip_path(&disc, FillRule::NonZero, Antialias::default());
//!     canvas.push_layer(0.5, BlendMode::SourceOver);
//!     canvas.fill_rect(Rect::from_ltrb(-32.0, -32.0, 32.0, 0.0), Color::RED);
//!     canvas.fill_rect(Rect::from_ltrb(-32.0, -8.0, 32.0, 32.0), Color::BLUE);
//!     canvas.pop_layer();
//! }
//! let picture = canvas.into_pixmap();
//! // Both rectangles were drawn here; the layer's opacity counts once.
//! assert_eq!(picture.pixel(32, 28), Some([0, 0, 128, 128]));
//! assert_eq!(picture.pixel(2, 2), Some([0; 4]));
//! # Ok::<(), rastrum::Error>(())
//! ```
//!
//! # Coverage
//!
//! [`Antialias`] is chosen for each drawing call: exact areas (the default), exact areas that are also right where edges
//! cross inside a pixel, n × n samples, or pixel centres alone.
//!
//! # Pixels, without a canvas
//!
//! [`raster`] has the aliased primitives as iterators and callbacks, for grids of one's own.
//!
//! ```
//! let line: Vec<(i32, i32)> = rastrum::raster::line::bresenham((0, 0), (4, 2)).collect();
//! assert_eq!(line, [(0, 0), (1, 0), (2, 1), (3, 1), (4, 2)]);
//! ```
//!
//! # The same bytes
//!
//! [`RenderSettings`] chooses threads, the SIMD level and the height of bands. None of them changes a pixel, so that pictures
//! can be compared by equality.
//!
//! ```
//! use rastrum::{Canvas, Color, RenderSettings, SimdLevel};
//!
//! let draw = |settings: RenderSettings| -> rastrum::Result<_> {
//!     let mut canvas = Canvas::with_settings(100, 100, settings)?;
//!     canvas.fill_circle((50.0, 50.0), 40.3, Color::from_rgba8(20, 160, 90, 200));
//!     Ok(canvas.into_pixmap())
//! };
//! let one = draw(RenderSettings::default().with_threads(1).with_level(SimdLevel::Scalar))?;
//! let other = draw(RenderSettings::default().with_threads(4).with_band_height(8))?;
//! assert_eq!(one.data(), other.data());
//! # Ok::<(), rastrum::Error>(())
//! ```
//!
//! # Features
//!
//! The library alone has few dependencies: `default-features = false`. `codec` adds PNG (and JPEG, GIF, WebP in), `svg` SVG files
//! and path data, `text` text in SVG files, `parallel` threads; `cli` is the program and all of these.

mod blend;
mod canvas;
#[cfg(feature = "codec")]
mod codec;
mod color;
mod display_list;
mod error;
pub mod filter;
mod geom;
#[cfg(feature = "mesh")]
pub mod load;
mod num;
mod paint;
mod path;
mod pool;
pub mod raster;
mod render;
pub mod scene;
pub mod space;
mod style;
mod surface;
#[cfg(feature = "svg")]
pub mod svg;

pub use blend::BlendMode;
pub use canvas::{Canvas, LayerOptions, SaveGuard, Shadow};
pub use color::Color;
pub use display_list::{ImagePaint, Paint, ToPaint};
pub use error::{Error, Result};
pub use fearless_simd;
pub use geom::{IntRect, Point, Rect, Transform};
pub use glam;
pub use num::level::SimdLevel;
pub use paint::{
    FilterQuality, GradientStop, LinearGradient, Pattern, RadialGradient, Shader, SpreadMode, SweepGradient,
};
pub use path::{Dash, LineCap, LineJoin, Path, Radii, Segment, Stroke, Verb};
pub use render::RenderSettings;
pub use style::{Antialias, FillRule};
pub use surface::{Limits, Mask, MaskKind, Pixmap, PixmapMut, PixmapRef};

/// The README's example, compiled.
#[cfg(all(doctest, feature = "codec"))]
#[doc = include_str!("../README.md")]
mod readme {}
