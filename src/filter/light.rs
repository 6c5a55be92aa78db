//! Sources of light.

use crate::num::trig;

/// Where light comes from. Positions are in user space; z points towards the viewer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightSource {
    /// Light from far away.
    Distant {
        /// The direction on the canvas, clockwise from the right, in degrees.
        azimuth: f32,
        /// The angle above the canvas, in degrees.
        elevation: f32,
    },
    /// Light from a point, to all sides.
    Point {
        /// Its position.
        position: [f32; 3],
    },
    /// Light from a point in one direction.
    Spot {
        /// Its position.
        position: [f32; 3],
        /// The point that it is aimed at.
        target: [f32; 3],
        /// How much it is focused: 1 is the least that is usual.
        exponent: f32,
        /// The greatest angle from its axis at which there is light, in degrees; `None` for no limit but the half space.
        cone_angle: Option<f32>,
    },
}

type Vector = [f32; 3];

pub(super) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `v` with a length of 1; a vector of no length stays as it is.
pub(super) fn normalized(v: Vector) -> Vector {
    let length = dot(v, v).sqrt();
    if length > 0.0 { v.map(|v| v / length) } else { v }
}

/// A light made ready, in pixels.
pub(super) enum Light {
    Distant { direction: Vector },
    Point { position: Vector },
    Spot { position: Vector, axis: Vector, least_cosine: f32, focus: Power },
}

impl Light {
    /// The light under a map from user space to pixels (a scale and a move, across and down).
    pub(super) fn new(source: &LightSource, scale: (f32, f32), origin: (f32, f32)) -> Self {
        // SVG leaves z to the mean of the two scales.
        let depth = ((scale.0 * scale.0 + scale.1 * scale.1) * 0.5).sqrt();
        let map = |[x, y, z]: Vector| [x * scale.0 + origin.0, y * scale.1 + origin.1, z * depth];
        match *source {
            LightSource::Distant { azimuth, elevation } => {
                let (sin_a, cos_a) = trig::sin_cos(f64::from(azimuth).to_radians());
                let (sin_e, cos_e) = trig::sin_cos(f64::from(elevation).to_radians());
                Self::Distant { direction: [cos_a * cos_e, sin_a * cos_e, sin_e].map(|v| v as f32) }
            }
            LightSource::Point { position } => Self::Point { position: map(position) },
            LightSource::Spot { position, target, exponent, cone_angle } => {
                let (position, target) = (map(position), map(target));
                let cosine = |angle: f32| trig::sin_cos(f64::from(angle).to_radians()).1 as f32;
                Self::Spot {
                    position,
                    axis: normalized([target[0] - position[0], target[1] - position[1], target[2] - position[2]]),
                    least_cosine: cone_angle.map_or(0.0, cosine),
                    focus: Power::new(exponent),
                }
            }
        }
    }

    /// The direction from a point of the surface to the light, and how bright it is there, 0 ..= 1.
    #[inline(always)]
    pub(super) fn at(&self, point: Vector) -> (Vector, f32) {
        let towards =
            |position: &Vector| normalized([position[0] - point[0], position[1] - point[1], position[2] - point[2]]);
        match self {
            Self::Distant { direction } => (*direction, 1.0),
            Self::Point { position } => (towards(position), 1.0),
            Self::Spot { position, axis, least_cosine, focus } => {
                let direction = towards(position);
                let cosine = -dot(direction, *axis);
                let bright = cosine > 0.0 && cosine >= *least_cosine;
                (direction, if bright { focus.of(cosine) } else { 0.0 })
            }
        }
    }
}

/// Powers of numbers in 0 ..= 1, from a table: one of a library's for each pixel would cost more than all the rest.
pub(super) struct Power {
    /// At equal distances, and the last one twice; empty for the exponent 1.
    table: Vec<f32>,
}

const STEPS: usize = 4096;

impl Power {
    pub(super) fn new(exponent: f32) -> Self {
        if exponent == 1.0 {
            return Self { table: Vec::new() };
        }
        let value = |i: usize| trig::pow(i as f64 / STEPS as f64, f64::from(exponent)) as f32;
        Self { table: (0..=STEPS + 1).map(|i| value(i.min(STEPS))).collect() }
    }

    /// `base` to the power; below 0 as 0, above 1 as 1.
    #[inline(always)]
    pub(super) fn of(&self, base: f32) -> f32 {
        let base = if base > 0.0 { if base < 1.0 { base } else { 1.0 } } else { 0.0 };
        if self.table.is_empty() {
            return base;
        }
        let position = base * STEPS as f32;
        let index = position as usize;
        let part = position - index as f32;
        match self.table.get(index..index + 2) {
            Some([low, high]) => low + (high - low) * part,
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::disallowed_methods, reason = "an oracle")]
    fn powers_from_the_table_are_near_the_true_ones() {
        for exponent in [0.0, 0.5, 1.0, 2.0, 7.3, 40.0, 128.0, 1000.0] {
            let power = Power::new(exponent);
            let mut worst = 0.0_f32;
            for i in 1..=10_000 {
                let base = i as f32 / 10_000.0;
                worst = worst.max((power.of(base) - base.powf(exponent)).abs());
            }
            // A table of 4,096 steps bends by up to e² / (8 · 4,096²); roots are steep at 0.
            let allowed = if exponent == 0.5 { 4e-3 } else { 1e-5 + exponent * exponent / 1.3e8 };
            assert!(worst <= allowed, "{exponent}: {worst}");
        }
        assert_eq!(Power::new(3.0).of(-1.0), 0.0);
        assert_eq!(Power::new(3.0).of(f32::NAN), 0.0);
        assert_eq!(Power::new(3.0).of(5.0), 1.0);
    }

    #[test]
    fn a_distant_light_from_the_lower_left() {
        let light = Light::new(&LightSource::Distant { azimuth: 135.0, elevation: 0.0 }, (1.0, 1.0), (0.0, 0.0));
        let ([x, y, z], bright) = light.at([5.0, 5.0, 0.0]);
        let half = std::f32::consts::FRAC_1_SQRT_2;
        assert!((x + half).abs() < 1e-6 && (y - half).abs() < 1e-6 && z.abs() < 1e-6 && bright == 1.0);
    }

    #[test]
    fn a_spot_lights_its_cone() {
        let spot = |cone_angle| {
            let source =
                LightSource::Spot { position: [0.0, 0.0, 10.0], target: [0.0, 0.0, 0.0], exponent: 2.0, cone_angle };
            Light::new(&source, (2.0, 2.0), (3.0, 0.0))
        };
        // 20 pixels above (3, 0); at 20 pixels to the side the angle is 45°, whose cosine's square is a half.
        assert_eq!(spot(None).at([3.0, 0.0, 0.0]).1, 1.0);
        assert!((spot(None).at([23.0, 0.0, 0.0]).1 - 0.5).abs() < 1e-3);
        assert!(spot(Some(46.0)).at([23.0, 0.0, 0.0]).1 > 0.4);
        assert_eq!(spot(Some(44.0)).at([23.0, 0.0, 0.0]).1, 0.0);
        assert_eq!(spot(None).at([3.0, 0.0, 25.0]).1, 0.0);
    }
}
