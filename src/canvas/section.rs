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
}

impl Default for Sections {
    fn default() -> Self {
        Self { before: (0, 0), next: FEWEST }
    }
}

impl Sections {
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
        let before = self.sections.before;
        let own = (self.list.commands.len(), self.list.points.len());
        if !self.layers.is_empty() || self.is_clipped() || self.list.has_effects() || !self.settings.is_parallel() {
            self.sections.next = (own.0 + FEWEST.0, own.1 + FEWEST.1);
            return;
        }
        let before = (before.0 + own.0, before.1 + own.1);
        let list = std::mem::take(&mut self.list);
        self.list = self.renderer.take_section(list, self.frame(), self.settings);
        let next = (FEWEST.0.max(before.0 / SHARE), FEWEST.1.max(before.1 / SHARE));
        self.sections = Sections { before, next };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blend::BlendMode;
    use crate::color::Color;
    use crate::geom::{IntRect, Rect};
    use crate::path::Path;
    use crate::render::RenderSettings;
    use crate::style::{Antialias, FillRule};

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
}
