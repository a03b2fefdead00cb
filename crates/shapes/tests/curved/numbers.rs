//! Random numbers, the same on every run, and rays made of them.

use glam::{DVec3, Vec3A};
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::shape::{Crossing, Shape};

/// A generator; its seed is in the messages of tests that fail.
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    /// In `[0, 1)`.
    pub(crate) fn next(&mut self) -> f32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }

    /// In `[low, high)`.
    pub(crate) fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.next()
    }

    /// In a cube of half edge `size`.
    pub(crate) fn vector(&mut self, size: f32) -> Vec3A {
        Vec3A::new(self.between(-size, size), self.between(-size, size), self.between(-size, size))
    }

    /// From somewhere on a sphere around a point to somewhere near it.
    pub(crate) fn ray_at(&mut self, target: Vec3A, spread: f32, distance: f32) -> Ray {
        let from = loop {
            let from = self.vector(1.0);
            if from.length() > 0.1 {
                break target + from.normalize() * distance;
            }
        };
        let to = target + self.vector(spread);
        Ray::new(from, (to - from) * self.between(0.1, 3.0), RayKind::Camera)
    }
}

/// All crossings, by `t`.
pub(crate) fn crossings(shape: &impl Shape, ray: &Ray) -> Vec<Crossing> {
    let mut all = Vec::new();
    shape.crossings(ray, |crossing| all.push(crossing));
    all.sort_by(|a, b| a.t.total_cmp(&b.t));
    all
}

/// A place on a ray, in doubles.
pub(crate) fn at(ray: &Ray, t: f64) -> DVec3 {
    ray.origin().as_dvec3() + ray.dir().as_dvec3() * t
}
