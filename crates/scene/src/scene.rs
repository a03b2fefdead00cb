//! The scene as a whole.

use nestray_core::aabb::Aabb;

use crate::animation::Animation;
use crate::camera::Camera;
use crate::geometry::Geometry;
use crate::group::{Group, Motion, Place};
use crate::light::{Background, Light};
use crate::material::Material;
use crate::texture::Texture;

/// Everything a picture is made of. Parts name each other by index; a reader that hands
/// out a scene has checked that they are in range.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Geometries, in file order; a hit names one of them.
    pub geometries: Vec<Geometry>,
    /// Sets of geometries that stand together; the last resort of instancing.
    pub groups: Vec<Group>,
    /// The group that is the world.
    pub root: usize,
    /// Materials.
    pub materials: Vec<Material>,
    /// Textures.
    pub textures: Vec<Texture>,
    /// Lights without a surface; glowing surfaces are found by their materials.
    pub lights: Vec<Light>,
    /// Cameras; the first is used unless another is asked for.
    pub cameras: Vec<Camera>,
    /// What rays see that hit nothing.
    pub background: Background,
    /// Light that arrives from everywhere, per colour channel, in Whitted's model.
    pub ambient: [f32; 3],
    /// How nodes move over the frames of a film.
    pub animation: Animation,
}

impl Scene {
    /// A world with nothing in it.
    #[must_use]
    pub fn new() -> Self {
        Self { groups: vec![Group::default()], ..Self::default() }
    }

    /// Adds a geometry that stands in the world as it is; returns its number.
    pub fn add(&mut self, geometry: Geometry) -> usize {
        let number = self.add_apart(geometry);
        self.groups[self.root].geometries.push(number);
        number
    }

    /// Adds a geometry that stands nowhere yet; returns its number.
    pub fn add_apart(&mut self, geometry: Geometry) -> usize {
        self.geometries.push(geometry);
        self.geometries.len() - 1
    }

    /// Adds a group that stands nowhere yet; returns its number.
    pub fn add_group(&mut self, group: Group) -> usize {
        self.groups.push(group);
        self.groups.len() - 1
    }

    /// Puts a group somewhere in the world.
    pub fn place(&mut self, group: usize, motion: Motion) {
        self.groups[self.root].places.push(Place { name: String::new(), group, motion });
    }

    /// Adds a material; returns its number.
    pub fn add_material(&mut self, material: Material) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// A box around everything bounded, over the whole shutter.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        let mut known = vec![None; self.groups.len()];
        self.group_bounds(self.root, &mut known)
    }

    fn group_bounds(&self, group: usize, known: &mut Vec<Option<Aabb>>) -> Aabb {
        if let Some(bounds) = known[group] {
            return bounds;
        }
        // Also what a cycle finds: `check` refuses those.
        known[group] = Some(Aabb::EMPTY);
        let mut bounds = Aabb::EMPTY;
        for &geometry in &self.groups[group].geometries {
            bounds = bounds.join(self.geometries[geometry].bounds());
        }
        for place in &self.groups[group].places {
            let inside = self.group_bounds(place.group, known);
            let moved = self.sweep(&place.motion, inside);
            bounds = if moved.is_empty() { bounds } else { bounds.join(moved) };
        }
        known[group] = Some(bounds);
        bounds
    }

    /// How many primitives there are, every instance counted; more than `u64` counts as
    /// that.
    #[must_use]
    pub fn primitives(&self) -> u64 {
        let mut known = vec![None; self.groups.len()];
        self.group_primitives(self.root, &mut known)
    }

    fn group_primitives(&self, group: usize, known: &mut Vec<Option<u64>>) -> u64 {
        if let Some(count) = known[group] {
            return count;
        }
        known[group] = Some(0);
        let group_of = &self.groups[group];
        let own = group_of.geometries.iter().map(|&g| u64::from(self.geometries[g].primitives()));
        let mut count: u64 = own.sum();
        for place in &group_of.places {
            count = count.saturating_add(self.group_primitives(place.group, known));
        }
        known[group] = Some(count);
        count
    }
}
