//! The colours along a gradient: from a position to a premultiplied pixel.

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x8, mask32x8, u32x8};

use super::shader::{GradientStop, SpreadMode};
use crate::color::{Color, unit};
use crate::num::lanes::{lesser_f32, max_f32, min_f32, min_i32, truncate_f32};

/// Eight neighbouring pixels of a row, as bytes.
pub(super) type PixelGroup = [u8; 32];

/// A gradient's colours, prepared: one linear piece per interval between stops of different position.
///
/// Coincident stops leave no interval, so that the later one wins at their position and after it.
#[derive(Debug)]
pub(super) struct Ramp {
    repetition: Repetition,
    /// Positions are clamped to this range before they are looked up.
    low: f32,
    high: f32,
    /// Whether every stop is opaque: then colours need no multiplication.
    opaque: bool,
    /// In order; where the last ends is of no consequence.
    pieces: Vec<Piece>,
}

/// How positions outside 0 ..= 1 are folded into it. Pad needs nothing but the clamp, and decal is a pad
/// between transparent pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Repetition {
    None,
    Repeat,
    Reflect,
}

/// Colours over one interval, up to `end`: `color` at `origin`, and what each unit of position adds.
///
/// Where the ramp is opaque, red, green and blue are in 0.5 ..= 255.5, ready to be truncated; else they are
/// straight, in 0 ..= 1, and alpha is in 0 ..= 255.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    end: f32,
    origin: f32,
    color: [f32; 4],
    slope: [f32; 4],
}

/// What a list of stops comes to.
#[derive(Debug)]
pub(super) enum Colors {
    /// No stop.
    None,
    /// The same everywhere.
    Constant([u8; 4]),
    /// Different by position.
    Ramp(Ramp),
}

/// The stops' positions, clamped and in order, with their colours times `opacity`.
fn clean_stops(stops: &[GradientStop], opacity: f32) -> impl Iterator<Item = GradientStop> {
    let mut last = 0.0_f32;
    stops.iter().map(move |stop| {
        // Positions that are all but 0 are 0: a slope between two of them would overflow.
        let position = if stop.position > 1e-20 { unit(stop.position) } else { 0.0 };
        last = if position > last { position } else { last };
        let Color { r, g, b, .. } = stop.color;
        let color = Color::from_rgba(unit(r), unit(g), unit(b), stop.color.with_opacity(opacity).a);
        GradientStop::new(last, color)
    })
}

/// The colour that a gradient of no length has: that of its last stop.
pub(super) fn last_color(stops: &[GradientStop], opacity: f32) -> Option<[u8; 4]> {
    clean_stops(stops, opacity).last().map(|stop| stop.color.premultiply())
}

impl Colors {
    /// The colours of `stops`, times `opacity`. One stop paints everywhere (SVG 2, 14.2.4); several of the
    /// same colour leave a geometry's holes open.
    pub(super) fn new(stops: &[GradientStop], spread: SpreadMode, opacity: f32, holes: bool) -> Self {
        // Most gradients have few: these need no memory of their own.
        let mut few = [GradientStop::new(0.0, Color::TRANSPARENT); 8];
        let mut many = Vec::new();
        let stops = match few.get_mut(..stops.len()) {
            Some(few) => {
                few.iter_mut().zip(clean_stops(stops, opacity)).for_each(|(few, stop)| *few = stop);
                &*few
            }
            None => {
                many.extend(clean_stops(stops, opacity));
                &*many
            }
        };
        let (Some(first), Some(last)) = (stops.first(), stops.last()) else { return Self::None };
        let same = stops.iter().all(|stop| stop.color == first.color);
        let invisible = stops.iter().all(|stop| stop.color.a == 0.0);
        let bounded = holes || spread == SpreadMode::Decal;
        if invisible || stops.len() == 1 || (same && !bounded) {
            return Self::Constant(first.color.premultiply());
        }
        Self::Ramp(Ramp::new(stops, *first, *last, spread))
    }
}

impl Ramp {
    fn new(stops: &[GradientStop], first: GradientStop, last: GradientStop, spread: SpreadMode) -> Self {
        let opaque = spread != SpreadMode::Decal && stops.iter().all(|stop| stop.color.a == 1.0);
        let decal = spread == SpreadMode::Decal;
        let mut pieces = Vec::with_capacity(stops.len() + if decal { 3 } else { 1 });
        let mut start = f32::NEG_INFINITY;
        // Intervals of no length go.
        let mut add = |piece: Piece| {
            if piece.end > start {
                start = piece.end;
                pieces.push(piece);
            }
        };
        let constant =
            |end: f32, color: Color| Piece { end, origin: 0.0, color: scaled(color, opaque), slope: [0.0; 4] };
        if decal {
            add(constant(0.0, Color::TRANSPARENT));
        }
        add(constant(first.position, first.color));
        for (from, to) in stops.iter().zip(stops.iter().skip(1)) {
            let (from_color, to_color) = (scaled(from.color, opaque), scaled(to.color, opaque));
            let length = f64::from(to.position) - f64::from(from.position);
            let slope = |k: usize| ((f64::from(to_color[k]) - f64::from(from_color[k])) / length) as f32;
            let slope = [slope(0), slope(1), slope(2), slope(3)];
            add(Piece { end: to.position, origin: from.position, color: from_color, slope });
        }
        if decal {
            add(constant(1.0_f32.next_up(), last.color));
        }
        add(constant(f32::INFINITY, if decal { Color::TRANSPARENT } else { last.color }));

        // So do flat ends that the clamp stands for, where no step precedes them.
        let (mut low, mut high) = (-1.0, 2.0);
        if !decal && pieces.len() > 2 {
            if pieces.get(1).is_some_and(|piece| piece.color == scaled(first.color, opaque)) {
                low = pieces.remove(0).end;
            }
            let final_stop = stops.iter().rev().find(|stop| stop.position < last.position);
            // The last sloping piece ends in the colour of the first stop at the last position.
            let arrives = stops.iter().find(|stop| stop.position == last.position);
            if final_stop.is_some() && arrives.is_some_and(|stop| stop.color == last.color) && pieces.len() > 1 {
                pieces.pop();
                high = last.position;
            }
        }
        let repetition = match spread {
            SpreadMode::Repeat => Repetition::Repeat,
            SpreadMode::Reflect => Repetition::Reflect,
            SpreadMode::Pad | SpreadMode::Decal => Repetition::None,
        };
        Self { repetition, low, high, opaque, pieces }
    }

    /// Whether every pixel it gives is opaque.
    pub(super) fn is_opaque(&self) -> bool {
        self.opaque
    }

    /// The premultiplied pixels at `positions`, eight to a group. NaN counts as far below 0.
    #[inline(always)]
    pub(super) fn shade<S: Simd>(&self, simd: S, positions: &mut [[f32; 8]], out: &mut [PixelGroup]) {
        match self.repetition {
            Repetition::None => {}
            Repetition::Repeat => repeat(simd, positions),
            Repetition::Reflect => reflect(simd, positions),
        }
        if self.opaque {
            self.shade_with::<S, true>(simd, positions, out);
        } else {
            self.shade_with::<S, false>(simd, positions, out);
        }
    }

    #[inline(always)]
    fn shade_with<S: Simd, const OPAQUE: bool>(&self, simd: S, positions: &[[f32; 8]], out: &mut [PixelGroup]) {
        match self.pieces.as_slice() {
            [first] => self.shade_few::<S, OPAQUE, 0>(simd, first, [], positions, out),
            [first, second] => self.shade_few::<S, OPAQUE, 1>(simd, first, [(first.end, second)], positions, out),
            [first, second, third] => {
                let others = [(first.end, second), (second.end, third)];
                self.shade_few::<S, OPAQUE, 2>(simd, first, others, positions, out);
            }
            _ => self.shade_many::<S, OPAQUE>(simd, positions, out),
        }
    }

    /// Of few pieces each lane chooses its own: `others` with where they begin.
    #[inline(always)]
    fn shade_few<S: Simd, const OPAQUE: bool, const OTHERS: usize>(
        &self,
        simd: S,
        first: &Piece,
        others: [(f32, &Piece); OTHERS],
        positions: &[[f32; 8]],
        out: &mut [PixelGroup],
    ) {
        let (low, high) = (f32x8::splat(simd, self.low), f32x8::splat(simd, self.high));
        let first = PieceLanes::splat(simd, first);
        let mut later = [(high, first); OTHERS];
        for (later, (start, piece)) in later.iter_mut().zip(others) {
            *later = (f32x8::splat(simd, start), PieceLanes::splat(simd, piece));
        }
        for (position, out) in positions.iter().zip(out) {
            let t = lesser_f32(max_f32(f32x8::simd_from(simd, *position), low), high);
            let mut piece = first;
            for (start, other) in &later {
                piece = piece.or::<OPAQUE>(t.simd_ge(*start), other);
            }
            *out = piece.pixels::<OPAQUE>(simd, t).to_bytes().to_array();
        }
    }

    #[inline(always)]
    fn shade_many<S: Simd, const OPAQUE: bool>(&self, simd: S, positions: &[[f32; 8]], out: &mut [PixelGroup]) {
        let (low, high) = (f32x8::splat(simd, self.low), f32x8::splat(simd, self.high));
        // The piece in hand: neighbours mostly share one, and so do groups.
        let (mut start, mut end) = (f32::INFINITY, f32::INFINITY);
        let mut piece = PieceLanes::splat(simd, &self.piece(0));
        for (position, out) in positions.iter().zip(out) {
            let t = min_f32(max_f32(f32x8::simd_from(simd, *position), low), high);
            let lanes = t.to_array();
            let mut pixels = u32x8::splat(simd, 0);
            let mut open = 255_u64;
            // Each round gives the pixels of all lanes in the piece of the first lane that has none yet.
            while open != 0 {
                let lane = open.trailing_zeros() as usize & 7;
                if !(lanes[lane] >= start && lanes[lane] < end) {
                    let index = self.find(lanes[lane]);
                    let before = index.checked_sub(1).and_then(|k| self.pieces.get(k));
                    start = before.map_or(self.low, |piece| piece.end);
                    end = self.ends().get(index).map_or(f32::INFINITY, |piece| piece.end);
                    piece = PieceLanes::splat(simd, &self.piece(index));
                }
                let inside = t.simd_ge(start) & t.simd_lt(end);
                // Lanes of other pieces are clamped into this one, where its colours are within bounds.
                let clamped = min_f32(max_f32(t, f32x8::splat(simd, start)), f32x8::splat(simd, end));
                pixels = inside.select(piece.pixels::<OPAQUE>(simd, clamped), pixels);
                open &= !(inside.to_bitmask() | 1 << lane);
            }
            *out = pixels.to_bytes().to_array();
        }
    }

    /// The pieces whose end counts: all but the last.
    #[inline(always)]
    fn ends(&self) -> &[Piece] {
        self.pieces.split_last().map_or(&[], |(_, others)| others)
    }

    /// The index of the piece that holds position `t`: the number of ends at or before it.
    #[inline(always)]
    fn find(&self, t: f32) -> usize {
        let ends = self.ends();
        if ends.len() <= 8 {
            ends.iter().map(|piece| usize::from(t >= piece.end)).sum()
        } else {
            ends.partition_point(|piece| t >= piece.end)
        }
    }

    #[inline(always)]
    fn piece(&self, index: usize) -> Piece {
        self.pieces.get(index).copied().unwrap_or(Piece { end: 0.0, origin: 0.0, color: [0.0; 4], slope: [0.0; 4] })
    }
}

/// The colour in a [`Piece`]'s units.
fn scaled(color: Color, opaque: bool) -> [f32; 4] {
    if opaque {
        [color.r * 255.0 + 0.5, color.g * 255.0 + 0.5, color.b * 255.0 + 0.5, 255.5]
    } else {
        [color.r, color.g, color.b, color.a * 255.0]
    }
}

/// A piece's coefficients in vectors.
#[derive(Clone, Copy)]
struct PieceLanes<S: Simd> {
    origin: f32x8<S>,
    color: [f32x8<S>; 4],
    slope: [f32x8<S>; 4],
}

impl<S: Simd> PieceLanes<S> {
    #[inline(always)]
    fn splat(simd: S, piece: &Piece) -> Self {
        let lanes = |v: [f32; 4]| {
            [f32x8::splat(simd, v[0]), f32x8::splat(simd, v[1]), f32x8::splat(simd, v[2]), f32x8::splat(simd, v[3])]
        };
        Self { origin: f32x8::splat(simd, piece.origin), color: lanes(piece.color), slope: lanes(piece.slope) }
    }

    /// `other` in the lanes that `chosen` names.
    #[inline(always)]
    fn or<const OPAQUE: bool>(&self, chosen: mask32x8<S>, other: &Self) -> Self {
        let pick = |a: f32x8<S>, b: f32x8<S>| chosen.select(b, a);
        let mut piece = Self { origin: pick(self.origin, other.origin), ..*self };
        // Alpha is the same in all opaque pieces.
        for component in 0..if OPAQUE { 3 } else { 4 } {
            piece.color[component] = pick(self.color[component], other.color[component]);
            piece.slope[component] = pick(self.slope[component], other.slope[component]);
        }
        piece
    }

    /// The pixels at the clamped positions `t`.
    #[inline(always)]
    fn pixels<const OPAQUE: bool>(&self, simd: S, t: f32x8<S>) -> u32x8<S> {
        let offset = t - self.origin;
        let r = self.color[0] + self.slope[0] * offset;
        let g = self.color[1] + self.slope[1] * offset;
        let b = self.color[2] + self.slope[2] * offset;
        if OPAQUE {
            // Between 0.5 and 255.5 but for the last bit: truncation cannot leave 0 ..= 255.
            let (r, g, b) = (truncate_f32(r), truncate_f32(g), truncate_f32(b));
            let rgb = r | (g << 8) | (b << 16) | i32x8::splat(simd, 255 << 24);
            return rgb.bitcast();
        }
        let a = self.color[3] + self.slope[3] * offset;
        let alpha = truncate_f32(a + 0.5);
        // The last bit of an interpolated 1 must not lift a colour above its alpha.
        let r = min_i32(truncate_f32(r * a + 0.5), alpha);
        let g = min_i32(truncate_f32(g * a + 0.5), alpha);
        let b = min_i32(truncate_f32(b * a + 0.5), alpha);
        (r | (g << 8) | (b << 16) | (alpha << 24)).bitcast()
    }
}

/// Positions past this have no fraction worth having; the clamp also catches NaN and infinities.
const FAR: f32 = 4_194_304.0;

#[inline(always)]
fn repeat<S: Simd>(simd: S, positions: &mut [[f32; 8]]) {
    for position in positions {
        let t = f32x8::simd_from(simd, *position);
        let t = min_f32(max_f32(t, f32x8::splat(simd, -FAR)), f32x8::splat(simd, FAR));
        *position = (t - t.floor()).to_array();
    }
}

#[inline(always)]
fn reflect<S: Simd>(simd: S, positions: &mut [[f32; 8]]) {
    for position in positions {
        let t = f32x8::simd_from(simd, *position);
        let t = min_f32(max_f32(t, f32x8::splat(simd, -FAR)), f32x8::splat(simd, FAR));
        let u = t - (t * 0.5).floor() * 2.0;
        *position = u.simd_gt(1.0).select(f32x8::splat(simd, 2.0) - u, u).to_array();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    #[test]
    fn lanes_that_choose_among_few_pieces_find_what_the_search_finds() {
        let mut seed = 3_u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) as f32 / (1 << 24) as f32
        };
        let mut counts = [0; 4];
        for case in 0..300 {
            let opaque = case % 2 == 0;
            // Coincident ones, too: then the colour jumps.
            let mut position = 0.0;
            let stops: Vec<GradientStop> = (0..2 + case % 4)
                .map(|_| {
                    position = if random() < 0.3 { position } else { position + random() * 0.5 };
                    let alpha = if opaque { 1.0 } else { random() };
                    GradientStop::new(position, Color::from_rgba(random(), random(), random(), alpha))
                })
                .collect();
            let spread = [SpreadMode::Pad, SpreadMode::Repeat, SpreadMode::Reflect, SpreadMode::Decal][case / 4 % 4];
            let Colors::Ramp(ramp) = Colors::new(&stops, spread, 1.0, false) else { continue };
            counts[ramp.pieces.len().min(4) - 1] += 1;
            let mut positions = [[0.0; 8]; 6];
            positions.as_flattened_mut().fill_with(|| random() * 1.5 - 0.25);
            positions[0] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.0, 0.0, 1.0, 1e30, -1e30];
            for (lane, stop) in positions[1].iter_mut().zip(&stops) {
                *lane = stop.position;
            }
            for level in SimdLevel::available() {
                let (mut few, mut many) = ([[0; 32]; 6], [[0; 32]; 6]);
                dispatch!(level, simd => if ramp.opaque {
                    ramp.shade_with::<_, true>(simd, &positions, &mut few);
                    ramp.shade_many::<_, true>(simd, &positions, &mut many);
                } else {
                    ramp.shade_with::<_, false>(simd, &positions, &mut few);
                    ramp.shade_many::<_, false>(simd, &positions, &mut many);
                });
                assert_eq!(few, many, "{stops:?} {spread:?} at {level:?}");
            }
        }
        assert!(counts.iter().all(|count| *count > 10), "{counts:?}");
    }
}
