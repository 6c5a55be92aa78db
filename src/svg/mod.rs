//! SVG files, drawn through the canvas.
//!
//! [`usvg`] parses the file and resolves its references, styles, units and text; this module draws
//! the tree that it makes. What cannot be drawn is named in a [`Warning`] and never left out in
//! silence.

mod clip;
mod convert;
mod filter;
mod group;
mod image;
mod limits;
mod links;
mod pattern;
mod read;
mod render;
mod shape;
mod warning;

pub use limits::ParseLimits;
pub use links::image_resolver;
pub use read::{parse, parse_with_limits, unpack};
pub use usvg;
pub use warning::{Warning, WarningKind};

use crate::canvas::Canvas;
use crate::geom::Transform;
use crate::style::Antialias;

/// How an SVG tree is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// How shapes are antialiased unless they ask not to be (`shape-rendering`). The default is
    /// [`Antialias::Analytic`].
    pub antialias: Antialias,
}

impl Settings {
    /// The same with the given antialiasing.
    #[must_use]
    pub fn with_antialias(self, antialias: Antialias) -> Self {
        Self { antialias }
    }
}

/// Draws an SVG tree with the default [`Settings`].
///
/// `transform` maps the tree's space, (0, 0) to its size, to the canvas's user space; the picture is not
/// clipped to the tree's size. The result names what could not be drawn, each thing once.
pub fn render(tree: &usvg::Tree, transform: Transform, canvas: &mut Canvas<'_>) -> Vec<Warning> {
    render_with(tree, transform, &Settings::default(), canvas)
}

/// Draws an SVG tree as [`render`] does, with settings.
pub fn render_with(
    tree: &usvg::Tree,
    transform: Transform,
    settings: &Settings,
    canvas: &mut Canvas<'_>,
) -> Vec<Warning> {
    let mut renderer = render::Renderer::new(settings);
    canvas.save();
    canvas.transform(transform);
    renderer.draw_children(tree.root(), canvas);
    canvas.restore();
    renderer.into_warnings()
}

/// Draws one element of a tree at the place where the whole tree would show it, without the opacity,
/// clips and masks of the groups around it.
pub fn render_node(
    node: &usvg::Node,
    transform: Transform,
    settings: &Settings,
    canvas: &mut Canvas<'_>,
) -> Vec<Warning> {
    let mut renderer = render::Renderer::new(settings);
    // A group's absolute transform holds its own, which drawing the group applies again.
    let own = match node {
        usvg::Node::Group(group) => convert::transform(group.transform()),
        _ => Transform::IDENTITY,
    };
    if let Some(undo) = own.invert() {
        canvas.save();
        canvas.transform(transform);
        canvas.transform(convert::transform(node.abs_transform()).pre_concat(undo));
        renderer.draw_node(node, canvas);
        canvas.restore();
    }
    renderer.into_warnings()
}
