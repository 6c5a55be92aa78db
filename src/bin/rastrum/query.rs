//! Which elements a drawing has, and where: for `--query-all`.

use std::fmt::Write as _;

use rastrum::svg::usvg::{Node, Rect, Tree};

use crate::args::QueryFormat;
use crate::json;

/// The elements that have an id, in the order in which they are drawn, with the boxes that they draw on: as lines of
/// id, x, y, width and height, or as one JSON array.
pub(crate) fn elements(tree: &Tree, format: QueryFormat) -> String {
    let mut lines = Vec::new();
    // What is still to visit, the next one last: depth is the file's choice.
    let mut nodes: Vec<&Node> = tree.root().children().iter().rev().collect();
    while let Some(node) = nodes.pop() {
        if !node.id().is_empty() {
            let area = drawn_box(node);
            let numbers = [area.x(), area.y(), area.width(), area.height()].map(number);
            lines.push(match format {
                // A line break or comma in an id would forge a field.
                QueryFormat::Text => format!("{},{}", plain(node.id()), numbers.join(",")),
                QueryFormat::Json => {
                    let [x, y, width, height] = &numbers;
                    let id = json::string(node.id());
                    format!("{{\"id\":{id},\"x\":{x},\"y\":{y},\"width\":{width},\"height\":{height}}}")
                }
            });
        }
        if let Node::Group(group) = node {
            nodes.extend(group.children().iter().rev());
        }
    }
    match format {
        QueryFormat::Text => lines.iter().fold(String::new(), |mut text, line| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{line}");
            text
        }),
        QueryFormat::Json => format!("[{}]\n", lines.join(",")),
    }
}

/// The box of what an element draws: strokes and filters included.
pub(crate) fn drawn_box(node: &Node) -> Rect {
    match node {
        Node::Group(group) => group.abs_layer_bounding_box().to_rect(),
        _ => node.abs_stroke_bounding_box(),
    }
}

/// To a thousandth.
fn number(value: f32) -> String {
    let rounded = (f64::from(value) * 1000.0).round() / 1000.0;
    if rounded == 0.0 { "0".to_owned() } else { rounded.to_string() }
}

fn plain(id: &str) -> String {
    let mut out = String::new();
    for c in id.chars() {
        if c.is_control() || c == ',' || c == '\\' { out.extend(c.escape_unicode()) } else { out.push(c) }
    }
    out
}
