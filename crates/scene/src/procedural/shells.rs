//! A sea shell of balls that overlap without end [Pickover 89], in [Haines 87].

use std::f64::consts::PI;

use glam::DVec3;

use super::standard::{Eye, Fill, SKY, Standard};
use crate::scene::Scene;

/// Balls.
pub(super) fn count(size: u32) -> u64 {
    (180 << size) + 1
}

pub(super) fn build(size: u32) -> Scene {
    let eye = Eye::above([-6.0, -60.0, 35.0], [0.0, 8.0, -15.0], 0.5);
    let mut scene = Standard::new(SKY, &eye, &[[-100.0, -100.0, 100.0]]);
    let shell = Fill { angle: 10.0, ior: 1.0, ..Fill::mirror([1.0, 0.8, 0.4], 0.8, 0.2) };
    scene.fill("shell", &shell);
    let steps = 180i64 << size;
    for i in -steps * 2 / 3..=steps / 3 {
        let angle = 18.0 * PI * i as f64 / steps as f64;
        let radius = libm::exp(0.15 * angle);
        let unit = DVec3::new(libm::sin(angle), libm::cos(angle), -2.0);
        scene.sphere(unit * radius, radius);
    }
    scene.finish()
}
