//! Files made to harm, through the program: each ends in a picture or in one line, and never in a backtrace.
//!
//! Nothing here looks at the clock but the program itself, whose `--max-time` would make a failure of what has to be drawn.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};

use rastrum::Pixmap;

/// A folder of its own for each test, gone afterwards.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("rastrum-hostile-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn run(&self, svg: &str, arguments: &[&str]) -> Output {
        fs::write(self.0.join("a.svg"), svg).unwrap();
        let _ = fs::remove_file(self.0.join("a.png"));
        let mut command = Command::new(env!("CARGO_BIN_EXE_rastrum"));
        command.current_dir(&self.0).args(["render", "a.svg", "--no-system-fonts"]).args(arguments);
        command.stdin(Stdio::null()).output().unwrap()
    }

    fn picture(&self) -> Option<Pixmap> {
        Pixmap::load_png(self.0.join("a.png")).ok()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn svg(content: &str) -> String {
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' width='64' height='64'>{content}</svg>"
    )
}

/// The program said no, in one line.
#[track_caller]
fn assert_refused(name: &str, output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{name}: {said}");
    assert!(said.starts_with("rastrum: a.svg: ") && said.lines().count() == 1, "{name}: {said}");
    assert!(!said.contains("panicked") && !said.contains("internal error"), "{name}: {said}");
}

/// A picture, or one line.
#[track_caller]
fn assert_ends(name: &str, folder: &Folder, content: &str) -> bool {
    let output = folder.run(content, &["--max-time", "20", "--max-memory", "1GiB"]);
    if output.status.code() == Some(0) {
        assert!(folder.picture().is_some(), "{name}");
        return true;
    }
    assert_refused(name, &output);
    assert!(folder.picture().is_none(), "{name}");
    false
}

/// A picture.
#[track_caller]
fn assert_drawn(name: &str, folder: &Folder, content: &str) -> Pixmap {
    let output = folder.run(content, &["--max-time", "60", "--max-memory", "1GiB"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{name}: {said}");
    folder.picture().unwrap()
}

#[test]
fn what_refers_to_itself_ends() {
    let folder = Folder::new();
    let rect = "<rect width='64' height='64' fill='red'/>";
    for (name, content) in [
        ("use", "<use id='a' href='#a'/><g id='b'><use href='#c'/></g><g id='c'><use href='#b'/></g>".to_owned()),
        (
            "pattern",
            "<pattern id='p' width='8' height='8' patternUnits='userSpaceOnUse'><rect width='4' height='4' fill='url(#p)'/></pattern>\
             <rect width='64' height='64' fill='url(#p)'/>"
                .to_owned(),
        ),
        (
            "patterns in a circle",
            "<pattern id='p' width='8' height='8' patternUnits='userSpaceOnUse'><rect width='4' height='4' fill='url(#q)'/></pattern>\
             <pattern id='q' width='8' height='8' patternUnits='userSpaceOnUse'><rect width='4' height='4' stroke='url(#p)'/></pattern>\
             <rect width='64' height='64' fill='url(#p)'/>"
                .to_owned(),
        ),
        (
            "a pattern in the mask of text in it",
            "<pattern id='p' width='8' height='8' patternUnits='userSpaceOnUse'><text y='9' mask='url(#m)'>a</text></pattern>\
             <mask id='m'><rect width='9' height='9' fill='url(#p)'/></mask><rect width='64' height='64' fill='url(#p)'/>"
                .to_owned(),
        ),
        ("mask", format!("<mask id='m' mask='url(#m)'><g mask='url(#m)'>{rect}</g></mask><g mask='url(#m)'>{rect}</g>")),
        (
            "clip",
            format!("<clipPath id='c' clip-path='url(#c)'><path d='M0 0H9V9Z' clip-path='url(#c)'/></clipPath><g clip-path='url(#c)'>{rect}</g>"),
        ),
        (
            "filter",
            format!("<filter id='f'><feImage href='#r'/></filter><g id='r' filter='url(#f)'>{rect}</g>"),
        ),
        (
            "marker",
            "<marker id='m'><path d='M0 0H9' marker-start='url(#m)'/></marker><path d='M0 0H9' marker-start='url(#m)'/>".to_owned(),
        ),
        ("image", "<image href='a.svg' width='64' height='64'/>".to_owned()),
    ] {
        assert_ends(name, &folder, &svg(&content));
    }
}

#[test]
fn few_lines_that_ask_for_much_end() {
    let folder = Folder::new();
    let levels = |of: &dyn Fn(usize) -> String| (0..9).map(of).collect::<String>();
    let masks = levels(&|i| {
        let shape = format!("<rect width='64' height='64' fill='#fff' mask='url(#m{})'/>", i + 1);
        format!("<mask id='m{i}'>{}</mask>", shape.repeat(10))
    });
    let clips = levels(&|i| {
        let shape = format!("<path d='M0 0H64V64Z' clip-path='url(#c{})'/>", i + 1);
        format!("<clipPath id='c{i}'>{}</clipPath>", shape.repeat(10))
    });
    let markers = levels(&|i| {
        let shape = format!("<path d='M0 0h1h1h1h1h1h1' marker-mid='url(#k{})'/>", i + 1);
        format!("<marker id='k{i}' overflow='visible'>{}</marker>", shape.repeat(4))
    });
    let uses = levels(&|i| format!("<g id='u{i}'>{}</g>", format!("<use href='#u{}'/>", i + 1).repeat(10)));
    let selectors: String = (0..400).map(|i| format!("{} .x{i}{{fill:red}}", "g ".repeat(40))).collect::<String>();
    let nested =
        format!("{}{}{}", "<g>".repeat(400), "<path class='y' d='M0 0H1V1Z'/>".repeat(500), "</g>".repeat(400));
    let laughs: String = (1..12).map(|i| format!("<!ENTITY l{i} '{}'>", format!("&l{};", i - 1).repeat(10))).collect();
    let long = "x".repeat(1 << 20);
    for (name, content) in [
        (
            "masks",
            svg(&format!(
                "{masks}<mask id='m9'><path d='M0 0H9V9Z'/></mask><rect width='64' height='64' mask='url(#m0)'/>"
            )),
        ),
        (
            "clips",
            svg(&format!(
                "{clips}<clipPath id='c9'><path d='M0 0H9V9Z'/></clipPath><rect width='64' height='64' clip-path='url(#c0)'/>"
            )),
        ),
        (
            "markers",
            svg(&format!(
                "{markers}<marker id='k9'><path d='M0 0H9V9Z'/></marker><path d='M0 0h1h1h1' marker-mid='url(#k0)'/>"
            )),
        ),
        ("uses", svg(&format!("<defs>{uses}<path id='u9' d='M0 0H9V9Z'/></defs><use href='#u0'/>"))),
        ("selectors", svg(&format!("<style>{selectors}</style>{nested}"))),
        ("tspans", svg(&format!("<text>{}a{}</text>", "<tspan>".repeat(5000), "</tspan>".repeat(5000)))),
        ("a billion laughs", format!("<!DOCTYPE svg [<!ENTITY l0 'ha'>{laughs}]>{}", svg("<desc>&l11;</desc>"))),
        (
            "a long entity",
            format!("<!DOCTYPE svg [<!ENTITY a '{long}'>]>{}", svg(&format!("<desc>{}</desc>", "&a;".repeat(4000)))),
        ),
    ] {
        assert_ends(name, &folder, &content);
    }
}

#[test]
fn extreme_numbers_are_drawn_or_refused() {
    let folder = Folder::new();
    let huge = "<svg xmlns='http://www.w3.org/2000/svg' width='1e9' height='1e9'><rect width='9' height='9'/></svg>";
    assert!(!assert_ends("a picture of 1e18 pixels", &folder, huge));
    let filtered = |primitives: &str| {
        svg(&format!(
            "<filter id='f' filterUnits='userSpaceOnUse' x='-500000' y='-500000' width='1000000' height='1000000'>{primitives}</filter>\
             <rect x='16' y='16' width='32' height='32' fill='red' filter='url(#f)'/>"
        ))
    };
    let order = "1 ".repeat(300 * 300);
    for (name, content) in [
        ("a blur of 1e9", filtered("<feGaussianBlur stdDeviation='1e9'/>")),
        ("a shadow far away", filtered("<feDropShadow dx='1e9' dy='-1e9' stdDeviation='1e9'/>")),
        ("a radius of 1e6", filtered("<feMorphology operator='dilate' radius='1e6'/>")),
        ("erosion by 1e6", filtered("<feMorphology radius='1e6'/>")),
        ("a kernel of 300", filtered(&format!("<feConvolveMatrix order='300' kernelMatrix='{order}'/>"))),
        ("1e6 octaves", filtered("<feTurbulence baseFrequency='1e30' numOctaves='1000000'/>")),
        ("noise of nothing", filtered("<feTurbulence baseFrequency='0' numOctaves='1000000' stitchTiles='stitch'/>")),
        ("an offset of 1e30", filtered("<feOffset dx='1e30' dy='-1e30'/><feTile/>")),
        ("displacement by 1e30", filtered("<feDisplacementMap in2='SourceGraphic' scale='1e30'/>")),
        (
            "light from 1e30",
            filtered(
                "<feDiffuseLighting surfaceScale='1e30'><fePointLight x='1e30' y='0' z='-1e30'/></feDiffuseLighting>",
            ),
        ),
        (
            "forty filters in each other",
            svg(&format!(
                "<filter id='f' x='-10' y='-10' width='30' height='30'><feGaussianBlur stdDeviation='200'/></filter>{}<rect width='9' height='9'/>{}",
                "<g filter='url(#f)'>".repeat(40),
                "</g>".repeat(40)
            )),
        ),
        (
            "a tile of 1e6",
            svg(
                "<pattern id='p' width='1e6' height='1e6' patternUnits='userSpaceOnUse'><rect width='5e5' height='5e5' fill='red'/></pattern>\
                 <rect width='64' height='64' fill='url(#p)'/>",
            ),
        ),
        (
            "coordinates",
            svg("<path d='M-1e30 -1e30L1e30 1e30L1e38 0Z' stroke='red' stroke-width='1e20' stroke-dasharray='1e-9'/>"),
        ),
    ] {
        assert_drawn(name, &folder, &content);
    }
}

#[test]
fn a_path_of_300_000_segments_is_drawn() {
    let mut data = "M0 0".to_owned();
    let mut seed = 1_u32;
    for _ in 0..300_000 {
        let mut next = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            seed >> 26
        };
        data += &format!("L{} {}", next(), next());
    }
    let path = format!("<path d='{data}' fill='red' fill-rule='evenodd' stroke='blue' stroke-width='.01'/>");
    assert_drawn("segments", &Folder::new(), &svg(&path));
}

#[test]
fn a_convolution_of_too_many_products_is_left_out_and_named() {
    let folder = Folder::new();
    let filter =
        format!("<filter id='f'><feConvolveMatrix order='300' kernelMatrix='{}'/></filter>", "1 ".repeat(90_000));
    let shapes = "<rect width='900' height='900' filter='url(#f)'/><rect x='950' width='9' height='9' fill='red'/>";
    let text = svg(&format!("{filter}{shapes}")).replace("width='64' height='64'", "width='1000' height='1000'");
    let output = folder.run(&text, &[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("a convolution") && said.lines().count() == 1, "{said}");
    let picture = folder.picture().unwrap();
    assert_eq!((picture.pixel(955, 5), picture.pixel(450, 450)), (Some([255, 0, 0, 255]), Some([0; 4])));
}

#[test]
fn links_lead_to_files_around_the_drawing_only() {
    let folder = Folder::new();
    let picture = |name: &str, color| {
        let mut pixmap = Pixmap::new(4, 4).unwrap();
        pixmap.fill(color);
        pixmap.save_png(folder.0.join(name)).unwrap();
    };
    picture("inside.png", rastrum::Color::RED);
    let link = |link: &str| svg(&format!("<image href='{link}' width='64' height='64'/>"));
    let middle = || folder.picture().unwrap().pixel(32, 32);
    assert_eq!(folder.run(&link("inside.png"), &[]).status.code(), Some(0));
    assert_eq!(middle(), Some([255, 0, 0, 255]));
    // An absolute link to another folder, and the same with leave.
    let other = Folder::new();
    let mut pixmap = Pixmap::new(4, 4).unwrap();
    pixmap.fill(rastrum::Color::BLUE);
    pixmap.save_png(other.0.join("b.png")).unwrap();
    let absolute = other.0.join("b.png");
    let output = folder.run(&link(absolute.to_str().unwrap()), &[]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stderr).contains("outside"), "{output:?}");
    assert_eq!(middle(), Some([0; 4]));
    let leave = other.0.to_str().unwrap();
    assert_eq!(folder.run(&link(absolute.to_str().unwrap()), &["--resources-dir", leave]).status.code(), Some(0));
    assert_eq!(middle(), Some([0, 0, 255, 255]));
    // What has no end.
    for endless in ["/dev/zero", "file:///dev/zero", "/dev/stdin"] {
        for arguments in [&[] as &[&str], &["--resources-dir", "/"]] {
            let output = folder.run(&link(endless), arguments);
            assert_eq!(output.status.code(), Some(0), "{endless}: {output:?}");
            assert!(String::from_utf8_lossy(&output.stderr).contains("left out"), "{endless}: {output:?}");
        }
    }
}

#[test]
fn text_without_fonts_is_left_out() {
    let output = Folder::new().run(&svg("<text y='20'>words</text><rect width='9' height='9'/>"), &[]);
    assert_eq!(output.status.code(), Some(0));
    assert!(String::from_utf8_lossy(&output.stderr).contains("no fonts"), "{output:?}");
}

/// Its header claims 16,000 × 16,000 pixels: decoded, they would take 1 GiB and their decoder's buffers.
#[test]
fn a_picture_of_16_000_pixels_a_side_is_left_out() {
    let folder = Folder::new();
    let mut png = Pixmap::new(1, 1).unwrap().encode_png().unwrap();
    // Signature, the chunk's length and its name come before the sides; its checksum follows five more bytes.
    png[16..20].copy_from_slice(&16_000_u32.to_be_bytes());
    png[20..24].copy_from_slice(&16_000_u32.to_be_bytes());
    let checksum = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&checksum.to_be_bytes());
    fs::write(folder.0.join("large.png"), png).unwrap();
    let output = folder.run(&svg("<image href='large.png' width='64' height='64'/>"), &[]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert!(said.contains("16000 × 16000") && said.lines().count() == 1, "{said}");
}

/// PNG's checksum of a chunk's name and content.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xEDB8_8320 } else { sum >> 1 })
    })
}

#[test]
fn time_and_memory_have_limits() {
    let folder = Folder::new();
    let long = "<svg xmlns='http://www.w3.org/2000/svg' width='6000' height='6000'><filter id='f'><feTurbulence baseFrequency='.1' numOctaves='20'/></filter>\
                <rect width='6000' height='6000' filter='url(#f)'/></svg>";
    let output = folder.run(long, &["--max-time", "0.05"]);
    assert_refused("time", &output);
    assert!(String::from_utf8_lossy(&output.stderr).contains("--max-time"), "{output:?}");
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 1, "and nothing is left behind");
    if cfg!(target_os = "linux") {
        let output = folder.run(long, &["--max-memory", "64MiB"]);
        assert_refused("memory", &output);
        assert!(String::from_utf8_lossy(&output.stderr).contains("--max-memory"), "{output:?}");
    }
}

/// Draws a square picture with as many addresses for each process as so many bytes beside 64 MiB need, and expects a picture
/// and not a word.
#[cfg(target_os = "linux")]
fn assert_drawn_within(name: &str, side: u32, bytes: u32, content: &str) {
    // The program, its libraries, the encoder and stacks take some 93 MiB of addresses, of which 20 are its code as tests build it, and less than 40 MiB of
    // memory.
    let mebibytes = 64 + 96 + bytes.div_ceil(1 << 20);
    let folder = Folder::new();
    let text = svg(content).replace("width='64' height='64'", &format!("width='{side}' height='{side}'"));
    fs::write(folder.0.join("a.svg"), text).unwrap();
    let script = format!("ulimit -v {} && exec \"$0\" render a.svg --threads 1", mebibytes << 10);
    let mut command = Command::new("sh");
    command.current_dir(&folder.0).args(["-c", &script, env!("CARGO_BIN_EXE_rastrum")]).stdin(Stdio::null());
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.is_empty(), "{name} in {mebibytes} MiB: {said}");
    assert_eq!(folder.picture().unwrap().width(), side, "{name}");
}

/// A hundred circles in and far around a picture of 2000².
fn circles() -> String {
    let circle = |i: u32| {
        let (x, y, r) = (i * 7919 % 8000, i * 104_729 % 8000, 100 + i * 7);
        let (x, y) = (i64::from(x) - 3000, i64::from(y) - 3000);
        format!("<circle cx='{x}.3' cy='{y}.7' r='{r}' fill='#{:06x}' fill-opacity='.6'/>", i * 7_654_321 % 0xFF_FFFF)
    };
    (0..100).map(circle).collect()
}

/// Shapes within a filter whose region is as large as one likes.
fn everywhere(filter: &str, content: &str) -> String {
    let region = "filterUnits='userSpaceOnUse' x='-10000' y='-10000' width='22000' height='22000'";
    format!("<filter id='f' {region}>{filter}</filter><g filter='url(#f)'>{content}</g>")
}

#[test]
fn many_layers_over_a_whole_picture_are_stopped_in_time() {
    let folder = Folder::new();
    // Shapes alone, in 40 KB: 500 times 4 million pixels of the slowest mode.
    let layer = "<g style='mix-blend-mode:luminosity'><rect width='2000' height='2000' fill='#0963c77f'/></g>";
    let text = svg(&layer.repeat(500)).replace("width='64' height='64'", "width='2000' height='2000'");
    let output = folder.run(&text, &["--max-time", "0.1"]);
    assert_refused("layers", &output);
    assert!(String::from_utf8_lossy(&output.stderr).contains("--max-time"), "{output:?}");
}

#[test]
#[cfg(target_os = "linux")]
fn layers_take_their_pixels_and_64_mib() {
    const SHAPE: &str = "<path d='M0 0h2000v2000z' fill='red'/>";
    const PLANE: &str = "<rect x='-10000' y='-10000' width='30000' height='30000' fill='red'/>";
    let filtered = |filter: &str, count: usize| {
        let region = "x='-1' y='-1' width='3' height='3'";
        let groups = format!("<g filter='url(#f)'>{SHAPE}</g>").repeat(count);
        format!("<filter id='f' {region}>{filter}</filter>{groups}")
    };
    let blur = "<feGaussianBlur stdDeviation='200'/>";
    let blur_300 = "<feGaussianBlur stdDeviation='300'/>";
    let linear = "<feGaussianBlur color-interpolation-filters='linearRGB' stdDeviation='300 200'/>";
    let glow = "<feGaussianBlur stdDeviation='300' result='a'/><feMerge><feMergeNode in='a'/><feMergeNode in='SourceGraphic'/></feMerge>";
    let chain = "<feGaussianBlur stdDeviation='300'/><feGaussianBlur stdDeviation='300'/><feOffset dx='99'/>";
    let circles = circles();
    let masked = format!("<mask id='m'>{SHAPE}</mask><g mask='url(#m)'>{SHAPE}</g>");
    let clipped = format!("<clipPath id='m'>{SHAPE}</clipPath><g clip-path='url(#m)'>{SHAPE}</g>");
    // How many pictures of all of the canvas, which is one, are there at a time: groups and masks are drawn in bands and need none.
    let cases = [
        ("group", 1, format!("<g opacity='.5'>{SHAPE}</g>")),
        ("a hundred groups", 1, format!("{}{SHAPE}{}", "<g opacity='.9'>".repeat(100), "</g>".repeat(100))),
        ("blend mode", 1, format!("<g style='mix-blend-mode:hue'>{SHAPE}</g>")),
        ("mask", 1, masked),
        ("clip", 1, clipped),
        ("blur", 2, filtered(blur, 1)),
        ("shadow", 2, filtered("<feDropShadow dx='9' stdDeviation='20'/>", 1)),
        ("turbulence", 2, filtered("<feTurbulence baseFrequency='.01'/>", 1)),
        ("morphology", 2, filtered("<feMorphology radius='20'/>", 1)),
        ("three blurs", 4, filtered(blur, 3)),
        // What was recorded is drawn when pictures that wait take 16 MiB: one or two of these. Within a group one more, of the group so far.
        ("forty blurs", 4, filtered(blur, 40)),
        ("forty blurs in a group", 6, format!("<g opacity='.5'>{}</g>", filtered(blur, 40))),
        // Blurs that bring into view what lies far outside.
        ("wide blur of a rectangle", 2, everywhere(blur_300, PLANE)),
        ("wider blur of a rectangle", 2, everywhere("<feGaussianBlur stdDeviation='1000'/>", PLANE)),
        ("wide blur of circles", 2, everywhere(blur_300, &circles)),
        ("wide blur in linear light", 2, everywhere(linear, &circles)),
        ("wide blur of alpha", 2, everywhere("<feGaussianBlur in='SourceAlpha' stdDeviation='300'/>", &circles)),
        ("wide shadow", 3, everywhere("<feDropShadow dx='300' stdDeviation='300'/>", &circles)),
        ("wide glow", 3, everywhere(glow, &circles)),
        // What lies between primitives, or in a layer inside, has a picture.
        ("blur of a blur, moved", 3, everywhere(chain, PLANE)),
        ("wide erosion", 3, everywhere("<feMorphology operator='erode' radius='900'/>", PLANE)),
        ("wide blur of a filtered group", 3, everywhere(blur_300, &format!("<g filter='url(#f)'>{circles}</g>"))),
        ("wide blur of blurs", 5, everywhere(blur_300, &format!("{circles}<g filter='url(#f)'>{PLANE}</g>").repeat(3))),
    ];
    for (name, pictures, content) in cases {
        assert_drawn_within(name, 2000, 4 * 2000 * 2000 * pictures, &content);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn layers_take_their_pixels_and_64_mib_of_large_canvases() {
    let plane = "<rect x='-10000' y='-10000' width='30000' height='30000' fill='red'/>".to_owned();
    let circles = circles();
    let blur = "<feGaussianBlur stdDeviation='20'/>";
    let shadow = "<feDropShadow dx='9' stdDeviation='20'/>";
    let glow = "<feGaussianBlur stdDeviation='20' result='a'/><feMerge><feMergeNode in='a'/><feMergeNode in='SourceGraphic'/></feMerge>";
    let old_shadow = "<feGaussianBlur in='SourceAlpha' stdDeviation='20'/><feOffset dx='9' result='a'/><feFlood flood-color='blue'/>\
                      <feComposite operator='in' in2='a'/><feMerge><feMergeNode/><feMergeNode in='SourceGraphic'/></feMerge>";
    let noise = "<feTurbulence baseFrequency='.01'/>";
    let erode = "<feMorphology radius='20'/>";
    let convolve = "<feConvolveMatrix order='3' preserveAlpha='true' kernelMatrix='0 1 0 1 0 1 0 1 0'/>";
    let light = "<feDiffuseLighting lighting-color='red'><feDistantLight/></feDiffuseLighting>";
    // How many pictures of the filter's there are at a time: what a single blur or shadow reads is none.
    for (name, pictures, filter, content) in [
        ("none", 0, "", &plane),
        ("blur", 1, blur, &plane),
        ("blur of circles", 1, blur, &circles),
        ("small blur", 1, "<feGaussianBlur stdDeviation='1'/>", &plane),
        ("shadow", 1, shadow, &plane),
        ("shadow of circles", 1, shadow, &circles),
        ("wide shadow", 1, "<feDropShadow dx='300' stdDeviation='300'/>", &plane),
        ("noise", 1, noise, &plane),
        ("glow", 2, glow, &plane),
        ("erosion", 2, erode, &plane),
        ("convolution", 2, convolve, &plane),
        ("light", 2, light, &plane),
        ("shadow of primitives", 3, old_shadow, &plane),
    ] {
        let content = if filter.is_empty() { content.clone() } else { everywhere(filter, content) };
        let canvas = 4 * 4000 * 4000;
        assert_drawn_within(name, 4000, canvas * (1 + pictures), &content);
        if !["blur", "shadow of circles", "erosion", "shadow of primitives"].contains(&name) {
            continue;
        }
        // A turned canvas has a box of its own: of 4000 · (cos 30° + sin 30°).
        let turned = format!("<g transform='rotate(30 2000 2000)'>{content}</g>");
        assert_drawn_within(&format!("{name}, turned"), 4000, canvas + 4 * 5466 * 5466 * pictures, &turned);
    }
}

/// The program draws no shadows of a canvas: this test draws some in a process of its own.
#[test]
#[cfg(target_os = "linux")]
fn layers_take_their_pixels_and_64_mib_as_shadows_of_a_canvas() {
    const WITHIN: &str = "RASTRUM_TEST_SHADOW_DEVIATION";
    if let Some(deviation) = std::env::var(WITHIN).ok().and_then(|deviation| deviation.parse().ok()) {
        let settings = rastrum::RenderSettings::default().with_threads(1);
        let mut canvas = rastrum::Canvas::with_settings(2000, 2000, settings).unwrap();
        let color = rastrum::Color::BLACK;
        canvas.set_shadow(rastrum::Shadow { offset_x: 90.0, offset_y: 10.0, deviation, color });
        canvas.fill_rect(rastrum::Rect::from_xywh(-9999.5, -9999.5, 30_000.0, 11_000.0), rastrum::Color::RED);
        canvas.fill_circle((1000.0, 1000.0), 4000.0, rastrum::Color::RED.with_opacity(0.1));
        canvas.set_shadow(rastrum::Shadow { offset_x: 9.0, offset_y: 10.0, deviation: 4.0, color });
        for _ in 0..20 {
            canvas.fill_rect(rastrum::Rect::from_xywh(2.5, 2.5, 1990.0, 1990.0), rastrum::Color::RED);
        }
        canvas.flush().unwrap();
        assert!(canvas.into_pixmap().pixel(1000, 1500).is_some_and(|pixel| pixel[3] > 99));
        return;
    }
    for deviation in ["300", "1000"] {
        let name = "hostile::layers_take_their_pixels_and_64_mib_as_shadows_of_a_canvas";
        // Its target, two shadows, and what the binary takes of addresses.
        let script = format!("ulimit -v {} && exec \"$0\" --exact {name} --test-threads 1", (64 + 90 + 16 * 3) << 10);
        let mut command = Command::new("sh");
        command.args(["-c", &script]).arg(std::env::current_exe().unwrap()).env(WITHIN, deviation);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{deviation}: {output:?}");
        assert!(String::from_utf8_lossy(&output.stdout).contains("1 passed"), "{output:?}");
    }
}

#[test]
fn after_a_file_that_ends_its_worker_the_next_is_drawn() {
    let folder = Folder::new();
    let good = svg("<rect width='64' height='64' fill='red'/>");
    let bad = "<svg xmlns='http://www.w3.org/2000/svg' width='6000' height='6000'><filter id='f'><feTurbulence baseFrequency='.1' numOctaves='20'/></filter>\
               <rect width='6000' height='6000' filter='url(#f)'/></svg>";
    for (name, content) in [("1.svg", good.as_str()), ("2.svg", bad), ("3.svg", good.as_str())] {
        fs::write(folder.0.join(name), content).unwrap();
    }
    let mut command = Command::new(env!("CARGO_BIN_EXE_rastrum"));
    let arguments = ["render", "1.svg", "2.svg", "3.svg", "-j", "1", "--max-time", "0.4"];
    let output = command.current_dir(&folder.0).args(arguments).stdin(Stdio::null()).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{output:?}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("1 of 3 files failed"), "{output:?}");
    for name in ["1.png", "3.png"] {
        assert_eq!(Pixmap::load_png(folder.0.join(name)).unwrap().pixel(9, 9), Some([255, 0, 0, 255]), "{name}");
    }
}
