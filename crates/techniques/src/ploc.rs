//! A bounding volume hierarchy put together from the bottom: neighbours along a curve through
//! space merge where the joint box is smallest [Meister 18].
//!
//! Space about 40 bytes per child, build `O(n log n + n · window)`, a ray visits `O(log n)` nodes.

mod merge;

use std::cell::OnceCell;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::wide_tree::{Binary, LeafSize, WideTree};

/// The technique: a hierarchy put together from the bottom.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Ploc {
    /// How many clusters to either side are candidates to merge with.
    pub window: usize,
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// What testing a leaf costs, in visits of a node.
    pub leaf_cost: f32,
}

impl Default for Ploc {
    fn default() -> Self {
        Self { window: 16, max_leaf: 8, leaf_cost: 0.8 }
    }
}

impl Technique for Ploc {
    const NAME: &'static str = "ploc";
    const EFFORT: f64 = 2.0;
    type Index = WideTree;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> WideTree {
        let size = LeafSize { most: self.max_leaf, cost: self.leaf_cost };
        // Merged once, however often it has to be made shallower.
        let merges = OnceCell::new();
        WideTree::new(size, family, leaves, |of, halves_from| {
            let merges = merges.get_or_init(|| merge::merges(of, self.window));
            Binary::merged(of, merges, halves_from)
        })
    }

    fn neighbours(&self) -> Vec<Self> {
        let near = [
            Self { window: self.window / 2, ..*self },
            Self { window: self.window * 2, ..*self },
            Self { max_leaf: self.max_leaf / 2, ..*self },
            Self { max_leaf: self.max_leaf * 2, ..*self },
        ];
        near.into_iter().filter(|params| params.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1..=128).contains(&self.window), "window", "1 to 128")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::counted::{expected_and_counted, spheres};

    #[test]
    fn random_lines_do_what_is_expected() {
        let params = Ploc::default();
        for [expected, counted] in expected_and_counted(&params, &spheres(500, 1), 2) {
            assert!((counted / expected - 1.0).abs() < 0.03, "{counted} for {expected}");
        }
    }
}
