//! Mirror balls in a cubic lattice, with bars between neighbours (Costa, in [Haines 87]).

use glam::DVec3;

use super::standard::{Eye, Fill, SKY, Standard};
use crate::scene::Scene;

/// Balls and bars.
pub(super) fn count(size: u32) -> u64 {
    let n = u64::from(size);
    (n + 1).pow(3) + 3 * n * (n + 1).pow(2)
}

pub(super) fn build(size: u32) -> Scene {
    const BARS: [(&str, DVec3, [f64; 3]); 3] = [
        ("red", DVec3::X, [0.9, 0.1, 0.1]),
        ("green", DVec3::Y, [0.1, 0.9, 0.1]),
        ("blue", DVec3::Z, [0.1, 0.1, 0.9]),
    ];
    let step = 1.0 / f64::from(size);
    let (ball, bar) = (step / 4.0, step / 16.0);
    // A little less than up to where a bar leaves its ball.
    let short = ball * (1.0 - (bar / ball).sqrt()) * 0.99;
    let mut scene = start(size);
    let many = size + 1;
    for i in 0..many.pow(3) {
        let cell = [i / (many * many), i / many % many, i % many];
        let at = DVec3::from_array(cell.map(|x| f64::from(x) / f64::from(size)));
        scene.fill("balls", &Fill::mirror([0.9; 3], 0.5, 0.5));
        scene.sphere(at, ball);
        for (axis, (name, dir, color)) in BARS.into_iter().enumerate() {
            if cell[axis] < size {
                scene.fill(name, &Fill::matte(color, 0.99));
                scene.cylinder(at + dir * short, at + dir * (step - short), bar);
            }
        }
    }
    scene.finish()
}

fn start(size: u32) -> Standard {
    let x = (f64::from(size / 2) + 0.5) / f64::from(size);
    let down = 0.5 / f64::from(size);
    let eye = Eye {
        up: DVec3::new(0.2, 1.0, 0.0),
        degrees: 60.0,
        ..Eye::above([x, 1.0, 1.0 - down], [x, -1.0, -1.0 - down], 0.0)
    };
    let lights = [
        [2.0, 0.5, 0.5],
        [-1.0, 0.5, 0.5],
        [0.5, 2.0, 0.5],
        [0.5, -1.0, 0.5],
        [0.5, 0.5, 2.0],
        [0.5, 0.5, -1.0],
    ];
    Standard::new(SKY, &eye, &lights)
}
