//! Scenes drawn slowly: coverage in `f64` along 256 lines a pixel, each measured exactly; colours by tiny-skia where
//! coverage is full; and the two put together by their definition, what is there · (1 − coverage) + what would be
//! there · coverage. A clip's coverage and a shape's are multiplied, as both libraries do.
//!
//! A stroke's outline is tiny-skia's, asked for at many times the resolution that its own drawing uses.

use rastrum::{BlendMode, FillRule, Paint, Point, Segment, Transform};
use tiny_skia::PathSegment;

use super::scene::{Item, Outline, SIZE, Scene, Style};
use super::skia;

const PIXELS: usize = (SIZE * SIZE) as usize;
/// Lines a pixel.
const LINES: usize = 256;
/// Pieces that a curve is cut into.
const PIECES: usize = 256;
/// How much finer than for its own drawing tiny-skia is to approximate curves of strokes.
const STROKE_RESOLUTION: f32 = 16.0;

/// What a scene should look like.
pub(super) struct Truth {
    /// Premultiplied components, 0.0 ..= 255.0.
    pub(super) pixels: Vec<[f64; 4]>,
    /// Pixels that some outline covers in part.
    pub(super) partial: Vec<bool>,
    /// Those and all their neighbours: elsewhere every pixel is inside or outside of each outline with a pixel to spare.
    pub(super) zone: Vec<bool>,
}

pub(super) fn draw(scene: &Scene) -> Truth {
    let mut background = skia::blank();
    background.fill(skia::color(scene.background));
    let mut truth = Truth::new(&background);
    truth.draw_items(&scene.items, Transform::IDENTITY, &[1.0; PIXELS]);
    truth
}

impl Truth {
    fn new(background: &tiny_skia::Pixmap) -> Self {
        let pixels = background.data().as_chunks::<4>().0.iter().map(|p| p.map(f64::from)).collect();
        Self { pixels, partial: vec![false; PIXELS], zone: vec![false; PIXELS] }
    }

    fn draw_items(&mut self, items: &[Item], transform: Transform, clip: &[f64]) {
        for item in items {
            match item {
                Item::Draw { outline, style, paint } => {
                    let (polygons, rule) = match style {
                        Style::Fill(rule) => (outline_polygons(outline, transform), *rule),
                        Style::Stroke(stroke) => (stroke_polygons(outline, stroke, transform), FillRule::NonZero),
                    };
                    let mut coverage = self.cover(&polygons, rule);
                    multiply(&mut coverage, clip);
                    self.paint(paint, transform, &coverage);
                }
                Item::Transformed(inner, items) => self.draw_items(items, transform.pre_concat(*inner), clip),
                Item::Clipped(outline, rule, items) => {
                    let mut inner = self.cover(&outline_polygons(outline, transform), *rule);
                    multiply(&mut inner, clip);
                    self.draw_items(items, transform, &inner);
                }
                Item::Masked { kind, picture, items } => {
                    let mut inner = self.mask(picture, *kind);
                    multiply(&mut inner, clip);
                    self.draw_items(items, transform, &inner);
                }
                Item::Layer { opacity, blend_mode, items } => {
                    let layer = self.layer(items, transform);
                    let mut full = self.rounded();
                    skia::draw_layer(&mut full, &layer.rounded(), *opacity, *blend_mode, None);
                    self.mix(&full, clip);
                }
                Item::MaskedLayer { kind, picture, items } => {
                    let mut layer = self.layer(items, transform);
                    let mask = self.mask(picture, *kind);
                    for (pixel, mask) in layer.pixels.iter_mut().zip(mask) {
                        *pixel = pixel.map(|v| v * mask);
                    }
                    let mut full = self.rounded();
                    skia::draw_layer(&mut full, &layer.rounded(), 1.0, BlendMode::SourceOver, None);
                    self.mix(&full, clip);
                }
            }
        }
    }

    /// A picture of items alone; its edges become this picture's.
    fn layer(&mut self, items: &[Item], transform: Transform) -> Self {
        let mut layer = Self::new(&skia::blank());
        layer.draw_items(items, transform, &[1.0; PIXELS]);
        for index in 0..PIXELS {
            self.partial[index] |= layer.partial[index];
            self.zone[index] |= layer.zone[index];
        }
        layer
    }

    fn mask(&mut self, picture: &[Item], kind: rastrum::MaskKind) -> Vec<f64> {
        let layer = self.layer(picture, Transform::IDENTITY);
        let weights = match kind {
            rastrum::MaskKind::Alpha => [0.0, 0.0, 0.0, 1.0],
            rastrum::MaskKind::Luminance => [0.2126, 0.7152, 0.0722, 0.0],
        };
        let weigh = |pixel: &[f64; 4]| pixel.iter().zip(weights).map(|(v, weight)| v * weight).sum::<f64>() / 255.0;
        layer.pixels.iter().map(weigh).collect()
    }

    /// The coverage of polygons, which also tells where edges are.
    fn cover(&mut self, polygons: &[Vec<[f64; 2]>], rule: FillRule) -> Vec<f64> {
        let coverage = coverage(polygons, rule);
        let size = SIZE as usize;
        for (index, own) in coverage.iter().enumerate() {
            self.partial[index] |= is_partial(*own);
            let (x, y) = (index % size, index / size);
            for other_y in y.saturating_sub(1)..(y + 2).min(size) {
                for other_x in x.saturating_sub(1)..(x + 2).min(size) {
                    let other = coverage[other_y * size + other_x];
                    self.zone[index] |= is_partial(other) || (other - own).abs() > 0.5;
                }
            }
        }
        coverage
    }

    fn paint(&mut self, paint: &Paint, transform: Transform, coverage: &[f64]) {
        if paint.blend_mode == BlendMode::Plus {
            // The coverage scales the source; the sum is clamped after that.
            let mut source = skia::blank();
            skia::flood(&mut source, &paint.clone().with_blend_mode(BlendMode::Source), transform);
            let source = source.data().as_chunks::<4>().0;
            for ((pixel, source), coverage) in self.pixels.iter_mut().zip(source).zip(coverage) {
                for (value, source) in pixel.iter_mut().zip(source) {
                    *value = (*value + f64::from(*source) * coverage).min(255.0);
                }
            }
            return;
        }
        let mut full = self.rounded();
        skia::flood(&mut full, paint, transform);
        self.mix(&full, coverage);
    }

    fn mix(&mut self, full: &tiny_skia::Pixmap, coverage: &[f64]) {
        let full = full.data().as_chunks::<4>().0;
        for ((pixel, full), coverage) in self.pixels.iter_mut().zip(full).zip(coverage) {
            for (value, full) in pixel.iter_mut().zip(full) {
                *value += (f64::from(*full) - *value) * coverage;
            }
        }
    }

    fn rounded(&self) -> tiny_skia::Pixmap {
        let data = self.pixels.iter().flat_map(|p| p.map(|v| (v + 0.5) as u8)).collect();
        tiny_skia::Pixmap::from_vec(data, tiny_skia::IntSize::from_wh(SIZE, SIZE).unwrap()).unwrap()
    }
}

/// Neither outside nor inside, rounding aside.
fn is_partial(coverage: f64) -> bool {
    coverage > 1e-9 && coverage < 1.0 - 1e-9
}

fn multiply(values: &mut [f64], by: &[f64]) {
    for (value, by) in values.iter_mut().zip(by) {
        *value *= by;
    }
}

/// The share of each pixel that lies inside.
fn coverage(polygons: &[Vec<[f64; 2]>], rule: FillRule) -> Vec<f64> {
    let size = SIZE as usize;
    let lines = LINES as f64;
    let mut rows: Vec<Vec<(f64, i32)>> = vec![Vec::new(); size * LINES];
    for polygon in polygons {
        for (index, a) in polygon.iter().enumerate() {
            let b = polygon[(index + 1) % polygon.len()];
            let (top, bottom, winding) = if a[1] < b[1] { (*a, b, 1) } else { (b, *a, -1) };
            // The lines at (row + ½) / 256 in top ≤ y < bottom.
            let first = (top[1] * lines - 0.5).ceil().clamp(0.0, rows.len() as f64) as usize;
            let last = (bottom[1] * lines - 0.5).ceil().clamp(0.0, rows.len() as f64) as usize;
            for (row, crossings) in rows.iter_mut().enumerate().take(last).skip(first) {
                let y = (row as f64 + 0.5) / lines;
                crossings.push((top[0] + (bottom[0] - top[0]) * (y - top[1]) / (bottom[1] - top[1]), winding));
            }
        }
    }
    let mut lengths = vec![0.0; PIXELS];
    for (row, crossings) in rows.iter_mut().enumerate() {
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut around = 0;
        for (index, (x, winding)) in crossings.iter().enumerate() {
            around += winding;
            let inside = if rule == FillRule::NonZero { around != 0 } else { around % 2 != 0 };
            let Some((next, _)) = crossings.get(index + 1).filter(|_| inside) else { continue };
            let (mut from, to) = (x.clamp(0.0, size as f64), next.clamp(0.0, size as f64));
            while from < to {
                let pixel = from.floor();
                let end = to.min(pixel + 1.0);
                lengths[row / LINES * size + pixel as usize] += end - from;
                from = end;
            }
        }
    }
    lengths.iter().map(|length| length / lines).collect()
}

/// An outline's polygons in device pixels.
#[expect(clippy::disallowed_methods, reason = "the truth need not be the same to the last bit everywhere")]
fn outline_polygons(outline: &Outline, transform: Transform) -> Vec<Vec<[f64; 2]>> {
    let mut flattener = Flattener::new(transform);
    match outline {
        Outline::Rect(rect) => flattener.polygons.push(rect.corners().map(|p| flattener.map(point(p))).to_vec()),
        Outline::Ellipse { center: (x, y), rx, ry } => {
            let [x, y, rx, ry] = [*x, *y, *rx, *ry].map(f64::from);
            let on = |step: u32| {
                let (sin, cos) = (f64::from(step) / 1024.0 * std::f64::consts::TAU).sin_cos();
                flattener.map([x + rx * cos, y + ry * sin])
            };
            let polygon = (0..1024).map(on).collect();
            flattener.polygons.push(polygon);
        }
        Outline::Path(path) => {
            for segment in path.segments() {
                match segment {
                    Segment::MoveTo(p) => flattener.begin(point(p)),
                    Segment::LineTo(p) => flattener.curve(&[point(p)]),
                    Segment::QuadTo(c, p) => flattener.curve(&[point(c), point(p)]),
                    Segment::CubicTo(c1, c2, p) => flattener.curve(&[point(c1), point(c2), point(p)]),
                    Segment::Close => {}
                }
            }
        }
    }
    flattener.polygons
}

/// The polygons of a stroke's outline in device pixels.
fn stroke_polygons(outline: &Outline, stroke: &rastrum::Stroke, transform: Transform) -> Vec<Vec<[f64; 2]>> {
    let mut path = skia::path(outline);
    let mut style = skia::stroke(stroke);
    let to_device = skia::transform(transform);
    let mut flattener = Flattener::new(transform);
    if style.width == 0.0 {
        // A hairline is one device pixel wide.
        path = path.transform(to_device).unwrap();
        style.width = 1.0;
        flattener = Flattener::new(Transform::IDENTITY);
    }
    let resolution = tiny_skia::PathStroker::compute_resolution_scale(&to_device) * STROKE_RESOLUTION;
    if let Some(dash) = &style.dash {
        path = path.dash(dash, resolution).unwrap();
    }
    let path = path.stroke(&style, resolution).unwrap();
    let point = |p: tiny_skia::Point| [f64::from(p.x), f64::from(p.y)];
    for segment in path.segments() {
        match segment {
            PathSegment::MoveTo(p) => flattener.begin(point(p)),
            PathSegment::LineTo(p) => flattener.curve(&[point(p)]),
            PathSegment::QuadTo(c, p) => flattener.curve(&[point(c), point(p)]),
            PathSegment::CubicTo(c1, c2, p) => flattener.curve(&[point(c1), point(c2), point(p)]),
            PathSegment::Close => {}
        }
    }
    flattener.polygons
}

/// Polygons from curves, mapped in `f64`.
struct Flattener {
    matrix: [f64; 6],
    /// The last point, not mapped.
    last: [f64; 2],
    polygons: Vec<Vec<[f64; 2]>>,
}

impl Flattener {
    fn new(t: Transform) -> Self {
        let matrix = [t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from);
        Self { matrix, last: [0.0; 2], polygons: Vec::new() }
    }

    fn map(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b, c, d, e, f] = self.matrix;
        [a * x + c * y + e, b * x + d * y + f]
    }

    fn begin(&mut self, p: [f64; 2]) {
        self.last = p;
        self.polygons.push(vec![self.map(p)]);
    }

    /// A Bézier curve from the last point by de Casteljau's construction; one point is a line.
    fn curve(&mut self, points: &[[f64; 2]]) {
        let pieces = if points.len() == 1 { 1 } else { PIECES };
        for piece in 1..=pieces {
            let t = piece as f64 / pieces as f64;
            let mut row = vec![self.last];
            row.extend(points);
            while row.len() > 1 {
                row = row.windows(2).map(|p| [0, 1].map(|axis| p[0][axis] + (p[1][axis] - p[0][axis]) * t)).collect();
            }
            let mapped = self.map(row[0]);
            self.polygons.last_mut().unwrap().push(mapped);
        }
        self.last = *points.last().unwrap();
    }
}

fn point(p: Point) -> [f64; 2] {
    [f64::from(p.x), f64::from(p.y)]
}
