//! Random paints.

use std::sync::Arc;

use crate::color::Color;
use crate::geom::{Point, Transform};
use crate::paint::{
    FilterQuality, GradientStop, LinearGradient, Pattern, RadialGradient, Shader, SpreadMode, SweepGradient,
};
use crate::surface::Pixmap;

pub(super) const SPREADS: [SpreadMode; 4] =
    [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect, SpreadMode::Decal];
pub(super) const QUALITIES: [FilterQuality; 3] =
    [FilterQuality::Nearest, FilterQuality::Bilinear, FilterQuality::Bicubic];

/// SplitMix64.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    pub(super) fn range(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * ((self.bits() >> 40) as f32 / 16_777_216.0)
    }

    pub(super) fn point(&mut self) -> Point {
        Point::new(self.range(0.0, 100.0), self.range(0.0, 100.0))
    }

    pub(super) fn color(&mut self, opaque: bool) -> Color {
        let [r, g, b, a, ..] = self.bits().to_le_bytes();
        Color::from_rgba8(r, g, b, if opaque { 255 } else { a })
    }

    /// Stops from 0 to 1, without coincident ones, at least 0.05 apart.
    pub(super) fn stops(&mut self, count: usize) -> Vec<GradientStop> {
        let opaque = self.below(2) == 0;
        let step = 1.0 / (count - 1) as f32;
        let jitter = step * 0.3;
        let mut stops: Vec<GradientStop> = (0..count)
            .map(|k| GradientStop::new(k as f32 * step + self.range(-jitter, jitter), self.color(opaque)))
            .collect();
        stops[0].position = 0.0;
        stops[count - 1].position = 1.0;
        stops
    }

    pub(super) fn transform(&mut self) -> Transform {
        match self.below(4) {
            0 => Transform::IDENTITY,
            1 => Transform::from_translate(self.range(-30.0, 30.0), self.range(-30.0, 30.0)),
            2 => Transform::from_row(
                self.range(0.5, 3.0),
                0.0,
                0.0,
                self.range(-3.0, -0.5),
                self.range(-9.0, 9.0),
                self.range(50.0, 90.0),
            ),
            _ => Transform::from_rotate_at(self.range(0.0, 360.0), self.point())
                .pre_concat(Transform::from_scale(self.range(0.5, 3.0), self.range(0.5, 3.0))),
        }
    }

    pub(super) fn image(&mut self, width: u32, height: u32, opaque: bool) -> Arc<Pixmap> {
        let data = (0..width * height).flat_map(|_| self.color(opaque).to_rgba8()).collect();
        Arc::new(Pixmap::from_straight(width, height, data).unwrap())
    }

    pub(super) fn linear(&mut self) -> Shader {
        let count = 2 + self.below(4);
        let (start, mut end) = (self.point(), self.point());
        match self.below(3) {
            0 => end.x = start.x,
            1 => end.y = start.y,
            _ => {}
        }
        end.x += 30.0 * f32::from(u8::from(end.x != start.x || end.y == start.y));
        end.y += 30.0 * f32::from(u8::from(end.y != start.y));
        LinearGradient::new(start, end, self.stops(count)).with_transform(self.transform()).into()
    }

    pub(super) fn radial(&mut self) -> Shader {
        let count = 2 + self.below(3);
        let stops = self.stops(count);
        let (c0, c1) = (self.point(), self.point());
        let (r0, r1) = (self.range(0.0, 40.0), self.range(20.0, 60.0));
        let gradient = match self.below(6) {
            0 => RadialGradient::new(c0, r1, stops),
            1 => RadialGradient::two_point(c0, r0, c0, r0 + 30.0, stops),
            2 => RadialGradient::two_point(c0, r0 + 40.0, c0, r0, stops),
            // Inside the end circle: focal.
            3 => RadialGradient::two_point(Point::new(c0.x + r1 * 0.5, c0.y - r1 * 0.3), 0.0, c0, r1, stops),
            4 => RadialGradient::two_point(c0, r1, c1, r1, stops),
            _ => RadialGradient::two_point(c0, r0, c1, r1, stops),
        };
        gradient.with_transform(self.transform()).into()
    }

    pub(super) fn sweep(&mut self) -> Shader {
        let count = 2 + self.below(4);
        let gradient = SweepGradient::new(self.point(), self.stops(count)).with_transform(self.transform());
        match self.below(3) {
            0 => gradient.into(),
            1 => gradient.with_angles(self.range(0.0, 100.0), self.range(150.0, 350.0)).into(),
            _ => gradient.with_angles(self.range(-180.0, 0.0), self.range(30.0, 500.0)).into(),
        }
    }

    pub(super) fn pattern(&mut self) -> Pattern {
        let (width, height) = (1 + self.below(20) as u32, 1 + self.below(20) as u32);
        let opaque = self.below(2) == 0;
        let mut pattern = Pattern::new(self.image(width, height, opaque));
        pattern.quality = QUALITIES[self.below(3)];
        pattern.spread_x = SPREADS[self.below(4)];
        pattern.spread_y = SPREADS[self.below(4)];
        pattern.transform =
            Transform::from_scale(self.range(0.7, 5.0), self.range(0.7, 5.0)).post_concat(self.transform());
        pattern
    }

    pub(super) fn shader(&mut self) -> Shader {
        let mut shader = match self.below(4) {
            0 => self.linear(),
            1 => self.radial(),
            2 => self.sweep(),
            _ => self.pattern().into(),
        };
        let spread = SPREADS[self.below(4)];
        match &mut shader {
            Shader::LinearGradient(g) => g.spread = spread,
            Shader::RadialGradient(g) => g.spread = spread,
            Shader::SweepGradient(g) => g.spread = spread,
            _ => {}
        }
        shader
    }
}
