//! Head-to-head benches: rastrum and other CPU renderers draw the same scenes in turns. See the README beside.

mod accuracy;
mod compare;
mod drawings;
mod engines;
mod filters;
mod measure;
mod options;
mod peak;
mod random;
mod report;
mod scaling;
mod scene;
mod workloads;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use compare::Difference;
use drawings::Drawing;
use engines::{Engine, Kind};
use options::Options;
use report::{Report, Row, Workload};
use scene::Scene;

fn main() -> ExitCode {
    match Options::parse(std::env::args().skip(1)).and_then(|options| run(&options)) {
        Ok(true) => ExitCode::SUCCESS,
        // Some engine drew something else.
        Ok(false) => ExitCode::from(1),
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::from(2)
        }
    }
}

fn run(options: &Options) -> Result<bool, String> {
    if options.help {
        println!("{}", options::HELP);
        return Ok(true);
    }
    if options.list {
        list(options)?;
        return Ok(true);
    }
    if options.filters {
        print!("{}", filters::table(options.rounds)?);
        return Ok(true);
    }
    if let Some(workload) = &options.peak_of {
        return print_peak(workload, options).map(|()| true);
    }
    let mut report = Report { machine: machine(), rounds: options.rounds, ..Report::default() };
    if options.scaling {
        report.scaling = scaling::measure(&[Kind::Rastrum(1), Kind::Vello], |series, kind, size, time| {
            eprintln!("{series}: {} at {size:.0}: {time:.3} ms", kind.name());
        });
    } else {
        let names = names(options)?;
        if let Some(unknown) = options.workloads.iter().find(|name| !names.contains(name)) {
            return Err(format!("{unknown} is no workload; --list names them"));
        }
        for name in names.iter().filter(|name| options.wants_workload(name)) {
            eprintln!("{name}");
            report.workloads.push(bench(name, options)?);
        }
        if options.accuracy && !options.check_only {
            eprintln!("accuracy");
            let kinds = [Kind::Rastrum(1), Kind::RastrumExact, Kind::Vello, Kind::TinySkia, Kind::Raqote];
            report.accuracy = accuracy::measure(&kinds, 80);
        }
    }
    println!("{}", if options.json { report.json() } else { report.table() });
    Ok(report.workloads.iter().all(|workload| workload.refused.is_empty()))
}

/// What a workload's name stands for.
enum Subject {
    Scene(Box<Scene>),
    Drawing(Box<Drawing>),
}

impl Subject {
    fn load(name: &str, options: &Options) -> Result<Self, String> {
        if let Some(scene) = workloads::workload(name) {
            return Ok(Self::Scene(Box::new(scene)));
        }
        let file = files(options)?.into_iter().find(|file| drawings::name(file) == name);
        let file = file.ok_or_else(|| format!("{name} is no workload; --list names them"))?;
        // usvg recurses into nested elements.
        let load = move || drawings::load(&file);
        let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(load).map_err(|error| error.to_string())?;
        let drawing = thread.join().map_err(|_| format!("{name}: reading it panicked"))??;
        Ok(Self::Drawing(Box::new(drawing)))
    }

    fn scene(&self) -> &Scene {
        match self {
            Self::Scene(scene) => scene,
            Self::Drawing(drawing) => &drawing.scene,
        }
    }

    fn tree(&self) -> Option<&usvg::Tree> {
        match self {
            Self::Scene(_) => None,
            Self::Drawing(drawing) => Some(&drawing.tree),
        }
    }
}

fn files(options: &Options) -> Result<Vec<PathBuf>, String> {
    options.svg_real.as_deref().map_or(Ok(Vec::new()), drawings::files)
}

fn names(options: &Options) -> Result<Vec<String>, String> {
    let drawings = files(options)?;
    Ok(workloads::NAMES
        .iter()
        .map(|name| (*name).to_owned())
        .chain(drawings.iter().map(|f| drawings::name(f)))
        .collect())
}

/// Draws one workload with every engine, compares the pictures, and times those that drew the same thing.
fn bench(name: &str, options: &Options) -> Result<Workload, String> {
    let subject = Subject::load(name, options)?;
    let (scene, tree) = (subject.scene(), subject.tree());
    let mut workload = Workload {
        name: name.to_owned(),
        title: scene.title.clone(),
        width: scene.width,
        height: scene.height,
        is_drawing: tree.is_some(),
        rows: Vec::new(),
        refused: Vec::new(),
        notes: Vec::new(),
    };
    if let Subject::Drawing(drawing) = &subject {
        workload.notes = drawing.notes.iter().map(|(what, count)| format!("{count} {what}")).collect();
    }

    let Some((_, reference)) = first_picture(Kind::Rastrum(1), &subject) else {
        return Err(format!("{name}: rastrum panicked"));
    };
    let mut engines = Vec::new();
    let mut compared = Vec::new();
    for kind in Kind::ALL.into_iter().filter(|kind| options.wants_engine(*kind, name, tree.is_some())) {
        if kind == Kind::Resvg && tree.is_none() {
            continue;
        }
        let Some((engine, picture)) = first_picture(kind, &subject) else {
            workload.refused.push((kind, "it panicked".to_owned()));
            continue;
        };
        let difference = Difference::between(&reference, &picture, scene.width as usize);
        let problem = if matches!(kind, Kind::Rastrum(_)) && picture != reference {
            Some("threads change the picture".to_owned())
        } else if !difference.is_the_same_thing() {
            let Difference { mean, max, blocks } = difference;
            Some(format!("its picture differs by {mean:.2}, at most {max}; {:.1} % of squares", blocks * 100.0))
        } else {
            None
        };
        write_pictures(options, kind, scene, problem.is_some(), &reference, &picture)?;
        match problem {
            Some(problem) => workload.refused.push((kind, problem)),
            None => {
                engines.push(engine);
                compared.push((kind, difference));
            }
        }
    }

    let times = if options.check_only {
        vec![measure::Times::default(); engines.len()]
    } else {
        measure::take_turns(&mut engines, options.rounds)
    };
    for ((kind, difference), times) in compared.into_iter().zip(times) {
        let wanted = options.peak && !options.check_only;
        let engine = options::full_name(kind);
        let peak = wanted.then(|| peak::in_child(name, &engine, options.svg_real.as_deref())).flatten();
        workload.rows.push(Row { kind, times, peak, difference });
    }
    Ok(workload)
}

/// An engine that has drawn once, and its picture; `None` where it panicked.
fn first_picture(kind: Kind, subject: &Subject) -> Option<(Box<dyn Engine + '_>, Vec<u8>)> {
    let draw = || {
        let mut engine = kind.prepare(subject.scene(), subject.tree())?;
        engine.draw();
        let picture = engine.picture();
        Some((engine, picture))
    };
    catch_unwind(AssertUnwindSafe(draw)).ok().flatten()
}

/// Writes what was asked for, and pictures that are refused with what they should have been.
fn write_pictures(
    options: &Options,
    kind: Kind,
    scene: &Scene,
    is_refused: bool,
    reference: &[u8],
    picture: &[u8],
) -> Result<(), String> {
    let refused = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/pictures");
    let folder = match &options.pictures {
        Some(folder) => folder,
        None if is_refused => &refused,
        None => return Ok(()),
    };
    let (name, width, height) = (&scene.name, scene.width, scene.height);
    if is_refused {
        compare::write(folder, &format!("{name}-expected"), reference, width, height)?;
    }
    compare::write(folder, &format!("{name}-{}-{}", kind.name(), kind.threads()), picture, width, height)
}

/// The child's part of [`peak::in_child`].
fn print_peak(workload: &str, options: &Options) -> Result<(), String> {
    let subject = Subject::load(workload, options)?;
    let kind = Kind::ALL.into_iter().find(|kind| options.engines == [options::full_name(*kind)]);
    let kind = kind.ok_or("--peak-of needs one engine with its threads, as in rastrum:1")?;
    let engine = kind.prepare(subject.scene(), subject.tree());
    let mut engine = engine.ok_or("this engine does not draw this workload")?;
    let peak = peak::of(&mut *engine).ok_or("peak memory can be measured on Linux alone")?;
    println!("{peak}");
    Ok(())
}

fn list(options: &Options) -> Result<(), String> {
    for name in workloads::NAMES {
        let title = workloads::workload(name).map(|scene| scene.title).unwrap_or_default();
        println!("{name:6} {title}");
    }
    for file in files(options)? {
        println!("{}", drawings::name(&file));
    }
    let engines: Vec<String> = Kind::ALL.iter().map(|kind| options::full_name(*kind)).collect();
    println!("engines: {}", engines.join(", "));
    Ok(())
}

/// What the times depend on.
fn machine() -> Vec<(&'static str, String)> {
    let git = |arguments: &[&str]| {
        let output = Command::new("git").args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output().ok()?;
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
    };
    let mut commit = git(&["rev-parse", "--short=12", "HEAD"]).unwrap_or_else(|| "unknown".to_owned());
    if git(&["status", "--porcelain"]).is_some_and(|changes| !changes.is_empty()) {
        commit.push_str(" with changes");
    }
    let cpu = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let cpu = cpu.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let engines: Vec<String> = ["vello_cpu", "tiny-skia", "resvg", "raqote"].map(locked_version).into();
    vec![
        ("simd", rastrum::SimdLevel::best().name().to_owned()),
        ("threads", std::thread::available_parallelism().map_or(1, usize::from).to_string()),
        ("commit", commit),
        ("cpu", cpu.map_or("unknown", |(_, name)| name.trim()).to_owned()),
        ("engines", engines.join(", ")),
    ]
}

/// A crate and its version in the lock file.
fn locked_version(name: &str) -> String {
    let entry = format!("name = \"{name}\"\nversion = \"");
    let lock = include_str!("../Cargo.lock");
    let version = lock.split_once(&entry).and_then(|(_, rest)| rest.split('"').next()).unwrap_or("?");
    format!("{name} {version}")
}
