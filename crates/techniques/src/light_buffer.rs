//! The light buffer [Haines 86]: around each light, cells of directions, each with a list of what
//! may stand in the way of its light.
//!
//! Lists hold parts of a hierarchy of boxes, and end where one child shades all that is behind it.
//! A crowded cell is cut into sixteen, again and again; if that does not thin it out, its list
//! holds whole subtrees. Cells are made when the first shadow ray comes. All other rays go through
//! the hierarchy.
//!
//! Space and build as for the hierarchy, and what the cells that rays came to take; a shadow ray
//! tests a few children.

use nestray_core::aabb::Aabb;
use nestray_core::aim::{Aims, Emitter};
use nestray_core::family::{Family, boxes};
use nestray_core::ray::RayKind;
use nestray_core::technique::{Leaves, OutOfRange, Place, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::beams::{Beams, Emitters, Limits};
use crate::bvh::Bvh;

/// The technique: a light buffer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct LightBuffer {
    /// The lights; those of the scene if there are none here.
    pub lights: Vec<Emitter>,
    /// Cells along an edge of the cube around a light, a power of two; 0 chooses by the number of
    /// children.
    pub side: u32,
    /// Cells with longer lists are cut into sixteen.
    pub most: usize,
    /// How often.
    pub depth: u32,
    /// Most memory for lists, in MB. Where it is used up, shadow rays go through the hierarchy.
    pub memory: u32,
    /// Most children in one leaf of the hierarchy.
    pub max_leaf: usize,
}

impl Default for LightBuffer {
    fn default() -> Self {
        Self { lights: Vec::new(), side: 0, most: 4, depth: 4, memory: 1024, max_leaf: 8 }
    }
}

impl Technique for LightBuffer {
    const NAME: &'static str = "light-buffer";
    const EFFORT: f64 = 4.0;
    type Index = Beams;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Beams {
        let serves = |kind: RayKind| matches!(kind, RayKind::Shadow { .. } | RayKind::Custom(_));
        let cells =
            Around { side: self.side, most: self.most, depth: self.depth, memory: self.memory };
        build(&self.lights, &cells, self.max_leaf, serves, (family, leaves))
    }

    fn neighbours(&self) -> Vec<Self> {
        let near = [
            Self { most: self.most / 2, ..self.clone() },
            Self { most: self.most * 2, ..self.clone() },
            Self { depth: self.depth.saturating_sub(1), ..self.clone() },
            Self { depth: self.depth + 1, ..self.clone() },
        ];
        near.into_iter().filter(|next| next != self && next.check().is_ok()).collect()
    }

    fn check(&self) -> Result<(), OutOfRange> {
        in_range(self.lights.iter().all(Emitter::is_sound), "lights", "finite, boxes in order")?;
        let side = self.side == 0 || (self.side.is_power_of_two() && self.side <= 256);
        in_range(side, "side", "0 (chosen), or a power of two up to 256")?;
        in_range((1..=16).contains(&self.most), "most", "1 to 16")?;
        in_range(self.depth <= 8, "depth", "0 to 8")?;
        in_range((1..=1 << 20).contains(&self.memory), "memory", "1 to 1048576")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")
    }

    fn aimed(self, aims: &Aims) -> Self {
        if self.lights.is_empty() { Self { lights: aims.lights.clone(), ..self } } else { self }
    }

    fn objection(&self, place: &Place) -> Option<String> {
        (place.instances > 0).then(|| {
            "a light buffer knows where lights are in the world, and an instance has a space of \
             its own"
                .into()
        })
    }
}

/// Cells around an emitter, as settings say.
pub(crate) struct Around {
    pub(crate) side: u32,
    pub(crate) most: usize,
    pub(crate) depth: u32,
    pub(crate) memory: u32,
}

impl Around {
    /// Where so many leaves are to be told apart.
    fn limits(&self, leaves: usize) -> Limits {
        let side = match self.side {
            // About one cell for each leaf that is seen.
            0 => ((leaves as f32 / 2.0).sqrt().max(1.0) as u32).next_power_of_two().min(64),
            side => side,
        };
        let first = 2 * side.ilog2();
        Limits {
            first,
            depth: self.depth.min((DEEPEST - first) / 4),
            most: self.most,
            idle: u32::MAX,
            memory: u64::from(self.memory) << 20,
        }
    }
}

/// Most halves on the way to a cell: finer ones are no wider than rounding errors.
const DEEPEST: u32 = 36;

/// A hierarchy of boxes with lists for rays that pass `emitters`.
pub(crate) fn build(
    emitters: &[Emitter],
    around: &Around,
    max_leaf: usize,
    serves: fn(RayKind) -> bool,
    (family, leaves): (&dyn Family, &mut Leaves),
) -> Beams {
    let tree = Bvh { max_leaf, ..Bvh::default() }.build(family, leaves);
    let bounds = boxes(family).into_iter().fold(Aabb::EMPTY, Aabb::join);
    let guide = Emitters::new(emitters, bounds, serves);
    let cells = (guide.roots(), around.limits(leaves.count()));
    Beams::new(tree, leaves, Box::new(guide), cells)
}
