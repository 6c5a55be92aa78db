//! `rastrum gallery`: a picture for each system that the library has, and a page that shows them.
//!
//! A section is a file with a table of rows: number, name, caption, and the function that draws. A new row is one entry in a table.

mod board;
mod circles;
mod clipping;
mod culling;
mod depth;
mod font;
mod fragments;
mod interpolation;
mod lines;
mod page;
mod parts;
mod pipeline;
mod polygons;
mod shadows;
mod smoothing;
mod stage;
mod textures;
mod tiles;
mod traversal;
mod triangles;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::Args;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::files::write_whole;
use crate::report::{self, Failure, Outcome};
use board::Board;

const EXAMPLES: &str = "\
Examples:
  rastrum gallery gallery                     draws everything; open gallery/index.html in a browser
  rastrum gallery lines --rows 21-38          lines and circles alone
  rastrum gallery some --rows 21,50,106-111

Exit codes: 0 done; 1 some pictures could not be drawn; 2 a usage or output error.";

/// Draw a picture of every algorithm, and a page that shows them.
///
/// DIR gets a PNG for each row, named by its number, and index.html with captions. The bytes are the same on every machine and with
/// any number of threads. Pictures and page are replaced as a whole; other files in DIR are left alone.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct GalleryArguments {
    /// The folder; made where it is missing.
    #[arg(value_name = "DIR")]
    folder: PathBuf,

    /// Draw these rows alone, and show them alone: numbers and ranges, with commas between.
    #[arg(long, value_name = "ROWS", value_parser = rows)]
    rows: Option<Wanted>,

    /// Pictures drawn at a time, 0 for one on each core.
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: usize,

    /// Say nothing but errors.
    #[arg(short, long)]
    quiet: bool,
}

/// One picture.
pub(crate) struct Row {
    /// Its number in the checklist, and the name of its file.
    number: u32,
    name: &'static str,
    /// What to look at.
    caption: &'static str,
    draw: fn(&mut Board) -> rastrum::Result<()>,
}

/// The entry of a table.
const fn row(
    number: u32,
    name: &'static str,
    caption: &'static str,
    draw: fn(&mut Board) -> rastrum::Result<()>,
) -> Row {
    Row { number, name, caption, draw }
}

impl Row {
    fn file(&self) -> String {
        format!("{:03}.png", self.number)
    }
}

/// Rows under one heading.
struct Section {
    title: &'static str,
    /// Its name in links.
    id: &'static str,
    tables: &'static [&'static [Row]],
}

impl Section {
    fn rows(&self) -> impl Iterator<Item = &'static Row> {
        self.tables.iter().flat_map(|table| table.iter())
    }
}

const SECTIONS: &[Section] = &[
    Section { title: "Lines and circles", id: "lines", tables: &[lines::ROWS, circles::ROWS] },
    Section { title: "Polygons and antialiasing", id: "polygons", tables: &[polygons::ROWS, smoothing::ROWS] },
    Section { title: "Pipeline and vertices", id: "pipeline", tables: &[pipeline::ROWS, parts::ROWS] },
    Section {
        title: "Triangle rasterization",
        id: "triangles",
        tables: &[triangles::ROWS, traversal::ROWS, tiles::ROWS],
    },
    Section {
        title: "Interpolation and clipping",
        id: "interpolation",
        tables: &[interpolation::ROWS, clipping::ROWS],
    },
    Section {
        title: "Fragments and framebuffer",
        id: "fragments",
        tables: &[fragments::ROWS, textures::ROWS, depth::ROWS],
    },
    Section { title: "Shadows and culling", id: "shadows", tables: &[shadows::ROWS, culling::ROWS] },
];

/// Ranges of row numbers.
type Wanted = std::sync::Arc<[(u32, u32)]>;

fn rows(text: &str) -> Result<Wanted, String> {
    let wrong = |part: &str| format!("'{part}' is no row or range; try 21 or 30-43 or 21,30-43");
    let mut ranges = Vec::new();
    for part in text.split(',').map(str::trim) {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        match (first.trim().parse(), last.trim().parse()) {
            (Ok(first), Ok(last)) if first <= last => ranges.push((first, last)),
            _ => return Err(wrong(part)),
        }
    }
    for (first, last) in &ranges {
        if !SECTIONS.iter().flat_map(Section::rows).any(|row| (*first..=*last).contains(&row.number)) {
            return Err(format!(
                "there is no row {first}{}",
                if first == last { String::new() } else { format!(" to {last}") }
            ));
        }
    }
    Ok(ranges.into())
}

pub(crate) fn run(arguments: &GalleryArguments) -> Result<Outcome, Failure> {
    let folder = &arguments.folder;
    let fail = |text: String| Failure::new(format!("{}: {text}", folder.display()));
    if folder.exists() && !folder.is_dir() {
        return Err(fail("is a file; name a folder".to_owned()));
    }
    std::fs::create_dir_all(folder).map_err(|error| fail(format!("the folder cannot be made: {error}")))?;
    let wanted = |row: &Row| {
        let ranges = arguments.rows.as_deref();
        ranges.is_none_or(|ranges| ranges.iter().any(|(first, last)| (*first..=*last).contains(&row.number)))
    };
    let rows: Vec<&Row> = SECTIONS.iter().flat_map(Section::rows).filter(|row| wanted(row)).collect();
    let failures = draw_all(&rows, folder, arguments);
    let drawn = |row: &Row| rows.iter().any(|other| other.number == row.number) && !failures.contains(&row.number);
    let page = page::page(SECTIONS, drawn);
    write_whole(&folder.join("index.html"), page.as_bytes()).map_err(|error| fail(format!("index.html: {error}")))?;
    if failures.is_empty() {
        return Ok(Outcome::Done);
    }
    report::complain(&format!("{} of {} pictures failed", failures.len(), rows.len()));
    Ok(Outcome::SomeFailed)
}

/// Draws the rows and writes them; gives the numbers of those that failed.
fn draw_all(rows: &[&Row], folder: &Path, arguments: &GalleryArguments) -> Vec<u32> {
    let threads = match arguments.threads {
        0 => std::thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    };
    let bar = if arguments.quiet {
        ProgressBar::hidden()
    } else {
        // Hidden by itself where standard error is no terminal.
        let bar = ProgressBar::with_draw_target(Some(rows.len() as u64), ProgressDrawTarget::stderr());
        let style = ProgressStyle::with_template("{bar:32} {pos}/{len} {msg}");
        bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
    };
    let next = AtomicUsize::new(0);
    let failures = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..threads.clamp(1, rows.len().max(1)) {
            scope.spawn(|| {
                while let Some(row) = rows.get(next.fetch_add(1, Ordering::Relaxed)) {
                    bar.set_message(row.name);
                    if let Err(error) = draw(row, folder) {
                        bar.suspend(|| {
                            report::complain(&Failure::new(format!("row {}: {error}", row.number)).to_string())
                        });
                        if let Ok(mut failures) = failures.lock() {
                            failures.push(row.number);
                        }
                    }
                    bar.inc(1);
                }
            });
        }
    });
    bar.finish_and_clear();
    failures.into_inner().unwrap_or_default()
}

fn draw(row: &Row, folder: &Path) -> rastrum::Result<()> {
    let mut board = Board::new()?;
    (row.draw)(&mut board)?;
    board.finish().save_png(folder.join(row.file()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn rows_have_numbers_of_their_own_names_and_captions() {
        let mut numbers = BTreeSet::new();
        for row in SECTIONS.iter().flat_map(Section::rows) {
            assert!(numbers.insert(row.number), "{} comes twice", row.number);
            assert!(!row.name.is_empty() && row.caption.len() > 30 && row.caption.ends_with('.'), "{}", row.number);
        }
    }

    #[test]
    fn rows_are_numbers_and_ranges() {
        assert_eq!(rows("21, 30-33").as_deref(), Ok(&[(21, 21), (30, 33)][..]));
        for bad in ["", "x", "3-", "9-3", "21,,22", "9999"] {
            assert!(rows(bad).is_err(), "{bad}");
        }
    }
}
