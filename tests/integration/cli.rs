//! The program, driven as a user would.

use std::fs;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use flate2::Compression;
use flate2::write::GzEncoder;
use rastrum::Pixmap;

const RED: [u8; 4] = [255, 0, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

/// A folder of its own for each test, gone afterwards.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("rastrum-cli-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> &Self {
        let path = self.0.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
        self
    }

    fn read(&self, name: &str) -> Pixmap {
        Pixmap::load_png(self.0.join(name)).unwrap()
    }

    fn has(&self, name: &str) -> bool {
        self.0.join(name).exists()
    }

    /// The names of the files directly in the folder, sorted.
    fn names(&self) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(&self.0).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rastrum"));
        command.current_dir(&self.0).args(arguments).stdin(Stdio::null());
        command
    }

    fn run(&self, arguments: &[&str]) -> Output {
        self.command(arguments).output().unwrap()
    }

    fn run_with_input(&self, arguments: &[&str], input: &[u8]) -> Output {
        let mut command = self.command(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(input).unwrap();
        child.wait_with_output().unwrap()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// 4 × 2 pixels, red on the left, blue on the right.
const FLAG: &str = "<svg xmlns='http://www.w3.org/2000/svg' width='4' height='2'>\
    <rect width='2' height='2' fill='red'/><rect id='right' x='2' width='2' height='2' fill='blue'/></svg>";

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

#[track_caller]
fn assert_flag(pixmap: &Pixmap, width: u32, height: u32) {
    assert_eq!((pixmap.width(), pixmap.height()), (width, height));
    assert_eq!(pixmap.pixel(0, 0), Some(RED));
    assert_eq!(pixmap.pixel(width - 1, height - 1), Some(BLUE));
}

#[track_caller]
fn assert_success(output: &Output) {
    assert!(output.status.success(), "{output:?}");
    assert_eq!(text(&output.stderr), "");
}

/// The command failed as a whole, with one line that begins with `rastrum: ` and holds `part`.
#[track_caller]
fn assert_failure(output: &Output, part: &str) {
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    let line = text(&output.stderr);
    assert!(line.starts_with("rastrum: ") && line.ends_with('\n') && line.lines().count() == 1, "{line:?}");
    assert!(line.contains(part), "{line:?} lacks {part:?}");
    assert_eq!(text(&output.stdout), "");
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

#[test]
fn the_picture_goes_beside_the_input() {
    let folder = Folder::new();
    let output = folder.write("a.svg", FLAG).run(&["render", "a.svg"]);
    assert_success(&output);
    assert_flag(&folder.read("a.png"), 4, 2);
    assert_eq!(folder.names(), ["a.png", "a.svg"], "and nothing else stays behind");
}

#[test]
fn sizes_keep_the_aspect() {
    let folder = Folder::new();
    folder.write("a.svg", FLAG);
    for (arguments, width, height) in [
        (["-w", "40", "--width", ""].as_slice(), 40, 20),
        (&["-H", "10"], 20, 10),
        (&["-w", "100", "-H", "10"], 20, 10),
        (&["-z", "2.5"], 10, 5),
    ] {
        let arguments: Vec<_> =
            ["render", "a.svg", "-o", "out.png"].iter().chain(arguments.iter().take(4)).copied().collect();
        let arguments: Vec<_> = arguments.into_iter().filter(|a| !a.is_empty() && *a != "--width").collect();
        assert_success(&folder.run(&arguments));
        assert_flag(&folder.read("out.png"), width, height);
    }
    assert_failure(&folder.run(&["render", "a.svg", "-w", "99999"]), "smaller --width");
}

#[test]
fn the_background_lies_behind() {
    let folder = Folder::new();
    folder.write("a.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='2' height='2'/>");
    assert_success(&folder.run(&["render", "a.svg", "-b", "rgba(255, 0, 0, 0.2)"]));
    // 0.2 of 255 is 51; straight red comes back from it.
    assert_eq!(folder.read("a.png").to_straight()[..4], [255, 0, 0, 51]);
    let output = folder.run(&["render", "a.svg", "-b", "reddish"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn one_element_is_drawn_at_its_own_size() {
    let folder = Folder::new();
    folder.write("a.svg", FLAG);
    assert_success(&folder.run(&["render", "a.svg", "--export-id", "right"]));
    let pixmap = folder.read("a.png");
    assert_eq!((pixmap.width(), pixmap.height(), pixmap.pixel(0, 0)), (2, 2, Some(BLUE)));
    assert_failure(&folder.run(&["render", "a.svg", "--export-id", "middle"]), "'middle'");
}

#[test]
fn the_area_is_the_page_or_what_is_drawn() {
    let folder = Folder::new();
    folder.write(
        "a.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><rect id='r' x='2' y='3' width='4' height='2' fill='red'/></svg>",
    );
    for (arguments, size, at, expected) in [
        ([].as_slice(), (9, 9), (3, 4), RED),
        (&["--export-area", "page"], (9, 9), (0, 0), [0; 4]),
        (&["--export-area", "drawing"], (4, 2), (0, 0), RED),
        (&["--export-id", "r"], (4, 2), (3, 1), RED),
        (&["--export-id", "r", "--export-area", "drawing"], (4, 2), (3, 1), RED),
        (&["--export-id", "r", "--export-area", "page"], (9, 9), (5, 4), RED),
    ] {
        let arguments: Vec<_> = ["render", "a.svg"].iter().chain(arguments).copied().collect();
        assert_success(&folder.run(&arguments));
        let pixmap = folder.read("a.png");
        assert_eq!((pixmap.width(), pixmap.height()), size, "{arguments:?}");
        assert_eq!(pixmap.pixel(at.0, at.1), Some(expected), "{arguments:?}");
    }
}

#[test]
fn a_style_sheet_and_languages_apply() {
    let folder = Folder::new();
    folder.write("a.css", "rect { fill: blue }").write(
        "a.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='4' height='2'><rect width='2' height='2' fill='red'/>\
         <switch><rect systemLanguage='fr' x='2' width='2' height='2' style='fill:red'/><g/></switch></svg>",
    );
    assert_success(&folder.run(&["render", "a.svg", "--stylesheet", "a.css", "--languages", "de,fr"]));
    assert_eq!((folder.read("a.png").pixel(0, 0), folder.read("a.png").pixel(3, 1)), (Some(BLUE), Some(RED)));
    assert_success(&folder.run(&["render", "a.svg"]));
    assert_eq!((folder.read("a.png").pixel(0, 0), folder.read("a.png").pixel(3, 1)), (Some(RED), Some([0; 4])));
    assert_failure(&folder.run(&["render", "a.svg", "--stylesheet", "b.css"]), "style sheet b.css: no such file");
}

#[test]
fn elements_are_listed_with_their_boxes() {
    let folder = Folder::new();
    folder.write(
        "a.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='9' height='9'><g id='a,b' transform='translate(1.5 0)'>\
         <rect id='r' x='2' y='3' width='4' height='2' stroke='red'/></g><path d='M0 0H1V1Z'/></svg>",
    );
    let output = folder.run(&["render", "a.svg", "--query-all"]);
    assert_success(&output);
    assert_eq!(text(&output.stdout), "a\\u{2c}b,3,2.5,5,3\nr,3,2.5,5,3\n");
    assert!(!folder.has("a.png"));
    let output = folder.run(&["render", "a.svg", "--query-all=json"]);
    assert_eq!(
        text(&output.stdout),
        "[{\"id\":\"a,b\",\"x\":3,\"y\":2.5,\"width\":5,\"height\":3},{\"id\":\"r\",\"x\":3,\"y\":2.5,\"width\":5,\"height\":3}]\n"
    );
    folder.write("b.svg", FLAG);
    let output = folder.run(&["render", "a.svg", "b.svg", "--query-all"]);
    assert!(text(&output.stdout).ends_with("b.svg:right,2,0,2,2\n"), "{output:?}");
}

#[test]
fn fonts_are_listed() {
    let folder = Folder::new();
    let output = folder.run(&["render", "--list-fonts", "--no-system-fonts"]);
    assert_success(&output);
    assert_eq!(text(&output.stdout), "");
    assert_failure(&folder.run(&["render", "--list-fonts", "--font-dir", "none"]), "none");
}

#[test]
fn standard_input_to_standard_output() {
    let folder = Folder::new();
    for arguments in [["render", "-"].as_slice(), &["render", "-", "-o", "-"]] {
        let output = folder.run_with_input(arguments, FLAG.as_bytes());
        assert_success(&output);
        assert_flag(&Pixmap::decode_png(&output.stdout).unwrap(), 4, 2);
    }
    assert_failure(&folder.run_with_input(&["render", "-"], b"<svg"), "standard input");
}

#[test]
fn standard_streams_have_names_as_well() {
    let folder = Folder::new();
    folder.write("flag.svg", FLAG);
    // Drawn by the program itself, and, being larger, by a worker of it, whose standard streams lead to the program.
    for zoom in ["1", "800"] {
        let scale = zoom.parse::<u32>().unwrap();
        for (input, output, given) in
            [("/dev/stdin", "-", FLAG), ("/dev/fd/0", "/dev/stdout", FLAG), ("flag.svg", "/proc/self/fd/1", "")]
        {
            let output = folder.run_with_input(&["render", input, "-o", output, "-z", zoom], given.as_bytes());
            assert_success(&output);
            assert_flag(&Pixmap::decode_png(&output.stdout).unwrap(), 4 * scale, 2 * scale);
        }
    }
}

#[test]
fn several_inputs_take_a_pattern() {
    let folder = Folder::new();
    folder.write("in/a.svg", FLAG).write("in/b.svg", FLAG);
    assert_success(&folder.run(&["render", "in/a.svg", "in/b.svg", "-o", "{dir}/{stem}@2x.png", "-z", "2"]));
    assert_flag(&folder.read("in/a@2x.png"), 8, 4);
    assert_flag(&folder.read("in/b@2x.png"), 8, 4);
    // Quoted, so that no shell but the program reads the pattern; missing folders are made for it.
    assert_success(&folder.run(&["render", "in/*.svg", "-o", "out/{stem}.png", "-j", "2"]));
    assert_flag(&folder.read("out/b.png"), 4, 2);
}

#[test]
fn a_folder_is_searched_and_mirrored() {
    let folder = Folder::new();
    folder.write("in/a.svg", FLAG).write("in/deep/b.SVGZ", packed(FLAG.as_bytes())).write("in/notes.txt", "no SVG");
    assert_success(&folder.run(&["render", "in", "-o", "out/"]));
    assert_flag(&folder.read("out/a.png"), 4, 2);
    assert_flag(&folder.read("out/deep/b.png"), 4, 2);
    assert!(!folder.has("out/notes.png"));
    folder.write("empty/notes.txt", "no SVG");
    assert_failure(&folder.run(&["render", "empty"]), "no .svg or .svgz");
}

#[test]
fn one_bad_file_among_good_ones_is_told_and_the_others_go_on() {
    let folder = Folder::new();
    folder.write("a.svg", FLAG).write("bad.svg", "<svg").write("c.svg", FLAG);
    let output = folder.run(&["render", "a.svg", "bad.svg", "missing.svg", "c.svg"]);
    assert_eq!(output.status.code(), Some(1));
    let errors = text(&output.stderr);
    assert_eq!(errors.lines().count(), 3, "{errors}");
    assert!(errors.contains("rastrum: bad.svg: not an SVG"), "{errors}");
    assert!(errors.contains("rastrum: missing.svg: no such file"), "{errors}");
    assert!(errors.contains("2 of 4 files failed"), "{errors}");
    assert_flag(&folder.read("a.png"), 4, 2);
    assert_flag(&folder.read("c.png"), 4, 2);
    assert!(!folder.has("bad.png"));
}

#[test]
fn a_collision_is_refused_before_anything_is_drawn() {
    let folder = Folder::new();
    folder.write("x/a.svg", FLAG).write("y/a.svg", FLAG);
    assert_failure(&folder.run(&["render", "x/a.svg", "y/a.svg", "-o", "{stem}.png"]), "both x/a.svg and y/a.svg");
    assert_failure(&folder.run(&["render", "x/a.svg", "y/a.svg", "-o", "one.png"]), "{stem}");
    assert_failure(&folder.run(&["render", "x/a.svg", "-o", "y/../x/a.svg"]), "overwrite");
    assert_eq!(folder.names(), ["x", "y"]);
    assert_eq!(fs::read_to_string(folder.0.join("x/a.svg")).unwrap(), FLAG);
}

#[test]
fn a_failure_leaves_the_old_picture() {
    let folder = Folder::new();
    folder.write("a.svg", FLAG);
    assert_success(&folder.run(&["render", "a.svg"]));
    folder.write("a.svg", "<svg xmlns='http://www.w3.org/2000/svg' width='4' height='2'><rect></svg>");
    assert_failure(&folder.run(&["render", "a.svg"]), "a.svg");
    assert_flag(&folder.read("a.png"), 4, 2);
    assert_eq!(folder.names(), ["a.png", "a.svg"]);
}

#[test]
fn a_target_that_cannot_be_written_is_named() {
    let folder = Folder::new();
    folder.write("a.svg", FLAG).write("taken.png/inside", "");
    assert_failure(&folder.run(&["render", "a.svg", "-o", "no/such/a.png"]), "folder is not there");
    // The default target of taken.svg is a folder.
    folder.write("taken.svg", FLAG);
    assert_failure(&folder.run(&["render", "taken.svg"]), "it is a folder");
    folder.write("kept.png", "old");
    let mut permissions = fs::metadata(folder.0.join("kept.png")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(folder.0.join("kept.png"), permissions).unwrap();
    assert_failure(&folder.run(&["render", "a.svg", "-o", "kept.png"]), "permissions");
    assert_eq!(fs::read(folder.0.join("kept.png")).unwrap(), b"old");
}

#[test]
fn what_is_no_svg_ends_in_one_line() {
    let folder = Folder::new();
    // Bytes as from a random source, always the same ones.
    let mut state = 1_u64;
    let noise: Vec<u8> = std::iter::repeat_with(|| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 56) as u8
    })
    .take(100_000)
    .collect();
    let mut torn = packed(FLAG.as_bytes());
    torn.truncate(torn.len() / 2);
    let zero = "<svg xmlns='http://www.w3.org/2000/svg' width='0' height='2'/>";
    let nested = format!("<svg xmlns='http://www.w3.org/2000/svg'>{}", "<g>".repeat(100_000));
    let closed = format!("{nested}{}</svg>", "</g>".repeat(100_000));
    for (bytes, part) in [
        (b"".as_slice(), "empty"),
        (&noise, "not an SVG"),
        (b"\x1f\x8b", "gzip"),
        (&torn, "gzip"),
        (b"<html/>", "not an SVG"),
        (zero.as_bytes(), "no valid size"),
        (nested.as_bytes(), "not an SVG"),
        (closed.as_bytes(), "deep"),
        (b"\xff\xfe<\0s\0v\0g\0/\0>\0", "not UTF-8"),
    ] {
        folder.write("a.svg", bytes);
        assert_failure(&folder.run(&["render", "a.svg"]), part);
    }
    assert_failure(&folder.run(&["render", "missing.svg"]), "no such file");
    assert_eq!(folder.names(), ["a.svg"]);
}

#[test]
fn a_packed_file_is_unpacked_up_to_a_limit() {
    let folder = Folder::new();
    folder.write("a.svgz", packed(FLAG.as_bytes()));
    assert_success(&folder.run(&["render", "a.svgz"]));
    assert_flag(&folder.read("a.png"), 4, 2);
    // 257 MiB of spaces, packed a member of a MiB at a time: about a quarter of a MiB.
    let member = packed(&vec![b' '; 1 << 20]);
    folder.write("bomb.svgz", member.repeat(257));
    assert_failure(&folder.run(&["render", "bomb.svgz"]), "limit");
}

#[test]
fn elements_as_deep_as_the_parser_takes_are_drawn() {
    let folder = Folder::new();
    let groups = "<g opacity='0.999'>".repeat(1000);
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='4' height='2'>{groups}\
         <rect width='9' height='9' fill='red'/>{}</svg>",
        "</g>".repeat(1000)
    );
    assert_success(&folder.write("a.svg", svg).run(&["render", "a.svg"]));
    // 0.999 to the thousandth is 0.3677.
    let alpha = i32::from(folder.read("a.png").pixel(1, 1).unwrap()[3]);
    assert!((alpha - 94).abs() <= 1, "{alpha}");
}

#[test]
fn what_is_left_out_is_warned_of_unless_quiet() {
    let folder = Folder::new();
    folder.write(
        "a.svg",
        "<svg xmlns='http://www.w3.org/2000/svg' width='4' height='2'><image href='gone.png' width='2' height='2'/></svg>",
    );
    let output = folder.run(&["render", "a.svg"]);
    assert!(output.status.success());
    assert!(text(&output.stderr).starts_with("rastrum: a.svg: warning: "), "{output:?}");
    assert!(text(&output.stderr).contains("gone.png"), "{output:?}");
    assert_success(&folder.run(&["render", "a.svg", "-q"]));
}

#[test]
fn timings_are_one_object_a_line_in_the_order_of_the_inputs() {
    let folder = Folder::new();
    folder.write("b.svg", FLAG).write("a.svg", FLAG);
    let output = folder.run(&["render", "b.svg", "a.svg", "--timings", "json"]);
    assert_success(&output);
    let lines: Vec<_> = text(&output.stdout).lines().collect();
    assert!(lines[0].starts_with(r#"{"input":"b.svg","output":"b.png","width":4,"height":2,"parse_ms":"#), "{lines:?}");
    assert!(lines[1].contains(r#""input":"a.svg""#) && lines[1].ends_with(r#""warnings":[]}"#), "{lines:?}");
    assert_eq!(lines.len(), 2);
    let output = folder.run(&["render", "a.svg", "-o", "-", "--timings", "json"]);
    assert_flag(&Pixmap::decode_png(&output.stdout).unwrap(), 4, 2);
    assert!(text(&output.stderr).starts_with(r#"{"input":"a.svg","output":"-""#), "{output:?}");
}

#[test]
fn threads_and_jobs_do_not_change_a_byte() {
    let folder = Folder::new();
    folder.write("a.svg", FLAG).write("b.svg", FLAG);
    assert_success(&folder.run(&["render", "a.svg", "b.svg", "-z", "40.3", "-j", "2", "--threads", "2"]));
    let first = fs::read(folder.0.join("a.png")).unwrap();
    assert_success(&folder.run(&["render", "a.svg", "-z", "40.3", "--threads", "1"]));
    assert_eq!(first, fs::read(folder.0.join("a.png")).unwrap());
    assert_eq!(first, fs::read(folder.0.join("b.png")).unwrap());
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let folder = Folder::new();
    let mut child =
        folder.command(&["completions", "bash"]).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut output = child.stdout.take().unwrap();
    output.read_exact(&mut [0; 1]).unwrap();
    drop(output);
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""));
}

#[test]
fn info_completions_and_man_print_what_they_are_for() {
    let folder = Folder::new();
    for (arguments, part) in [
        (["info"].as_slice(), "scalar"),
        (&["info", "--json"], r#""chosen":""#),
        (&["completions", "zsh"], "#compdef rastrum"),
        (&["man"], ".TH rastrum"),
        (&["man", "render"], "{stem}"),
        (&["render", "--help"], "Examples:"),
        (&["--version"], env!("CARGO_PKG_VERSION")),
    ] {
        let output = folder.run(arguments);
        assert_success(&output);
        assert!(text(&output.stdout).contains(part), "{arguments:?}");
    }
    assert_failure(&folder.run(&["man", "paint"]), "'paint'");
}

#[test]
fn wrong_arguments_exit_with_2() {
    let folder = Folder::new();
    folder.write("a.svg", FLAG);
    for arguments in [
        ["render"].as_slice(),
        &["paint"],
        &["render", "a.svg", "-w", "0"],
        &["render", "a.svg", "-z", "-1"],
        &["render", "a.svg", "-z", "2", "-w", "3"],
        &["render", "a.svg", "--antialias", "supersample=99"],
        &["render", "a.svg", "--font-file", "no-such-font.ttf"],
        &["render", "a.svg", "--max-memory", "lots"],
        &["render", "a.svg", "--max-time", "0"],
        &["render", "a.svg", "--query-all=xml"],
    ] {
        let output = folder.run(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty() && output.stdout.is_empty(), "{arguments:?}");
    }
    assert!(!Path::new(&folder.0).join("a.png").exists());
}

/// A square in the plane z = 0, its left triangle first.
const SQUARE: &str = "o square\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nf 1//1 3//1 4//1\nf 1//1 2//1 3//1\n";

#[test]
fn mesh_draws_the_modes_that_are_exact_by_definition() {
    let folder = Folder::new();
    folder.write("square.obj", SQUARE);
    let draw = |options: &[&str]| {
        let eye = ["mesh", "square.obj", "-o", "out.png", "--size", "41x41", "--eye", "0,0,4", "--at", "0,0,0"];
        let output = folder.run(&[&eye[..], options].concat());
        assert_success(&output);
        folder.read("out.png")
    };
    let ids = draw(&["--shading", "ids"]);
    assert_eq!((ids.pixel(14, 18), ids.pixel(26, 22)), (Some([1, 0, 0, 255]), Some([2, 0, 0, 255])));
    assert_eq!(ids.pixel(0, 0), Some([0; 4]));
    assert_eq!(draw(&["--shading", "normals"]).pixel(20, 20), Some([128, 128, 255, 255]));
    // Straight on, N = V = L: 0.1 + 0.9 of the colour, and 0.5.
    let phong = draw(&["--shading", "phong", "--light", "0,0,1", "--color", "404040"]).pixel(20, 20).unwrap();
    assert!(phong[0].abs_diff(64 + 128) <= 1, "{phong:?}");
    // From the side: the light's cosine alone where the highlight is below half a level.
    let phong = draw(&["--shading", "phong", "--light", "0,4,3", "--color", "404040"]).pixel(20, 20).unwrap();
    let half = (1.6_f64 / 2.0).sqrt();
    #[expect(clippy::disallowed_methods, reason = "compared with a tolerance")]
    let expected = 64.0 * (0.1 + 0.9 * 0.6) + 255.0 * 0.5 * half.powi(32);
    assert!((f64::from(phong[0]) - expected).abs() <= 1.5, "{phong:?} {expected}");
    let front = draw(&["--shading", "unlit", "--color", "FF0000", "--background", "0000FF", "--threads", "2"]);
    assert_eq!((front.pixel(20, 20), front.pixel(0, 0)), (Some(RED), Some(BLUE)));
    for aa in ["fxaa", "ssaa2", "msaa4", "msaa8"] {
        assert_eq!(draw(&["--shading", "unlit", "--aa", aa]).pixel(20, 20), Some([204, 204, 204, 255]), "{aa}");
    }
    assert_eq!(draw(&["--shading", "unlit", "--cull", "front"]).pixel(20, 20), Some([0; 4]));
}

#[test]
fn mesh_frames_numbers_and_refuses() {
    let folder = Folder::new();
    folder.write("square.obj", SQUARE).write("empty.stl", "").write("other.txt", "");
    for view in ["front", "back", "iso"] {
        assert_success(&folder.run(&["mesh", "square.obj", "-o", "out.png", "--size", "40x30", "--view", view]));
        let picture = folder.read("out.png");
        let seen = picture.data().as_chunks::<4>().0.iter().filter(|pixel| pixel[3] == 255).count();
        assert!((100..1000).contains(&seen), "{view} fills the picture: {seen}");
        assert!((0..40).all(|x| picture.pixel(x, 0) == Some([0; 4])), "{view} fits");
    }
    assert_success(&folder.run(&["mesh", "square.obj", "-o", "t.png", "--size", "8x8", "--turntable", "2"]));
    assert!(folder.has("t-000.png") && folder.has("t-001.png") && !folder.has("t.png"));
    let info = folder.run(&["mesh", "square.obj", "--info"]);
    assert!(text(&info.stdout).contains("4 vertices, 2 triangles"), "{info:?}");
    assert_failure(&folder.run(&["mesh", "empty.stl", "-o", "out.png"]), "empty");
    assert_failure(&folder.run(&["mesh", "gone.ply", "-o", "out.png"]), "gone.ply");
    assert_failure(&folder.run(&["mesh", "other.txt", "-o", "out.png"]), "not a model");
    assert_failure(&folder.run(&["mesh", "square.obj", "-o", "out.png", "--camera", "3"]), "no camera 3");
}

#[test]
fn mesh_names_its_picture_and_writes_depths() {
    let folder = Folder::new();
    folder.write("square.obj", SQUARE).write("other.obj", SQUARE);
    let eye = ["mesh", "square.obj", "--size", "9x7", "--eye", "0,0,4", "--at", "0,0,0", "--near", "2", "--far", "6"];
    for name in ["d.npy", "d.pfm", "d.raw"] {
        assert_success(&folder.run(&[&eye[..], &["--depth-out", name]].concat()));
    }
    assert_eq!((folder.read("square.png").width(), folder.read("square.png").height()), (9, 7));
    let raw = fs::read(folder.0.join("d.raw")).unwrap();
    let depths: Vec<f32> = raw.as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    // z' at a distance of 4 between 2 and 6, as 0 to 1: f (z - n) / (z (f - n)).
    assert_eq!((depths.len(), depths[0]), (63, 1.0));
    assert!((depths[3 * 9 + 4] - 0.75).abs() < 1e-6, "{depths:?}");
    let npy = fs::read(folder.0.join("d.npy")).unwrap();
    assert!(npy.ends_with(&raw) && text(&npy[10..80]).contains("'shape': (7, 9)"));
    let pfm = fs::read(folder.0.join("d.pfm")).unwrap();
    assert!(pfm.starts_with(b"Pf\n9 7\n-1.0\n") && pfm.ends_with(&raw[..36]));
    assert_failure(&folder.run(&["mesh", "square.obj", "other.obj"]), "-o");
    assert_failure(&folder.run(&["mesh", "square.obj", "--depth-out", "gone/d.npy"]), "gone/d.npy");
    assert!(!folder.has("other.png"));
}

#[test]
fn mesh_frames_what_it_draws() {
    let folder = Folder::new();
    let boxed = "v -4 -1 -1\nv 4 -1 -1\nv 4 1 -1\nv -4 1 1\nv 4 -1 1\nv -4 -1 1\nf 1 2 3\nf 4 5 6\nf 1 3 4\nf 2 5 4\n";
    folder.write("box.obj", boxed);
    let whole = ["front", "back", "left", "right", "top", "bottom", "iso"].map(|view| vec!["--view", view]);
    let more = [vec!["--ortho"], vec!["--ortho", "--view", "left"], vec!["--fov", "120"], vec!["--up-axis", "z"]];
    for view in whole.into_iter().chain(more) {
        for size in ["200x200", "300x100", "100x300"] {
            let draw = ["mesh", "box.obj", "-o", "out.png", "--cull", "none", "--size", size];
            assert_success(&folder.run(&[&draw[..], &view].concat()));
            let picture = folder.read("out.png");
            let (width, height) = (picture.width(), picture.height());
            let drawn: Vec<(u32, u32)> = (0..height)
                .flat_map(|y| (0..width).map(move |x| (x, y)))
                .filter(|(x, y)| picture.pixel(*x, *y).unwrap()[3] > 0)
                .collect();
            let [left, right] = [drawn.iter().map(|p| p.0).min(), drawn.iter().map(|p| p.0).max()].map(Option::unwrap);
            let [top, bottom] = [drawn.iter().map(|p| p.1).min(), drawn.iter().map(|p| p.1).max()].map(Option::unwrap);
            // Nothing is cut off, and one of the sides is filled for the most part.
            assert!(left > 0 && top > 0 && right < width - 1 && bottom < height - 1, "{view:?} {size}");
            let filled = ((right - left) as f32 / width as f32).max((bottom - top) as f32 / height as f32);
            assert!(filled > 0.45, "{view:?} {size}: {filled}");
        }
    }
    // What cannot be framed is said; with a camera that is given there is a picture, though clipping at 1e30 is coarse. What holds
    // nothing is warned of.
    folder.write("far.obj", "v -1e30 -1e30 0\nv 1e30 -1e30 0\nv 0 1e30 0\nf 1 2 3\n");
    assert_failure(&folder.run(&["mesh", "far.obj", "-o", "far.png"]), "--near");
    let given = ["--eye", "0,0,3", "--at", "0,0,0", "--near", "1", "--far", "5", "--size", "40x40"];
    assert_success(&folder.run(&[&["mesh", "far.obj", "-o", "far.png"][..], &given].concat()));
    assert_eq!(folder.read("far.png").width(), 40);
    folder.write("empty.obj", "v 0 0 0\n");
    let output = folder.run(&["mesh", "empty.obj", "-o", "empty.png"]);
    assert!(
        output.status.success() && String::from_utf8_lossy(&output.stderr).contains("nothing to draw"),
        "{output:?}"
    );
}

#[test]
fn mesh_filters_textures_as_it_is_told() {
    let folder = Folder::new();
    let stripes: String =
        (0..32).map(|x| format!("<path d='M{} 0v64' stroke='#fff'/>", 2.0 * f64::from(x) + 0.5)).collect();
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='64' height='64'><path d='M0 0h64v64H0z'/>{stripes}</svg>"
    );
    folder.write("stripes.svg", &svg).write("stripes.mtl", "newmtl s\nKd 1 1 1\nmap_Kd stripes.png\n");
    assert_success(&folder.run(&["render", "stripes.svg", "-o", "stripes.png"]));
    let square =
        "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";
    folder.write("square.obj", format!("mtllib stripes.mtl\nusemtl s\n{square}"));
    // The greys of the square's middle row, which is `side` pixels long.
    let greys = |side: u32, filter: &[&str]| {
        let size = format!("{side}x{side}");
        let eye = ["mesh", "square.obj", "-o", "out.png", "--shading", "unlit", "--size", &size];
        let view = ["--eye", "0,0,4", "--at", "0,0,0", "--ortho", "--fov", "28.0724870"];
        assert_success(&folder.run(&[&eye[..], &view, filter].concat()));
        let picture = folder.read("out.png");
        (1..side - 1).map(|x| picture.pixel(x, side / 2).unwrap()[0]).collect::<std::collections::BTreeSet<_>>()
    };
    // Enlarged, nearest shows black and white alone; reduced, only mipmaps make one grey of them.
    assert_eq!(greys(640, &["--filter", "nearest"]), [0, 255].into());
    assert!(greys(640, &["--filter", "bilinear"]).len() > 5);
    assert_eq!(greys(640, &["--filter", "bilinear"]), greys(640, &[]));
    assert_eq!(greys(15, &["--filter", "trilinear"]), greys(15, &[]));
    assert!(greys(15, &[]).iter().all(|v| (100..=155).contains(v)), "{:?}", greys(15, &[]));
    assert!(greys(15, &["--filter", "bilinear"]).iter().any(|v| !(100..=155).contains(v)));
}
