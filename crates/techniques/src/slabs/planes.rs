//! Sets of slanting planes, and where a ray is between two of them.

use glam::Vec3A;
use nestray_core::ray::Ray;
use nestray_core::simd::Simd;

/// Most slanting directions.
pub(super) const MOST: usize = 10;

/// The diagonals of a cube, then those of its faces. Not of unit length: sums round less.
pub(super) static SLANTING: [Vec3A; MOST] = [
    Vec3A::new(1.0, 1.0, 1.0),
    Vec3A::new(-1.0, 1.0, 1.0),
    Vec3A::new(-1.0, -1.0, 1.0),
    Vec3A::new(1.0, -1.0, 1.0),
    Vec3A::new(1.0, 1.0, 0.0),
    Vec3A::new(1.0, -1.0, 0.0),
    Vec3A::new(1.0, 0.0, 1.0),
    Vec3A::new(1.0, 0.0, -1.0),
    Vec3A::new(0.0, 1.0, 1.0),
    Vec3A::new(0.0, 1.0, -1.0),
];

/// Which of them make up so many sets, along with the three axes.
pub(super) fn slanting(sets: usize) -> (usize, usize) {
    match sets {
        7 => (0, 4),
        9 => (4, 10),
        13 => (0, 10),
        _ => (0, 0),
    }
}

/// How far planes are moved outwards, relative to the largest coordinate: three coordinates add
/// up, each with the slack of a box test, and so does what rounding does to `direction · dir`
/// along the whole way of the ray.
const SLACK: f32 = 64.0 * f32::EPSILON;

/// A ray's own part of the test for one direction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Cut {
    inverse: f32,
    /// `origin · direction × inverse` plus slack: what to take off where the ray enters.
    near: f32,
    /// The same minus slack: where it leaves.
    far: f32,
}

/// Works out the cuts of a ray, for volumes with coordinates up to `reach`.
#[inline(never)]
pub(super) fn prepare(ray: &Ray, reach: f32, directions: &[Vec3A], cuts: &mut [Cut; MOST]) {
    let slack = slack(ray, reach);
    for (cut, &direction) in cuts.iter_mut().zip(directions) {
        *cut = Cut::new(ray, slack, direction);
    }
}

/// How far planes are moved for a ray among volumes with coordinates up to `reach`.
#[inline(always)]
pub(crate) fn slack(ray: &Ray, reach: f32) -> f32 {
    ray.origin().abs().max_element().max(reach) * SLACK
}

impl Cut {
    /// For planes across `direction`, which is two or shorter.
    #[inline(always)]
    pub(crate) fn new(ray: &Ray, slack: f32, direction: Vec3A) -> Self {
        // Slower than this is all rounding. The slack has room for what the change moves.
        let least = ray.dir().abs().max_element() * (4.0 * f32::EPSILON);
        let speed = direction.dot(ray.dir());
        let inverse = 1.0 / if speed.abs() < least { least.copysign(speed) } else { speed };
        let (middle, slack) = (direction.dot(ray.origin()) * inverse, slack * inverse.abs());
        Self { inverse, near: middle + slack, far: middle - slack }
    }

    /// Narrows where the ray is inside of eight volumes.
    #[inline(always)]
    pub(crate) fn narrow<S: Simd>(
        &self,
        simd: S,
        rows: &[[f32; 8]; 2],
        near: S::F32,
        far: S::F32,
    ) -> (S::F32, S::F32) {
        let back = usize::from(self.inverse.is_sign_negative());
        let inverse = simd.splat(self.inverse);
        let enter = simd.mul_sub(simd.load(&rows[back]), inverse, simd.splat(self.near));
        let leave = simd.mul_sub(simd.load(&rows[1 - back]), inverse, simd.splat(self.far));
        // What is NaN narrows nothing.
        (simd.max(enter, near), simd.min(leave, far))
    }
}
