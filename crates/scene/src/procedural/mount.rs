//! A fractal mountain and four balls of glass [Haines 87], after [Fournier 82].

use glam::DVec3;

use super::standard::{Eye, Fill, SKY, Standard, rotation};
use crate::scene::Scene;

/// Triangles and balls.
pub(super) fn count(size: u32) -> u64 {
    2 * 4u64.pow(size) + 4
}

pub(super) fn build(size: u32) -> Scene {
    let eye = Eye::above([-1.6, 1.6, 1.7], [0.0; 3], 0.01);
    let mut scene = Standard::new(SKY, &eye, &[[-100.0, -100.0, 100.0]]);
    let glass = Fill { angle: 6.7, t: 0.9, ior: 1.5, ..Fill::mirror([1.0; 3], 0.1, 0.1) };
    scene.fill("glass", &glass);
    pyramid(&mut scene, DVec3::new(-0.8, 0.8, 1.0), 0.17);
    scene.fill("mountain", &Fill::matte([0.5, 0.45, 0.35], 1.0));
    let ratio = 2.0 / libm::exp(libm::log(2.0) / (DIMENSION - 1.0));
    let roughness = (ratio * ratio - 1.0).sqrt();
    let mut mountain = Mountain { scene, size, roughness };
    mountain.grow(1 << size, [0, 0], [0.0; 4]);
    mountain.scene.finish()
}

/// The fractal dimension: between 2, a plane, and 3.
const DIMENSION: f64 = 2.2;

/// The root of two as the published program has it.
#[expect(clippy::approx_constant, reason = "the published mountain is made with these digits")]
const ROOT_2: f64 = 1.414_213_6;

/// Another number gives another mountain.
const SEED: u32 = 21;

/// Balls that touch one another.
fn pyramid(scene: &mut Standard, center: DVec3, radius: f64) {
    let top = DVec3::new(0.0, 0.0, radius * (3.0f64 / 2.0).sqrt());
    scene.sphere(center + top, radius);
    let axis = DVec3::new(1.0, 1.0, 0.0).normalize();
    let side = rotation(axis, libm::acos(-1.0 / 3.0)) * top;
    for i in 0..3 {
        let angle = f64::from(i) * 2.0 * std::f64::consts::PI / 3.0;
        scene.sphere(center + rotation(DVec3::Z, angle) * side, radius);
    }
}

struct Mountain {
    scene: Standard,
    size: u32,
    roughness: f64,
}

impl Mountain {
    /// A square of the mountain, `width` steps wide, by the heights of its corners: lower
    /// left, lower right, upper right, upper left.
    fn grow(&mut self, width: u32, [x, y]: [u32; 2], z: [f64; 4]) {
        if width == 1 {
            return self.put([x, y], z);
        }
        let half = width / 2;
        let rise = f64::from(half) * 2.0 / f64::from(1u32 << self.size) * self.roughness;
        let by = |x: u32, y: u32| rise * gauss(SEED + self.hash(x, y));
        let lower = (z[0] + z[1]) / 2.0 + by(x + half, y);
        let right = (z[1] + z[2]) / 2.0 + by(x + width, y + half);
        let upper = (z[2] + z[3]) / 2.0 + by(x + half, y + width);
        let left = (z[3] + z[0]) / 2.0 + by(x, y + half);
        let middle = (z[0] + z[1] + z[2] + z[3]) / 4.0 + ROOT_2 * by(x + half, y + half);
        self.grow(half, [x, y], [z[0], lower, middle, left]);
        self.grow(half, [x + half, y], [lower, z[1], right, middle]);
        self.grow(half, [x + half, y + half], [middle, right, z[2], upper]);
        self.grow(half, [x, y + half], [left, middle, upper, z[3]]);
    }

    fn put(&mut self, [x, y]: [u32; 2], z: [f64; 4]) {
        let place = |i: u32| f64::from(i) * 2.0 / f64::from(1u32 << self.size) - 1.0;
        let corner = |i: u32, j: u32, z: f64| DVec3::new(place(x + i), place(y + j), z);
        let corners =
            [corner(0, 0, z[0]), corner(1, 0, z[1]), corner(1, 1, z[2]), corner(0, 1, z[3])];
        self.scene.polygon(&[corners[0], corners[1], corners[2]]);
        self.scene.polygon(&[corners[2], corners[3], corners[0]]);
    }

    /// A hash that repeats itself, kept because the published mountain does.
    fn hash(&self, x: u32, y: u32) -> u32 {
        ((x << (23 - self.size)) + (y << (15 - self.size)) + (x << (7 - self.size))) & 0xffff
    }
}

/// A number of the normal distribution, by the polar method.
fn gauss(seed: u32) -> f64 {
    let next = |x: u32| (28411 + 8121 * x) % 134_456;
    let unit = |x: u32| 2.0 * f64::from(x) / 134_456.0 - 1.0;
    let mut b = seed;
    loop {
        let a = next(b);
        b = next(a);
        let (v, w) = (unit(a), unit(b));
        let r = v * v + w * w;
        if r < 1.0 {
            return v * (-2.0 * libm::log(r) / r).sqrt();
        }
    }
}
