//! A bounding volume hierarchy that cuts children where boxes overlap [Stich 09]: a long child
//! stands in several leaves, each time with a small box around a part of it.
//!
//! Where much is cut, subtrees then look for better places.
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

use crate::reinsertion;
use crate::wide_tree::{Binary, LeafSize, WideTree};

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
    /// Most times that subtrees look for better places afterwards [Bittner 13], if much was cut.
    pub passes: usize,
    /// Which part of all subtrees looks each time: the largest.
    pub share: f32,
    /// Most children in one leaf.
    pub max_leaf: usize,
    /// Candidate planes per axis between children.
    pub bins: usize,
    /// What testing a leaf costs, in visits of a node.
    pub leaf_cost: f32,
}

impl Default for Sbvh {
    fn default() -> Self {
        Self {
            copies: 1.3,
            early: 1.0,
            overlap: 1e-3,
            passes: 3,
            share: 0.3,
            max_leaf: 8,
            bins: 32,
            leaf_cost: 0.8,
        }
    }
}

/// So many times as many pieces as children: where less is worth cutting, boxes overlap little, and
/// to move subtrees gains less than it takes.
const MUCH: f64 = 1.05;

impl Technique for Sbvh {
    const NAME: &'static str = "sbvh";
    const EFFORT: f64 = 6.0;
    type Index = WideTree;
    const COPIES: usize = 2;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> WideTree {
        let size = LeafSize { most: self.max_leaf, cost: self.leaf_cost };
        WideTree::new(size, family, leaves, |of, halves_from| {
            let cut = build::split(self, family, of, halves_from);
            let is_much = cut.order.len() as f64 >= MUCH * of.boxes.len() as f64;
            let improves = self.passes > 0 && is_much;
            if improves { self.improved(size, cut, halves_from) } else { cut }
        })
    }

    fn neighbours(&self) -> Vec<Self> {
        let near = [
            Self { copies: 1.1, ..*self },
            Self { copies: 2.0, ..*self },
            Self { passes: 0, ..*self },
            Self { passes: 8, share: 1.0, ..*self },
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
        in_range((0..=64).contains(&self.passes), "passes", "0 to 64")?;
        in_range((0.001..=1.0).contains(&self.share), "share", "0.001 to 1")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")?;
        in_range((2..=64).contains(&self.bins), "bins", "2 to 64")?;
        in_range((0.01..=100.0).contains(&self.leaf_cost), "leaf_cost", "0.01 to 100")
    }
}

impl Sbvh {
    /// A hierarchy in which pieces of children have looked for better places.
    fn improved<'a>(&self, size: LeafSize, cut: Binary<'a>, halves_from: usize) -> Binary<'a> {
        let pieces = cut.pieces();
        let Binary { of, order, pairs } = cut;
        let begin = Binary { of: &pieces, order: (0..order.len() as u32).collect(), pairs };
        let best = reinsertion::improved(begin, self.passes, self.share, size, halves_from);
        let order_of_pieces = best.order.into_iter();
        let order = order_of_pieces.map(|piece| order[piece as usize]).collect();
        Binary { of, order, pairs: best.pairs }
    }
}
