//! The test suite of the resvg project, if the environment says where it is (`RASTRUM_SVG_SUITE`): a folder with `tests/`,
//! `fonts/` and the list of cases `open.txt`. Pictures are compared as pictures of another antialiaser.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::{env, fs, thread};

use rastrum::svg::{self, usvg};
use rastrum::{Canvas, Pixmap, RenderSettings, Transform};

use super::fixtures::repository;

/// Files that are to be refused.
const WITHOUT_PICTURE: [&str; 3] =
    ["structure/svg/negative-size.svg", "structure/svg/zero-size.svg", "structure/svg/not-UTF-8-encoding.svg"];

/// The least share of cases that pass, in percent.
const LEAST: f64 = 99.5;

/// How a picture differs from its reference. A pixel's difference is the largest of its premultiplied components.
#[derive(Debug)]
struct Score {
    /// The mean difference, of 255.
    mean: f64,
    /// The share of pixels that differ by more than 16, and more than 64.
    soft: f64,
    hard: f64,
    /// The share of pixels more than 48 outside of what the other picture has in the 3 × 3 pixels around.
    stray: f64,
}

impl Score {
    fn new(expected: &Pixmap, actual: &Pixmap) -> Self {
        let (width, height) = (expected.width() as usize, expected.height() as usize);
        let (e, a) = (expected.data().as_chunks::<4>().0, actual.data().as_chunks::<4>().0);
        let (around_e, around_a) = (surroundings(e, width, height), surroundings(a, width, height));
        let outside = |value: u8, (low, high): (u8, u8)| low.saturating_sub(value).max(value.saturating_sub(high));
        let (mut sum, mut soft, mut hard, mut stray) = (0_u64, 0_u32, 0_u32, 0_u32);
        for index in 0..width * height {
            let difference = (0..4).map(|c| e[index][c].abs_diff(a[index][c])).max().unwrap();
            sum += u64::from(difference);
            soft += u32::from(difference > 16);
            hard += u32::from(difference > 64);
            let distance =
                |c: usize| outside(a[index][c], around_e[index][c]).max(outside(e[index][c], around_a[index][c]));
            stray += u32::from((0..4).map(distance).max().unwrap() > 48);
        }
        let share = |count: u32| f64::from(count) / (width * height) as f64;
        let mean = sum as f64 / (width * height) as f64 / 255.0;
        Self { mean, soft: share(soft), hard: share(hard), stray: share(stray) }
    }

    fn passes(&self) -> bool {
        self.mean <= 0.006 && self.soft <= 0.04 && self.hard <= 0.002 && self.stray <= 0.0002
    }
}

/// The least and the greatest of each component in the 3 × 3 pixels around each pixel.
fn surroundings(pixels: &[[u8; 4]], width: usize, height: usize) -> Vec<[(u8, u8); 4]> {
    let mut out = Vec::with_capacity(pixels.len());
    for y in 0..height {
        for x in 0..width {
            let mut all = [(255, 0); 4];
            for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
                for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
                    for (all, value) in all.iter_mut().zip(pixels[v * width + u]) {
                        *all = (all.0.min(value), all.1.max(value));
                    }
                }
            }
            out.push(all);
        }
    }
    out
}

fn options(fonts: &Arc<usvg::fontdb::Database>, file: &Path) -> usvg::Options<'static> {
    usvg::Options {
        resources_dir: file.parent().map(Path::to_owned),
        fontdb: Arc::clone(fonts),
        image_href_resolver: svg::image_resolver(|_| {}),
        ..usvg::Options::default()
    }
}

fn fonts(folder: &Path) -> Arc<usvg::fontdb::Database> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_fonts_dir(folder);
    fonts.set_serif_family("Noto Serif");
    fonts.set_sans_serif_family("Noto Sans");
    fonts.set_cursive_family("Yellowtail");
    fonts.set_fantasy_family("Sedgwick Ave Display");
    fonts.set_monospace_family("Noto Mono");
    Arc::new(fonts)
}

/// What is wrong with a case, if anything.
fn check(suite: &Path, case: &str, fonts: &Arc<usvg::fontdb::Database>) -> Option<String> {
    let file = suite.join("tests").join(case);
    let tree = svg::parse(&fs::read(&file).unwrap(), &options(fonts, &file));
    if WITHOUT_PICTURE.contains(&case) {
        return tree.is_ok().then(|| "it is drawn".to_owned());
    }
    let tree = match tree {
        Ok(tree) => tree,
        Err(error) => return Some(error.to_string()),
    };
    let expected = Pixmap::decode(&fs::read(file.with_extension("png")).unwrap()).unwrap();
    let (width, height) = (expected.width(), expected.height());
    let settings = RenderSettings::default().with_threads(1);
    let mut canvas = Canvas::with_settings(width, height, settings).unwrap();
    let scale = Transform::from_scale(width as f32 / tree.size().width(), height as f32 / tree.size().height());
    svg::render(&tree, scale, &mut canvas);
    let score = Score::new(&expected, &canvas.into_pixmap());
    (!score.passes()).then(|| format!("{score:.5?}"))
}

#[test]
fn cases_look_like_their_references() {
    let Some(suite) = env::var_os("RASTRUM_SVG_SUITE").map(PathBuf::from) else {
        println!("skipped: RASTRUM_SVG_SUITE names no folder");
        return;
    };
    let list = fs::read_to_string(suite.join("open.txt")).unwrap();
    let cases: Vec<&str> =
        list.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')).collect();
    let fonts = fonts(&suite.join("fonts"));
    let next = Mutex::new(cases.iter());
    let misses = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            let work = || {
                while let Some(case) = { next.lock().unwrap().next() } {
                    if let Some(fault) = check(&suite, case, &fonts) {
                        misses.lock().unwrap().push((*case, fault));
                    }
                }
            };
            // usvg recurses into what a file nests.
            thread::Builder::new().stack_size(64 << 20).spawn_scoped(scope, work).unwrap();
        }
    });
    let mut misses = misses.into_inner().unwrap();
    misses.sort();
    for (case, fault) in &misses {
        println!("{case}: {fault}");
    }
    let share = 100.0 * (1.0 - misses.len() as f64 / cases.len() as f64);
    println!("{} of {} cases pass: {share:.2} %", cases.len() - misses.len(), cases.len());
    assert!(share >= LEAST, "{share:.2} %");
    let known = fs::read_to_string(repository("docs/SVG.md")).unwrap();
    for (case, fault) in misses {
        let name = case.trim_end_matches(".svg");
        assert!(known.contains(&format!("`{name}`")), "docs/SVG.md does not say why {name} differs: {fault}");
    }
}

#[test]
fn the_score_tells_antialiasing_from_mistakes() {
    let square = |shift: u32, edge: u8| {
        let mut pixmap = Pixmap::new(100, 100).unwrap();
        for (index, pixel) in pixmap.data_mut().as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let (x, y) = (index as u32 % 100, index as u32 / 100);
            let inside = (20 + shift..80 + shift).contains(&x) && (20..80).contains(&y);
            *pixel = if inside { [0, 0, 0, if x == 20 + shift { edge } else { 255 }] } else { [0; 4] };
        }
        pixmap
    };
    let exact = square(0, 128);
    assert!(Score::new(&exact, &exact).passes());
    assert!(Score::new(&exact, &square(0, 160)).passes());
    // A column is missing; the square lies elsewhere.
    assert!(!Score::new(&exact, &square(0, 0)).passes());
    assert!(!Score::new(&exact, &square(2, 128)).passes());
}
