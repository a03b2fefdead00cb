//! Random numbers, vectors and rays, the same on every run.

use glam::{DVec3, Vec3A};
use nestray_core::ray::{Ray, RayKind};

/// `SplitMix64` [Steele 14].
#[derive(Debug)]
pub(crate) struct Numbers(pub(crate) u64);

impl Numbers {
    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let a = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let b = (a ^ (a >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        b ^ (b >> 31)
    }

    /// In `[0, 1)`.
    pub(crate) fn next(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    /// A size whose logarithm is even between those of two powers of ten.
    pub(crate) fn size(&mut self, low: f64, high: f64) -> f64 {
        libm::pow(10.0, self.between(low, high))
    }

    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    pub(crate) fn unit(&mut self) -> DVec3 {
        loop {
            let v = self.cube();
            let square = v.length_squared();
            if square > 1e-4 && square <= 1.0 {
                return v.normalize();
            }
        }
    }

    /// In the cube from −1 to 1.
    pub(crate) fn cube(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// A ray that passes somewhere near the ball around `center`, from inside or outside; one
    /// in eight runs along an axis.
    pub(crate) fn ray_near(&mut self, center: DVec3, size: f64) -> Ray {
        let target = center + self.cube() * size;
        let away = size * self.size(-1.0, 2.0);
        let dir = if self.below(8) == 0 {
            DVec3::AXES[self.below(3)] * if self.below(2) == 0 { 1.0 } else { -1.0 }
        } else {
            self.unit()
        };
        let length = self.size(-3.0, 3.0);
        Ray::new((target - dir * away).as_vec3a(), (dir * length).as_vec3a(), RayKind::Camera)
    }

    /// A unit vector on the side of `normal`.
    pub(crate) fn outward(&mut self, normal: Vec3A) -> Vec3A {
        let dir = self.unit().as_vec3a();
        if dir.dot(normal) < 0.0 { -dir } else { dir }
    }
}
