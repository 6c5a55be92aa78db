//! One file: read, parsed, drawn and written.

use std::fs;
use std::io::{self, Read as _};
use std::path::Path;
use std::time::Instant;

use rastrum::svg::{self, usvg};
use rastrum::{Canvas, Error, Pixmap, RenderSettings, Transform};

use crate::args::{ExportArea, RenderArguments};
use crate::fonts::Fonts;
use crate::notes;
use crate::query;
use crate::report::{self, Failure};
use crate::reports::Done;
use crate::simple;
use crate::size::Size;
use crate::wire::{Source, Task};

/// The most bytes read of one input, as many as a packed one may unpack to.
const LARGEST_INPUT: u64 = 256 << 20;

/// The most bytes of a style sheet.
const LARGEST_STYLE_SHEET: u64 = 16 << 20;

/// The most pixels of a picture that is drawn without supervision.
const FEW_PIXELS: u64 = 1 << 22;

/// And the most pixels that it has for each of its elements, any of which may blend all of them: about a second.
const LITTLE_WORK: u64 = 1 << 28;

/// Pictures of no more pixels are drawn on one thread: others would take longer to start.
const FEWEST_PIXELS: u64 = 1 << 16;

/// Does a task. The failure does not name the input.
pub(crate) fn draw(task: &Task, arguments: &RenderArguments, fonts: &Fonts<'_>) -> Result<Done, Failure> {
    let started = Instant::now();
    // A file that failed on this thread may have left some.
    notes::take();
    let bytes;
    let bytes = match &task.source {
        Source::File(path) => {
            bytes = read(path).map_err(Failure::new)?;
            &bytes
        }
        Source::Bytes(bytes) => bytes,
    };
    if bytes.is_empty() {
        return Err(Failure::new("is empty; an SVG was expected"));
    }
    let options = options(&task.source, arguments, fonts)?;
    let tree = svg::parse_with_limits(bytes, &options, &svg::ParseLimits::default())
        .map_err(|error| Failure::new(error.to_string()))?;
    finish(task, arguments, &tree, started)
}

/// Does a task at once if that is sure to be quick.
pub(crate) fn draw_simple(
    task: &Task,
    arguments: &RenderArguments,
    fonts: &Fonts<'_>,
) -> Option<Result<Done, Failure>> {
    let started = Instant::now();
    notes::take();
    let Source::File(path) = &task.source else { return None };
    let bytes = fs::metadata(path).ok().filter(|data| data.is_file() && data.len() <= simple::LONGEST as u64);
    let bytes = bytes.and_then(|_| fs::read(path).ok())?;
    if arguments.stylesheet.is_some() {
        return None;
    }
    let elements = simple::elements(&bytes)? as u64;
    let options = options(&task.source, arguments, fonts).ok()?;
    let tree = svg::parse(&bytes, &options).ok()?;
    let area = area(&tree, arguments).ok()?;
    let size = Size::of(arguments, area.width(), area.height());
    let pixels = u64::from(size.width) * u64::from(size.height);
    (pixels <= FEW_PIXELS && pixels * elements <= LITTLE_WORK).then(|| finish(task, arguments, &tree, started))
}

/// Draws and writes what was parsed.
fn finish(task: &Task, arguments: &RenderArguments, tree: &usvg::Tree, started: Instant) -> Result<Done, Failure> {
    let mut warnings = notes::take();
    let parsed = Instant::now();
    if let Some(format) = arguments.query_all {
        let output = query::elements(tree, format).into_bytes();
        let draw = std::time::Duration::ZERO;
        return Ok(Done { width: 0, height: 0, parse: parsed - started, draw, encode: draw, warnings, output });
    }

    let (pixmap, more) = picture(tree, arguments, task.threads).map_err(Failure::new)?;
    warnings.extend(more);
    let drawn = Instant::now();

    let mut output = Vec::new();
    match &task.output {
        Some(path) => save(&pixmap, path, arguments)?,
        None => output = pixmap.encode_png().map_err(|error| Failure::new(error.to_string()))?,
    }
    Ok(Done {
        width: pixmap.width(),
        height: pixmap.height(),
        parse: parsed - started,
        draw: drawn - parsed,
        encode: drawn.elapsed(),
        warnings,
        output,
    })
}

/// What standard input holds.
pub(crate) fn read_input() -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    io::stdin().lock().take(LARGEST_INPUT + 1).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    within(bytes, LARGEST_INPUT)
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    if path.is_dir() {
        return Err("is a folder".to_owned());
    }
    read_file(path, LARGEST_INPUT)
}

fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let read = fs::File::open(path).and_then(|file| {
        // Room for all of it at once; a device or pipe has no length.
        let length = file.metadata().map_or(0, |data| data.len()).min(limit);
        bytes.try_reserve_exact(length as usize + 1).map_err(io::Error::other)?;
        file.take(limit + 1).read_to_end(&mut bytes)
    });
    read.map_err(|error| report::why_unread(&error))?;
    within(bytes, limit)
}

fn within(bytes: Vec<u8>, limit: u64) -> Result<Vec<u8>, String> {
    if bytes.len() as u64 > limit { Err(format!("is over the limit of {} MiB", limit >> 20)) } else { Ok(bytes) }
}

fn options<'f>(
    source: &Source,
    arguments: &RenderArguments,
    fonts: &'f Fonts<'_>,
) -> Result<usvg::Options<'f>, Failure> {
    let resources_dir = arguments.resources_dir.clone().or_else(|| match source {
        Source::File(path) => fs::canonicalize(path).ok()?.parent().map(Path::to_owned),
        Source::Bytes(_) => None,
    });
    let style_sheet = match &arguments.stylesheet {
        Some(path) => {
            let fail = |text: String| Failure::new(format!("style sheet {}: {text}", path.display()));
            let bytes = read_file(path, LARGEST_STYLE_SHEET).map_err(fail)?;
            Some(String::from_utf8(bytes).map_err(|_| fail("is not UTF-8".to_owned()))?)
        }
        None => None,
    };
    let side = |pixels: Option<u32>| pixels.map_or(100.0, |pixels| pixels as f32);
    let mut options = usvg::Options {
        resources_dir,
        dpi: arguments.dpi as f32,
        languages: arguments.languages.clone(),
        style_sheet,
        font_resolver: fonts.resolver(),
        image_href_resolver: svg::image_resolver(notes::add),
        ..usvg::Options::default()
    };
    // Only a drawing without a size of its own asks for this one.
    if let Some(size) = usvg::Size::from_wh(side(arguments.width), side(arguments.height)) {
        options.default_size = size;
    }
    Ok(options)
}

/// Draws the tree, or one element of it, and says what was left out.
fn picture(tree: &usvg::Tree, arguments: &RenderArguments, threads: usize) -> Result<(Pixmap, Vec<String>), String> {
    let element = element(tree, arguments)?;
    let area = area(tree, arguments)?;
    let size = Size::of(arguments, area.width(), area.height());
    let few = u64::from(size.width) * u64::from(size.height) <= FEWEST_PIXELS;
    let settings = RenderSettings { threads: if few { 1 } else { threads }, ..RenderSettings::default() };
    let mut canvas = Canvas::with_settings(size.width, size.height, settings)
        .map_err(|error| format!("{error}; try a smaller --width, --height or --zoom"))?;
    if let Some(color) = arguments.background {
        canvas.clear(color);
    }
    let scale = Transform::from_scale(size.scale, size.scale);
    let transform = scale.pre_concat(Transform::from_translate(-area.x(), -area.y()));
    let how = svg::Settings::default().with_antialias(arguments.antialias);
    let warnings = match element {
        Some(node) => svg::render_node(node, transform, &how, &mut canvas),
        None => svg::render_with(tree, transform, &how, &mut canvas),
    };
    let mut warnings: Vec<String> = warnings.iter().map(ToString::to_string).collect();
    if let Err(error) = canvas.flush() {
        warnings.push(format!("a filter is left out: {error}"));
    }
    Ok((canvas.into_pixmap(), warnings))
}

/// The one element that is asked for, if one is.
fn element<'t>(tree: &'t usvg::Tree, arguments: &RenderArguments) -> Result<Option<&'t usvg::Node>, String> {
    match &arguments.export_id {
        Some(id) => tree.node_by_id(id).map(Some).ok_or_else(|| format!("no element that is drawn has the id '{id}'")),
        None => Ok(None),
    }
}

/// What the picture shows.
fn area(tree: &usvg::Tree, arguments: &RenderArguments) -> Result<usvg::Rect, String> {
    let page = usvg::Rect::from_xywh(0.0, 0.0, tree.size().width(), tree.size().height());
    let area = match (arguments.export_area, element(tree, arguments)?) {
        (Some(ExportArea::Page), _) | (None, None) => page,
        (Some(ExportArea::Drawing), None) => Some(tree.root().abs_layer_bounding_box().to_rect()),
        (_, Some(node)) => {
            let area = query::drawn_box(node);
            if !(area.width() > 0.0 && area.height() > 0.0) {
                return Err(format!("element '{}' has no area", node.id()));
            }
            Some(area)
        }
    };
    area.ok_or_else(|| "the drawing has no area".to_owned())
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
