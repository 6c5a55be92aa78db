//! Depth: order, precision, and what helps against fighting.

use rastrum::space::{Compare, Depth, DepthFormat, DepthMapping, Samples, State, Target, camera};
use rastrum::{Color, Pixmap, Point, Rect, Result};

use super::board::{AMBER, BLUE, Board, FAINT, GREEN, GREY, INK, MINT, RED, ROSE, SKY, VIOLET, mix};
use super::stage::{self, Vertex};
use super::{Row, row};

pub(super) const ROWS: &[Row] = &[
    row(
        98,
        "Depth test",
        "The lecture's 8 × 8 grids: the depths stored, those of a triangle that comes, and the smaller of the two at each cell.",
        depth_test,
    ),
    row(
        99,
        "Cleared to -1, greater",
        "Stored depths with clear value 1 and less (left), and with turned signs, a lower clear value and greater (right): other numbers, the same picture.",
        greater,
    ),
    row(
        100,
        "Order does not matter",
        "The same triangles drawn in three orders, with a depth buffer (top: equal) and without (bottom: all different).",
        any_order,
    ),
    row(
        104,
        "Painter's algorithm",
        "Discs drawn from far to near, each over what was there: the steps of a picture that needs no depth buffer.",
        painter,
    ),
    row(
        105,
        "Where the painter fails",
        "Three bars, each over the next: no order of painting is right (left, one of six). The depth buffer is (right).",
        cycle,
    ),
    row(
        106,
        "Z-fighting",
        "Two nearly equal walls, the red one nearer. 16-bit depths cannot tell them apart everywhere, floats can.",
        fighting,
    ),
    row(
        107,
        "The depth curve",
        "z' over distance, near 1 and far 50: half of all values are spent on the first two units. Grey bars show the same step of distance on both ends.",
        curve,
    ),
    row(
        108,
        "Remedy: near and far closer",
        "The same walls and 16 bits; with the planes at 0.1 and 1000, 1 and 500, and 40 and 120. The fight goes.",
        planes,
    ),
    row(109, "Remedy: more precision", "The same walls and planes with 16 and 24 bits and floats.", precision),
    row(
        110,
        "Logarithmic depth",
        "A scene from 0.01 to 1,000,000: walls a thousandth apart near and far. Projected depth loses the nearer, red wall in the distance; logarithmic depth keeps it everywhere.",
        logarithmic,
    ),
    row(
        111,
        "Polygon offset",
        "A decal on a tilted wall: in the same plane it fights, and mostly loses (left); moved towards the viewer by slope and units, all of it shows (right).",
        offset,
    ),
    row(
        112,
        "approxEqual",
        "0.1 + 0.2 is not 0.3: the error as it is, in units of 10⁻¹⁷, and which differences a relative tolerance accepts (green).",
        approximately,
    ),
];

fn depth_test(board: &mut Board) -> Result<()> {
    let [stored, incoming, result] = board.panels(["STORED", "INCOMING", "MINIMUM"]);
    let old = |x: i32, y: i32| if x + y < 8 { Some(5) } else { None };
    let new = |x: i32, y: i32| if x >= 1 && y >= 1 && x - y <= 2 { Some(2 + y) } else { None };
    let mut show = |rect: Rect, value: &dyn Fn(i32, i32) -> Option<i32>| {
        let grid = board.grid(rect, 8, 8);
        for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
            let color = match value(x, y) {
                None => Color::WHITE,
                Some(5) if old(x, y) == Some(5) && new(x, y).is_none_or(|v| v >= 5) => SKY,
                Some(v) => mix(ROSE, AMBER, v as f32 / 9.0),
            };
            board.cell(&grid, (x, y), color);
        }
        board.lines(&grid);
        for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
            let text = value(x, y).map_or("-".to_owned(), |v| v.to_string());
            board.mark(&grid, (x, y), &text, INK);
        }
    };
    show(stored, &old);
    show(incoming, &new);
    let least = |x: i32, y: i32| match (old(x, y), new(x, y)) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    };
    show(result, &least);
    Ok(())
}

const SIZE: (u32, u32) = (12, 12);

/// Two triangles that cut each other.
fn pair() -> Vec<Vertex> {
    let mut list = stage::flat([(0.5, 11.0), (4.0, 0.5), (11.5, 6.0)], 0.5, SKY, SIZE).to_vec();
    let mut leaning = stage::flat([(1.0, 2.0), (11.0, 3.0), (5.0, 11.8)], 0.5, RED, SIZE);
    for (vertex, z) in leaning.iter_mut().zip([-0.6, 0.7, 0.0]) {
        vertex.position[2] = z;
    }
    list.extend(leaning);
    list
}

fn greater(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["CLEAR 1, LESS", "CLEAR 0, GREATER"]);
    for (rect, turned) in [(left, false), (right, true)] {
        let mut target = stage::paper(SIZE.0, SIZE.1, Samples::One)?;
        let (clear, compare) = if turned { (0.0, Compare::Greater) } else { (1.0, Compare::Less) };
        target.clear_depth(clear);
        let mut list = pair();
        if turned {
            list.iter_mut().for_each(|vertex| vertex.position[2] = -vertex.position[2]);
        }
        let state = State { depth: Depth::compare(compare), ..State::default() };
        stage::draw(&mut target, &stage::pipeline(SIZE.0, SIZE.1, state), &list, &stage::carried);
        let grid = board.zoomed(rect, target.to_pixmap()?);
        for (x, y) in (0..SIZE.1).flat_map(|y| (0..SIZE.0).map(move |x| (x, y))) {
            let depth = target.depth(x, y).unwrap_or(clear);
            board.mark(&grid, (x as i32, y as i32), &format!("{:.0}", depth * 99.0), INK);
        }
    }
    Ok(())
}

/// Triangles at depths of their own.
fn fan() -> Vec<[Vertex; 3]> {
    let corners = [
        [(4.0, 40.0), (20.0, 4.0), (44.0, 30.0)],
        [(8.0, 8.0), (44.0, 12.0), (24.0, 44.0)],
        [(2.0, 22.0), (46.0, 18.0), (40.0, 42.0)],
        [(16.0, 2.0), (34.0, 46.0), (6.0, 30.0)],
    ];
    let colors = [SKY, ROSE, MINT, AMBER];
    let depths = [0.4, 0.2, 0.6, 0.8];
    corners.into_iter().zip(colors).zip(depths).map(|((t, color), z)| stage::flat(t, z, color, (48, 48))).collect()
}

fn any_order(board: &mut Board) -> Result<()> {
    let panels = board.tiles(3, &["1 2 3 4", "4 3 2 1", "2 4 1 3", "NO DEPTH: 1 2 3 4", "4 3 2 1", "2 4 1 3"]);
    let orders = [[0, 1, 2, 3], [3, 2, 1, 0], [1, 3, 0, 2]];
    let all = fan();
    for (i, rect) in panels.into_iter().enumerate() {
        let depth = if i < 3 { Depth::default() } else { Depth::OFF };
        let list: Vec<Vertex> = orders[i % 3].iter().flat_map(|k: &usize| all[*k]).collect();
        board.picture(rect, stage::picture(&list, (48, 48), Samples::One, State { depth, ..State::default() })?);
    }
    Ok(())
}

fn painter(board: &mut Board) -> Result<()> {
    let panels = board.tiles(3, &["1", "2", "3", "4", "5", "6"]);
    let discs = [
        (24.0, 16.0, 15.0, VIOLET),
        (36.0, 24.0, 13.0, BLUE),
        (16.0, 28.0, 12.0, GREEN),
        (28.0, 34.0, 10.0, AMBER),
        (40.0, 14.0, 8.0, RED),
        (22.0, 22.0, 6.0, SKY),
    ];
    let size = (54, 46);
    let mut target = stage::paper(size.0, size.1, Samples::One)?;
    let pipeline = stage::pipeline(size.0, size.1, State { depth: Depth::OFF, ..State::default() });
    for (rect, (cx, cy, radius, color)) in panels.into_iter().zip(discs) {
        let all = stage::quad([0.0, 0.0, 54.0, 46.0], 0.5, color, size);
        stage::draw(&mut target, &pipeline, &all, &|fragment| {
            let (x, y) = (fragment.x as f32 + 0.5 - cx, fragment.y as f32 + 0.5 - cy);
            (x * x + y * y < radius * radius).then(|| stage::components(color))
        });
        board.picture(rect, target.to_pixmap()?);
    }
    Ok(())
}

/// Three bars in a ring, each over the next.
fn bars() -> [Vec<Vertex>; 3] {
    let colors = [RED, GREEN, BLUE];
    [(0.0_f32, 1.0_f32), (0.866, -0.5), (-0.866, -0.5)].map(|(s, c)| {
        let color = colors[if s == 0.0 {
            0
        } else if s > 0.0 {
            1
        } else {
            2
        }];
        let turn = |x: f32, y: f32, z: f32| Vertex {
            position: [x * c - y * s, x * s + y * c, z, 1.0],
            values: stage::components(color),
        };
        let (a, b) = (turn(-0.85, -0.55, -0.5), turn(0.85, -0.55, 0.5));
        let (d, e) = (turn(0.85, -0.25, 0.5), turn(-0.85, -0.25, -0.5));
        vec![a, b, d, a, d, e]
    })
}

fn cycle(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["PAINTED", "DEPTH BUFFER"]);
    let list = bars().concat();
    for (rect, depth) in [(left, Depth::OFF), (right, Depth::default())] {
        let state = State { depth, ..State::default() };
        let size = (rect.width() as u32, rect.width() as u32);
        board.picture(rect, stage::picture(&list, size, Samples::Msaa8, state)?);
    }
    Ok(())
}

/// Two walls at the given distances, the nearer (red) first; where the farther one shows, they fight.
fn walls(format: DepthFormat, (near, far): (f32, f32), z: [f32; 2], mapping: DepthMapping) -> Result<Pixmap> {
    let projection = camera::perspective(1.0, 1.0, near, far);
    let mut target = Target::with_format(64, 64, format, Samples::One)?;
    target.clear_color(Color::WHITE);
    let depth = Depth { mapping, ..Depth::compare(Compare::LessEqual) };
    let pipeline = stage::pipeline(64, 64, State { depth, ..State::default() });
    for (z, color) in z.into_iter().zip([RED, BLUE]) {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let list = corners.map(|(x, y)| {
            let distance = z * (1.0 + 0.04 * x + 0.03 * y);
            let position = camera::transform(&projection, [x * z, y * z, -distance, 1.0]);
            Vertex { position, values: stage::components(color) }
        });
        stage::draw_opaque(&mut target, &pipeline, &list);
    }
    target.to_pixmap()
}

const CLOSE: [f32; 2] = [80.0, 80.5];
const PROJECTED: DepthMapping = DepthMapping::Projected;

fn fighting(board: &mut Board) -> Result<()> {
    let panels = board.tiles(2, &["D16: FAR / NEAR = 10000", "D32F", "D16: SURFACES CLOSE", "D32F"]);
    let cases = [
        (DepthFormat::D16, (0.1, 1000.0), CLOSE),
        (DepthFormat::D32F, (0.1, 1000.0), CLOSE),
        (DepthFormat::D16, (1.0, 100.0), [50.0, 50.02]),
        (DepthFormat::D32F, (1.0, 100.0), [50.0, 50.02]),
    ];
    for (rect, (format, planes, z)) in panels.into_iter().zip(cases) {
        board.picture(rect, walls(format, planes, z, PROJECTED)?);
    }
    Ok(())
}

fn curve(board: &mut Board) -> Result<()> {
    let whole = board.whole();
    let axes = board.axes(whole, (0.0, 50.0), (-1.0, 1.0), ("DISTANCE", "Z'"));
    let m = camera::perspective(1.0, 1.0, 1.0, 50.0);
    let depth = |z: f32| {
        let [_, _, cz, cw] = camera::transform(&m, [0.0, 0.0, -z, 1.0]);
        cz / cw
    };
    for (from, color) in [(2.0, GREEN), (40.0, RED)] {
        let (a, b) = (axes.map(from, depth(from)), axes.map(from + 5.0, depth(from + 5.0)));
        board.bar(Rect::from_ltrb(a.x, axes.area.top, b.x, axes.area.bottom), FAINT);
        board.bar(Rect::from_ltrb(axes.area.left, b.y, axes.area.left + 60.0, a.y.max(b.y + 1.5)), color);
    }
    board.curve(&axes, (0..=490).map(|i| 1.0 + i as f32 / 10.0).map(|z| (z, depth(z))), BLUE);
    Ok(())
}

fn planes(board: &mut Board) -> Result<()> {
    let panels = board.panels(["0.1 TO 1000", "1 TO 500", "40 TO 120"]);
    for (rect, planes) in panels.into_iter().zip([(0.1, 1000.0), (1.0, 500.0), (40.0, 120.0)]) {
        board.picture(rect, walls(DepthFormat::D16, planes, CLOSE, PROJECTED)?);
    }
    Ok(())
}

fn precision(board: &mut Board) -> Result<()> {
    let panels = board.panels(["D16", "D24", "D32F"]);
    let formats = [DepthFormat::D16, DepthFormat::D24, DepthFormat::D32F];
    for (rect, format) in panels.into_iter().zip(formats) {
        let square = Rect { bottom: rect.top + 200.0, ..rect };
        board.picture(square, walls(format, (0.1, 1000.0), CLOSE, PROJECTED)?);
        // How far apart two depths have to be at this distance.
        let m = camera::perspective(1.0, 1.0, 0.1, 1000.0);
        let depth = |z: f32| {
            let [_, _, cz, cw] = camera::transform(&m, [0.0, 0.0, -z, 1.0]);
            f64::from(cz) / f64::from(cw) / 2.0 + 0.5
        };
        let slope = (depth(81.0) - depth(80.0)).max(1e-12);
        let least = f64::from(format.resolution(depth(80.0) as f32)) / slope;
        board.middle(Point::new(rect.center().x, rect.top + 238.0), 10.0, "STEP AT 80:", GREY);
        let text = if least > 0.01 { format!("{least:.3}") } else { format!("{least:.6}") };
        board.middle(Point::new(rect.center().x, rect.top + 264.0), 14.0, &text, INK);
    }
    Ok(())
}

fn logarithmic(board: &mut Board) -> Result<()> {
    let names = ["PROJECTED, AT 1", "AT 9000", "AT 500000", "LOGARITHMIC, AT 1", "AT 9000", "AT 500000"];
    let panels = board.tiles(3, &names);
    let (near, far) = (1e-2, 1e6);
    let distances = [[1.0, 1.001], [9000.0, 9009.0], [500_000.0, 500_500.0]];
    for (i, rect) in panels.into_iter().enumerate() {
        let mapping = if i < 3 { PROJECTED } else { DepthMapping::Logarithmic { near, far } };
        board.picture(rect, walls(DepthFormat::D24, (near, far), distances[i % 3], mapping)?);
    }
    Ok(())
}

fn offset(board: &mut Board) -> Result<()> {
    let [left, right] = board.panels(["SAME PLANE", "OFFSET -1, -4"]);
    let m = camera::perspective(1.0, 1.0, 0.5, 50.0);
    let patch = |half: f32, color: Color, order: [usize; 6]| {
        let corner = |x: f32, y: f32| {
            let position = camera::transform(&m, [x * half, y * half, -4.0 + x * half * 0.7 + y * half * 0.31, 1.0]);
            Vertex { position, values: stage::components(color) }
        };
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.8, 1.0), corner(-1.0, 0.9)];
        order.map(|i| corners[i])
    };
    for (rect, slope, units) in [(left, 0.0, 0.0), (right, -1.0, -4.0)] {
        let mut target = stage::paper(64, 64, Samples::One)?;
        stage::draw_opaque(
            &mut target,
            &stage::pipeline(64, 64, State::default()),
            &patch(2.43, SKY, [0, 1, 2, 0, 2, 3]),
        );
        let depth = Depth { bias_slope: slope, bias_units: units, ..Depth::default() };
        let state = State { depth, ..State::default() };
        stage::draw_opaque(&mut target, &stage::pipeline(64, 64, state), &patch(1.0, RED, [1, 2, 3, 1, 3, 0]));
        board.picture(rect, target.to_pixmap()?);
    }
    Ok(())
}

fn approximately(board: &mut Board) -> Result<()> {
    let sum = 0.1_f64 + 0.2;
    board.label(40.0, 40.0, 20.0, "0.1 + 0.2 - 0.3", INK);
    board.label(400.0, 40.0, 20.0, &format!("= {:.2}", (sum - 0.3) * 1e17), RED);
    board.label(40.0, 90.0, 12.0, "AS IT IS: NOT EQUAL. WITHIN 10^-9: EQUAL.", GREY);
    let tolerance = 1e-9;
    for i in 0..12 {
        // Differences of 1e-16 to 1e-5.
        let exponent = 16 - i;
        let difference = (0..exponent).fold(1.0_f64, |v, _| v / 10.0);
        let equal = (0.3 + difference - 0.3).abs() <= tolerance * (0.3 + difference).abs().max(0.3);
        let x = 40.0 + i as f32 * 46.0;
        let height = 20.0 + i as f32 * 15.0;
        board.bar(Rect::from_xywh(x, 350.0 - height, 34.0, height), if equal { GREEN } else { ROSE });
        board.middle(Point::new(x + 17.0, 366.0), 9.0, &format!("-{exponent}"), INK);
    }
    board.label(40.0, 382.0, 10.0, "POWER OF TEN OF THE DIFFERENCE", GREY);
    Ok(())
}
