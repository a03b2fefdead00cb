//! Writing wide nodes, each before its subtrees.

use nestray_core::technique::{Leaf, Leaves, Step};
use rayon::prelude::*;

use super::Node;
use super::binary::Binary;
use super::collapse::MAX_DEPTH;
use super::forests::Forests;

/// More children than this below a node are worth being shared out between threads.
const SHARED: u32 = 8192;

/// What is to be written.
pub(super) struct Emit<'a> {
    pub(super) binary: &'a Binary<'a>,
    pub(super) forests: &'a Forests,
}

/// Some nodes and their leaves, numbered from 0.
#[derive(Default)]
pub(super) struct Piece {
    pub(super) nodes: Vec<Node>,
    pub(super) leaves: Leaves,
}

impl Piece {
    /// Appends another piece; says where its root is.
    fn append(&mut self, other: Self) -> u32 {
        let me = self.nodes.len() as u32;
        let leaf = self.leaves.append(&other.leaves);
        self.nodes.extend(other.nodes.into_iter().map(|node| node.moved(me, leaf)));
        me
    }
}

impl Node {
    /// The same node where its tree begins at `offset` of another, and the leaves at `leaf`.
    fn moved(mut self, offset: u32, leaf: u32) -> Self {
        let lanes = self.words.iter_mut().zip(&self.rows[0]);
        for (word, _) in lanes.filter(|(_, low)| low.is_finite()) {
            let step = Step::from_word(*word);
            *word = if step.is_onward() {
                *word + offset
            } else {
                Step::leaf(Leaf(step.as_leaf().0 + leaf)).word()
            };
        }
        self
    }
}

impl Emit<'_> {
    /// The whole tree, unless it is too deep.
    pub(super) fn all(&self) -> Option<Piece> {
        let mut piece = Piece::default();
        self.emit(0, 1, &mut piece).map(|_| piece)
    }

    /// Appends the wide node made of subtree `i`, and what is below it; says where it is.
    fn emit(&self, i: u32, depth: usize, out: &mut Piece) -> Option<u32> {
        if depth > MAX_DEPTH {
            return None;
        }
        let pairs = &self.binary.pairs;
        let me = out.nodes.len();
        let mut node = Node::empty();
        out.nodes.push(node);
        let children = self.forests.children(pairs, i);
        let mut apart = self.apart(i, &children, depth)?.into_iter();
        for (lane, &child) in children.iter().enumerate() {
            let pair = &pairs[child as usize];
            let word = if self.forests.is_leaf(child) {
                Step::leaf(self.leaf(self.binary.below(pair), out)).word()
            } else if self.is_large(child) {
                out.append(apart.next().expect("one for each large subtree"))
            } else {
                self.emit(child, depth + 1, out)?
            };
            node.put(lane, &pair.bounds, word);
        }
        out.nodes[me] = node;
        Some(me as u32)
    }

    fn is_large(&self, i: u32) -> bool {
        self.binary.pairs[i as usize].count > SHARED && !self.forests.is_leaf(i)
    }

    /// The large ones of some subtrees, by all cores.
    fn apart(&self, i: u32, children: &[u32], depth: usize) -> Option<Vec<Piece>> {
        if !self.is_large(i) {
            return Some(Vec::new());
        }
        let large: Vec<u32> = children.iter().copied().filter(|&i| self.is_large(i)).collect();
        let piece = |&i: &u32| {
            let mut piece = Piece::default();
            self.emit(i, depth + 1, &mut piece).map(|_| piece)
        };
        large.par_iter().map(piece).collect()
    }

    /// A leaf with each child once.
    fn leaf(&self, children: &[u32], out: &mut Piece) -> Leaf {
        if !self.binary.is_split() {
            return out.leaves.push(children);
        }
        let mut once = children.to_vec();
        once.sort_unstable();
        once.dedup();
        out.leaves.push(&once)
    }
}
