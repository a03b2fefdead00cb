//! Small triangles anywhere in a cube: nothing to cling to, but nothing uneven either.

use glam::DVec3;

use super::look::{camera, matte, outdoors};
use super::mesh::Mesh;
use super::random::Random;
use crate::geometry::Geometry;
use crate::scene::Scene;

/// Triangles.
pub(super) fn count(size: u32) -> u64 {
    u64::from(size)
}

pub(super) fn build(size: u32) -> Scene {
    let mut random = Random::new(1);
    let mut mesh = Mesh::default();
    // About two triangles in the way of a ray through the middle, for any number of them.
    let reach = 4.0 / f64::from(size).sqrt();
    for _ in 0..size {
        let middle = random.in_cube();
        mesh.triangle(std::array::from_fn(|_| middle + random.in_cube() * reach));
    }
    let mut scene = outdoors();
    let material = scene.add_material(matte("paper", [0.75, 0.6, 0.45]));
    scene.add(Geometry::mesh("triangles", material, mesh.finish()));
    scene.cameras.push(camera("whole", DVec3::new(3.2, -4.4, 2.6), DVec3::ZERO, 30.0));
    scene
}
