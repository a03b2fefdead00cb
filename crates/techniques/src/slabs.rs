//! A hierarchy of volumes that are cut by several sets of parallel planes each [Kay 86].
//!
//! Space about 80 bytes per child with seven sets, build `O(n log n)`, a ray visits `O(log n)` nodes.

pub(crate) mod planes;
mod volume;

use nestray_core::family::Family;
use nestray_core::simd::Simd;
use nestray_core::technique::{
    Expected, Index, Leaf, Leaves, OutOfRange, Query, Repeats, Step, Technique, Walk, in_range,
};
use serde::{Deserialize, Serialize};

use crate::bvh::Bvh;
use crate::wide_tree::{self, WideTree, next, turn};

/// A tree of boxes, with slanting planes that cut each of them further.
#[derive(Debug)]
pub struct SlabsIndex {
    tree: WideTree,
    /// For each node, and each slanting direction, how far its eight parts reach.
    rows: Vec<[[f32; 8]; 2]>,
    /// The slanting directions, as a range of [`planes::SLANTING`].
    from: usize,
    to: usize,
}

/// The technique: a hierarchy of slabs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Slabs {
    /// How many sets of parallel planes bound a volume: 3 along the axes, and the 4 diagonals of
    /// a cube (7), the 6 of its faces (9), or both (13).
    pub sets: usize,
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// What testing a leaf costs, in visits of a node.
    pub leaf_cost: f32,
}

impl Default for Slabs {
    fn default() -> Self {
        Self { sets: 7, max_leaf: 8, leaf_cost: 0.8 }
    }
}

impl Technique for Slabs {
    const NAME: &'static str = "slabs";
    const EFFORT: f64 = 5.0;
    type Index = SlabsIndex;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> SlabsIndex {
        let (max_leaf, leaf_cost) = (self.max_leaf, self.leaf_cost);
        let of_boxes = Bvh { max_leaf, leaf_cost, ..Bvh::default() };
        let tree = of_boxes.build(family, leaves);
        let (from, to) = planes::slanting(self.sets);
        let rows = volume::rows(&tree, family, leaves, &planes::SLANTING[from..to]);
        SlabsIndex { tree, rows, from, to }
    }

    fn neighbours(&self) -> Vec<Self> {
        let sets = [3, 7, 9, 13].map(|sets| Self { sets, ..*self });
        let leaves = [self.max_leaf / 2, self.max_leaf * 2];
        let leaves = leaves.map(|max_leaf| Self { max_leaf, ..*self });
        let near = sets.into_iter().chain(leaves);
        near.filter(|params| params != self && params.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range([3, 7, 9, 13].contains(&self.sets), "sets", "3, 7, 9 or 13")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")
    }
}

/// Where a ray stands, and its own part of the tests.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    boxes: wide_tree::Cursor,
    cuts: [planes::Cut; planes::MOST],
}

impl SlabsIndex {
    /// The rows of a node.
    #[inline(always)]
    fn rows(&self, node: usize) -> &[[[f32; 8]; 2]] {
        let sets = self.to - self.from;
        &self.rows[node * sets..][..sets]
    }
}

impl Index for SlabsIndex {
    const REPEATS: Repeats = Repeats::Never;
    type Cursor = Cursor;

    /// A volume is met as often as its surface is to that of the box around all.
    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected {
        volume::expected(self, family, leaves)
    }

    fn rename_leaves(&mut self, leaves: &[Leaf]) {
        self.tree.rename_leaves(leaves);
    }

    fn bytes(&self) -> u64 {
        self.tree.bytes() + size_of_val(self.rows.as_slice()) as u64
    }

    #[inline(always)]
    fn start<S: Simd>(&self, _simd: S, walk: &mut Walk<'_>, _limit: f32) -> (Cursor, Step) {
        let mut cursor = Cursor { boxes: self.tree.cursor(walk), ..Cursor::default() };
        let directions = &planes::SLANTING[self.from..self.to];
        planes::prepare(walk.ray, self.tree.reach(), directions, &mut cursor.cuts);
        (cursor, Step::onward(0))
    }

    #[inline(always)]
    fn step<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        at: Step,
        limit: f32,
    ) -> Step {
        let (mut near, mut far) = self.tree.cut(simd, &cursor.boxes, at, limit);
        if simd.le(near, far) != 0 {
            for (cut, rows) in cursor.cuts.iter().zip(self.rows(at.word() as usize)) {
                (near, far) = cut.narrow(simd, rows, near, far);
            }
        }
        let (mask, words) = (simd.le(near, far), self.tree.words(at));
        turn::<S, Q>(simd, walk.trail, &mut cursor.boxes.top, mask, near, words, limit)
    }

    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        limit: f32,
    ) -> Step {
        next::<S, Q>(simd, walk.trail, &mut cursor.boxes.top, limit)
    }

    #[inline(always)]
    fn address(&self, cursor: &Cursor, at: Step) -> *const u8 {
        self.tree.address(&cursor.boxes, at)
    }
}

#[cfg(test)]
mod tests;
