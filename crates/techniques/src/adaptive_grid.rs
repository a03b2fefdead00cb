//! Adaptive voxel subdivision [Jevans 89]: a coarse grid whose cells, where many children are, are
//! cut up again, each by how many there are and only where they are.
//!
//! Space `O(n)` (at most 16 entries a child), build `O(n · depth)`, a ray takes at most
//! `3 · cells^⅓` steps in each grid on its way.

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::cells::Children;
use crate::grids::resolution::{cubical, fitting, shown};
use crate::grids::{Crowd, Grids, Rule};

/// The technique: an adaptive grid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdaptiveGrid {
    /// Cells per child, in every grid.
    pub density: f32,
    /// Most grids around a child.
    pub max_depth: u32,
    /// Cells with more children are cut.
    pub max_leaf: usize,
}

impl Default for AdaptiveGrid {
    /// As in [Havran 00].
    fn default() -> Self {
        Self { density: 3.0, max_depth: 3, max_leaf: 8 }
    }
}

/// A line must be shown less than this part of the children in a cell once it is cut: those in
/// one place stay together.
const FEWER: f64 = 0.9;

impl Technique for AdaptiveGrid {
    const NAME: &'static str = "adaptive-grid";
    const EFFORT: f64 = 2.0;
    type Index = Grids;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Grids {
        Grids::new(self, &Children::new(family), leaves)
    }

    fn neighbours(&self) -> Vec<Self> {
        [
            Self { density: self.density * 0.5, ..*self },
            Self { density: self.density * 2.0, ..*self },
            Self { max_depth: self.max_depth - 1, ..*self },
            Self { max_depth: self.max_depth + 1, ..*self },
            Self { max_leaf: self.max_leaf / 2, ..*self },
            Self { max_leaf: self.max_leaf * 2, ..*self },
        ]
        .into_iter()
        .filter(|params| params.check().is_ok())
        .collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((0.01..=100.0).contains(&self.density), "density", "0.01 to 100")?;
        in_range((1..=8).contains(&self.max_depth), "max_depth", "1 to 8")?;
        in_range((1..=1000).contains(&self.max_leaf), "max_leaf", "1 to 1000")
    }
}

impl Rule for AdaptiveGrid {
    fn part(&self, cell: Aabb, hull: Aabb) -> Aabb {
        cell.meet(hull)
    }

    fn cut(&self, crowd: &Crowd<'_>) -> Option<[u32; 3]> {
        let (count, density) = (crowd.inside.len(), f64::from(self.density));
        if crowd.depth == 0 {
            return Some(fitting(crowd, density));
        }
        if crowd.depth >= self.max_depth || count <= self.max_leaf {
            return None;
        }
        let cells = cubical(crowd, density * count as f64);
        (shown(crowd, cells) < FEWER).then_some(cells)
    }
}
