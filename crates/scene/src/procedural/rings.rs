//! A pyramid of objects, each six pentagons linked to one another [Haines 87].

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::standard::{Eye, Fill, SKY, Standard, rotation};
use crate::scene::Scene;

const RADIUS: f64 = 0.07412;

/// Balls, cylinders and the wall.
pub(super) fn count(size: u32) -> u64 {
    let n = u64::from(size);
    10 * n * (n + 1) * (2 * n + 1) + 1
}

pub(super) fn build(size: u32) -> Scene {
    let spread = 1.0 / libm::sin(PI / 8.0);
    let eye = Eye::above([-1.0, -spread, 0.5], [-1.0, 1.0 - spread, 0.5], 1.0);
    let lights = [[3.0, -spread, 3.0], [-4.0, -spread, 1.0], [2.0, -spread, -4.0]];
    let mut scene = Standard::new(SKY, &eye, &lights);
    scene.fill("wall", &Fill::matte([1.0; 3], 1.0));
    let y = spread * f64::from(size + 1);
    // The picture's width there and one per cent.
    let half = 1.01 * (y + spread) * libm::tan(PI / 8.0);
    let corner = |x: f64, z: f64| DVec3::new(x * half - 1.0, y, z * half + 0.5);
    scene.polygon(&[corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)]);
    let pentagons = pentagons();
    for depth in 0..size {
        for i in 0..(depth + 1) * (depth + 1) {
            let place = |i: u32| f64::from(2 * i) - f64::from(depth);
            let (x, z) = (i % (depth + 1), i / (depth + 1));
            let at = DVec3::new(place(x), spread * f64::from(depth + 1), place(z));
            put(&mut scene, &pentagons, at);
        }
    }
    scene.finish()
}

fn put(scene: &mut Standard, pentagons: &[[DVec3; 5]; 6], at: DVec3) {
    const COLORS: [(&str, [f64; 3]); 6] = [
        ("red", [1.0, 0.0, 0.0]),
        ("green", [0.0, 1.0, 0.0]),
        ("blue", [0.0, 0.0, 1.0]),
        ("cyan", [0.0, 1.0, 1.0]),
        ("magenta", [1.0, 0.0, 1.0]),
        ("yellow", [1.0, 1.0, 0.0]),
    ];
    for (corners, (name, color)) in pentagons.iter().zip(COLORS) {
        scene.fill(name, &Fill::mirror(color, 0.5, 0.2));
        for (i, &corner) in corners.iter().enumerate() {
            scene.cylinder(at + corner, at + corners[(i + 4) % 5], RADIUS);
            scene.sphere(at + corner, RADIUS);
        }
    }
}

/// The corners of the pentagons, which join the middles of a dodecahedron's edges.
fn pentagons() -> [[DVec3; 5]; 6] {
    let first: [DVec3; 5] = std::array::from_fn(|i| {
        let angle = i as f64 * TAU / 5.0;
        DVec3::new(libm::cos(angle), libm::sin(angle), 0.0) / (1.0 + RADIUS)
    });
    let tilt = rotation(DVec3::X, 2.0 * libm::acos(libm::cos(PI / 3.0) / libm::sin(PI / 5.0)));
    std::array::from_fn(|i| {
        let turn = rotation(DVec3::Z, PI * (2.0 * i as f64 - 1.0) / 5.0);
        first.map(|corner| if i == 0 { corner } else { turn * (tilt * corner) })
    })
}
