//! SVG trees through the library: tiny drawings with pixels known by hand.

use rastrum::svg::{self, WarningKind, usvg};
use rastrum::{Antialias, Canvas, Pixmap, Transform};

const CLEAR: [u8; 4] = [0; 4];
const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

/// The drawing `content`, 8 × 8, and the warnings.
fn draw(content: &str) -> (Pixmap, Vec<svg::Warning>) {
    let text = format!("<svg xmlns='http://www.w3.org/2000/svg' width='8' height='8'>{content}</svg>");
    let tree = svg::parse(text.as_bytes(), &usvg::Options::default()).unwrap();
    let mut canvas = Canvas::new(8, 8).unwrap();
    let warnings = svg::render(&tree, Transform::IDENTITY, &mut canvas);
    (canvas.into_pixmap(), warnings)
}

/// The drawing `content`, which is drawn whole.
#[track_caller]
fn whole(content: &str) -> Pixmap {
    let (pixmap, warnings) = draw(content);
    assert_eq!(warnings, []);
    pixmap
}

#[track_caller]
fn assert_pixels<const N: usize>(pixmap: &Pixmap, pixels: [(u32, u32, [u8; 4]); N]) {
    for (x, y, expected) in pixels {
        let actual = pixmap.pixel(x, y).unwrap();
        // One level of difference is rounding's.
        let near = actual.iter().zip(expected).all(|(a, e)| a.abs_diff(e) <= 1);
        assert!(near, "({x}, {y}) is {actual:?}, not {expected:?}");
    }
}

#[test]
fn fill_and_stroke_in_both_orders() {
    let shape = "<rect x='2' y='2' width='4' height='4' fill='red' stroke='blue' stroke-width='2'";
    assert_pixels(&whole(&format!("{shape}/>")), [(0, 0, CLEAR), (1, 1, BLUE), (2, 2, BLUE), (3, 3, RED)]);
    let reversed = whole(&format!("{shape} paint-order='stroke'/>"));
    assert_pixels(&reversed, [(0, 0, CLEAR), (1, 1, BLUE), (2, 2, RED), (3, 3, RED)]);
}

#[test]
fn hidden_shapes_are_not_drawn() {
    assert_eq!(whole("<rect width='8' height='8' visibility='hidden'/>"), Pixmap::new(8, 8).unwrap());
}

#[test]
fn transforms_multiply_from_the_outside_in() {
    let pixmap = whole(
        "<g transform='translate(4 0)'><g transform='scale(2)'><rect width='1' height='2' fill='red'/></g></g>\
         <rect y='7' width='1' height='1' fill='blue'/>",
    );
    assert_pixels(&pixmap, [(3, 0, CLEAR), (4, 0, RED), (5, 3, RED), (6, 0, CLEAR), (4, 4, CLEAR), (0, 7, BLUE)]);
}

#[test]
fn even_odd_leaves_the_hole() {
    let path = "<path fill='red' d='M0 0H8V8H0Z M2 2H6V6H2Z'";
    assert_pixels(&whole(&format!("{path}/>")), [(0, 0, RED), (4, 4, RED)]);
    assert_pixels(&whole(&format!("{path} fill-rule='evenodd'/>")), [(0, 0, RED), (4, 4, CLEAR)]);
}

#[test]
fn shape_rendering_turns_antialiasing_off() {
    let soft = whole("<rect width='1.25' height='8' fill='red'/>");
    assert_pixels(&soft, [(0, 0, RED), (1, 0, [64, 0, 0, 64])]);
    let crisp = whole("<rect width='1.25' height='8' fill='red' shape-rendering='crispEdges'/>");
    assert_pixels(&crisp, [(0, 0, RED), (1, 0, CLEAR)]);
}

#[test]
fn the_settings_choose_the_antialiasing() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='8' height='8'><rect width='1.75' height='8'/></svg>";
    let tree = svg::parse(text.as_bytes(), &usvg::Options::default()).unwrap();
    let mut canvas = Canvas::new(8, 8).unwrap();
    let settings = svg::Settings::default().with_antialias(Antialias::None);
    svg::render_with(&tree, Transform::IDENTITY, &settings, &mut canvas);
    assert_eq!(canvas.into_pixmap().pixel(1, 0), Some([0, 0, 0, 255]));
}

#[test]
fn group_opacity_applies_to_the_group_as_one() {
    // Overlapping shapes at half opacity: the overlap shows the upper one alone.
    let pixmap = whole(
        "<g opacity='0.5'><rect width='6' height='8' fill='red'/><rect x='2' width='6' height='8' fill='blue'/></g>",
    );
    let half_red = [128, 0, 0, 128];
    let half_blue = [0, 0, 128, 128];
    assert_pixels(&pixmap, [(0, 0, half_red), (4, 4, half_blue), (7, 7, half_blue)]);
}

#[test]
fn opacities_of_nested_groups_multiply() {
    let nested = whole("<g opacity='0.5'><g opacity='0.5'><rect width='8' height='8' fill='red'/></g></g>");
    assert_pixels(&nested, [(0, 0, [64, 0, 0, 64])]);
    let both = whole("<g opacity='0.5'><g opacity='0.5'><rect width='8' height='8' fill='red' stroke='red'/></g></g>");
    assert_pixels(&both, [(0, 0, [64, 0, 0, 64]), (4, 4, [64, 0, 0, 64])]);
}

#[test]
fn blend_modes_meet_the_backdrop_and_isolation_hides_it() {
    let multiply = "<g style='mix-blend-mode:multiply'><rect width='8' height='8' fill='#808080'/></g>";
    let backdrop = "<rect width='8' height='8' fill='red'/>";
    // 255 · 128 / 255 = 128 in red; nothing in the others.
    assert_pixels(&whole(&format!("{backdrop}{multiply}")), [(4, 4, [128, 0, 0, 255])]);
    let isolated = whole(&format!("{backdrop}<g style='isolation:isolate'>{multiply}</g>"));
    assert_pixels(&isolated, [(4, 4, [128, 128, 128, 255])]);
    // The same with two shapes in the blended group, which makes it a layer.
    let two = "<g style='mix-blend-mode:multiply'><rect width='8' height='4' fill='#808080'/>\
               <rect width='8' height='4' y='4' fill='#808080'/></g>";
    assert_pixels(&whole(&format!("{backdrop}{two}")), [(1, 1, [128, 0, 0, 255]), (4, 6, [128, 0, 0, 255])]);
}

#[test]
fn a_clip_path_of_one_shape() {
    let clip = "<clipPath id='c'><rect x='2' width='2' height='8'/></clipPath>";
    for content in [
        "<rect width='8' height='8' fill='red'/>",
        "<rect width='8' height='8' fill='blue'/><rect width='8' height='8' fill='red'/>",
    ] {
        let pixmap = whole(&format!("{clip}<g clip-path='url(#c)'>{content}</g>"));
        assert_pixels(&pixmap, [(1, 1, CLEAR), (2, 1, RED), (3, 7, RED), (4, 1, CLEAR)]);
    }
}

#[test]
fn a_soft_clip_edge_shows_nothing_of_what_is_covered() {
    let pixmap = whole(
        "<clipPath id='c'><rect width='2.5' height='8'/></clipPath>\
         <g clip-path='url(#c)'><rect width='8' height='8' fill='blue'/><rect width='8' height='8' fill='red'/></g>",
    );
    assert_pixels(&pixmap, [(1, 1, RED), (2, 1, [128, 0, 0, 128]), (3, 1, CLEAR)]);
}

#[test]
fn a_clip_path_is_the_union_of_its_shapes() {
    let clip = "<clipPath id='c'><rect width='4' height='4'/><rect x='2' y='2' width='4' height='4'/></clipPath>";
    let pixmap = whole(&format!("{clip}<rect width='8' height='8' fill='red' clip-path='url(#c)'/>"));
    assert_pixels(&pixmap, [(0, 0, RED), (3, 3, RED), (5, 5, RED), (0, 5, CLEAR), (5, 0, CLEAR), (7, 7, CLEAR)]);
}

#[test]
fn an_empty_clip_path_hides_everything() {
    let pixmap = whole(
        "<clipPath id='c'><rect width='4' height='4' visibility='hidden'/></clipPath>\
         <rect width='8' height='8' fill='red' clip-path='url(#c)'/>",
    );
    assert_eq!(pixmap, Pixmap::new(8, 8).unwrap());
}

#[test]
fn clip_rule_and_transform_of_a_clip_path() {
    let pixmap = whole(
        "<clipPath id='c' transform='translate(1 0)'>\
         <path clip-rule='evenodd' d='M0 0H6V8H0Z M2 2H4V6H2Z'/></clipPath>\
         <rect width='8' height='8' fill='red' clip-path='url(#c)'/>",
    );
    assert_pixels(&pixmap, [(0, 0, CLEAR), (1, 0, RED), (3, 3, CLEAR), (5, 3, RED), (7, 0, CLEAR)]);
}

#[test]
fn clip_paths_on_clip_paths_and_on_their_shapes_intersect() {
    let rows = "<clipPath id='rows'><rect y='2' width='8' height='3'/></clipPath>";
    let pixmap = whole(&format!(
        "{rows}<clipPath id='c' clip-path='url(#rows)'><rect x='2' width='3' height='8'/></clipPath>\
         <rect width='8' height='8' fill='red' clip-path='url(#c)'/>"
    ));
    assert_pixels(&pixmap, [(2, 2, RED), (4, 4, RED), (1, 3, CLEAR), (3, 1, CLEAR), (3, 5, CLEAR), (5, 3, CLEAR)]);
    // One of two shapes is clipped: the union needs a mask.
    let pixmap = whole(&format!(
        "{rows}<clipPath id='c'><rect x='2' width='3' height='8' clip-path='url(#rows)'/>\
         <rect x='7' width='1' height='8'/></clipPath>\
         <rect width='8' height='8' fill='red' clip-path='url(#c)'/>"
    ));
    assert_pixels(&pixmap, [(2, 2, RED), (4, 4, RED), (3, 1, CLEAR), (6, 3, CLEAR), (7, 0, RED), (7, 7, RED)]);
}

#[test]
fn masks_by_luminance_and_by_alpha() {
    let masked = |kind: &str, fill: &str| {
        whole(&format!(
            "<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='8' height='8' style='mask-type:{kind}'>\
             <rect width='4' height='8' fill='{fill}'/></mask>\
             <g mask='url(#m)'><rect width='8' height='8' fill='red'/></g>"
        ))
    };
    assert_pixels(&masked("luminance", "white"), [(0, 0, RED), (3, 7, RED), (4, 0, CLEAR)]);
    assert_pixels(&masked("luminance", "black"), [(0, 0, CLEAR), (4, 0, CLEAR)]);
    // Green weighs 0.7152 of the luminance: 182.
    assert_pixels(&masked("luminance", "lime"), [(0, 0, [182, 0, 0, 182])]);
    assert_pixels(&masked("alpha", "black"), [(0, 0, RED), (4, 0, CLEAR)]);
}

#[test]
fn a_mask_ends_at_its_region_and_masks_multiply() {
    let pixmap = whole(
        "<mask id='n' maskUnits='userSpaceOnUse' x='0' y='0' width='8' height='4'>\
         <rect width='8' height='8' fill='white'/></mask>\
         <mask id='m' maskUnits='userSpaceOnUse' x='2' y='0' width='4' height='8' mask='url(#n)'>\
         <rect width='8' height='8' fill='white'/></mask>\
         <g mask='url(#m)' opacity='0.5'><rect width='8' height='8' fill='red'/></g>",
    );
    assert_pixels(
        &pixmap,
        [(1, 1, CLEAR), (2, 1, [128, 0, 0, 128]), (5, 3, [128, 0, 0, 128]), (6, 1, CLEAR), (3, 4, CLEAR)],
    );
}

#[test]
fn a_clip_and_a_mask_on_one_group_multiply() {
    let pixmap = whole(
        "<clipPath id='c'><rect width='2' height='8'/><rect x='4' width='2' height='8'/></clipPath>\
         <mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='8' height='8'>\
         <rect width='8' height='4' fill='white'/></mask>\
         <g clip-path='url(#c)' mask='url(#m)'><rect width='8' height='8' fill='red'/></g>",
    );
    assert_pixels(&pixmap, [(1, 1, RED), (2, 1, CLEAR), (5, 3, RED), (5, 5, CLEAR), (7, 1, CLEAR)]);
}

#[test]
fn gradients_take_transform_spread_and_opacity() {
    // Two hard stops: red up to half, blue after it.
    let stops = "<stop offset='0.5' stop-color='red'/><stop offset='0.5' stop-color='blue' stop-opacity='0.5'/>";
    let pixmap = whole(&format!(
        "<linearGradient id='g' gradientUnits='userSpaceOnUse' x1='0' x2='2' gradientTransform='scale(2 1)' \
         spreadMethod='repeat'>{stops}</linearGradient><rect width='8' height='8' fill='url(#g)'/>"
    ));
    let half = [0, 0, 128, 128];
    assert_pixels(&pixmap, [(0, 0, RED), (1, 0, RED), (2, 0, half), (3, 0, half), (4, 0, RED), (6, 0, half)]);
    let pixmap = whole(&format!(
        "<radialGradient id='g' gradientUnits='userSpaceOnUse' cx='4' cy='4' r='6'>{stops}</radialGradient>\
         <rect width='8' height='8' fill='url(#g)' fill-opacity='0.5'/>"
    ));
    // The corner's centre is 4.95 from the gradient's, beyond 3; a quarter is left of its blue.
    assert_pixels(&pixmap, [(4, 4, [128, 0, 0, 128]), (0, 0, [0, 0, 64, 64])]);
}

#[test]
fn a_pattern_repeats_its_tile() {
    let pattern = |size: &str, transform: &str| {
        whole(&format!(
            "<pattern id='p' patternUnits='userSpaceOnUse' width='{size}' height='4' patternTransform='{transform}'>\
             <rect width='2' height='4' fill='red'/><rect x='2' width='2' height='4' fill='blue'/></pattern>\
             <rect width='8' height='8' fill='url(#p)'/>"
        ))
    };
    assert_pixels(&pattern("4", ""), [(0, 0, RED), (1, 7, RED), (2, 0, BLUE), (4, 4, RED), (7, 7, BLUE)]);
    assert_pixels(&pattern("4", "translate(2 0)"), [(0, 0, BLUE), (2, 0, RED), (4, 4, BLUE)]);
    assert_pixels(&pattern("4", "scale(2 1)"), [(1, 1, RED), (2, 1, RED), (5, 1, BLUE)]);
}

#[test]
fn patterns_that_contain_each_other_end_in_a_warning() {
    let mut defs = String::new();
    for n in 0..40 {
        defs += &format!(
            "<pattern id='p{n}' patternUnits='userSpaceOnUse' width='8' height='8'>\
             <rect width='8' height='8' fill='url(#p{})'/></pattern>",
            n + 1
        );
    }
    let (_, warnings) = draw(&format!(
        "{defs}<pattern id='p40' width='1' height='1'><rect width='8' height='8'/></pattern>\
         <rect width='8' height='8' fill='url(#p0)'/>"
    ));
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert_eq!(warnings[0].kind, WarningKind::PatternDepth);
}

#[test]
fn a_huge_pattern_is_drawn_at_a_lower_resolution_and_says_so() {
    let (pixmap, warnings) = draw(
        "<pattern id='p' patternUnits='userSpaceOnUse' width='1e6' height='1e6'>\
         <rect width='1e6' height='1e6' fill='red'/></pattern><rect width='8' height='8' fill='url(#p)'/>",
    );
    assert_pixels(&pixmap, [(4, 4, RED)]);
    assert_eq!(
        warnings.iter().map(|w| (&w.kind, w.id.as_str())).collect::<Vec<_>>(),
        [(&WarningKind::PatternSize, "p")]
    );
}

/// A picture of 2 × 1 pixels, green and blue, as a link.
fn picture() -> String {
    let bytes = Pixmap::from_vec(2, 1, [GREEN, BLUE].concat()).unwrap().encode_png().unwrap();
    format!("data:image/png;base64,{}", base64(&bytes))
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for chunk in bytes.chunks(3) {
        let bits = chunk.iter().fold(0_u32, |bits, byte| bits << 8 | u32::from(*byte)) << (8 * (3 - chunk.len()));
        for digit in 0..4 {
            let value = (bits >> (18 - 6 * digit)) & 63;
            text.push(if digit <= chunk.len() { char::from(DIGITS[value as usize]) } else { '=' });
        }
    }
    text
}

#[test]
fn an_embedded_picture_is_drawn_under_transform_and_opacity() {
    let pixmap = whole(&format!(
        "<g opacity='0.5'><image href='{}' x='2' width='4' height='2' image-rendering='optimizeSpeed'/></g>",
        picture()
    ));
    let (green, blue) = ([0, 128, 0, 128], [0, 0, 128, 128]);
    assert_pixels(
        &pixmap,
        [(1, 0, CLEAR), (2, 0, green), (3, 1, green), (4, 0, blue), (5, 1, blue), (6, 0, CLEAR), (2, 2, CLEAR)],
    );
}

#[test]
fn a_broken_picture_is_left_out_with_a_warning_once() {
    // A whole header, so that the size is known, and no pixels after it.
    let bytes = Pixmap::from_vec(2, 1, [GREEN, BLUE].concat()).unwrap().encode_png().unwrap();
    let link = format!("data:image/png;base64,{}", base64(&bytes[..40]));
    let image = format!("<image id='broken' href='{link}' width='4' height='2'/>");
    let (pixmap, warnings) = draw(&format!("{image}<rect y='4' width='8' height='4' fill='red'/>"));
    assert_pixels(&pixmap, [(0, 0, CLEAR), (0, 4, RED)]);
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(matches!(warnings[0].kind, WarningKind::Image(_)), "{warnings:?}");
}

#[test]
fn a_nested_svg_image_is_clipped_to_its_size() {
    let inner = "<svg xmlns='http://www.w3.org/2000/svg' width='2' height='2'>\
                 <rect x='-5' y='-5' width='20' height='20' fill='red'/><rect width='1' height='2' fill='lime'/></svg>";
    let link = format!("data:image/svg+xml;base64,{}", base64(inner.as_bytes()));
    let pixmap = whole(&format!("<image href='{link}' x='2' y='2' width='4' height='4'/>"));
    assert_pixels(
        &pixmap,
        [(1, 3, CLEAR), (2, 2, GREEN), (3, 5, GREEN), (4, 2, RED), (5, 5, RED), (6, 3, CLEAR), (3, 6, CLEAR)],
    );
}

#[test]
fn filters_apply_before_clips_and_masks() {
    let move_by_4 = "<filter id='f' filterUnits='userSpaceOnUse' x='0' y='0' width='8' height='8'>\
                     <feOffset dx='4'/></filter>";
    let pixmap = whole(&format!(
        "{move_by_4}<clipPath id='c'><rect x='5' width='3' height='8'/></clipPath>\
         <g clip-path='url(#c)'><g filter='url(#f)'><rect width='4' height='4' fill='red'/></g></g>\
         <g filter='url(#f)' clip-path='url(#c)'><rect y='4' width='4' height='4' fill='lime'/></g>"
    ));
    assert_pixels(&pixmap, [(0, 0, CLEAR), (4, 0, CLEAR), (5, 0, RED), (4, 4, CLEAR), (7, 7, GREEN)]);
    let pixmap = whole(&format!(
        "{move_by_4}<mask id='m' maskUnits='userSpaceOnUse' x='0' y='0' width='8' height='8'><path d='M6 0h2v8h-2z' fill='white'/></mask>\
         <g filter='url(#f)' mask='url(#m)'><rect width='4' height='8' fill='red'/></g>"
    ));
    assert_pixels(&pixmap, [(1, 1, CLEAR), (5, 5, CLEAR), (6, 5, RED)]);
}

#[test]
fn a_filtered_group_fades_as_one() {
    let pixmap = whole(
        "<filter id='f'><feMerge><feMergeNode/></feMerge></filter><g filter='url(#f)' opacity='0.5'>\
         <rect width='8' height='8' fill='red'/><rect width='8' height='4' fill='lime'/></g>",
    );
    assert_pixels(&pixmap, [(2, 2, [0, 128, 0, 128]), (2, 6, [128, 0, 0, 128])]);
}

#[test]
fn a_filter_turns_with_its_element() {
    // To the right is down, under a quarter turn.
    let pixmap = whole(
        "<filter id='f' filterUnits='userSpaceOnUse' x='0' y='-8' width='8' height='8'><feOffset dx='4'/></filter>\
         <g transform='rotate(90)'><g filter='url(#f)'><rect y='-8' width='2' height='8' fill='red'/></g></g>",
    );
    assert_pixels(&pixmap, [(4, 1, CLEAR), (4, 3, CLEAR), (0, 4, RED), (7, 5, RED), (4, 6, CLEAR)]);
}

#[test]
fn filters_in_filters_and_pictures_in_filters_are_drawn() {
    let pixmap = whole(
        "<filter id='f' filterUnits='userSpaceOnUse' x='0' y='0' width='8' height='8'><feOffset dx='2'/></filter>\
         <rect id='r' width='2' height='2' fill='lime'/>\
         <filter id='i' filterUnits='userSpaceOnUse' x='0' y='0' width='8' height='8'><feImage href='#r'/><feOffset dy='6'/></filter>\
         <g filter='url(#f)'><g filter='url(#f)'><rect width='2' height='2' fill='red'/></g></g>\
         <rect width='1' height='1' filter='url(#i)'/>",
    );
    assert_pixels(&pixmap, [(1, 1, GREEN), (3, 1, CLEAR), (4, 1, RED), (5, 1, RED), (6, 1, CLEAR), (1, 7, GREEN)]);
}

#[test]
fn an_element_without_area_has_what_its_filter_paints() {
    let pixmap = whole(
        "<filter id='f' filterUnits='userSpaceOnUse' x='2' y='2' width='4' height='4'><feFlood flood-color='red'/></filter>\
         <g filter='url(#f)'/>",
    );
    assert_pixels(&pixmap, [(1, 1, CLEAR), (2, 2, RED), (5, 5, RED), (6, 6, CLEAR)]);
}

#[test]
fn masks_of_masks_of_masks_end() {
    // Ten shapes in each mask, each under the next: ten to the fifth in all.
    let mut defs = String::new();
    for n in 0..5 {
        let shape = format!("<rect width='8' height='8' fill='white' mask='url(#m{})'/>", n + 1);
        defs += &format!(
            "<mask id='m{n}' maskUnits='userSpaceOnUse' x='0' y='0' width='8' height='8'>{}</mask>",
            shape.repeat(10)
        );
    }
    let (_, warnings) = draw(&format!(
        "{defs}<mask id='m5' maskUnits='userSpaceOnUse' x='0' y='0' width='8' height='8'><rect width='8' height='8' fill='white'/></mask><rect width='8' height='8' mask='url(#m0)'/>"
    ));
    assert_eq!(warnings.iter().map(|w| &w.kind).collect::<Vec<_>>(), [&WarningKind::TooComplex]);
}

#[test]
fn deep_groups_need_no_stack() {
    let text = format!(
        "<svg xmlns='http://www.w3.org/2000/svg' width='8' height='8'>{}<rect width='8' height='8' fill='red'/>\
         <rect width='4' height='8' fill='blue'/>{}</svg>",
        "<g style='isolation:isolate'>".repeat(1000),
        "</g>".repeat(1000)
    );
    let parse = move || svg::parse(text.as_bytes(), &usvg::Options::default()).unwrap();
    let tree = std::thread::Builder::new().stack_size(64 << 20).spawn(parse).unwrap().join().unwrap();
    // Half of what a thread has: the drawing itself does not recurse. The tree's own drop does.
    let tree = std::sync::Arc::new(tree);
    let shared = tree.clone();
    let draw = move || {
        let mut canvas = Canvas::new(8, 8).unwrap();
        let warnings = svg::render(&shared, Transform::IDENTITY, &mut canvas);
        (canvas.into_pixmap(), warnings)
    };
    let (pixmap, warnings) = std::thread::Builder::new().stack_size(1 << 20).spawn(draw).unwrap().join().unwrap();
    assert_eq!(warnings, []);
    assert_pixels(&pixmap, [(0, 0, BLUE), (7, 7, RED)]);
    std::thread::Builder::new().stack_size(64 << 20).spawn(move || drop(tree)).unwrap().join().unwrap();
}

#[test]
fn one_node_is_drawn_where_the_tree_shows_it() {
    let text = "<svg xmlns='http://www.w3.org/2000/svg' width='8' height='8'><g transform='translate(4 0)'>\
                <g id='inner' transform='scale(2)'><rect width='1' height='1' fill='red'/></g></g></svg>";
    let tree = svg::parse(text.as_bytes(), &usvg::Options::default()).unwrap();
    let mut canvas = Canvas::new(8, 8).unwrap();
    let node = tree.node_by_id("inner").unwrap();
    svg::render_node(node, Transform::from_translate(0.0, 4.0), &svg::Settings::default(), &mut canvas);
    assert_pixels(&canvas.into_pixmap(), [(3, 4, CLEAR), (4, 4, RED), (5, 5, RED), (4, 3, CLEAR), (6, 4, CLEAR)]);
}

#[test]
fn numbers_at_the_ends_of_their_range_end_in_a_picture() {
    for content in [
        "<rect width='1e30' height='1e30' fill='red'/>",
        "<rect width='1e-30' height='8' stroke='red' stroke-width='1e-30'/>",
        "<g transform='scale(1e20)'><rect width='8' height='8'/></g>",
        "<g transform='scale(0)' opacity='0.5'><rect width='8' height='8'/><rect width='8' height='8'/></g>",
        "<path d='M0 0L1e38 1e38L-1e38 5' stroke='red' stroke-width='1e10'/>",
        "<path d='M0 0L8 8' stroke='red' stroke-dasharray='1e-30 1e-30'/>",
        "<pattern id='p' patternUnits='userSpaceOnUse' width='1e-9' height='1e-9'><rect width='1' height='1'/></pattern>\
         <rect width='8' height='8' fill='url(#p)'/>",
    ] {
        // Whatever the picture is, it is the same once more.
        assert_eq!(draw(content).0, draw(content).0, "{content}");
    }
}

#[test]
fn an_image_cut_to_fit_is_clipped_to_its_place() {
    // 2 × 1 pixels over a square of 4: scaled by 4, green fills the square and blue lies outside it.
    let pixmap = whole(&format!(
        "<image href='{}' width='4' height='4' preserveAspectRatio='xMinYMin slice' image-rendering='optimizeSpeed'/>",
        picture()
    ));
    assert_pixels(&pixmap, [(0, 0, GREEN), (3, 3, GREEN), (4, 0, CLEAR), (7, 3, CLEAR), (0, 4, CLEAR)]);
}
