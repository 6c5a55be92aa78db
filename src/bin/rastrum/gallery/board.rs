//! What pictures are drawn on: a canvas with panels, zoomed grids, labels and curves.

use std::sync::Arc;

use rastrum::{
    Antialias, Canvas, Color, FillRule, FilterQuality, ImagePaint, LineCap, LineJoin, Paint, Path, Pixmap, Point, Rect,
    RenderSettings, Result, Stroke,
};

use super::font;

pub(crate) const WIDTH: u32 = 640;
pub(crate) const HEIGHT: u32 = 400;

const fn rgb(r: u8, g: u8, b: u8) -> Color {
    Color::from_rgba(r as f32 / 255.0, g as f32 / 255.0, b as f32 / 255.0, 1.0)
}

pub(crate) const PAPER: Color = rgb(251, 251, 248);
pub(crate) const INK: Color = rgb(34, 38, 48);
pub(crate) const GREY: Color = rgb(120, 126, 138);
pub(crate) const FAINT: Color = rgb(207, 211, 218);
pub(crate) const PALE: Color = rgb(234, 237, 241);
pub(crate) const RED: Color = rgb(208, 62, 56);
pub(crate) const BLUE: Color = rgb(44, 106, 190);
pub(crate) const SKY: Color = rgb(158, 197, 240);
pub(crate) const GREEN: Color = rgb(40, 140, 86);
pub(crate) const MINT: Color = rgb(165, 216, 184);
pub(crate) const AMBER: Color = rgb(228, 160, 40);
pub(crate) const ROSE: Color = rgb(243, 178, 172);
pub(crate) const VIOLET: Color = rgb(128, 84, 180);

/// A colour between two.
pub(crate) fn mix(a: Color, b: Color, t: f32) -> Color {
    let mix = |a: f32, b: f32| a + (b - a) * t;
    Color::from_rgba(mix(a.r, b.r), mix(a.g, b.g), mix(a.b, b.b), mix(a.a, b.a))
}

/// A grey from 0 (black) to 1.
pub(crate) fn grey(value: f32) -> Color {
    let value = value.clamp(0.0, 1.0);
    Color::from_rgba(value, value, value, 1.0)
}

/// A zoomed grid of pixels on the board.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub(crate) left: f32,
    pub(crate) top: f32,
    pub(crate) cell: f32,
    pub(crate) columns: u32,
    pub(crate) rows: u32,
}

impl Grid {
    /// Where a place in the grid's pixels lies on the board.
    pub(crate) fn map(&self, x: f32, y: f32) -> Point {
        Point::new(self.left + x * self.cell, self.top + y * self.cell)
    }

    pub(crate) fn rect(&self) -> Rect {
        Rect::from_xywh(self.left, self.top, self.cell * self.columns as f32, self.cell * self.rows as f32)
    }

    fn holds(&self, (x, y): (i32, i32)) -> bool {
        x >= 0 && y >= 0 && x < self.columns as i32 && y < self.rows as i32
    }
}

pub(crate) struct Board {
    pub(crate) canvas: Canvas<'static>,
}

impl Board {
    pub(crate) fn new() -> Result<Self> {
        // Pictures are drawn side by side, one on each thread.
        let settings = RenderSettings::default().with_threads(1);
        let mut canvas = Canvas::with_settings(WIDTH, HEIGHT, settings)?;
        canvas.clear(PAPER);
        Ok(Self { canvas })
    }

    /// A label of capitals, its upper left corner at (x, y).
    pub(crate) fn label(&mut self, x: f32, y: f32, height: f32, text: &str, color: Color) {
        let stroke = Stroke::new((height * 0.15).max(1.1)).with_cap(LineCap::Round).with_join(LineJoin::Round);
        self.canvas.stroke_path(&font::outline(text, x, y, height), &stroke, color);
    }

    /// A label around a middle.
    pub(crate) fn middle(&mut self, at: Point, height: f32, text: &str, color: Color) {
        self.label(at.x - font::width(text, height) / 2.0, at.y - height / 2.0, height, text, color);
    }

    /// A label at the usual height.
    pub(crate) fn text(&mut self, x: f32, y: f32, text: &str) {
        self.label(x, y, 12.0, text, INK);
    }

    /// Panels side by side under their titles.
    pub(crate) fn panels<const N: usize>(&mut self, titles: [&str; N]) -> [Rect; N] {
        let width = (WIDTH as f32 - 16.0) / N as f32;
        let mut rects = [Rect::from_xywh(0.0, 0.0, 0.0, 0.0); N];
        for (i, (rect, title)) in rects.iter_mut().zip(titles).enumerate() {
            let left = 8.0 + i as f32 * width;
            // A title that would not fit is set smaller.
            let height = (12.0 * (width - 16.0) / font::width(title, 12.0).max(1.0)).clamp(7.0, 12.0);
            self.middle(Point::new(left + width / 2.0, 22.0), height, title, INK);
            *rect = Rect::from_xywh(left + 8.0, 42.0, width - 16.0, HEIGHT as f32 - 58.0);
        }
        rects
    }

    /// Panels in rows and columns under their titles, row by row.
    pub(crate) fn tiles(&mut self, columns: usize, titles: &[&str]) -> Vec<Rect> {
        let rows = titles.len().div_ceil(columns);
        let (width, height) = ((WIDTH as f32 - 16.0) / columns as f32, (HEIGHT as f32 - 12.0) / rows as f32);
        let mut rects = Vec::new();
        for (i, title) in titles.iter().enumerate() {
            let (left, top) = (8.0 + (i % columns) as f32 * width, 6.0 + (i / columns) as f32 * height);
            let size = (11.0 * (width - 12.0) / font::width(title, 11.0).max(1.0)).clamp(6.0, 11.0);
            self.middle(Point::new(left + width / 2.0, top + 12.0), size, title, INK);
            rects.push(Rect::from_xywh(left + 6.0, top + 24.0, width - 12.0, height - 30.0));
        }
        rects
    }

    /// All of the board but for a border.
    pub(crate) fn whole(&self) -> Rect {
        Rect::from_xywh(16.0, 16.0, WIDTH as f32 - 32.0, HEIGHT as f32 - 32.0)
    }

    /// A grid of square cells, as large as fits, in the middle of a rectangle.
    pub(crate) fn grid(&mut self, rect: Rect, columns: u32, rows: u32) -> Grid {
        let cell = (rect.width() / columns as f32).min(rect.height() / rows as f32).floor().max(1.0);
        let left = (rect.left + (rect.width() - cell * columns as f32) / 2.0).floor();
        let top = (rect.top + (rect.height() - cell * rows as f32) / 2.0).floor();
        let grid = Grid { left, top, cell, columns, rows };
        self.canvas.fill_rect(grid.rect(), Color::WHITE);
        grid
    }

    pub(crate) fn cell(&mut self, grid: &Grid, at: (i32, i32), color: Color) {
        if grid.holds(at) {
            let p = grid.map(at.0 as f32, at.1 as f32);
            self.canvas.fill_rect(Rect::from_xywh(p.x, p.y, grid.cell, grid.cell), color);
        }
    }

    pub(crate) fn cells(&mut self, grid: &Grid, pixels: impl IntoIterator<Item = (i32, i32)>, color: Color) {
        for pixel in pixels {
            self.cell(grid, pixel, color);
        }
    }

    /// The lines between the cells.
    pub(crate) fn lines(&mut self, grid: &Grid) {
        let rect = grid.rect();
        let line = |canvas: &mut Canvas<'_>, rect: Rect| canvas.fill_rect(rect, FAINT);
        for x in 0..=grid.columns {
            line(
                &mut self.canvas,
                Rect::from_xywh(rect.left + x as f32 * grid.cell, rect.top, 1.0, rect.height() + 1.0),
            );
        }
        for y in 0..=grid.rows {
            line(&mut self.canvas, Rect::from_xywh(rect.left, rect.top + y as f32 * grid.cell, rect.width(), 1.0));
        }
    }

    /// A grid with its lines and some cells.
    pub(crate) fn pixels(
        &mut self,
        rect: Rect,
        (columns, rows): (u32, u32),
        pixels: impl IntoIterator<Item = (i32, i32)>,
        color: Color,
    ) -> Grid {
        let grid = self.grid(rect, columns, rows);
        self.cells(&grid, pixels, color);
        self.lines(&grid);
        grid
    }

    /// A short text in a cell.
    pub(crate) fn mark(&mut self, grid: &Grid, (x, y): (i32, i32), text: &str, color: Color) {
        let room = grid.cell * 0.82;
        let height = (room * 0.62).min(room / (text.chars().count() as f32 - 0.33).max(0.67)).min(13.0);
        self.middle(grid.map(x as f32 + 0.5, y as f32 + 0.5), height, text, color);
    }

    /// Numbers from 1 in cells, in their order.
    pub(crate) fn order(&mut self, grid: &Grid, pixels: &[(i32, i32)], color: Color) {
        for (i, pixel) in pixels.iter().enumerate() {
            if grid.holds(*pixel) {
                self.mark(grid, *pixel, &(i + 1).to_string(), color);
            }
        }
    }

    /// A dot at a place in the grid's pixels.
    pub(crate) fn dot(&mut self, grid: &Grid, x: f32, y: f32, radius: f32, color: Color) {
        self.canvas.fill_circle(grid.map(x, y), radius, color);
    }

    /// Dots at the cells' centres.
    pub(crate) fn centers(&mut self, grid: &Grid) {
        for y in 0..grid.rows {
            for x in 0..grid.columns {
                self.dot(grid, x as f32 + 0.5, y as f32 + 0.5, 1.6, GREY);
            }
        }
    }

    pub(crate) fn segment(&mut self, from: Point, to: Point, width: f32, color: Color) {
        let mut path = Path::new();
        path.move_to(from).line_to(to);
        self.canvas.stroke_path(&path, &Stroke::new(width).with_cap(LineCap::Round), color);
    }

    /// A segment with a head at its end.
    pub(crate) fn arrow(&mut self, from: Point, to: Point, color: Color) {
        self.segment(from, to, 2.0, color);
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let length = (dx * dx + dy * dy).sqrt().max(1e-3);
        let (dx, dy) = (dx / length * 8.0, dy / length * 8.0);
        let head = [
            to,
            Point::new(to.x - dx - dy * 0.5, to.y - dy + dx * 0.5),
            Point::new(to.x - dx + dy * 0.5, to.y - dy - dx * 0.5),
        ];
        self.canvas.fill_polygon(&head, FillRule::NonZero, color);
    }

    /// An outline in the grid's pixels.
    pub(crate) fn outline(&mut self, grid: &Grid, points: &[(f32, f32)], width: f32, color: Color) {
        let points: Vec<Point> = points.iter().map(|(x, y)| grid.map(*x, *y)).collect();
        self.canvas.stroke_polygon(&points, &Stroke::new(width).with_join(LineJoin::Round), color);
    }

    /// A polyline on the board.
    pub(crate) fn polyline(&mut self, points: &[Point], width: f32, color: Color) {
        self.canvas.draw_polyline(
            points,
            &Stroke::new(width).with_join(LineJoin::Round).with_cap(LineCap::Round),
            color,
        );
    }

    pub(crate) fn frame(&mut self, rect: Rect, color: Color) {
        self.canvas.stroke_rect(rect, &Stroke::new(1.0), color);
    }

    pub(crate) fn bar(&mut self, rect: Rect, color: Color) {
        self.canvas.fill_rect(rect, Paint::new(color).with_antialias(Antialias::Analytic));
    }

    /// A picture with its pixels as cells as large as fit; gives the grid for marks on top.
    pub(crate) fn picture(&mut self, rect: Rect, picture: Pixmap) -> Grid {
        let (columns, rows) = (picture.width(), picture.height());
        let grid = self.grid(rect, columns, rows);
        let source = Rect::from_xywh(0.0, 0.0, columns as f32, rows as f32);
        let paint = ImagePaint { quality: FilterQuality::Nearest, ..ImagePaint::default() };
        self.canvas.draw_image(&Arc::new(picture), source, grid.rect(), &paint);
        grid
    }

    /// The same with lines between the cells.
    pub(crate) fn zoomed(&mut self, rect: Rect, picture: Pixmap) -> Grid {
        let grid = self.picture(rect, picture);
        self.lines(&grid);
        grid
    }

    /// Axes for curves; gives what maps values to the board.
    pub(crate) fn axes(&mut self, rect: Rect, x: (f32, f32), y: (f32, f32), names: (&str, &str)) -> Axes {
        let area = Rect::from_ltrb(rect.left + 14.0, rect.top + 22.0, rect.right - 8.0, rect.bottom - 22.0);
        self.bar(area, Color::WHITE);
        for i in 0..=4 {
            let t = i as f32 / 4.0;
            let (px, py) = (area.left + area.width() * t, area.top + area.height() * t);
            self.segment(Point::new(px, area.top), Point::new(px, area.bottom), 0.7, FAINT);
            self.segment(Point::new(area.left, py), Point::new(area.right, py), 0.7, FAINT);
        }
        self.segment(Point::new(area.left, area.top), Point::new(area.left, area.bottom), 1.6, INK);
        self.segment(Point::new(area.left, area.bottom), Point::new(area.right, area.bottom), 1.6, INK);
        self.label(area.left, rect.top + 4.0, 10.0, names.1, GREY);
        self.label(area.right - font::width(names.0, 10.0), area.bottom + 9.0, 10.0, names.0, GREY);
        Axes { area, x, y }
    }

    /// A curve through places.
    pub(crate) fn curve(&mut self, axes: &Axes, points: impl IntoIterator<Item = (f32, f32)>, color: Color) {
        let points: Vec<Point> = points.into_iter().map(|(x, y)| axes.map(x, y)).collect();
        self.polyline(&points, 2.4, color);
    }

    pub(crate) fn finish(self) -> Pixmap {
        self.canvas.into_pixmap()
    }
}

/// What maps values to the board.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Axes {
    pub(crate) area: Rect,
    x: (f32, f32),
    y: (f32, f32),
}

impl Axes {
    pub(crate) fn map(&self, x: f32, y: f32) -> Point {
        let t = |v: f32, (a, b): (f32, f32)| ((v - a) / (b - a)).clamp(-0.02, 1.02);
        Point::new(
            self.area.left + self.area.width() * t(x, self.x),
            self.area.bottom - self.area.height() * t(y, self.y),
        )
    }
}
