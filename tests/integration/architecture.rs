//! Folders are floors: a module uses only floors beneath it.

use std::fs;
use std::path::{Path, PathBuf};

/// From the ground up. Modules of one floor do not use each other.
const FLOORS: [&[&str]; 10] = [
    &["num", "error", "pool"],
    &["geom"],
    &["color", "style"],
    &["path", "surface"],
    &["raster", "space", "paint", "blend", "codec"],
    &["filter", "scene"],
    &["display_list", "load"],
    &["render"],
    &["canvas"],
    &["svg"],
];

fn floor(module: &str) -> Option<usize> {
    FLOORS.iter().position(|modules| modules.contains(&module))
}

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

fn rust_files(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            rust_files(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// The names after each `crate::` in a source text, outside of comments and of tests at the file's end.
fn used(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    lines
        .flat_map(|line| line.split("crate::").skip(1))
        .map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect())
        .collect()
}

#[test]
fn modules_use_only_floors_beneath_them() {
    let mut files = Vec::new();
    rust_files(&source(), &mut files);
    let mut faults = Vec::new();
    let mut seen = 0;
    for file in files {
        let relative = file.strip_prefix(source()).unwrap();
        let module = relative.components().next().unwrap().as_os_str().to_string_lossy();
        let module = module.strip_suffix(".rs").unwrap_or(&module);
        if ["lib", "bin"].contains(&module) || relative.components().any(|part| part.as_os_str() == "tests") {
            continue;
        }
        let Some(own) = floor(module) else {
            faults
                .push(format!("{}: the module {module} stands on no floor; name it in this test", relative.display()));
            continue;
        };
        for name in used(&fs::read_to_string(&file).unwrap()) {
            seen += 1;
            match floor(&name) {
                _ if name == module => {}
                Some(other) if other < own => {}
                Some(_) => {
                    faults.push(format!("{}: {module} uses {name}, which is not beneath it", relative.display()))
                }
                // A macro or a grouped import: write the module's own path, so that this test can read it.
                None => faults.push(format!("{}: `crate::{name}` names no floor", relative.display())),
            }
        }
    }
    assert!(faults.is_empty(), "\n{}", faults.join("\n"));
    assert!(seen > 200, "the test reads no imports any more: {seen}");
}

#[test]
fn the_program_sees_the_public_api_alone() {
    let mut files = Vec::new();
    rust_files(&source().join("bin"), &mut files);
    let floors: Vec<&str> = FLOORS.iter().flat_map(|modules| modules.iter().copied()).collect();
    let declared = fs::read_to_string(source().join("bin/rastrum/main.rs")).unwrap();
    for file in files {
        let names = used(&fs::read_to_string(&file).unwrap());
        for name in names {
            let own = declared.contains(&format!("mod {name};"));
            assert!(own || !floors.contains(&name.as_str()), "{}: reaches into crate::{name}", file.display());
        }
    }
}
