//! The scenes S1 to S6b: vertices and indices that every engine is given alike.

/// Columns and rows of the picture.
pub(crate) const SIZE: (u32, u32) = (1280, 720);

/// Position in clip space (x, y, z, w) and up to five more numbers: colour, normal and so on, or u and v.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex {
    pub(crate) position: [f32; 4],
    pub(crate) values: [f32; 3],
}

/// How a scene is shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shading {
    /// `values` is a colour.
    Gouraud,
    /// `values` is a normal; a light and a highlight per pixel.
    Phong,
    /// `values` holds u and v; a bilinear texture.
    Bilinear,
    /// Likewise with mipmaps.
    Trilinear,
}

/// A scene.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    pub(crate) name: &'static str,
    pub(crate) what: &'static str,
    pub(crate) vertices: Vec<Vertex>,
    pub(crate) indices: Vec<u32>,
    pub(crate) shading: Shading,
    pub(crate) samples: u32,
    /// Goal in ms on one and on two threads.
    pub(crate) goal: (f64, f64),
}

/// The perspective projection used throughout: vertical field of view 60°, near 0.1, far 100.
fn project([x, y, z]: [f32; 3]) -> [f32; 4] {
    let f = 1.732_050_8;
    let aspect = SIZE.0 as f32 / SIZE.1 as f32;
    let (near, far) = (0.1, 100.0);
    [x * f / aspect, y * f, (far + near) / (near - far) * z + 2.0 * far * near / (near - far), -z]
}

/// 1,000,000 small triangles: a rolling grid of 1000 × 500 cells that fills the picture.
fn s1() -> Scene {
    let (columns, rows) = (1000, 500);
    let mut vertices = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let (u, v) = (i as f32 / columns as f32, j as f32 / rows as f32);
            let z = -3.0 - 0.3 * ((u * 20.0).sin() * (v * 14.0).cos());
            let position = project([(u - 0.5) * 7.0, (v - 0.5) * 4.0, z]);
            vertices.push(Vertex { position, values: [u, v, 0.5 + 0.5 * (u * 20.0).sin()] });
        }
    }
    let mut indices = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
            indices.extend([a, b, c, a, c, d]);
        }
    }
    Scene {
        name: "S1",
        what: "1,000,000 small triangles, gouraud, no culling",
        vertices,
        indices,
        shading: Shading::Gouraud,
        samples: 1,
        goal: (60.0, 35.0),
    }
}

/// 70,000 triangles of a bumpy ball.
fn s2(name: &'static str, what: &'static str, samples: u32, goal: (f64, f64)) -> Scene {
    let (columns, rows) = (250_u32, 140_u32);
    let mut vertices = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let (a, b) =
                (i as f32 / columns as f32 * std::f32::consts::TAU, j as f32 / rows as f32 * std::f32::consts::PI);
            let n = [b.sin() * a.cos(), b.cos(), b.sin() * a.sin()];
            let r = 1.45 + 0.06 * (9.0 * a).sin() * (7.0 * b).sin();
            let position = project([n[0] * r, n[1] * r, n[2] * r - 3.0]);
            vertices.push(Vertex { position, values: n });
        }
    }
    let mut indices = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let (b, c, d) = (a + 1, a + columns + 2, a + columns + 1);
            indices.extend([a, b, c, a, c, d]);
        }
    }
    Scene { name, what, vertices, indices, shading: Shading::Phong, samples, goal }
}

/// Full-screen quads in perspective, tilted, in the given order of distance.
fn layers(count: u32, front_first: bool) -> (Vec<Vertex>, Vec<u32>) {
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for layer in 0..count {
        let rank = if front_first { layer } else { count - 1 - layer };
        let z = -2.0 - rank as f32 * 0.3;
        let tilt = 0.25;
        let (w, h) = (-z * 2.0, -z * 1.2);
        let first = layer * 4;
        let t = rank as f32 / count as f32;
        for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
            let position = project([x * w, y * h, z + x * tilt]);
            vertices.push(Vertex { position, values: [x * 0.5 + 0.5, y * 0.5 + 0.5, t] });
        }
        indices.extend([first, first + 1, first + 2, first, first + 2, first + 3]);
    }
    (vertices, indices)
}

fn quads(
    name: &'static str,
    what: &'static str,
    count: u32,
    front_first: bool,
    shading: Shading,
    goal: (f64, f64),
) -> Scene {
    let (mut vertices, indices) = layers(count, front_first);
    if matches!(shading, Shading::Bilinear | Shading::Trilinear) {
        for vertex in &mut vertices {
            vertex.values[0] *= 4.0;
            vertex.values[1] *= 3.0;
        }
    }
    Scene { name, what, vertices, indices, shading, samples: 1, goal }
}

/// 2,000 long thin triangles across the picture.
fn s5() -> Scene {
    let mut state = 12_345_u64;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f32 / (1 << 24) as f32
    };
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for i in 0..2000 {
        let angle = random() * std::f32::consts::TAU;
        let (x, y) = (random() * 2.0 - 1.0, random() * 2.0 - 1.0);
        let (dx, dy) = (angle.cos(), angle.sin());
        let z = random();
        let thin = 0.006;
        let corners = [(x - dx, y - dy), (x + dx, y + dy), (x + dx - dy * thin, y + dy + dx * thin)];
        for (k, (x, y)) in corners.into_iter().enumerate() {
            let mut values = [random(), random(), random()];
            values[k] = 1.0;
            vertices.push(Vertex { position: [x, y, z * 1.8 - 0.9, 1.0], values });
        }
        indices.extend([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    Scene {
        name: "S5",
        what: "2,000 long thin triangles",
        vertices,
        indices,
        shading: Shading::Gouraud,
        samples: 1,
        goal: (20.0, 11.0),
    }
}

/// Every scene.
pub(crate) fn all() -> Vec<Scene> {
    vec![
        s1(),
        s2("S2", "70,000 triangles, per-pixel Phong", 1, (14.0, 8.0)),
        quads("S3", "50 full-screen perspective quads, bilinear", 50, false, Shading::Bilinear, (200.0, 105.0)),
        quads("S3m", "the same, trilinear mipmaps", 50, false, Shading::Trilinear, (350.0, 185.0)),
        quads("S3g", "the same, gouraud", 50, false, Shading::Gouraud, (45.0, 25.0)),
        s2("S4", "S2 with MSAA 4x", 4, (40.0, 22.0)),
        s5(),
        quads("S6", "100 full layers, front to back", 100, true, Shading::Gouraud, (8.0, 5.0)),
        quads("S6b", "the same, back to front", 100, false, Shading::Gouraud, (90.0, 50.0)),
    ]
}

/// A texture of 256 × 256 RGBA8 pixels: a soft checker.
pub(crate) fn texture() -> (u32, Vec<u8>) {
    let side = 256_u32;
    let pixel = |x: u32, y: u32| {
        let check = if (x / 16 + y / 16) % 2 == 0 { 220 } else { 60 };
        [check, (x ^ y) as u8, (y * 255 / side) as u8, 255]
    };
    let data = (0..side).flat_map(|y| (0..side).flat_map(move |x| pixel(x, y))).collect();
    (side, data)
}
