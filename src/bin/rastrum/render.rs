//! `rastrum render`.

use std::any::Any;
use std::fs;
use std::io::{self, IsTerminal as _, Read as _};
use std::panic::{self, AssertUnwindSafe};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

use rastrum::svg::{self, usvg};
use rastrum::{Canvas, Error, Pixmap, RenderSettings, Transform};

use crate::args::RenderArguments;
use crate::fonts::Fonts;
use crate::notes;
use crate::plan::{self, Job};
use crate::report::{self, Failure, Outcome};
use crate::reports::{Done, Reports};
use crate::size::Size;

/// Stack of a thread that parses: usvg recurses into nested elements. Untouched pages cost nothing.
const STACK: usize = 64 << 20;

/// The most bytes read of one input, as many as a packed one may unpack to.
const LARGEST_INPUT: u64 = 256 << 20;

/// Draws every input.
pub(crate) fn run(arguments: &RenderArguments) -> Result<Outcome, Failure> {
    let jobs = plan::plan(&arguments.inputs, arguments.output.as_deref())?;
    if jobs.iter().any(|job| job.output.is_none()) && io::stdout().is_terminal() {
        return Err(Failure::new("standard output is a terminal; pass -o FILE, or send it to a file or a program"));
    }
    let fonts = Fonts::new(&arguments.fonts)?;
    notes::collect();
    // A panic is told as this program tells problems, by the thread that waits for the result.
    panic::set_hook(Box::new(|_| {}));

    let processors = thread::available_parallelism().map_or(1, usize::from);
    let workers = arguments.jobs.map_or(processors, usize::from).min(jobs.len());
    let settings = RenderSettings {
        threads: arguments.threads.unwrap_or(if workers > 1 { 1 } else { 0 }),
        ..RenderSettings::default()
    };
    let mut reports = Reports::new(arguments, &jobs);
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for _ in 0..workers {
            let sender = sender.clone();
            let (jobs, next, fonts, settings) = (&jobs, &next, &fonts, &settings);
            let work = move || {
                while let Some((index, job)) = take(jobs, next) {
                    let result = guarded(job, || draw(job, arguments, fonts, *settings));
                    if sender.send((index, result)).is_err() {
                        break;
                    }
                }
            };
            thread::Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, work)
                .map_err(|error| Failure::new(format!("no thread to draw on: {error}; try -j 1")))?;
        }
        // The channel ends when the last worker drops its sender.
        drop(sender);
        for (index, result) in receiver {
            reports.add(index, result);
        }
        Ok(())
    })?;
    reports.finish()
}

fn take<'j>(jobs: &'j [Job], next: &AtomicUsize) -> Option<(usize, &'j Job)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    Some((index, jobs.get(index)?))
}

/// Runs `work`; a panic in it, which is this program's fault, becomes a failure like any other.
fn guarded(job: &Job, work: impl FnOnce() -> Result<Done, Failure>) -> Result<Done, Failure> {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload: Box<dyn Any + Send>| {
        let text = payload.downcast_ref::<&str>().map(ToString::to_string);
        let text = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_default();
        Err(Failure::new(format!("{}: an internal error, not the file's fault: {text}; please report it", job.name())))
    })
}

/// Reads, parses, draws and writes one file.
fn draw(job: &Job, arguments: &RenderArguments, fonts: &Fonts<'_>, settings: RenderSettings) -> Result<Done, Failure> {
    let fail = |text: String| Failure::new(format!("{}: {text}", job.name()));
    let started = Instant::now();
    // A file that failed on this thread may have left some.
    notes::take();
    let bytes = read(job.input.as_deref()).map_err(fail)?;
    let options = options(job, arguments, fonts);
    let tree = svg::parse(&bytes, &options).map_err(|error| fail(error.to_string()))?;
    let mut warnings = notes::take();
    let parsed = Instant::now();

    let (pixmap, more) = picture(&tree, arguments, settings).map_err(fail)?;
    warnings.extend(more);
    let drawn = Instant::now();

    match &job.output {
        Some(path) => save(&pixmap, path, arguments)?,
        None => report::print(&pixmap.encode_png().map_err(|error| fail(error.to_string()))?)?,
    }
    Ok(Done {
        width: pixmap.width(),
        height: pixmap.height(),
        parse: parsed - started,
        draw: drawn - parsed,
        encode: drawn.elapsed(),
        warnings,
    })
}

fn read(path: Option<&Path>) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = match path {
        None => io::stdin().lock().take(LARGEST_INPUT + 1).read_to_end(&mut bytes),
        Some(path) if path.is_dir() => return Err("is a folder".to_owned()),
        Some(path) => fs::File::open(path).and_then(|file| {
            // Room for all of it at once; a device or pipe has no length.
            let length = file.metadata().map_or(0, |data| data.len()).min(LARGEST_INPUT);
            bytes.try_reserve_exact(length as usize + 1).map_err(io::Error::other)?;
            file.take(LARGEST_INPUT + 1).read_to_end(&mut bytes)
        }),
    };
    read.map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => "no such file; check its name and folder".to_owned(),
        io::ErrorKind::PermissionDenied => "may not be read; check its permissions".to_owned(),
        _ => error.to_string(),
    })?;
    if bytes.len() as u64 > LARGEST_INPUT {
        return Err("is over the limit of 256 MiB".to_owned());
    }
    if bytes.is_empty() {
        return Err("is empty; an SVG was expected".to_owned());
    }
    Ok(bytes)
}

fn options<'f>(job: &Job, arguments: &RenderArguments, fonts: &'f Fonts<'_>) -> usvg::Options<'f> {
    let resources_dir = arguments.resources_dir.clone().or_else(|| {
        let folder = fs::canonicalize(job.input.as_ref()?).ok()?;
        folder.parent().map(Path::to_owned)
    });
    let side = |pixels: Option<u32>| pixels.map_or(100.0, |pixels| pixels as f32);
    let mut options = usvg::Options {
        resources_dir,
        dpi: arguments.dpi as f32,
        font_resolver: fonts.resolver(),
        image_href_resolver: svg::image_resolver(notes::add),
        ..usvg::Options::default()
    };
    // Only a drawing without a size of its own asks for this one.
    if let Some(size) = usvg::Size::from_wh(side(arguments.width), side(arguments.height)) {
        options.default_size = size;
    }
    options
}

/// Draws the tree, or one element of it, and says what was left out.
fn picture(
    tree: &usvg::Tree,
    arguments: &RenderArguments,
    settings: RenderSettings,
) -> Result<(Pixmap, Vec<String>), String> {
    let element = match &arguments.export_id {
        Some(id) => {
            let node = tree.node_by_id(id).ok_or_else(|| format!("no element that is drawn has the id '{id}'"))?;
            let area = node.abs_layer_bounding_box().ok_or_else(|| format!("element '{id}' has no area"))?;
            Some((node, area))
        }
        None => None,
    };
    let (width, height) = match &element {
        Some((_, area)) => (area.width(), area.height()),
        None => (tree.size().width(), tree.size().height()),
    };
    let size = Size::of(arguments, width, height);
    let mut canvas = Canvas::with_settings(size.width, size.height, settings)
        .map_err(|error| format!("{error}; try a smaller --width, --height or --zoom"))?;
    if let Some(color) = arguments.background {
        canvas.clear(color);
    }
    let scale = Transform::from_scale(size.scale, size.scale);
    let how = svg::Settings::default().with_antialias(arguments.antialias);
    let warnings = match element {
        Some((node, area)) => {
            let transform = scale.pre_concat(Transform::from_translate(-area.x(), -area.y()));
            svg::render_node(node, transform, &how, &mut canvas)
        }
        None => svg::render_with(tree, scale, &how, &mut canvas),
    };
    Ok((canvas.into_pixmap(), warnings.iter().map(ToString::to_string).collect()))
}

fn save(pixmap: &Pixmap, path: &Path, arguments: &RenderArguments) -> Result<(), Failure> {
    let fail = |text: String| Failure::new(format!("{}: {text}", path.display()));
    // A single named file in a folder that is not there is more likely a slip than a wish.
    let is_pattern = arguments.output.as_ref().is_some_and(|output| {
        output.to_str().is_some_and(|text| text.contains('{') || text.ends_with(['/', '\\']))
            || Path::new(output).is_dir()
    });
    if let (true, Some(folder)) = (is_pattern, path.parent()) {
        fs::create_dir_all(folder).map_err(|error| fail(format!("its folder cannot be made: {error}")))?;
    }
    pixmap.save_png(path).map_err(|error| {
        fail(match error {
            Error::Io { source, .. } => match source.kind() {
                io::ErrorKind::NotFound => "cannot be written: its folder is not there; make it first".to_owned(),
                io::ErrorKind::PermissionDenied => "may not be written; check its permissions".to_owned(),
                _ if path.is_dir() => "cannot be written: it is a folder".to_owned(),
                _ => format!("cannot be written: {source}"),
            },
            error => error.to_string(),
        })
    })
}
