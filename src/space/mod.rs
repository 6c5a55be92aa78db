//! The 3D pipeline, stage by stage: vertices, clipping, set-up, traversal, depth, fragments, framebuffer.
//!
//! [`Pipeline::draw`] takes [`Primitives`], a [`VertexShader`] and a [`FragmentShader`] and draws onto a [`Target`]. Clip space is
//! that of OpenGL (x right, y up, z from −w at the near plane to w at the far one); device pixels have y down, pixel (0, 0) covers the
//! unit square at the origin, and its centre is at (½, ½). Positions are snapped to 1/256 pixel; a pixel is drawn where its centre is inside,
//! and on an edge by the top-left rule, so that triangles that share an edge draw each pixel exactly once.
//!
//! The scene on top of it, with nodes, materials and lights, is [`crate::scene`].

mod assembly;
mod batch;
mod bin;
pub mod camera;
mod clip;
pub mod compress;
mod counters;
mod depth;
mod fragment;
mod hiz;
mod msaa;
mod pipeline;
mod setup;
mod shade;
mod state;
mod target;
mod test;
mod texture;
mod traverse;
mod vertex;

pub use assembly::{Primitives, Topology};
pub use clip::{ClipPlane, ClipVertex, clip_polygon, clip_segment, clip_triangle};
pub use counters::Counters;
pub use depth::DepthFormat;
pub use fragment::{
    Fragment, FragmentShader, Fragments, PixelFn, PrimitiveIds, Shade, Solid, VertexColor, pack, pixel_fn, unpack,
};
pub use msaa::Samples;
pub use pipeline::Pipeline;
pub use state::{Blend, Compare, Cull, Depth, DepthMapping, Fill, FrontFace, State, Stencil, StencilFace, StencilOp};
pub use target::{Accumulation, Frames, Target};
pub use texture::{Address, Filter, Sampler, Texture};
pub use vertex::{ClipDepth, MAX_VARYINGS, VertexFn, VertexShader, Viewport, vertex_fn};
