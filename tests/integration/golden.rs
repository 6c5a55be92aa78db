//! Every drawing under `fixtures/` against its picture under `tests/golden/`, byte for byte.
//!
//! `RASTRUM_BLESS=1 cargo test golden` rewrites the pictures that differ, and fails, so that nothing is blessed
//! unseen; `fixtures/README.md` says what to do first.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder as _};
use rastrum::{Pixmap, RenderSettings};

use super::fixtures;

/// How two pictures of one size differ.
#[derive(Debug, PartialEq)]
struct Difference {
    /// How many pixels do.
    pixels: usize,
    /// The largest difference of a channel, and the first pixel that shows it.
    largest: u8,
    at: (u32, u32),
}

/// How the pictures differ, and a picture of it: black where they agree, else the brighter the more they differ,
/// with a difference of one well visible.
fn compare(expected: &Pixmap, actual: &Pixmap) -> Option<(Difference, Pixmap)> {
    let mut difference = Difference { pixels: 0, largest: 0, at: (0, 0) };
    let mut picture = Pixmap::new(expected.width(), expected.height()).unwrap();
    let pairs = expected.data().as_chunks::<4>().0.iter().zip(actual.data().as_chunks::<4>().0);
    for ((index, (e, a)), out) in pairs.enumerate().zip(picture.data_mut().as_chunks_mut::<4>().0) {
        let distance = e.iter().zip(a).map(|(e, a)| e.abs_diff(*a)).max().unwrap();
        let light = if distance == 0 { 0 } else { 80 + (u16::from(distance) * 175 / 255) as u8 };
        *out = [light, light, light, 255];
        difference.pixels += usize::from(distance > 0);
        if distance > difference.largest {
            let index = index as u32;
            difference.largest = distance;
            difference.at = (index % expected.width(), index / expected.width());
        }
    }
    (difference.pixels > 0).then_some((difference, picture))
}

/// What is wrong with a picture, if anything, in words. Both pictures and their difference are then below `folder`.
fn check(name: &str, expected: &Pixmap, actual: &Pixmap, folder: &Path) -> Option<String> {
    let size = |pixmap: &Pixmap| (pixmap.width(), pixmap.height());
    let save = |kind: &str, pixmap: &Pixmap| -> PathBuf {
        let path = folder.join(format!("{name}.{kind}.png"));
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        pixmap.save_png(&path).unwrap();
        path
    };
    let (text, picture) = if size(expected) == size(actual) {
        let (Difference { pixels, largest, at }, picture) = compare(expected, actual)?;
        (format!("{pixels} pixels differ, by up to {largest} at {at:?}"), Some(picture))
    } else {
        (format!("it is {:?} pixels large, not {:?}", size(actual), size(expected)), None)
    };
    let mut text = format!("{name}: {text}\n  expected {}", save("expected", expected).display());
    write!(text, "\n  actual {}", save("actual", actual).display()).unwrap();
    if let Some(picture) = picture {
        write!(text, "\n  difference {}", save("difference", &picture).display()).unwrap();
    }
    Some(text)
}

fn golden(name: &str) -> PathBuf {
    fixtures::repository("tests/golden").join(format!("{name}.png"))
}

/// A picture as small a PNG file as there is: every clone of the repository holds them all.
fn encode(pixmap: &Pixmap) -> Vec<u8> {
    let mut bytes = Vec::new();
    PngEncoder::new_with_quality(&mut bytes, CompressionType::Best, FilterType::Adaptive)
        .write_image(&pixmap.to_straight(), pixmap.width(), pixmap.height(), ExtendedColorType::Rgba8)
        .unwrap();
    bytes
}

#[test]
fn golden_pictures_are_drawn_to_the_byte() {
    let blessing = std::env::var_os("RASTRUM_BLESS").is_some_and(|value| value == "1");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
    let _ = fs::remove_dir_all(&folder);
    let (mut wrong, mut written) = (Vec::new(), Vec::new());
    for name in fixtures::all() {
        let actual = fixtures::render(&name, &fixtures::parse(&name), RenderSettings::default());
        let path = golden(&name);
        let text = if path.exists() {
            check(&name, &Pixmap::load_png(&path).unwrap(), &actual, &folder)
        } else {
            Some(format!("{name}: there is no tests/golden/{name}.png: see fixtures/README.md"))
        };
        let Some(text) = text else { continue };
        if blessing {
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, encode(&actual)).unwrap();
            written.push(format!("{text}\n  written {}", path.display()));
        } else {
            wrong.push(text);
        }
    }
    assert!(
        !blessing,
        "{} golden pictures were written: look at each, then run the test without RASTRUM_BLESS\n{}",
        written.len(),
        written.join("\n")
    );
    assert!(wrong.is_empty(), "{} pictures are wrong\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn golden_pictures_have_fixtures() {
    let fixtures = fixtures::all();
    for name in fixtures::names(&fixtures::repository("tests/golden"), "png") {
        let known = fixtures.binary_search(&name).is_ok();
        assert!(known, "tests/golden/{name}.png has no fixtures/{name}.svg: delete the picture or restore the drawing");
    }
}

#[test]
fn one_golden_pixel_off_by_one_is_found() {
    let mut expected = Pixmap::new(5, 3).unwrap();
    expected.data_mut().fill(200);
    let mut actual = expected.clone();
    assert_eq!(compare(&expected, &actual), None);
    actual.data_mut()[4 * (5 + 2) + 3] = 201;
    actual.data_mut()[4 * (10 + 4)] = 205;
    actual.data_mut()[4 * (10 + 4) + 1] = 197;
    let (difference, picture) = compare(&expected, &actual).unwrap();
    assert_eq!(difference, Difference { pixels: 2, largest: 5, at: (4, 2) });
    let lit = |x, y| picture.pixel(x, y).unwrap()[0] >= 80;
    assert_eq!((0..15).filter(|i| lit(i % 5, i / 5)).collect::<Vec<_>>(), [7, 14]);
}

#[test]
fn a_golden_mismatch_leaves_pictures_to_look_at() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden-mismatch");
    let (expected, actual) = (Pixmap::new(4, 4).unwrap(), Pixmap::new(4, 5).unwrap());
    let text = check("a/b", &expected, &actual, &folder).unwrap();
    assert!(text.contains("(4, 5) pixels large, not (4, 4)"), "{text}");
    let mut actual = expected.clone();
    actual.data_mut()[3] = 9;
    let text = check("a/b", &expected, &actual, &folder).unwrap();
    assert!(text.contains("1 pixels differ, by up to 9 at (0, 0)"), "{text}");
    for (kind, picture) in [("expected", expected), ("actual", actual)] {
        let path = folder.join(format!("a/b.{kind}.png"));
        assert!(text.contains(path.to_str().unwrap()), "{text}");
        assert_eq!(Pixmap::load_png(path).unwrap(), picture);
    }
    assert!(text.contains("b.difference.png") && folder.join("a/b.difference.png").exists(), "{text}");
}

#[test]
fn premultiplied_pixels_survive_their_golden_file() {
    // Every pair of alpha and colour that a premultiplied pixel can have.
    let mut pixmap = Pixmap::new(256, 256).unwrap();
    for (index, pixel) in pixmap.data_mut().as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let (alpha, color) = ((index >> 8) as u8, index as u8);
        *pixel = [color.min(alpha), 0, color.min(alpha) / 2, alpha];
    }
    assert_eq!(Pixmap::decode_png(&encode(&pixmap)).unwrap(), pixmap);
}
