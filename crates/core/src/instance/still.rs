//! A place that never changes.

use glam::{Affine3A, Vec3A};

use super::{Motion, inverse};
use crate::aabb::Aabb;

/// Never moves.
#[derive(Clone, Copy, Debug)]
pub struct Still {
    world_from_object: Affine3A,
    object_from_world: Option<Affine3A>,
}

impl Still {
    /// A place that never changes.
    #[must_use]
    pub fn new(world_from_object: Affine3A) -> Self {
        Self { world_from_object, object_from_world: inverse(&world_from_object) }
    }
}

impl Motion for Still {
    const KIND: &'static str = "instance";
    const MOVES: bool = false;

    #[inline(always)]
    fn object_from_world(&self, _time: f32) -> Option<Affine3A> {
        self.object_from_world
    }

    fn world_from_object(&self, _time: f32) -> Affine3A {
        self.world_from_object
    }

    /// Only without shear: then a ray moved inside is no farther off, in proportion, than the ray
    /// itself, whichever way the object is stretched.
    fn direction_inside(&self, direction: Vec3A) -> Option<(Vec3A, f32)> {
        let [x, y, z] = {
            let matrix = self.world_from_object.matrix3;
            [matrix.x_axis, matrix.y_axis, matrix.z_axis]
        };
        let is_square = |a: Vec3A, b: Vec3A| a.dot(b).abs() <= 1e-6 * a.length() * b.length();
        let inside = Vec3A::new(x.dot(direction), y.dot(direction), z.dot(direction));
        let shift = direction.dot(self.world_from_object.translation);
        let tells = self.object_from_world.is_some()
            && is_square(x, y)
            && is_square(y, z)
            && is_square(z, x);
        tells.then_some((inside, shift))
    }

    fn sweep(&self, local: Aabb, _time: [f32; 2]) -> Aabb {
        match self.object_from_world {
            Some(_) => local.transformed(&self.world_from_object),
            None => Aabb::EMPTY,
        }
    }
}
