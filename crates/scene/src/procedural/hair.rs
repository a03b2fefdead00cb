//! A ball with curved hair: every strand a chain of thinning cones.

use glam::DVec3;
use nestray_shapes::any::AnyShape;
use nestray_shapes::cone::Cone;
use nestray_shapes::sphere::Sphere;

use super::look::{camera, outdoors, paint};
use super::mesh::across;
use super::random::Random;
use crate::geometry::Geometry;
use crate::scene::Scene;

/// Cones of a strand.
const PIECES: u32 = 5;

/// Cones and the ball.
pub(super) fn count(size: u32) -> u64 {
    u64::from(PIECES) * u64::from(size) + 1
}

pub(super) fn build(size: u32) -> Scene {
    let mut random = Random::new(3);
    let mut cones = Vec::with_capacity((PIECES * size) as usize);
    for _ in 0..size {
        strand(&mut random, &mut cones);
    }
    let mut scene = outdoors();
    let skin = scene.add_material(paint("skin", [0.25, 0.16, 0.1], 0.8));
    let hair = scene.add_material(paint("hair", [0.55, 0.33, 0.13], 0.35));
    let ball = Sphere { center: DVec3::ZERO.as_vec3a(), radius: 1.0 };
    scene.add(Geometry::shapes("ball", skin, vec![ball.into()]));
    scene.add(Geometry::shapes("hair", hair, cones));
    scene.cameras.push(camera("whole", DVec3::new(2.0, -4.2, 1.2), DVec3::ZERO, 36.0));
    scene
}

fn strand(random: &mut Random, cones: &mut Vec<AnyShape>) {
    let root = random.direction();
    let length = random.between(0.4, 0.7);
    let [side, _] = across(root);
    let mut dir = (root + random.in_cube() * 0.35).normalize();
    let mut place = root;
    for piece in 0..PIECES {
        let thick = |piece: u32| 0.004 * (1.0 - f64::from(piece) / f64::from(PIECES + 1));
        let next = place + dir * (length / f64::from(PIECES));
        let cone = Cone {
            base: place.as_vec3a(),
            base_radius: thick(piece) as f32,
            apex: next.as_vec3a(),
            apex_radius: thick(piece + 1) as f32,
        };
        cones.push(cone.into());
        place = next;
        // It hangs down, and curls a little.
        dir = (dir + DVec3::NEG_Z * 0.22 + side * random.between(-0.15, 0.35)).normalize();
    }
}
