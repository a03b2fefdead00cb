//! A bounding volume hierarchy grown child by child, each put where the expected cost grows
//! least [Goldsmith 87].
//!
//! Space about 40 bytes per child, build `O(n log n)` as a rule and `O(n · visits)` at worst, a ray
//! visits `O(log n)` nodes.

mod grow;
mod order;

use std::cell::OnceCell;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use self::grow::Grown;
pub use self::order::Order;
use crate::wide_tree::{Binary, Contents, LeafSize, WideTree};

/// The technique: a hierarchy grown child by child.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GoldsmithSalmon {
    /// In which order children come, at the first try; at all others they come shuffled.
    pub order: Order,
    /// What shuffles begin with.
    pub seed: u64,
    /// How many trees are grown; the cheapest is kept.
    pub tries: u32,
    /// Most volumes looked into to find the best place for a child.
    pub visits: usize,
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// What testing a leaf costs, in visits of a node.
    pub leaf_cost: f32,
}

impl Default for GoldsmithSalmon {
    fn default() -> Self {
        let (order, max_leaf, leaf_cost) = (Order::Shuffled, 8, 0.8);
        Self { order, seed: 0, tries: 4, visits: 128, max_leaf, leaf_cost }
    }
}

impl Technique for GoldsmithSalmon {
    const NAME: &'static str = "goldsmith-salmon";
    const EFFORT: f64 = 15.0;
    type Index = WideTree;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> WideTree {
        let size = LeafSize { most: self.max_leaf, cost: self.leaf_cost };
        // Grown once, however often it has to be made shallower.
        let merges = OnceCell::new();
        WideTree::new(size, family, leaves, |of, halves_from| {
            Binary::merged(of, merges.get_or_init(|| self.merges(of)), halves_from)
        })
    }

    fn neighbours(&self) -> Vec<Self> {
        let mut near = Vec::new();
        for order in [Order::Given, Order::Shuffled, Order::Largest] {
            near.push(Self { order, ..*self });
        }
        for tries in [self.tries / 2, self.tries * 2] {
            near.push(Self { tries, ..*self });
        }
        near.push(Self { seed: self.seed.wrapping_add(1), ..*self });
        near.retain(|params| params != self && params.check().is_ok());
        near
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1..=64).contains(&self.tries), "tries", "1 to 64")?;
        in_range((1..=65_536).contains(&self.visits), "visits", "1 to 65536")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")
    }
}

impl GoldsmithSalmon {
    /// The cheapest tree of all tries, in pairs.
    fn merges<'a>(&self, of: &'a Contents) -> Vec<[u32; 2]> {
        let grown = |attempt: u32| {
            let order = if attempt == 0 { self.order } else { Order::Shuffled };
            let order = order.of(&of.boxes, self.seed.wrapping_add(u64::from(attempt)));
            let mut tree = Grown::new(&of.boxes, self.visits);
            for child in order {
                tree.insert(child);
            }
            (tree.cost(), attempt, tree)
        };
        let cheaper = |a: (f64, u32, Grown<'a>), b: (f64, u32, Grown<'a>)| {
            if a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).is_le() { a } else { b }
        };
        let best = (0..self.tries).into_par_iter().map(grown).reduce_with(cheaper);
        let (_, _, tree) = best.expect("there is a try at least");
        tree.merges()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::counted::{expected_and_counted, spheres};

    #[test]
    fn random_lines_do_what_is_expected() {
        let params = GoldsmithSalmon::default();
        let both = expected_and_counted(&params, &spheres(500, 1), 2);
        for [expected, counted] in both {
            assert!((counted / expected - 1.0).abs() < 0.03, "{counted} for {expected}");
        }
    }

    #[test]
    fn more_tries_are_not_dearer() {
        let cost = |tries| {
            let params = GoldsmithSalmon { tries, ..Default::default() };
            expected_and_counted(&params, &spheres(100, 1), 2)[0][0]
        };
        assert!(cost(16) <= 1.05 * cost(1), "{} {}", cost(16), cost(1));
    }
}
