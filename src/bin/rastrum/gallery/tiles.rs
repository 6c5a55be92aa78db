//! Tiles, bins, and buffers of ids and materials.

use rastrum::glam::Mat4;
use rastrum::scene::{Camera, Look, Mesh, Scene, SceneSettings, Shading};
use rastrum::space::compress::{TileCode, tiled_index};
use rastrum::space::{
    Blend, ClipDepth, Compare, Cull, Depth, DepthFormat, Pipeline, Primitives, Samples, State, Target, VertexColor,
    camera,
};
use rastrum::{Color, IntRect, Pixmap, Point, Rect, Result};

use super::board::{AMBER, BLUE, Board, FAINT, GREEN, GREY, INK, MINT, PALE, RED, ROSE, SKY, VIOLET, mix};
use super::parts::confetti;
use super::stage::{self, Triangle, Vertex};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        60,
        "Zmax culling",
        "Layers drawn front to back. A tile that lies behind the farthest depth stored for it is skipped whole (blue): all but those along the border that still shows.",
        zmax,
    ),
    row(
        61,
        "Zmin culling",
        "Layers drawn back to front. A tile that lies in front of the nearest stored depth needs no depth to be read: all of them (green) pass unread.",
        zmin,
    ),
    row(
        62,
        "Buffer compression",
        "A depth buffer's tiles: cleared (white, 0 bytes), one value (green, 4), a plane with small differences (blue, 44), too varied (red, 256).",
        compression,
    ),
    row(
        63,
        "Tiled texture layout",
        "Where texels lie in memory. In rows, a step down is a whole row away; in 4 × 4 tiles, neighbours both ways are mostly near.",
        layout,
    ),
    row(
        65,
        "Binned: set-up and cull",
        "What becomes of each triangle before any bin sees it: kept (blue), no area (red), turned away (grey), off the screen (amber), between all centres (violet).",
        setup,
    ),
    row(
        66,
        "Binned: coarse",
        "Bands of rows, and the numbers of the triangles that each lists: every band that a triangle touches.",
        coarse,
    ),
    row(
        67,
        "Binned: fine",
        "Each band drawn on its own from its list, pulled apart on the left; pushed together they are the direct draw.",
        fine,
    ),
    row(
        68,
        "Bit fields to lists",
        "A bit for each triangle (row) and band (column). Read along the bands, the bits become lists, in the order of submission.",
        bits,
    ),
    row(
        69,
        "Visibility buffer",
        "First pass: which triangle each pixel sees (a colour for each number). Second pass: every pixel is shaded once, by its triangle.",
        visibility,
    ),
    row(
        70,
        "G-buffer",
        "A material pass leaves colour, normal and depth for each pixel; light comes afterwards, from these alone.",
        g_buffer,
    ),
    row(
        71,
        "Depth prepass",
        "How often each pixel is shaded. Left up to many times, as nearer triangles come later; right, with depths known beforehand, once.",
        prepass,
    ),
    row(
        72,
        "Small triangles",
        "A ball of 8,192 triangles, most smaller than a pixel, and of 128: a colour for each triangle. Small ones are tested against the few centres that their box holds.",
        small,
    ),
    row(
        73,
        "Reversed float depth",
        "Two walls at 9,000 and 9,010 with the near plane at 0.01. Forward depth gives both the same few values and they fight; reversed, floats are fine where distance needs it.",
        reversed,
    ),
];

/// Layers over all of a square of 128 at the given depths, drawn one by one: for each, what `count` takes of the tiles.
fn layers(board: &mut Board, depths: [f32; 8], color: Color, hidden: bool) -> Result<()> {
    let [left, right] = board.panels(["PICTURE", "TILES OF EACH LAYER"]);
    let mut target = stage::paper(128, 128, Samples::One)?;
    let palette = [RED, AMBER, GREEN, BLUE, VIOLET, SKY, MINT, ROSE];
    let pipeline = stage::pipeline(128, 128, State::default());
    let base = right.bottom - 30.0;
    for (i, (z, tint)) in depths.into_iter().zip(palette).enumerate() {
        // Each layer behind reaches a little farther out; each one in front a little less far.
        let inset = (if hidden { 7 - i } else { i }) as f32 * 6.0;
        let bounds = if hidden { [inset, inset, 128.0, 128.0] } else { [0.0, 0.0, 128.0 - inset, 128.0 - inset] };
        let counters = stage::draw_opaque(&mut target, &pipeline, &stage::quad(bounds, z, tint, (128, 128)));
        let share = if hidden { counters.tiles_hidden } else { counters.tiles_in_front };
        let x = right.left + 10.0 + i as f32 * 34.0;
        let height = |tiles: u64| tiles as f32 * 0.44;
        board.bar(Rect::from_xywh(x, base - height(counters.tiles), 24.0, height(counters.tiles)), FAINT);
        board.bar(Rect::from_xywh(x, base - height(share), 24.0, height(share)), color);
        board.middle(Point::new(x + 12.0, base + 14.0), 11.0, &(i + 1).to_string(), INK);
    }
    board.picture(left, target.to_pixmap()?);
    Ok(())
}

fn zmax(board: &mut Board) -> Result<()> {
    layers(board, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8], BLUE, true)
}

fn zmin(board: &mut Board) -> Result<()> {
    layers(board, [0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1], GREEN, false)
}

fn compression(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["PICTURE", "TILES"]);
    let size = (128, 128);
    let mut target = Target::with_format(size.0, size.1, DepthFormat::D24, Samples::One)?;
    target.clear_color(Color::WHITE);
    let mut list = stage::flat([(12.0, 116.0), (60.0, 10.0), (120.0, 90.0)], 0.3, SKY, size).to_vec();
    for (vertex, z) in list.iter_mut().zip([-0.6, 0.2, 0.5]) {
        vertex.position[2] = z;
    }
    list.extend(stage::quad([84.0, 8.0, 124.0, 48.0], 0.6, MINT, size));
    let mut random = stage::Random::new(62);
    for _ in 0..60 {
        let (x, y) = (random.within(16.0, 60.0), random.within(76.0, 116.0));
        list.extend(stage::flat([(x, y), (x + 6.0, y + 1.0), (x + 2.0, y + 7.0)], random.within(0.0, 0.2), ROSE, size));
    }
    stage::draw_opaque(&mut target, &stage::pipeline(size.0, size.1, State::default()), &list);
    board.picture(left, target.to_pixmap()?);
    let grid = board.grid(right, 16, 16);
    let clear = DepthFormat::D24.key(1.0) as u32;
    for (tx, ty) in (0..16).flat_map(|y| (0..16).map(move |x| (x, y))) {
        let key = |x: usize, y: usize| {
            DepthFormat::D24.key(target.depth(tx * 8 + x as u32, ty * 8 + y as u32).unwrap_or(1.0)) as u32
        };
        let tile: [[u32; 8]; 8] = std::array::from_fn(|y| std::array::from_fn(|x| key(x, y)));
        let color = match TileCode::compress(&tile, clear) {
            TileCode::Cleared => Color::WHITE,
            TileCode::Constant(_) => MINT,
            TileCode::Plane { .. } => SKY,
            TileCode::Raw(_) => ROSE,
        };
        board.cell(&grid, (tx as i32, ty as i32), color);
    }
    board.lines(&grid);
    Ok(())
}

fn layout(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["ROWS", "4 X 4 TILES"]);
    for (rect, tiled) in [(left, false), (right, true)] {
        let grid = board.grid(rect, 8, 8);
        let index = |(x, y): (usize, usize)| if tiled { tiled_index(x, y, 8) } else { y * 8 + x };
        let mut places: Vec<(usize, usize)> = (0..8).flat_map(|y| (0..8).map(move |x| (x, y))).collect();
        for at in &places {
            let color = mix(SKY, ROSE, index(*at) as f32 / 63.0);
            board.cell(&grid, (at.0 as i32, at.1 as i32), color);
        }
        board.lines(&grid);
        places.sort_by_key(|at| index(*at));
        let line: Vec<Point> = places.iter().map(|(x, y)| grid.map(*x as f32 + 0.5, *y as f32 + 0.5)).collect();
        board.polyline(&line, 1.4, GREY);
        for at in places {
            board.mark(&grid, (at.0 as i32, at.1 as i32), &index(at).to_string(), INK);
        }
    }
    Ok(())
}

fn setup(board: &mut Board) -> Result<()> {
    // The screen is the middle 20 × 12 of 28 × 17.
    let rect = Rect::from_xywh(16.0, 10.0, 608.0, 300.0);
    let grid = board.grid(rect, 28, 17);
    let screen = (20, 12);
    let triangles: [(Triangle, Color); 7] = [
        ([(1.2, 10.6), (5.8, 1.4), (10.4, 8.9)], BLUE),
        ([(12.1, 9.8), (14.2, 2.2), (19.4, 7.1)], BLUE),
        ([(7.6, 3.2), (11.9, 4.4), (9.1, 7.2)], GREY),
        ([(2.5, 10.5), (7.5, 10.5), (12.5, 10.5)], RED),
        ([(-3.8, -1.8), (-0.6, 2.4), (-3.2, 6.2)], AMBER),
        ([(20.8, 13.6), (23.6, 10.2), (22.8, 14.2)], AMBER),
        ([(11.58, 1.62), (11.9, 1.7), (11.7, 1.95)], VIOLET),
    ];
    let mut target = Target::new(screen.0, screen.1)?;
    let state = State { cull: Cull::Back, front_face: rastrum::space::FrontFace::Clockwise, ..State::default() };
    let mut list = Vec::new();
    for (i, (corners, color)) in triangles.into_iter().enumerate() {
        // The third one the other way round.
        let [a, b, c] = corners;
        list.extend(stage::flat(if i == 2 { [a, c, b] } else { corners }, 0.5, color, screen));
    }
    let counters = stage::draw(&mut target, &stage::pipeline(screen.0, screen.1, state), &list, &stage::carried);
    let place = |(x, y): (f32, f32)| (x + 4.0, y + 2.0);
    for (x, y) in (0..screen.1).flat_map(|y| (0..screen.0).map(move |x| (x, y))) {
        let lit = target.pixel(x, y).is_some_and(|pixel| pixel[3] != 0);
        board.cell(&grid, (x as i32 + 4, y as i32 + 2), if lit { SKY } else { PALE });
    }
    board.lines(&grid);
    for (corners, color) in triangles {
        board.outline(&grid, &corners.map(place), 2.4, color);
    }
    let counts = [
        ("KEPT", counters.setups, BLUE),
        ("NO AREA", counters.zero_area, RED),
        ("CULLED", counters.culled, GREY),
        ("OUTSIDE", counters.outside, AMBER),
        ("NO CENTRE", counters.no_samples, VIOLET),
    ];
    for (i, (name, count, color)) in counts.into_iter().enumerate() {
        let x = 70.0 + i as f32 * 124.0;
        board.middle(Point::new(x, 338.0), 20.0, &count.to_string(), color);
        board.middle(Point::new(x, 370.0), 11.0, name, color);
    }
    Ok(())
}

/// A few triangles on a square of 128, numbered by their order.
fn numbered() -> Vec<Vertex> {
    let corners: [Triangle; 6] = [
        [(8.0, 14.0), (60.0, 8.0), (30.0, 52.0)],
        [(70.0, 10.0), (120.0, 30.0), (88.0, 120.0)],
        [(10.0, 60.0), (52.0, 70.0), (20.0, 118.0)],
        [(40.0, 30.0), (100.0, 44.0), (60.0, 74.0)],
        [(44.0, 84.0), (84.0, 90.0), (60.0, 122.0)],
        [(96.0, 70.0), (124.0, 74.0), (110.0, 100.0)],
    ];
    let colors = [SKY, MINT, ROSE, AMBER, VIOLET, RED];
    let depth = |i: usize| 0.9 - i as f32 * 0.1;
    corners
        .into_iter()
        .zip(colors)
        .enumerate()
        .flat_map(|(i, (t, color))| stage::flat(t, depth(i), color, (128, 128)))
        .collect()
}

/// The picture of the numbered triangles, and four bands with their lists.
fn bands() -> Result<(Pixmap, u32, Vec<Vec<u32>>)> {
    let mut target = stage::paper(128, 128, Samples::One)?;
    // Eight bands a thread at least: pairs of them are shown as one of 16 rows.
    let pipeline = stage::pipeline(128, 128, State::default()).with_threads(2);
    let list = numbered();
    let (rows, bins) = stage::bins(&target, &pipeline, &list);
    stage::draw_opaque(&mut target, &pipeline, &list);
    let merged = bins.chunks(2).map(|pair| {
        let mut list = pair.concat();
        list.sort_unstable();
        list.dedup();
        list
    });
    Ok((target.to_pixmap()?, rows * 2, merged.collect()))
}

fn coarse(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["BANDS", "THEIR LISTS"]);
    let (picture, rows, bins) = bands()?;
    let grid = board.picture(left, picture);
    for (i, vertex) in numbered().chunks(3).enumerate() {
        let middle =
            vertex.iter().fold((0.0, 0.0), |sum, v| (sum.0 + v.position[0] / 3.0, sum.1 + v.position[1] / 3.0));
        board.middle(grid.map((middle.0 + 1.0) * 64.0, (1.0 - middle.1) * 64.0), 14.0, &i.to_string(), INK);
    }
    for (i, list) in bins.iter().enumerate() {
        let y = (i as u32 * rows) as f32;
        board.segment(grid.map(0.0, y), grid.map(128.0, y), 1.2, INK);
        let at = grid.map(0.0, y + rows as f32 / 2.0);
        for (k, id) in list.iter().enumerate() {
            let rect = Rect::from_xywh(right.left + 20.0 + k as f32 * 36.0, at.y - 11.0, 30.0, 22.0);
            board.bar(rect, [SKY, MINT, ROSE, AMBER, VIOLET, RED][*id as usize % 6]);
            board.middle(rect.center(), 11.0, &id.to_string(), INK);
        }
    }
    Ok(())
}

fn fine(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["BAND BY BAND", "DIRECT"]);
    let list = numbered();
    let mut direct = stage::paper(128, 128, Samples::One)?;
    stage::draw_opaque(&mut direct, &stage::pipeline(128, 128, State::default()), &list);
    board.picture(right, direct.to_pixmap()?);
    for band in 0..4 {
        let scissor = Some(IntRect::from_xywh(0, band * 32, 128, 32));
        let mut target = stage::paper(128, 128, Samples::One)?;
        stage::draw_opaque(&mut target, &stage::pipeline(128, 128, State { scissor, ..State::default() }), &list);
        let part = target.to_pixmap()?.as_ref().crop(IntRect::from_xywh(0, band * 32, 128, 32))?;
        let rect = Rect::from_xywh(left.left, left.top + 10.0 + band as f32 * 82.0, left.width(), 72.0);
        let grid = board.picture(rect, part);
        board.frame(grid.rect(), GREY);
    }
    Ok(())
}

fn bits(board: &mut Board) -> Result<()> {
    let (_, _, bins) = bands()?;
    let count = bins.len() as u32;
    let grid = board.grid(Rect::from_xywh(80.0, 30.0, 540.0, 200.0), count, 6);
    for (band, list) in bins.iter().enumerate() {
        for id in 0..6 {
            let set = list.contains(&id);
            board.cell(&grid, (band as i32, id as i32), if set { SKY } else { Color::WHITE });
            board.mark(&grid, (band as i32, id as i32), if set { "1" } else { "0" }, if set { INK } else { GREY });
        }
        let x = grid.map(band as f32 + 0.5, 0.0).x;
        board.middle(Point::new(x, grid.top - 12.0), 10.0, &band.to_string(), GREY);
        board.arrow(Point::new(x, grid.rect().bottom + 4.0), Point::new(x, grid.rect().bottom + 22.0), GREY);
        for (k, id) in list.iter().enumerate() {
            board.middle(Point::new(x, grid.rect().bottom + 38.0 + k as f32 * 20.0), 13.0, &id.to_string(), BLUE);
        }
    }
    board.lines(&grid);
    for id in 0..6 {
        board.middle(Point::new(grid.left - 18.0, grid.map(0.0, id as f32 + 0.5).y), 11.0, &format!("T{id}"), INK);
    }
    board.label(16.0, 12.0, 11.0, "BAND", GREY);
    board.label(16.0, grid.rect().bottom + 34.0, 11.0, "LIST", BLUE);
    Ok(())
}

fn visibility(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["IDS", "SHADED"]);
    let size = 96;
    let mut list = confetti(26, size, 9);
    for (i, vertex) in list.iter_mut().enumerate() {
        let light = [1.0, 0.72, 0.45][i % 3];
        vertex.values = [vertex.values[0] * light, vertex.values[1] * light, vertex.values[2] * light, 1.0];
    }
    let pipeline = stage::pipeline(size, size, State::default());
    let primitives = Primitives::triangles(&list);
    let mut ids = Target::new(size, size)?;
    pipeline.draw_visibility(&mut ids, &primitives, &stage::shader());
    let mut target = stage::paper(size, size, Samples::One)?;
    pipeline.shade_visibility(&ids, &mut target, &primitives, &stage::shader(), &VertexColor);
    let mut data = Vec::new();
    for (x, y) in (0..size).flat_map(|y| (0..size).map(move |x| (x, y))) {
        let id = ids.pixel(x, y).map_or(0, u32::from_le_bytes);
        data.extend(id_color(id >> 3, id != 0).premultiply());
    }
    board.picture(left, Pixmap::from_vec(size, size, data)?);
    board.picture(right, target.to_pixmap()?);
    Ok(())
}

/// A colour for a number.
fn id_color(id: u32, some: bool) -> Color {
    let bits = id.wrapping_add(1).wrapping_mul(0x9e37_79b9);
    let part = |shift: u32| 0.3 + 0.65 * ((bits >> shift) & 255) as f32 / 255.0;
    if some { Color::from_rgba(part(24), part(16), part(8), 1.0) } else { Color::WHITE }
}

fn still_life() -> (Scene, Camera) {
    let scene = stage::scene(vec![
        (stage::floor(2.2, -0.7), stage::matte(MINT), Mat4::IDENTITY),
        (Mesh::sphere(0.7, 40, 20, 0), stage::matte(RED), stage::at(-0.7, 0.0, 0.2)),
        (
            Mesh::cuboid([-0.5, -0.7, -0.5], [0.5, 0.5, 0.5], 0),
            stage::matte(BLUE),
            camera::product(&stage::at(0.8, 0.0, -0.3), &camera::rotation([0.0, 1.0, 0.0], 0.6)),
        ),
    ]);
    let camera = Camera { near: 2.0, far: 7.0, ..Camera::look_at([0.6, 1.8, 3.4], [0.0, -0.2, 0.0], [0.0, 1.0, 0.0]) };
    (scene, camera)
}

fn g_buffer(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["COLOUR", "NORMAL", "DEPTH", "LIT"]);
    let (scene, camera) = still_life();
    let looks = [
        SceneSettings { shading: Some(Shading::Unlit), ..stage::settings() },
        SceneSettings { look: Look::Normals, ..stage::settings() },
        SceneSettings { look: Look::Depth, ..stage::settings() },
        stage::settings(),
    ];
    for (rect, settings) in panels.into_iter().zip(looks) {
        stage::show(board, rect, &scene, &camera, &settings)?;
    }
    Ok(())
}

fn prepass(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["DIRECT", "AFTER A PREPASS"]);
    let mut list = confetti(90, 128, 71);
    for vertex in &mut list {
        vertex.values = [1.0 / 255.0; 4];
    }
    let mut pipeline = stage::pipeline(128, 128, State { blend: Blend::Additive, ..State::default() });
    for (rect, before) in [(left, false), (right, true)] {
        let mut target = Target::new(128, 128)?;
        if before {
            pipeline.draw_depth(&mut target, &Primitives::triangles(&list), &stage::shader());
            pipeline = pipeline.after_prepass();
        }
        stage::draw(&mut target, &pipeline, &list, &stage::carried);
        let mut data = Vec::new();
        for (x, y) in (0..128).flat_map(|y| (0..128).map(move |x| (x, y))) {
            let times = target.pixel(x, y).map_or(0, |pixel| pixel[3]);
            let color = match times {
                0 => Color::WHITE,
                1 => MINT,
                2 => AMBER,
                n => mix(RED, INK, (f32::from(n) - 3.0) / 6.0),
            };
            data.extend(color.premultiply());
        }
        board.picture(rect, Pixmap::from_vec(128, 128, data)?);
    }
    for (i, (name, color)) in [("1", MINT), ("2", AMBER), ("3 AND MORE", RED)].into_iter().enumerate() {
        let x = 190.0 + i as f32 * 70.0;
        board.bar(Rect::from_xywh(x, 376.0, 14.0, 14.0), color);
        board.label(x + 20.0, 378.0, 10.0, name, INK);
    }
    Ok(())
}

fn small(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["8192 TRIANGLES", "128 TRIANGLES"]);
    for (rect, columns, rows) in [(left, 64, 64), (right, 8, 8)] {
        let scene = stage::scene(vec![(Mesh::sphere(1.0, columns, rows, 0), stage::matte(BLUE), Mat4::IDENTITY)]);
        let camera = Camera::look_at([0.3, 0.7, 1.95], [0.0; 3], [0.0, 1.0, 0.0]);
        let settings = SceneSettings {
            look: Look::Ids,
            cull: Some(Cull::Back),
            background: Color::TRANSPARENT,
            ..stage::settings()
        };
        let (ids, _) = stage::view(&scene, &camera, (64, 64), &settings)?;
        let mut data = Vec::new();
        for pixel in ids.data().as_chunks::<4>().0 {
            let id = u32::from_le_bytes(*pixel) & 0xff_ffff;
            data.extend(id_color(id, pixel[3] != 0).premultiply());
        }
        board.picture(rect, Pixmap::from_vec(64, 64, data)?);
    }
    Ok(())
}

fn reversed(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["FORWARD", "REVERSED"]);
    let forward = camera::perspective(1.0, 1.0, 0.01, 10_000.0);
    let backward = camera::perspective_reversed(1.0, 1.0, 0.01);
    let cases = [
        (left, forward, ClipDepth::MinusOneToOne, 1.0, Compare::LessEqual),
        (right, backward, ClipDepth::ZeroToOne, 0.0, Compare::Greater),
    ];
    for (rect, projection, clip_depth, clear, compare) in cases {
        let mut target = stage::paper(48, 48, Samples::One)?;
        target.clear_depth(clear);
        // Turned a little, so that rounding goes both ways.
        let wall = |x0: f32, x1: f32, z: f32, color: Color| {
            [(x0, -0.8), (x1, -0.8), (x1, 0.8), (x0, -0.8), (x1, 0.8), (x0, 0.8)].map(|(x, y)| {
                let z = z + x * 6.0 + y * 3.0;
                let at = camera::transform(&projection, [x * 4500.0, y * 4500.0, z, 1.0]);
                Vertex { position: at, values: stage::components(color) }
            })
        };
        let list: Vec<Vertex> =
            wall(-0.9, 0.5, -9000.0, RED).into_iter().chain(wall(-0.5, 0.9, -9010.0, BLUE)).collect();
        let mut pipeline: Pipeline =
            stage::pipeline(48, 48, State { depth: Depth::compare(compare), ..State::default() });
        pipeline.viewport.clip_depth = clip_depth;
        stage::draw_opaque(&mut target, &pipeline, &list);
        board.zoomed(rect, target.to_pixmap()?);
    }
    Ok(())
}
