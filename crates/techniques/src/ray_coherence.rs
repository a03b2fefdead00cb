//! Ray coherence [Ohta 87]: rays that leave an object, told apart by where they go, and for each
//! of its directions the list of what they may meet.
//!
//! The rays from a small thing to another form a narrow cone, so what they may meet in between is
//! known from where they start. Rays start from the leaves of a hierarchy of boxes: each leaf has
//! cells of directions around it, each with a list of parts of the hierarchy. Cells are made when
//! the first ray comes. Rays that leave nothing, as those of a camera, go through the hierarchy.
//!
//! Space and build as for the hierarchy, and what the cells that rays came to take; a ray looks for
//! the leaf it starts from and tests a few children.

use nestray_core::aabb::Aabb;
use nestray_core::family::{Family, boxes};
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::beams::{Beams, Limits, Origins};
use crate::bvh::Bvh;

/// The technique: ray coherence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RayCoherence {
    /// Cells along an edge of the cube around a leaf, a power of two; 8 to 32 in the literature.
    pub side: u32,
    /// Cells with longer lists are cut into sixteen.
    pub most: usize,
    /// How often.
    pub depth: u32,
    /// Most memory for lists, in MB. Where it is used up, rays go through the hierarchy.
    pub memory: u32,
    /// Most children in one leaf of the hierarchy.
    pub max_leaf: usize,
}

impl Default for RayCoherence {
    fn default() -> Self {
        Self { side: 8, most: 16, depth: 0, memory: 512, max_leaf: 8 }
    }
}

impl Technique for RayCoherence {
    const NAME: &'static str = "ray-coherence";
    const EFFORT: f64 = 1.5;
    type Index = Beams;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Beams {
        let tree = Bvh { max_leaf: self.max_leaf, ..Bvh::default() }.build(family, leaves);
        let bounds = boxes(family).into_iter().fold(Aabb::EMPTY, Aabb::join);
        let limits = Limits {
            first: 2 * self.side.ilog2(),
            depth: self.depth,
            most: self.most,
            idle: u32::MAX,
            memory: u64::from(self.memory) << 20,
        };
        let roots = 6 * leaves.count();
        Beams::new(tree, leaves, Box::new(Origins::new(bounds)), (roots, limits))
    }

    fn neighbours(&self) -> Vec<Self> {
        let near = [
            Self { side: self.side / 2, ..*self },
            Self { side: self.side * 2, ..*self },
            Self { depth: self.depth.saturating_sub(1), ..*self },
            Self { depth: self.depth + 1, ..*self },
        ];
        near.into_iter().filter(|next| next != self && next.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        let side = self.side.is_power_of_two() && self.side <= 256;
        in_range(side, "side", "a power of two up to 256")?;
        in_range((1..=16).contains(&self.most), "most", "1 to 16")?;
        in_range(self.depth <= 4, "depth", "0 to 4")?;
        in_range((1..=1 << 20).contains(&self.memory), "memory", "1 to 1048576")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")
    }
}
