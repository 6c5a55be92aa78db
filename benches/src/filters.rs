//! Filters of a whole picture: rastrum and resvg, in turns.

use rastrum::{Canvas, PixmapMut, RenderSettings};

use crate::engines::Engine;
use crate::measure::{Times, take_turns};

const SIDE: u32 = 1024;

/// Name and primitives of each filter. They apply to the same two shapes, in a region as large as the picture.
const FILTERS: [(&str, &str); 9] = [
    ("no change", "<feOffset/>"),
    ("blur 2", "<feGaussianBlur stdDeviation='2'/>"),
    ("blur 20", "<feGaussianBlur stdDeviation='20'/>"),
    ("blur 200", "<feGaussianBlur stdDeviation='200'/>"),
    ("drop shadow", "<feDropShadow dx='10' dy='12' stdDeviation='8'/>"),
    ("turbulence", "<feTurbulence baseFrequency='.02' numOctaves='4'/>"),
    (
        "diffuse light",
        "<feDiffuseLighting surfaceScale='5'><fePointLight x='300' y='200' z='200'/></feDiffuseLighting>",
    ),
    (
        "specular light",
        "<feSpecularLighting surfaceScale='5' specularExponent='20'>\
         <feSpotLight x='300' y='200' z='200' pointsAtX='500' pointsAtY='500'/></feSpecularLighting>",
    ),
    ("dilate 10", "<feMorphology operator='dilate' radius='10'/>"),
];

struct Rastrum<'t> {
    tree: &'t usvg::Tree,
    pixels: Vec<u8>,
    threads: usize,
}

impl Engine for Rastrum<'_> {
    fn draw(&mut self) {
        self.pixels.fill(255);
        let target = PixmapMut::from_bytes(&mut self.pixels, SIDE, SIDE).expect("the size is valid");
        let mut canvas = Canvas::on(target);
        canvas.set_settings(RenderSettings::default().with_threads(self.threads));
        rastrum::svg::render(self.tree, rastrum::Transform::IDENTITY, &mut canvas);
    }

    fn picture(&mut self) -> Vec<u8> {
        self.pixels.clone()
    }
}

struct Resvg<'t> {
    tree: &'t usvg::Tree,
    target: resvg::tiny_skia::Pixmap,
}

impl Engine for Resvg<'_> {
    fn draw(&mut self) {
        self.target.fill(resvg::tiny_skia::Color::WHITE);
        resvg::render(self.tree, resvg::tiny_skia::Transform::identity(), &mut self.target.as_mut());
    }

    fn picture(&mut self) -> Vec<u8> {
        self.target.data().to_vec()
    }
}

/// One line of the table.
struct Row {
    name: &'static str,
    times: Vec<Times>,
    /// The mean difference of the pictures' bytes.
    difference: f64,
}

/// Draws every filter in turns and gives a table of milliseconds.
pub fn table(rounds: usize) -> Result<String, String> {
    let mut out = format!(
        "{SIDE}² pixels, ms a picture, minimum of {rounds} rounds\n\n\
         | filter | rastrum 1 thread | 2 threads | resvg | resvg / rastrum:1 | mean difference |\n|---|---|---|---|---|---|\n"
    );
    for (name, primitives) in FILTERS {
        eprintln!("{name}");
        let Row { name, times, difference } = row(name, primitives, rounds)?;
        let [one, two, resvg] = [0, 1, 2].map(|index| times[index].minimum());
        out += &format!("| {name} | {one:.1} | {two:.1} | {resvg:.1} | {:.1} | {difference:.2} |\n", resvg / one);
    }
    Ok(out)
}

fn row(name: &'static str, primitives: &str, rounds: usize) -> Result<Row, String> {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{SIDE}' height='{SIDE}'>\
         <filter id='f' filterUnits='userSpaceOnUse' x='0' y='0' width='{SIDE}' height='{SIDE}'>{primitives}</filter>\
         <g filter='url(#f)'><rect x='100' y='100' width='824' height='824' fill='#c33'/>\
         <circle cx='600' cy='500' r='300' fill='#36c' fill-opacity='.7'/></g></svg>"
    );
    let options = usvg::Options::default();
    let tree = usvg::Tree::from_str(&text, &options).map_err(|error| format!("{name}: {error}"))?;
    let pixels = vec![255; (SIDE * SIDE * 4) as usize];
    let target = resvg::tiny_skia::Pixmap::new(SIDE, SIDE).ok_or("no memory for a picture")?;
    let mut engines: Vec<Box<dyn Engine + '_>> = vec![
        Box::new(Rastrum { tree: &tree, pixels: pixels.clone(), threads: 1 }),
        Box::new(Rastrum { tree: &tree, pixels, threads: 2 }),
        Box::new(Resvg { tree: &tree, target }),
    ];
    let pictures: Vec<Vec<u8>> = engines
        .iter_mut()
        .map(|engine| {
            engine.draw();
            engine.picture()
        })
        .collect();
    if pictures[0] != pictures[1] {
        return Err(format!("{name}: the picture depends on the number of threads"));
    }
    let sum: u64 = pictures[0].iter().zip(&pictures[2]).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    let difference = sum as f64 / pictures[0].len() as f64;
    Ok(Row { name, times: take_turns(&mut engines, rounds), difference })
}
