//! A bounding volume hierarchy for what moves: boxes linear in time, split in space by their
//! mean surface, and in time where that pays [Woop 17].
//!
//! Space about 40 bytes per child, 80 where children move, more where time is split; build
//! `O(n log n)`, a ray visits `O(log n)` nodes.

mod plane;
pub(crate) mod split;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::bvh::Bvh;
use crate::timed_tree::{Growing, Manner, TimedTree, Visits, grow};
use crate::wide_tree::{Contents, LeafSize};

/// The technique: a hierarchy of moving boxes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionBvh {
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// Candidate planes per axis.
    pub bins: usize,
    /// What testing a packed leaf costs, in visits of a node.
    pub leaf_cost: f32,
    /// How often the shutter may be halved.
    pub halvings: u32,
    /// How many times cheaper a split in time must be than one in space.
    pub bias: f32,
}

impl Default for MotionBvh {
    fn default() -> Self {
        Self { max_leaf: 8, bins: 32, leaf_cost: 0.8, halvings: 4, bias: 1.25 }
    }
}

/// References a child may become, on average, by splits in time.
const REPEATS: f64 = 4.0;
/// From which depth on children are split in halves: the first that makes the tree shallow
/// enough is taken.
const HALVES_FROM: [usize; 3] = [96, 24, 0];

impl Technique for MotionBvh {
    const NAME: &'static str = "motion-bvh";
    const EFFORT: f64 = 1.5;
    type Index = TimedTree;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> TimedTree {
        let (max_leaf, bins, leaf_cost) = (self.max_leaf, self.bins, self.leaf_cost);
        if !(0..family.count()).any(|child| moves(family, child)) {
            return TimedTree::still(Bvh { max_leaf, bins, leaf_cost }.build(family, leaves));
        }
        let size = LeafSize { most: max_leaf, cost: leaf_cost };
        let of = Contents::new(family);
        TimedTree::new(size, &of, Visits::Once, leaves, &HALVES_FROM, |halves_from| {
            let mut growing = Growing::new(family, &of);
            let all = growing.all(REPEATS * f64::from(family.count()), Manner::Children);
            grow(all, |open| split::split(self, &mut growing, open, halves_from))
        })
    }

    fn neighbours(&self) -> Vec<Self> {
        let leaves = [self.max_leaf / 2, self.max_leaf * 2];
        let leaves = leaves.map(|max_leaf| Self { max_leaf, ..*self });
        let halvings = [0, 2, 4, 6].map(|halvings| Self { halvings, ..*self });
        let near = leaves.into_iter().chain(halvings);
        near.filter(|params| params != self && params.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((2..=64).contains(&self.bins), "bins", "2 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")?;
        in_range((0..=8).contains(&self.halvings), "halvings", "0 to 8")?;
        in_range((1.0..=100.0).contains(&self.bias), "bias", "1 to 100")
    }
}

/// Whether a child is smaller at the beginning than over the whole shutter.
fn moves(family: &dyn Family, child: u32) -> bool {
    family.bounds_during(child, [0.0, 0.0]) != family.bounds_during(child, [0.0, 1.0])
}

#[cfg(test)]
mod tests;
