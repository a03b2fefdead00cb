//! Long thin things, none along an axis: boxes around them are nearly empty.

use glam::DVec3;
use nestray_shapes::any::AnyShape;
use nestray_shapes::cylinder::Cylinder;

use super::look::{camera, outdoors, paint};
use super::mesh::{Mesh, across};
use super::random::Random;
use crate::geometry::Geometry;
use crate::scene::Scene;

/// Triangles and cylinders.
pub(super) fn count(size: u32) -> u64 {
    u64::from(size)
}

pub(super) fn build(size: u32) -> Scene {
    let mut random = Random::new(2);
    let thin = 0.3 / f64::from(size).sqrt();
    let (mut mesh, mut cylinders) = (Mesh::default(), Vec::<AnyShape>::new());
    for i in 0..size {
        let (from, to) = ends(&mut random);
        if i % 4 == 3 {
            let (base, top) = (from.as_vec3a(), to.as_vec3a());
            cylinders.push(Cylinder { base, top, radius: thin as f32 }.into());
        } else {
            let [side, _] = across((to - from).normalize());
            mesh.triangle([from - side * thin, from + side * thin, to]);
        }
    }
    let mut scene = outdoors();
    let red = scene.add_material(paint("red", [0.7, 0.12, 0.08], 0.4));
    let steel = scene.add_material(paint("steel", [0.45, 0.47, 0.5], 0.4));
    scene.add(Geometry::mesh("triangles", red, mesh.finish()));
    if !cylinders.is_empty() {
        scene.add(Geometry::shapes("cylinders", steel, cylinders));
    }
    scene.cameras.push(camera("whole", DVec3::new(3.2, -4.4, 2.6), DVec3::ZERO, 32.0));
    scene
}

/// The ends of a needle about along a diagonal of the cube.
fn ends(random: &mut Random) -> (DVec3, DVec3) {
    let middle = random.in_cube();
    let sign = |bit: u64| if bit == 0 { 1.0 } else { -1.0 };
    let bits = random.bits();
    let diagonal = DVec3::new(sign(bits & 1), sign(bits & 2), sign(bits & 4));
    let dir = (diagonal + random.in_cube() * 0.3).normalize();
    let half = dir * random.between(0.1, 0.4);
    (middle - half, middle + half)
}
