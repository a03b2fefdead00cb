//! A ripple that dies down outwards, as a height field of triangles (Enzmann, in [Haines 87]).

use glam::DVec3;

use super::standard::{Eye, Fill, SKY, Standard};
use crate::scene::Scene;

/// Triangles.
pub(super) fn count(size: u32) -> u64 {
    let cells = u64::from(samples(size)) - 1;
    2 * cells * cells
}

/// Samples along a side.
fn samples(size: u32) -> u32 {
    16 << size
}

pub(super) fn build(size: u32) -> Scene {
    let eye = Eye { degrees: 40.0, ..Eye::above([0.0, 5.0, -8.0], [0.0; 3], 0.01) };
    let mut scene = Standard::new(SKY, &eye, &[[10.0, 10.0, -10.0]]);
    let red = Fill { angle: 40.0, ior: 1.0, ..Fill::matte([1.0, 0.1, 0.1], 0.8) };
    scene.fill("sombrero", &red);
    let many = samples(size);
    // The function is sampled as if there were one step more than there is room for.
    let height = |i: u32, j: u32| {
        let [x, z] = [i, j].map(|i| -4.0 + 8.0 * f64::from(i) / f64::from(many));
        let from_middle = (x * x + z * z).sqrt();
        libm::cos(std::f64::consts::TAU * from_middle) * libm::exp(-from_middle) - 3.0
    };
    let corner = |i: u32, j: u32| {
        let [x, z] = [i, j].map(|i| -4.0 + 8.0 * f64::from(i) / f64::from(many - 1));
        DVec3::new(x, height(i, j), z)
    };
    for cell in 0..(many - 1) * (many - 1) {
        let (i, j) = (cell % (many - 1), cell / (many - 1));
        let (near, far) = (corner(i, j), corner(i + 1, j + 1));
        scene.polygon(&[near, far, corner(i + 1, j)]);
        scene.polygon(&[near, corner(i, j + 1), far]);
    }
    scene.finish()
}
