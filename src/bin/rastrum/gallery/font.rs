//! Letters for labels: capitals, digits and signs as strokes, so that pictures need no font file.

use rastrum::{Path, Point};

/// How wide a letter is with the gap behind it, as a share of its height.
const ADVANCE: f32 = 0.9;

/// The strokes of a letter on a grid of 4 × 6: points as two digits (x, y), strokes parted by semicolons.
fn strokes(letter: char) -> &'static str {
    match letter.to_ascii_uppercase() {
        'A' => "06 02 20 42 46;04 44",
        'B' => "00 06 36 45 44 33 03;00 30 41 42 33",
        'C' => "41 30 10 01 05 16 36 45",
        'D' => "00 06 26 44 42 20 00",
        'E' => "40 00 06 46;03 33",
        'F' => "40 00 06;03 33",
        'G' => "41 30 10 01 05 16 36 45 43 23",
        'H' => "00 06;40 46;03 43",
        'I' => "10 30;20 26;16 36",
        'J' => "40 45 36 16 05",
        'K' => "00 06;40 03 46",
        'L' => "00 06 46",
        'M' => "06 00 23 40 46",
        'N' => "06 00 46 40",
        'O' => "10 30 41 45 36 16 05 01 10",
        '0' => "10 30 41 45 36 16 05 01 10;32 14",
        'P' => "06 00 30 41 42 33 03",
        'Q' => "10 30 41 45 36 16 05 01 10;24 46",
        'R' => "06 00 30 41 42 33 03;23 46",
        'S' => "41 30 10 01 02 13 33 44 45 36 16 05",
        'T' => "00 40;20 26",
        'U' => "00 05 16 36 45 40",
        'V' => "00 26 40",
        'W' => "00 16 23 36 40",
        'X' => "00 46;40 06",
        'Y' => "00 23 40;23 26",
        'Z' => "00 40 06 46",
        '1' => "11 20 26;16 36",
        '2' => "01 10 30 41 42 06 46",
        '3' => "01 10 30 41 42 33 44 45 36 16 05;33 13",
        '4' => "36 30 04 44",
        '5' => "40 00 02 32 43 45 36 16 05",
        '6' => "41 30 10 01 05 16 36 45 44 33 03",
        '7' => "00 40 16",
        '8' => "10 30 41 42 33 13 02 01 10;13 04 05 16 36 45 44 33",
        '9' => "43 13 02 01 10 30 41 45 36 16 05",
        '.' => "25 26",
        ',' => "25 17",
        '-' => "13 33",
        '+' => "03 43;21 25",
        '=' => "02 42;04 44",
        '(' => "30 21 25 36",
        ')' => "10 21 25 16",
        '/' => "06 40",
        ':' => "21 22;24 25",
        '<' => "40 03 46",
        '>' => "00 43 06",
        '%' => "06 40;00 10 11 01 00;35 45 46 36 35",
        '*' => "11 35;31 15",
        '^' => "02 20 42",
        '\'' => "20 21",
        '|' => "20 26",
        '?' => "01 10 30 41 42 23 24;25 26",
        _ => "",
    }
}

/// The width of a text whose capitals are `height` high.
pub(crate) fn width(text: &str, height: f32) -> f32 {
    (text.chars().count() as f32 * ADVANCE - 0.23) * height
}

/// The strokes of a text whose upper left corner is at (x, y).
pub(crate) fn outline(text: &str, x: f32, y: f32, height: f32) -> Path {
    let unit = height / 6.0;
    let mut path = Path::new();
    for (i, letter) in text.chars().enumerate() {
        let left = x + i as f32 * ADVANCE * height;
        for stroke in strokes(letter).split(';') {
            for (k, point) in stroke.split_whitespace().enumerate() {
                let mut digits = point.bytes().map(|digit| f32::from(digit.wrapping_sub(b'0')));
                let (Some(px), Some(py)) = (digits.next(), digits.next()) else { continue };
                let at = Point::new(left + px * unit, y + py * unit);
                if k == 0 {
                    path.move_to(at);
                } else {
                    path.line_to(at);
                }
            }
        }
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capitals_digits_and_signs_have_strokes() {
        for letter in ('A'..='Z').chain('0'..='9').chain(".,-+=()/:<>%*^'|?".chars()) {
            assert!(!outline(&letter.to_string(), 0.0, 0.0, 6.0).is_empty(), "{letter}");
        }
        assert!(outline(" ", 0.0, 0.0, 6.0).is_empty());
    }
}
