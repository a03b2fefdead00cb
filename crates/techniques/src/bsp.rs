//! The BSP tree of [Kaplan 85]: cells cut in the middle, along each axis in turn.
//!
//! Space `O(n)` (at most 8 entries a child), build `O(n · depth)`, a ray visits the cells on its
//! way.

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::cells::{Cell, Cells, Children, Plane, Rule};

/// The technique: a BSP tree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Bsp {
    /// Cells with more children are cut, 2 in the literature; 0 is 8 for packed triangles and 2
    /// for all else.
    pub max_leaf: usize,
    /// Most cells around one, 16 in the literature; 0 chooses by the number of children, 16 or
    /// more.
    pub max_depth: u32,
}

impl Technique for Bsp {
    const NAME: &'static str = "bsp";
    const EFFORT: f64 = 2.0;
    type Index = Cells;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Cells {
        let children = Children::new(family);
        let max_depth = match self.max_depth {
            0 => children.usual_depth().max(16),
            depth => depth,
        };
        let rule = Self { max_leaf: children.most_in_leaf(self.max_leaf, 2), max_depth };
        Cells::new(&rule, &children, leaves)
    }

    fn neighbours(&self) -> Vec<Self> {
        let from = if self.max_leaf > 0 { self.max_leaf } else { 4 };
        [from / 2, from * 2]
            .map(|max_leaf| Self { max_leaf, ..*self })
            .into_iter()
            .filter(|params| params.max_leaf > 0 && params.check().is_ok())
            .collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((0..=64).contains(&self.max_leaf), "max_leaf", "0 (chosen), or 1 to 64")?;
        in_range((0..=64).contains(&self.max_depth), "max_depth", "0 (chosen), or 1 to 64")
    }
}

impl Rule for Bsp {
    /// The axis to cut next.
    type Memory = usize;

    fn cut(&self, cell: &Cell<'_>, next: usize) -> Option<(Plane, usize)> {
        if cell.inside.len() <= self.max_leaf || cell.depth >= self.max_depth {
            return None;
        }
        // An axis along which nothing is set apart waits for the next turn.
        (next..next + 3).map(|axis| axis % 3).find_map(|axis| {
            let at = cell.middle(axis).filter(|&at| cell.separates(axis, at))?;
            Some((Plane { axis, at }, (axis + 1) % 3))
        })
    }
}
