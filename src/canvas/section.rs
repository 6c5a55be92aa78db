//! Recording is done by one thread; the others prepare what it has recorded so far.

use super::Canvas;

/// So many commands, or points of their outlines, are worth the waking of a thread: it takes 30 to 100 µs to record them.
const FEWEST: (usize, usize) = (1024, 16_384);
/// Later sections are at least this part of all before them: a million commands make some fifty, each of which has a list for each
/// band.
const SHARE: usize = 8;

/// When a section of the recording ends.
#[derive(Debug)]
pub(super) struct Sections {
    /// Commands and points in sections that have ended.
    before: (usize, usize),
    /// Once as many of either are recorded since, the next may end.
    next: (usize, usize),
    /// What a section has at least: tests have more of them.
    fewest: (usize, usize),
}

impl Default for Sections {
    fn default() -> Self {
        Self::of_at_least(FEWEST)
    }
}

impl Sections {
    fn of_at_least(fewest: (usize, usize)) -> Self {
        Self { before: (0, 0), next: fewest, fewest }
    }

    /// Begins a frame.
    pub(super) fn restart(&mut self) {
        *self = Self::of_at_least(self.fewest);
    }

    /// Whether a section may end that has `commands`, and outlines of `points`.
    #[inline(always)]
    pub(super) fn is_next(&self, commands: usize, points: usize) -> bool {
        commands >= self.next.0 || points >= self.next.1
    }
}

impl Canvas<'_> {
    /// Hands what was recorded so far to other threads, if there are any and nothing that follows can refer to it.
    #[cold]
    #[inline(never)]
    pub(super) fn end_section(&mut self) {
        let Sections { before, fewest, .. } = self.sections;
        let own = (self.list.commands.len(), self.list.points.len());
        if !self.layers.is_empty() || self.is_clipped() || self.list.has_effects() || !self.settings.is_parallel() {
            self.sections.next = (own.0 + fewest.0, own.1 + fewest.1);
            return;
        }
        let before = (before.0 + own.0, before.1 + own.1);
        let list = std::mem::take(&mut self.list);
        self.list = self.renderer.take_section(list, self.frame(), self.settings);
        let next = (fewest.0.max(before.0 / SHARE), fewest.1.max(before.1 / SHARE));
        self.sections = Sections { before, next, fewest };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    use crate::blend::BlendMode;
    use crate::canvas::{LayerOptions, Shadow};
    use crate::color::Color;
    use crate::filter::{Filter, Input, Kind};
    use crate::geom::{IntRect, Rect};
    use crate::paint::{GradientStop, LinearGradient};
    use crate::path::{Path, Stroke};
    use crate::render::RenderSettings;
    use crate::style::{Antialias, FillRule};
    use crate::surface::{Mask, MaskKind};

    fn canvas(threads: usize) -> Canvas<'static> {
        Canvas::with_settings(64, 64, RenderSettings::default().with_threads(threads)).unwrap()
    }

    fn draw(canvas: &mut Canvas<'_>, commands: usize) {
        for index in 0..commands {
            canvas.fill_rect(Rect::from_xywh((index % 60) as f32, (index % 50) as f32, 3.0, 2.5), Color::RED);
        }
    }

    #[cfg(feature = "parallel")]
    #[test]
    fn sections_end_where_nothing_refers_to_them() {
        let mut canvas = canvas(2);
        draw(&mut canvas, FEWEST.0 - 1);
        assert_eq!((canvas.renderer.section_count(), canvas.list.commands.len()), (0, FEWEST.0 - 1));
        draw(&mut canvas, FEWEST.0 + 1);
        assert_eq!((canvas.renderer.section_count(), canvas.list.commands.len()), (2, 0));
        canvas.push_layer(0.5, BlendMode::SourceOver);
        draw(&mut canvas, 2 * FEWEST.0);
        assert_eq!(canvas.renderer.section_count(), 2);
        canvas.pop_layer();
        // What had to wait goes with what comes next.
        draw(&mut canvas, FEWEST.0);
        assert_eq!(canvas.renderer.section_count(), 3);
        let mut round = Path::new();
        round.circle((30.0, 30.0), 20.0);
        canvas.save();
        canvas.clip_path(&round, FillRule::NonZero, Antialias::Analytic);
        draw(&mut canvas, FEWEST.0);
        canvas.save();
        canvas.clip_rect(Rect::from_xywh(0.0, 0.0, 9.0, 9.0), Antialias::Analytic);
        draw(&mut canvas, FEWEST.0);
        assert_eq!(canvas.renderer.section_count(), 3);
        canvas.restore();
        canvas.restore();
        draw(&mut canvas, FEWEST.0);
        assert_eq!(canvas.renderer.section_count(), 4);
        canvas.flush().unwrap();
        assert_eq!((canvas.renderer.section_count(), canvas.list.commands.len()), (0, 0));
    }

    #[test]
    fn one_thread_records_in_one_go() {
        let mut canvas = canvas(1);
        draw(&mut canvas, 5 * FEWEST.0);
        assert_eq!((canvas.renderer.section_count(), canvas.list.commands.len()), (0, 5 * FEWEST.0));
    }

    #[cfg(feature = "parallel")]
    #[test]
    fn sections_grow() {
        let mut canvas = canvas(2);
        draw(&mut canvas, 1_000_000);
        let count = canvas.renderer.section_count();
        assert!((40..60).contains(&count), "{count}");
    }

    #[test]
    fn what_is_read_from_under_an_open_layer_shows_the_sections() {
        let picture = |threads: usize| {
            let mut canvas = canvas(threads);
            draw(&mut canvas, 3 * FEWEST.0);
            canvas.push_layer(0.5, BlendMode::Multiply);
            canvas.fill_rect(Rect::from_xywh(10.5, 10.5, 30.0, 30.0), Color::BLUE);
            let all = IntRect::from_xywh(0, 0, 64, 64);
            let (first, second) = (canvas.read_pixels(all).unwrap(), canvas.read_pixels(all).unwrap());
            assert!(first.data() == second.data());
            canvas.pop_layer();
            let last = canvas.into_pixmap();
            assert!(first.data() == last.data());
            last.into_vec()
        };
        assert!(picture(2) == picture(1));
    }

    #[test]
    fn another_band_height_after_a_section_shows_nowhere() {
        let picture = |threads: usize, heights: [u32; 2]| {
            let mut canvas = canvas(threads);
            for height in heights {
                canvas.set_settings(canvas.settings().with_band_height(height));
                draw(&mut canvas, FEWEST.0 + 10);
            }
            canvas.into_pixmap().into_vec()
        };
        let expected = picture(1, [32, 32]);
        for heights in [[32, 8], [8, 64], [64, 64]] {
            assert!(picture(2, heights) == expected, "{heights:?}");
        }
    }

    /// What has been begun and must end.
    #[derive(Clone, Copy)]
    enum Open {
        Save,
        Layer,
        Mask,
    }

    /// Calls of all kinds in an order that `seed` gives: the pictures that were read on the way and at the end, and how many
    /// sections there were.
    fn any_calls(canvas: &mut Canvas<'_>, mut seed: u32) -> (Vec<Vec<u8>>, usize) {
        let mut random = |limit: u32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) % limit
        };
        let all = IntRect::from_xywh(0, 0, 64, 64);
        let stops = [GradientStop::new(0.0, Color::RED), GradientStop::new(1.0, Color::from_rgba(0.0, 0.4, 1.0, 0.3))];
        let mut cover = Mask::new(40, 40).unwrap();
        cover.data_mut().iter_mut().enumerate().for_each(|(index, value)| *value = (index % 251) as u8);
        let cover = Arc::new(cover);
        let mut blur = Filter::new();
        blur.add(Kind::GaussianBlur { input: Input::SourceGraphic, deviation_x: 2.0, deviation_y: 1.0 });
        let blur = Arc::new(blur);
        let (mut open, mut seen) = (Vec::new(), Vec::new());
        let mut sections = 0;
        canvas.clear(Color::WHITE);
        for _ in 0..120 {
            let before = canvas.renderer.section_count();
            let (x, y, size) = (random(60) as f32 - 4.0, random(60) as f32 - 4.0, 2.0 + random(200) as f32 / 8.0);
            let color =
                Color::from_rgba8(random(256) as u8, random(256) as u8, random(256) as u8, 90 + random(166) as u8);
            let rect = Rect::from_xywh(x, y, size, size / 2.0);
            let mut heart = Path::new();
            heart.move_to((x, y)).cubic_to((x + size, y), (x, y + size), (x + size, y + size)).close();
            match random(26) {
                0..4 => canvas.fill_rect(rect, color),
                4..6 => canvas.fill_circle((x, y), size / 2.0, color),
                6..8 => canvas.fill_path(&heart, FillRule::EvenOdd, LinearGradient::new((x, y), (x + size, y), stops)),
                8..10 => canvas.stroke_path(&heart, &Stroke::new(1.0 + size / 9.0), color),
                10 => canvas.draw_pixel_circle((x as i32, y as i32), size as u32, color),
                11 => canvas.fill_round_rect(rect, size / 5.0, color),
                12 => {
                    open.push(Open::Save);
                    canvas.save();
                    canvas.rotate(size);
                    canvas.translate(size / 7.0, 1.0);
                }
                13 => {
                    open.push(Open::Save);
                    canvas.save();
                    match random(3) {
                        0 => canvas.clip_path(&heart, FillRule::NonZero, Antialias::Analytic),
                        1 => canvas.clip_rect(rect.outset(9.0), Antialias::Analytic),
                        _ => canvas.clip_mask(Arc::clone(&cover), x as i32, y as i32),
                    }
                }
                14 if open.len() < 4 => {
                    open.push(Open::Layer);
                    canvas.push_layer(0.8, [BlendMode::SourceOver, BlendMode::Multiply][random(2) as usize]);
                }
                15 if open.len() < 4 => {
                    open.push(Open::Layer);
                    canvas.push_layer_with(&LayerOptions::default().with_filter(Arc::clone(&blur)));
                }
                16 if matches!(open.last(), Some(Open::Layer)) => {
                    open.push(Open::Mask);
                    canvas.push_mask(MaskKind::Luminance);
                }
                17..22 => match open.pop() {
                    Some(Open::Save) => canvas.restore(),
                    Some(Open::Layer) => canvas.pop_layer(),
                    Some(Open::Mask) => canvas.pop_mask(),
                    None => {}
                },
                22 => canvas.set_shadow(Shadow { offset_x: 3.0, offset_y: 2.0, deviation: 1.5, color }),
                23 => canvas.set_shadow(None),
                24 => seen.push(canvas.read_pixels(all).unwrap().into_vec()),
                25 => canvas.set_settings(canvas.settings().with_band_height([8, 16, 32][random(3) as usize])),
                _ if open.is_empty() => canvas.flush().unwrap(),
                _ => {}
            }
            sections += canvas.renderer.section_count().saturating_sub(before);
        }
        canvas.finish();
        seen.push(canvas.read_pixels(all).unwrap().into_vec());
        (seen, sections)
    }

    #[test]
    fn whatever_is_called_the_shortest_sections_show_nowhere() {
        let mut all = 0;
        for seed in 0..200 {
            let (expected, _) = any_calls(&mut canvas(1), seed);
            let mut canvas = canvas(2);
            canvas.sections = Sections::of_at_least((1, 1));
            let (drawn, sections) = any_calls(&mut canvas, seed);
            assert!(drawn == expected, "seed {seed}");
            all += sections;
        }
        assert!(all > 1000 || !cfg!(feature = "parallel"), "{all} sections");
    }
}
