//! Shapes, a gradient, a dashed stroke and a layer: `cargo run --example shapes` writes shapes.png.

use rastrum::{
    BlendMode, Canvas, Color, FillRule, GradientStop, LineCap, LinearGradient, Path, Point, Rect, Shadow, Stroke,
};

fn main() -> rastrum::Result<()> {
    let mut canvas = Canvas::new(480, 200)?;
    canvas.clear(Color::from_rgb8(250, 248, 240));

    // A card with a shadow.
    canvas.save();
    canvas.set_shadow(Shadow { offset_x: 0.0, offset_y: 4.0, deviation: 5.0, color: Color::BLACK.with_opacity(0.35) });
    let stops =
        [GradientStop::new(0.0, Color::from_rgb8(255, 190, 80)), GradientStop::new(1.0, Color::from_rgb8(230, 80, 90))];
    let card = Rect::from_xywh(20.0, 30.0, 130.0, 130.0);
    canvas.fill_round_rect(card, 18.0, LinearGradient::new((20.0, 30.0), (150.0, 160.0), stops));
    canvas.restore();

    // A star, filled by the even-odd rule.
    let star = [(240.0, 33.0), (278.2, 150.6), (178.2, 77.9), (301.8, 77.9), (201.8, 150.6)].map(Point::from);
    canvas.fill_polygon(&star, FillRule::EvenOdd, Color::from_rgb8(40, 90, 160));

    // A dashed wave.
    let mut wave = Path::new();
    wave.move_to((320.0, 60.0)).cubic_to((360.0, -10.0), (400.0, 130.0), (460.0, 50.0));
    canvas.stroke_path(
        &wave,
        &Stroke::new(6.0).with_cap(LineCap::Round).with_dash([14.0, 11.0], 0.0),
        Color::from_rgb8(20, 130, 110),
    );

    // Three discs that darken each other, then shown together at nine tenths.
    canvas.push_layer(0.9, BlendMode::SourceOver);
    for (x, y, color) in [(370.0, 125.0, (0, 170, 220)), (410.0, 125.0, (220, 40, 140)), (390.0, 155.0, (250, 220, 0))]
    {
        let ink = rastrum::Paint::new(Color::from_rgb8(color.0, color.1, color.2)).with_blend_mode(BlendMode::Multiply);
        canvas.fill_circle((x, y), 32.0, ink);
    }
    canvas.pop_layer();

    canvas.into_pixmap().save_png("shapes.png")?;
    println!("shapes.png");
    Ok(())
}
