//! A jack with smaller jacks in its corners (Enzmann, in [Haines 87]).

use glam::{DAffine3, DMat3, DVec3};

use super::standard::{Eye, Fill, Standard, rotation};
use crate::scene::Scene;

/// Cylinders and balls.
pub(super) fn count(size: u32) -> u64 {
    9 * (0..size).map(|level| 8u64.pow(level)).sum::<u64>()
}

pub(super) fn build(size: u32) -> Scene {
    let eye = Eye {
        up: DVec3::Y,
        degrees: 25.0,
        resolution: 256,
        ..Eye::above([0.0, 0.0, -8.0], [0.0; 3], 0.001)
    };
    let mut scene = Standard::new([0.2, 0.05, 0.2], &eye, &[[-10.0, 3.0, -20.0]]);
    let pink = Fill { angle: 20.0, ior: 1.0, ..Fill::mirror([0.737, 0.561, 0.561], 0.7, 0.7) };
    scene.fill("jacks", &pink);
    let tilt =
        rotation(DVec3::X, (-30f64).to_radians()) * rotation(DVec3::Y, (-20f64).to_radians());
    put(&mut scene, DAffine3::from_mat3(tilt), 1.0, size);
    scene.finish()
}

fn put(scene: &mut Standard, place: DAffine3, scale: f64, depth: u32) {
    let end = |dir: DVec3| place.transform_point3(dir * 0.75);
    for axis in DVec3::AXES {
        scene.cylinder(end(-axis), end(axis), 0.075 * scale);
    }
    for dir in DVec3::AXES.into_iter().chain(DVec3::AXES.map(|axis| -axis)) {
        scene.sphere(end(dir), 0.15 * scale);
    }
    if depth <= 1 {
        return;
    }
    let half = |bit: u32| if bit == 0 { -0.5 } else { 0.5 };
    for i in 0..8 {
        let at = DVec3::new(half(i & 4), half(i & 2), half(i & 1));
        let smaller = DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(0.5)), at);
        put(scene, place * smaller, scale / 2.0, depth - 1);
    }
}
