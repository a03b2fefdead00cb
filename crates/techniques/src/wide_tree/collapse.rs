//! From a binary tree to nodes of eight.

use nestray_core::technique::{Leaf, Leaves, Step};

use super::binary::{Binary, Outlook, Pair};
use super::{LeafSize, Node};

/// Deepest tree a [`Trail`](nestray_core::trail::Trail) has room for.
pub(crate) const MAX_DEPTH: usize = 34;

/// From which depth on a binary tree is split in halves: the first that makes the wide one
/// shallow enough is taken.
const HALVES_FROM: [usize; 3] = [96, 24, 0];

/// The wide nodes of the tree that `build` makes, and whether it splits children.
pub(super) fn collapsed<'a>(
    size: LeafSize,
    leaves: &mut Leaves,
    build: impl Fn(usize) -> Binary<'a>,
) -> (Vec<Node>, bool) {
    for halves_from in HALVES_FROM {
        let binary = build(halves_from);
        let forests = forests(size, &binary);
        let mut out =
            Emit { binary: &binary, forests: &forests, nodes: Vec::new(), leaves, depth: 0 };
        if forests.depth(&binary.pairs) <= MAX_DEPTH {
            out.emit(0, 0);
            assert!(out.depth <= MAX_DEPTH, "depth and what is emitted agree");
            return (out.nodes, binary.is_split());
        }
    }
    unreachable!("a tree split in halves is shallow")
}

/// What becomes of a binary tree.
pub(super) fn outlook(size: LeafSize, binary: &Binary<'_>) -> Outlook {
    let forests = forests(size, binary);
    let whole = binary.pairs[0].bounds.surface_area().max(f32::MIN_POSITIVE);
    let cost = f64::from(forests.cost[0][0]) / f64::from(whole);
    Outlook {
        cost: (forests.depth(&binary.pairs) <= MAX_DEPTH).then_some(cost),
        leaves: (0..binary.pairs.len() as u32).map(|i| forests.is_leaf(i)).collect(),
    }
}

/// How best to cut up a binary tree of boxes.
fn forests(size: LeafSize, binary: &Binary<'_>) -> Forests {
    Forests::new(size.most, &binary.pairs, |i| {
        let pair = &binary.pairs[i];
        let area = pair.bounds.surface_area();
        [area, area * binary.of.leaf_cost(size, binary.below(pair))]
    })
}

/// How best to cut each binary subtree into at most 1, 2, … 8 wide ones, by dynamic
/// programming [Ylitie 17].
#[derive(Debug)]
pub(crate) struct Forests {
    /// How often a subtree is met, to whatever scale.
    area: Vec<f32>,
    /// Cost of a subtree as at most `j + 1` parts.
    cost: Vec<[f32; 8]>,
    /// How many of those parts the left side gets; [`LEAF`], [`NODE`] or [`FEWER`].
    cut: Vec<[u8; 8]>,
}

const LEAF: u8 = 0;
const FEWER: u8 = 254;
const NODE: u8 = 255;

impl Forests {
    /// `price` says how often subtree `i` is met, and what it costs as one leaf; leaves have
    /// at most `most` children, if the tree allows.
    pub(crate) fn new(most: usize, pairs: &[Pair], price: impl Fn(usize) -> [f32; 2]) -> Self {
        let count = pairs.len();
        let mut forests = Self {
            area: vec![0.0; count],
            cost: vec![[0.0; 8]; count],
            cut: vec![[LEAF; 8]; count],
        };
        // Children come after their parents.
        for (i, pair) in pairs.iter().enumerate().rev() {
            let [area, leaf] = price(i);
            forests.area[i] = area;
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
            let node = area + cost[7];
            let fits = pair.count as usize <= most;
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
    fn roots(&self, pairs: &[Pair], i: u32, parts: usize, out: &mut Vec<u32>) {
        let pair = &pairs[i as usize];
        match self.cut[i as usize][parts - 1] {
            _ if parts == 1 || pair.left == 0 => out.push(i),
            FEWER => self.roots(pairs, i, parts - 1, out),
            left => {
                self.roots(pairs, pair.left, usize::from(left), out);
                self.roots(pairs, pair.right, parts - usize::from(left), out);
            }
        }
    }

    /// What a wide node made of subtree `i` holds.
    pub(crate) fn children(&self, pairs: &[Pair], i: u32) -> Vec<u32> {
        let mut out = Vec::with_capacity(8);
        let pair = &pairs[i as usize];
        let parts = (2..=8).rev().find(|&p| self.cut[i as usize][p - 1] != FEWER);
        match parts.filter(|_| pair.left != 0) {
            Some(parts) => {
                let left = usize::from(self.cut[i as usize][parts - 1]);
                self.roots(pairs, pair.left, left, &mut out);
                self.roots(pairs, pair.right, parts - left, &mut out);
            }
            // Best as one leaf: only the root of a whole tree is asked nevertheless.
            None => out.push(i),
        }
        let area = |i: u32| self.area[i as usize];
        out.sort_by(|&a, &b| area(a).total_cmp(&area(b)));
        out
    }

    /// Whether a subtree is best as one leaf.
    pub(crate) fn is_leaf(&self, i: u32) -> bool {
        self.cut[i as usize][0] == LEAF
    }

    /// How many nodes are on the longest way down.
    pub(crate) fn depth(&self, pairs: &[Pair]) -> usize {
        let mut deepest = 0;
        let mut open = vec![(0, 1)];
        while let Some((i, depth)) = open.pop() {
            deepest = deepest.max(depth);
            let inner = self.children(pairs, i).into_iter().filter(|&c| !self.is_leaf(c));
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
        let mut node = Node::empty();
        self.nodes.push(node);
        for (lane, child) in self.forests.children(&self.binary.pairs, i).into_iter().enumerate() {
            let pair = &self.binary.pairs[child as usize];
            let word = if self.forests.is_leaf(child) {
                Step::leaf(self.leaf(self.binary.below(pair))).word()
            } else {
                self.emit(child, depth + 1)
            };
            node.put(lane, &pair.bounds, word);
        }
        self.nodes[me] = node;
        me as u32
    }

    /// A leaf with each child once.
    fn leaf(&mut self, children: &[u32]) -> Leaf {
        if !self.binary.is_split() {
            return self.leaves.push(children);
        }
        let mut once = children.to_vec();
        once.sort_unstable();
        once.dedup();
        self.leaves.push(&once)
    }
}
