//! Sierpiński's tetrahedron [Haines 87].

use glam::DVec3;

use super::standard::{Eye, Fill, SKY, Standard};
use crate::scene::Scene;

/// Triangles.
pub(super) fn count(size: u32) -> u64 {
    4u64.pow(size)
}

pub(super) fn build(size: u32) -> Scene {
    let eye = Eye {
        up: DVec3::new(-0.816_497, -0.816_497, 0.816_497),
        ..Eye::above([1.022_846, -3.177_154, -2.174_512], [-0.004_103, -0.004_103, 0.216_539], 1.0)
    };
    let mut scene = Standard::new(SKY, &eye, &[[2.0, -18.0, -5.0]]);
    scene.fill("tetrahedra", &Fill::matte([1.0, 0.2, 0.2], 1.0));
    put(&mut scene, DVec3::ZERO, 1.0, size);
    scene.finish()
}

fn put(scene: &mut Standard, center: DVec3, half: f64, depth: u32) {
    /// Every other corner of a cube.
    const CORNERS: [[f64; 3]; 4] =
        [[-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0], [1.0, 1.0, 1.0]];
    let corners = CORNERS.map(DVec3::from_array);
    if depth <= 1 {
        for face in [[0, 1, 2], [3, 2, 1], [2, 3, 0], [1, 0, 3]] {
            scene.polygon(&face.map(|i| center + corners[i] * half));
        }
        return;
    }
    for corner in corners {
        put(scene, center + corner * (half / 2.0), half / 2.0, depth - 1);
    }
}
