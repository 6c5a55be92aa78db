//! Real drawings: an SVG tree made into a flat list of fills and strokes that every engine can be given.
//!
//! Gradients, images, clip paths, dashes and opacity go along. What some engine has no call for is left out or simplified
//! for all of them alike, and counted; [`Drawing::notes`] says so. resvg draws the whole tree beside.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use usvg::tiny_skia_path::PathSegment;

use crate::scene::{
    Cap, Clip, Gradient, IDENTITY, Image, Item, Join, Paint, Rule, Scene, Segment, Shape, Spread, Stroke, Style,
    Transform, concat,
};

/// The longer side of a drawing's picture, in pixels.
const SIDE: f32 = 1024.0;

pub struct Drawing {
    pub tree: usvg::Tree,
    pub scene: Scene,
    /// What differs from the file, and how often.
    pub notes: BTreeMap<&'static str, usize>,
}

/// How a tree is scaled to its picture.
pub struct Fit {
    pub scale: f32,
    pub width: u32,
    pub height: u32,
}

pub fn fit(tree: &usvg::Tree) -> Fit {
    let size = tree.size();
    let scale = SIDE / size.width().max(size.height());
    let pixels = |length: f32| ((length * scale).round() as u32).max(1);
    Fit { scale, width: pixels(size.width()), height: pixels(size.height()) }
}

/// The SVG files of a folder, by name.
pub fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut files: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "svg" || extension == "svgz"));
    files.sort();
    Ok(files)
}

/// The workload's name: the file's, without its ending.
pub fn name(file: &Path) -> String {
    file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
}

pub fn load(file: &Path) -> Result<Drawing, String> {
    let bytes = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    let mut options = usvg::Options { resources_dir: file.parent().map(Path::to_path_buf), ..usvg::Options::default() };
    options.fontdb_mut().load_system_fonts();
    let tree = rastrum::svg::parse(&bytes, &options).map_err(|error| format!("{}: {error}", file.display()))?;
    let fit = fit(&tree);
    let mut flattener = Flattener::default();
    flattener.scene.name = name(file);
    (flattener.scene.width, flattener.scene.height) = (fit.width, fit.height);
    let around = Around { transform: [fit.scale, 0.0, 0.0, fit.scale, 0.0, 0.0], opacity: 1.0, clip: None };
    flattener.children(tree.root(), around);
    let Flattener { mut scene, notes, .. } = flattener;
    scene.title = format!("{} shapes, {} clips, {} images", scene.items.len(), scene.clips.len(), scene.images.len());
    Ok(Drawing { tree, scene, notes })
}

#[derive(Default)]
struct Flattener {
    scene: Scene,
    notes: BTreeMap<&'static str, usize>,
    /// Clips met before, by parent, clip path and transform.
    clips: HashMap<(Option<usize>, usize, [u32; 6]), usize>,
    /// Images met before, by their bytes' address.
    images: HashMap<usize, Option<usize>>,
}

/// What the groups around a node do to it.
#[derive(Clone, Copy)]
struct Around {
    transform: Transform,
    opacity: f32,
    clip: Option<usize>,
}

impl Flattener {
    fn note(&mut self, what: &'static str) {
        *self.notes.entry(what).or_default() += 1;
    }

    fn children(&mut self, group: &usvg::Group, around: Around) {
        for node in group.children() {
            match node {
                usvg::Node::Group(group) => self.group(group, around),
                usvg::Node::Path(path) => self.path(path, around),
                usvg::Node::Image(image) => self.image(image, around),
                usvg::Node::Text(text) => self.group(text.flattened(), around),
            }
        }
    }

    fn group(&mut self, group: &usvg::Group, mut around: Around) {
        around.transform = concat(transform(group.transform()), around.transform);
        if group.blend_mode() != usvg::BlendMode::Normal {
            self.note("blend modes drawn as source-over");
        }
        if group.mask().is_some() {
            self.note("masks left out");
        }
        if !group.filters().is_empty() {
            self.note("filters left out");
        }
        if group.opacity().get() < 1.0 {
            if paints(group) > 1 {
                self.note("opacities of groups given to each shape");
            }
            around.opacity *= group.opacity().get();
        }
        if let Some(clip) = group.clip_path() {
            around.clip = self.clip(clip, around.clip, around.transform);
        }
        self.children(group, around);
    }

    fn clip(&mut self, clip: &usvg::ClipPath, parent: Option<usize>, outer: Transform) -> Option<usize> {
        let parent = match clip.clip_path() {
            Some(further) => self.clip(further, parent, outer),
            None => parent,
        };
        let key = (parent, std::ptr::from_ref(clip).addr(), outer.map(f32::to_bits));
        if let Some(index) = self.clips.get(&key) {
            return Some(*index);
        }
        let mut outlines = Vec::new();
        self.clip_outlines(clip.root(), IDENTITY, &mut outlines);
        let (shape, rule) = match outlines.as_slice() {
            [(outline, rule)] => (shape(outline), *rule),
            several => {
                if several.len() > 1 {
                    self.note("clips of several shapes taken as one nonzero path");
                }
                (Shape::Path(several.iter().flat_map(|(outline, _)| outline).copied().collect()), Rule::NonZero)
            }
        };
        let transform = concat(transform(clip.transform()), outer);
        self.scene.clips.push(Clip { parent, shape, rule, transform });
        let index = self.scene.clips.len() - 1;
        self.clips.insert(key, index);
        Some(index)
    }

    fn clip_outlines(&mut self, group: &usvg::Group, outer: Transform, out: &mut Vec<(Vec<Segment>, Rule)>) {
        for node in group.children() {
            match node {
                usvg::Node::Path(path) if path.is_visible() => {
                    let rule = path.fill().map_or(Rule::NonZero, |fill| fill_rule(fill.rule()));
                    out.push((mapped(path.data(), outer), rule));
                }
                usvg::Node::Group(group) => {
                    if group.clip_path().is_some() {
                        self.note("clips inside of clip paths left out");
                    }
                    self.clip_outlines(group, concat(transform(group.transform()), outer), out);
                }
                usvg::Node::Text(text) => self.clip_outlines(text.flattened(), outer, out),
                usvg::Node::Path(_) | usvg::Node::Image(_) => {}
            }
        }
    }

    fn path(&mut self, path: &usvg::Path, around: Around) {
        if !path.is_visible() {
            return;
        }
        if !path.rendering_mode().use_shape_antialiasing() {
            self.note("shapes that ask for hard edges drawn smooth");
        }
        let fill = path
            .fill()
            .map(|fill| (Style::Fill(fill_rule(fill.rule())), fill.paint(), fill.opacity().get() * around.opacity));
        let stroke = path.stroke().map(|stroke| {
            (Style::Stroke(stroke_style(stroke)), stroke.paint(), stroke.opacity().get() * around.opacity)
        });
        let order = match path.paint_order() {
            usvg::PaintOrder::FillAndStroke => [fill, stroke],
            usvg::PaintOrder::StrokeAndFill => [stroke, fill],
        };
        for (style, paint, opacity) in order.into_iter().flatten() {
            let Some(paint) = paint_of(paint, opacity) else {
                self.note("shapes painted with patterns left out");
                continue;
            };
            let outline = mapped(path.data(), IDENTITY);
            let shape = if matches!(style, Style::Fill(_)) { shape(&outline) } else { Shape::Path(outline) };
            self.scene.items.push(Item { shape, style, paint, transform: around.transform, clip: around.clip });
        }
    }

    fn image(&mut self, image: &usvg::Image, around: Around) {
        if !image.is_visible() {
            return;
        }
        let bytes = match image.kind() {
            usvg::ImageKind::SVG(tree) => {
                self.note("SVG files inside not clipped to their size");
                return self.group(tree.root(), around);
            }
            usvg::ImageKind::PNG(bytes)
            | usvg::ImageKind::JPEG(bytes)
            | usvg::ImageKind::GIF(bytes)
            | usvg::ImageKind::WEBP(bytes) => bytes,
        };
        let known = self.images.get(&Arc::as_ptr(bytes).addr()).copied();
        let index = known.unwrap_or_else(|| {
            let index = decode(bytes).map(|image| {
                self.scene.images.push(image);
                self.scene.images.len() - 1
            });
            self.images.insert(Arc::as_ptr(bytes).addr(), index);
            index
        });
        let Some(index) = index else { return self.note("images that cannot be read left out") };
        let smooth = matches!(
            image.rendering_mode(),
            usvg::ImageRendering::OptimizeQuality | usvg::ImageRendering::HighQuality | usvg::ImageRendering::Smooth
        );
        if smooth {
            self.note("images drawn bilinear");
        }
        let (width, height) = (self.scene.images[index].width, self.scene.images[index].height);
        self.scene.items.push(Item {
            shape: Shape::Rect([0.0, 0.0, width as f32, height as f32]),
            style: Style::Fill(Rule::NonZero),
            paint: Paint::Image { index, smooth, opacity: around.opacity, transform: IDENTITY },
            transform: around.transform,
            clip: around.clip,
        });
    }
}

/// How many fills, strokes and images a group draws.
fn paints(group: &usvg::Group) -> usize {
    let paints = |node: &usvg::Node| match node {
        usvg::Node::Group(group) => paints(group),
        usvg::Node::Path(path) => usize::from(path.fill().is_some()) + usize::from(path.stroke().is_some()),
        usvg::Node::Image(_) => 1,
        usvg::Node::Text(text) => paints(text.flattened()),
    };
    group.children().iter().map(paints).sum()
}

fn transform(t: usvg::Transform) -> Transform {
    [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty]
}

fn mapped(path: &usvg::tiny_skia_path::Path, [a, b, c, d, e, f]: Transform) -> Vec<Segment> {
    let map = |p: usvg::tiny_skia_path::Point| [a * p.x + c * p.y + e, b * p.x + d * p.y + f];
    let segment = |segment| match segment {
        PathSegment::MoveTo(p) => Segment::Move(map(p)),
        PathSegment::LineTo(p) => Segment::Line(map(p)),
        PathSegment::QuadTo(c, p) => Segment::Quad(map(c), map(p)),
        PathSegment::CubicTo(c1, c2, p) => Segment::Cubic(map(c1), map(c2), map(p)),
        PathSegment::Close => Segment::Close,
    };
    path.segments().map(segment).collect()
}

/// usvg makes paths of rectangles; engines have calls of their own for those with sides along the axes.
fn shape(outline: &[Segment]) -> Shape {
    use Segment::{Close, Line, Move};
    if let [Move(a), Line(b), Line(c), Line(d), Close] = outline {
        let across = a[1] == b[1] && b[0] == c[0] && c[1] == d[1] && d[0] == a[0];
        let down = a[0] == b[0] && b[1] == c[1] && c[0] == d[0] && d[1] == a[1];
        if across || down {
            return Shape::Rect([a[0].min(c[0]), a[1].min(c[1]), a[0].max(c[0]), a[1].max(c[1])]);
        }
    }
    Shape::Path(outline.to_vec())
}

fn fill_rule(rule: usvg::FillRule) -> Rule {
    match rule {
        usvg::FillRule::NonZero => Rule::NonZero,
        usvg::FillRule::EvenOdd => Rule::EvenOdd,
    }
}

fn stroke_style(stroke: &usvg::Stroke) -> Stroke {
    let mut dashes = stroke.dasharray().map(<[f32]>::to_vec).unwrap_or_default();
    if dashes.len() % 2 == 1 {
        dashes.extend_from_within(..);
    }
    Stroke {
        width: stroke.width().get(),
        cap: match stroke.linecap() {
            usvg::LineCap::Butt => Cap::Butt,
            usvg::LineCap::Round => Cap::Round,
            usvg::LineCap::Square => Cap::Square,
        },
        join: match stroke.linejoin() {
            usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => Join::Miter,
            usvg::LineJoin::Round => Join::Round,
            usvg::LineJoin::Bevel => Join::Bevel,
        },
        miter_limit: stroke.miterlimit().get(),
        dashes,
        dash_offset: stroke.dashoffset(),
    }
}

fn paint_of(paint: &usvg::Paint, opacity: f32) -> Option<Paint> {
    let alpha = |opacity: f32| (opacity.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let gradient = |base: &usvg::BaseGradient| Gradient {
        stops: base
            .stops()
            .iter()
            .map(|stop| {
                let color = stop.color();
                (stop.offset().get(), [color.red, color.green, color.blue, alpha(stop.opacity().get())])
            })
            .collect(),
        spread: match base.spread_method() {
            usvg::SpreadMethod::Pad => Spread::Pad,
            usvg::SpreadMethod::Reflect => Spread::Reflect,
            usvg::SpreadMethod::Repeat => Spread::Repeat,
        },
        opacity,
        transform: transform(base.transform()),
    };
    match paint {
        usvg::Paint::Color(color) => Some(Paint::Solid([color.red, color.green, color.blue, alpha(opacity)])),
        usvg::Paint::LinearGradient(linear) => Some(Paint::Linear {
            start: [linear.x1(), linear.y1()],
            end: [linear.x2(), linear.y2()],
            gradient: gradient(linear),
        }),
        usvg::Paint::RadialGradient(radial) => Some(Paint::Radial {
            focus: [radial.fx(), radial.fy()],
            focal_radius: radial.fr().get(),
            center: [radial.cx(), radial.cy()],
            radius: radial.r().get(),
            gradient: gradient(radial),
        }),
        usvg::Paint::Pattern(_) => None,
    }
}

fn decode(bytes: &[u8]) -> Option<Image> {
    let image = image::load_from_memory(bytes).ok()?.into_rgba8();
    let (width, height) = image.dimensions();
    let mut rgba = image.into_raw();
    for pixel in rgba.as_chunks_mut::<4>().0 {
        let alpha = u32::from(pixel[3]);
        for channel in &mut pixel[..3] {
            *channel = ((u32::from(*channel) * alpha + 127) / 255) as u8;
        }
    }
    Some(Image { width, height, rgba })
}
