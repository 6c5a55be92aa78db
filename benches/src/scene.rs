//! What is drawn, in no engine's own terms: each engine turns a [`Scene`] into its own types before the clock starts.

/// x and y in pixels, y down.
pub type Point = [f32; 2];

/// x' = a·x + c·y + e, y' = b·x + d·y + f, as in SVG's `matrix(a b c d e f)`.
pub type Transform = [f32; 6];

pub const IDENTITY: Transform = [1.0, 0.0, 0.0, 1.0, 0.0, 0.0];

/// Straight (not premultiplied) RGBA.
pub type Color = [u8; 4];

/// A picture: items drawn in order over opaque white.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    pub name: String,
    /// What it holds, in one line.
    pub title: String,
    pub width: u32,
    pub height: u32,
    pub items: Vec<Item>,
    pub clips: Vec<Clip>,
    pub images: Vec<Image>,
}

#[derive(Clone, Debug)]
pub struct Item {
    pub shape: Shape,
    pub style: Style,
    pub paint: Paint,
    /// From the shape's and the paint's space to pixels.
    pub transform: Transform,
    /// Which of the scene's clips it is drawn in.
    pub clip: Option<usize>,
}

/// Lets through what lies inside the shape and inside the clip's parents.
#[derive(Clone, Debug)]
pub struct Clip {
    pub parent: Option<usize>,
    pub shape: Shape,
    pub rule: Rule,
    pub transform: Transform,
}

#[derive(Clone, Debug)]
pub enum Shape {
    /// Left, top, right, bottom: engines have calls of their own for it.
    Rect([f32; 4]),
    Path(Vec<Segment>),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    Move(Point),
    Line(Point),
    Quad(Point, Point),
    Cubic(Point, Point, Point),
    Close,
}

#[derive(Clone, Debug)]
pub enum Style {
    Fill(Rule),
    Stroke(Stroke),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    NonZero,
    EvenOdd,
}

#[derive(Clone, Debug)]
pub struct Stroke {
    pub width: f32,
    pub cap: Cap,
    pub join: Join,
    pub miter_limit: f32,
    /// Lengths of dashes and gaps in turn, an even number of them; none for a solid line.
    pub dashes: Vec<f32>,
    pub dash_offset: f32,
}

#[derive(Clone, Copy, Debug)]
pub enum Cap {
    Butt,
    Round,
    Square,
}

#[derive(Clone, Copy, Debug)]
pub enum Join {
    Miter,
    Round,
    Bevel,
}

#[derive(Clone, Debug)]
pub enum Paint {
    Solid(Color),
    Linear {
        start: Point,
        end: Point,
        gradient: Gradient,
    },
    Radial {
        focus: Point,
        focal_radius: f32,
        center: Point,
        radius: f32,
        gradient: Gradient,
    },
    /// One of the scene's images, its edge pixels continued outwards.
    Image {
        index: usize,
        smooth: bool,
        opacity: f32,
        /// From the image's pixels to the item's space.
        transform: Transform,
    },
}

#[derive(Clone, Debug)]
pub struct Gradient {
    /// Positions in 0 ..= 1 that do not fall, with their colours.
    pub stops: Vec<(f32, Color)>,
    pub spread: Spread,
    pub opacity: f32,
    /// From the gradient's space to the item's.
    pub transform: Transform,
}

#[derive(Clone, Copy, Debug)]
pub enum Spread {
    Pad,
    Reflect,
    Repeat,
}

#[derive(Clone, Debug)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    /// Premultiplied RGBA.
    pub rgba: Vec<u8>,
}

impl Image {
    pub fn is_opaque(&self) -> bool {
        self.rgba.iter().skip(3).step_by(4).all(|alpha| *alpha == 255)
    }
}

impl Scene {
    pub fn new(name: &str, title: &str, side: u32) -> Self {
        Self { name: name.to_owned(), title: title.to_owned(), width: side, height: side, ..Self::default() }
    }

    /// Adds a shape filled with one colour.
    pub fn fill(&mut self, shape: Shape, rule: Rule, color: Color) {
        self.push(shape, Style::Fill(rule), Paint::Solid(color));
    }

    /// Adds an outline in one colour.
    pub fn stroke(&mut self, shape: Shape, stroke: Stroke, color: Color) {
        self.push(shape, Style::Stroke(stroke), Paint::Solid(color));
    }

    pub fn push(&mut self, shape: Shape, style: Style, paint: Paint) {
        self.items.push(Item { shape, style, paint, transform: IDENTITY, clip: None });
    }

    /// The clips that an item in `clip` is drawn in, outermost first.
    pub fn clip_chain(&self, clip: Option<usize>) -> Vec<usize> {
        let mut chain = Vec::new();
        let mut next = clip;
        while let Some(index) = next {
            chain.push(index);
            next = self.clips[index].parent;
        }
        chain.reverse();
        chain
    }
}

impl Stroke {
    pub fn new(width: f32) -> Self {
        Self { width, cap: Cap::Butt, join: Join::Miter, miter_limit: 4.0, dashes: Vec::new(), dash_offset: 0.0 }
    }
}

/// First `first`, then `then`.
pub fn concat(first: Transform, then: Transform) -> Transform {
    let [a, b, c, d, e, f] = first.map(f64::from);
    let [ta, tb, tc, td, te, tf] = then.map(f64::from);
    [ta * a + tc * b, tb * a + td * b, ta * c + tc * d, tb * c + td * d, ta * e + tc * f + te, tb * e + td * f + tf]
        .map(|v| v as f32)
}

/// The shape's points as one path.
pub fn segments(shape: &Shape) -> Vec<Segment> {
    match shape {
        Shape::Path(segments) => segments.clone(),
        Shape::Rect([l, t, r, b]) => {
            use Segment::{Close, Line, Move};
            vec![Move([*l, *t]), Line([*r, *t]), Line([*r, *b]), Line([*l, *b]), Close]
        }
    }
}
