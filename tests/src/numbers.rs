//! Random numbers from a printed seed.

use glam::{Affine3A, Quat, Vec3, Vec3A};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Random numbers; the same for the same seed, on every machine.
#[derive(Clone, Debug)]
pub struct Numbers(Pcg64Mcg);

impl Numbers {
    /// The numbers of a seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    /// A number in `[0, 1)`.
    pub fn unit(&mut self) -> f32 {
        self.0.random()
    }

    /// A number in `[low, high)`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        self.0.random_range(0..count)
    }

    /// Whether something happens that does once in `times`.
    pub fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    /// One of several.
    pub fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[self.below(from.len())]
    }

    /// A point of the unit cube.
    pub fn point(&mut self) -> Vec3A {
        Vec3A::new(self.unit(), self.unit(), self.unit())
    }

    /// A direction, all alike.
    pub fn direction(&mut self) -> Vec3A {
        loop {
            let v = self.point() * 2.0 - 1.0;
            if (0.01..=1.0).contains(&v.length_squared()) {
                return v.normalize();
            }
        }
    }

    /// A place for an object of size 1 in a world of size 1: turned, scaled by up to `scale`,
    /// now and then mirrored or squeezed.
    pub fn place(&mut self, scale: f32) -> Affine3A {
        let axis = self.direction();
        let turn = match self.below(4) {
            // Quarter turns put faces into faces.
            0 => Quat::from_rotation_z(std::f32::consts::FRAC_PI_2 * self.below(4) as f32),
            _ => Quat::from_axis_angle(axis.into(), self.between(0.0, 6.3)),
        };
        let size = self.between(0.2, 1.0) * scale;
        let scale = match self.below(4) {
            0 => Vec3::new(-size, size, size),
            1 => Vec3::new(size, size * self.between(0.1, 1.0), size * self.between(0.1, 2.0)),
            _ => Vec3::splat(size),
        };
        Affine3A::from_scale_rotation_translation(scale, turn, self.point().into())
    }
}
