//! The sphereflake: balls with nine smaller balls around each, on a square [Haines 87].

use glam::{DMat3, DVec3};

use super::standard::{Eye, Fill, SKY, Standard, rotation, turn};
use crate::scene::Scene;

/// Squares and balls at a size factor.
pub(super) fn count(size: u32) -> u64 {
    1 + (0..=size).map(|level| 9u64.pow(level)).sum::<u64>()
}

pub(super) fn build(size: u32) -> Scene {
    let eye = Eye::above([2.1, 1.3, 1.7], [0.0; 3], 0.01);
    let lights = [[4.0, 3.0, 2.0], [1.0, -4.0, 4.0], [-3.0, 1.0, 5.0]];
    let mut scene = Standard::new(SKY, &eye, &lights);
    scene.fill("floor", &Fill { ior: 1.0, ..Fill::matte([1.0, 0.75, 0.33], 0.8) });
    scene.floor(12.0, -0.5);
    scene.fill("balls", &Fill { ior: 1.0, ..Fill::mirror([1.0, 0.9, 0.7], 0.5, 0.5) });
    flake(size, DVec3::ZERO, 0.5, &mut |center, radius| scene.sphere(center, radius));
    scene.finish()
}

/// Calls `put` with every ball of a flake that grows along +z, the largest first.
pub(super) fn flake(depth: u32, center: DVec3, radius: f64, put: &mut impl FnMut(DVec3, f64)) {
    grow(depth, center, radius, DVec3::Z, &directions(), put);
}

fn grow(
    depth: u32,
    center: DVec3,
    radius: f64,
    dir: DVec3,
    around: &[DVec3; 9],
    put: &mut impl FnMut(DVec3, f64),
) {
    put(center, radius);
    if depth == 0 {
        return;
    }
    let turned = upright_to(dir);
    for &offset in around {
        let dir = turned * offset;
        grow(depth - 1, center + dir * (radius * 4.0 / 3.0), radius / 3.0, dir, around, put);
    }
}

/// The turn that takes +z to a unit vector.
fn upright_to(dir: DVec3) -> DMat3 {
    if dir.z >= 0.9999 {
        return DMat3::IDENTITY;
    }
    if dir.z <= -0.9999 {
        return turn(DVec3::Y, 0.0, -1.0);
    }
    let axis = DVec3::Z.cross(dir);
    let sine = axis.length();
    turn(axis / sine, sine, dir.z)
}

/// Where the nine balls sit on one that grows along +z.
fn directions() -> [DVec3; 9] {
    let axis = DVec3::new(1.0, -1.0, 0.0) / 2f64.sqrt();
    let lift = rotation(axis, libm::asin(2.0 / 6f64.sqrt()));
    let trio = [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 0.0, -1.0), DVec3::new(0.0, 1.0, -1.0)]
        .map(|dir| lift * (dir / 2f64.sqrt()));
    let third = |i: usize| rotation(DVec3::Z, (i / 3) as f64 * std::f64::consts::TAU / 3.0);
    std::array::from_fn(|i| third(i) * trio[i % 3])
}
