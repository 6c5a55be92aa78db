//! `rastrum gallery`, its files, and its page in a browser.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use rastrum::Pixmap;

/// Every row of the checklist that is drawn.
const ROWS: std::ops::RangeInclusive<u32> = 1..=142;

/// A folder of its own, gone afterwards.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("rastrum-gallery-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn gallery(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rastrum"));
        command.current_dir(&self.0).arg("gallery").args(arguments);
        command.stdin(Stdio::null()).output().unwrap()
    }

    /// The files of a folder within, by name.
    fn files(&self, name: &str) -> BTreeMap<String, Vec<u8>> {
        let entries = fs::read_dir(self.0.join(name)).unwrap().map(|entry| entry.unwrap());
        entries.map(|e| (e.file_name().into_string().unwrap(), fs::read(e.path()).unwrap())).collect()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// What stands between `before` and the next quote, each time.
fn quoted<'a>(text: &'a str, before: &str) -> Vec<&'a str> {
    text.split(before).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn every_row_has_a_picture_of_its_own_and_the_page_shows_them_all() {
    let folder = Folder::new("all");
    let output = folder.gallery(&["one", "--threads", "1"]);
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    let files = folder.files("one");
    let names: BTreeSet<String> = ROWS.map(|row| format!("{row:03}.png")).collect();
    let expected: BTreeSet<String> = names.iter().cloned().chain(["index.html".to_owned()]).collect();
    assert_eq!(files.keys().cloned().collect::<BTreeSet<_>>(), expected);
    let mut seen = BTreeMap::new();
    for name in &names {
        let picture = Pixmap::decode_png(&files[name]).unwrap();
        let pixels = picture.data().as_chunks::<4>().0;
        let mut counts = BTreeMap::new();
        pixels.iter().for_each(|pixel| *counts.entry(*pixel).or_insert(0_usize) += 1);
        let most = counts.values().max().unwrap();
        assert!(pixels.len() - most > 2000, "{name} shows next to nothing");
        assert!(pixels.iter().all(|pixel| pixel[3] == 255), "{name} is transparent");
        let other = seen.insert(picture.data().to_vec(), name.clone());
        assert!(other.is_none(), "{name} is {other:?}");
    }
    let page = String::from_utf8(files["index.html"].clone()).unwrap();
    let shown: Vec<String> = quoted(&page, "src=\"").into_iter().map(str::to_owned).collect();
    assert_eq!((shown.iter().cloned().collect(), shown.len()), (names.clone(), names.len()));
    let alts = quoted(&page, "alt=\"");
    assert!(alts.len() == names.len() && alts.iter().all(|alt| alt.len() > 40));
    for link in quoted(&page, "href=\"") {
        match link.strip_prefix('#') {
            Some(id) => assert!(page.contains(&format!("id=\"{id}\"")), "{link}"),
            None => assert!(names.contains(link), "{link}"),
        }
    }
    assert!(!page.contains("<script") && !page.contains("//") && page.contains("prefers-color-scheme:dark"));

    let output = folder.gallery(&["three", "--threads", "3"]);
    assert!(output.status.success(), "{output:?}");
    assert!(folder.files("three") == files, "threads change bytes");
}

#[test]
fn some_rows_alone() {
    let folder = Folder::new("some");
    let output = folder.gallery(&["some", "--rows", "21, 50-51"]);
    assert!(output.status.success(), "{output:?}");
    assert_eq!(folder.files("some").keys().collect::<Vec<_>>(), ["021.png", "050.png", "051.png", "index.html"]);
    // Again over what is there, with other rows: the page shows what was asked for.
    assert!(folder.gallery(&["some", "--rows", "22"]).status.success());
    let page = fs::read_to_string(folder.0.join("some/index.html")).unwrap();
    assert_eq!(quoted(&page, "src=\""), ["022.png"]);
}

#[test]
fn wrong_arguments_are_one_line_and_exit_code_2() {
    let folder = Folder::new("wrong");
    fs::write(folder.0.join("file"), b"kept").unwrap();
    for (arguments, expected) in [
        (&["file"][..], "file: is a file; name a folder"),
        (&["file/below"], "the folder cannot be made"),
        (&["out", "--rows", "9999"], "there is no row 9999"),
        (&["out", "--rows", "x"], "try 21 or 30-43"),
        (&[], "<DIR>"),
    ] {
        let output = folder.gallery(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        let text = String::from_utf8(output.stderr).unwrap();
        assert!(text.contains(expected), "{arguments:?}: {text}");
    }
    assert_eq!(fs::read(folder.0.join("file")).unwrap(), b"kept");
    assert!(!folder.0.join("out").exists());
}

/// A browser, if the machine has one.
fn browser() -> Option<PathBuf> {
    let folders: Vec<PathBuf> = std::env::split_paths(&std::env::var_os("PATH")?).collect();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name))).find(|path| path.is_file())
}

/// Runs the browser without a window; `None` if it does not end within two minutes.
fn browse(browser: &Path, folder: &Folder, arguments: &[&str]) -> Option<String> {
    let mut command = Command::new(browser);
    command.current_dir(&folder.0).args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars"]);
    command.arg(format!("--user-data-dir={}", folder.0.join("profile").display())).args(arguments);
    let out = fs::File::create(folder.0.join("dom.txt")).unwrap();
    let mut child = command.stdin(Stdio::null()).stdout(out).stderr(Stdio::null()).spawn().unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            child.wait().unwrap();
            return None;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Some(fs::read_to_string(folder.0.join("dom.txt")).unwrap())
}

#[test]
fn the_page_in_a_browser() {
    let Some(browser) = browser() else {
        eprintln!("skipped: no chromium, chromium-browser or google-chrome in PATH");
        return;
    };
    let folder = Folder::new("browser");
    assert!(folder.gallery(&["pages"]).status.success());
    let at = |name: &str| format!("file://{}", folder.0.join("pages").join(name).display());
    let screenshot = format!("--screenshot={}", folder.0.join("page.png").display());
    browse(&browser, &folder, &["--window-size=1200,1600", &screenshot, &at("index.html")])
        .expect("a screenshot in time");
    let picture = Pixmap::load_png(folder.0.join("page.png")).unwrap();
    let colors: BTreeSet<_> = picture.data().as_chunks::<4>().0.iter().collect();
    assert!(colors.len() > 100, "the page is blank: {} colours", colors.len());

    // A copy that tells the frame around it, as wide as a phone, what it found.
    let page = fs::read_to_string(folder.0.join("pages/index.html")).unwrap();
    let script = "<script>onload=()=>{const all=[...document.images],root=document.documentElement;\
        parent.postMessage([all.length,all.filter(i=>i.naturalWidth==640).length,root.scrollWidth,innerWidth,\
        Math.min(...all.map(i=>i.getBoundingClientRect().width))].join(' '),'*')}</script></body>";
    fs::write(folder.0.join("pages/inner.html"), page.replace("</body>", script)).unwrap();
    let outer = "<body><iframe src=inner.html width=400 height=800 style='border:0'></iframe><script>\
        onmessage=e=>{document.body.innerHTML='<p>found '+e.data+' end</p>'}</script>";
    fs::write(folder.0.join("pages/outer.html"), outer).unwrap();
    let arguments = ["--window-size=800,900", "--virtual-time-budget=20000", "--dump-dom", &at("outer.html")];
    let dom = browse(&browser, &folder, &arguments).expect("a page in time");
    let found =
        dom.split("found ").nth(1).and_then(|rest| rest.split(" end").next()).unwrap_or_else(|| panic!("{dom}"));
    let numbers: Vec<f64> = found.split(' ').map(|number| number.parse().unwrap()).collect();
    let rows = ROWS.count() as f64;
    assert_eq!(numbers[..2], [rows, rows], "pictures that the page has, and that were loaded");
    assert_eq!(numbers[3], 400.0);
    assert!(numbers[2] <= 400.0, "the page is {} wide in a window of 400", numbers[2]);
    assert!(numbers[4] > 330.0, "pictures are {} wide in a window of 400", numbers[4]);
}
