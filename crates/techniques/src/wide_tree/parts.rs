//! Trees from the outside: made of nodes, and looked into.

use nestray_core::aabb::{Aabb, Clip};
use nestray_core::huge::Huge;
use nestray_core::technique::Step;

use super::{Node, WideTree};

impl WideTree {
    /// The tree of these nodes, root first, as [`nodes`](Self::nodes) lists them: at most eight
    /// parts each, the largest last, of coordinates up to `reach`.
    pub(crate) fn of(nodes: impl Iterator<Item = Vec<(Aabb, Step)>>, reach: f32) -> Self {
        let nodes: Vec<Node> = nodes.map(|parts| Node::of(&parts)).collect();
        Self { nodes: Huge::new(&nodes, 0), reach, slack: Clip::SLACK, is_split: false }
    }

    /// Lower x of the boxes of a node, upper x, lower y, …
    #[inline(always)]
    pub(crate) fn rows(&self, at: Step) -> &[[f32; 8]; 6] {
        &self.nodes[at.word() as usize].rows
    }

    /// The box of one lane of a node; not bounded if there is nothing.
    pub(crate) fn lane_box(&self, node: u32, lane: usize) -> Aabb {
        self.nodes[node as usize].bounds(lane)
    }

    /// The same tree, not yet renamed, with the number of each leaf kept beside its name.
    pub(crate) fn with_leaf_numbers(mut self) -> Self {
        for node in self.nodes.iter_mut() {
            node.spare = node.words.map(|word| Step::from_word(word).as_leaf().0);
        }
        self
    }

    /// The number a leaf had when it was pushed.
    pub(crate) fn leaf_number(&self, node: u32, lane: usize) -> u32 {
        self.nodes[node as usize].spare[lane]
    }
}

impl Node {
    /// Nothing in it.
    pub(super) fn empty() -> Self {
        let mut node = Self { rows: [[0.0; 8]; 6], words: [0; 8], spare: [0; 8] };
        for (row, empty) in node.rows.iter_mut().zip([f32::INFINITY, f32::NEG_INFINITY].repeat(3)) {
            *row = [empty; 8];
        }
        node
    }

    fn of(parts: &[(Aabb, Step)]) -> Self {
        let mut node = Self::empty();
        for (lane, (bounds, step)) in parts.iter().enumerate() {
            node.put(lane, bounds, step.word());
        }
        node
    }

    /// What one of the eight is.
    pub(super) fn put(&mut self, lane: usize, bounds: &Aabb, word: u32) {
        for axis in 0..3 {
            self.rows[2 * axis][lane] = bounds.min[axis];
            self.rows[2 * axis + 1][lane] = bounds.max[axis];
        }
        self.words[lane] = word;
    }
}
