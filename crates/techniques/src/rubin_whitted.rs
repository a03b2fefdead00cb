//! A hierarchy of boxes that are turned where that makes them smaller [Rubin 80].
//!
//! Space 40 to 80 bytes per child, build `O(n log n)`, a ray visits `O(log n)` nodes.

mod orient;

use glam::Vec3A;
use nestray_core::family::Family;
use nestray_core::simd::Simd;
use nestray_core::technique::{
    Expected, Index, Leaf, Leaves, OutOfRange, Query, Repeats, Step, Technique, Walk, in_range,
};
use serde::{Deserialize, Serialize};

use crate::bvh::Bvh;
use crate::slabs::planes::{Cut, slack};
use crate::wide_tree::{self, WideTree, next, turn};

/// A tree of boxes. In some nodes all eight are turned alike.
#[derive(Debug)]
pub struct RubinWhittedIndex {
    /// The note of a turned node is 1 more than the number of its turned boxes.
    tree: WideTree,
    turned: Vec<Turned>,
}

/// The boxes of one node, turned.
#[derive(Clone, Copy, Debug)]
struct Turned {
    axes: [Vec3A; 3],
    /// For each axis, how far the eight reach.
    rows: [[[f32; 8]; 2]; 3],
}

/// The technique: a hierarchy of turned boxes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RubinWhitted {
    /// How many times smaller turned boxes must be to be worth turning the ray.
    pub gain: f32,
    /// Nodes with more children below are not turned: large parts of a scene fill boxes as
    /// well one way as another.
    pub most_below: usize,
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// What testing a leaf costs, in visits of a node.
    pub leaf_cost: f32,
}

impl Default for RubinWhitted {
    fn default() -> Self {
        Self { gain: 1.5, most_below: 4096, max_leaf: 8, leaf_cost: 0.8 }
    }
}

impl Technique for RubinWhitted {
    const NAME: &'static str = "rubin-whitted";
    const EFFORT: f64 = 12.0;
    type Index = RubinWhittedIndex;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> RubinWhittedIndex {
        let (max_leaf, leaf_cost) = (self.max_leaf, self.leaf_cost);
        let of_boxes = Bvh { max_leaf, leaf_cost, ..Bvh::default() };
        let tree = of_boxes.build(family, leaves);
        let (notes, turned) = orient::turned(self, &tree, family, leaves);
        RubinWhittedIndex { tree: tree.with_notes(&notes), turned }
    }

    fn neighbours(&self) -> Vec<Self> {
        let gains = [1.0, 1.25, 2.0].map(|gain| Self { gain, ..*self });
        let leaves = [self.max_leaf / 2, self.max_leaf * 2];
        let leaves = leaves.map(|max_leaf| Self { max_leaf, ..*self });
        let near = gains.into_iter().chain(leaves);
        near.filter(|params| params != self && params.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1.0..=100.0).contains(&self.gain), "gain", "1 to 100")?;
        in_range((1..=1 << 20).contains(&self.most_below), "most_below", "1 to 1048576")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")
    }
}

impl Index for RubinWhittedIndex {
    const REPEATS: Repeats = Repeats::Never;
    type Cursor = wide_tree::Cursor;

    /// A box is met as often as its surface is to that of the box around all.
    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected {
        orient::expected(self, family, leaves)
    }

    fn rename_leaves(&mut self, leaves: &[Leaf]) {
        self.tree.rename_leaves(leaves);
    }

    fn bytes(&self) -> u64 {
        self.tree.bytes() + size_of_val(self.turned.as_slice()) as u64
    }

    #[inline(always)]
    fn start<S: Simd>(
        &self,
        _simd: S,
        walk: &mut Walk<'_>,
        _limit: f32,
    ) -> (wide_tree::Cursor, Step) {
        (self.tree.cursor(walk), Step::onward(0))
    }

    #[inline(always)]
    fn step<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut wide_tree::Cursor,
        at: Step,
        limit: f32,
    ) -> Step {
        let (near, far) = match self.tree.note(at) {
            0 => self.tree.cut(simd, cursor, at, limit),
            note => {
                let turned = &self.turned[note as usize - 1];
                let slack = slack(walk.ray, self.tree.reach());
                let (mut near, mut far) = (simd.splat(cursor.t_min()), simd.splat(limit));
                for (axis, rows) in turned.axes.iter().zip(&turned.rows) {
                    (near, far) = Cut::new(walk.ray, slack, *axis).narrow(simd, rows, near, far);
                }
                (near, far)
            }
        };
        let (mask, words) = (simd.le(near, far), self.tree.words(at));
        turn::<S, Q>(simd, walk.trail, &mut cursor.top, mask, near, words, limit)
    }

    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut wide_tree::Cursor,
        limit: f32,
    ) -> Step {
        next::<S, Q>(simd, walk.trail, &mut cursor.top, limit)
    }

    #[inline(always)]
    fn address(&self, cursor: &wide_tree::Cursor, at: Step) -> *const u8 {
        self.tree.address(cursor, at)
    }
}

#[cfg(test)]
mod tests;
