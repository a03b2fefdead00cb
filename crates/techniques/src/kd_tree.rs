//! The kd-tree: cells cut where a random ray is expected to be done soonest, by the surface area
//! heuristic [Havran 00].
//!
//! Space `O(n)` (at most 8 entries a child), build `O(n log² n)`, a ray visits `O(log n)` nodes.

mod sweep;

use nestray_core::family::Family;
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::cells::{Cell, Cells, Children, Plane, Rule};

use self::sweep::Sweep;

/// The technique: a kd-tree.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct KdTree {
    /// What visiting a node costs, in nanoseconds.
    pub step_cost: f32,
    /// By which part a cut is cheaper if it cuts off empty space.
    pub empty_bonus: f32,
    /// Most cells around one; 0 chooses by the number of children.
    pub max_depth: u32,
}

impl Default for KdTree {
    fn default() -> Self {
        Self { step_cost: 5.0, empty_bonus: 0.2, max_depth: 0 }
    }
}

impl Technique for KdTree {
    const NAME: &'static str = "kd-tree";
    const EFFORT: f64 = 6.0;
    type Index = Cells;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Cells {
        let children = Children::new(family);
        let max_depth = match self.max_depth {
            0 => children.usual_depth(),
            depth => depth,
        };
        let rule = Self { max_depth, ..*self };
        Cells::new(&rule, &children, leaves)
    }

    fn neighbours(&self) -> Vec<Self> {
        [0.5, 2.0]
            .map(|factor| Self { step_cost: self.step_cost * factor, ..*self })
            .into_iter()
            .filter(|params| params.check().is_ok())
            .collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((0.01..=1000.0).contains(&self.step_cost), "step_cost", "0.01 to 1000")?;
        in_range((0.0..=0.9).contains(&self.empty_bonus), "empty_bonus", "0 to 0.9")?;
        in_range((0..=64).contains(&self.max_depth), "max_depth", "0 (chosen), or 1 to 64")
    }
}

/// Most cuts on the way to a cell that seemed not worth it [Pharr 23].
const MOST_BAD: u8 = 3;
/// Cells with fewer children are not cut where that seems not worth it.
const FEW: usize = 16;

impl Rule for KdTree {
    /// How many cuts on the way seemed not worth it.
    type Memory = u8;

    fn cut(&self, cell: &Cell<'_>, bad: u8) -> Option<(Plane, u8)> {
        let whole = cell.price();
        if cell.depth >= self.max_depth || whole <= f64::from(self.step_cost) {
            return None;
        }
        let (plane, cost) = Sweep::new(self, cell).best()?;
        if cost < whole {
            return Some((plane, bad));
        }
        // It may pay one cut later.
        let hopeful = cell.inside.len() >= FEW && cost < 4.0 * whole && bad < MOST_BAD;
        hopeful.then_some((plane, bad + 1))
    }
}
