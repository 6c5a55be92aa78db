//! A tree of boxes around edges, by which those are found that may meet.
//!
//! Edges that follow each other lie near each other: eight of them are a *node*, eight nodes one of the level above, if there are more
//! than a few. A box is compared with eight at once.

use core::ops::Range;

use fearless_simd::prelude::*;
use fearless_simd::{f32x8, i32x4, i32x8};

use super::edge::{FixedPoint, coordinates, for_eights};
use super::star::{Eight, Turn, Way};
use crate::num::lanes::{least_of_each, max_i32, min_i32};

/// A box's left and upper side, and its right and lower one with all bits turned around (`!`), as are those of a [`Node`]: the box around others
/// then has the least of all four, and two boxes meet if the sum of each one's `left` and the other's `right`, and so on, is below 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds([i32; 4]);

/// The boxes of up to eight edges or nodes. Where there are fewer, the others are empty.
#[derive(Clone, Copy, Debug)]
struct Node {
    left: [i32; 8],
    top: [i32; 8],
    right: [i32; 8],
    bottom: [i32; 8],
    around: Bounds,
    /// The first of them: the number of the corner at which an edge starts, or of a node in the level below.
    first: u32,
    /// The first and the last edge of the outline that all of them belong to; meaningless where they do not.
    outline: [u32; 2],
    /// Above the lowest level: the ways that all edges go, those along the other axis counted among them. Known for sure only where there is one
    /// across and one down.
    ways: u8,
    /// Whether all go one way or around a point, and so meet only where they follow each other.
    is_ordered: bool,
    /// Whether the whole outline goes around a point once, so that none of its edges meet but where they follow each other.
    is_star: bool,
    /// Of nodes, those of which this holds, as bits.
    ordered: u8,
}

// In the order of a box's sides at which what goes such a way ends.
const LEFT: u8 = 1;
const UP: u8 = 2;
const RIGHT: u8 = 4;
const DOWN: u8 = 8;

/// Two nodes of a level above the lowest, or one twice, that are still to be compared.
#[derive(Clone, Copy, Debug)]
struct Pair {
    level: u32,
    one: u32,
    other: u32,
}

/// The tree.
#[derive(Debug, Default)]
pub(super) struct Boxes {
    /// The nodes around edges: the first so many of these. The others are what earlier shapes left, to be written over.
    edges: Vec<Node>,
    used: usize,
    /// The levels above them, upwards.
    levels: Vec<Vec<Node>>,
    /// How many levels there are, that of the edges counted.
    height: usize,
    pairs: Vec<Pair>,
}

/// So many nodes around edges are compared with each other one by one: a level above them would take as long to build.
pub(super) const FEW: usize = 20;

/// An edge: the numbers of its corners.
pub(super) type Numbers = [u32; 2];

impl Boxes {
    pub(super) fn clear(&mut self) {
        self.levels.iter_mut().for_each(Vec::clear);
        (self.used, self.height) = (0, 0);
    }

    /// The number of nodes around edges so far.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.used
    }

    /// Keeps so many of them.
    #[inline(always)]
    pub(super) fn truncate(&mut self, len: usize) {
        self.used = self.used.min(len);
    }

    /// Those in `nodes`.
    #[inline(always)]
    fn edges(&self, nodes: Range<usize>) -> &[Node] {
        self.edges.get(nodes).unwrap_or(&[])
    }

    /// Adds the `count` edges of an outline, each from one of `corners` to the next, and says which box is around them and, if it is found to
    /// go around a point once, which way it turns. The first corner has number `first` and is there once more at the end, and as often as it takes
    /// to make the number of corners a multiple of eight. `None`, and nothing is added, if one of the edges has no length.
    #[inline(always)]
    pub(super) fn add<S: Simd>(
        &mut self,
        simd: S,
        corners: &[FixedPoint],
        count: usize,
        first: u32,
    ) -> Option<(Bounds, Option<Way>)> {
        let outline = [first, first + count.saturating_sub(1) as u32];
        let (start, mut have_length, mut around) = (self.used, true, Bounds::EMPTY);
        let end = start + count.div_ceil(8);
        if end > self.edges.len() {
            self.edges.resize(end, Node::EMPTY);
        }
        // Made where they stay: a node that is moved is written in parts and read as a whole, and then has to be waited for.
        let nodes = self.edges.get_mut(start..end)?;
        let mut turn = Turn::of(corners, count);
        let mut unset = nodes.iter_mut();
        for_eights(
            corners,
            count,
            #[inline(always)]
            |place, eight, next, count| {
                if let Some(node) = unset.next() {
                    have_length &= node.set_edges(simd, eight, next, count, &mut turn);
                    (node.first, node.outline) = (first + place as u32, outline);
                    around = around.with(node.around);
                }
            },
        );
        if !have_length {
            return None;
        }
        self.used = end;
        let way = turn.whole();
        if way.is_some() {
            for node in nodes {
                (node.is_star, node.is_ordered, node.ordered) = (true, true, 0xff);
            }
        }
        Some((around, way))
    }

    /// The leftmost corner of the outline whose edges are in `nodes`, and that lies in a box; of several the last, which is moved to the
    /// right least ([`orientation`](super::orientation)).
    #[inline(always)]
    pub(super) fn leftmost<S: Simd>(
        &self,
        simd: S,
        nodes: Range<usize>,
        Bounds([left, ..]): Bounds,
        corners: &[FixedPoint],
    ) -> Option<u32> {
        for node in self.edges(nodes).iter().rev() {
            let mut lanes = i32x8::load_array_ref(simd, &node.left).simd_eq(left).to_bitmask() as u32;
            while let Some(lane) = lanes.checked_ilog2() {
                let number = node.first + lane;
                // It may be where the edge ends, too: then, the outline's first corner.
                if corners.get(number as usize)?.x == left {
                    return Some(number);
                }
                lanes &= !(1 << lane);
            }
        }
        None
    }

    /// Builds the levels above the edges, where there are more than [`FEW`] nodes around those.
    #[inline(always)]
    pub(super) fn build<S: Simd>(&mut self, simd: S) {
        let Self { edges, used, levels, height, .. } = self;
        *height = 1;
        let mut count = *used;
        while count > if *height == 1 { FEW } else { 1 } {
            if levels.len() < *height {
                levels.push(Vec::new());
            }
            let Some((below, [level, ..])) = levels.split_at_mut_checked(*height - 1) else { break };
            let (below, are_edges) =
                below.last().map_or_else(|| (edges.get(..*used).unwrap_or(&[]), true), |below| (below, false));
            for (first, nodes) in (0..).step_by(8).zip(below.chunks(8)) {
                level.push(Node::of_nodes(simd, nodes, first, are_edges));
            }
            (count, *height) = (level.len(), *height + 1);
        }
    }

    /// Calls `meet` with any two edges whose boxes meet, and that do not follow each other, until it returns false. False then, and where `looks` do not suffice.
    #[inline(always)]
    pub(super) fn for_pairs<S: Simd>(
        &mut self,
        simd: S,
        looks: &mut usize,
        mut meet: impl FnMut(Numbers, Numbers) -> bool,
    ) -> bool {
        let Self { edges, used, levels, height, pairs } = self;
        let edges = edges.get(..*used).unwrap_or(&[]);
        let Some(top) = height.checked_sub(1) else { return true };
        if top == 0 {
            return take_looks(looks, for_pairs_of_few(simd, edges, &mut meet));
        }
        pairs.clear();
        pairs.push(Pair { level: top as u32, one: 0, other: 0 });
        while let Some(Pair { level, one, other }) = pairs.pop() {
            let Some(lower) = level.checked_sub(1) else { break };
            let [below, level_nodes] = [lower, level].map(|level| nodes_of(edges, levels, level));
            let (Some(own), Some(others)) = (level_nodes.get(one as usize), level_nodes.get(other as usize)) else {
                break;
            };
            if own.is_star_of(others) {
                continue;
            }
            let mut lanes = own.near(simd, others.around);
            let mut used = 1 + lanes.count_ones() as usize;
            while lanes != 0 {
                let lane = lanes.trailing_zeros();
                lanes &= lanes - 1;
                let mut near = others.near(simd, own.bounds(lane));
                if one == other {
                    near &= !(u32::from(own.ordered) & 1 << lane) & !0 << lane;
                }
                while near != 0 {
                    let (one, other) = (own.first + lane, others.first + near.trailing_zeros());
                    near &= near - 1;
                    if level > 1 {
                        pairs.push(Pair { level: lower, one, other });
                    } else if let (Some(own), Some(others)) = (below.get(one as usize), below.get(other as usize))
                        && !own.is_star_of(others)
                    {
                        match own.for_pairs(simd, others, &mut meet) {
                            Some(more) => used += more,
                            None => return false,
                        }
                    }
                }
            }
            if !take_looks(looks, Some(used)) {
                return false;
            }
        }
        true
    }

    /// Calls `found` with those edges in `nodes` whose boxes lie beside a point, to its left or around it. Says how many nodes it looked at.
    #[inline(always)]
    pub(super) fn for_left_of_in<S: Simd>(
        &self,
        simd: S,
        nodes: Range<usize>,
        point: FixedPoint,
        mut found: impl FnMut(Numbers),
    ) -> usize {
        let nodes = self.edges(nodes);
        for node in nodes {
            let mut near = node.near(simd, Bounds::left_of(point));
            while near != 0 {
                found(node.numbers(node.first + near.trailing_zeros()));
                near &= near - 1;
            }
        }
        nodes.len()
    }

    /// Calls `found` with the edges whose boxes lie beside a point, to its left or around it. False where `looks` do not suffice.
    #[inline(always)]
    pub(super) fn for_left_of<S: Simd>(
        &mut self,
        simd: S,
        point: FixedPoint,
        looks: &mut usize,
        mut found: impl FnMut(Numbers),
    ) -> bool {
        if self.height == 1 {
            let used = self.for_left_of_in(simd, 0..self.len(), point, found);
            return take_looks(looks, Some(used));
        }
        let Self { edges, levels, height, pairs, .. } = self;
        let Some(top) = height.checked_sub(1) else { return true };
        let beside = Bounds::left_of(point);
        pairs.clear();
        pairs.push(Pair { level: top as u32, one: 0, other: 0 });
        while let Some(Pair { level, one, .. }) = pairs.pop() {
            let Some(node) = nodes_of(edges, levels, level).get(one as usize) else { break };
            let mut near = node.near(simd, beside);
            if !take_looks(looks, Some(1)) {
                return false;
            }
            while near != 0 {
                let index = node.first + near.trailing_zeros();
                near &= near - 1;
                if level > 0 {
                    pairs.push(Pair { level: level - 1, one: index, other: index });
                } else {
                    found(node.numbers(index));
                }
            }
        }
        true
    }
}

/// Those of a level.
#[inline(always)]
fn nodes_of<'a>(edges: &'a [Node], levels: &'a [Vec<Node>], level: u32) -> &'a [Node] {
    match (level as usize).checked_sub(1) {
        Some(above) => levels.get(above).map_or(&[], Vec::as_slice),
        None => edges,
    }
}

/// Takes what was used from the looks that are left; false where they do not suffice, or where there is no more to be used for.
#[inline(always)]
fn take_looks(looks: &mut usize, used: Option<usize>) -> bool {
    match used.and_then(|used| looks.checked_sub(used)) {
        Some(rest) => {
            *looks = rest;
            true
        }
        None => false,
    }
}

/// [`Boxes::for_pairs`] of up to 31 nodes around edges, compared with each other one by one. Says how many looks that took; `None` where `meet`
/// returned false.
#[inline(always)]
fn for_pairs_of_few<S: Simd>(
    simd: S,
    nodes: &[Node],
    meet: &mut impl FnMut(Numbers, Numbers) -> bool,
) -> Option<usize> {
    let mut looks = 1;
    for (index, own) in nodes.iter().enumerate() {
        // The node itself, then those further on.
        let mut near = u32::from(!own.is_ordered);
        let skipped = own.nodes_to_skip();
        let turned = own.around.turned(simd);
        for (lane, other) in (skipped..).zip(nodes.get(index + skipped..).unwrap_or(&[])) {
            near |= u32::from(other.around.meets(simd, turned)) << lane;
        }
        while near != 0 {
            let other = nodes.get(index + near.trailing_zeros() as usize)?;
            near &= near - 1;
            looks += own.for_pairs(simd, other, meet)?;
        }
    }
    Some(looks)
}

impl Node {
    const EMPTY: Self = Self {
        left: [NOWHERE; 8],
        top: [NOWHERE; 8],
        right: [NOWHERE; 8],
        bottom: [NOWHERE; 8],
        around: Bounds::EMPTY,
        first: 0,
        outline: [0; 2],
        ways: 0,
        is_ordered: false,
        is_star: false,
        ordered: 0,
    };

    /// Makes it that of the first `count` of the edges between eight corners and the next, and says whether all of them have a length. `turn` is
    /// that of the edges before.
    #[inline(always)]
    fn set_edges<S: Simd>(
        &mut self,
        simd: S,
        corners: &[FixedPoint; 8],
        next: FixedPoint,
        count: usize,
        turn: &mut Turn,
    ) -> bool {
        let (from_x, from_y) = coordinates(simd, corners);
        // Not loaded as well, from between what was just written.
        let (to_x, to_y) =
            (from_x.slide::<1>(i32x8::splat(simd, next.x)), from_y.slide::<1>(i32x8::splat(simd, next.y)));
        let edges = Eight { from: [from_x, from_y], to: [to_x, to_y], count };
        let others = !0_u32 << count & 0xff;
        let have_length = (from_x.simd_eq(to_x) & from_y.simd_eq(to_y)).to_bitmask() as u32 & !others == 0;
        let mut is_ordered = turn.goes_on() && turn.go(simd, &edges);
        if !turn.goes_on() {
            // Each goes some way along the line from the first corner to the last. The margin is more than what rounding may add.
            let (start, end) = (corners[0], corners.get(count).unwrap_or(&next));
            let chord = (end.x - start.x, end.y - start.y);
            let (across, down) = ((to_x - from_x).to_float::<f32x8<S>>(), (to_y - from_y).to_float::<f32x8<S>>());
            let (across, down) = (across * chord.0 as f32, down * chord.1 as f32);
            let margin = (across.abs() + down.abs()) * (1.0 / (1 << 20) as f32);
            is_ordered = (across + down).simd_gt(margin).to_bitmask() as u32 | others == 0xff;
        }
        let (mut left, mut right) = (min_i32(from_x, to_x), !max_i32(from_x, to_x));
        let (mut top, mut bottom) = (min_i32(from_y, to_y), !max_i32(from_y, to_y));
        if count < 8 {
            let is_one = i32x8::load_array(simd, [0, 1, 2, 3, 4, 5, 6, 7]).simd_lt(count as i32);
            let nowhere = i32x8::splat(simd, NOWHERE);
            (left, top) = (is_one.select(left, nowhere), is_one.select(top, nowhere));
            (right, bottom) = (is_one.select(right, nowhere), is_one.select(bottom, nowhere));
        }
        let around = Bounds(least_of_each([left, top, right, bottom]));
        left.store_array(&mut self.left);
        top.store_array(&mut self.top);
        right.store_array(&mut self.right);
        bottom.store_array(&mut self.bottom);
        self.around = around;
        (self.is_star, self.ways) = (false, 0);
        (self.is_ordered, self.ordered) = (is_ordered, if is_ordered { 0xff } else { 0 });
        have_length
    }

    /// At most eight nodes, of which the first is number `first`, and whether they are those of edges.
    #[inline(always)]
    fn of_nodes<S: Simd>(simd: S, nodes: &[Self], first: u32, are_edges: bool) -> Self {
        let outline = nodes.first().map_or([0; 2], |node| node.outline);
        let mut node = Self { first, outline, ..Self::EMPTY };
        let Self { left, top, right, bottom, .. } = &mut node;
        let (mut around, mut before) = (i32x4::splat(simd, NOWHERE), None);
        let (mut ordered, mut ways, mut is_one_outline) = (0, LEFT | UP | RIGHT | DOWN, true);
        let sides = left.iter_mut().zip(top).zip(right.iter_mut().zip(bottom));
        for ((lane, child), ((left, top), (right, bottom))) in nodes.iter().enumerate().zip(sides) {
            let own = i32x4::load_array_ref(simd, &child.around.0);
            if let Some(before) = before {
                ways &= i32x4::simd_eq(before, !child.around.turned(simd)).to_bitmask() as u8;
            }
            (around, before) = (min_i32(around, own), Some(own));
            ordered |= u8::from(child.is_ordered) << lane;
            is_one_outline &= child.outline == outline;
            [*left, *top, *right, *bottom] = child.around.0;
        }
        (node.around, node.ordered) = (Bounds(around.to_array()), ordered);
        if is_one_outline {
            if nodes.first().is_some_and(|child| child.is_star) {
                (node.is_star, node.is_ordered) = (true, true);
            } else if is_one_way(ways) {
                // Few get here.
                let own = |child: &Self| if are_edges { child.ways_of_edges() } else { child.ways };
                node.ways = nodes.iter().fold(ways, |ways, child| ways & own(child));
                node.is_ordered = is_one_way(node.ways);
            }
        }
        node
    }

    /// The ways that edges follow each other: each one's box ends where the next begins.
    #[inline(always)]
    fn ways_of_edges(&self) -> u8 {
        let Self { left, top, right, bottom, .. } = self;
        let count = left.iter().take_while(|left| **left != NOWHERE).count();
        let follow = |ends: &[i32; 8], starts: &[i32; 8], way: u8| {
            let starts = starts.iter().take(count).skip(1);
            if ends.iter().zip(starts).all(|(end, start)| *end == !*start) { way } else { 0 }
        };
        let across = follow(right, left, RIGHT) | follow(left, right, LEFT);
        across | follow(bottom, top, DOWN) | follow(top, bottom, UP)
    }

    /// Calls `meet` with the edges of this node and others of another, or the same, whose boxes meet, and that do not follow each other. Says how
    /// many it looked at; `None` where `meet` returned false.
    #[inline(always)]
    fn for_pairs<S: Simd>(
        &self,
        simd: S,
        others: &Self,
        meet: &mut impl FnMut(Numbers, Numbers) -> bool,
    ) -> Option<usize> {
        let is_same = self.first == others.first;
        let follows = others.first == self.first + 8 && self.outline == others.outline;
        let mut lanes = if is_same { self.near_own(simd) } else { self.near(simd, others.around) };
        if follows && lanes == 1 << 7 && others.near(simd, self.around) == 1 {
            return Some(1);
        }
        let looks = if is_same { Self::OWN_LOOKS } else { 1 + lanes.count_ones() as usize };
        while lanes != 0 {
            let lane = lanes.trailing_zeros();
            lanes &= lanes - 1;
            let mut near = others.near(simd, self.bounds(lane));
            if is_same {
                near &= !3 << lane;
            } else if follows && lane == 7 {
                near &= !1;
            }
            while near != 0 {
                let (edge, other) = (self.first + lane, others.first + near.trailing_zeros());
                near &= near - 1;
                if self.outline != [edge, other] && !meet(self.numbers(edge), others.numbers(other)) {
                    return None;
                }
            }
        }
        Some(looks)
    }

    /// Whether all of this and of another belongs to an outline whose edges do not meet.
    #[inline(always)]
    fn is_star_of(&self, other: &Self) -> bool {
        self.is_star && self.outline == other.outline
    }

    /// The corners of an edge.
    #[inline(always)]
    fn numbers(&self, edge: u32) -> Numbers {
        let [first, last] = self.outline;
        [edge, if edge == last { first } else { edge + 1 }]
    }

    /// So many nodes further on begin those that may meet this one: all that belongs to an outline whose edges do not meet is left out.
    #[inline(always)]
    fn nodes_to_skip(&self) -> usize {
        let [first, last] = self.outline;
        if self.is_star { (((last - first) >> 3) - ((self.first - first) >> 3) + 1) as usize } else { 1 }
    }

    /// The box in lane `lane`.
    #[inline(always)]
    fn bounds(&self, lane: u32) -> Bounds {
        let at = |lanes: &[i32; 8]| lanes.get(lane as usize & 7).copied().unwrap_or(0);
        Bounds([at(&self.left), at(&self.top), at(&self.right), at(&self.bottom)])
    }

    /// How many looks it counts for to compare a node's edges with each other.
    const OWN_LOOKS: usize = 4;

    /// Which boxes meet one of those that come after the next, as bits.
    #[inline(always)]
    fn near_own<S: Simd>(&self, simd: S) -> u32 {
        let load = |lanes: &[i32; 8]| i32x8::load_array_ref(simd, lanes);
        let (left, top, right, bottom) = (load(&self.left), load(&self.top), load(&self.right), load(&self.bottom));
        // Which boxes meet the one so many lanes further on, around the end.
        macro_rules! near {
            ($step:literal) => {{
                let meet = (left.slide::<$step>(left) + right)
                    & (left + right.slide::<$step>(right))
                    & (top.slide::<$step>(top) + bottom)
                    & (top + bottom.slide::<$step>(bottom));
                meet.simd_lt(0).to_bitmask() as u32
            }};
        }
        // Two of eight in a ring are at most four steps apart; those one step apart follow each other, but for the last and the first.
        let (first, second, third, fourth) = (near!(1), near!(2), near!(3), near!(4));
        first >> 7 | (second & 0x3f | second >> 6) | (third & 0x1f | third >> 5) | fourth & 0x0f
    }

    /// Which boxes meet another, as bits.
    #[inline(always)]
    fn near<S: Simd>(&self, simd: S, Bounds([left, top, right, bottom]): Bounds) -> u32 {
        let load = |lanes: &[i32; 8]| i32x8::load_array_ref(simd, lanes);
        let meet = (load(&self.right) + left)
            & (load(&self.left) + right)
            & (load(&self.bottom) + top)
            & (load(&self.top) + bottom);
        meet.simd_lt(0).to_bitmask() as u32
    }
}

/// Whether all go one way across and one way down.
#[inline(always)]
fn is_one_way(ways: u8) -> bool {
    ways & (RIGHT | LEFT) != 0 && ways & (DOWN | UP) != 0
}

/// Where the sides of empty boxes are: corners are at most 2^28 from 0, so that such a side makes no sum with theirs, or its own, that is below 0.
const NOWHERE: i32 = 3 << 28;

impl Bounds {
    const EMPTY: Self = Self([NOWHERE; 4]);

    /// A row from a point to the left, further than any box.
    #[inline(always)]
    fn left_of(point: FixedPoint) -> Self {
        Self([-(1 << 30), point.y, !point.x, !point.y])
    }

    /// A point.
    #[inline(always)]
    pub(super) fn of(FixedPoint { x, y }: FixedPoint) -> Self {
        Self([x, y, !x, !y])
    }

    /// Whether another lies in it.
    #[inline(always)]
    pub(super) fn contains<S: Simd>(&self, simd: S, other: &Self) -> bool {
        let load = |sides: &[i32; 4]| i32x4::load_array_ref(simd, sides);
        load(&self.0).simd_gt(load(&other.0)).to_bitmask() == 0
    }

    /// What to add to the sides of another box to see whether they meet.
    #[inline(always)]
    fn turned<S: Simd>(self, simd: S) -> i32x4<S> {
        let sides = i32x4::load_array(simd, self.0);
        sides.slide::<2>(sides)
    }

    /// Whether it has a point in common with another, be it of a side.
    #[inline(always)]
    fn meets<S: Simd>(&self, simd: S, turned: i32x4<S>) -> bool {
        (i32x4::load_array_ref(simd, &self.0) + turned).simd_lt(0).to_bitmask() == 0xf
    }

    #[inline(always)]
    fn with(self, other: Self) -> Self {
        let (Self([a, b, c, d]), Self([e, f, g, h])) = (self, other);
        Self([a.min(e), b.min(f), c.min(g), d.min(h)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::level::{SimdLevel, dispatch};

    /// Numbers below `end`.
    struct Random(u32);

    impl Random {
        fn below(&mut self, end: i32) -> i32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.0 >> 8) as i32 % end
        }
    }

    /// An outline's corners with its first one as often as it takes to make their number a multiple of eight.
    fn padded(outline: &[FixedPoint]) -> Vec<FixedPoint> {
        let mut corners = outline.to_vec();
        corners.resize(outline.len().next_multiple_of(8), outline[0]);
        corners
    }

    /// The left, upper, right and lower side of the box around an edge.
    fn bounds(corners: &[FixedPoint], [from, to]: Numbers) -> [i32; 4] {
        let (a, b) = (corners[from as usize], corners[to as usize]);
        [a.x.min(b.x), a.y.min(b.y), a.x.max(b.x), a.y.max(b.y)]
    }

    fn meets([left, top, right, bottom]: [i32; 4], other: [i32; 4]) -> bool {
        left <= other[2] && other[0] <= right && top <= other[3] && other[1] <= bottom
    }

    /// Whether two edges have a point in common, or lie on one line.
    fn touch(corners: &[FixedPoint], edge: Numbers, other: Numbers) -> bool {
        let corner = |number: u32| corners[number as usize];
        let side = |[a, b]: Numbers, c: u32| {
            let [a, b, c] = [a, b, c].map(corner);
            let [bx, by, cx, cy] = [b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y].map(i64::from);
            (bx * cy - by * cx).signum()
        };
        let apart = |edge: Numbers, [c, d]: Numbers| side(edge, c) * side(edge, d) > 0;
        !apart(edge, other) && !apart(other, edge)
    }

    /// Closed outlines one after another, as walks by steps or with corners anywhere; their edges and the tree.
    fn outlines(random: &mut Random, level: SimdLevel) -> (Vec<FixedPoint>, Vec<(Vec<Numbers>, Bounds)>, Boxes) {
        let (mut corners, mut edges, mut boxes) = (Vec::new(), Vec::new(), Boxes::default());
        for _ in 0..1 + random.below(4) {
            let first = corners.len();
            let (count, is_walk, size) = (3 + random.below(90), random.below(3) > 0, 4 + random.below(60));
            let mut at = FixedPoint { x: random.below(size), y: random.below(size) };
            corners.push(at);
            while corners.len() < first + count as usize {
                let step = |random: &mut Random| random.below(size) - if is_walk { size / 5 } else { size / 2 };
                at = FixedPoint { x: at.x + step(random), y: at.y + step(random) };
                if corners.last() != Some(&at) && corners[first] != at {
                    corners.push(at);
                }
            }
            corners.push(corners[first]);
            let number = |index: usize| index as u32;
            let last = corners.len() - 2;
            let next = |index: usize| if index == last { first } else { index + 1 };
            let (around, _) = dispatch!(level, simd => boxes.add(simd, &padded(&corners[first..]), corners.len() - first - 1, first as u32)).unwrap();
            edges.push(((first..=last).map(|index| [number(index), number(next(index))]).collect(), around));
        }
        dispatch!(level, simd => boxes.build(simd));
        (corners, edges, boxes)
    }

    #[test]
    fn edges_that_touch_are_found_once_and_no_others_but_by_their_boxes() {
        for level in SimdLevel::available() {
            let mut random = Random(1);
            let mut touching = 0;
            for round in 0..150 {
                let (corners, outlines, mut boxes) = outlines(&mut random, level);
                let mut found = Vec::new();
                let mut looks = usize::MAX;
                assert!(dispatch!(level, simd => boxes.for_pairs(simd, &mut looks, |a, b| {
                    found.push([a, b]);
                    true
                })));
                found.sort_unstable();
                assert!(found.windows(2).all(|pair| pair[0] != pair[1]), "round {round}: twice");
                let edges: Vec<_> = outlines.into_iter().flat_map(|(edges, _)| edges).collect();
                for (index, edge) in edges.iter().enumerate() {
                    for other in &edges[index + 1..] {
                        let (follow, pair) = (edge[1] == other[0] || other[1] == edge[0], [*edge, *other]);
                        let is_found = found.binary_search(&pair).is_ok();
                        let (near, touch) =
                            (meets(bounds(&corners, *edge), bounds(&corners, *other)), touch(&corners, *edge, *other));
                        assert!(!is_found || near && !follow, "round {round}: {pair:?}");
                        assert!(is_found || follow || !near || !touch, "round {round}: {pair:?} of {corners:?}");
                        touching += usize::from(is_found && touch);
                    }
                }
                // With fewer looks it gives up.
                let used = usize::MAX - looks;
                let mut few = used - 1;
                assert!(!dispatch!(level, simd => boxes.for_pairs(simd, &mut few, |_, _| true)));
                if !found.is_empty() {
                    let mut looks = usize::MAX;
                    assert!(!dispatch!(level, simd => boxes.for_pairs(simd, &mut looks, |_, _| false)));
                }
                let mut enough = used;
                assert!(dispatch!(level, simd => boxes.for_pairs(simd, &mut enough, |_, _| true)));
            }
            assert!(touching > 5000, "{touching}");
        }
    }

    #[test]
    fn leftmost_corners_and_edges_to_the_left_are_found() {
        for level in SimdLevel::available() {
            let mut random = Random(2);
            for round in 0..150 {
                let (corners, outlines, mut boxes) = outlines(&mut random, level);
                let point = corners[random.below(corners.len() as i32) as usize];
                let FixedPoint { x, y } = point;
                let (mut node, mut found_one_by_one) = (0, Vec::new());
                for (edges, around) in &outlines {
                    let (nodes, around) = (node..node + edges.len().div_ceil(8), *around);
                    node = nodes.end;
                    let sides = edges.iter().map(|edge| bounds(&corners, *edge));
                    let [left, top, right, bottom] =
                        sides.reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]).unwrap();
                    assert_eq!(around.0, [left, top, !right, !bottom]);
                    let contains = (left..=right).contains(&x) && (top..=bottom).contains(&y);
                    assert_eq!(dispatch!(level, simd => around.contains(simd, &Bounds::of(point))), contains);
                    let found = |edge| found_one_by_one.push(edge);
                    dispatch!(level, simd => boxes.for_left_of_in(simd, nodes.clone(), point, found));
                    let leftmost = edges.iter().map(|[from, _]| *from).min_by_key(|number| {
                        let corner = corners[*number as usize];
                        (corner.x, std::cmp::Reverse(*number))
                    });
                    let found = dispatch!(level, simd => boxes.leftmost(simd, nodes, around, &corners));
                    assert_eq!(found, leftmost, "round {round}");
                }
                assert_eq!(boxes.len(), node);
                let (mut found, mut looks) = (Vec::new(), usize::MAX);
                assert!(dispatch!(level, simd => boxes.for_left_of(simd, point, &mut looks, |edge| found.push(edge))));
                found.sort_unstable();
                let mut beside: Vec<_> = outlines.into_iter().flat_map(|(edges, _)| edges).collect();
                beside.retain(|edge| {
                    let [left, top, _, bottom] = bounds(&corners, *edge);
                    left <= x && top <= y && y <= bottom
                });
                beside.sort_unstable();
                assert_eq!(found, beside, "round {round}");
                found_one_by_one.sort_unstable();
                assert_eq!(found_one_by_one, beside, "round {round}");
            }
        }
    }

    #[test]
    fn what_goes_one_way_is_known() {
        let mut random = Random(3);
        for round in 0..200 {
            // 300 edges that go one way, or along an axis, and three back to the start around them.
            let (across, down) = ([1, -1][round % 2], [1, -1][round / 2 % 2]);
            let mut at = FixedPoint { x: 0, y: 0 };
            let mut corners = vec![at];
            while corners.len() <= 300 {
                let step = (random.below(3), random.below(3));
                at = FixedPoint { x: at.x + across * step.0, y: at.y + down * step.1 };
                if step != (0, 0) {
                    corners.push(at);
                }
            }
            corners.push(FixedPoint { x: at.x + across, y: at.y + down });
            corners.extend([FixedPoint { x: at.x + across, y: -down }, FixedPoint { x: 0, y: -down }, corners[0]]);
            // In every other round one of the first 64 edges goes back.
            let back = 1 + random.below(63) as usize;
            let is_straight = round % 8 < 4;
            if !is_straight {
                let (before, after) = (corners[back - 1], corners[back + 1]);
                corners[back] = match round % 3 {
                    0 => FixedPoint { x: before.x - across, ..after },
                    _ => FixedPoint { y: after.y + down, ..before },
                };
            }
            let mut boxes = Boxes::default();
            assert!(
                dispatch!(SimdLevel::best(), simd => boxes.add(simd, &padded(&corners), corners.len() - 1, 0))
                    .is_some()
            );
            dispatch!(SimdLevel::best(), simd => boxes.build(simd));
            let is_ordered: Vec<_> = boxes.levels[0].iter().map(|node| node.is_ordered).collect();
            assert_eq!(is_ordered, [is_straight, true, true, true, false], "round {round}");
            assert!(!boxes.levels[1][0].is_ordered);
        }
    }

    #[test]
    fn edges_without_length_are_refused() {
        let mut boxes = Boxes::default();
        let corner = |x: i32, y: i32| FixedPoint { x, y };
        for count in [3, 8, 9, 20] {
            let mut corners: Vec<_> = (0..count).map(|i| corner(i * i, i * 7)).collect();
            corners.push(corners[0]);
            let add = |boxes: &mut Boxes, corners: &[FixedPoint]| dispatch!(SimdLevel::best(), simd => boxes.add(simd, &padded(corners), corners.len() - 1, 0).is_some());
            assert!(add(&mut boxes, &corners));
            for index in 0..corners.len() {
                let mut repeated = corners.clone();
                repeated.insert(index, corners[index]);
                let before = boxes.len();
                assert!(!add(&mut boxes, &repeated) && boxes.len() == before, "{count}: {index}");
            }
        }
    }
}
