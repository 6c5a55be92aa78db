//! The command line.

use std::path::PathBuf;

use crate::engines::Kind;

pub const HELP: &str = "\
Head-to-head benches of rastrum with other CPU renderers.

cargo run --release -- [options]

  --workload W1,W2     these workloads alone; drawings by their file's name
  --engine NAME,NAME   these engines alone: rastrum, rastrum-exact, vello_cpu, tiny-skia, raqote, resvg,
                       or one thread count of them, as in rastrum:2
  --rounds N           rounds in which each engine has one turn (15)
  --svg-real DIR       a folder of SVG files to draw as well (RASTRUM_SVG_REAL)
  --check-only         compare the pictures, time nothing
  --pictures DIR       write every picture to DIR; else those that are refused go to target/pictures
  --no-peak            do not measure peak memory
  --no-accuracy        do not measure accuracy
  --scaling            measure how cost grows with shapes, vertices, pixels and layers, and nothing else
  --filters            measure SVG filters beside resvg's, and nothing else
  --list               name the workloads and engines
  --json               print JSON instead of a table
  --help               print this";

pub struct Options {
    pub workloads: Vec<String>,
    pub engines: Vec<String>,
    pub rounds: usize,
    pub svg_real: Option<PathBuf>,
    pub check_only: bool,
    pub pictures: Option<PathBuf>,
    pub peak: bool,
    pub accuracy: bool,
    pub scaling: bool,
    pub filters: bool,
    pub list: bool,
    pub json: bool,
    pub help: bool,
    /// Draw this workload once with the one engine named and print the memory that it took: how the program runs itself.
    pub peak_of: Option<String>,
}

impl Options {
    pub fn parse(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self {
            workloads: Vec::new(),
            engines: Vec::new(),
            rounds: 15,
            svg_real: std::env::var_os("RASTRUM_SVG_REAL").map(PathBuf::from),
            check_only: false,
            pictures: None,
            peak: true,
            accuracy: true,
            scaling: false,
            filters: false,
            list: false,
            json: false,
            help: false,
            peak_of: None,
        };
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or_else(|| format!("{argument} needs a value"));
            let names = |list: String| list.split(',').map(str::to_owned).collect::<Vec<String>>();
            match argument.as_str() {
                "--workload" => options.workloads.extend(names(value()?)),
                "--engine" => options.engines.extend(names(value()?)),
                "--rounds" => {
                    let text = value()?;
                    let rounds = text.parse().ok().filter(|rounds| *rounds > 0);
                    options.rounds = rounds.ok_or_else(|| format!("--rounds {text}: not a number above 0"))?;
                }
                "--svg-real" => options.svg_real = Some(value()?.into()),
                "--pictures" => options.pictures = Some(value()?.into()),
                "--check-only" => options.check_only = true,
                "--no-peak" => options.peak = false,
                "--no-accuracy" => options.accuracy = false,
                "--scaling" => options.scaling = true,
                "--filters" => options.filters = true,
                "--list" => options.list = true,
                "--json" => options.json = true,
                "--help" | "-h" => options.help = true,
                "--peak-of" => options.peak_of = Some(value()?),
                other => return Err(format!("{other} is no option; --help names them")),
            }
        }
        let known = |name: &str| Kind::ALL.iter().any(|kind| matches(*kind, name));
        match options.engines.iter().find(|name| !known(name)) {
            Some(name) => Err(format!("{name} is no engine; --list names them")),
            None => Ok(options),
        }
    }

    pub fn wants_workload(&self, name: &str) -> bool {
        self.workloads.is_empty() || self.workloads.iter().any(|wanted| wanted == name)
    }

    /// Whether to run an engine. `Exact` antialiasing runs where there is a goal for it, or where it is asked for.
    pub fn wants_engine(&self, kind: Kind, workload: &str, is_drawing: bool) -> bool {
        if self.engines.is_empty() {
            return kind != Kind::RastrumExact || is_drawing || ["W2", "W4", "W11"].contains(&workload);
        }
        self.engines.iter().any(|name| matches(kind, name))
    }
}

/// An engine and its threads as the command line names them.
pub fn full_name(kind: Kind) -> String {
    format!("{}:{}", kind.name(), kind.threads())
}

fn matches(kind: Kind, name: &str) -> bool {
    name == kind.name() || name == full_name(kind)
}
