//! A tree of cones, tiny on a huge field [Haines 87], after [Aono 84].

use glam::{DAffine3, DMat3, DVec3};

use super::standard::{Eye, Fill, SKY, Standard, rotation};
use crate::scene::Scene;

/// Cones, balls and the field.
pub(super) fn count(size: u32) -> u64 {
    2 * ((2 << size) - 1) + 1
}

pub(super) fn build(size: u32) -> Scene {
    let lights = [
        [-5.0, 5.0, 50.0],
        [30.0, -30.0, 30.0],
        [-40.0, -30.0, 20.0],
        [10.0, 30.0, 40.0],
        [-30.0, 40.0, 10.0],
        [50.0, 25.0, 20.0],
        [-10.0, -60.0, 30.0],
    ];
    let eye = Eye::above([4.5, 0.4, 2.0], [0.0, 0.0, 1.5], 1.0);
    let mut scene = Standard::new(SKY, &eye, &lights);
    scene.fill("field", &Fill::matte([0.2, 0.7, 0.2], 1.0));
    scene.floor(50.0, 0.0);
    scene.fill("tree", &Fill::matte([0.55, 0.4, 0.2], 1.0));
    let branches = [[40.0f64, 90.0, 0.65], [25.0, 230.0, 0.70]].map(|[lean, around, scale]| {
        let turned =
            rotation(DVec3::Z, around.to_radians()) * rotation(DVec3::X, lean.to_radians());
        let scaled = DMat3::from_diagonal(DVec3::splat(scale)) * turned;
        DAffine3::from_mat3_translation(scaled, DVec3::Z)
    });
    put(&mut scene, &branches, size, DAffine3::IDENTITY, 1.0);
    scene.finish()
}

/// A branch and those that grow from its end.
fn put(scene: &mut Standard, branches: &[DAffine3; 2], depth: u32, place: DAffine3, thick: f64) {
    let (base, end) = (place.translation, place.transform_point3(DVec3::Z));
    let thinner = thick * TAPER;
    scene.cone((base, RADIUS * thick), (end, RADIUS * thinner));
    scene.sphere(end, RADIUS * thinner);
    if depth > 0 {
        for &branch in branches {
            put(scene, branches, depth - 1, place * branch, thinner);
        }
    }
}

/// Of the stem, at the ground.
const RADIUS: f64 = 0.15;

/// How much thinner a branch is at its end.
const TAPER: f64 = 0.67;
