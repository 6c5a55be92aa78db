//! The engines, each behind the same two calls.
//!
//! An engine is made from a [`Scene`] before the clock starts: paths, paints, gradients and images in its own types, the
//! target allocated and written to once. [`Engine::draw`] is what is timed: clear to white, every item, pixels complete.

mod raqote;
mod rastrum;
mod resvg;
mod tiny_skia;
mod vello;

use ::rastrum::Antialias;

use crate::scene::Scene;

/// Something that draws one scene again and again into the same pixels.
pub trait Engine {
    /// Clears the target to opaque white and draws the scene into it.
    fn draw(&mut self);

    /// The target as premultiplied RGBA8.
    fn picture(&mut self) -> Vec<u8>;
}

/// An engine and its settings: a row of the results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// With so many threads.
    Rastrum(usize),
    /// `Antialias::Exact`, on one thread.
    RastrumExact,
    /// One thread.
    Vello,
    /// As many threads as vello_cpu takes by default.
    VelloThreads,
    TinySkia,
    Raqote,
    /// Draws the SVG tree itself, not the scene made from it.
    Resvg,
}

impl Kind {
    pub const ALL: [Self; 8] = [
        Self::Rastrum(1),
        Self::Rastrum(2),
        Self::RastrumExact,
        Self::Vello,
        Self::VelloThreads,
        Self::TinySkia,
        Self::Raqote,
        Self::Resvg,
    ];

    /// The engine's crate; rastrum's other antialiasing under a name of its own.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rastrum(_) => "rastrum",
            Self::RastrumExact => "rastrum-exact",
            Self::Vello | Self::VelloThreads => "vello_cpu",
            Self::TinySkia => "tiny-skia",
            Self::Raqote => "raqote",
            Self::Resvg => "resvg",
        }
    }

    pub fn threads(self) -> usize {
        match self {
            Self::Rastrum(threads) => threads,
            // The calling thread and the workers.
            Self::VelloThreads => 1 + usize::from(vello::default_workers()),
            _ => 1,
        }
    }

    /// The engine ready to draw `scene`, or `tree`, which the scene was made from.
    pub fn prepare<'s>(self, scene: &'s Scene, tree: Option<&'s usvg::Tree>) -> Option<Box<dyn Engine + 's>> {
        Some(match self {
            Self::Rastrum(threads) => Box::new(rastrum::Prepared::new(scene, threads, Antialias::Analytic)),
            Self::RastrumExact => Box::new(rastrum::Prepared::new(scene, 1, Antialias::Exact)),
            Self::Vello => Box::new(vello::Prepared::new(scene, 0)),
            Self::VelloThreads => Box::new(vello::Prepared::new(scene, vello::default_workers())),
            Self::TinySkia => Box::new(tiny_skia::Prepared::new(scene)),
            Self::Raqote => Box::new(raqote::Prepared::new(scene)),
            Self::Resvg => Box::new(resvg::Prepared::new(scene, tree?)),
        })
    }
}
