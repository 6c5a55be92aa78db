//! An SVG file to a PNG file of a given width: `cargo run --example svg_to_png drawing.svg 800 drawing.png`.

use rastrum::{Canvas, Color, Transform, svg};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, width, output] = &arguments[..] else {
        return Err("usage: svg_to_png <input.svg> <width> <output.png>".into());
    };
    let tree = svg::parse(&std::fs::read(input)?, &svg::usvg::Options::default())?;
    let scale = width.parse::<f32>()? / tree.size().width();
    let height = (tree.size().height() * scale).round().max(1.0);
    let mut canvas = Canvas::new(width.parse()?, height as u32)?;
    canvas.clear(Color::WHITE);
    for warning in svg::render(&tree, Transform::from_scale(scale, scale), &mut canvas) {
        eprintln!("{input}: {warning}");
    }
    canvas.into_pixmap().save_png(output)?;
    Ok(())
}
