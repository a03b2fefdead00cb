//! Spacetime [Glassner 88]: cells of space and time guide how children are put together, and
//! boxes around what is in each cell, cut to it, make a hierarchy whose siblings are disjoint.
//!
//! Space `O(n)` (at most 8 references a child), build `O(n log n)`, a ray visits the cells on its
//! way at its time, but for what is empty in them.

mod cut;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::motion_bvh::MotionBvh;
use crate::timed_tree::{Growing, Manner, TimedTree, Visits, grow};
use crate::wide_tree::{Contents, LeafSize};

/// The technique: a hierarchy over cells of space and time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Spacetime {
    /// Most children in one leaf, if cells can be cut.
    pub max_leaf: usize,
    /// Candidate planes per axis of small cells, equally spaced; large ones are cut in half.
    pub planes: usize,
    /// What testing a packed leaf costs, in visits of a node.
    pub leaf_cost: f32,
    /// How often the shutter may be halved.
    pub halvings: u32,
    /// How many times cheaper a cut in time must be than one in space.
    pub bias: f32,
}

impl Default for Spacetime {
    fn default() -> Self {
        Self { max_leaf: 4, planes: 3, leaf_cost: 0.8, halvings: 4, bias: 1.25 }
    }
}

/// References a child may become, on average.
const REPEATS: f64 = 8.0;
/// Most cells around one: the first that makes the tree shallow enough is taken.
const MOST_AROUND: [usize; 3] = [72, 24, 8];

impl Technique for Spacetime {
    const NAME: &'static str = "spacetime";
    const EFFORT: f64 = 10.0;
    type Index = TimedTree;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> TimedTree {
        let size = LeafSize { most: self.max_leaf, cost: self.leaf_cost };
        let of = Contents::new(family);
        TimedTree::new(size, &of, Visits::Often, leaves, &MOST_AROUND, |most_around| {
            let mut growing = Growing::new(family, &of);
            let mut all = growing.all(REPEATS * f64::from(family.count()), Manner::Cells);
            all.cell = all.bounds().within;
            grow(all, |open| cut::cut(self, &mut growing, open, most_around))
        })
    }

    fn neighbours(&self) -> Vec<Self> {
        let leaves = [self.max_leaf / 2, self.max_leaf * 2];
        let leaves = leaves.map(|max_leaf| Self { max_leaf, ..*self });
        let planes = [1, 3, 7].map(|planes| Self { planes, ..*self });
        let halvings = [0, 2, 4, 6].map(|halvings| Self { halvings, ..*self });
        let near = leaves.into_iter().chain(planes).chain(halvings);
        near.filter(|params| params != self && params.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((1..=31).contains(&self.planes), "planes", "1 to 31")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")?;
        in_range((0..=8).contains(&self.halvings), "halvings", "0 to 8")?;
        in_range((1.0..=100.0).contains(&self.bias), "bias", "1 to 100")
    }
}

impl Spacetime {
    /// How what moves in one cell is put together.
    fn moving(&self) -> MotionBvh {
        let Self { max_leaf, leaf_cost, halvings, bias, .. } = *self;
        MotionBvh { max_leaf, leaf_cost, halvings, bias, ..MotionBvh::default() }
    }
}

#[cfg(test)]
mod tests;
