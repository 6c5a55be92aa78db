//! Clip paths: as clips of the canvas where they are one outline, else as masks.

use super::render::{Renderer, Step};
use super::{Settings, convert, shape};
use crate::blend::BlendMode;
use crate::canvas::Canvas;
use crate::color::Color;
use crate::display_list::Paint;
use crate::geom::{Rect, Transform};
use crate::style::Antialias;

/// One outline of a clip path; `None` encloses nothing.
pub(super) struct Outline<'t> {
    shape: Option<(&'t usvg::Path, &'t usvg::Fill)>,
    /// From the outline's space to that of the clipped group's children.
    transform: Transform,
}

/// The most outlines that are intersected one by one; clip paths that share each other may stand for
/// a number exponential in theirs.
const MAX_OUTLINES: usize = 32;

/// The outlines whose intersection is the area of the group's clip path, or `None` where some union of outlines
/// is part of it, or where they are too many. Outlines around all that the group draws are left out: plots clip
/// each of a thousand marks to the frame that holds them all.
pub(super) fn outlines(group: &usvg::Group) -> Option<Vec<Outline<'_>>> {
    let Some(clip) = group.clip_path() else { return Some(Vec::new()) };
    let mut outlines = all_outlines(clip)?;
    if let Some(content) = content(group) {
        outlines.retain(|outline| !outline.holds(content));
    }
    Some(outlines)
}

/// The box of what the group's children draw. The group's own is not that: where an image is cut to fit,
/// usvg makes it the box of the clip.
fn content(group: &usvg::Group) -> Option<Rect> {
    let mut boxes = group.children().iter().map(|node| {
        let bounds = convert::bounds(node.stroke_bounding_box());
        match node {
            // A filter may draw further out than what it applies to.
            usvg::Node::Group(group) => {
                let layer = convert::rect(group.layer_bounding_box());
                convert::transform(group.transform()).map_rect(bounds.union(layer))
            }
            _ => Some(bounds),
        }
    });
    let first = boxes.next()??;
    boxes.try_fold(first, |all, bounds| Some(all.union(bounds?)))
}

impl Outline<'_> {
    /// Whether it is a rectangle around `content`, which clips nothing.
    fn holds(&self, content: Rect) -> bool {
        let rect = self
            .shape
            .filter(|_| self.transform.is_scale_translate())
            .and_then(|(path, _)| convert::rectangle(path.data()))
            .and_then(|rect| self.transform.map_rect(rect));
        rect.is_some_and(|rect| {
            rect.left <= content.left
                && rect.top <= content.top
                && rect.right >= content.right
                && rect.bottom >= content.bottom
        })
    }
}

fn all_outlines(clip: &usvg::ClipPath) -> Option<Vec<Outline<'_>>> {
    let mut outlines = Vec::new();
    let mut clips = vec![(clip, Transform::IDENTITY)];
    while let Some((clip, outer)) = clips.pop() {
        if outlines.len() + clips.len() > MAX_OUTLINES {
            return None;
        }
        // A clip path's own clip lies in the space of what is clipped, without the clip path's transform.
        clips.extend(clip.clip_path().map(|clip| (clip, outer)));
        let mut transform = outer.pre_concat(convert::transform(clip.transform()));
        let mut group = clip.root();
        let shape = loop {
            group = match group.children() {
                [] => break None,
                [usvg::Node::Path(path)] => break visible_fill(path),
                [usvg::Node::Image(_)] => break None,
                [usvg::Node::Group(inner)] => inner,
                [usvg::Node::Text(text)] => text.flattened(),
                _ => return None,
            };
            transform = transform.pre_concat(convert::transform(group.transform()));
            clips.extend(group.clip_path().map(|clip| (clip, transform)));
        };
        outlines.push(Outline { shape, transform });
    }
    Some(outlines)
}

/// Intersects the canvas's clip with outlines.
pub(super) fn apply(outlines: &[Outline<'_>], settings: &Settings, canvas: &mut Canvas<'_>) {
    let outer = canvas.current_transform();
    for Outline { shape, transform } in outlines {
        match shape {
            Some((path, fill)) => {
                canvas.transform(*transform);
                let antialias = shape::antialias(path, settings);
                shape::nudge(antialias, canvas);
                match convert::rectangle(path.data()) {
                    Some(rect) => canvas.clip_rect(rect, antialias),
                    None => canvas.clip_path(&convert::path(path.data()), convert::fill_rule(fill.rule()), antialias),
                }
                canvas.set_transform(outer);
            }
            None => canvas.clip_rect(Rect::from_xywh(0.0, 0.0, 0.0, 0.0), Antialias::None),
        }
    }
}

fn visible_fill(path: &usvg::Path) -> Option<(&usvg::Path, &usvg::Fill)> {
    path.fill().filter(|_| path.is_visible()).map(|fill| (path, fill))
}

impl Renderer<'_> {
    /// Draws one node of a clip path into the mask that stands for it.
    pub(super) fn outline<'t>(&mut self, node: &'t usvg::Node, steps: &mut Vec<Step<'t>>, canvas: &mut Canvas<'_>) {
        let group = match node {
            usvg::Node::Path(path) => {
                if let Some((path, fill)) = visible_fill(path) {
                    let paint = Paint::from(Color::BLACK).with_antialias(shape::antialias(path, self.settings));
                    let transform = canvas.current_transform();
                    shape::nudge(paint.antialias, canvas);
                    canvas.fill_path(&convert::path(path.data()), convert::fill_rule(fill.rule()), paint);
                    canvas.set_transform(transform);
                }
                return;
            }
            usvg::Node::Image(_) => return,
            usvg::Node::Group(group) => group,
            usvg::Node::Text(text) => text.flattened(),
        };
        canvas.save();
        canvas.transform(convert::transform(group.transform()));
        steps.push(Step::Restore);
        if let Some(clip) = group.clip_path() {
            if let Some(outlines) = all_outlines(clip) {
                apply(&outlines, self.settings, canvas);
            } else if self.count_layer() {
                canvas.push_layer(1.0, BlendMode::SourceOver);
                steps.push(Step::PopLayer);
                steps.push(Step::Clip(clip));
            }
        }
        steps.push(Step::Outlines(group, 0));
    }
}
