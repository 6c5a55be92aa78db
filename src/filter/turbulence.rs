//! Perlin noise, as the specification's `feTurbulence` defines it.

use super::image::{Image, Work};
use super::lighting::Map;
use crate::color::premultiply_u8;
use crate::error::Result;
use crate::geom::IntRect;

/// Noise in the four straight components, a function of the position in user space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turbulence {
    /// Cells of noise per unit of user space, across; not negative.
    pub frequency_x: f32,
    /// Cells of noise per unit of user space, down; not negative.
    pub frequency_y: f32,
    /// How many noises are summed, each of twice the frequency and half the strength of the one before. Those beyond the
    /// 24th do not show.
    pub octaves: u32,
    /// Which noise it is.
    pub seed: i32,
    /// Whether frequencies are adjusted and the noise wrapped around so that copies of the subregion fit together.
    pub stitch: bool,
    /// Whether the noise is summed with its sign, around a grey of one half (`fractalNoise`), or its absolute value.
    pub fractal: bool,
}

const CELLS: usize = 256;
/// Added to positions, so that cells' numbers are positive near the origin.
const SHIFT: f64 = 4096.0;
const MOST_OCTAVES: u32 = 24;

/// A permutation of the cells, and for each a gradient for every component. Both go on a little over 256, and
/// permuted numbers up to 510 are looked up.
struct Lattice {
    permutation: Vec<usize>,
    /// The x components of the four gradients, then the y components.
    gradients: Vec<[[f32; 4]; 2]>,
}

impl Lattice {
    fn new(seed: i32) -> Self {
        let mut random = Random::new(seed);
        let mut gradients = vec![[[0.0; 4]; 2]; CELLS];
        for component in 0..4 {
            for gradient in &mut gradients {
                let mut coordinate = || (random.next() % (2 * CELLS as i64) - CELLS as i64) as f64 / CELLS as f64;
                let (x, y) = (coordinate(), coordinate());
                let length = (x * x + y * y).sqrt();
                // Both can be zero in theory; no seed's are known to be.
                if length > 0.0 {
                    gradient[0][component] = (x / length) as f32;
                    gradient[1][component] = (y / length) as f32;
                }
            }
        }
        let mut permutation: Vec<usize> = (0..CELLS).collect();
        for index in (1..CELLS).rev() {
            permutation.swap(index, (random.next() % CELLS as i64) as usize);
        }
        permutation.extend_from_within(..);
        gradients.extend_from_within(..);
        Self { permutation, gradients }
    }

    fn cell(&self, x: i32, y: i32) -> &[[f32; 4]; 2] {
        const NONE: [[f32; 4]; 2] = [[0.0; 4]; 2];
        let column = self.permutation.get((x & 255) as usize).copied().unwrap_or(0);
        let index = self.permutation.get(column + (y & 255) as usize).copied().unwrap_or(0);
        self.gradients.get(index).unwrap_or(&NONE)
    }

    /// The noise at a point, around 0, in the four components.
    #[inline(always)]
    fn noise(&self, x: f64, y: f64, stitch: Option<&Stitch>) -> [f32; 4] {
        let (x, y) = (x + SHIFT, y + SHIFT);
        let (floor_x, floor_y) = (x.trunc(), y.trunc());
        // Far away whole numbers go on by themselves; numbers beyond 2^31 end there.
        let (column, row) = (floor_x as i32, floor_y as i32);
        let mut columns = [column, column.saturating_add(1)];
        let mut rows = [row, row.saturating_add(1)];
        if let Some(stitch) = stitch {
            columns = columns.map(|column| stitch.wrap(column, 0));
            rows = rows.map(|row| stitch.wrap(row, 1));
        }
        let (dx, dy) = ((x - floor_x) as f32, (y - floor_y) as f32);
        let smooth = |t: f32| t * t * (3.0 - 2.0 * t);
        let (blend_x, blend_y) = (smooth(dx), smooth(dy));
        let corner = |column: i32, row: i32, dx: f32, dy: f32| {
            let [gx, gy] = self.cell(column, row);
            std::array::from_fn::<f32, 4, _>(|c| dx * gx[c] + dy * gy[c])
        };
        let a = corner(columns[0], rows[0], dx, dy);
        let b = corner(columns[1], rows[0], dx - 1.0, dy);
        let c = corner(columns[0], rows[1], dx, dy - 1.0);
        let d = corner(columns[1], rows[1], dx - 1.0, dy - 1.0);
        std::array::from_fn(|i| {
            let above = a[i] + (b[i] - a[i]) * blend_x;
            let below = c[i] + (d[i] - c[i]) * blend_x;
            above + (below - above) * blend_y
        })
    }
}

/// Park and Miller's generator, which the specification prescribes.
struct Random(i64);

impl Random {
    const MODULUS: i64 = 2_147_483_647;

    fn new(seed: i32) -> Self {
        let seed = i64::from(seed);
        let seed = if seed <= 0 { -seed % (Self::MODULUS - 1) + 1 } else { seed };
        Self(seed.min(Self::MODULUS - 1))
    }

    fn next(&mut self) -> i64 {
        self.0 = self.0 * 16_807 % Self::MODULUS;
        self.0
    }
}

/// How cells are wrapped around, for one octave.
#[derive(Clone, Copy)]
struct Stitch {
    /// Cells in the tile, across and down.
    size: [i32; 2],
    /// The first cell that is beyond it.
    end: [i32; 2],
}

impl Stitch {
    fn wrap(&self, cell: i32, axis: usize) -> i32 {
        if cell >= self.end[axis] { cell.saturating_sub(self.size[axis]) } else { cell }
    }

    fn doubled(self) -> Self {
        Self {
            size: self.size.map(|size| size.saturating_mul(2)),
            end: self.end.map(|end| end.saturating_mul(2).saturating_sub(SHIFT as i32)),
        }
    }
}

/// The frequency nearest to `frequency` of which whole cells fit `length`.
fn fitting(frequency: f64, length: f64) -> f64 {
    if frequency == 0.0 || !(length > 0.0) {
        return frequency;
    }
    let low = (length * frequency).floor() / length;
    let high = (length * frequency).ceil() / length;
    // By their ratios; a low one of 0 is infinitely far away.
    if frequency / low < high / frequency { low } else { high }
}

/// The noise in `area`, which lies in the subregion `tile`; the map takes user space to pixels.
pub(super) fn turbulence(noise: &Turbulence, area: IntRect, tile: IntRect, map: &Map, work: Work) -> Result<Image> {
    let mut frequency = [f64::from(noise.frequency_x), f64::from(noise.frequency_y)];
    if !frequency.iter().all(|frequency| *frequency >= 0.0 && frequency.is_finite()) {
        return Ok(Image::empty());
    }
    let scale = [f64::from(map.scale.0), f64::from(map.scale.1)];
    let origin = [f64::from(map.origin.0), f64::from(map.origin.1)];
    let mut stitch = None;
    if noise.stitch {
        let start = [(f64::from(tile.left) - origin[0]) / scale[0], (f64::from(tile.top) - origin[1]) / scale[1]];
        let size = [f64::from(tile.width()) / scale[0], f64::from(tile.height()) / scale[1]];
        frequency = [fitting(frequency[0], size[0]), fitting(frequency[1], size[1])];
        let cells = [0, 1].map(|axis: usize| (size[axis] * frequency[axis] + 0.5) as i32);
        let end = [0, 1].map(|axis: usize| (start[axis] * frequency[axis] + SHIFT + f64::from(cells[axis])) as i32);
        stitch = Some(Stitch { size: cells, end });
    }
    let lattice = Lattice::new(noise.seed);
    let octaves = noise.octaves.min(MOST_OCTAVES);
    let mut out = Image::new(area)?;
    out.for_rows(work, |y, row| {
        let v = (f64::from(y) - origin[1]) / scale[1] * frequency[1];
        for (x, pixel) in (area.left..).zip(row) {
            let u = (f64::from(x) - origin[0]) / scale[0] * frequency[0];
            let mut sum = [0.0_f32; 4];
            let (mut factor, mut strength, mut stitch) = (1.0, 1.0_f32, stitch);
            for _ in 0..octaves {
                let value = lattice.noise(u * factor, v * factor, stitch.as_ref());
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += strength * if noise.fractal { value } else { value.abs() };
                }
                factor *= 2.0;
                strength *= 0.5;
                stitch = stitch.map(Stitch::doubled);
            }
            let level = |v: f32| (if noise.fractal { (v + 1.0) * 127.5 } else { v * 255.0 } + 0.5) as u8;
            *pixel = premultiply_u8(sum.map(level));
        }
    });
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::super::image::tests::WORK;
    use super::*;

    const MAP: Map = Map { scale: (1.0, 1.0), origin: (0.0, 0.0) };

    fn fractal(frequency: f32) -> Turbulence {
        Turbulence { frequency_x: frequency, frequency_y: frequency, octaves: 1, seed: 0, stitch: false, fractal: true }
    }

    #[test]
    fn the_generator_has_the_value_of_its_authors() {
        // Park and Miller: from 1, the 10,000th number is 1,043,618,065.
        let mut random = Random::new(1);
        let last = (0..10_000).map(|_| random.next()).last();
        assert_eq!(last, Some(1_043_618_065));
        assert_eq!(Random::new(0).0, 1);
        assert_eq!(Random::new(-5).0, 6);
        assert_eq!(Random::new(i32::MAX).0, 2_147_483_646);
    }

    #[test]
    fn noise_is_zero_at_the_corners_of_cells_and_bounded() {
        let lattice = Lattice::new(7);
        assert_eq!(lattice.noise(3.0, -9.0, None), [0.0; 4]);
        for i in 0..2_000 {
            let value = lattice.noise(f64::from(i) * 0.37 - 200.0, f64::from(i) * 0.11, None);
            assert!(value.iter().all(|v| v.abs() < 1.0));
        }
        // Nothing at all: half grey at half alpha.
        let area = IntRect::from_ltrb(0, 0, 2, 2);
        let out = turbulence(&fractal(0.0), area, area, &MAP, WORK).unwrap();
        assert!(out.pixels().iter().all(|pixel| *pixel == [64, 64, 64, 128]));
    }

    #[test]
    fn stitched_tiles_fit_together() {
        let noise = Turbulence { stitch: true, octaves: 3, ..fractal(0.043) };
        let tile = IntRect::from_ltrb(0, 0, 64, 64);
        // The pixels just beyond the tile are those at its other side.
        let column = turbulence(&noise, IntRect::from_ltrb(64, 0, 65, 64), tile, &MAP, WORK).unwrap();
        let first = turbulence(&noise, IntRect::from_ltrb(0, 0, 1, 64), tile, &MAP, WORK).unwrap();
        assert_eq!(column.pixels(), first.pixels());
        let row = turbulence(&noise, IntRect::from_ltrb(0, 64, 64, 65), tile, &MAP, WORK).unwrap();
        let first = turbulence(&noise, IntRect::from_ltrb(0, 0, 64, 1), tile, &MAP, WORK).unwrap();
        assert_eq!(row.pixels(), first.pixels());
    }

    #[test]
    fn extremes_end() {
        let area = IntRect::from_ltrb(0, 0, 4, 4);
        for noise in [
            Turbulence { octaves: u32::MAX, ..fractal(1e30) },
            Turbulence { stitch: true, seed: i32::MIN, octaves: 40, ..fractal(3e9) },
            fractal(f32::NAN),
            fractal(-1.0),
        ] {
            let _ = turbulence(&noise, area, area, &MAP, WORK).unwrap();
        }
    }
}
