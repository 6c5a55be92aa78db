//! Scenes drawn by rastrum.

use rastrum::{Antialias, Canvas, Mask, Paint, Pixmap, RenderSettings};

use super::scene::{Item, Outline, SIZE, Scene, Style};

/// The picture that rastrum gives, every edge treated as `antialias` says.
pub(super) fn draw(scene: &Scene, antialias: Antialias) -> Pixmap {
    let mut canvas = blank();
    canvas.clear(scene.background);
    draw_items(&mut canvas, &scene.items, antialias);
    canvas.into_pixmap()
}

fn blank() -> Canvas<'static> {
    Canvas::with_settings(SIZE, SIZE, RenderSettings::default().with_threads(1)).unwrap()
}

fn draw_items(canvas: &mut Canvas<'_>, items: &[Item], antialias: Antialias) {
    for item in items {
        match item {
            Item::Draw { outline, style, paint } => {
                draw_shape(canvas, outline, style, paint.clone().with_antialias(antialias));
            }
            Item::Transformed(transform, items) => {
                let mut canvas = canvas.saved();
                canvas.transform(*transform);
                draw_items(&mut canvas, items, antialias);
            }
            Item::Clipped(outline, rule, items) => {
                let mut canvas = canvas.saved();
                match outline {
                    Outline::Path(path) => canvas.clip_path(path, *rule, antialias),
                    Outline::Rect(rect) => canvas.clip_rect(*rect, antialias),
                    Outline::Ellipse { center, rx, ry } => {
                        let mut path = rastrum::Path::new();
                        path.ellipse(*center, *rx, *ry);
                        canvas.clip_path(&path, *rule, antialias);
                    }
                }
                draw_items(&mut canvas, items, antialias);
            }
            Item::Masked { kind, picture, items } => {
                let mut other = blank();
                draw_items(&mut other, picture, antialias);
                let mask = Mask::from_pixmap(other.into_pixmap().as_ref(), *kind).unwrap();
                let mut canvas = canvas.saved();
                canvas.clip_mask(mask, 0, 0);
                draw_items(&mut canvas, items, antialias);
            }
            Item::Layer { opacity, blend_mode, items } => {
                canvas.push_layer(*opacity, *blend_mode);
                draw_items(canvas, items, antialias);
                canvas.pop_layer();
            }
            Item::MaskedLayer { kind, picture, items } => {
                canvas.push_layer(1.0, rastrum::BlendMode::SourceOver);
                draw_items(canvas, items, antialias);
                canvas.push_mask(*kind);
                canvas.set_transform(rastrum::Transform::IDENTITY);
                draw_items(canvas, picture, antialias);
                canvas.pop_mask();
                canvas.pop_layer();
            }
        }
    }
}

fn draw_shape(canvas: &mut Canvas<'_>, outline: &Outline, style: &Style, paint: Paint) {
    match (outline, style) {
        (Outline::Path(path), Style::Fill(rule)) => canvas.fill_path(path, *rule, paint),
        (Outline::Path(path), Style::Stroke(stroke)) => canvas.stroke_path(path, stroke, paint),
        (Outline::Rect(rect), Style::Fill(_)) => canvas.fill_rect(*rect, paint),
        (Outline::Rect(rect), Style::Stroke(stroke)) => canvas.stroke_rect(*rect, stroke, paint),
        (Outline::Ellipse { center, rx, ry }, Style::Fill(_)) => canvas.fill_ellipse(*center, *rx, *ry, paint),
        (Outline::Ellipse { center, rx, ry }, Style::Stroke(stroke)) => {
            canvas.stroke_ellipse(*center, *rx, *ry, stroke, paint);
        }
    }
}
