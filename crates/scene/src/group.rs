//! What stands where: groups of geometries, placed in one another.

use glam::Affine3A;
use nestray_core::aabb::Aabb;
use nestray_core::instance::{Motion as _, Still};
use nestray_core::moving::Keys;

use crate::scene::Scene;

/// Geometries that stand together, and groups placed among them. A group placed in many
/// places is stored once.
#[derive(Clone, Debug, Default)]
pub struct Group {
    /// What it is called; may be empty.
    pub name: String,
    /// Geometries that stand in it as they are.
    pub geometries: Vec<usize>,
    /// Other groups, moved.
    pub places: Vec<Place>,
}

/// A group, somewhere.
#[derive(Clone, Debug)]
pub struct Place {
    /// What it is called; may be empty.
    pub name: String,
    /// Which group.
    pub group: usize,
    /// Where.
    pub motion: Motion,
}

/// Where a place is, while the shutter is open.
#[derive(Clone, Debug)]
pub enum Motion {
    /// Always here: `world_from_object`.
    Still(Affine3A),
    /// Moving while the shutter is open.
    Keys(Keys),
    /// Wherever a node of the [`Animation`](crate::animation::Animation) is.
    Node(usize),
}

impl Scene {
    /// A box around all places that `local` comes to.
    #[must_use]
    pub fn sweep(&self, motion: &Motion, local: Aabb) -> Aabb {
        match motion {
            Motion::Still(place) => Still::new(*place).sweep(local, [0.0, 1.0]),
            Motion::Keys(keys) => keys.sweep(local, [0.0, 1.0]),
            Motion::Node(node) => {
                Still::new(self.animation.world_from_node(*node, 0.0)).sweep(local, [0.0, 1.0])
            }
        }
    }
}
