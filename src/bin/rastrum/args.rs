//! The command line, as clap reads it.

use std::ffi::OsString;
use std::path::PathBuf;
use std::str::FromStr as _;

use clap::{Args, Parser, Subcommand, ValueEnum};
use rastrum::{Antialias, Color};

/// Draws SVG files and 3D models as PNG, with the same bytes on every machine.
#[derive(Debug, Parser)]
#[command(
    name = "rastrum",
    version,
    about,
    after_help = "Exit codes: 0 done; 1 some of several inputs or pictures failed; 2 a usage, input or output error.\n\n\
                  Try `rastrum render --help` for options and examples."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Render(Box<RenderArguments>),
    Mesh(Box<crate::mesh::MeshArguments>),
    Gallery(crate::gallery::GalleryArguments),
    #[command(hide = true)]
    Worker(Box<RenderArguments>),
    Info(InfoArguments),
    Completions(CompletionsArguments),
    Man(ManArguments),
}

/// [`Arguments`] for `rastrum render` alone: to describe all commands takes as long as to draw an icon, and drawings come one by one.
#[derive(Parser)]
#[command(name = "rastrum", version)]
struct RenderAlone {
    #[command(subcommand)]
    command: RenderCommand,
}

#[derive(Subcommand)]
enum RenderCommand {
    Render(Box<RenderArguments>),
}

/// What the command line asks for; help and errors of usage end the program.
pub(crate) fn parse() -> Command {
    if std::env::args_os().nth(1).is_some_and(|command| command == "render") {
        let RenderCommand::Render(arguments) = RenderAlone::parse().command;
        return Command::Render(arguments);
    }
    Arguments::parse().command
}

const RENDER_EXAMPLES: &str = "\
Examples:
  rastrum render icon.svg                        writes icon.png beside icon.svg
  rastrum render icon.svg -o big.png -w 1024     1024 pixels wide, height in proportion
  rastrum render *.svg -o 'png/{stem}@2x.png' -z 2
  rastrum render icons/ -o png/                  every .svg and .svgz below icons, same folders below png
  curl -s URL | rastrum render - -o - | display
  rastrum render map.svg --timings json";

/// Draw SVG files as PNG.
///
/// SVG (and .svgz) files are read, drawn at their own size or the one asked for, and written as 8-bit RGBA PNG.
/// A target is replaced only once the new picture is complete.
#[derive(Args, Debug)]
#[command(after_help = RENDER_EXAMPLES)]
pub(crate) struct RenderArguments {
    /// SVG files, folders (searched for .svg and .svgz, recursively), patterns such as 'icons/*.svg', or - for
    /// standard input.
    #[arg(required_unless_present = "list_fonts", value_name = "INPUT")]
    pub(crate) inputs: Vec<OsString>,

    /// Where the picture goes: a file, a folder, a name with {stem} (the input's name without its ending) and
    /// {dir} (the input's folder), or - for standard output. Default: beside the input, ending in .png; standard
    /// output for standard input.
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Option<OsString>,

    /// Width in pixels; the height follows in proportion. With --height: the largest size that fits both.
    #[arg(short, long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) width: Option<u32>,

    /// Height in pixels; the width follows in proportion. With --width: the largest size that fits both.
    #[arg(short = 'H', long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) height: Option<u32>,

    /// Scale, as a factor of the SVG's own size.
    #[arg(short, long, value_name = "FACTOR", value_parser = factor, conflicts_with_all = ["width", "height"])]
    pub(crate) zoom: Option<f32>,

    /// Pixels per inch, for sizes in cm, mm, in, pt and pc.
    #[arg(long, value_name = "DPI", default_value_t = 96, value_parser = clap::value_parser!(u32).range(10..=4000))]
    pub(crate) dpi: u32,

    /// Colour behind the drawing, as CSS writes it: white, '#eef', 'rgba(0, 0, 0, 0.5)'. Default: transparent.
    #[arg(short, long, value_name = "COLOR", value_parser = color)]
    pub(crate) background: Option<Color>,

    /// Draw only the element with this id, at its own size.
    #[arg(long, value_name = "ID")]
    pub(crate) export_id: Option<String>,

    /// What the picture shows: the page, or the box of all that is drawn (with --export-id, of the element). Default:
    /// the page; with --export-id, the element's box.
    #[arg(long, value_name = "AREA")]
    pub(crate) export_area: Option<ExportArea>,

    /// Draw nothing; print the elements that have an id, and the boxes that they draw on: a line of
    /// id,x,y,width,height each, or (=json) one array of objects.
    #[arg(long, value_name = "FORMAT", num_args = 0..=1, require_equals = true, default_missing_value = "text", conflicts_with = "output")]
    pub(crate) query_all: Option<QueryFormat>,

    /// CSS file whose rules apply before those of the drawing.
    #[arg(long, value_name = "FILE")]
    pub(crate) stylesheet: Option<PathBuf>,

    /// Languages for the `systemLanguage` attribute, the most wanted first.
    #[arg(long, value_name = "LANGUAGES", value_delimiter = ',', default_value = "en")]
    pub(crate) languages: Vec<String>,

    /// Stop a file that takes longer than so many seconds.
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds)]
    pub(crate) max_time: f64,

    /// Stop a file that takes more memory (a number of bytes, or with K, M, G, KiB, MiB, GiB). On Linux only.
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = bytes)]
    pub(crate) max_memory: u64,

    /// How edges are smoothed: analytic, exact, none, or supersample=N (N × N samples a pixel, 1 to 16).
    #[arg(long, value_name = "MODE", default_value = "analytic", value_parser = antialias)]
    pub(crate) antialias: Antialias,

    /// Folder that links to images start from. Default: the input's folder. Absolute links to files outside of it are
    /// refused.
    #[arg(long, value_name = "DIR")]
    pub(crate) resources_dir: Option<PathBuf>,

    /// Threads per picture, 0 for all. The picture is the same with any number. Default: all for one input, one
    /// each for several.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,

    /// Files drawn at a time. Default: the number of processors.
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) jobs: Option<u16>,

    /// Print how long each file took, one JSON object a line, to standard output (to standard error if the
    /// picture goes there).
    #[arg(long, value_name = "FORMAT")]
    pub(crate) timings: Option<Timings>,

    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,

    /// Say what was written, too.
    #[arg(short, long, conflicts_with = "quiet")]
    pub(crate) verbose: bool,

    #[command(flatten)]
    pub(crate) fonts: FontArguments,
}

#[derive(Args, Debug)]
#[command(next_help_heading = "Fonts (read only if the drawing has text)")]
pub(crate) struct FontArguments {
    /// Load the fonts in this folder and below.
    #[arg(long, value_name = "DIR")]
    pub(crate) font_dir: Vec<PathBuf>,

    /// Load this font file.
    #[arg(long, value_name = "FILE")]
    pub(crate) font_file: Vec<PathBuf>,

    /// Draw nothing; print the fonts: family, style and file.
    #[arg(long)]
    pub(crate) list_fonts: bool,

    /// Do not load the system's fonts.
    #[arg(long)]
    pub(crate) no_system_fonts: bool,

    /// The font that stands for serif.
    #[arg(long, value_name = "FAMILY")]
    pub(crate) serif_family: Option<String>,

    /// The font that stands for sans-serif.
    #[arg(long, value_name = "FAMILY")]
    pub(crate) sans_serif_family: Option<String>,

    /// The font that stands for cursive.
    #[arg(long, value_name = "FAMILY")]
    pub(crate) cursive_family: Option<String>,

    /// The font that stands for fantasy.
    #[arg(long, value_name = "FAMILY")]
    pub(crate) fantasy_family: Option<String>,

    /// The font that stands for monospace.
    #[arg(long, value_name = "FAMILY")]
    pub(crate) monospace_family: Option<String>,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Timings {
    /// One object a line: input, output, width, height, parse_ms, draw_ms, encode_ms, warnings.
    Json,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ExportArea {
    /// The page: the drawing's own size.
    Page,
    /// The box of what is drawn.
    Drawing,
}

/// How elements are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum QueryFormat {
    /// id,x,y,width,height, a line each.
    Text,
    /// One array of objects.
    Json,
}

/// Show the version, the SIMD levels and the threads of this machine.
#[derive(Args, Debug)]
pub(crate) struct InfoArguments {
    /// As one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Print a shell's completions, to be put where the shell looks for them.
#[derive(Args, Debug)]
pub(crate) struct CompletionsArguments {
    pub(crate) shell: clap_complete::Shell,
}

/// Print a manual page in roff.
#[derive(Args, Debug)]
pub(crate) struct ManArguments {
    /// The subcommand whose page is wanted. Default: the program's own.
    pub(crate) subcommand: Option<String>,
}

fn factor(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(factor) if factor > 0.0 && factor.is_finite() => Ok(factor),
        _ => Err("must be a number above 0".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds > 0.0 => Ok(seconds),
        _ => Err("must be a number of seconds above 0".to_owned()),
    }
}

fn bytes(text: &str) -> Result<u64, String> {
    let wrong = || "must be a size such as 500000000, 512MiB or 4G".to_owned();
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let shift = match text.get(digits.len()..).unwrap_or_default().to_ascii_lowercase().as_str() {
        "" | "b" => 0,
        "k" | "kib" => 10,
        "m" | "mib" => 20,
        "g" | "gib" => 30,
        "t" | "tib" => 40,
        _ => return Err(wrong()),
    };
    let number: u64 = digits.trim().parse().map_err(|_| wrong())?;
    match number.checked_mul(1 << shift) {
        Some(bytes) if bytes > 0 => Ok(bytes),
        _ => Err(wrong()),
    }
}

fn color(text: &str) -> Result<Color, String> {
    svgtypes::Color::from_str(text.trim())
        .map(|color| Color::from_rgba8(color.red, color.green, color.blue, color.alpha))
        .map_err(|_| "not a CSS colour; try white, '#eef' or 'rgba(0, 0, 0, 0.5)'".to_owned())
}

fn antialias(text: &str) -> Result<Antialias, String> {
    let samples = |n: &str| n.parse().ok().filter(|n| (1..=16).contains(n)).map(Antialias::Supersample);
    match text.split_once('=') {
        None => match text {
            "analytic" => Some(Antialias::Analytic),
            "exact" => Some(Antialias::Exact),
            "none" => Some(Antialias::None),
            "supersample" => Some(Antialias::Supersample(4)),
            _ => None,
        },
        Some(("supersample", n)) => samples(n),
        Some(_) => None,
    }
    .ok_or_else(|| "must be analytic, exact, none, or supersample=N with N from 1 to 16".to_owned())
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn clap_finds_no_fault_in_the_definition() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn values_of_their_own_grammar() {
        assert_eq!(antialias("supersample"), Ok(Antialias::Supersample(4)));
        assert_eq!(antialias("supersample=16"), Ok(Antialias::Supersample(16)));
        for bad in ["supersample=0", "supersample=17", "exact=1", "", "best"] {
            assert!(antialias(bad).is_err(), "{bad}");
        }
        assert_eq!(color(" #f00 "), Ok(Color::RED));
        assert!(color("reddish").is_err());
        for bad in ["0", "-1", "nan", "inf", "x"] {
            assert!(factor(bad).is_err(), "{bad}");
        }
        assert_eq!((bytes("512MiB"), bytes("3 k"), bytes("7")), (Ok(512 << 20), Ok(3 << 10), Ok(7)));
        for bad in ["0", "", "G", "-1M", "1X", "99999999999G", "1.5G"] {
            assert!(bytes(bad).is_err(), "{bad}");
        }
        assert_eq!((seconds("0.5"), seconds("inf")), (Ok(0.5), Ok(f64::INFINITY)));
        for bad in ["0", "-1", "nan", "x"] {
            assert!(seconds(bad).is_err(), "{bad}");
        }
    }
}
