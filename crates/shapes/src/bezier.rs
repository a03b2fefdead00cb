//! Bicubic Bézier patches, hit as they are: nothing is cut into triangles.

use glam::Vec3A;
use nestray_core::aabb::Aabb;

/// A bicubic Bézier patch.
///
/// Row `i` of the control points goes with `u`, column `j` with `v`, both in `[0, 1]`: the
/// corners `(u, v)` are `points[0][0]` for (0, 0), `points[3][0]` for (1, 0) and
/// `points[0][3]` for (0, 1). Its front is where `∂u × ∂v` points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BezierPatch {
    /// The control points.
    pub points: [[Vec3A; 4]; 4],
}

impl BezierPatch {
    /// The box around the control points, which holds the patch; empty if one is not finite.
    #[must_use]
    pub fn hull(&self) -> Aabb {
        let points = self.points.as_flattened();
        if !points.iter().all(|point| point.is_finite()) {
            return Aabb::EMPTY;
        }
        points.iter().fold(Aabb::EMPTY, |hull, &point| hull.with(point))
    }

    /// The same surface with its front where its back was: `u` and `v` change places.
    #[must_use]
    pub fn turned(&self) -> Self {
        let points = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| self.points[j][i]));
        Self { points }
    }
}
