//! The uniform grid whose crowded cells hold a grid again [Devillers 89].
//!
//! Space `O(n)` (at most 16 entries a child), build `O(n · depth)`, a ray takes at most
//! `3 · cells^⅓` steps in each grid on its way.

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::cells::Children;
use crate::grids::resolution::{cheapest, cheapest_around, fitting};
use crate::grids::{Crowd, Grids, Rule};

/// The technique: grids in the cells of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct NestedGrid {
    /// Cells per child, in every grid; 0 chooses by expected cost.
    pub density: f32,
    /// Most grids around a child.
    pub max_depth: u32,
    /// Cells with more children are cut, if that pays.
    pub max_leaf: usize,
}

impl Default for NestedGrid {
    fn default() -> Self {
        Self { density: 0.0, max_depth: 3, max_leaf: 4 }
    }
}

/// Densities to choose from, in cells per child: of the outermost grid, which may leave crowds to
/// others, and of those.
const OUTER: [f64; 10] = [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
const INNER: [f64; 6] = [0.25, 0.5, 1.0, 2.0, 4.0, 8.0];
/// A grid in a cell must cost a line less than this part of testing all there is in the cell.
const WORTH: f64 = 0.9;

impl Technique for NestedGrid {
    const NAME: &'static str = "nested-grid";
    const EFFORT: f64 = 4.0;
    type Index = Grids;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Grids {
        Grids::new(self, &Children::new(family), leaves)
    }

    fn neighbours(&self) -> Vec<Self> {
        let from = if self.density > 0.0 { self.density } else { 2.0 };
        [
            Self { density: from * 0.5, ..*self },
            Self { density: from * 2.0, ..*self },
            Self { max_depth: self.max_depth - 1, ..*self },
            Self { max_depth: self.max_depth + 1, ..*self },
            Self { max_leaf: self.max_leaf * 2, ..*self },
        ]
        .into_iter()
        .filter(|params| params.check().is_ok())
        .collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        let dense = self.density == 0.0 || (0.001..=1000.0).contains(&self.density);
        in_range(dense, "density", "0 (chosen), or 0.001 to 1000")?;
        in_range((1..=8).contains(&self.max_depth), "max_depth", "1 to 8")?;
        in_range((1..=1000).contains(&self.max_leaf), "max_leaf", "1 to 1000")
    }
}

impl Rule for NestedGrid {
    fn part(&self, cell: Aabb, _hull: Aabb) -> Aabb {
        cell
    }

    fn cut(&self, crowd: &Crowd<'_>) -> Option<[u32; 3]> {
        let set = [f64::from(self.density)];
        if crowd.depth == 0 {
            let few = if self.max_depth > 1 { self.max_leaf } else { usize::MAX };
            return Some(if set[0] > 0.0 {
                fitting(crowd, set[0])
            } else {
                cheapest_around(crowd, &OUTER, few)
            });
        }
        if crowd.depth >= self.max_depth || crowd.inside.len() <= self.max_leaf {
            return None;
        }
        let (cells, cost, all) = cheapest(crowd, if set[0] > 0.0 { &set } else { &INNER });
        (cost < WORTH * all).then_some(cells)
    }
}
