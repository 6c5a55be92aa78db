//! resvg: draws the SVG tree itself, with all that the list of shapes leaves out.

use resvg::tiny_skia::{Color, Pixmap, Transform};

use super::Engine;
use crate::drawings::fit;
use crate::scene::Scene;

pub struct Prepared<'s> {
    tree: &'s usvg::Tree,
    transform: Transform,
    target: Pixmap,
}

impl<'s> Prepared<'s> {
    pub fn new(scene: &Scene, tree: &'s usvg::Tree) -> Self {
        let scale = fit(tree).scale;
        let mut target = Pixmap::new(scene.width, scene.height).expect("the scene has a valid size");
        target.fill(Color::WHITE);
        Self { tree, transform: Transform::from_scale(scale, scale), target }
    }
}

impl Engine for Prepared<'_> {
    fn draw(&mut self) {
        self.target.fill(Color::WHITE);
        resvg::render(self.tree, self.transform, &mut self.target.as_mut());
    }

    fn picture(&mut self) -> Vec<u8> {
        self.target.data().to_vec()
    }
}
