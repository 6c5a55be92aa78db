//! Fragments and framebuffer: rows 15 to 20 and 89 to 112 of the checklist.

use rastrum::fearless_simd::{Simd, f32x8, prelude::*, u32x8};
use rastrum::space::*;
use rastrum::{Color, IntRect, Pixmap};

use crate::oracle::{Random, rays};
use crate::space_support::*;

const SIZE: u32 = 16;

fn pipeline(state: State) -> Pipeline {
    Pipeline::new(SIZE, SIZE).with_state(state).with_threads(1)
}

/// Draws a full quad at a depth in a colour (premultiplied, 0 ..= 1).
fn fill(target: &mut Target, state: State, z: f32, color: [f32; 4]) -> Counters {
    pipeline(state).draw(target, &Primitives::triangles(&quad(z, color)), &pass(), &Values)
}

fn off() -> State {
    State { depth: Depth::OFF, ..State::default() }
}

fn new() -> Target {
    Target::new(SIZE, SIZE).unwrap()
}

#[test]
fn s015_a_discarded_fragment_writes_neither_colour_nor_depth() {
    let mut target = new();
    let stencil = Stencil::both(StencilFace { pass: StencilOp::IncrementClamp, ..StencilFace::default() });
    let shader = pixel_fn(4, |f: &Fragment| (!(f.x + f.y).is_multiple_of(3)).then_some([0.0, 1.0, 0.0, 1.0]));
    let state = State { stencil: Some(stencil), ..State::default() };
    pipeline(state).draw(&mut target, &Primitives::triangles(&quad(0.25, [0.0; 4])), &pass(), &shader);
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        let expected = if (x + y) % 3 != 0 { ([0, 255, 0, 255], 0.25, 1) } else { ([0; 4], 1.0, 0) };
        let got = (target.pixel(x, y).unwrap(), target.depth(x, y).unwrap(), target.stencil(x, y).unwrap());
        assert_eq!(got, expected);
    }
}

#[test]
fn s016_the_colour_buffer_is_cleared_written_and_read_exactly() {
    let mut target = Target::new(13, 9).unwrap();
    target.clear_color(Color::from_rgba8(10, 20, 30, 255));
    assert!((0..9).all(|y| (0..13).all(|x| target.pixel(x, y) == Some([10, 20, 30, 255]))));
    assert_eq!((target.pixel(13, 0), target.pixel(0, 9)), (None, None));
    for value in 0..=255_u8 {
        let v = f32::from(value) / 255.0;
        let quad = quad(0.5, [v, 1.0 - v, v * 0.5, 1.0]);
        let pipeline = Pipeline::new(13, 9).with_state(off());
        pipeline.draw(&mut target, &Primitives::triangles(&quad), &pass(), &Values);
        let expected = [value, 255 - value, ((f32::from(value) / 2.0) + 0.5).floor() as u8, 255];
        assert_eq!(target.pixel(12, 8), Some(expected));
    }
    // Colour masks leave the others alone.
    let state = State { color_mask: [true, false, false, true], ..off() };
    target.clear_color(Color::from_rgba8(1, 2, 3, 255));
    let white = quad(0.5, [1.0; 4]);
    Pipeline::new(13, 9).with_state(state).draw(&mut target, &Primitives::triangles(&white), &pass(), &Values);
    assert_eq!(target.pixel(5, 5), Some([255, 2, 3, 255]));
    // Loading a picture and reading it back.
    let mut picture = Pixmap::new(13, 9).unwrap();
    for (i, byte) in picture.data_mut().iter_mut().enumerate() {
        *byte = (i % 251) as u8;
    }
    target.load_color(&picture).unwrap();
    assert_eq!(target.to_pixmap().unwrap(), picture);
}

#[test]
fn s017_clear_value_and_function_of_the_depth_buffer_are_chosen() {
    for format in [DepthFormat::D16, DepthFormat::D24, DepthFormat::D32F] {
        for compare in Compare::ALL {
            for (clear, z) in [(0.25, 0.5), (0.5, 0.5), (0.75, 0.5), (1.0, 0.5), (0.0, 0.5)] {
                let mut target = Target::with_format(SIZE, SIZE, format, Samples::One).unwrap();
                target.clear_depth(clear);
                let drawn =
                    fill(&mut target, State { depth: Depth::compare(compare), ..State::default() }, z, [1.0; 4]);
                let passes = compare.passes(format.key(z), format.key(clear));
                assert_eq!(drawn.samples_passed > 0, passes, "{format:?} {compare:?} {clear}");
                let stored = if passes { z } else { clear };
                assert!((target.depth(3, 3).unwrap() - stored).abs() <= format.resolution(1.0));
                // Without writes the buffer stays.
                let depth = Depth { write: false, ..Depth::compare(Compare::Always) };
                fill(&mut target, State { depth, ..State::default() }, 0.9, [1.0; 4]);
                assert!((target.depth(3, 3).unwrap() - stored).abs() <= format.resolution(1.0));
            }
        }
    }
}

#[test]
fn s018_every_stencil_operation() {
    for op in StencilOp::ALL {
        for stored in [0_u8, 1, 7, 128, 254, 255] {
            for reference in [0, 9, 255] {
                let expected = match op {
                    StencilOp::Keep => stored,
                    StencilOp::Zero => 0,
                    StencilOp::Replace => reference,
                    StencilOp::IncrementClamp => (u16::from(stored) + 1).min(255) as u8,
                    StencilOp::DecrementClamp => (i16::from(stored) - 1).max(0) as u8,
                    StencilOp::Invert => 255 - stored,
                    StencilOp::IncrementWrap => ((u16::from(stored) + 1) % 256) as u8,
                    StencilOp::DecrementWrap => ((u16::from(stored) + 255) % 256) as u8,
                };
                let mut target = new();
                target.clear_stencil(stored);
                let face = StencilFace { reference, pass: op, ..StencilFace::default() };
                fill(&mut target, State { stencil: Some(Stencil::both(face)), ..off() }, 0.5, [1.0; 4]);
                assert_eq!(target.stencil(8, 8), Some(expected), "{op:?} {stored} {reference}");
                // Through a write mask only its bits change.
                target.clear_stencil(stored);
                let face = StencilFace { write_mask: 0x0f, ..face };
                fill(&mut target, State { stencil: Some(Stencil::both(face)), ..off() }, 0.5, [1.0; 4]);
                assert_eq!(target.stencil(8, 8), Some((stored & 0xf0) | (expected & 0x0f)));
            }
        }
    }
}

#[test]
fn s019_the_mean_of_equal_frames_is_the_frame() {
    let mut frame = Pixmap::new(16, 16).unwrap();
    for (i, byte) in frame.data_mut().iter_mut().enumerate() {
        *byte = (i * 7 % 256) as u8;
    }
    for n in [1, 2, 3, 7, 16, 255] {
        let mut sum = Accumulation::new(16, 16).unwrap();
        for _ in 0..n {
            sum.add(&frame, 1).unwrap();
        }
        assert_eq!(sum.average().unwrap(), frame);
        sum.clear();
        assert!(sum.average().unwrap().data().iter().all(|v| *v == 0));
    }
    // Two frames: the mean, rounded to nearest; weights count.
    let mut sum = Accumulation::new(16, 16).unwrap();
    let dark = Pixmap::new(16, 16).unwrap();
    sum.add(&frame, 3).unwrap();
    sum.add(&dark, 1).unwrap();
    for (mean, v) in sum.average().unwrap().data().iter().zip(frame.data()) {
        assert_eq!(*mean, ((f64::from(*v) * 0.75) + 0.5).floor() as u8);
    }
    assert!(sum.add(&Pixmap::new(8, 8).unwrap(), 1).is_err() && sum.add(&dark, 1 << 24).is_err());
}

#[test]
fn s020_present_swaps_and_leaves_the_back_buffer_as_it_was() {
    let mut frames = Frames::new(new());
    fill(frames.back(), off(), 0.5, [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(frames.front().pixel(0, 0), Some([0; 4]), "drawing does not show");
    frames.present();
    assert_eq!(frames.front().pixel(0, 0), Some([255, 0, 0, 255]));
    fill(frames.back(), off(), 0.5, [0.0, 0.0, 1.0, 1.0]);
    let drawn = frames.back().to_pixmap().unwrap();
    frames.present();
    assert_eq!(frames.front().to_pixmap().unwrap(), drawn);
    assert_eq!(frames.back().pixel(0, 0), Some([255, 0, 0, 255]), "what was shown is the back now, intact");
}

/// Samples a texture over a quad whose u and v run over `from ..= to`.
struct Sampled<'a> {
    texture: &'a Texture,
    grad: bool,
}

impl FragmentShader for Sampled<'_> {
    #[inline(always)]
    fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
        let [u, v] = f.varyings(0);
        Shade::packed(if self.grad {
            self.texture.sample_grad(u, v, f.derivatives(0), f.derivatives(1))
        } else {
            self.texture.sample(u, v)
        })
    }
}

fn textured(texture: &Texture, size: u32, (u0, u1): (f32, f32), (v0, v1): (f32, f32), grad: bool) -> Pixmap {
    let corner = |x: f32, y: f32| {
        let values = [if x < 0.0 { u0 } else { u1 }, if y < 0.0 { v1 } else { v0 }, 0.0, 0.0];
        Vertex::new([x, y, 0.0, 1.0], values)
    };
    let c = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let list = [c[0], c[1], c[2], c[0], c[2], c[3]];
    let mut target = Target::new(size, size).unwrap();
    let pipeline = Pipeline::new(size, size).with_state(off());
    pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Sampled { texture, grad });
    target.to_pixmap().unwrap()
}

fn noise(width: usize, height: usize, depth: usize, seed: u64) -> Vec<u32> {
    let mut random = Random::new(seed);
    (0..width * height * depth).map(|_| random.bits() as u32 | 0xff00_0000).collect()
}

/// The texel that a place beyond the sides stands for.
fn address(i: i64, size: i64, mode: Address) -> i64 {
    match mode {
        Address::Wrap => i.rem_euclid(size),
        Address::Clamp => i.clamp(0, size - 1),
        Address::Mirror => {
            let i = i.rem_euclid(2 * size);
            if i < size { i } else { 2 * size - 1 - i }
        }
    }
}

#[test]
fn s089_nearest_is_exact_and_bilinear_within_three_levels() {
    let (w, h) = (11, 7);
    let texels = noise(w, h, 1, 89);
    let at = |x: i64, y: i64, mode: Address| {
        let (x, y) = (address(x, w as i64, mode), address(y, h as i64, mode));
        texels[y as usize * w + x as usize].to_le_bytes()
    };
    for mode in [Address::Wrap, Address::Clamp, Address::Mirror] {
        let range = (-1.3, 2.45);
        let nearest = Texture::new(w as u32, h as u32, 1, texels.clone(), Sampler::new(mode, Filter::Nearest)).unwrap();
        let linear = Texture::new(w as u32, h as u32, 1, texels.clone(), Sampler::new(mode, Filter::Bilinear)).unwrap();
        let (near, smooth) = (textured(&nearest, 64, range, range, false), textured(&linear, 64, range, range, false));
        for (x, y) in (0..64).flat_map(|y| (0..64).map(move |x| (x, y))) {
            let coordinate = |i: u32| -1.3 + 3.75 * (f64::from(i) + 0.5) / 64.0;
            let (u, v) = (coordinate(x) * w as f64, coordinate(y) * h as f64);
            let doubtful = |t: f64| (t - t.round()).abs() < 1e-4;
            if !doubtful(u) && !doubtful(v) {
                let expected = at(u.floor() as i64, v.floor() as i64, mode);
                assert_eq!(near.pixel(x, y), Some(expected), "{mode:?} {x} {y}");
            }
            let (u, v) = (u - 0.5, v - 0.5);
            let (fx, fy) = (u - u.floor(), v - v.floor());
            let (i, j) = (u.floor() as i64, v.floor() as i64);
            let four = [at(i, j, mode), at(i + 1, j, mode), at(i, j + 1, mode), at(i + 1, j + 1, mode)];
            let weights = [(1.0 - fx) * (1.0 - fy), fx * (1.0 - fy), (1.0 - fx) * fy, fx * fy];
            for c in 0..4 {
                let expected: f64 = four.iter().zip(weights).map(|(t, w)| f64::from(t[c]) * w).sum();
                let got = f64::from(smooth.pixel(x, y).unwrap()[c]);
                assert!((got - expected).abs() <= 3.0, "{mode:?} {x} {y}: {got} {expected}");
            }
        }
    }
    // Coordinates that are no numbers stop nothing.
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 1e30, -1e30] {
        let texture = Texture::new(w as u32, h as u32, 1, texels.clone(), Sampler::default()).unwrap();
        textured(&texture, 8, (bad, bad), (0.0, bad), true);
    }
    assert!(Texture::new(0, 4, 1, Vec::new(), Sampler::default()).is_err());
    assert!(Texture::new(4, 4, 1, vec![0; 15], Sampler::default()).is_err());
}

/// Samples a texture at places that are given, eight at a time.
fn sample_at(texture: &Texture, places: &[[f32; 3]], volume: bool) -> Vec<[u8; 4]> {
    struct At<'a>(&'a Texture, &'a [[f32; 3]], bool);
    impl FragmentShader for At<'_> {
        #[inline(always)]
        fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
            let place = |lane: usize| self.1.get(f.x() as usize + lane).copied().unwrap_or_default();
            let [u, v, w] = [0, 1, 2].map(|k| f32x8::from_fn(f.simd(), |i| place(i)[k]));
            Shade::packed(if self.2 { self.0.sample_3d(u, v, w) } else { self.0.sample(u, v) })
        }
    }
    let width = places.len() as u32;
    let mut target = Target::new(width, 1).unwrap();
    let pipeline = Pipeline::new(width, 1).with_state(off());
    pipeline.draw(&mut target, &Primitives::triangles(&quad(0.5, [0.0; 4])), &pass(), &At(texture, places, volume));
    (0..width).map(|x| target.pixel(x, 0).unwrap()).collect()
}

#[test]
fn s090_textures_of_one_two_and_three_dimensions_are_exact_at_texel_centres() {
    for filter in [Filter::Nearest, Filter::Bilinear] {
        for (size, volume) in [([9, 1, 1], false), ([5, 4, 1], false), ([4, 3, 5], true)] {
            let texels = noise(size[0], size[1], size[2], 90);
            let [w, h, d] = size.map(|v| v as u32);
            let texture = Texture::new(w, h, d, texels.clone(), Sampler::new(Address::Clamp, filter)).unwrap();
            let center = |i: usize, size: usize| (i as f32 + 0.5) / size as f32;
            let places: Vec<[f32; 3]> = (0..texels.len())
                .map(|i| {
                    let (x, y, z) = (i % size[0], i / size[0] % size[1], i / size[0] / size[1]);
                    [center(x, size[0]), center(y, size[1]), center(z, size[2])]
                })
                .collect();
            let expected: Vec<[u8; 4]> = texels.iter().map(|t| t.to_le_bytes()).collect();
            assert_eq!(sample_at(&texture, &places, volume), expected, "{filter:?} {size:?}");
        }
    }
    // Half way between two slices: their mean.
    let texture = Texture::new(1, 1, 2, vec![0xff00_0000, 0xff00_00c8], Sampler::new(Address::Clamp, Filter::Bilinear));
    assert_eq!(sample_at(&texture.unwrap(), &[[0.5, 0.5, 0.5]], true), [[100, 0, 0, 255]]);
}

#[test]
fn s091_a_minified_checker_is_uniform_grey_with_mipmaps() {
    let texels: Vec<u32> =
        (0..64 * 64).map(|i| if (i % 64 + i / 64) % 2 == 0 { 0xffff_ffff } else { 0xff00_0000 }).collect();
    let texture = |filter| Texture::new(64, 64, 1, texels.clone(), Sampler::new(Address::Wrap, filter)).unwrap();
    let mipmapped = texture(Filter::Trilinear);
    assert_eq!(mipmapped.levels(), 7);
    let scale = (0.0, 3.7);
    let calm = textured(&mipmapped, 48, scale, scale, true);
    for pixel in calm.data().as_chunks::<4>().0 {
        assert!(pixel[..3].iter().all(|v| v.abs_diff(128) <= 2), "{pixel:?}");
    }
    // Without them it is moiré: black, white and everything between.
    let moire = textured(&texture(Filter::Nearest), 48, scale, scale, true);
    let values: Vec<u8> = moire.data().as_chunks::<4>().0.iter().map(|pixel| pixel[0]).collect();
    assert!(values.contains(&0) && values.contains(&255));
    // The level follows the size: at one texel a pixel it is the texture itself.
    let same = textured(&mipmapped, 64, (0.0, 1.0), (0.0, 1.0), true);
    let exact: Vec<u8> = texels.iter().flat_map(|t| t.to_le_bytes()).collect();
    assert!(same.data().iter().zip(&exact).all(|(a, b)| a.abs_diff(*b) <= 4));
    // Each level is the mean of the one above, odd sizes too.
    let odd = noise(7, 5, 1, 91);
    let texture = Texture::new(7, 5, 1, odd.clone(), Sampler::default()).unwrap();
    assert_eq!(texture.levels(), 3);
    let mean = |c: usize| odd.iter().map(|t| f64::from(t.to_le_bytes()[c])).sum::<f64>() / 35.0;
    let last = texture.texel(2, 0, 0, 0).unwrap().to_le_bytes();
    assert!((0..4).all(|c| (f64::from(last[c]) - mean(c)).abs() <= 1.5));
}

#[test]
fn s093_the_scissor_lets_nothing_outside_through_and_changes_nothing_inside() {
    let mut random = Random::new(93);
    let list: Vec<Vertex> = (0..40)
        .flat_map(|i| {
            vertices(random_triangle(&mut random, 16, 8), i as f32 / 40.0, [i as f32 / 40.0, 0.5, 1.0, 1.0], 16.0)
        })
        .collect();
    let free = picture(&pipeline(State::default()), SIZE, &list);
    for scissor in [
        IntRect::from_xywh(3, 5, 7, 6),
        IntRect::from_xywh(-5, -5, 9, 50),
        IntRect::from_xywh(8, 8, 1, 1),
        IntRect::from_xywh(4, 4, 0, 3),
        IntRect::from_xywh(100, 0, 5, 5),
    ] {
        let cut = picture(&pipeline(State { scissor: Some(scissor), ..State::default() }), SIZE, &list);
        for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            let inside = scissor.intersect(IntRect::from_xywh(x as i32, y as i32, 1, 1));
            let expected = if inside.is_empty() { Some([0; 4]) } else { free.pixel(x, y) };
            assert_eq!(cut.pixel(x, y), expected, "{scissor:?} {x} {y}");
        }
    }
}

#[test]
fn s094_the_alpha_test_keeps_what_passes_and_leaves_depth_untouched_below() {
    // Alpha runs from 0 to 1 across the target.
    let mut list = quad(0.25, [0.0, 0.0, 0.0, 0.0]);
    for vertex in &mut list {
        vertex.values[3] = vertex.position[0] * 0.5 + 0.5;
    }
    let mut target = new();
    let state = State { alpha_test: Some((Compare::GreaterEqual, 128)), ..State::default() };
    pipeline(state).draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
    for x in 0..SIZE {
        let alpha = ((x as f32 + 0.5) / 16.0 * 255.0 + 0.5) as u8;
        let kept = alpha >= 128;
        assert_eq!(target.depth(x, 7), Some(if kept { 0.25 } else { 1.0 }), "{x}");
        assert_eq!(target.pixel(x, 7).unwrap()[3], if kept { alpha } else { 0 });
    }
}

#[test]
fn s096_eight_stencil_functions_with_three_operations() {
    for compare in Compare::ALL {
        for (reference, stored, mask) in
            [(5_u8, 5_u8, 255_u8), (4, 5, 255), (6, 5, 255), (0x15, 0x25, 0x0f), (0x1f, 0x25, 0x0f)]
        {
            for depth_passes in [true, false] {
                let face = StencilFace {
                    compare,
                    reference,
                    read_mask: mask,
                    write_mask: 255,
                    fail: StencilOp::Invert,
                    depth_fail: StencilOp::IncrementClamp,
                    pass: StencilOp::Zero,
                };
                let mut target = new();
                target.clear_stencil(stored);
                target.clear_depth(if depth_passes { 1.0 } else { 0.0 });
                let state = State { stencil: Some(Stencil::both(face)), ..State::default() };
                let counters = fill(&mut target, state, 0.5, [1.0; 4]);
                let (a, b) = (reference & mask, stored & mask);
                let passes = match compare {
                    Compare::Never => false,
                    Compare::Less => a < b,
                    Compare::Equal => a == b,
                    Compare::LessEqual => a <= b,
                    Compare::Greater => a > b,
                    Compare::NotEqual => a != b,
                    Compare::GreaterEqual => a >= b,
                    Compare::Always => true,
                };
                let expected = match (passes, depth_passes) {
                    (false, _) => !stored,
                    (true, false) => stored + 1,
                    (true, true) => 0,
                };
                assert_eq!(target.stencil(9, 2), Some(expected), "{compare:?} {reference} {stored}");
                assert_eq!(counters.samples_passed > 0, passes && depth_passes);
                assert_eq!(target.pixel(9, 2).unwrap()[3] > 0, passes && depth_passes);
            }
        }
    }
    // Front and back have their own: this quad is counter-clockwise, its mirror image clockwise.
    let mut target = new();
    let stencil = Stencil {
        front: StencilFace { pass: StencilOp::IncrementWrap, ..StencilFace::default() },
        back: StencilFace { pass: StencilOp::DecrementWrap, ..StencilFace::default() },
    };
    let state = State { stencil: Some(stencil), ..off() };
    fill(&mut target, state, 0.5, [1.0; 4]);
    assert_eq!(target.stencil(0, 0), Some(1));
    let mut turned = quad(0.5, [1.0; 4]);
    turned.reverse();
    pipeline(state).draw(&mut target, &Primitives::triangles(&turned), &pass(), &Values);
    pipeline(state).draw(&mut target, &Primitives::triangles(&turned), &pass(), &Values);
    assert_eq!(target.stencil(0, 0), Some(255));
}

#[test]
fn s098_the_depth_test_is_the_element_wise_minimum() {
    // Two surfaces on a grid of 8 × 8, as the lecture draws them: one slanted along x, one constant.
    let mut slanted = quad(0.0, [1.0, 0.0, 0.0, 1.0]);
    for vertex in &mut slanted {
        vertex.position[2] = vertex.position[0];
    }
    let flat = quad(0.47, [0.0, 1.0, 0.0, 1.0]);
    for order in [[&slanted, &flat], [&flat, &slanted]] {
        let mut target = Target::new(8, 8).unwrap();
        for surface in order {
            Pipeline::new(8, 8).draw(&mut target, &Primitives::triangles(surface), &pass(), &Values);
        }
        for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
            let (a, b) = ((x as f32 + 0.5) / 8.0, 0.47_f32);
            assert!((target.depth(x, y).unwrap() - a.min(b)).abs() < 1e-6);
            let expected = if a < b { [255, 0, 0, 255] } else { [0, 255, 0, 255] };
            assert_eq!(target.pixel(x, y), Some(expected));
        }
    }
}

#[test]
fn s099_minus_one_and_greater_is_infinity_and_less() {
    let mut random = Random::new(99);
    let list: Vec<Vertex> = (0..60)
        .flat_map(|i| {
            vertices(
                random_triangle(&mut random, 16, 8),
                random.within(1..64) as f32 / 64.0,
                [i as f32 / 60.0, 1.0, 0.0, 1.0],
                16.0,
            )
        })
        .collect();
    let mut less = new();
    less.clear_depth(f32::INFINITY);
    pipeline(State::default()).draw(&mut less, &Primitives::triangles(&list), &pass(), &Values);
    let mut greater = new();
    greater.clear_depth(-1.0);
    let mut reversed = pipeline(State { depth: Depth::compare(Compare::Greater), ..State::default() });
    (reversed.viewport.near, reversed.viewport.far) = (1.0, 0.0);
    reversed.draw(&mut greater, &Primitives::triangles(&list), &pass(), &Values);
    assert_eq!(less.to_pixmap().unwrap(), greater.to_pixmap().unwrap());
    assert!(drawn(&less).len() > 200);
    for (a, b) in less.depths().into_iter().zip(greater.depths()) {
        assert!((a.is_infinite() && b == -1.0) || (a - (1.0 - b)).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn s100_the_order_of_triangles_does_not_show_where_depths_differ() {
    let mut random = Random::new(100);
    let triangles: Vec<[Vertex; 3]> = (0..50)
        .map(|i| {
            vertices(
                random_triangle(&mut random, 64, 20),
                (i as f32 + 1.0) / 60.0,
                [i as f32 / 50.0, 0.2, 0.9, 1.0],
                64.0,
            )
        })
        .collect();
    let draw = |order: &[usize]| {
        let list: Vec<Vertex> = order.iter().flat_map(|i| triangles[*i]).collect();
        picture(&Pipeline::new(64, 64), 64, &list)
    };
    let mut order: Vec<usize> = (0..50).collect();
    let expected = draw(&order);
    for _ in 0..20 {
        for i in (1..50).rev() {
            order.swap(i, random.within(0..i as i64 + 1) as usize);
        }
        assert!(draw(&order) == expected);
    }
}

#[test]
fn s101_alpha_blending_is_the_formula_on_straight_and_premultiplied_colours() {
    for alpha in (0..=255_u32).step_by(5) {
        for (front, back) in [(255, 0), (0, 255), (200, 100), (13, 250)] {
            let a = alpha as f32 / 255.0;
            let mut target = new();
            target.clear_color(Color::from_rgba8(back, back, back, 255));
            let color = [front as f32 / 255.0 * a, front as f32 / 255.0 * a, front as f32 / 255.0 * a, a];
            fill(&mut target, State { blend: Blend::SourceOver, ..off() }, 0.5, color);
            let expected = f64::from(a) * f64::from(front) + (1.0 - f64::from(a)) * f64::from(back);
            let [r, _, _, opacity] = target.pixel(3, 3).unwrap();
            assert!((f64::from(r) - expected).abs() <= 1.0, "{alpha} {front} {back}: {r} {expected}");
            assert_eq!(opacity, 255);
        }
    }
    // Over a translucent destination: premultiplied alphas add up as 1 − (1 − a)(1 − b).
    let mut target = new();
    fill(&mut target, State { blend: Blend::SourceOver, ..off() }, 0.5, [0.0, 0.0, 0.5, 0.5]);
    fill(&mut target, State { blend: Blend::SourceOver, ..off() }, 0.5, [0.25, 0.0, 0.0, 0.25]);
    assert_eq!(target.pixel(0, 0), Some([64, 0, 96, 160]));
}

#[test]
fn s102_additive_minimum_maximum_and_multiply() {
    let (s, d) = ([100_u8, 200, 30, 180], [120_u8, 90, 30, 255]);
    let table: [(Blend, fn(u32, u32) -> u32); 5] = [
        (Blend::Replace, |s, _| s),
        (Blend::Additive, |s, d| (s + d).min(255)),
        (Blend::Min, |s, d| s.min(d)),
        (Blend::Max, |s, d| s.max(d)),
        (Blend::Multiply, |s, d| (2 * s * d + 255) / 510),
    ];
    for samples in Samples::ALL {
        for (blend, formula) in table {
            let mut target = Target::with_format(SIZE, SIZE, DepthFormat::D32F, samples).unwrap();
            target.clear_color_bits(u32::from_le_bytes(d));
            fill(&mut target, State { blend, ..off() }, 0.5, s.map(|v| f32::from(v) / 255.0));
            let expected = [0, 1, 2, 3].map(|i| formula(u32::from(s[i]), u32::from(d[i])) as u8);
            assert_eq!(target.pixel(5, 5), Some(expected), "{blend:?} {samples:?}");
        }
    }
}

#[test]
fn s105_painters_algorithm_fails_on_a_cycle_and_the_depth_buffer_does_not() {
    // Three bars, each over the next at one end and under the one before at the other.
    let colors = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]];
    let bars: Vec<[Vertex; 3]> = (0..3)
        .map(|i| {
            let (s, c) = [(0.0_f32, 1.0_f32), (0.866, -0.5), (-0.866, -0.5)][i];
            let turn = |x: f32, y: f32, z: f32| Vertex::new([x * c - y * s, x * s + y * c, z, 1.0], colors[i]);
            [turn(-0.8, -0.55, -0.5), turn(0.8, -0.45, 0.5), turn(-0.8, -0.15, -0.5)]
        })
        .collect();
    let tail_over: Vec<Vertex> = bars.iter().flatten().copied().collect();
    let right = picture(&Pipeline::new(96, 96), 96, &tail_over);
    // The ray oracle, parallel rays along z: the smallest z wins.
    let truth = |x: u32, y: u32| {
        let (px, py) = ((f64::from(x) + 0.5) / 48.0 - 1.0, 1.0 - (f64::from(y) + 0.5) / 48.0);
        let triangles: Vec<_> = bars.iter().map(|b| b.map(|v| [0, 1, 2].map(|i| f64::from(v.position[i])))).collect();
        rays::nearest([px, py, -10.0], [0.0, 0.0, 1.0], &triangles, 0.03)
    };
    let mut wrong = [0; 7];
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let painted: Vec<Pixmap> = orders
        .iter()
        .map(|order| {
            let list: Vec<Vertex> = order.iter().flat_map(|i| bars[*i]).collect();
            picture(&Pipeline::new(96, 96).with_state(off()), 96, &list)
        })
        .collect();
    for (x, y) in (0..96).flat_map(|y| (0..96).map(move |x| (x, y))) {
        let Some(nearest) = truth(x, y) else { continue };
        let expected = nearest.map_or([0; 4], |(i, _)| colors[i].map(|v| (v * 255.0) as u8));
        for (count, picture) in wrong.iter_mut().zip(std::iter::once(&right).chain(&painted)) {
            *count += usize::from(picture.pixel(x, y) != Some(expected));
        }
    }
    assert_eq!(wrong[0], 0, "the depth buffer is right");
    assert!(wrong[1..].iter().all(|count| *count > 10), "no order of painting is right: {wrong:?}");
}

/// Two walls at the given distances drawn one over the other; how many pixels show the farther one.
fn fight(format: DepthFormat, near: f32, far: f32, z: [f32; 2], mapping: DepthMapping) -> usize {
    let projection = camera::perspective(1.0, 1.0, near, far);
    // Slightly tilted, alike, so that rounding differs from pixel to pixel.
    let wall = |z: f32, color: [f32; 4]| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| {
            let depth = z * (1.0 + 0.04 * x + 0.03 * y);
            Vertex::new(camera::transform(&projection, [x * z, y * z, -depth, 1.0]), color)
        })
    };
    let list: Vec<Vertex> =
        wall(z[0], [1.0, 0.0, 0.0, 1.0]).into_iter().chain(wall(z[1], [0.0, 0.0, 1.0, 1.0])).collect();
    let mut target = Target::with_format(64, 64, format, Samples::One).unwrap();
    let depth = Depth { mapping, ..Depth::compare(Compare::LessEqual) };
    let state = State { depth, ..State::default() };
    Pipeline::new(64, 64).with_state(state).draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
    let pixels = target.to_pixmap().unwrap();
    pixels.data().as_chunks::<4>().0.iter().filter(|pixel| pixel[2] == 255).count()
}

#[test]
fn s106_sixteen_bits_fight_where_floats_do_not() {
    // Two cases: a large far / near, and surfaces that are close together.
    for (near, far, z) in [(0.1, 1000.0, [80.0, 80.5]), (1.0, 100.0, [50.0, 50.02])] {
        let sixteen = fight(DepthFormat::D16, near, far, z, DepthMapping::Projected);
        let float = fight(DepthFormat::D32F, near, far, z, DepthMapping::Projected);
        assert!(sixteen > 100, "{near} {far}: {sixteen}");
        assert_eq!(float, 0, "{near} {far}");
    }
}

#[test]
fn s107_the_depth_curve_and_its_loss_of_precision() {
    let (n, f) = (1.0_f32, 50.0_f32);
    let m = camera::perspective(1.0, 1.0, n, f);
    let mut last_step = f64::MAX;
    for z in [1.0_f32, 1.5, 2.0, 5.0, 10.0, 25.0, 49.0] {
        let projected = |z: f32| {
            let [_, _, cz, cw] = camera::transform(&m, [0.0, 0.0, -z, 1.0]);
            f64::from(cz) / f64::from(cw)
        };
        // z' = (f + n)/(f − n) − 2fn/(f − n)/z, with the distance z > 0; the lecture's 2nf/(f−n)·1/z + (n+f)/(f−n) with z < 0.
        let (n, f, d) = (f64::from(n), f64::from(f), f64::from(z));
        let expected = 2.0 * n * f / (f - n) * (1.0 / -d) + (n + f) / (f - n);
        assert!((projected(z) - expected).abs() < 1e-5, "{z}");
        // What a step of 0.5 in front of the camera becomes: ever less.
        let step = projected(z + 0.5) - projected(z);
        assert!(step > 0.0 && step < last_step);
        last_step = step;
    }
}

#[test]
fn s108_moving_near_and_far_closer_ends_the_fight() {
    let z = [80.0, 80.5];
    assert!(fight(DepthFormat::D16, 0.1, 1000.0, z, DepthMapping::Projected) > 100);
    assert_eq!(fight(DepthFormat::D16, 40.0, 120.0, z, DepthMapping::Projected), 0);
}

#[test]
fn s109_formats_of_more_precision_are_selectable() {
    let mut counts = Vec::new();
    for format in [DepthFormat::D16, DepthFormat::D24, DepthFormat::D32F] {
        let target = Target::with_format(8, 8, format, Samples::One).unwrap();
        assert_eq!((target.depth_format(), target.depth(0, 0)), (format, Some(1.0)));
        counts.push(fight(format, 0.1, 1000.0, [80.0, 80.5], DepthMapping::Projected));
    }
    assert!(counts[0] > 100 && counts[1] == 0 && counts[2] == 0, "{counts:?}");
    // Steps as documented: the next key is one resolution away.
    for (format, step) in [(DepthFormat::D16, 1.0 / 65_535.0), (DepthFormat::D24, 1.0 / 16_777_215.0)] {
        assert_eq!(format.key(0.25 + 1.1 * step) - format.key(0.25), 1);
        assert_eq!(format.resolution(0.25), step);
    }
    assert_eq!(DepthFormat::D32F.resolution(0.75), 0.75_f32.next_up() - 0.75);
}

#[test]
fn s110_logarithmic_depth_holds_from_a_hundredth_to_a_million() {
    let (near, far) = (1e-2, 1e6);
    let log = DepthMapping::Logarithmic { near, far };
    for z in [[0.02, 0.02002], [1.0, 1.001], [100.0, 100.1], [9000.0, 9009.0], [500_000.0, 500_500.0]] {
        assert_eq!(fight(DepthFormat::D24, near, far, z, log), 0, "{z:?}");
    }
    assert!(fight(DepthFormat::D24, near, far, [9000.0, 9009.0], DepthMapping::Projected) > 0);
    // The value is the formula's.
    let m = camera::perspective(1.0, 1.0, near, far);
    for z in [0.02_f32, 3.0, 700.0, 90_000.0] {
        let p = camera::transform(&m, [0.0, 0.0, -z, 1.0]);
        let point = [Vertex::new(p, [1.0; 4])];
        let mut target = new();
        let state = State { depth: Depth { mapping: log, ..Depth::default() }, ..State::default() };
        pipeline(state).draw(&mut target, &Primitives::new(&point, Topology::Points), &pass(), &Values);
        let (x, y) = *drawn(&target).first().unwrap();
        #[expect(clippy::disallowed_methods, reason = "compared with a tolerance")]
        let expected = (f64::from(z) / 1e-2).ln() / (1e8_f64).ln();
        let got = f64::from(target.depth(x as u32, y as u32).unwrap());
        assert!((got - expected).abs() < 1e-5, "{z}: {got} {expected}");
    }
}

#[test]
fn s111_polygon_offset_is_factor_times_slope_plus_units_times_step() {
    for format in [DepthFormat::D16, DepthFormat::D24, DepthFormat::D32F] {
        // A triangle whose depth rises by 1/64 a pixel to the right and 1/128 down.
        let place =
            |x: f32, y: f32| Vertex::new(device(x, y, 0.2 + x / 64.0 * 0.25 + y / 128.0 * 0.25, 1.0, 64.0), [1.0; 4]);
        let list = [place(0.0, 0.0), place(64.0, 0.0), place(0.0, 64.0)];
        let depth_at = |slope: f32, units: f32| {
            let mut target = Target::with_format(64, 64, format, Samples::One).unwrap();
            let depth = Depth { bias_slope: slope, bias_units: units, ..Depth::default() };
            let pipeline = Pipeline::new(64, 64).with_state(State { depth, ..State::default() });
            pipeline.draw(&mut target, &Primitives::triangles(&list), &pass(), &Values);
            f64::from(target.depth(10, 10).unwrap())
        };
        let plain = depth_at(0.0, 0.0);
        let (m, r) = (0.25 / 64.0, f64::from(format.resolution(0.45)));
        for (slope, units) in [(1.0, 0.0), (0.0, 8.0), (-2.0, -16.0), (0.5, 100.0)] {
            let expected = plain + f64::from(slope) * m + f64::from(units) * r;
            let got = depth_at(slope, units);
            assert!((got - expected).abs() <= 1.01 * r + 1e-7, "{format:?} {slope} {units}: {got} {expected}");
        }
    }
    // A decal on walls of several tilts: without offset it fights or loses on some, with it all of it shows on each.
    let m = camera::perspective(1.0, 1.0, 0.5, 50.0);
    let patch = |half: f32, tilt: f32, color: [f32; 4], order: [usize; 3]| {
        let corner = |x: f32, y: f32| {
            Vertex::new(camera::transform(&m, [x * half, y * half, -4.0 + x * half * tilt, 1.0]), color)
        };
        let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.1, 1.0)];
        order.map(|i| corners[i])
    };
    let mut lost = 0;
    for tilt in [0.1, 0.3, 0.5, 0.7, 0.9] {
        let decal = patch(0.8, tilt, [0.0, 0.0, 1.0, 1.0], [1, 2, 0]);
        let show = |slope: f32, units: f32| {
            let mut target = Target::new(64, 64).unwrap();
            let pipeline = Pipeline::new(64, 64);
            let wall = patch(3.0, tilt, [1.0, 0.0, 0.0, 1.0], [0, 1, 2]);
            pipeline.draw(&mut target, &Primitives::triangles(&wall), &pass(), &Values);
            let depth = Depth { bias_slope: slope, bias_units: units, ..Depth::default() };
            let state = State { depth, ..State::default() };
            pipeline.with_state(state).draw(&mut target, &Primitives::triangles(&decal), &pass(), &Values);
            target.to_pixmap().unwrap().data().as_chunks::<4>().0.iter().filter(|pixel| pixel[2] == 255).count()
        };
        let mut alone = Target::new(64, 64).unwrap();
        Pipeline::new(64, 64).draw(&mut alone, &Primitives::triangles(&decal), &pass(), &Values);
        let all = drawn(&alone).len();
        assert_eq!(show(-1.0, -4.0), all, "tilt {tilt}");
        // Pushed the other way it is behind the wall: the offset decides, not the luck of rounding.
        assert_eq!(show(1.0, 4.0), 0, "tilt {tilt}");
        lost += all - show(0.0, 0.0);
    }
    assert!(lost > 100, "{lost}");
}

#[test]
fn s112_approx_equal() {
    assert_ne!(0.1_f64 + 0.2, 0.3);
    assert!(approx_equal(0.1 + 0.2, 0.3, 1e-12));
    assert!(approx_equal(1e20, 1e20 * (1.0 + 1e-13), 1e-12) && !approx_equal(1.0, 1.001, 1e-12));
    assert!(approx_equal(0.0, 0.0, 1e-12) && !approx_equal(0.0, 1e-30, 1e-12) && !approx_equal(f64::NAN, 1.0, 1.0));
}

/// A shader that gives one packed colour to lanes by their column.
struct Columns;

impl FragmentShader for Columns {
    #[inline(always)]
    fn shade<S: Simd>(&self, f: &Fragments<'_, S>) -> Shade<S> {
        let x = f.center_x().to_array();
        Shade::packed(u32x8::from_fn(f.simd(), |i| x[i] as u32 | 0xff00_0000))
    }
}

#[test]
fn s016_lanes_are_columns() {
    let mut target = Target::new(100, 3).unwrap();
    Pipeline::new(100, 3).draw(&mut target, &Primitives::triangles(&quad(0.5, [0.0; 4])), &pass(), &Columns);
    for x in 0..100 {
        assert_eq!(target.pixel(x, 1), Some([x as u8, 0, 0, 255]));
    }
}
