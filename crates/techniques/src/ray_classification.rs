//! Ray classification [Arvo 87]: rays told apart by where they start and where they go, and for
//! each class the list of what its rays may meet.
//!
//! A ray is a point in five dimensions. Their space is cut in two again and again where rays come,
//! along the number by which the rays of a class are farthest apart; the list of a class holds
//! parts of a hierarchy of boxes, sorted along the axis that its rays run along, and ends where one
//! child hides all that is behind it. Nothing is cut before the first ray comes, and instances that
//! share an aggregate share its classes.
//!
//! Space and build as for the hierarchy, and what the classes that rays came to take; a ray takes
//! as many steps as its class has cuts around it, and tests a few children.

use nestray_core::aabb::Aabb;
use nestray_core::family::{Family, boxes};
use nestray_core::technique::{Leaves, OutOfRange, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::beams::{Beams, Classes, Limits};
use crate::bvh::Bvh;

/// The technique: ray classification.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RayClassification {
    /// Classes with longer lists are cut in two four times.
    pub most: usize,
    /// Most cuts around a class.
    pub depth: u32,
    /// Most memory for lists, in MB. Where it is used up, rays go through the hierarchy.
    pub memory: u32,
    /// Most children in one leaf of the hierarchy.
    pub max_leaf: usize,
}

impl Default for RayClassification {
    fn default() -> Self {
        Self { most: 8, depth: 24, memory: 512, max_leaf: 8 }
    }
}

/// So many times all rays are cut in two at once.
const FIRST: u32 = 12;

impl Technique for RayClassification {
    const NAME: &'static str = "ray-classification";
    const EFFORT: f64 = 8.0;
    type Index = Beams;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Beams {
        let tree = Bvh { max_leaf: self.max_leaf, ..Bvh::default() }.build(family, leaves);
        let bounds = boxes(family).into_iter().fold(Aabb::EMPTY, Aabb::join);
        let first = self.depth.min(FIRST);
        let limits = Limits {
            first,
            depth: (self.depth - first) / 4,
            most: self.most,
            idle: 3,
            memory: u64::from(self.memory) << 20,
        };
        Beams::new(tree, leaves, Box::new(Classes::new(bounds)), (Classes::ROOTS, limits))
    }

    fn neighbours(&self) -> Vec<Self> {
        let near = [
            Self { most: self.most / 2, ..*self },
            Self { most: self.most * 2, ..*self },
            Self { depth: self.depth.saturating_sub(4), ..*self },
            Self { depth: self.depth + 4, ..*self },
        ];
        near.into_iter().filter(|next| next != self && next.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range((1..=16).contains(&self.most), "most", "1 to 16")?;
        in_range(self.depth <= 60, "depth", "0 to 60")?;
        in_range((1..=1 << 20).contains(&self.memory), "memory", "1 to 1048576")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")
    }
}
