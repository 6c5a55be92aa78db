//! Tests on fragments, blending, and what they are kept in.

use rastrum::scene::{AlphaMode, Camera, Material, Mesh, SceneSettings, shadow_volumes};
use rastrum::space::{
    Accumulation, Blend, Compare, Depth, Frames, Samples, State, Stencil, StencilFace, StencilOp, Target, camera,
};
use rastrum::{Color, IntRect, Pixmap, Point, Rect, Result};

use super::board::{AMBER, BLUE, Board, GREEN, GREY, INK, MINT, PALE, RED, SKY, VIOLET, grey, mix};
use super::stage::{self, Vertex};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        15,
        "Discard",
        "A shader that discards makes round holes. They leave neither colour nor depth: the red square behind, drawn later, shows through.",
        discard,
    ),
    row(
        16,
        "Colour buffer",
        "Cleared to one value, then written by a triangle. The numbers are what is read back of the red component.",
        color_buffer,
    ),
    row(
        17,
        "Depth buffer",
        "The same two triangles with four compare functions. Which one shows, and whether anything does, is the function's choice.",
        depth_buffer,
    ),
    row(
        18,
        "Stencil operations",
        "A stencil buffer of rising values (top row) after each operation on its lower half, the reference being 5.",
        stencil_operations,
    ),
    row(
        19,
        "Accumulation buffer",
        "Eight frames of a moving square, added up and divided: motion blur. Equal frames would give the frame.",
        accumulation,
    ),
    row(
        20,
        "Two buffers",
        "While the front buffer is shown, the back buffer is drawn. Present swaps them: nobody sees the half-drawn one.",
        double_buffer,
    ),
    row(
        93,
        "Scissor test",
        "The same drawing without and with a scissor rectangle: nothing is drawn outside, and inside it is unchanged.",
        scissor,
    ),
    row(
        94,
        "Alpha test",
        "A disc whose alpha falls outwards (left), kept where alpha is at least one half (right). What fails leaves no depth either.",
        alpha_test,
    ),
    row(
        96,
        "Stencil test",
        "The eight functions with reference 3 against stored values 0 to 6: blue cells pass.",
        stencil_test,
    ),
    row(
        97,
        "Stencil shadows",
        "A box's shadow volume (left, outlined) is counted with z-fail: where the count is not zero, the floor is in shadow.",
        stencil_shadows,
    ),
    row(
        101,
        "Alpha blending",
        "Source over: C = α·Cf + (1 − α)·Cb for α from 0 to 1 over two grounds.",
        alpha_blending,
    ),
    row(
        102,
        "Blend stages",
        "Two discs in the four other stages: added, the smaller and the larger of each component, and multiplied.",
        blend_stages,
    ),
    row(
        103,
        "Sorting for transparency",
        "Three panes of half-transparent glass. Drawn from far to near they mix rightly; in the wrong order the far ones come to the front.",
        sorting,
    ),
];

const SIZE: (u32, u32) = (32, 24);

fn discard(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let mut target = stage::paper(SIZE.0, SIZE.1, Samples::One)?;
    let pipeline = stage::pipeline(SIZE.0, SIZE.1, State::default());
    stage::draw(&mut target, &pipeline, &stage::quad([4.0, 3.0, 28.0, 21.0], 0.3, BLUE, SIZE), &|fragment| {
        let (x, y) = ((fragment.x as f32 + 0.5) % 8.0 - 4.0, (fragment.y as f32 + 0.5) % 8.0 - 4.0);
        (x * x + y * y > 6.5).then(|| stage::components(BLUE))
    });
    stage::draw(&mut target, &pipeline, &stage::quad([10.0, 8.0, 31.0, 23.0], 0.6, RED, SIZE), &stage::carried);
    board.zoomed(whole, target.to_pixmap()?);
    Ok(())
}

fn color_buffer(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["CLEARED", "WRITTEN"]);
    let size = (10, 10);
    let mut target = stage::paper(size.0, size.1, Samples::One)?;
    target.clear_color(Color::from_rgb8(200, 220, 240));
    for (rect, draws) in [(left, false), (right, true)] {
        if draws {
            let mut list = stage::flat([(0.5, 9.5), (4.0, 0.5), (9.8, 7.0)], 0.5, RED, size);
            list[2].values = stage::components(AMBER);
            stage::draw(&mut target, &stage::pipeline(size.0, size.1, State::default()), &list, &stage::carried);
        }
        let grid = board.zoomed(rect, target.to_pixmap()?);
        for (x, y) in (0..10).flat_map(|y| (0..10).map(move |x| (x, y))) {
            let value = target.pixel(x, y).map_or(0, |pixel| pixel[0]);
            board.mark(&grid, (x as i32, y as i32), &value.to_string(), INK);
        }
    }
    Ok(())
}

/// A blue triangle, then a red one that leans through it.
fn two_triangles() -> Vec<Vertex> {
    let mut list = stage::flat([(2.0, 21.0), (14.0, 2.0), (28.0, 17.0)], 0.5, SKY, SIZE).to_vec();
    let mut leaning = stage::flat([(3.0, 5.0), (30.0, 9.0), (12.0, 23.0)], 0.5, RED, SIZE);
    for (vertex, z) in leaning.iter_mut().zip([-0.8, 0.8, 0.1]) {
        vertex.position[2] = z;
    }
    list.extend(leaning);
    list
}

fn depth_buffer(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["LESS, CLEAR 1", "GREATER, CLEAR 0", "ALWAYS", "EQUAL, CLEAR 0.5"]);
    let cases = [(Compare::Less, 1.0), (Compare::Greater, 0.0), (Compare::Always, 1.0), (Compare::Equal, 0.5)];
    for (rect, (compare, clear)) in panels.into_iter().zip(cases) {
        let mut target = stage::paper(SIZE.0, SIZE.1, Samples::One)?;
        target.clear_depth(clear);
        let state = State { depth: Depth::compare(compare), ..State::default() };
        stage::draw(&mut target, &stage::pipeline(SIZE.0, SIZE.1, state), &two_triangles(), &stage::carried);
        board.zoomed(rect, target.to_pixmap()?);
    }
    Ok(())
}

const OPERATIONS: [(StencilOp, &str); 8] = [
    (StencilOp::Keep, "KEEP"),
    (StencilOp::Zero, "ZERO"),
    (StencilOp::Replace, "REPLACE"),
    (StencilOp::IncrementClamp, "+1, CLAMP"),
    (StencilOp::DecrementClamp, "-1, CLAMP"),
    (StencilOp::Invert, "INVERT"),
    (StencilOp::IncrementWrap, "+1, WRAP"),
    (StencilOp::DecrementWrap, "-1, WRAP"),
];

fn stencil_operations(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &OPERATIONS.map(|(_, name)| name));
    let values = [0_u8, 1, 5, 100, 200, 254, 255];
    for (rect, (op, _)) in panels.into_iter().zip(OPERATIONS) {
        let mut target = Target::new(7, 2)?;
        for (x, value) in values.into_iter().enumerate() {
            let x = x as f32;
            let set = StencilFace { reference: value, pass: StencilOp::Replace, ..StencilFace::default() };
            stamp(&mut target, set, [x, 0.0, x + 1.0, 2.0]);
        }
        stamp(&mut target, StencilFace { reference: 5, pass: op, ..StencilFace::default() }, [0.0, 1.0, 7.0, 2.0]);
        let grid = board.grid(rect, 7, 2);
        for (x, y) in (0..2).flat_map(|y| (0..7).map(move |x| (x, y))) {
            let value = target.stencil(x, y).unwrap_or(0);
            board.cell(
                &grid,
                (x as i32, y as i32),
                mix(Color::WHITE, if y == 0 { GREY } else { BLUE }, f32::from(value) / 400.0),
            );
            board.mark(&grid, (x as i32, y as i32), &value.to_string(), INK);
        }
        board.lines(&grid);
    }
    Ok(())
}

/// Draws a rectangle onto the stencil buffer alone.
fn stamp(target: &mut Target, face: StencilFace, bounds: [f32; 4]) {
    let (width, height) = (target.width(), target.height());
    let state =
        State { depth: Depth::OFF, stencil: Some(Stencil::both(face)), color_mask: [false; 4], ..State::default() };
    let list = stage::quad(bounds, 0.5, Color::BLACK, (width, height));
    stage::draw(target, &stage::pipeline(width, height, state), &list, &stage::carried);
}

fn accumulation(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["ONE FRAME OF EIGHT", "THEIR MEAN"]);
    let frame = |i: u32| -> Result<Pixmap> {
        let x = 2.0 + i as f32 * 2.0;
        stage::picture(&stage::quad([x, 7.0, x + 10.0, 17.0], 0.5, BLUE, SIZE), SIZE, Samples::One, State::default())
    };
    let mut sum = Accumulation::new(SIZE.0, SIZE.1)?;
    for i in 0..8 {
        sum.add(&frame(i)?, 1)?;
    }
    board.zoomed(left, frame(3)?);
    board.zoomed(right, sum.average()?);
    Ok(())
}

fn double_buffer(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["FRONT, SHOWN", "BACK, HALF DRAWN", "FRONT AFTER PRESENT", "BACK, AS IT WAS"]);
    let mut first = stage::paper(SIZE.0, SIZE.1, Samples::One)?;
    first.clear_color(PALE);
    let mut frames = Frames::new(first);
    let pipeline = stage::pipeline(SIZE.0, SIZE.1, State::default());
    stage::draw(frames.back(), &pipeline, &stage::quad([4.0, 6.0, 14.0, 18.0], 0.5, BLUE, SIZE), &stage::carried);
    frames.present();
    frames.back().clear_color(PALE);
    stage::draw(frames.back(), &pipeline, &stage::quad([12.0, 6.0, 17.0, 18.0], 0.5, BLUE, SIZE), &stage::carried);
    let before = [frames.front().to_pixmap()?, frames.back().to_pixmap()?];
    stage::draw(frames.back(), &pipeline, &stage::quad([17.0, 6.0, 22.0, 18.0], 0.5, BLUE, SIZE), &stage::carried);
    frames.present();
    let after = [frames.front().to_pixmap()?, frames.back().to_pixmap()?];
    for (rect, picture) in panels.into_iter().zip(before.into_iter().chain(after)) {
        board.picture(rect, picture);
    }
    Ok(())
}

fn scissor(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["WITHOUT", "WITH"]);
    let bounds = IntRect::from_xywh(8, 5, 17, 13);
    for (rect, scissor) in [(left, None), (right, Some(bounds))] {
        let state = State { scissor, ..State::default() };
        let grid = board.zoomed(rect, stage::picture(&two_triangles(), SIZE, Samples::One, state)?);
        board.outline(&grid, &[(8.0, 5.0), (25.0, 5.0), (25.0, 18.0), (8.0, 18.0)], 2.0, INK);
    }
    Ok(())
}

fn alpha_test(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["ALPHA", "ALPHA >= 128"]);
    for (rect, test) in [(left, None), (right, Some((Compare::GreaterEqual, 128)))] {
        let mut target = stage::paper(SIZE.0, SIZE.0, Samples::One)?;
        let size = (SIZE.0, SIZE.0);
        let state = State { alpha_test: test, blend: Blend::SourceOver, ..State::default() };
        let pipeline = stage::pipeline(size.0, size.1, state);
        stage::draw(&mut target, &pipeline, &stage::quad([0.0, 0.0, 32.0, 32.0], 0.4, BLUE, size), &|fragment| {
            let (x, y) = (fragment.x as f32 - 15.5, fragment.y as f32 - 15.5);
            let alpha = (1.35 - (x * x + y * y).sqrt() / 14.0).clamp(0.0, 1.0);
            Some(stage::components(BLUE.with_opacity(alpha)))
        });
        // Behind it, drawn later.
        let behind = stage::pipeline(size.0, size.1, State::default());
        stage::draw(&mut target, &behind, &stage::quad([0.0, 18.0, 32.0, 22.0], 0.6, AMBER, size), &stage::carried);
        board.zoomed(rect, target.to_pixmap()?);
    }
    Ok(())
}

const FUNCTIONS: [(Compare, &str); 8] = [
    (Compare::Never, "NEVER"),
    (Compare::Less, "LESS"),
    (Compare::Equal, "EQUAL"),
    (Compare::LessEqual, "LESS, EQUAL"),
    (Compare::Greater, "GREATER"),
    (Compare::NotEqual, "NOT EQUAL"),
    (Compare::GreaterEqual, "GREATER, EQUAL"),
    (Compare::Always, "ALWAYS"),
];

fn stencil_test(board: &mut Board) -> Result<()> {
    let grid = board.grid(Rect::from_xywh(210.0, 44.0, 420.0, 340.0), 7, 8);
    let mut target = stage::paper(7, 8, Samples::One)?;
    for x in 0..7_u8 {
        let set = StencilFace { reference: x, pass: StencilOp::Replace, ..StencilFace::default() };
        stamp(&mut target, set, [f32::from(x), 0.0, f32::from(x) + 1.0, 8.0]);
    }
    for (y, (compare, name)) in FUNCTIONS.into_iter().enumerate() {
        let face = StencilFace { compare, reference: 3, ..StencilFace::default() };
        let state = State { depth: Depth::OFF, stencil: Some(Stencil::both(face)), ..State::default() };
        let list = stage::quad([0.0, y as f32, 7.0, y as f32 + 1.0], 0.5, SKY, (7, 8));
        stage::draw(&mut target, &stage::pipeline(7, 8, state), &list, &stage::carried);
        let at = grid.map(0.0, y as f32 + 0.5);
        board.label(16.0, at.y - 6.0, 11.0, name, INK);
    }
    for (x, y) in (0..8).flat_map(|y| (0..7).map(move |x| (x, y))) {
        if target.pixel(x, y).is_some_and(|pixel| pixel != [255; 4]) {
            board.cell(&grid, (x as i32, y as i32), SKY);
        }
        board.mark(&grid, (x as i32, y as i32), &x.to_string(), INK);
    }
    board.lines(&grid);
    board.label(16.0, 18.0, 11.0, "3 AGAINST", GREY);
    Ok(())
}

fn stencil_shadows(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["VOLUME", "SHADOW"]);
    let cube = Mesh::cuboid([-0.5, 0.9, -0.5], [0.5, 1.9, 0.5], 0);
    let floor = stage::floor(2.6, 0.0);
    let light = [1.0, 1.7, 0.6, 0.0];
    let corners = |mesh: &Mesh| -> Vec<[[f32; 3]; 3]> {
        let place = |i: u32| mesh.vertices.get(i as usize).map_or([0.0; 3], |v| v.position);
        mesh.triangles().into_iter().map(|t| t.map(place)).collect()
    };
    let size = (left.width() as u32, left.height() as u32);
    let view = Camera { near: 0.5, far: 30.0, ..Camera::look_at([2.8, 3.4, 4.6], [-0.2, 0.4, 0.0], [0.0, 1.0, 0.0]) };
    let m = camera::product(&view.projection_matrix(size.0 as f32 / size.1 as f32), &view.view);
    let place =
        |p: [f32; 4], color: Color| Vertex { position: camera::transform(&m, p), values: stage::components(color) };
    let solid = |mesh: &Mesh, color: Color| -> Vec<Vertex> {
        let shades = [0.8, 0.65, 1.0, 0.5, 0.9, 0.6];
        let face = |i: usize| mix(Color::BLACK, color, shades[i / 2 % 6]);
        let corner = |i: usize, [x, y, z]: [f32; 3]| place([x, y, z, 1.0], face(i));
        corners(mesh).into_iter().enumerate().flat_map(|(i, t)| t.map(|p| corner(i, p))).collect()
    };
    let volumes: Vec<Vertex> =
        shadow_volumes(&corners(&cube), light).into_iter().flatten().map(|p| place(p, RED)).collect();
    for (rect, shown) in [(left, true), (right, false)] {
        let mut target = stage::paper(size.0, size.1, Samples::One)?;
        let pipeline = stage::pipeline(size.0, size.1, State::default());
        for list in [solid(&floor, MINT), solid(&cube, BLUE)] {
            stage::draw_opaque(&mut target, &pipeline, &list);
        }
        if shown {
            let fill = rastrum::space::Fill::Wireframe;
            let state = State { fill, depth: Depth::OFF, ..State::default() };
            stage::draw(&mut target, &stage::pipeline(size.0, size.1, state), &volumes, &stage::carried);
        } else {
            let count = |op: StencilOp| StencilFace { depth_fail: op, ..StencilFace::default() };
            let stencil = Stencil { back: count(StencilOp::IncrementWrap), front: count(StencilOp::DecrementWrap) };
            let depth = Depth { write: false, clamp: true, ..Depth::default() };
            let state = State { stencil: Some(stencil), depth, color_mask: [false; 4], ..State::default() };
            stage::draw(&mut target, &stage::pipeline(size.0, size.1, state), &volumes, &stage::carried);
            let dark = StencilFace { compare: Compare::NotEqual, ..StencilFace::default() };
            // Only where something is drawn: behind it there is no floor for a shadow.
            let depth = Depth { write: false, ..Depth::compare(Compare::Greater) };
            let state =
                State { stencil: Some(Stencil::both(dark)), depth, blend: Blend::SourceOver, ..State::default() };
            let all = stage::quad([0.0, 0.0, size.0 as f32, size.1 as f32], 0.9999, INK.with_opacity(0.6), size);
            stage::draw(&mut target, &stage::pipeline(size.0, size.1, state), &all, &stage::carried);
        }
        board.picture(rect, target.to_pixmap()?);
    }
    Ok(())
}

fn alpha_blending(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let size = (33, 12);
    let mut target = stage::paper(size.0, size.1, Samples::One)?;
    let plain = stage::pipeline(size.0, size.1, State::default());
    stage::draw(&mut target, &plain, &stage::quad([0.0, 6.0, 33.0, 12.0], 0.9, INK, size), &stage::carried);
    let over =
        stage::pipeline(size.0, size.1, State { blend: Blend::SourceOver, depth: Depth::OFF, ..State::default() });
    for i in 0..11 {
        let x = i as f32 * 3.0;
        let color = RED.with_opacity(i as f32 / 10.0);
        stage::draw(&mut target, &over, &stage::quad([x, 2.0, x + 3.0, 10.0], 0.5, color, size), &stage::carried);
    }
    let grid = board.zoomed(whole, target.to_pixmap()?);
    for i in 0..11 {
        let at = grid.map(i as f32 * 3.0 + 1.5, 1.0);
        board.middle(at, 10.0, &format!("{:.1}", i as f32 / 10.0), INK);
    }
    Ok(())
}

fn blend_stages(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["ADDITIVE", "MINIMUM", "MAXIMUM", "MULTIPLY"]);
    let ground = grey(0.45);
    for (rect, blend) in panels.into_iter().zip([Blend::Additive, Blend::Min, Blend::Max, Blend::Multiply]) {
        let size = (60, 40);
        let mut target = stage::paper(size.0, size.1, Samples::One)?;
        target.clear_color(ground);
        let state = State { blend, depth: Depth::OFF, ..State::default() };
        for (cx, color) in [(22.0_f32, AMBER), (38.0, BLUE)] {
            let list = stage::quad([0.0, 0.0, 60.0, 40.0], 0.5, color, size);
            stage::draw(&mut target, &stage::pipeline(size.0, size.1, state), &list, &|fragment| {
                let (x, y) = (fragment.x as f32 + 0.5 - cx, fragment.y as f32 - 19.5);
                (x * x + y * y < 240.0).then(|| stage::components(color))
            });
        }
        board.picture(rect, target.to_pixmap()?);
    }
    Ok(())
}

fn sorting(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["SORTED", "UNSORTED"]);
    let glass = |color: Color| Material {
        shading: rastrum::scene::Shading::Unlit,
        alpha: AlphaMode::Blend,
        color: [color.r, color.g, color.b, 0.6],
        ..Material::default()
    };
    let pane = || Mesh::cuboid([-0.8, -0.8, 0.0], [0.8, 0.8, 0.001], 0);
    // Nearest first.
    let parts = [(RED, 0.0), (GREEN, -1.0), (VIOLET, -2.0)];
    let scene = stage::scene(parts.map(|(color, z)| (pane(), glass(color), stage::at(z * 0.35, -z * 0.2, z))).to_vec());
    let camera = Camera::look_at([0.9, 0.5, 3.4], [-0.25, 0.15, -0.8], [0.0, 1.0, 0.0]);
    for (rect, sort) in [(left, true), (right, false)] {
        let settings = SceneSettings { sort_transparent: sort, ..stage::settings() };
        stage::show(board, rect, &scene, &camera, &settings)?;
    }
    board.middle(Point::new(160.0, 380.0), 10.0, "RED IS NEAREST", GREY);
    Ok(())
}
