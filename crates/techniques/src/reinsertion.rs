//! A bounding volume hierarchy made better: subtrees are taken out and put where the joint surface
//! of all boxes falls most [Bittner 13].
//!
//! Space about 40 bytes per child, build `O(n log n)` and a few seconds for a million, a ray visits
//! `O(log n)` nodes.

mod moves;
mod search;
#[cfg(test)]
mod tests;
mod tree;

use std::collections::VecDeque;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::bvh::build;
use crate::wide_tree::{Binary, Contents, LeafSize, WideTree};

/// The technique: a hierarchy whose subtrees look for better places.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Reinsertion {
    /// Most times that subtrees look for better places.
    pub passes: usize,
    /// Which part of all subtrees looks each time: the largest.
    pub share: f32,
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// Candidate planes per axis, for the hierarchy to begin with.
    pub bins: usize,
    /// What testing a leaf costs, in visits of a node.
    pub leaf_cost: f32,
}

impl Default for Reinsertion {
    fn default() -> Self {
        Self { passes: 8, share: 1.0, max_leaf: 8, bins: 32, leaf_cost: 0.8 }
    }
}

impl Technique for Reinsertion {
    const NAME: &'static str = "reinsertion";
    const EFFORT: f64 = 8.0;
    type Index = WideTree;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> WideTree {
        let size = LeafSize { most: self.max_leaf, cost: self.leaf_cost };
        WideTree::new(size, family, leaves, |of, halves_from| self.best(size, of, halves_from))
    }

    fn neighbours(&self) -> Vec<Self> {
        let near = [
            Self { share: self.share / 4.0, ..*self },
            Self { passes: self.passes / 2, ..*self },
            Self { passes: self.passes * 2, ..*self },
            Self { max_leaf: self.max_leaf / 2, ..*self },
            Self { max_leaf: self.max_leaf * 2, ..*self },
        ];
        near.into_iter().filter(|params| params.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1..=64).contains(&self.passes), "passes", "1 to 64")?;
        in_range((0.001..=1.0).contains(&self.share), "share", "0.001 to 1")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((2..=64).contains(&self.bins), "bins", "2 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")
    }
}

/// A pass that gains less than this part is not worth another of its kind.
const LEAST: f64 = 0.001;

impl Reinsertion {
    fn best<'a>(&self, size: LeafSize, of: &'a Contents, halves_from: usize) -> Binary<'a> {
        let begin = build::split(self.bins, 1, of, halves_from);
        improved(begin, self.passes, self.share, size, halves_from)
    }
}

/// A hierarchy made better in at most `passes`, as long as nodes of eight gain by that. Each leaf
/// of it is one child. What single children gain may be lost by leaves less full: so passes in
/// which leaves move as a whole alternate with those in which they do not.
pub(crate) fn improved(
    mut best: Binary<'_>,
    passes: usize,
    share: f32,
    size: LeafSize,
    halves_from: usize,
) -> Binary<'_> {
    if best.order.len() < 4 {
        return best;
    }
    let mut outlook = best.outlook(size);
    let mut kinds = VecDeque::from([false, true]);
    for _ in 0..passes {
        let Some(whole_leaves) = kinds.pop_front() else { break };
        let leaves = if whole_leaves { &outlook.leaves[..] } else { &[] };
        let merges = moves::merges(share, &best, leaves);
        let next = Binary::merged(best.of, &merges, halves_from);
        let next_outlook = next.outlook(size);
        let before = outlook.cost.unwrap_or(f64::INFINITY);
        let after = next_outlook.cost.unwrap_or(f64::INFINITY);
        if after < before {
            (best, outlook) = (next, next_outlook);
        }
        if after < (1.0 - LEAST) * before {
            kinds.push_back(whole_leaves);
        }
    }
    best
}
