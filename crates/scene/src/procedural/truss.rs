//! Square bars between the points of a cubic lattice, turned so that none is along an axis.

use glam::{DAffine3, DMat3, DVec3};

use super::look::{camera, outdoors, paint};
use super::mesh::Mesh;
use super::standard::rotation;
use crate::geometry::Geometry;
use crate::scene::Scene;

/// Triangles.
pub(super) fn count(size: u32) -> u64 {
    let n = u64::from(size);
    12 * 3 * n * (n + 1).pow(2)
}

pub(super) fn build(size: u32) -> Scene {
    let step = 2.0 / f64::from(size);
    let turned = rotation(DVec3::new(1.0, 1.0, 0.0).normalize(), 0.6) * rotation(DVec3::Z, 0.4);
    let mut mesh = Mesh::default();
    let many = size + 1;
    for i in 0..many.pow(3) {
        let cell = [i % many, i / many % many, i / (many * many)];
        let at = DVec3::from_array(cell.map(|x| f64::from(x) * step - 1.0));
        for (dir, i) in DVec3::AXES.into_iter().zip(cell) {
            if i < size {
                let scale = DVec3::splat(0.08) + dir * 0.92;
                let bar = DMat3::from_diagonal(scale * step);
                let middle = turned * (at + dir * (step / 2.0));
                mesh.cuboid(DAffine3::from_mat3_translation(turned * bar, middle));
            }
        }
    }
    let mut scene = outdoors();
    let steel = scene.add_material(paint("steel", [0.5, 0.2, 0.12], 0.5));
    scene.add(Geometry::mesh("truss", steel, mesh.finish()));
    scene.cameras.push(camera("whole", DVec3::new(2.6, -3.6, 1.7), DVec3::ZERO, 40.0));
    scene
}
