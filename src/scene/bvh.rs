//! A bounding volume hierarchy: boxes in boxes.
//!
//! Built from the top: each node's items are cut in two halves by the middle of their centres along the longest axis.

use super::bounds::{Aabb, Frustum};

/// A node of a [`Bvh`].
#[derive(Clone, Debug)]
pub struct BvhNode {
    /// The box of everything below.
    pub bounds: Aabb,
    /// The two children's numbers, or `None` for a leaf.
    pub children: Option<[usize; 2]>,
    /// The items of a leaf, as places in [`Bvh::items`].
    pub items: std::ops::Range<usize>,
}

/// A hierarchy over items that have boxes.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    /// The nodes; the first is the root. Empty without items.
    pub nodes: Vec<BvhNode>,
    /// Every item's number, exactly once, those of a leaf side by side.
    pub items: Vec<usize>,
    bounds: Vec<Aabb>,
}

/// The most items of a leaf.
const LEAF: usize = 4;

impl Bvh {
    /// Builds the hierarchy over items by their boxes.
    pub fn new(bounds: &[Aabb]) -> Self {
        let mut bvh = Self { nodes: Vec::new(), items: (0..bounds.len()).collect(), bounds: bounds.to_vec() };
        if !bounds.is_empty() {
            bvh.build(0..bounds.len());
        }
        bvh
    }

    /// Builds the node of a range of items; gives its number.
    fn build(&mut self, range: std::ops::Range<usize>) -> usize {
        let all = &self.bounds;
        let items = self.items.get_mut(range.clone()).unwrap_or_default();
        let box_of = |i: &usize| all.get(*i).copied().unwrap_or(Aabb::EMPTY);
        let bounds = items.iter().map(box_of).fold(Aabb::EMPTY, |a, b| a.union(&b));
        let number = self.nodes.len();
        let leaf = items.len() <= LEAF;
        self.nodes.push(BvhNode { bounds, children: None, items: if leaf { range.clone() } else { 0..0 } });
        if leaf {
            return number;
        }
        let centers = Aabb::of_points(items.iter().map(|i| box_of(i).center()));
        let side = |i: usize| centers.max[i] - centers.min[i];
        let axis = (0..3).max_by(|a, b| side(*a).total_cmp(&side(*b))).unwrap_or(0);
        let middle = items.len() / 2;
        // Equal centres are told apart by number, so that the tree does not depend on how the selection works.
        items.select_nth_unstable_by(middle, |a, b| {
            box_of(a).center()[axis].total_cmp(&box_of(b).center()[axis]).then(a.cmp(b))
        });
        let left = self.build(range.start..range.start + middle);
        let right = self.build(range.start + middle..range.end);
        if let Some(node) = self.nodes.get_mut(number) {
            node.children = Some([left, right]);
        }
        number
    }

    /// The items whose boxes may be visible, in rising order, and how many boxes were tested to find them.
    pub fn query(&self, frustum: &Frustum) -> (Vec<usize>, usize) {
        let (mut found, mut tests, mut stack) = (Vec::new(), 0, vec![0]);
        while let Some(node) = stack.pop().and_then(|number| self.nodes.get(number)) {
            tests += 1;
            if !frustum.meets(&node.bounds) {
                continue;
            }
            match node.children {
                Some(children) => stack.extend(children),
                None => {
                    for item in self.items.get(node.items.clone()).unwrap_or_default() {
                        tests += 1;
                        if self.bounds.get(*item).is_some_and(|bounds| frustum.meets(bounds)) {
                            found.push(*item);
                        }
                    }
                }
            }
        }
        found.sort_unstable();
        (found, tests)
    }
}
