//! From a binary tree to nodes of eight.

use nestray_core::technique::{Leaves, Step};

use super::binary::Binary;
use super::{LeafSize, Node};

/// Deepest tree a [`Trail`](nestray_core::trail::Trail) has room for.
const MAX_DEPTH: usize = 34;

/// From which depth on a binary tree is split in halves: the first that makes the wide one
/// shallow enough is taken.
const HALVES_FROM: [usize; 3] = [96, 24, 0];

/// The wide nodes of the tree that `build` makes.
pub(super) fn collapsed<'a>(
    size: LeafSize,
    leaves: &mut Leaves,
    build: impl Fn(usize) -> Binary<'a>,
) -> Vec<Node> {
    for halves_from in HALVES_FROM {
        let binary = build(halves_from);
        let forests = Forests::new(size, &binary);
        let mut out =
            Emit { binary: &binary, forests: &forests, nodes: Vec::new(), leaves, depth: 0 };
        if forests.depth(&binary) <= MAX_DEPTH {
            out.emit(0, 0);
            assert!(out.depth <= MAX_DEPTH, "depth and what is emitted agree");
            return out.nodes;
        }
    }
    unreachable!("a tree split in halves is shallow")
}

/// How best to cut each binary subtree into at most 1, 2, … 8 wide ones, by dynamic
/// programming [Ylitie 17].
struct Forests {
    /// Cost of a subtree as at most `j + 1` parts.
    cost: Vec<[f32; 8]>,
    /// How many of those parts the left side gets; [`LEAF`], [`NODE`] or [`FEWER`].
    cut: Vec<[u8; 8]>,
}

const LEAF: u8 = 0;
const FEWER: u8 = 254;
const NODE: u8 = 255;

impl Forests {
    fn new(size: LeafSize, binary: &Binary<'_>) -> Self {
        let count = binary.pairs.len();
        let mut forests = Self { cost: vec![[0.0; 8]; count], cut: vec![[LEAF; 8]; count] };
        // Children come after their parents.
        for (i, pair) in binary.pairs.iter().enumerate().rev() {
            let leaf = pair.bounds.surface_area() * binary.of.leaf_cost(size, binary.below(pair));
            if pair.left == 0 {
                forests.cost[i] = [leaf; 8];
                continue;
            }
            let (left, right) =
                (forests.cost[pair.left as usize], forests.cost[pair.right as usize]);
            let (mut cost, mut cut) = ([0.0f32; 8], [LEAF; 8]);
            for parts in 2..=8 {
                let best = (1..parts)
                    .map(|l| (left[l - 1] + right[parts - l - 1], l as u8))
                    .fold((f32::INFINITY, 1), |a, b| if b.0 < a.0 { b } else { a });
                (cost[parts - 1], cut[parts - 1]) = best;
            }
            let node = pair.bounds.surface_area() + cost[7];
            let fits = pair.count as usize <= size.most;
            (cost[0], cut[0]) = if fits && leaf <= node { (leaf, LEAF) } else { (node, NODE) };
            for parts in 1..8 {
                if cost[parts - 1] < cost[parts] {
                    (cost[parts], cut[parts]) = (cost[parts - 1], FEWER);
                }
            }
            (forests.cost[i], forests.cut[i]) = (cost, cut);
        }
        forests
    }

    /// The roots of subtree `i` as at most `parts` parts.
    fn roots(&self, binary: &Binary<'_>, i: u32, parts: usize, out: &mut Vec<u32>) {
        let pair = &binary.pairs[i as usize];
        match self.cut[i as usize][parts - 1] {
            _ if parts == 1 || pair.left == 0 => out.push(i),
            FEWER => self.roots(binary, i, parts - 1, out),
            left => {
                self.roots(binary, pair.left, usize::from(left), out);
                self.roots(binary, pair.right, parts - usize::from(left), out);
            }
        }
    }

    /// What a wide node made of subtree `i` holds.
    fn children(&self, binary: &Binary<'_>, i: u32) -> Vec<u32> {
        let mut out = Vec::with_capacity(8);
        let pair = &binary.pairs[i as usize];
        let parts = (2..=8).rev().find(|&p| self.cut[i as usize][p - 1] != FEWER);
        match parts.filter(|_| pair.left != 0) {
            Some(parts) => {
                let left = usize::from(self.cut[i as usize][parts - 1]);
                self.roots(binary, pair.left, left, &mut out);
                self.roots(binary, pair.right, parts - left, &mut out);
            }
            // Best as one leaf: only the root of a whole tree is asked nevertheless.
            None => out.push(i),
        }
        let area = |i: u32| binary.pairs[i as usize].bounds.surface_area();
        out.sort_by(|&a, &b| area(a).total_cmp(&area(b)));
        out
    }

    fn is_leaf(&self, i: u32) -> bool {
        self.cut[i as usize][0] == LEAF
    }

    fn depth(&self, binary: &Binary<'_>) -> usize {
        let mut deepest = 0;
        let mut open = vec![(0, 1)];
        while let Some((i, depth)) = open.pop() {
            deepest = deepest.max(depth);
            let inner = self.children(binary, i).into_iter().filter(|&c| !self.is_leaf(c));
            open.extend(inner.map(|c| (c, depth + 1)));
        }
        deepest
    }
}

/// Writes the wide nodes, each before its subtrees.
struct Emit<'a> {
    binary: &'a Binary<'a>,
    forests: &'a Forests,
    nodes: Vec<Node>,
    leaves: &'a mut Leaves,
    /// The deepest node so far.
    depth: usize,
}

impl Emit<'_> {
    fn emit(&mut self, i: u32, depth: usize) -> u32 {
        self.depth = self.depth.max(depth);
        let me = self.nodes.len();
        let mut node = Node { rows: [[0.0; 8]; 6], words: [0; 8], spare: [0; 8] };
        for (row, empty) in node.rows.iter_mut().zip([f32::INFINITY, f32::NEG_INFINITY].repeat(3)) {
            *row = [empty; 8];
        }
        self.nodes.push(node);
        for (lane, child) in self.forests.children(self.binary, i).into_iter().enumerate() {
            let pair = &self.binary.pairs[child as usize];
            for axis in 0..3 {
                node.rows[2 * axis][lane] = pair.bounds.min[axis];
                node.rows[2 * axis + 1][lane] = pair.bounds.max[axis];
            }
            node.words[lane] = if self.forests.is_leaf(child) {
                Step::leaf(self.leaves.push(self.binary.below(pair))).word()
            } else {
                self.emit(child, depth + 1)
            };
        }
        self.nodes[me] = node;
        me as u32
    }
}
