//! Calls at random.

use std::f32::consts::PI;
use std::sync::Arc;
use std::time::Instant;

use rastrum::{
    Antialias, BlendMode, Canvas, Color, FillRule, FilterQuality, GradientStop, IntRect, LineCap, LineJoin,
    LinearGradient, Mask, MaskKind, Paint, Path, Pattern, Pixmap, RadialGradient, RenderSettings, Shadow, SimdLevel,
    SpreadMode, Stroke, SweepGradient, Transform,
};

use super::{CALLS, HANG, MODES};
use crate::oracle::Random;

/// Draws numbers and choices at random, most of them odd ones.
struct Odd(Random);

impl Odd {
    fn choose<T: Clone>(&mut self, from: &[T]) -> T {
        from[self.0.within(0..from.len() as i64) as usize].clone()
    }

    fn number(&mut self) -> f32 {
        const POOL: [f32; 16] = [
            0.0,
            1e-30,
            1e-10,
            0.5,
            1.0,
            12.3,
            31.0,
            40.5,
            255.99,
            1e4,
            3.2767e4,
            1e7,
            1e15,
            1e30,
            f32::MAX,
            f32::INFINITY,
        ];
        match self.0.within(0..40) {
            0 => f32::NAN,
            // Whole shapes should not always be spoiled by one number.
            1..20 => self.0.within(-20 * 16..80 * 16) as f32 / 16.0,
            _ => self.choose(&POOL) * self.choose(&[1.0, -1.0]),
        }
    }

    fn numbers(&mut self) -> [f32; 8] {
        [(); 8].map(|()| self.number())
    }

    fn color(&mut self) -> Color {
        let mut component = || match self.0.within(0..8) {
            0 => self.number(),
            v => v as f32 / 7.0,
        };
        Color::from_rgba(component(), component(), component(), component())
    }

    fn stops(&mut self) -> Vec<GradientStop> {
        (0..self.0.within(0..6)).map(|_| GradientStop::new(self.number() / 30.0, self.color())).collect()
    }

    fn transform(&mut self) -> Transform {
        let v = self.numbers();
        match self.0.within(0..6) {
            0 => Transform::from_row(v[0], v[1], v[2], v[3], v[4], v[5]),
            1 => Transform::from_rotate(v[0]),
            2 => Transform::from_skew(v[0], v[1]),
            3 => Transform::from_scale(v[0] / 20.0, v[1] / 20.0),
            4 => Transform::from_translate(v[0], v[1]),
            _ => Transform::IDENTITY,
        }
    }

    fn paint(&mut self, image: &Arc<Pixmap>) -> Paint {
        let (v, stops, transform) = (self.numbers(), self.stops(), self.transform());
        let spread = self.choose(&[SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect, SpreadMode::Decal]);
        let quality = self.choose(&[FilterQuality::Nearest, FilterQuality::Bilinear, FilterQuality::Bicubic]);
        let (a, b) = ((v[0], v[1]), (v[2], v[3]));
        let paint = match self.0.within(0..8) {
            0 => Paint::new(LinearGradient::new(a, b, stops).with_spread(spread).with_transform(transform)),
            1 => {
                let radial = RadialGradient::two_point(a, v[4], b, v[5], stops);
                Paint::new(radial.with_spread(spread).with_transform(transform))
            }
            2 => {
                let sweep = SweepGradient::new(a, stops).with_angles(v[4], v[5]);
                Paint::new(sweep.with_spread(spread).with_transform(transform))
            }
            3 => {
                let pattern = Pattern::new(Arc::clone(image)).with_quality(quality).with_spread(spread);
                Paint::new(pattern.with_transform(transform))
            }
            _ => Paint::new(self.color()),
        };
        let opacity = self.choose(&[1.0, 1.0, 0.5, 2.0, -1.0, f32::NAN]);
        let mode = if self.0.within(0..3) == 0 { self.choose(&BlendMode::ALL) } else { BlendMode::SourceOver };
        paint.with_antialias(self.antialias()).with_opacity(opacity).with_blend_mode(mode)
    }

    fn antialias(&mut self) -> Antialias {
        let odd = [Antialias::Supersample(0), Antialias::Supersample(3), Antialias::Supersample(255)];
        if self.0.within(0..8) == 0 { self.choose(&odd) } else { self.choose(&MODES) }
    }

    fn stroke(&mut self) -> Stroke {
        let mut stroke = Stroke::new(self.choose(&[0.0, 1e-30, 0.3, 1.0, 5.0, 40.0, 1e4, 1e30, -1.0, f32::NAN]))
            .with_cap(self.choose(&[LineCap::Butt, LineCap::Round, LineCap::Square]))
            .with_join(self.choose(&[LineJoin::Miter, LineJoin::MiterClip, LineJoin::Round, LineJoin::Bevel]))
            .with_miter_limit(self.choose(&[4.0, 0.0, 1.0, 1e30, f32::NAN, -1.0]));
        if self.0.within(0..4) == 0 {
            let intervals: Vec<f32> =
                (0..self.0.within(0..5)).map(|_| self.choose(&[0.0, 0.5, 3.0, 7.0, 1e30])).collect();
            stroke = stroke.with_dash(intervals, self.number());
        }
        stroke
    }

    fn path(&mut self) -> Path {
        let mut path = Path::new();
        for _ in 0..self.0.within(1..7) {
            let v = self.numbers();
            let (a, b, c) = ((v[0], v[1]), (v[2], v[3]), (v[4], v[5]));
            match self.0.within(0..12) {
                0 => path.move_to(a),
                1..4 => path.line_to(a),
                4 => path.quad_to(a, b),
                5..7 => path.cubic_to(a, b, c),
                7 => path.close(),
                8 => path.arc(a, v[2], v[3] * PI, v[4] * PI),
                9 => path.arc_to(a, b, v[4]),
                10 => path.svg_arc_to(v[0], v[1], v[2], v[3] > 0.0, v[4] > 0.0, c),
                _ => path.ellipse(a, v[2], v[3]),
            };
        }
        path
    }

    /// One random call.
    fn call(&mut self, canvas: &mut Canvas<'_>, image: &Arc<Pixmap>) {
        let (paint, stroke, v) = (self.paint(image), self.stroke(), self.numbers());
        let whole = |v: f32| v as i32;
        match self.0.within(0..24) {
            0 => canvas.save(),
            1 => canvas.restore(),
            2 => canvas.transform(self.transform()),
            3 => canvas.set_transform(Transform::IDENTITY),
            4 => canvas.push_layer(v[0], self.choose(&BlendMode::ALL)),
            5 | 6 => canvas.pop_layer(),
            7 => {
                let kind = self.choose(&[MaskKind::Alpha, MaskKind::Luminance]);
                canvas.push_mask(kind);
                let (name, call) = self.choose(&CALLS);
                let _ = name;
                call(canvas, &paint, &stroke, v);
                canvas.pop_mask();
            }
            8 => {
                let deviation = self.choose(&[0.0, 0.7, 3.0, -1.0, f32::NAN]);
                let (offset_x, offset_y, color) = (self.number(), self.number(), self.color());
                canvas.set_shadow(Shadow { offset_x, offset_y, deviation, color });
            }
            9 => canvas.set_shadow(None),
            10 => {
                let path = self.path();
                canvas.save();
                canvas.clip_path(&path, FillRule::EvenOdd, paint.antialias);
            }
            11 => {
                let mask = Mask::from_vec(3, 2, vec![255, 128, 0, 1, 200, 90]).unwrap();
                canvas.save();
                canvas.clip_mask(mask, whole(v[0]), whole(v[1]));
            }
            12 => {
                canvas.draw_pixel_line((whole(v[0]), whole(v[1])), (whole(v[2]), whole(v[3])), &paint);
                canvas.draw_pixel_circle((whole(v[4]), whole(v[5])), v[6] as u32, &paint);
                canvas.fill_pixel_circle((whole(v[5]), whole(v[6])), v[7] as u32, &paint);
            }
            13 => canvas.write_pixels(image.as_ref().as_ref(), whole(v[0]), whole(v[1])).unwrap(),
            14 => {
                let rect = IntRect::from_xywh(whole(v[0]), whole(v[1]), 7, 5);
                let _ = canvas.read_pixels(rect).map(|part| canvas.write_pixels(part.as_ref(), 3, 3));
            }
            15 => {
                let path = self.path();
                let _ = canvas.is_point_in_path(&path, FillRule::NonZero, (v[0], v[1]));
                let _ = canvas.is_point_in_stroke(&path, &stroke, (v[2], v[3]));
            }
            16..19 => canvas.fill_path(&self.path(), self.choose(&[FillRule::NonZero, FillRule::EvenOdd]), &paint),
            19..22 => canvas.stroke_path(&self.path(), &stroke, &paint),
            _ => self.choose(&CALLS).1(canvas, &paint, &stroke, v),
        }
    }
}

#[test]
fn random_calls_with_odd_numbers_neither_panic_nor_depend_on_the_settings() {
    let image = {
        let mut canvas = Canvas::new(9, 7).unwrap();
        canvas.clear(Color::from_rgba(0.2, 0.8, 0.4, 0.5));
        canvas.fill_circle((4.0, 3.0), 3.0, Color::RED);
        Arc::new(canvas.into_pixmap())
    };
    let draw = |seed: u64, settings: RenderSettings| {
        let mut odd = Odd(Random::new(seed));
        let mut canvas = Canvas::with_settings(64, 48, settings).unwrap();
        canvas.clear(Color::WHITE);
        for _ in 0..12 {
            odd.call(&mut canvas, &image);
        }
        canvas.into_pixmap().into_vec()
    };
    let mut shown = 0;
    for seed in 0..700 {
        let start = Instant::now();
        let found = draw(seed, RenderSettings::default());
        assert!(start.elapsed() < HANG, "seed {seed} takes {:?}", start.elapsed());
        let plain = RenderSettings { level: SimdLevel::Scalar, threads: 1, band_height: 8 };
        assert!(found == draw(seed, plain), "seed {seed} differs");
        shown += u32::from(found.iter().any(|v| *v != 255));
    }
    assert!(shown > 350, "most pictures are empty: {shown}");
}
