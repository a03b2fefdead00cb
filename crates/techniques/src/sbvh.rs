//! A bounding volume hierarchy that cuts children where boxes overlap [Stich 09]: a long child
//! stands in several leaves, each time with a small box around a part of it.
//!
//! Space about 40 bytes per child and copy, build `O(n log n)`, a ray visits `O(log n)` nodes.

mod build;
mod cut;
mod early;
mod plane;
#[cfg(test)]
mod tests;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::wide_tree::{LeafSize, WideTree};

/// The technique: a hierarchy of boxes that long children are cut for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sbvh {
    /// In how many leaves a child stands at most, on average.
    pub copies: f32,
    /// Which part of the copies may be made before the tree is built, of the largest children.
    pub early: f32,
    /// Children are cut where the boxes of two sides overlap by this part of the whole surface.
    pub overlap: f32,
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// Candidate planes per axis between children.
    pub bins: usize,
    /// What testing a leaf costs, in visits of a node.
    pub leaf_cost: f32,
}

impl Default for Sbvh {
    fn default() -> Self {
        Self { copies: 1.5, early: 1.0, overlap: 1e-5, max_leaf: 8, bins: 32, leaf_cost: 0.8 }
    }
}

impl Technique for Sbvh {
    const NAME: &'static str = "sbvh";
    type Index = WideTree;
    const COPIES: usize = 2;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> WideTree {
        let size = LeafSize { most: self.max_leaf, cost: self.leaf_cost };
        WideTree::new(size, family, leaves, |of, halves_from| {
            build::split(self, family, of, halves_from)
        })
    }

    fn neighbours(&self) -> Vec<Self> {
        let near = [
            Self { copies: 1.2, ..*self },
            Self { copies: 2.0, ..*self },
            Self { early: 0.0, ..*self },
            Self { overlap: self.overlap / 10.0, ..*self },
            Self { overlap: self.overlap * 10.0, ..*self },
            Self { max_leaf: self.max_leaf / 2, ..*self },
            Self { max_leaf: self.max_leaf * 2, ..*self },
        ];
        near.into_iter().filter(|params| params != self && params.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1.0..=2.0).contains(&self.copies), "copies", "1 to 2")?;
        in_range((0.0..=1.0).contains(&self.early), "early", "0 to 1")?;
        in_range((0.0..=1.0).contains(&self.overlap), "overlap", "0 to 1")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((2..=64).contains(&self.bins), "bins", "2 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")
    }
}
