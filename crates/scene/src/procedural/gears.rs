//! Meshing gears, some of glass, with faces of 144 corners [Haines 87].

use std::f64::consts::PI;

use glam::DVec3;

use super::standard::{Eye, Fill, SKY, Standard, rotation};
use crate::scene::Scene;

const TEETH: usize = 36;

/// The part of a gear's radius between the middles of its teeth and those of its gaps.
const EDGE: f64 = 1.0 - 0.9;

/// Faces, sides of teeth, and the ground.
pub(super) fn count(size: u32) -> u64 {
    u64::from(size).pow(3) * (2 + 4 * TEETH as u64) + 1
}

pub(super) fn build(size: u32) -> Scene {
    let lights = [
        [2.0, 4.0, 4.0],
        [-2.0, 4.0, 3.0],
        [2.0, -2.5, 2.5],
        [-1.0, -4.0, 2.0],
        [-1.111, -2.121, 2.626],
    ];
    let mut scene = Standard::new(SKY, &Eye::above([-1.1, -2.1, 2.6], [0.0; 3], 1.0), &lights);
    scene.fill("ground", &Fill::mirror([1.0, 0.85, 0.7], 0.3, 0.6));
    scene.floor(2.0, 0.0);
    let many = f64::from(size);
    let radius = 1.0 / (many - (many - 1.0) * EDGE / 2.0);
    let pitch = radius * (2.0 - EDGE);
    let gear = Gear {
        outer: 0.995 * radius,
        inner: (1.0 - EDGE) * radius,
        thickness: 0.1f64.min(1.0 / (2.0 * many)),
    };
    for i in 0..size.pow(3) {
        let (x, y, z) = (i % size, i / size % size, i / (size * size));
        let color = color(x, y, z);
        if (x * 4 + y * 2 + z) % 5 == 0 {
            scene.fill("glass", &Fill { t: 0.8, ior: 1.1, ..Fill::matte(color, 0.2) });
        } else {
            scene.fill("gear", &Fill::matte(color, 1.0));
        }
        let first = radius - 1.0;
        let center = DVec3::new(
            first + f64::from(x) * pitch,
            first + f64::from(y) * pitch,
            1.0 - f64::from(z) / many,
        );
        let angle = PI * f64::from((x + y + z) % 2) / TEETH as f64;
        gear.put(&mut scene, center, angle);
    }
    scene.finish()
}

fn color(x: u32, y: u32, z: u32) -> [f64; 3] {
    let channel = |sum: u32, part: f64| {
        let x = f64::from(sum) * part / 7.0;
        0.01 + (x - x.floor())
    };
    let color = [
        channel(x * 3 + y * 2 + z + 1, 5.0),
        channel(y * 3 + z * 2 + x + 1, 3.0),
        channel(z * 3 + x * 2 + y + 1, 2.0),
    ];
    let brightest = color.into_iter().fold(0.0, f64::max);
    color.map(|x| x / brightest)
}

struct Gear {
    outer: f64,
    inner: f64,
    thickness: f64,
}

impl Gear {
    /// The face above, the sides of the teeth, the face below.
    fn put(&self, scene: &mut Standard, center: DVec3, angle: f64) {
        let down = DVec3::new(0.0, 0.0, -self.thickness);
        let top = self.face(center, angle, 1.0);
        scene.polygon(&top);
        for (i, &corner) in top.iter().enumerate() {
            let next = top[(i + 1) % top.len()];
            scene.polygon(&[corner, corner + down, next + down, next]);
        }
        scene.polygon(&self.face(center + down, angle, -1.0));
    }

    /// The corners of a face, tooth by tooth; counter-clockwise from above if `way` is 1.
    fn face(&self, center: DVec3, angle: f64, way: f64) -> Vec<DVec3> {
        let step = way * 2.0 * PI / TEETH as f64;
        let corner = |i: usize| {
            let tooth = angle + step * (i / 4) as f64;
            let (radius, part) = match i % 4 {
                0 => (self.outer, -0.19),
                1 => (self.outer, 0.19),
                2 => (self.inner, 0.3),
                _ => (self.inner, 0.7),
            };
            center + rotation(DVec3::Z, tooth + part * step) * DVec3::new(radius, 0.0, 0.0)
        };
        (0..4 * TEETH).map(corner).collect()
    }
}
