//! From a binary tree in time to nodes of eight.

use nestray_core::aabb::Aabb;
use nestray_core::technique::{Leaves, Step};

use super::moves::Moves;
use super::{Part, Timed, TimedTree, Visits};
use crate::wide_tree::{Contents, Forests, LeafSize, MAX_DEPTH, WideTree};

impl TimedTree {
    /// The nodes of the first of the binary trees that is shallow enough, made by `build` from
    /// each of the `limits`; the last must be.
    pub(crate) fn new(
        size: LeafSize,
        of: &Contents,
        visits: Visits,
        leaves: &mut Leaves,
        limits: &[usize],
        mut build: impl FnMut(usize) -> Timed,
    ) -> Self {
        for &limit in limits {
            let tree = build(limit);
            let forests = forests(size, of, &tree);
            if forests.depth(&tree.pairs) <= MAX_DEPTH {
                let mut out = Emit { tree: &tree, forests: &forests, nodes: Vec::new(), leaves };
                out.emit(0);
                return Self::of(&out.nodes, visits);
            }
        }
        unreachable!("the last limit makes trees shallow")
    }

    /// The tree of these nodes, root first.
    fn of(nodes: &[Vec<Part>], visits: Visits) -> Self {
        let (mut moves, mut notes) = (Vec::new(), Vec::with_capacity(nodes.len()));
        for parts in nodes {
            let note = Moves::new(parts).map_or(0, |moving| {
                moves.push(moving);
                moves.len() as u32
            });
            notes.push(note);
        }
        let all =
            nodes.iter().flatten().fold(Aabb::EMPTY, |all, part| all.join(part.bounds.within));
        let begin = |parts: &Vec<Part>| {
            parts.iter().map(|part| (part.bounds.begin, part.step)).collect::<Vec<_>>()
        };
        let tree = WideTree::of(nodes.iter().map(begin), all.reach()).with_notes(&notes);
        Self { tree, moves, visits }
    }
}

/// How best to cut the tree: what a node costs is how often it is met while it is there.
fn forests(size: LeafSize, of: &Contents, tree: &Timed) -> Forests {
    Forests::new(size.most, &tree.pairs, |i| {
        let (bounds, time) = tree.parts[i];
        let area = (bounds.mean_area() * f64::from(time[1] - time[0])) as f32;
        [area, area * of.leaf_cost(size, tree.below(i))]
    })
}

impl Timed {
    /// The children below a node, some several times.
    fn below(&self, i: usize) -> &[u32] {
        let pair = &self.pairs[i];
        &self.order[pair.first as usize..][..pair.count as usize]
    }
}

/// Writes the wide nodes, each before its subtrees.
struct Emit<'a> {
    tree: &'a Timed,
    forests: &'a Forests,
    nodes: Vec<Vec<Part>>,
    leaves: &'a mut Leaves,
}

impl Emit<'_> {
    fn emit(&mut self, i: u32) -> Step {
        let me = self.nodes.len();
        self.nodes.push(Vec::new());
        let children = self.forests.children(&self.tree.pairs, i);
        let parts = children.iter().map(|&child| self.part(child)).collect();
        self.nodes[me] = parts;
        Step::onward(me as u32)
    }

    fn part(&mut self, i: u32) -> Part {
        let (bounds, time) = self.tree.parts[i as usize];
        let step = if self.forests.is_leaf(i) {
            let mut below = self.tree.below(i as usize).to_vec();
            below.sort_unstable();
            below.dedup();
            Step::leaf(self.leaves.push(&below))
        } else {
            self.emit(i)
        };
        Part { bounds: Moves::widened(bounds), time, step }
    }
}
