//! The drawings under `fixtures/`, as tests share them.

use std::fs;
use std::path::{Path, PathBuf};

use rastrum::svg::{self, usvg};
use rastrum::{Canvas, Pixmap, RenderSettings, Transform};

/// The path of something in this repository.
pub(crate) fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The names of all fixtures, sorted: paths below `fixtures/`, with slashes, without the ending `.svg`.
pub(crate) fn all() -> Vec<String> {
    let names = names(&repository("fixtures"), "svg");
    assert!(!names.is_empty(), "no fixtures were found");
    names
}

/// The names of all files below a folder that end in `.{ending}`: sorted, with slashes, without the ending.
pub(crate) fn names(root: &Path, ending: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == ending) {
                let name = path.with_extension("");
                let parts = name.strip_prefix(root).unwrap().iter().map(|part| part.to_str().unwrap());
                names.push(parts.collect::<Vec<_>>().join("/"));
            }
        }
    }
    names.sort();
    names
}

/// Parses a fixture.
pub(crate) fn parse(name: &str) -> usvg::Tree {
    let bytes = fs::read(repository("fixtures").join(format!("{name}.svg"))).unwrap();
    svg::parse(&bytes, &usvg::Options::default()).unwrap_or_else(|error| panic!("fixtures/{name}.svg: {error}"))
}

/// Draws a fixture at its own size. What rastrum does not draw has no place in one.
pub(crate) fn render(name: &str, tree: &usvg::Tree, settings: RenderSettings) -> Pixmap {
    let size = tree.size().to_int_size();
    let mut canvas = Canvas::with_settings(size.width(), size.height(), settings).unwrap();
    let warnings = svg::render(tree, Transform::IDENTITY, &mut canvas);
    assert!(warnings.is_empty(), "fixtures/{name}.svg is not drawn whole: {warnings:?}");
    canvas.into_pixmap()
}
