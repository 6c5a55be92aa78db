//! Filters: usvg's, as the canvas's own.

use std::sync::Arc;

use super::convert;
use super::render::{Renderer, Step};
use super::warning::WarningKind;
use crate::canvas::{Canvas, LayerOptions};
use crate::color::Color;
use crate::filter::{
    Channel, ColorMatrix, ColorSpace, CompositeOperator, ConvolveMatrix, DiffuseLighting, DisplacementMap, EdgeMode,
    Filter, Grid, Input, Kind, LightSource, MorphologyOperator, Primitive, SpecularLighting, TransferFunction,
    Turbulence,
};
use crate::geom::{IntRect, Rect, Transform};
use usvg::filter as source;

impl Renderer<'_> {
    /// Begins the layers of a group's filters, the last one outermost, with `options` for that one.
    pub(super) fn push_filters(
        &mut self,
        group: &usvg::Group,
        options: LayerOptions,
        steps: &mut Vec<Step<'_>>,
        canvas: &mut Canvas<'_>,
    ) {
        let mut options = options;
        for (index, filter) in group.filters().iter().enumerate().rev() {
            if !self.count_layer() {
                return;
            }
            options = options.with_filter(self.filter(filter, canvas));
            // The innermost one's source is what the group draws.
            if index == 0 {
                options.content = Some(content(group));
            }
            canvas.push_layer_with(&options);
            steps.push(Step::PopLayer);
            options = LayerOptions::default();
        }
    }

    /// The filter for a layer that is begun now.
    fn filter(&mut self, filter: &source::Filter, canvas: &Canvas<'_>) -> Filter {
        let region = convert::rect(filter.rect());
        let mut out = Filter::new().with_region(region);
        let mut names: Vec<&str> = Vec::new();
        for primitive in filter.primitives() {
            let subregion = convert::rect(primitive.rect());
            let kind = self.kind(primitive.kind(), filter, subregion, &names, canvas);
            let color_space = match primitive.color_interpolation() {
                source::ColorInterpolation::SRGB => ColorSpace::Srgb,
                source::ColorInterpolation::LinearRGB => ColorSpace::LinearRgb,
            };
            out.add(Primitive::from(kind).with_subregion(subregion).with_color_space(color_space));
            names.push(primitive.result());
        }
        out
    }

    fn kind(
        &mut self,
        kind: &source::Kind,
        filter: &source::Filter,
        subregion: Rect,
        names: &[&str],
        canvas: &Canvas<'_>,
    ) -> Kind {
        let input = |input: &source::Input| match input {
            source::Input::SourceGraphic => Input::SourceGraphic,
            source::Input::SourceAlpha => Input::SourceAlpha,
            // The last result of that name; without one, usvg has made it something else.
            source::Input::Reference(name) => {
                names.iter().rposition(|known| known == name).map_or(Input::SourceGraphic, Input::Result)
            }
        };
        match kind {
            source::Kind::Blend(blend) => Kind::Blend {
                top: input(blend.input1()),
                bottom: input(blend.input2()),
                mode: convert::blend_mode(blend.mode()),
            },
            source::Kind::ColorMatrix(matrix) => {
                Kind::ColorMatrix { input: input(matrix.input()), matrix: color_matrix(matrix.kind()) }
            }
            source::Kind::ComponentTransfer(transfer) => Kind::ComponentTransfer {
                input: input(transfer.input()),
                functions: [transfer.func_r(), transfer.func_g(), transfer.func_b(), transfer.func_a()].map(function),
            },
            source::Kind::Composite(composite) => Kind::Composite {
                top: input(composite.input1()),
                bottom: input(composite.input2()),
                operator: operator(composite.operator()),
            },
            source::Kind::ConvolveMatrix(matrix) => {
                Kind::ConvolveMatrix { input: input(matrix.input()), matrix: convolve_matrix(matrix) }
            }
            source::Kind::DiffuseLighting(lighting) => Kind::DiffuseLighting {
                input: input(lighting.input()),
                lighting: DiffuseLighting {
                    surface_scale: lighting.surface_scale(),
                    diffuse_constant: lighting.diffuse_constant(),
                    color: color(lighting.lighting_color(), 1.0),
                    light: light(lighting.light_source()),
                },
            },
            source::Kind::SpecularLighting(lighting) => Kind::SpecularLighting {
                input: input(lighting.input()),
                lighting: SpecularLighting {
                    surface_scale: lighting.surface_scale(),
                    specular_constant: lighting.specular_constant(),
                    specular_exponent: lighting.specular_exponent(),
                    color: color(lighting.lighting_color(), 1.0),
                    light: light(lighting.light_source()),
                },
            },
            source::Kind::DisplacementMap(map) => Kind::DisplacementMap {
                input: input(map.input1()),
                map: input(map.input2()),
                displacement: DisplacementMap {
                    scale: map.scale(),
                    x_channel: channel(map.x_channel_selector()),
                    y_channel: channel(map.y_channel_selector()),
                },
            },
            source::Kind::DropShadow(shadow) => Kind::DropShadow {
                input: input(shadow.input()),
                dx: shadow.dx(),
                dy: shadow.dy(),
                deviation_x: shadow.std_dev_x().get(),
                deviation_y: shadow.std_dev_y().get(),
                color: color(shadow.color(), shadow.opacity().get()),
            },
            source::Kind::Flood(flood) => Kind::Flood { color: color(flood.color(), flood.opacity().get()) },
            source::Kind::GaussianBlur(blur) => Kind::GaussianBlur {
                input: input(blur.input()),
                deviation_x: blur.std_dev_x().get(),
                deviation_y: blur.std_dev_y().get(),
            },
            source::Kind::Image(image) => self.filter_image(image, filter, subregion, canvas),
            source::Kind::Merge(merge) => Kind::Merge { inputs: merge.inputs().iter().map(input).collect() },
            source::Kind::Morphology(morphology) => Kind::Morphology {
                input: input(morphology.input()),
                operator: match morphology.operator() {
                    source::MorphologyOperator::Erode => MorphologyOperator::Erode,
                    source::MorphologyOperator::Dilate => MorphologyOperator::Dilate,
                },
                radius_x: morphology.radius_x().get(),
                radius_y: morphology.radius_y().get(),
            },
            source::Kind::Offset(offset) => {
                Kind::Offset { input: input(offset.input()), dx: offset.dx(), dy: offset.dy() }
            }
            source::Kind::Tile(tile) => Kind::Tile { input: input(tile.input()) },
            source::Kind::Turbulence(noise) => Kind::Turbulence(Turbulence {
                frequency_x: noise.base_frequency_x().get(),
                frequency_y: noise.base_frequency_y().get(),
                octaves: noise.num_octaves(),
                seed: noise.seed(),
                stitch: noise.stitch_tiles(),
                fractal: noise.kind() == source::TurbulenceKind::FractalNoise,
            }),
        }
    }

    /// Draws the content of an `feImage` on a canvas of its own, at the resolution of the filter.
    fn filter_image(
        &mut self,
        image: &source::Image,
        filter: &source::Filter,
        subregion: Rect,
        canvas: &Canvas<'_>,
    ) -> Kind {
        let nothing = Kind::Merge { inputs: Vec::new() };
        let Some(space) = canvas.filter_space() else { return nothing };
        let grid = Grid::new(space.grid);
        let whole = grid.pixels(subregion);
        let area = whole.intersect(grid.pixels(convert::rect(filter.rect()))).intersect(space.near());
        if area.is_empty() {
            return nothing;
        }
        if !self.enter_canvas(filter.id()) {
            return nothing;
        }
        let fits = self.count_pixels(area.width(), area.height());
        let own = fits.then(|| Canvas::with_settings(area.width(), area.height(), canvas.settings()).ok());
        let Some(mut own) = own.flatten() else {
            self.leave_canvas();
            self.warnings.add(WarningKind::FilterSize, filter.id());
            return nothing;
        };
        let Transform { sx, sy, tx, ty, .. } = space.grid;
        let (x, y) = ((whole.left - area.left) as f32, (whole.top - area.top) as f32);
        own.transform(Transform::from_row(sx, 0.0, 0.0, sy, x, y));
        self.draw_children(image.root(), &mut own);
        self.leave_canvas();
        let IntRect { left, top, right, bottom } = area;
        // Back to user space; the filter rounds it to the same pixels.
        let destination = Rect::from_ltrb(
            (left as f32 - tx) / sx,
            (top as f32 - ty) / sy,
            (right as f32 - tx) / sx,
            (bottom as f32 - ty) / sy,
        );
        Kind::Image { image: Arc::new(own.into_pixmap()), destination }
    }
}

/// The box of what a group's children draw, filters included.
fn content(group: &usvg::Group) -> Rect {
    let mut all: Option<Rect> = None;
    for node in group.children() {
        let bounds = match node {
            usvg::Node::Group(child) => {
                convert::transform(child.transform()).map_rect(convert::rect(child.layer_bounding_box()))
            }
            _ => Some(convert::bounds(node.stroke_bounding_box())),
        };
        if let Some(bounds) = bounds {
            all = Some(all.map_or(bounds, |all| all.union(bounds)));
        }
    }
    all.unwrap_or_default()
}

fn color(color: usvg::Color, opacity: f32) -> Color {
    Color::from_rgb8(color.red, color.green, color.blue).with_opacity(opacity)
}

fn color_matrix(kind: &source::ColorMatrixKind) -> ColorMatrix {
    match kind {
        source::ColorMatrixKind::Matrix(values) => {
            ColorMatrix(std::array::from_fn(|index| values.get(index).copied().unwrap_or(0.0)))
        }
        source::ColorMatrixKind::Saturate(amount) => ColorMatrix::saturate(amount.get()),
        source::ColorMatrixKind::HueRotate(degrees) => ColorMatrix::hue_rotate(*degrees),
        source::ColorMatrixKind::LuminanceToAlpha => ColorMatrix::luminance_to_alpha(),
    }
}

fn function(function: &source::TransferFunction) -> TransferFunction {
    match function {
        source::TransferFunction::Identity => TransferFunction::Identity,
        source::TransferFunction::Table(values) => TransferFunction::Table(values.clone()),
        source::TransferFunction::Discrete(values) => TransferFunction::Discrete(values.clone()),
        source::TransferFunction::Linear { slope, intercept } => {
            TransferFunction::Linear { slope: *slope, intercept: *intercept }
        }
        source::TransferFunction::Gamma { amplitude, exponent, offset } => {
            TransferFunction::Gamma { amplitude: *amplitude, exponent: *exponent, offset: *offset }
        }
    }
}

fn operator(operator: source::CompositeOperator) -> CompositeOperator {
    match operator {
        source::CompositeOperator::Over => CompositeOperator::Over,
        source::CompositeOperator::In => CompositeOperator::In,
        source::CompositeOperator::Out => CompositeOperator::Out,
        source::CompositeOperator::Atop => CompositeOperator::Atop,
        source::CompositeOperator::Xor => CompositeOperator::Xor,
        source::CompositeOperator::Lighter => CompositeOperator::Lighter,
        source::CompositeOperator::Arithmetic { k1, k2, k3, k4 } => CompositeOperator::Arithmetic { k1, k2, k3, k4 },
    }
}

fn convolve_matrix(matrix: &source::ConvolveMatrix) -> ConvolveMatrix {
    let data = matrix.matrix();
    ConvolveMatrix {
        columns: data.columns(),
        rows: data.rows(),
        weights: data.data().to_vec(),
        target_x: data.target_x(),
        target_y: data.target_y(),
        divisor: matrix.divisor().get(),
        bias: matrix.bias(),
        edge_mode: match matrix.edge_mode() {
            source::EdgeMode::None => EdgeMode::None,
            source::EdgeMode::Duplicate => EdgeMode::Duplicate,
            source::EdgeMode::Wrap => EdgeMode::Wrap,
        },
        preserve_alpha: matrix.preserve_alpha(),
    }
}

fn channel(channel: source::ColorChannel) -> Channel {
    match channel {
        source::ColorChannel::R => Channel::Red,
        source::ColorChannel::G => Channel::Green,
        source::ColorChannel::B => Channel::Blue,
        source::ColorChannel::A => Channel::Alpha,
    }
}

fn light(light: source::LightSource) -> LightSource {
    match light {
        source::LightSource::DistantLight(light) => {
            LightSource::Distant { azimuth: light.azimuth, elevation: light.elevation }
        }
        source::LightSource::PointLight(light) => LightSource::Point { position: [light.x, light.y, light.z] },
        source::LightSource::SpotLight(light) => LightSource::Spot {
            position: [light.x, light.y, light.z],
            target: [light.points_at_x, light.points_at_y, light.points_at_z],
            exponent: light.specular_exponent.get(),
            cone_angle: light.limiting_cone_angle,
        },
    }
}
