//! The parts of a tree that a beam meets.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nestray_core::aabb::Aabb;
use nestray_core::beam::Beam;
use nestray_core::dispatch;
use nestray_core::family::Family;
use nestray_core::packet::Pencil;
use nestray_core::simd::{Level, Simd};
use nestray_core::technique::{Leaves, Step};

use crate::wide_tree::WideTree;

/// A tree, and the children in its leaves.
#[derive(Debug)]
pub(crate) struct Forest {
    pub(super) tree: WideTree,
    /// The children of all leaves, in the order pushed.
    children: Vec<u32>,
    /// Where those of each leaf begin, and where the last end.
    starts: Vec<u32>,
}

/// One lane of a node of the tree: `node << 3 | lane`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Name(u32);

impl Name {
    fn new(node: u32, lane: usize) -> Self {
        Self(node << 3 | lane as u32)
    }

    /// From [`word`](Self::word).
    pub(super) fn from_word(word: u32) -> Self {
        Self(word)
    }

    /// As one word.
    pub(super) fn word(self) -> u32 {
        self.0
    }

    fn node(self) -> u32 {
        self.0 >> 3
    }

    fn lane(self) -> usize {
        self.0 as usize & 7
    }
}

/// A part of the tree that a beam meets.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub(crate) name: Name,
    /// No ray of the beam meets it nearer along the main axis.
    pub(crate) begin: f32,
    /// How large its box is.
    size: f32,
}

/// What a beam meets: whole subtrees, and leaves.
#[derive(Debug, Default)]
pub(crate) struct Cut {
    /// Subtrees that were not looked into.
    pub(crate) whole: Vec<Part>,
    /// Leaves whose box some ray may meet.
    pub(crate) leaves: Vec<Part>,
}

/// The largest is looked into first.
struct Largest(Part);

impl PartialEq for Largest {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Largest {}

impl PartialOrd for Largest {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Largest {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.size.total_cmp(&other.0.size).then(self.0.name.cmp(&other.0.name))
    }
}

impl Forest {
    /// The tree as built, its leaves not yet renamed.
    pub(super) fn new(tree: WideTree, leaves: &Leaves) -> Self {
        let (mut children, mut starts) = (Vec::new(), vec![0]);
        for leaf in 0..leaves.count() {
            children.extend_from_slice(leaves.of(leaf));
            starts.push(children.len() as u32);
        }
        Self { tree: tree.with_leaf_numbers(), children, starts }
    }

    /// What is in a lane: the word of a [`Step`].
    pub(super) fn word(&self, name: Name) -> u32 {
        self.tree.words(Step::onward(name.node()))[name.lane()]
    }

    /// The first leaf that overlaps `place` and has a child that `is` the one looked for: its
    /// number and its box.
    pub(super) fn leaf_around(
        &self,
        place: &Aabb,
        is: &dyn Fn(u32) -> bool,
    ) -> Option<(usize, Aabb)> {
        let mut open = vec![0];
        while let Some(node) = open.pop() {
            for lane in 0..8 {
                let bounds = self.tree.lane_box(node, lane);
                if !bounds.overlaps(place) {
                    continue;
                }
                let name = Name::new(node, lane);
                let word = self.word(name);
                if Step::from_word(word).is_onward() {
                    open.push(word);
                } else if self.children(name).iter().any(|&child| is(child)) {
                    return Some((self.tree.leaf_number(node, lane) as usize, bounds));
                }
            }
        }
        None
    }

    /// Where a part begins along an axis, or along the other way, with the sign changed.
    pub(super) fn coordinate(&self, name: Name, axis: usize, backward: bool) -> f32 {
        let bounds = self.tree.lane_box(name.node(), name.lane());
        if backward { -bounds.max[axis] } else { bounds.min[axis] }
    }

    /// Leaves out what has no child that a ray of `beam` may meet; the rest begins where those
    /// children do.
    pub(crate) fn keep_met(&self, family: &dyn Family, beam: &Beam, leaves: &mut Vec<Part>) {
        leaves.retain_mut(|part| {
            let met = |&child: &u32| family.meets(child, beam);
            let begins = self.children(part.name).iter().filter_map(met);
            let begin = begins.map(|[begin, _]| begin).reduce(f32::min);
            part.begin = begin.map_or(part.begin, |begin| begin.max(part.begin));
            begin.is_some()
        });
    }

    /// The children of a leaf; of a subtree none.
    pub(super) fn children(&self, name: Name) -> &[u32] {
        if Step::from_word(self.word(name)).is_onward() {
            return &[];
        }
        let leaf = self.tree.leaf_number(name.node(), name.lane()) as usize;
        &self.children[self.starts[leaf] as usize..self.starts[leaf + 1] as usize]
    }

    pub(super) fn bytes(&self) -> u64 {
        let beside = size_of_val(&*self.children) + size_of_val(&*self.starts);
        nestray_core::technique::Index::bytes(&self.tree) + beside as u64
    }

    /// What `beam` meets of `from`, or of the whole tree if there is none: subtrees are looked
    /// into, the largest first, until there would be more than `most` parts.
    pub(crate) fn cut(&self, beam: &Beam, from: Option<&[Name]>, most: usize) -> Cut {
        let pencil = Pencil::new(beam, self.tree.reach());
        let mut growing = Growing { forest: self, open: BinaryHeap::new(), leaves: Vec::new() };
        match from {
            None => self.look_into(&pencil, 0, |part| growing.sort_in(part)),
            Some(names) => {
                for of_node in names.chunk_by(|a, b| a.node() == b.node()) {
                    self.look_into(&pencil, of_node[0].node(), |part| {
                        if of_node.contains(&part.name) {
                            growing.sort_in(part);
                        }
                    });
                }
            }
        }
        let mut parts = Vec::with_capacity(8);
        while let Some(Largest(part)) = growing.open.pop() {
            parts.clear();
            self.look_into(&pencil, self.word(part.name), |part| parts.push(part));
            if growing.leaves.len() + growing.open.len() + parts.len() > most {
                growing.open.push(Largest(part));
                break;
            }
            for &part in &parts {
                growing.sort_in(part);
            }
        }
        let whole = growing.open.into_iter().map(|Largest(part)| part).collect();
        Cut { whole, leaves: growing.leaves }
    }

    /// Shows the lanes of a node that a beam meets.
    fn look_into(&self, pencil: &Pencil, node: u32, mut show: impl FnMut(Part)) {
        let rows = self.tree.rows(Step::onward(node));
        let (mask, begin) = dispatch!(Level::best(), simd => {
            let (mask, begin) = pencil.meets(simd, rows);
            (mask, simd.array(begin))
        });
        for lane in (0..8).filter(|lane| mask >> lane & 1 == 1) {
            let size = self.tree.lane_box(node, lane).surface_area();
            show(Part { name: Name::new(node, lane), begin: begin[lane], size });
        }
    }
}

/// A cut being made.
struct Growing<'a> {
    forest: &'a Forest,
    open: BinaryHeap<Largest>,
    leaves: Vec<Part>,
}

impl Growing<'_> {
    /// Subtrees are to be looked into, leaves stay.
    fn sort_in(&mut self, part: Part) {
        if Step::from_word(self.forest.word(part.name)).is_onward() {
            self.open.push(Largest(part));
        } else {
            self.leaves.push(part);
        }
    }
}

impl Cut {
    /// How many parts there are.
    pub(crate) fn count(&self) -> usize {
        self.whole.len() + self.leaves.len()
    }

    /// All parts, in the order of the tree.
    pub(crate) fn names(&self) -> Vec<Name> {
        let mut names: Vec<Name> =
            self.whole.iter().chain(&self.leaves).map(|part| part.name).collect();
        names.sort_unstable();
        names
    }

    /// All parts.
    pub(crate) fn into_parts(mut self) -> Vec<Part> {
        self.leaves.append(&mut self.whole);
        self.leaves
    }
}
