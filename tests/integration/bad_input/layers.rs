//! Layers, clips and saved states: unbalanced, crowded, degenerate.

use std::sync::Arc;

use rastrum::{BlendMode, Canvas, Color, FillRule, Mask, MaskKind, Paint, Path, Rect};

use super::{draws_like, draws_nothing, survives};

#[test]
fn unbalanced_restores_and_layers() {
    let shape = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    draws_like(
        "restores first",
        0,
        |c, p| {
            for _ in 0..1000 {
                c.restore();
                c.pop_layer();
                c.pop_mask();
            }
            shape(c, p);
        },
        shape,
    );
    draws_like(
        "restores inside a layer stay inside",
        0,
        |c, p| {
            c.save();
            c.translate(5.0, 5.0);
            c.push_layer(1.0, BlendMode::SourceOver);
            c.restore();
            c.restore();
            c.translate(-5.0, -5.0);
            shape(c, p);
            c.pop_mask();
            c.pop_layer();
            c.restore();
        },
        shape,
    );
    draws_like(
        "layers that nobody closes",
        0,
        |c, p| {
            c.push_layer(1.0, BlendMode::SourceOver);
            shape(c, p);
            c.push_layer(0.5, BlendMode::SourceOver);
            c.save();
        },
        shape,
    );
    draws_like(
        "a mask without a layer masks nothing",
        0,
        |c, p| {
            shape(c, p);
            c.push_mask(MaskKind::Alpha);
            c.fill(p);
            c.pop_mask();
        },
        shape,
    );
}

#[test]
fn a_million_saves() {
    let shape = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    draws_like(
        "alike",
        0,
        |c, p| {
            (0..1_000_000).for_each(|_| c.save());
            shape(c, p);
            (0..1_000_001).for_each(|_| c.restore());
        },
        shape,
    );
    draws_like(
        "each different",
        0,
        |c, p| {
            for _ in 0..1_000_000 {
                c.save();
                c.translate(1.0, 0.0);
            }
            (0..1_000_000).for_each(|_| c.restore());
            shape(c, p);
        },
        shape,
    );
}

#[test]
fn ten_thousand_layers() {
    let shape = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    draws_like(
        "nested",
        0,
        |c, p| {
            (0..10_000).for_each(|_| c.push_layer(1.0, BlendMode::SourceOver));
            shape(c, p);
            (0..10_000).for_each(|_| c.pop_layer());
        },
        shape,
    );
    draws_like(
        "nested and left open",
        0,
        |c, p| {
            for _ in 0..10_000 {
                c.push_layer(1.0, BlendMode::SourceOver);
                c.save();
            }
            shape(c, p);
        },
        shape,
    );
    draws_like(
        "one after another",
        0,
        |c, p| {
            for _ in 0..10_000 {
                c.push_layer(1.0, BlendMode::SourceOver);
                c.pop_layer();
            }
            shape(c, p);
        },
        shape,
    );
}

#[test]
fn ten_thousand_clips() {
    draws_like(
        "nested",
        0,
        |c, p| {
            for _ in 0..10_000 {
                c.save();
                c.clip_rect(Rect::from_ltrb(10.0, 10.0, 50.0, 40.0), p.antialias);
            }
            c.fill(p);
        },
        |c, p| c.fill_rect(Rect::from_ltrb(10.0, 10.0, 50.0, 40.0), p),
    );
    // The same with coverage: each clip multiplies the one before, so that nothing is left but what is whole.
    let mut path = Path::new();
    path.circle((30.0, 24.0), 15.0);
    survives(|c, p| {
        for _ in 0..1_000 {
            c.clip_path(&path, FillRule::NonZero, p.antialias);
        }
        c.fill(p);
    });
}

#[test]
fn clips() {
    let circle = |c: &mut Canvas<'_>, p: &Paint| c.fill_circle((30.0, 20.0), 12.0, p);
    for far in [1e5, 1e30, f32::MAX] {
        draws_like(
            &format!("huge {far}"),
            0,
            |c, p| {
                c.clip_rect(Rect::from_ltrb(-far, -far, far, far), p.antialias);
                circle(c, p);
            },
            circle,
        );
    }
    draws_nothing("empty path", |c, p| {
        c.clip_path(&Path::new(), FillRule::NonZero, p.antialias);
        circle(c, p);
    });
    draws_nothing("outside", |c, p| {
        c.clip_rect(Rect::from_ltrb(100.0, 0.0, 200.0, 50.0), p.antialias);
        circle(c, p);
        c.push_layer(1.0, BlendMode::Source);
        circle(c, p);
        c.pop_layer();
        c.clear(Color::RED);
        c.draw_pixel_line((0, 0), (9, 9), p);
    });
    draws_nothing("apart", |c, p| {
        c.clip_rect(Rect::from_ltrb(0.0, 0.0, 20.0, 48.0), p.antialias);
        c.clip_rect(Rect::from_ltrb(20.0, 0.0, 64.0, 48.0), p.antialias);
        c.fill(p);
    });
    let mask = Arc::new(Mask::from_vec(2, 2, vec![255; 4]).unwrap());
    for at in [i32::MIN, -2, 64, i32::MAX - 1, i32::MAX] {
        draws_nothing("mask outside", |c, p| {
            c.clip_mask(Arc::clone(&mask), at, 5);
            c.fill(p);
        });
        draws_nothing("mask outside", |c, p| {
            c.clip_mask(Arc::clone(&mask), 5, at);
            c.fill(p);
        });
    }
}
