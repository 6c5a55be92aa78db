//! From the command line's inputs and output to pairs of files, checked before anything is drawn.

use std::collections::{HashMap, HashSet};
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

use crate::report::Failure;

/// One picture to draw.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Job {
    /// The SVG file; `None` is standard input.
    pub(crate) input: Option<PathBuf>,
    /// The PNG file; `None` is standard output.
    pub(crate) output: Option<PathBuf>,
}

impl Job {
    /// The input as messages name it.
    pub(crate) fn name(&self) -> String {
        self.input.as_ref().map_or_else(|| "standard input".to_owned(), |path| path.display().to_string())
    }
}

/// An input file and where it lay below the folder that was given for it.
struct Source {
    /// `None` is standard input.
    path: Option<PathBuf>,
    below: PathBuf,
}

/// The jobs of a command line, in its order, folders in the order of their names.
pub(crate) fn plan(inputs: &[OsString], output: Option<&OsStr>) -> Result<Vec<Job>, Failure> {
    let mut sources = Vec::new();
    for input in inputs {
        find(input, &mut sources)?;
    }
    // `*.svg icon.svg` names icon.svg twice and means it once.
    let mut seen = HashSet::new();
    sources.retain(|source| seen.insert(source.path.clone()));
    let jobs = sources
        .iter()
        .map(|source| Ok(Job { input: source.path.clone(), output: target(source, output, sources.len())? }))
        .collect::<Result<Vec<_>, Failure>>()?;
    check(&jobs)?;
    Ok(jobs)
}

/// Names of the standard streams. A worker has others of its own, through which it is told what to draw: it must not open them by
/// these names.
const STANDARD_INPUT: [&str; 4] = ["-", "/dev/stdin", "/dev/fd/0", "/proc/self/fd/0"];
const STANDARD_OUTPUT: [&str; 4] = ["-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];

/// Whether an output's name means the program's own output.
pub(crate) fn is_standard_output(name: &OsStr) -> bool {
    STANDARD_OUTPUT.iter().any(|other| name == *other)
}

fn find(input: &OsStr, sources: &mut Vec<Source>) -> Result<(), Failure> {
    let path = Path::new(input);
    if STANDARD_INPUT.iter().any(|name| input == *name) {
        sources.push(Source { path: None, below: PathBuf::new() });
    } else if path.is_dir() {
        let before = sources.len();
        search(path, sources)?;
        if sources.len() == before {
            return Err(Failure::new(format!("{}: the folder holds no .svg or .svgz file", path.display())));
        }
    } else if let Some(pattern) = input.to_str().filter(|text| text.contains(['*', '?', '[']) && !path.exists()) {
        let paths = glob::glob(pattern).map_err(|error| Failure::new(format!("{pattern}: {error}")))?;
        let before = sources.len();
        for path in paths {
            let path = path.map_err(|error| Failure::new(error.to_string()))?;
            if !path.is_dir() {
                sources.push(Source { path: Some(path), below: PathBuf::new() });
            }
        }
        if sources.len() == before {
            return Err(Failure::new(format!("{pattern}: no file matches")));
        }
    } else {
        sources.push(Source { path: Some(path.to_owned()), below: PathBuf::new() });
    }
    Ok(())
}

/// The SVG files of a folder and of those below it. Links to folders are not followed: they may go
/// round in circles.
fn search(root: &Path, sources: &mut Vec<Source>) -> Result<(), Failure> {
    let fail = |path: &Path, error: std::io::Error| Failure::new(format!("{}: {error}", path.display()));
    let mut found = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(below) = folders.pop() {
        // Joining an empty path would add a slash to the names in messages.
        let folder = if below.as_os_str().is_empty() { root.to_owned() } else { root.join(&below) };
        for entry in fs::read_dir(&folder).map_err(|error| fail(&folder, error))? {
            let entry = entry.map_err(|error| fail(&folder, error))?;
            let kind = entry.file_type().map_err(|error| fail(&entry.path(), error))?;
            let ending = Path::new(&entry.file_name()).extension().map(OsStr::to_ascii_lowercase);
            if kind.is_dir() {
                folders.push(below.join(entry.file_name()));
            } else if ending.is_some_and(|ending| ending == "svg" || ending == "svgz") && !entry.path().is_dir() {
                found.push(Source { path: Some(entry.path()), below: below.clone() });
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    sources.extend(found);
    Ok(())
}

/// Where the picture of `source`, one of `count`, goes.
fn target(source: &Source, output: Option<&OsStr>, count: usize) -> Result<Option<PathBuf>, Failure> {
    let Some(output) = output else {
        return Ok(source.path.as_ref().map(|path| path.with_extension("png")));
    };
    if is_standard_output(output) {
        return if count == 1 {
            Ok(None)
        } else {
            Err(Failure::new("-o -: several pictures do not fit into standard output; pass one input, or {stem} in -o"))
        };
    }
    let stem = source.path.as_ref().and_then(|path| path.file_stem()).unwrap_or(OsStr::new("stdin"));
    if let Some(path) = fill(output, stem, source.path.as_deref())? {
        return Ok(Some(path));
    }
    let is_folder = Path::new(output).is_dir() || output.to_str().is_some_and(|text| text.ends_with(['/', '\\']));
    if is_folder {
        let mut name = stem.to_owned();
        name.push(".png");
        return Ok(Some(Path::new(output).join(&source.below).join(name)));
    }
    if count > 1 {
        let output = output.display();
        return Err(Failure::new(format!(
            "-o {output}: {count} inputs and one output; put {{stem}} into its name, as in '{{stem}}.png', or name a folder"
        )));
    }
    Ok(Some(PathBuf::from(output)))
}

/// The output's name with `{stem}` and `{dir}` filled in, or `None` if it has no braces.
fn fill(output: &OsStr, stem: &OsStr, input: Option<&Path>) -> Result<Option<PathBuf>, Failure> {
    let Some(mut rest) = output.to_str().filter(|text| text.contains('{')) else { return Ok(None) };
    let folder = match input.and_then(Path::parent) {
        Some(folder) if !folder.as_os_str().is_empty() => folder.as_os_str(),
        _ => OsStr::new("."),
    };
    let mut name = OsString::new();
    while let Some((before, after)) = rest.split_once('{') {
        name.push(before);
        rest = if let Some(after) = after.strip_prefix("stem}") {
            name.push(stem);
            after
        } else if let Some(after) = after.strip_prefix("dir}") {
            name.push(folder);
            after
        } else {
            return Err(Failure::new(format!(
                "-o {}: only {{stem}} and {{dir}} can stand in braces",
                output.display()
            )));
        };
    }
    name.push(rest);
    Ok(Some(PathBuf::from(name)))
}

/// Refuses plans in which a picture would overwrite another or an input.
fn check(jobs: &[Job]) -> Result<(), Failure> {
    let inputs: HashMap<PathBuf, &Job> =
        jobs.iter().filter_map(|job| Some((identity(job.input.as_deref()?), job))).collect();
    let mut outputs: HashMap<PathBuf, &Job> = HashMap::new();
    for job in jobs {
        let Some(output) = &job.output else { continue };
        let output_identity = identity(output);
        if let Some(other) = inputs.get(&output_identity) {
            return Err(Failure::new(format!(
                "{}: the picture of {} would overwrite this input; pass another -o",
                other.name(),
                job.name()
            )));
        }
        if let Some(other) = outputs.insert(output_identity, job) {
            return Err(Failure::new(format!(
                "{}: both {} and {} would be written here; put {{stem}} or {{dir}} into -o to tell them apart",
                output.display(),
                other.name(),
                job.name()
            )));
        }
    }
    Ok(())
}

/// One path for all the ways to write it, as far as its folder exists.
fn identity(path: &Path) -> PathBuf {
    let resolve = || {
        if path.exists() {
            return fs::canonicalize(path).ok();
        }
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(fs::canonicalize(folder).ok()?.join(path.file_name()?))
    };
    resolve().or_else(|| std::path::absolute(path).ok()).unwrap_or_else(|| path.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outputs(inputs: &[&str], output: Option<&str>) -> Result<Vec<String>, String> {
        let inputs: Vec<_> = inputs.iter().map(OsString::from).collect();
        let show = |job: Job| job.output.map_or("-".to_owned(), |path| path.display().to_string().replace('\\', "/"));
        plan(&inputs, output.map(OsStr::new))
            .map(|jobs| jobs.into_iter().map(show).collect())
            .map_err(|failure| failure.to_string())
    }

    #[test]
    fn outputs_follow_the_input_or_the_pattern() {
        assert_eq!(outputs(&["no/a.svg"], None).unwrap(), ["no/a.png"]);
        assert_eq!(outputs(&["-"], None).unwrap(), ["-"]);
        assert_eq!(outputs(&["no/a.svg"], Some("-")).unwrap(), ["-"]);
        assert_eq!(outputs(&["/dev/stdin"], Some("/dev/stdout")).unwrap(), ["-"]);
        assert_eq!(outputs(&["/dev/fd/0"], None).unwrap(), ["-"]);
        assert_eq!(outputs(&["no/a.svg"], Some("b.png")).unwrap(), ["b.png"]);
        assert_eq!(
            outputs(&["no/a.svg", "b.svgz"], Some("{dir}/{stem}@2x.png")).unwrap(),
            ["no/a@2x.png", "./b@2x.png"]
        );
        assert_eq!(outputs(&["-"], Some("{stem}.png")).unwrap(), ["stdin.png"]);
        assert_eq!(outputs(&["no/a.svg", "b.svg"], Some("out/")).unwrap(), ["out/a.png", "out/b.png"]);
    }

    #[test]
    fn an_input_named_twice_is_drawn_once() {
        assert_eq!(outputs(&["a.svg", "a.svg"], None).unwrap(), ["a.png"]);
    }

    #[test]
    fn plans_that_would_lose_a_picture_are_refused() {
        for (inputs, output) in [
            (["no/a.svg", "b.svg"], Some("out.png")),
            (["no/a.svg", "b.svg"], Some("-")),
            (["no/a.svg", "a.svg"], Some("{stem}.png")),
            (["a.svg", "a.svgz"], None),
            (["a.svg", "b.svg"], Some("{name}.png")),
            (["a.svg", "b.svg"], Some("a.svg")),
        ] {
            assert!(outputs(&inputs, output).is_err(), "{inputs:?} {output:?}");
        }
        assert!(outputs(&["a.svg"], Some("./a.svg")).unwrap_err().contains("overwrite this input"));
        assert!(outputs(&["no-such-*.svg"], None).unwrap_err().contains("no file matches"));
    }
}
