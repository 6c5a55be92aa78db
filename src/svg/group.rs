//! Groups: transform, opacity, blend mode, clip path, mask.

use super::clip::{self, Outline};
use super::convert;
use super::render::{Renderer, Step};
use super::shape::{self, Effects};
use crate::blend::BlendMode;
use crate::canvas::{Canvas, LayerOptions};
use crate::geom::{Rect, Transform};
use crate::style::Antialias;

/// Begins a group and notes the steps that draw its children and end it.
pub(super) fn draw<'t>(
    group: &'t usvg::Group,
    renderer: &mut Renderer<'_>,
    steps: &mut Vec<Step<'t>>,
    canvas: &mut Canvas<'_>,
) {
    if group.should_isolate() {
        match single(group) {
            Some(single) => single.draw(renderer, canvas),
            None => begin_layer(group, renderer, steps, canvas),
        }
    } else if group.transform().is_identity() {
        steps.push(Step::Children(group, 0));
    } else {
        canvas.save();
        canvas.transform(convert::transform(group.transform()));
        steps.push(Step::Restore);
        steps.push(Step::Children(group, 0));
    }
}

fn begin_layer<'t>(
    group: &'t usvg::Group,
    renderer: &mut Renderer<'_>,
    steps: &mut Vec<Step<'t>>,
    canvas: &mut Canvas<'_>,
) {
    if !renderer.count_layer() {
        return;
    }
    canvas.save();
    canvas.transform(convert::transform(group.transform()));
    steps.push(Step::Restore);
    // One outline is a clip of the canvas; a union of several has to be drawn as a mask.
    let outlines = clip::outlines(group);
    if let Some(outlines) = &outlines {
        clip::apply(outlines, renderer.settings, canvas);
    }
    bound(group, canvas);
    let mut options = LayerOptions::default()
        .with_opacity(group.opacity().get())
        .with_blend_mode(convert::blend_mode(group.blend_mode()));
    // Clips and masks apply to what filters made.
    if group.filters().is_empty() || group.mask().is_some() || outlines.is_none() {
        canvas.push_layer_with(&options);
        options = LayerOptions::default();
        steps.push(Step::PopLayer);
        steps.extend(group.mask().map(Step::Mask));
        if outlines.is_none() {
            steps.extend(group.clip_path().map(Step::Clip));
        }
    }
    renderer.push_filters(group, options, steps, canvas);
    steps.push(Step::Children(group, 0));
}

/// Clips to the whole pixels that the group's content can touch: a layer costs time for each of its pixels, drawn
/// on or not.
fn bound(group: &usvg::Group, canvas: &mut Canvas<'_>) {
    // With a filter, the box is the filter's region, which does not bound what is drawn without it.
    if !group.filters().is_empty() {
        return;
    }
    let transform = canvas.current_transform();
    // Soft edges, and a pixel against rounding.
    let area = transform.map_rect(convert::rect(group.layer_bounding_box())).map(|area| area.outset(2.0).round_out());
    if let Some(area) = area {
        canvas.set_transform(Transform::IDENTITY);
        canvas.clip_rect(area.to_rect(), Antialias::None);
        canvas.set_transform(transform);
    }
}

/// Clips to a rectangle in the current user space and notes the steps that draw a group's children inside it;
/// the caller has saved the state and restores it.
pub(super) fn clip_to_rect<'t>(
    rect: Rect,
    group: &'t usvg::Group,
    renderer: &mut Renderer<'_>,
    steps: &mut Vec<Step<'t>>,
    canvas: &mut Canvas<'_>,
) {
    canvas.clip_rect(rect, renderer.settings.antialias);
    // Shapes over each other show the ones below along a soft edge, unless they are clipped as one.
    if single(group).is_none() && renderer.count_layer() {
        canvas.push_layer(1.0, BlendMode::SourceOver);
        steps.push(Step::PopLayer);
    }
    steps.push(Step::Children(group, 0));
}

/// A group, or groups in each other, with one thing in it that paints each pixel at most once.
/// Its effects can be the paint's own: no layer is needed, which is both faster and rounds less.
struct Single<'t> {
    /// The groups from the outside in, each with its clip as outlines.
    groups: Vec<(&'t usvg::Group, Vec<Outline<'t>>)>,
    node: &'t usvg::Node,
}

fn single(group: &usvg::Group) -> Option<Single<'_>> {
    if group.mask().is_some() || !group.filters().is_empty() {
        return None;
    }
    let mut groups = Vec::new();
    let mut inner = group;
    loop {
        groups.push((inner, clip::outlines(inner)?));
        let [node] = inner.children() else { return None };
        inner = match node {
            usvg::Node::Group(group) => group,
            usvg::Node::Text(text) => text.flattened(),
            usvg::Node::Path(path) => return shape::paints_once(path).then_some(Single { groups, node }),
            usvg::Node::Image(image) => {
                let is_raster = !matches!(image.kind(), usvg::ImageKind::SVG(_));
                return is_raster.then_some(Single { groups, node });
            }
        };
        let plain = inner.blend_mode() == usvg::BlendMode::Normal;
        if !plain || inner.mask().is_some() || !inner.filters().is_empty() {
            return None;
        }
    }
}

impl Single<'_> {
    fn draw(self, renderer: &mut Renderer<'_>, canvas: &mut Canvas<'_>) {
        let mut effects = Effects::default();
        canvas.save();
        for (group, outlines) in &self.groups {
            canvas.transform(convert::transform(group.transform()));
            clip::apply(outlines, renderer.settings, canvas);
            effects.opacity *= group.opacity().get();
        }
        if let Some((outermost, _)) = self.groups.first() {
            effects.blend_mode = convert::blend_mode(outermost.blend_mode());
        }
        match self.node {
            usvg::Node::Path(path) => renderer.draw_path(path, &effects, canvas),
            usvg::Node::Image(image) => renderer.draw_image(image, &effects, &mut Vec::new(), canvas),
            usvg::Node::Group(_) | usvg::Node::Text(_) => {}
        }
        canvas.restore();
    }
}
