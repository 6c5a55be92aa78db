//! SVG path data: the `d` attribute.

use super::Path;
use crate::error::{Error, Result};
use crate::geom::Point;
use svgtypes::{SimplePathSegment, SimplifyingPathParser};

impl Path {
    /// Reads SVG path data, such as `"M 10 10 h 20 v 20 z"`. An empty text is an empty path.
    ///
    /// # Errors
    ///
    /// [`Error::Format`] names the first fault and its position. (A browser would draw what comes before
    /// it; here nothing is kept.)
    pub fn from_svg_data(data: &str) -> Result<Self> {
        let point = |x: f64, y: f64| Point::new(x as f32, y as f32);
        let mut path = Self::new();
        for (read, segment) in SimplifyingPathParser::from(data).enumerate() {
            match segment.map_err(|fault| Error::Format(format!("path data, after {read} segments: {fault}")))? {
                SimplePathSegment::MoveTo { x, y } => path.move_to(point(x, y)),
                SimplePathSegment::LineTo { x, y } => path.line_to(point(x, y)),
                SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => {
                    path.cubic_to(point(x1, y1), point(x2, y2), point(x, y))
                }
                SimplePathSegment::Quadratic { x1, y1, x, y } => path.quad_to(point(x1, y1), point(x, y)),
                SimplePathSegment::ClosePath => path.close(),
            };
        }
        Ok(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::path::Verb;

    #[test]
    fn relative_and_shorthand_commands_are_resolved() {
        let path = Path::from_svg_data("m1 2 3 0v4h-3z l 1 1 q1 1 2 0 t2 0").unwrap();
        let mut expected = Path::new();
        expected.move_to((1.0, 2.0)).line_to((4.0, 2.0)).line_to((4.0, 6.0)).line_to((1.0, 6.0)).close();
        expected.line_to((2.0, 3.0)).quad_to((3.0, 4.0), (4.0, 3.0)).quad_to((5.0, 2.0), (6.0, 3.0));
        assert_eq!(path, expected);
    }

    #[test]
    fn an_arc_command_ends_where_it_says() {
        let path = Path::from_svg_data("M0 0 A 5 5 0 0 1 10 0").unwrap();
        assert_eq!(path.verbs()[1], Verb::CubicTo);
        let bounds = path.bounds().unwrap();
        assert!((bounds.top + 5.0).abs() < 0.01 && (bounds.right - 10.0).abs() < 0.01, "{bounds:?}");
    }

    #[test]
    fn faults_name_their_place() {
        for (data, place) in [("M 1 2 L 3 x", "11"), ("10 20", "1"), ("M 1 2 # 3", "7")] {
            match Path::from_svg_data(data) {
                Err(Error::Format(text)) => assert!(text.contains(place), "{data}: {text}"),
                other => panic!("{data}: {other:?}"),
            }
        }
        assert!(Path::from_svg_data("").unwrap().is_empty());
    }
}
