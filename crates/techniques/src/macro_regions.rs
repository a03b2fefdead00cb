//! The uniform grid whose empty cells are gathered into large boxes, which a ray crosses in one
//! step [Devillers 89].
//!
//! Space `O(cells + overlaps)`, build `O(cells + overlaps)`, a ray takes at most `3 · cells^⅓`
//! steps, and far fewer where most cells are empty.

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::cells::Children;
use crate::grids::resolution::{fitting, sparsest};
use crate::grids::{Crowd, Grids, Rule};

/// The technique: a grid with macro-regions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MacroRegions {
    /// Cells per child, 8 to 64 or more; 0 chooses by expected cost.
    pub density: f32,
}

impl Technique for MacroRegions {
    const NAME: &'static str = "macro-regions";
    const EFFORT: f64 = 6.0;
    type Index = Grids;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Grids {
        Grids::new(self, &Children::new(family), leaves)
    }

    fn neighbours(&self) -> Vec<Self> {
        let from = if self.density > 0.0 { self.density } else { 16.0 };
        [0.5, 2.0]
            .map(|factor| Self { density: from * factor })
            .into_iter()
            .filter(|params| params.check().is_ok())
            .collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        let dense = self.density == 0.0 || (0.001..=1000.0).contains(&self.density);
        in_range(dense, "density", "0 (chosen), or 0.001 to 1000")
    }
}

impl Rule for MacroRegions {
    fn part(&self, cell: Aabb, _hull: Aabb) -> Aabb {
        cell
    }

    fn cut(&self, crowd: &Crowd<'_>) -> Option<[u32; 3]> {
        if crowd.depth > 0 {
            return None;
        }
        let set = f64::from(self.density);
        Some(if set > 0.0 { fitting(crowd, set) } else { sparsest(crowd) })
    }

    fn has_regions(&self) -> bool {
        true
    }
}
