//! Antialiasing.

use std::f64::consts::{PI, TAU};

use rastrum::scene::antialias::{box_average, shared_samples};
use rastrum::scene::{Camera, Mesh, Scene, SceneAntialias, SceneSettings};
use rastrum::space::{Accumulation, Samples, State};
use rastrum::{Antialias, Canvas, Color, FillRule, Paint, Pixmap, Point, Rect, Result, Stroke};

use super::board::{AMBER, BLUE, Board, GREY, Grid, INK, RED, VIOLET};
use super::stage::{self, Triangle};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        121,
        "Coverage as alpha",
        "A thin line, aliased and with each pixel's coverage as its alpha. Numbers are percent: along each column they add up to the line's vertical width.",
        coverage_alpha,
    ),
    row(
        122,
        "Box filter: the pixel's area",
        "The exact area of each pixel that lies inside the shape, in percent. The lower edge runs through pixel centres and leaves half of each pixel.",
        box_filter,
    ),
    row(
        123,
        "Filter before sampling",
        "Rings that get finer outwards. Sampled at pixel centres the fine ones come back as false rings; averaged over the pixel's area first they fade to grey.",
        filter_first,
    ),
    row(
        124,
        "Convolution is multiplication of spectra",
        "A signal (blue), a box kernel (amber) and their convolution (red) in space; below their spectra. The red spectrum is the product of the two others.",
        spectra,
    ),
    row(
        125,
        "Jaggies and the sample count",
        "One edge with 1, 4, 16 and 64 samples a pixel, and how far it is from the exact area: the bars fall as the samples grow.",
        jaggies,
    ),
    row(
        126,
        "Wagon wheel",
        "A wheel of eight spokes turns by 40° a frame, clockwise. Sharp frames (top) seem to turn back by 5°, as the marked spoke's neighbours show; with the shutter open (bottom) nothing seems to turn back.",
        wagon_wheel,
    ),
    row(113, "SSAA", "The picture at four times the width and height, and the average of each 4 × 4 block.", ssaa),
    row(
        114,
        "MSAA",
        "Left one sample, right four: the depth and coverage tests run for every sample, the shader once per pixel and triangle. Interiors are the same.",
        msaa,
    ),
    row(
        115,
        "Sample positions",
        "Where the samples lie inside a pixel, in sixteenths: no two share a row or a column.",
        positions,
    ),
    row(
        116,
        "CSAA",
        "16 coverage samples give an edge 17 shades, where MSAA 4× has 5; only 4 colours are kept. The curves: coverage of a half-plane against its true area.",
        csaa,
    ),
    row(
        117,
        "EQAA",
        "Eight coverage samples, of which four (filled) keep a colour: edges as fine as MSAA 8× at half the memory.",
        eqaa,
    ),
    row(
        118,
        "FXAA",
        "A filter on the finished picture: it finds edges by their luma and blends along them. Flat areas stay as they are.",
        fxaa,
    ),
    row(
        119,
        "Temporal antialiasing",
        "The mean of 1, 4, 16 and 64 frames, each with the camera moved by a fraction of a pixel. It converges to supersampling.",
        temporal,
    ),
    row(
        120,
        "Shared samples",
        "Samples on the sides of pixels serve both neighbours: six samples for two pixels instead of eight. Right: the edge as they give it.",
        shared,
    ),
];

/// A zoomed drawing on white.
fn drawing(width: u32, height: u32, antialias: Antialias, draw: impl FnOnce(&mut Canvas<'_>, Paint)) -> Result<Pixmap> {
    let settings = rastrum::RenderSettings::default().with_threads(1);
    let mut canvas = Canvas::with_settings(width, height, settings)?;
    canvas.clear(Color::WHITE);
    draw(&mut canvas, Paint::new(BLUE).with_antialias(antialias));
    Ok(canvas.into_pixmap())
}

/// How much of a pixel is covered, from white to blue, by its red component.
fn covered(picture: &Pixmap, x: u32, y: u32) -> f32 {
    let blue = BLUE.to_rgba8()[0];
    picture.pixel(x, y).map_or(0.0, |p| (255.0 - f32::from(p[0])) / (255.0 - f32::from(blue)))
}

fn percents(board: &mut Board, grid: &Grid, picture: &Pixmap) {
    for y in 0..grid.rows {
        for x in 0..grid.columns {
            let share = (covered(picture, x, y) * 100.0).round() as i32;
            if share > 0 {
                board.mark(grid, (x as i32, y as i32), &share.to_string(), if share > 60 { Color::WHITE } else { INK });
            }
        }
    }
}

fn coverage_alpha(board: &mut Board) -> Result<()> {
    let draw = |antialias| {
        drawing(16, 5, antialias, |canvas, paint| {
            canvas.draw_line((0.0, 1.0), (16.0, 3.9), &Stroke::new(1.0), paint);
        })
    };
    let (aliased, smooth) = (draw(Antialias::None)?, draw(Antialias::Exact)?);
    let grid = board.zoomed(Rect::from_xywh(16.0, 6.0, 608.0, 190.0), aliased);
    let ends = [(0.0, 0.51), (16.0, 3.41), (16.0, 4.39), (0.0, 1.49)];
    board.outline(&grid, &ends, 1.2, INK);
    let grid = board.zoomed(Rect::from_xywh(16.0, 204.0, 608.0, 190.0), smooth.clone());
    percents(board, &grid, &smooth);
    Ok(())
}

fn box_filter(board: &mut Board) -> Result<()> {
    let corners = [(1.0, 1.3), (11.6, 0.6), (13.0, 6.5), (3.0, 6.5)];
    let picture = drawing(14, 8, Antialias::Exact, |canvas, paint| {
        canvas.fill_polygon(&corners.map(|(x, y)| Point::new(x, y)), FillRule::NonZero, paint);
    })?;
    let whole = board.whole();
    let grid = board.zoomed(whole, picture.clone());
    board.outline(&grid, &corners, 1.6, INK);
    percents(board, &grid, &picture);
    Ok(())
}

/// Rings whose distance shrinks outwards, `n` samples a pixel's side.
fn rings(side: u32, n: u32) -> Result<Pixmap> {
    let mut data = Vec::new();
    let size = side * n;
    for y in 0..size {
        for x in 0..size {
            let place = |v: u32| (f64::from(v) + 0.5) / f64::from(size);
            let r2 = place(x) * place(x) + place(y) * place(y);
            let value = 0.5 + 0.5 * libm::cos(r2 * f64::from(side) * 1.15 * PI);
            let byte = (value * 255.0 + 0.5) as u8;
            data.extend([byte, byte, byte, 255]);
        }
    }
    Pixmap::from_vec(size, size, data)
}

fn filter_first(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["SAMPLED AT CENTRES", "AVERAGED, THEN SAMPLED"]);
    board.picture(left, rings(96, 1)?);
    board.picture(right, box_average(&rings(96, 8)?, 8)?);
    Ok(())
}

/// Lengths of a signal's Fourier coefficients.
fn spectrum(signal: &[f64]) -> Vec<f64> {
    let n = signal.len();
    let part = |k: usize, f: fn(f64) -> f64| -> f64 {
        signal.iter().enumerate().map(|(i, v)| v * f(TAU * ((i * k) % n) as f64 / n as f64)).sum()
    };
    (0..n).map(|k| (part(k, libm::cos), part(k, libm::sin))).map(|(re, im)| (re * re + im * im).sqrt()).collect()
}

fn spectra(board: &mut Board) -> Result<()> {
    const N: usize = 64;
    let signal: Vec<f64> = (0..N).map(|i| if (i / 4) % 3 == 0 || (30..44).contains(&i) { 1.0 } else { 0.1 }).collect();
    let kernel: Vec<f64> = (0..N).map(|i| if (i + 3) % N < 7 { 1.0 / 7.0 } else { 0.0 }).collect();
    let blurred: Vec<f64> = (0..N).map(|i| (0..N).map(|k| signal[(i + N - k) % N] * kernel[k]).sum()).collect();
    let space = board.axes(
        Rect::from_xywh(10.0, 4.0, 620.0, 194.0),
        (0.0, N as f32),
        (0.0, 1.1),
        ("PLACE", "SIGNAL, KERNEL, CONVOLUTION"),
    );
    let steps =
        |values: &[f64]| -> Vec<(f32, f32)> { values.iter().enumerate().map(|(i, v)| (i as f32, *v as f32)).collect() };
    let centred: Vec<f64> = (0..N).map(|i| kernel[(i + N / 2) % N] * 3.0).collect();
    board.curve(&space, steps(&signal), BLUE);
    board.curve(&space, steps(&centred), AMBER);
    board.curve(&space, steps(&blurred), RED);
    let frequency = board.axes(
        Rect::from_xywh(10.0, 202.0, 620.0, 194.0),
        (0.0, N as f32 / 2.0),
        (0.0, 16.0),
        ("FREQUENCY", "SPECTRA"),
    );
    let (s, k, b) = (spectrum(&signal), spectrum(&kernel), spectrum(&blurred));
    let half = |values: &[f64], scale: f64| -> Vec<(f32, f32)> {
        values.iter().take(N / 2).enumerate().map(|(i, v)| (i as f32, (v * scale) as f32)).collect()
    };
    board.curve(&frequency, half(&s, 1.0), BLUE);
    board.curve(&frequency, half(&k, 14.0), AMBER);
    board.curve(&frequency, half(&b, 1.0), RED);
    Ok(())
}

fn jaggies(board: &mut Board) -> Result<()> {
    let edge = |canvas: &mut Canvas<'_>, paint: Paint| {
        canvas.fill_polygon(
            &[Point::new(0.0, 9.3), Point::new(14.0, 2.6), Point::new(14.0, 14.0), Point::new(0.0, 14.0)],
            FillRule::NonZero,
            paint,
        );
    };
    let exact = drawing(14, 12, Antialias::Exact, edge)?;
    let panels = board.tiles(4, &["1", "4", "16", "64 SAMPLES"]);
    for ((rect, n), i) in panels.into_iter().zip([1_u8, 2, 4, 8]).zip(0..) {
        let antialias = if n == 1 { Antialias::None } else { Antialias::Supersample(n) };
        let picture = drawing(14, 12, antialias, edge)?;
        let pixels = || (0..12).flat_map(|y| (0..14).map(move |x| (x, y)));
        let error: f32 =
            pixels().map(|(x, y)| (covered(&picture, x, y) - covered(&exact, x, y)).abs()).sum::<f32>() / 14.0;
        let top = Rect::from_xywh(rect.left, rect.top, rect.width(), 180.0);
        board.zoomed(top, picture);
        let base = 380.0;
        let height = (error * 500.0).max(1.0);
        board.bar(Rect::from_xywh(rect.left + 45.0, base - height, rect.width() - 90.0, height), RED);
        board.middle(
            Point::new(rect.left + rect.width() / 2.0, base - height - 14.0),
            11.0,
            &format!("{:.3}", error),
            INK,
        );
        if i == 0 {
            board.label(rect.left, 215.0, 11.0, "MEAN ERROR OF EDGE PIXELS", GREY);
        }
    }
    Ok(())
}

/// A wheel of eight spokes, one of them red, on a square of 100.
fn wheel(degrees: f32) -> Result<Pixmap> {
    drawing(100, 100, Antialias::Analytic, |canvas, paint| {
        canvas.stroke_circle((50.0, 50.0), 44.0, &Stroke::new(5.0), paint.clone());
        canvas.fill_circle((50.0, 50.0), 8.0, paint.clone());
        canvas.translate(50.0, 50.0);
        canvas.rotate(degrees);
        for _ in 0..8 {
            canvas.draw_line((0.0, 0.0), (0.0, -43.0), &Stroke::new(5.0), paint.clone());
            canvas.rotate(45.0);
        }
    })
}

fn wagon_wheel(board: &mut Board) -> Result<()> {
    for frame in 0..5 {
        let angle = frame as f32 * 40.0;
        let left = 14.0 + frame as f32 * 124.0;
        board.picture(Rect::from_xywh(left, 42.0, 116.0, 130.0), wheel(angle)?);
        // The spoke that is taken for the one marked first: 5° behind it each frame.
        let apparent = f64::from(-5.0 * frame as f32) * PI / 180.0;
        let at =
            Point::new(left + 58.0 + (38.0 * libm::sin(apparent)) as f32, 107.0 - (38.0 * libm::cos(apparent)) as f32);
        board.canvas.fill_circle(at, 6.0, RED);
        let mut sum = Accumulation::new(100, 100)?;
        for step in 0..40 {
            sum.add(&wheel(angle + step as f32)?, 1)?;
        }
        board.picture(Rect::from_xywh(left, 238.0, 116.0, 130.0), sum.average()?);
    }
    board.text(16.0, 16.0, "SHARP FRAMES: SEEM TO TURN BACK");
    board.text(16.0, 212.0, "SHUTTER OPEN: A BLUR");
    Ok(())
}

const EDGES: Triangle = [(1.2, 13.4), (7.6, 1.3), (15.0, 10.6)];

fn triangle(scale: f32, samples: Samples, size: u32) -> Result<Pixmap> {
    let corners = EDGES.map(|(x, y)| (x * scale, y * scale));
    stage::picture(&stage::flat(corners, 0.5, BLUE, (size, size)), (size, size), samples, State::default())
}

fn ssaa(board: &mut Board) -> Result<()> {
    let [one, large, mean] = board.panels(["1 SAMPLE", "4 X 4 PIXELS", "THEIR AVERAGE"]);
    board.zoomed(one, triangle(1.0, Samples::One, 16)?);
    let four = triangle(4.0, Samples::One, 64)?;
    board.picture(large, four.clone());
    board.zoomed(mean, box_average(&four, 4)?);
    Ok(())
}

fn msaa(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["1 SAMPLE", "MSAA 4X"]);
    for (rect, samples) in [(left, Samples::One), (right, Samples::Msaa4)] {
        let grid = board.zoomed(rect, triangle(1.0, samples, 16)?);
        for y in 0..16 {
            for x in 0..16 {
                for (sx, sy) in samples.positions() {
                    board.dot(&grid, x as f32 + f32::from(*sx) / 16.0, y as f32 + f32::from(*sy) / 16.0, 1.4, AMBER);
                }
            }
        }
        board.outline(&grid, &EDGES, 1.5, INK);
    }
    Ok(())
}

/// A pixel with its samples.
fn pixel(board: &mut Board, rect: Rect, samples: Samples) {
    let grid = board.grid(rect, 16, 16);
    board.lines(&grid);
    board.canvas.stroke_rect(grid.rect(), &Stroke::new(2.0), INK);
    for (i, (x, y)) in samples.positions().iter().enumerate() {
        let keeps = i < samples.colors();
        board.dot(&grid, f32::from(*x), f32::from(*y), 6.5, if keeps { RED } else { INK });
        if !keeps {
            board.dot(&grid, f32::from(*x), f32::from(*y), 4.5, Color::WHITE);
        }
    }
}

fn positions(board: &mut Board) -> Result<()> {
    let panels = board.tiles(3, &["1", "MSAA 2X", "MSAA 4X", "MSAA 8X", "CSAA 16/4", "EQAA 8/4"]);
    for (rect, samples) in panels.into_iter().zip(Samples::ALL) {
        pixel(board, rect, samples);
    }
    Ok(())
}

/// A nearly level edge.
fn edge(samples: Samples) -> Result<Pixmap> {
    let size = (34, 4);
    let corners = [(0.0, 2.9), (34.0, 1.1), (34.0, 4.0), (0.0, 4.0)];
    let mut vertices = stage::flat([corners[0], corners[2], corners[1]], 0.5, BLUE, size).to_vec();
    vertices.extend(stage::flat([corners[0], corners[3], corners[2]], 0.5, BLUE, size));
    stage::picture(&vertices, size, samples, State::default())
}

/// The share of samples above a line y = t + slope·x through the pixel, less the true area.
fn half_plane(samples: Samples, t: f32) -> f32 {
    let slope = 0.3;
    let above =
        samples.positions().iter().filter(|(x, y)| f32::from(*y) / 16.0 < t + slope * (f32::from(*x) / 16.0 - 0.5));
    above.count() as f32 / samples.coverage() as f32
}

fn csaa(board: &mut Board) -> Result<()> {
    for (top, name, samples) in [(6.0, "MSAA 4X", Samples::Msaa4), (106.0, "CSAA 16/4", Samples::Csaa16x4)] {
        board.label(16.0, top, 11.0, name, INK);
        board.picture(Rect::from_xywh(16.0, top + 16.0, 608.0, 72.0), edge(samples)?);
    }
    let axes = board.axes(
        Rect::from_xywh(10.0, 206.0, 620.0, 190.0),
        (0.0, 1.0),
        (0.0, 1.0),
        ("PLACE OF THE EDGE", "COVERAGE"),
    );
    board.curve(&axes, (0..=200).map(|i| i as f32 / 200.0).map(|t| (t, half_plane(Samples::Msaa4, t))), AMBER);
    board.curve(&axes, (0..=200).map(|i| i as f32 / 200.0).map(|t| (t, half_plane(Samples::Csaa16x4, t))), BLUE);
    board.curve(&axes, [(0.0, 0.0), (1.0, 1.0)], GREY);
    let at = axes.map(0.04, 0.9);
    board.label(at.x, at.y, 11.0, "MSAA 4X", AMBER);
    board.label(at.x, at.y + 18.0, 11.0, "CSAA 16/4", BLUE);
    Ok(())
}

fn eqaa(board: &mut Board) -> Result<()> {
    let rect = Rect::from_xywh(16.0, 40.0, 230.0, 320.0);
    pixel(board, rect, Samples::Eqaa8x4);
    for (i, (name, samples)) in
        [("MSAA 4X", Samples::Msaa4), ("EQAA 8/4", Samples::Eqaa8x4), ("MSAA 8X", Samples::Msaa8)]
            .into_iter()
            .enumerate()
    {
        let top = 40.0 + i as f32 * 112.0;
        board.label(262.0, top, 11.0, name, INK);
        board.picture(Rect::from_xywh(256.0, top + 18.0, 376.0, 66.0), edge(samples)?);
    }
    Ok(())
}

/// Two bars and a ball, for edges at all angles.
fn shapes() -> (Scene, Camera) {
    let turned = |angle: f32| rastrum::space::camera::rotation([0.0, 0.0, 1.0], angle);
    let unlit = |color| rastrum::scene::Material { shading: rastrum::scene::Shading::Unlit, ..stage::matte(color) };
    let scene = stage::scene(vec![
        (Mesh::cuboid([-1.6, -0.22, -0.1], [1.6, 0.22, 0.1], 0), unlit(BLUE), turned(0.25)),
        (Mesh::cuboid([-1.6, -0.22, -0.2], [1.6, 0.22, 0.0], 0), unlit(RED), turned(1.25)),
    ]);
    (scene, Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0]))
}

fn smoothed(antialias: SceneAntialias, size: u32) -> Result<Pixmap> {
    let (scene, camera) = shapes();
    Ok(stage::view(&scene, &camera, (size, size), &SceneSettings { antialias, ..stage::settings() })?.0)
}

fn fxaa(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["BEFORE", "AFTER"]);
    board.picture(left, smoothed(SceneAntialias::None, 48)?);
    board.picture(right, smoothed(SceneAntialias::Fxaa, 48)?);
    Ok(())
}

/// The mean difference of two pictures in levels.
fn difference(a: &Pixmap, b: &Pixmap) -> f32 {
    let sum: u32 = a.data().iter().zip(b.data()).map(|(a, b)| u32::from(a.abs_diff(*b))).sum();
    sum as f32 / a.data().len() as f32
}

fn temporal(board: &mut Board) -> Result<()> {
    let truth = smoothed(SceneAntialias::Supersample(8), 32)?;
    let panels = board.tiles(4, &["1", "4", "16", "64 FRAMES"]);
    for (rect, n) in panels.into_iter().zip([1, 4, 16, 64]) {
        let picture = smoothed(SceneAntialias::Temporal(n), 32)?;
        let error = difference(&picture, &truth);
        board.picture(Rect::from_xywh(rect.left, rect.top, rect.width(), 170.0), picture);
        let height = (error * 34.0).clamp(1.0, 130.0);
        board.bar(Rect::from_xywh(rect.left + 45.0, 382.0 - height, rect.width() - 90.0, height), RED);
        board.middle(
            Point::new(rect.left + rect.width() / 2.0, 382.0 - height - 14.0),
            11.0,
            &format!("{error:.2}"),
            INK,
        );
    }
    board.label(16.0, 212.0, 11.0, "MEAN DIFFERENCE FROM SSAA 8 X 8, IN LEVELS", GREY);
    Ok(())
}

fn shared(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["6 SAMPLES, 2 PIXELS", "AN EDGE"]);
    let grid = board.grid(left, 2, 1);
    board.lines(&grid);
    board.canvas.stroke_rect(grid.rect(), &Stroke::new(2.0), INK);
    for x in 0..3 {
        for y in [0.25, 0.75] {
            board.dot(&grid, x as f32, y, 9.0, if x == 1 { RED } else { BLUE });
        }
    }
    for x in [0.5, 1.5] {
        for y in [0.25, 0.75] {
            board.arrow(grid.map(x - 0.4, y), grid.map(x - 0.12, 0.5), GREY);
            board.arrow(grid.map(x + 0.4, y), grid.map(x + 0.12, 0.5), GREY);
        }
        board.dot(&grid, x, 0.5, 6.0, VIOLET);
    }
    // Samples of a half-plane: one column more than pixels, twice the rows.
    let side = 14_u32;
    let mut data = Vec::new();
    for y in 0..side * 2 {
        for x in 0..=side {
            let (px, py) = (x as f32, (y as f32 + 0.5) / 2.0);
            let inside = py > 2.0 + px * 0.62;
            data.extend(if inside { BLUE.premultiply() } else { [255; 4] });
        }
    }
    let samples = Pixmap::from_vec(side + 1, side * 2, data)?;
    let grid = board.zoomed(right, shared_samples(&samples)?);
    board.segment(grid.map(0.0, 2.0), grid.map(14.0, 10.68), 1.5, INK);
    Ok(())
}
