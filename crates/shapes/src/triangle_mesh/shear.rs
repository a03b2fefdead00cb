//! The space in which a ray is the z axis.

use nestray_core::packet::longest;
use nestray_core::ray::Ray;
use nestray_core::simd::Simd;

use super::test::Rays;
use crate::shape::Sides;

/// What a ray brings to the triangles of a mesh.
#[derive(Clone, Copy, Debug, Default)]
pub struct Probe {
    /// The space in which it is the z axis.
    pub shear: Shear,
    /// The triangle it left, which it cannot meet again.
    pub(super) skip: u32,
    /// Which sides it can see.
    pub(super) sides: Sides,
}

/// The space in which a ray runs along z, from 0.
#[derive(Clone, Copy, Debug, Default)]
pub struct Shear {
    pub(super) origin: [f32; 3],
    /// `dir.x / dir.z`, `dir.y / dir.z`, `1 / dir.z`, where z is the longest.
    pub(super) slope: [f32; 3],
    pub(super) t_min: f32,
    pub(super) axes: [u8; 3],
}

impl Shear {
    /// The shear of a ray.
    #[inline(always)]
    #[must_use]
    pub fn new(ray: &Ray) -> Self {
        let (origin, dir) = (ray.origin().to_array(), ray.dir().to_array());
        let [x, y, z] = axes(longest(dir));
        let inverse = 1.0 / dir[z];
        Self {
            origin: [origin[x], origin[y], origin[z]],
            slope: [dir[x] * inverse, dir[y] * inverse, inverse],
            t_min: ray.t_min(),
            axes: [x as u8, y as u8, z as u8],
        }
    }

    /// Lanes that are all this ray.
    #[inline(always)]
    pub(super) fn in_all<S: Simd>(&self, simd: S, limit: f32) -> Rays<S> {
        let [x, y, z] = self.origin;
        let moves = |slope: f32| u32::from(slope.abs() > STILL) * 255;
        Rays {
            slope: [
                simd.splat(self.slope[0]),
                simd.splat(self.slope[1]),
                simd.splat(self.slope[2]),
            ],
            moves: [moves(self.slope[0]), moves(self.slope[1])],
            reach: simd.splat(2.0 * x.abs().max(y.abs()).max(z.abs())),
            t_min: simd.splat(self.t_min),
            limit: simd.splat(limit),
            is_forward: self.slope[2] > 0.0,
        }
    }

    /// Which axis of space is axis `i` here.
    #[inline(always)]
    pub(super) fn axis(&self, i: usize) -> usize {
        usize::from(self.axes[i])
    }

    /// Points, given by their coordinates along [`axis`](Self::axis) 0, 1 and 2.
    #[inline(always)]
    pub(super) fn apply<S: Simd>(&self, simd: S, x: S::F32, y: S::F32, z: S::F32) -> [S::F32; 3] {
        let x = simd.sub(x, simd.splat(self.origin[0]));
        let y = simd.sub(y, simd.splat(self.origin[1]));
        let z = simd.sub(z, simd.splat(self.origin[2]));
        let x = simd.sub(x, simd.mul(simd.splat(self.slope[0]), z));
        let y = simd.sub(y, simd.mul(simd.splat(self.slope[1]), z));
        [x, y, z]
    }
}

/// The axes that are x, y and z where a ray runs fastest along axis `z`.
#[inline(always)]
pub(super) fn axes(z: usize) -> [usize; 3] {
    [[1, 2, 0][z], [2, 0, 1][z], z]
}

/// Largest slope of a ray that does not move along an axis.
pub(super) const STILL: f32 = 1e-9;
