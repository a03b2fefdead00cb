//! The light buffer [Haines 86] put at an eye: cells of directions, each with a list of what may
//! be seen there.
//!
//! Space and build as for the light buffer; a ray from the eye tests a few children, nearest
//! first. All other rays go through the hierarchy.

use nestray_core::aim::{Aims, Emitter};
use nestray_core::family::Family;
use nestray_core::ray::RayKind;
use nestray_core::technique::{Leaves, OutOfRange, Place, Technique, in_range};
use serde::{Deserialize, Serialize};

use crate::beams::Beams;
use crate::light_buffer::{self, Around};

/// The technique: an eye buffer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct EyeBuffer {
    /// Where rays come from; the cameras of the scene if there is nothing here.
    pub eyes: Vec<Emitter>,
    /// Cells along an edge of the cube around an eye, a power of two; 0 chooses by the number of
    /// children.
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

impl Default for EyeBuffer {
    fn default() -> Self {
        Self { eyes: Vec::new(), side: 0, most: 4, depth: 4, memory: 1024, max_leaf: 8 }
    }
}

impl Technique for EyeBuffer {
    const NAME: &'static str = "eye-buffer";
    const EFFORT: f64 = 4.0;
    type Index = Beams;

    fn build(&self, family: &dyn Family, leaves: &mut Leaves) -> Beams {
        let serves = |kind: RayKind| matches!(kind, RayKind::Camera | RayKind::Custom(_));
        let cells =
            Around { side: self.side, most: self.most, depth: self.depth, memory: self.memory };
        light_buffer::build(&self.eyes, &cells, self.max_leaf, serves, (family, leaves))
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
        in_range(self.eyes.iter().all(Emitter::is_sound), "eyes", "finite, boxes in order")?;
        let side = self.side == 0 || (self.side.is_power_of_two() && self.side <= 256);
        in_range(side, "side", "0 (chosen), or a power of two up to 256")?;
        in_range((1..=16).contains(&self.most), "most", "1 to 16")?;
        in_range(self.depth <= 8, "depth", "0 to 8")?;
        in_range((1..=1 << 20).contains(&self.memory), "memory", "1 to 1048576")?;
        in_range((1..=64).contains(&self.max_leaf), "max_leaf", "1 to 64")
    }

    fn aimed(self, aims: &Aims) -> Self {
        if self.eyes.is_empty() { Self { eyes: aims.eyes.clone(), ..self } } else { self }
    }

    fn objection(&self, place: &Place) -> Option<String> {
        (place.instances > 0).then(|| {
            "an eye buffer knows where eyes are in the world, and an instance has a space of its \
             own"
            .into()
        })
    }
}
