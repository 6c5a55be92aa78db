//! `euc` 0.5.3, on one thread: it has no indices, no samples and no mipmaps, and clips nothing.

use euc::buffer::Buffer2d;
use euc::rasterizer::{BackfaceCullingDisabled, Triangles};
use euc::{Pipeline, Target as _};

use super::scenes::{self, SIZE, Scene, Shading, Vertex};

struct Peer {
    shading: Shading,
    texture: Vec<u8>,
    side: u32,
}

/// Three values, interpolated.
#[derive(Clone)]
struct Values([f32; 3]);

impl euc::Interpolate for Values {
    #[inline(always)]
    fn lerp2(a: Self, b: Self, x: f32, y: f32) -> Self {
        Self(std::array::from_fn(|i| a.0[i] * x + b.0[i] * y))
    }

    #[inline(always)]
    fn lerp3(a: Self, b: Self, c: Self, x: f32, y: f32, z: f32) -> Self {
        Self(std::array::from_fn(|i| a.0[i] * x + b.0[i] * y + c.0[i] * z))
    }
}

impl Pipeline for Peer {
    type Vertex = Vertex;
    type VsOut = Values;
    type Pixel = [u8; 4];

    #[inline(always)]
    fn vert(&self, vertex: &Vertex) -> ([f32; 4], Values) {
        (vertex.position, Values(vertex.values))
    }

    #[inline(always)]
    fn frag(&self, Values([x, y, z]): &Values) -> [u8; 4] {
        let byte = |v: f32| (v * 255.0 + 0.5) as u8;
        match self.shading {
            Shading::Gouraud => [byte(*x), byte(*y), byte(*z), 255],
            Shading::Phong => {
                let inverse = 1.0 / (x * x + y * y + z * z).sqrt();
                let (x, y, z) = (x * inverse, y * inverse, z * inverse);
                let diffuse = (x * 0.267 + y * 0.534 + z * 0.802).max(0.0) * 0.9 + 0.1;
                let shine = (x * 0.14 + y * 0.28 + z * 0.95).max(0.0).powi(32);
                [0.8, 0.5, 0.3, 0.0].map(|c| byte(diffuse * c + shine * 0.5))
            }
            Shading::Bilinear | Shading::Trilinear => self.bilinear(*x, *y),
        }
    }
}

impl Peer {
    fn bilinear(&self, u: f32, v: f32) -> [u8; 4] {
        let side = self.side as f32;
        let (x, y) = (u.rem_euclid(1.0) * side - 0.5, v.rem_euclid(1.0) * side - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let at = |dx: i32, dy: i32| {
            let wrap = |v: f32, d: i32| (v.floor() as i32 + d).rem_euclid(self.side as i32) as usize;
            let start = (wrap(y, dy) * self.side as usize + wrap(x, dx)) * 4;
            [0, 1, 2, 3].map(|i| f32::from(self.texture[start + i]))
        };
        let (a, b, c, d) = (at(0, 0), at(1, 0), at(0, 1), at(1, 1));
        std::array::from_fn(|i| {
            ((a[i] * (1.0 - fx) + b[i] * fx) * (1.0 - fy) + (c[i] * (1.0 - fx) + d[i] * fx) * fy + 0.5) as u8
        })
    }
}

/// Whether euc has what a scene asks for.
pub(crate) fn can_draw(shading: Shading) -> bool {
    shading != Shading::Trilinear
}

pub(crate) fn draw(scene: &Scene) {
    let (side, texture) = scenes::texture();
    let size = [SIZE.0 as usize, SIZE.1 as usize];
    let mut color = Buffer2d::new(size, [0, 0, 0, 255]);
    let mut depth = Buffer2d::new(size, 1.0);
    color.clear([0, 0, 0, 255]);
    let vertices: Vec<Vertex> = scene.indices.iter().map(|i| scene.vertices[*i as usize]).collect();
    let peer = Peer { shading: scene.shading, texture, side };
    peer.draw::<Triangles<'_, _, BackfaceCullingDisabled>, _>(&vertices, &mut color, Some(&mut depth));
    std::hint::black_box(&color);
}
