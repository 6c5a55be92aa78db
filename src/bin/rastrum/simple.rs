//! Drawings that need no supervision.
//!
//! To start a worker takes longer than to draw an icon. A small drawing of shapes and gradients alone, nested a little, cannot
//! ask for more than it shows, and is drawn where it is.

use rastrum::svg::usvg::roxmltree::{Document, Node};

/// The longest text that is looked at.
pub(crate) const LONGEST: usize = 256 << 10;

/// How deep elements may be nested.
const DEEPEST: usize = 64;

/// What may occur. What refers to something that is drawn is left out, but for gradients: copies of copies are how few
/// lines ask for much.
const ELEMENTS: [&str; 17] = [
    "svg",
    "g",
    "path",
    "rect",
    "circle",
    "ellipse",
    "line",
    "polyline",
    "polygon",
    "defs",
    "linearGradient",
    "radialGradient",
    "stop",
    "title",
    "desc",
    "metadata",
    "a",
];

/// If a file's bytes are such a drawing: how many elements it has.
pub(crate) fn elements(bytes: &[u8]) -> Option<usize> {
    if bytes.len() > LONGEST {
        return None;
    }
    let text = std::str::from_utf8(bytes).ok()?;
    // A dash may be as short as one likes.
    if text.contains("dasharray") {
        return None;
    }
    // Without declarations, which the reader refuses by default, there are no entities.
    let document = Document::parse(text).ok()?;
    let elements = || document.descendants().filter(Node::is_element);
    let simple = elements().all(|node| {
        let known = ELEMENTS.contains(&node.tag_name().name());
        // The descriptions' own elements are not drawn.
        let described = || {
            node.ancestors().any(|node| ["metadata", "title", "desc"].contains(&node.tag_name().name()))
                || node.tag_name().namespace() != Some("http://www.w3.org/2000/svg")
        };
        (known || described()) && node.ancestors().take(DEEPEST + 1).count() <= DEEPEST
    });
    simple.then(|| elements().count())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(content: &str) -> bool {
        elements(format!("<svg xmlns='http://www.w3.org/2000/svg' xmlns:x='urn:x'>{content}</svg>").as_bytes())
            .is_some()
    }

    #[test]
    fn shapes_and_gradients_are_simple_and_what_copies_is_not() {
        assert!(of(
            "<title>t</title><g fill='url(#g)'><path d='M0 0H9V9Z'/></g><linearGradient id='g'><stop/></linearGradient>"
        ));
        assert!(of("<metadata><x:thing><x:other/></x:thing></metadata><x:view/>"));
        for element in
            ["use", "text", "image", "pattern", "mask", "clipPath", "filter", "marker", "style", "switch", "symbol"]
        {
            assert!(!of(&format!("<g><{element}/></g>")), "{element}");
        }
    }

    #[test]
    fn what_is_deep_long_or_no_xml_is_not() {
        assert!(of(&format!("{}{}", "<g>".repeat(60), "</g>".repeat(60))));
        assert!(!of(&format!("{}{}", "<g>".repeat(70), "</g>".repeat(70))));
        assert!(!of(&" ".repeat(300_000)));
        assert!(!of("<g style='stroke-dasharray:1e-9'/>"));
        let entity = "<!DOCTYPE svg [<!ENTITY a 'b'>]><svg xmlns='http://www.w3.org/2000/svg'>&a;</svg>";
        for text in [entity.as_bytes(), b"\xff", b"<svg", b""] {
            assert_eq!(elements(text), None);
        }
        assert_eq!(elements(b"<svg xmlns='http://www.w3.org/2000/svg'><g><path/></g></svg>"), Some(3));
    }
}
