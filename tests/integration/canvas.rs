//! The canvas: state, clips, layers, masks, shadows, pixels in the middle of drawing.

#![expect(clippy::disallowed_methods, reason = "compared with a tolerance, so that no machine's last bit matters")]

use rastrum::{
    Antialias, BlendMode, Canvas, Color, FillRule, IntRect, LineCap, Mask, MaskKind, Paint, Path, Pixmap, Rect, Shadow,
    Stroke, Transform,
};

pub(crate) const HALF_BLACK: Color = Color::from_rgba(0.0, 0.0, 0.0, 0.5);

/// A picture as text: a letter for the pure colours, `.` for transparent, `?` for all others.
pub(crate) fn text(pixmap: &Pixmap) -> Vec<String> {
    let letter = |pixel: &[u8; 4]| match pixel {
        [0, 0, 0, 0] => '.',
        [0, 0, 0, 255] => '#',
        [255, 0, 0, 255] => 'R',
        [0, 255, 0, 255] => 'G',
        [0, 0, 255, 255] => 'B',
        [255, 255, 255, 255] => 'W',
        _ => '?',
    };
    pixmap.as_ref().rows().map(|row| row.as_chunks::<4>().0.iter().map(letter).collect()).collect()
}

pub(crate) fn drawn(width: u32, height: u32, draw: impl FnOnce(&mut Canvas<'_>)) -> Pixmap {
    let mut canvas = Canvas::new(width, height).unwrap();
    draw(&mut canvas);
    canvas.into_pixmap()
}

pub(crate) fn rect(left: f32, top: f32, right: f32, bottom: f32) -> Rect {
    Rect::from_ltrb(left, top, right, bottom)
}

/// The alpha values of row `y`.
pub(crate) fn alphas(pixmap: &Pixmap, y: u32) -> Vec<u8> {
    (0..pixmap.width()).map(|x| pixmap.pixel(x, y).unwrap()[3]).collect()
}

pub(crate) fn unit() -> Rect {
    rect(0.0, 0.0, 1.0, 1.0)
}

// State

#[test]
fn restore_brings_back_transform_clip_and_shadow() {
    let picture = drawn(8, 4, |canvas| {
        canvas.translate(1.0, 1.0);
        canvas.save();
        canvas.translate(2.0, 0.0);
        canvas.clip_rect(rect(0.0, 0.0, 1.0, 1.0), Antialias::Analytic);
        canvas.set_shadow(Shadow { offset_x: 0.0, offset_y: 1.0, deviation: 0.0, color: Color::RED });
        canvas.save();
        canvas.translate(100.0, 100.0);
        canvas.restore();
        canvas.fill_rect(rect(0.0, 0.0, 3.0, 1.0), Color::GREEN);
        canvas.restore();
        canvas.fill_rect(unit(), Color::BLUE);
        canvas.fill_rect(rect(4.0, 0.0, 6.0, 1.0), Color::BLACK);
    });
    assert_eq!(text(&picture), ["........", ".B.G.##.", "........", "........"]);
}

#[test]
fn a_guard_restores_when_it_is_dropped() {
    let picture = drawn(4, 2, |canvas| {
        {
            let mut canvas = canvas.saved();
            canvas.translate(1.0, 0.0);
            {
                let mut canvas = canvas.saved();
                canvas.translate(1.0, 1.0);
                canvas.fill_rect(unit(), Color::RED);
            }
            canvas.fill_rect(unit(), Color::GREEN);
        }
        canvas.fill_rect(unit(), Color::BLUE);
        assert!(canvas.current_transform().is_identity());
    });
    assert_eq!(text(&picture), ["BG..", "..R."]);
}

#[test]
fn transforms_compose_from_the_outside_in() {
    // x' = 3 + 2x, y' = 1 + y: the last call is applied first.
    let moved_then_scaled = drawn(8, 3, |canvas| {
        canvas.translate(3.0, 1.0);
        canvas.scale(2.0, 1.0);
        canvas.fill_rect(unit(), Color::BLACK);
        assert_eq!(canvas.current_transform(), Transform::from_row(2.0, 0.0, 0.0, 1.0, 3.0, 1.0));
    });
    assert_eq!(text(&moved_then_scaled), ["........", "...##...", "........"]);
    // x' = 2 (3 + x)
    let scaled_then_moved = drawn(8, 3, |canvas| {
        canvas.scale(2.0, 1.0);
        canvas.translate(3.0, 1.0);
        canvas.fill_rect(unit(), Color::BLACK);
    });
    assert_eq!(text(&scaled_then_moved), ["........", "......##", "........"]);
    // A quarter turn clockwise: x' = −y, y' = x.
    let turned = drawn(4, 4, |canvas| {
        canvas.translate(4.0, 0.0);
        canvas.rotate(90.0);
        canvas.fill_rect(rect(1.0, 0.0, 4.0, 1.0), Color::BLACK);
        canvas.fill_rect(rect(0.0, 3.0, 1.0, 4.0), Color::RED);
    });
    assert_eq!(text(&turned), ["R...", "...#", "...#", "...#"]);
    let replaced = drawn(4, 1, |canvas| {
        canvas.scale(9.0, 9.0);
        canvas.transform(Transform::from_translate(7.0, 7.0));
        canvas.set_transform(Transform::from_translate(2.0, 0.0));
        canvas.transform(Transform::from_translate(1.0, 0.0));
        canvas.fill_rect(unit(), Color::BLACK);
    });
    assert_eq!(text(&replaced), ["...#"]);
}

// Clips

#[test]
fn a_clips_edge_is_antialiased_and_clips_multiply() {
    let picture = drawn(6, 1, |canvas| {
        canvas.clip_rect(rect(1.5, 0.0, 4.25, 1.0), Antialias::Analytic);
        canvas.fill(Color::BLACK);
    });
    // Halves and quarters of 255, rounded.
    assert_eq!(alphas(&picture, 0), [0, 128, 255, 255, 64, 0]);
    let picture = drawn(6, 1, |canvas| {
        canvas.clip_rect(rect(1.5, 0.0, 4.25, 1.0), Antialias::Analytic);
        canvas.clip_rect(rect(0.0, 0.0, 5.0, 0.5), Antialias::Analytic);
        canvas.fill(Color::BLACK);
    });
    assert_eq!(alphas(&picture, 0), [0, 64, 128, 128, 32, 0]);
    // Without antialiasing a pixel belongs to the clip by its centre.
    let picture = drawn(6, 1, |canvas| {
        canvas.clip_rect(rect(1.5, 0.0, 4.25, 0.6), Antialias::None);
        canvas.fill(Color::BLACK);
    });
    assert_eq!(alphas(&picture, 0), [0, 255, 255, 255, 0, 0]);
}

#[test]
fn filling_a_clip_is_filling_its_path() {
    let mut path = Path::new();
    path.circle((20.0, 15.5), 11.0).circle((27.0, 17.0), 9.3);
    for antialias in [Antialias::Analytic, Antialias::Exact, Antialias::Supersample(4), Antialias::None] {
        for rule in [FillRule::NonZero, FillRule::EvenOdd] {
            let paint = Paint::new(Color::BLACK).with_antialias(antialias);
            let filled = drawn(40, 30, |canvas| canvas.fill_path(&path, rule, &paint));
            let clipped = drawn(40, 30, |canvas| {
                canvas.clip_path(&path, rule, antialias);
                canvas.fill(&paint);
            });
            assert!(filled == clipped, "{antialias:?} {rule:?}");
            // Cut by pixels, both ways round.
            let inner = |canvas: &mut Canvas<'_>| canvas.clip_rect(rect(10.0, 8.0, 30.0, 20.0), antialias);
            let cut = drawn(40, 30, |canvas| {
                inner(canvas);
                canvas.fill_path(&path, rule, &paint);
            });
            let both = drawn(40, 30, |canvas| {
                canvas.clip_path(&path, rule, antialias);
                inner(canvas);
                canvas.fill(&paint);
            });
            // Where an edge is cut at the clip's side, the cut is rounded to 1/256 pixel.
            let near = cut.data().iter().zip(both.data()).all(|(a, b)| a.abs_diff(*b) <= 1);
            assert!(near && cut != filled, "{antialias:?} {rule:?}");
        }
    }
}

#[test]
fn rectangles_that_leave_a_shape_whole_clip_as_their_coverage_does() {
    const SIDE: u32 = 72;
    let mut seed = 5_u32;
    let mut random = |n: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) % n
    };
    let mut left_whole = 0;
    for case in 0..240 {
        let mut between = |least: u32, most: u32| least as f32 + random((most - least) * 16) as f32 / 16.0;
        let clips: Vec<Rect> =
            (0..1 + case % 3).map(|_| rect(between(0, 12), between(0, 12), between(52, 70), between(52, 70))).collect();
        let (at, size) = ((between(4, 60), between(4, 60)), between(1, 16));
        let antialias = [Antialias::Analytic, Antialias::Exact, Antialias::Supersample(4), Antialias::None][case % 4];
        let mut path = Path::new();
        path.move_to(at).quad_to((at.0 + size, at.1 - size), (at.0 + size, at.1 + size)).line_to((at.0, at.1 + size));
        let shape = |canvas: &mut Canvas<'_>| match case % 5 {
            0 => canvas.fill_rect(rect(at.0, at.1, at.0 + size, at.1 + size), Paint::new(HALF_BLACK)),
            1 => canvas.stroke_path(&path, &Stroke { width: 5.0, ..Stroke::default() }, Paint::new(Color::BLACK)),
            2 => canvas.fill(HALF_BLACK),
            _ => canvas.fill_path(&path, FillRule::NonZero, Paint::new(Color::BLACK)),
        };
        // A clip between them that is no rectangle, every other time.
        let mut hexagon = Path::new();
        hexagon.move_to((36.0, 0.0)).line_to((70.0, 20.0)).line_to((66.0, 60.0)).line_to((36.0, 72.0));
        hexagon.line_to((3.0, 55.0)).line_to((0.0, 18.0)).close();
        let by_rectangles = drawn(SIDE, SIDE, |canvas| {
            for (index, clip) in clips.iter().enumerate() {
                canvas.clip_rect(*clip, antialias);
                if index == 0 && case % 2 == 0 {
                    canvas.clip_path(&hexagon, FillRule::NonZero, antialias);
                }
            }
            shape(canvas);
        });
        let by_masks = drawn(SIDE, SIDE, |canvas| {
            for (index, clip) in clips.iter().enumerate() {
                let paint = Paint::new(Color::BLACK).with_antialias(antialias);
                let coverage = drawn(SIDE, SIDE, |canvas| canvas.fill_rect(*clip, &paint));
                canvas.clip_mask(Mask::from_pixmap(coverage.as_ref(), MaskKind::Alpha).unwrap(), 0, 0);
                if index == 0 && case % 2 == 0 {
                    canvas.clip_path(&hexagon, FillRule::NonZero, antialias);
                }
            }
            shape(canvas);
        });
        // Where an outline is cut at the bounds of all clips, the cut is rounded to 1/256 pixel: a sample may fall to its other side.
        let rounding = if matches!(antialias, Antialias::Supersample(_)) { 16 } else { 1 };
        let near = by_rectangles.data().iter().zip(by_masks.data()).all(|(a, b)| a.abs_diff(*b) <= rounding);
        assert!(near, "case {case}: {clips:?}, {at:?}, {size}, {antialias:?}");
        let is_whole = case % 5 != 2
            && clips.iter().all(|clip| {
                clip.left + 4.0 < at.0
                    && clip.top + 4.0 < at.1 - size
                    && at.0 + size < clip.right - 4.0
                    && at.1 + size < clip.bottom - 4.0
            });
        if is_whole && case % 2 == 1 {
            assert!(by_rectangles == drawn(SIDE, SIDE, shape), "case {case}: {clips:?}, {at:?}, {size}, {antialias:?}");
            left_whole += 1;
        }
    }
    // Some are, most are cut.
    assert!((10..100).contains(&left_whole), "{left_whole}");
}

#[test]
fn clip_bounds_are_those_of_all_clips() {
    let mut canvas = Canvas::new(20, 20).unwrap();
    assert_eq!(canvas.clip_bounds(), IntRect::from_ltrb(0, 0, 20, 20));
    canvas.clip_rect(rect(2.0, 3.0, 15.0, 12.0), Antialias::Analytic);
    canvas.save();
    canvas.clip_rect(rect(-5.0, 5.0, 10.0, 99.0), Antialias::Analytic);
    assert_eq!(canvas.clip_bounds(), IntRect::from_ltrb(2, 5, 10, 12));
    canvas.restore();
    assert_eq!(canvas.clip_bounds(), IntRect::from_ltrb(2, 3, 15, 12));
}

/// Clips, saves and draws between which `pause` is called.
fn draw_with_pauses(canvas: &mut Canvas<'_>, mut pause: impl FnMut(&mut Canvas<'_>)) {
    let mut circle = Path::new();
    circle.circle((0.0, 0.0), 7.5);
    let mask = Mask::from_vec(2, 40, (0..80).map(|i| i * 3).collect()).unwrap();
    canvas.clear(Color::WHITE);
    // Each clip goes with the transform under which it was made.
    canvas.set_transform(Transform::from_row(2.0, 0.0, 0.0, 2.0, 20.0, 20.0));
    canvas.clip_path(&circle, FillRule::NonZero, Antialias::Analytic);
    canvas.set_transform(Transform::IDENTITY);
    pause(canvas);
    canvas.save();
    canvas.clip_rect(rect(5.5, 5.5, 30.0, 31.0), Antialias::Analytic);
    canvas.fill(HALF_BLACK);
    pause(canvas);
    canvas.save();
    canvas.clip_mask(mask, 12, 0);
    canvas.fill(Color::RED);
    pause(canvas);
    canvas.fill(Color::from_rgba(0.0, 1.0, 0.0, 0.3));
    canvas.restore();
    pause(canvas);
    canvas.fill_rect(rect(0.0, 22.0, 40.0, 25.3), Color::BLUE);
    canvas.restore();
    pause(canvas);
    pause(canvas);
    canvas.fill_rect(rect(0.0, 27.0, 40.0, 29.0), Color::GREEN);
}

#[test]
fn clips_survive_a_flush_and_a_read() {
    let whole = drawn(40, 40, |canvas| draw_with_pauses(canvas, |_| {}));
    let flushed = drawn(40, 40, |canvas| draw_with_pauses(canvas, |canvas| canvas.flush().unwrap()));
    assert!(whole == flushed);
    let read = drawn(40, 40, |canvas| {
        draw_with_pauses(canvas, |canvas| {
            canvas.read_pixels(IntRect::from_xywh(0, 0, 4, 4)).unwrap();
        });
    });
    assert!(whole == read);
    assert!(whole.pixel(20, 28) == Some([0, 255, 0, 255]) && whole.pixel(2, 28) == Some([255; 4]));
}

/// From the second drawing on recordings share what a path is made of.
#[test]
fn a_path_that_is_drawn_again_looks_as_it_did_the_first_time() {
    let flower = |petals: u16| {
        let mut path = Path::new();
        for petal in 0..petals {
            let angle = f32::from(petal);
            path.circle((20.0 + 9.0 * angle.cos(), 20.0 + 9.0 * angle.sin()), 6.5);
        }
        path
    };
    let draw = |canvas: &mut Canvas<'_>, [clip, fill, stroke]: [&Path; 3]| {
        canvas.save();
        canvas.translate(3.25, -2.5);
        canvas.clip_path(clip, FillRule::EvenOdd, Antialias::Analytic);
        canvas.fill(Color::RED);
        canvas.restore();
        canvas.fill_path(fill, FillRule::EvenOdd, HALF_BLACK);
        canvas.stroke_path(stroke, &Stroke::new(1.5), Color::GREEN);
    };
    // Each path drawn once: nothing is shared.
    let fresh = |paths: [Path; 3]| drawn(40, 40, |canvas| draw(canvas, paths.each_ref()));
    let fives = fresh([flower(5), flower(5), flower(5)]);
    let (mut path, mut canvas) = (flower(5), Canvas::new(40, 40).unwrap());
    // Among other paths, at other places in the recording, and after a change.
    for round in 0..5 {
        canvas.clear(Color::TRANSPARENT);
        if round % 2 == 0 {
            draw(&mut canvas, [&flower(3); 3]);
            canvas.clear(Color::TRANSPARENT);
        }
        draw(&mut canvas, [&path; 3]);
        assert!(canvas.read_pixels(IntRect::from_xywh(0, 0, 40, 40)).unwrap() == fives, "round {round}");
    }
    path.extend(&flower(6), Transform::IDENTITY);
    let longer = || {
        let mut path = flower(5);
        path.extend(&flower(6), Transform::IDENTITY);
        path
    };
    let longer = fresh([longer(), longer(), longer()]);
    for round in 0..3 {
        canvas.clear(Color::TRANSPARENT);
        draw(&mut canvas, [&path; 3]);
        assert!(canvas.read_pixels(IntRect::from_xywh(0, 0, 40, 40)).unwrap() == longer, "round {round} of the change");
    }
    // A clip that outlives the recording, by a path that does not outlive the call.
    canvas.clear(Color::TRANSPARENT);
    {
        let path = flower(5);
        let _ = drawn(40, 40, |other| draw(other, [&path; 3]));
        canvas.clip_path(&path, FillRule::NonZero, Antialias::Analytic);
    }
    canvas.flush().unwrap();
    canvas.fill(Color::BLUE);
    let clipped = drawn(40, 40, |canvas| canvas.fill_path(&flower(5), FillRule::NonZero, Color::BLUE));
    assert!(canvas.into_pixmap() == clipped);
}

#[test]
fn a_mask_multiplies_by_its_values() {
    let picture = drawn(6, 2, |canvas| {
        canvas.clip_mask(Mask::from_vec(4, 1, vec![0, 64, 128, 255]).unwrap(), 1, 0);
        canvas.fill(Color::BLACK);
    });
    assert_eq!(alphas(&picture, 0), [0, 0, 64, 128, 255, 0]);
    assert_eq!(alphas(&picture, 1), [0; 6]);
    let picture = drawn(6, 1, |canvas| {
        canvas.clip_mask(Mask::from_vec(4, 1, vec![0, 64, 128, 255]).unwrap(), -1, 0);
        canvas.fill(HALF_BLACK);
    });
    // 64, 128 and 255 of 255 times 128 (half of 255, rounded).
    assert_eq!(alphas(&picture, 0), [32, 64, 128, 0, 0, 0]);
}

// Layers and masks

#[test]
fn a_layer_is_drawn_as_one_picture() {
    // Two black squares that overlap, half transparent together: one grey. 255 · (1 − 128/255) = 127.
    let picture = drawn(5, 1, |canvas| {
        canvas.clear(Color::WHITE);
        canvas.push_layer(0.5, BlendMode::SourceOver);
        canvas.fill_rect(rect(0.0, 0.0, 3.0, 1.0), Color::BLACK);
        canvas.fill_rect(rect(2.0, 0.0, 4.0, 1.0), Color::BLACK);
        canvas.pop_layer();
    });
    let grey = Some([127, 127, 127, 255]);
    assert_eq!([0, 1, 2, 3, 4].map(|x| picture.pixel(x, 0)), [grey, grey, grey, grey, Some([255; 4])]);
    // Opaque and unblended it changes nothing, whatever is drawn inside.
    let shapes = |canvas: &mut Canvas<'_>| {
        canvas.fill_circle((12.0, 10.0), 7.5, Color::RED);
        canvas.stroke_circle((15.0, 12.0), 6.0, &Stroke::new(2.5), Color::BLUE);
    };
    let plain = drawn(30, 24, shapes);
    let layered = drawn(30, 24, |canvas| {
        canvas.push_layer(1.0, BlendMode::SourceOver);
        canvas.push_layer(1.0, BlendMode::SourceOver);
        shapes(canvas);
        canvas.pop_layer();
        canvas.pop_layer();
    });
    assert!(plain == layered);
}

#[test]
fn a_layer_blends_by_its_mode() {
    let blended = |mode| {
        let picture = drawn(2, 1, |canvas| {
            canvas.clear(Color::from_rgb8(200, 100, 50));
            canvas.push_layer(1.0, mode);
            canvas.fill_rect(unit(), Color::from_rgb8(100, 200, 255));
            canvas.pop_layer();
        });
        [0, 1].map(|x| picture.pixel(x, 0).unwrap())
    };
    let backdrop = [200, 100, 50, 255];
    // 200 · 100 / 255 = 78.4, 100 · 200 / 255 = 78.4
    assert_eq!(blended(BlendMode::Multiply), [[78, 78, 50, 255], backdrop]);
    // 255 − 55 · 155 / 255 = 221.6
    assert_eq!(blended(BlendMode::Screen), [[222, 222, 255, 255], backdrop]);
    assert_eq!(blended(BlendMode::Plus), [[255, 255, 255, 255], backdrop]);
    // What of the layer is empty clears as well.
    assert_eq!(blended(BlendMode::Source), [[100, 200, 255, 255], [0; 4]]);
    assert_eq!(blended(BlendMode::DestinationIn), [backdrop, [0; 4]]);
    let empty = |mode| {
        drawn(1, 1, |canvas| {
            canvas.clear(Color::RED);
            canvas.push_layer(1.0, mode);
            canvas.pop_layer();
        })
        .pixel(0, 0)
    };
    assert_eq!(empty(BlendMode::Source), Some([0; 4]));
    assert_eq!(empty(BlendMode::SourceIn), Some([0; 4]));
    assert_eq!(empty(BlendMode::SourceOver), Some([255, 0, 0, 255]));
    assert_eq!(empty(BlendMode::Multiply), Some([255, 0, 0, 255]));
}

#[test]
fn a_clip_cuts_a_layer_once() {
    // Each of the layer's two draws cut by itself would leave 128 + 128 · 127 / 255 = 192.
    let picture = drawn(2, 1, |canvas| {
        canvas.clip_rect(rect(0.0, 0.0, 0.5, 1.0), Antialias::Analytic);
        canvas.push_layer(1.0, BlendMode::SourceOver);
        canvas.fill(Color::BLACK);
        canvas.fill(Color::BLACK);
        canvas.pop_layer();
    });
    assert_eq!(alphas(&picture, 0), [128, 0]);
}

#[test]
fn a_mask_hides_what_of_a_layer_it_does_not_show() {
    let masked = |kind, draw: fn(&mut Canvas<'_>)| {
        let picture = drawn(4, 1, |canvas| {
            canvas.push_layer(1.0, BlendMode::SourceOver);
            canvas.fill(Color::WHITE);
            canvas.push_mask(kind);
            draw(canvas);
            canvas.pop_mask();
            canvas.pop_layer();
        });
        alphas(&picture, 0)
    };
    let four = |canvas: &mut Canvas<'_>| {
        canvas.fill_rect(rect(0.0, 0.0, 1.0, 1.0), Color::RED);
        canvas.fill_rect(rect(1.0, 0.0, 2.0, 1.0), Color::from_rgba(1.0, 1.0, 1.0, 0.5));
        canvas.fill_rect(rect(2.0, 0.0, 3.0, 1.0), Color::BLACK);
    };
    assert_eq!(masked(MaskKind::Alpha, four), [255, 128, 255, 0]);
    // 0.2126 · 255 = 54.2; white at half alpha 128; black and nothing 0.
    assert_eq!(masked(MaskKind::Luminance, four), [54, 128, 0, 0]);
    assert_eq!(masked(MaskKind::Alpha, |_| {}), [0; 4]);
    // Green and blue: 0.7152 · 255 = 182.4, 0.0722 · 255 = 18.4.
    let two = |canvas: &mut Canvas<'_>| {
        canvas.fill_rect(rect(0.0, 0.0, 1.0, 1.0), Color::GREEN);
        canvas.fill_rect(rect(1.0, 0.0, 2.0, 1.0), Color::BLUE);
    };
    assert_eq!(masked(MaskKind::Luminance, two), [182, 18, 0, 0]);
    // Draws after the mask are not masked; the clip inside a layer does not reach the mask.
    let picture = drawn(4, 1, |canvas| {
        canvas.push_layer(1.0, BlendMode::SourceOver);
        canvas.clip_rect(rect(0.0, 0.0, 3.0, 1.0), Antialias::Analytic);
        canvas.fill(Color::WHITE);
        canvas.push_mask(MaskKind::Alpha);
        canvas.fill_rect(rect(2.0, 0.0, 4.0, 1.0), Color::BLACK);
        canvas.pop_mask();
        canvas.fill_rect(unit(), Color::RED);
        canvas.pop_layer();
    });
    assert_eq!(text(&picture), ["R.W."]);
}

// Pixels in the middle of drawing

#[test]
fn pixels_are_read_as_they_stand() {
    let mut canvas = Canvas::new(4, 1).unwrap();
    let all = IntRect::from_xywh(0, 0, 4, 1);
    canvas.fill_rect(rect(0.0, 0.0, 2.0, 1.0), Color::RED);
    assert_eq!(text(&canvas.read_pixels(all).unwrap()), ["RR.."]);
    canvas.fill_rect(rect(1.0, 0.0, 3.0, 1.0), Color::GREEN);
    assert_eq!(text(&canvas.read_pixels(all).unwrap()), ["RGG."]);
    assert_eq!(text(&canvas.read_pixels(IntRect::from_ltrb(-1, 0, 2, 2)).unwrap()), [".RG", "..."]);
    // Open layers and masks look as if they were closed, and stay open.
    canvas.push_layer(1.0, BlendMode::SourceOver);
    canvas.fill_rect(rect(0.0, 0.0, 4.0, 1.0), Color::BLUE);
    assert_eq!(text(&canvas.read_pixels(all).unwrap()), ["BBBB"]);
    canvas.push_mask(MaskKind::Alpha);
    canvas.fill_rect(rect(2.0, 0.0, 3.0, 1.0), Color::BLACK);
    assert_eq!(text(&canvas.read_pixels(all).unwrap()), ["RGB."]);
    canvas.fill_rect(rect(3.0, 0.0, 4.0, 1.0), Color::BLACK);
    canvas.pop_mask();
    canvas.fill_rect(unit(), Color::BLACK);
    canvas.pop_layer();
    assert_eq!(text(&canvas.into_pixmap()), ["#GBB"]);
}

#[test]
fn written_pixels_replace_what_is_there() {
    let two = drawn(2, 1, |canvas| canvas.fill_rect(unit(), Color::GREEN));
    let picture = drawn(6, 1, |canvas| {
        canvas.clear(Color::RED);
        // None of these matters.
        canvas.translate(3.0, 3.0);
        canvas.clip_rect(rect(0.0, 0.0, 0.0, 0.0), Antialias::Analytic);
        canvas.set_shadow(Shadow { offset_x: 3.0, offset_y: 0.0, deviation: 0.0, color: Color::BLACK });
        canvas.write_pixels(two.as_ref(), 1, 0).unwrap();
        canvas.write_pixels(two.as_ref(), 5, 0).unwrap();
        canvas.fill(Color::BLUE);
    });
    assert_eq!(text(&picture), ["RG.RRG"]);
    // An open layer is written to, within its bounds, and drawn with its opacity. Red under half a green: 127, 128.
    let picture = drawn(4, 1, |canvas| {
        canvas.clear(Color::RED);
        canvas.clip_rect(rect(1.0, 0.0, 4.0, 1.0), Antialias::Analytic);
        canvas.push_layer(0.5, BlendMode::SourceOver);
        canvas.write_pixels(two.as_ref(), 0, 0).unwrap();
        canvas.write_pixels(two.as_ref(), 2, 0).unwrap();
        canvas.pop_layer();
    });
    assert_eq!(picture.pixel(2, 0), Some([127, 128, 0, 255]));
    assert_eq!(text(&picture), ["RR?R"]);
}

// Shadows

#[test]
fn a_sharp_shadow_is_the_shape_moved_and_coloured() {
    let mut path = Path::new();
    path.circle((12.3, 11.8), 6.0).rect(rect(9.0, 8.0, 14.5, 25.25));
    let stroke = Stroke::new(2.5).with_cap(LineCap::Round);
    let shapes: [(&str, &dyn Fn(&mut Canvas<'_>, Color)); 6] = [
        ("fill", &|canvas, color| canvas.fill_path(&path, FillRule::EvenOdd, color)),
        ("stroke", &|canvas, color| canvas.stroke_path(&path, &stroke, color)),
        ("pixel circle", &|canvas, color| canvas.draw_pixel_circle((12, 12), 7, color)),
        ("pixel line", &|canvas, color| canvas.draw_pixel_line((2, 3), (20, 25), color)),
        ("aliased hairline", &|canvas, color| {
            canvas.stroke_path(&path, &Stroke::new(0.0), Paint::new(color).with_antialias(Antialias::None));
        }),
        ("half transparent", &|canvas, color| canvas.fill_path(&path, FillRule::NonZero, color.with_opacity(0.5))),
    ];
    for (name, shape) in shapes {
        for (dx, dy) in [(5, 3), (-4, 6), (0, -3), (30, 0)] {
            let found = drawn(40, 34, |canvas| {
                let (offset_x, offset_y) = (dx as f32, dy as f32);
                canvas.set_shadow(Shadow { offset_x, offset_y, deviation: 0.0, color: Color::RED });
                shape(canvas, Color::BLACK);
            });
            let expected = drawn(40, 34, |canvas| {
                // Drawn beyond the canvas's edges before it is moved.
                let moved = drawn(140, 134, |canvas| {
                    let mask = drawn(140, 134, |canvas| shape(canvas, Color::RED));
                    canvas.write_pixels(mask.as_ref(), dx, dy).unwrap();
                });
                canvas.write_pixels(moved.as_ref(), 0, 0).unwrap();
                shape(canvas, Color::BLACK);
            });
            // Where an edge is cut at a side of the shadow's surface, the cut is rounded to 1/256 pixel.
            let near = found.data().iter().zip(expected.data()).all(|(a, b)| a.abs_diff(*b) <= 1);
            assert!(near, "{name} by {dx}, {dy}");
        }
    }
}

#[test]
fn a_blurred_shadow_is_the_shapes_convolution_with_a_gaussian() {
    let (left, top, right, bottom) = (12, 10, 26, 19);
    for deviation in [0.6, 1.3, 1.9, 2.5, 5.0] {
        let found = drawn(44, 36, |canvas| {
            canvas.set_shadow(Shadow { offset_x: 3.0, offset_y: 2.0, deviation, color: Color::BLACK });
            let source = rect(left as f32, top as f32, right as f32, bottom as f32);
            canvas.fill_rect(source, Color::WHITE);
            canvas.set_shadow(None);
            canvas.clear_rect(source);
        });
        // From 3 on three boxes stand for the Gaussian.
        let (sigma, tolerance) = (f64::from(deviation), if deviation < 3.0 { 1.6 } else { 4.0 });
        let weight = |d: i32| (-f64::from(d * d) / (2.0 * sigma * sigma)).exp();
        let total: f64 = (-40..=40).map(weight).sum();
        let along = |at: i32, low: i32, high: i32| (low..high).map(|p| weight(at - p)).sum::<f64>() / total;
        for y in 0..36 {
            for x in 0..44 {
                if (left..right).contains(&x) && (top..bottom).contains(&y) {
                    continue;
                }
                let expected = 255.0 * along(x - 3, left, right) * along(y - 2, top, bottom);
                let alpha = f64::from(found.pixel(x as u32, y as u32).unwrap()[3]);
                assert!((alpha - expected).abs() < tolerance, "{deviation}: {alpha}, not {expected} at {x}, {y}");
            }
        }
    }
}

#[test]
fn a_clip_cuts_a_shadow_but_not_what_casts_it() {
    let picture = drawn(8, 1, |canvas| {
        canvas.set_shadow(Shadow { offset_x: 4.0, offset_y: 0.0, deviation: 0.0, color: Color::RED });
        canvas.clip_rect(rect(2.0, 0.0, 7.0, 1.0), Antialias::Analytic);
        canvas.fill_rect(rect(0.0, 0.0, 4.0, 1.0), Color::BLACK);
    });
    assert_eq!(text(&picture), ["..##RRR."]);
    // What fills the whole clip has no edge: its shadow shows through it evenly.
    let picture = drawn(6, 1, |canvas| {
        canvas.clip_rect(rect(1.0, 0.0, 5.0, 1.0), Antialias::Analytic);
        canvas.set_shadow(Shadow { offset_x: 2.0, offset_y: 0.0, deviation: 1.5, color: Color::BLACK });
        canvas.fill(HALF_BLACK);
    });
    // 128 over 128: 128 + 128 · 127 / 255 = 191.7
    assert_eq!(alphas(&picture, 0), [0, 192, 192, 192, 192, 0]);
    // Clearing casts none.
    let picture = drawn(4, 1, |canvas| {
        canvas.set_shadow(Shadow { offset_x: 2.0, offset_y: 0.0, deviation: 0.0, color: Color::RED });
        canvas.clear(Color::BLUE);
        canvas.clear_rect(unit());
    });
    assert_eq!(text(&picture), [".BBB"]);
}

#[test]
fn clearing_replaces_every_pixel_whatever_its_color() {
    // The last is 128 in all four components.
    let translucent = [Color::from_rgba8(200, 100, 50, 77), Color::from_rgba8(255, 255, 255, 128)];
    for color in [Color::WHITE, Color::BLACK, Color::TRANSPARENT, Color::RED].into_iter().chain(translucent) {
        for (width, height) in [(1, 1), (16, 8), (37, 21), (64, 40), (130, 9)] {
            let mut canvas = Canvas::new(width, height).unwrap();
            canvas.fill(Color::from_rgb8(1, 2, 3));
            canvas.clear(color);
            let cleared = canvas.into_pixmap();
            let expected = color.premultiply();
            assert!(cleared.data().as_chunks::<4>().0.iter().all(|pixel| *pixel == expected), "{color:?} {width}");
            // Within a clip of whole pixels, and in a layer.
            let mut canvas = Canvas::new(width, height).unwrap();
            canvas.fill(Color::BLUE);
            canvas.save();
            canvas.clip_rect(Rect::from_xywh(0.0, 4.0, width as f32, 3.0), Antialias::None);
            canvas.clear(color);
            canvas.restore();
            canvas.push_layer(1.0, BlendMode::Source);
            canvas.fill_rect(Rect::from_xywh(0.0, 0.0, width as f32, 2.0), Color::RED);
            canvas.clear(color);
            canvas.pop_layer();
            let layered = canvas.into_pixmap();
            assert!(layered.data().as_chunks::<4>().0.iter().all(|pixel| *pixel == expected), "{color:?} {width}");
            let mut canvas = Canvas::new(width, height).unwrap();
            canvas.fill(Color::BLUE);
            canvas.clip_rect(Rect::from_xywh(0.0, 4.0, width as f32, 3.0), Antialias::None);
            canvas.clear(color);
            let clipped = canvas.into_pixmap();
            for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
                let expected = if (4..7).contains(&y) { expected } else { [0, 0, 255, 255] };
                assert_eq!(clipped.pixel(x, y), Some(expected), "{color:?} {x} {y}");
            }
        }
    }
}
