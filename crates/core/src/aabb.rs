//! Axis-aligned bounding boxes, and where a ray is inside one.

use glam::{Affine3A, Vec3A};

use crate::ray::Ray;

/// An axis-aligned box; empty when `min > max` on any axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Lower corner.
    pub min: Vec3A,
    /// Upper corner.
    pub max: Vec3A,
}

impl Aabb {
    /// Contains nothing; the identity of [`join`](Self::join).
    pub const EMPTY: Self = Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    /// Contains everything.
    pub const ENDLESS: Self = Self { min: Vec3A::NEG_INFINITY, max: Vec3A::INFINITY };

    /// The smallest box around both.
    #[inline]
    #[must_use]
    pub fn join(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The smallest box around this one and a point.
    #[inline]
    #[must_use]
    pub fn with(self, point: Vec3A) -> Self {
        Self { min: self.min.min(point), max: self.max.max(point) }
    }

    /// What is in both; empty if nothing is.
    #[inline]
    #[must_use]
    pub fn meet(self, other: Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// Edge lengths; negative where empty.
    #[inline]
    #[must_use]
    pub fn size(self) -> Vec3A {
        self.max - self.min
    }

    /// The middle.
    #[inline]
    #[must_use]
    pub fn center(self) -> Vec3A {
        self.min * 0.5 + self.max * 0.5
    }

    /// Surface area; zero when empty. The numerator and denominator of
    /// [Arvo 90, Theorem 1].
    #[inline]
    #[must_use]
    pub fn surface_area(self) -> f32 {
        let s = self.size();
        if s.min_element() < 0.0 { 0.0 } else { 2.0 * (s.x * s.y + s.y * s.z + s.z * s.x) }
    }

    /// Whether the two share a point.
    #[inline]
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether all of `other` is inside.
    #[inline]
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// The interval of `direction · point` over the box.
    #[must_use]
    pub fn along(&self, direction: Vec3A) -> [f32; 2] {
        let (a, b) = (self.min * direction, self.max * direction);
        [a.min(b).element_sum(), a.max(b).element_sum()]
    }

    /// Whether there is nothing in it; a box with a NaN corner counts as empty.
    #[inline]
    #[must_use]
    pub fn is_empty(self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether all corners are finite; planes and other endless shapes are not.
    #[inline]
    #[must_use]
    pub fn is_bounded(self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// Largest coordinate, by size.
    #[inline]
    #[must_use]
    pub fn reach(self) -> f32 {
        self.min.abs().max(self.max.abs()).max_element()
    }

    /// Grown by a few ulps, so that a point on a face is inside for every test.
    #[inline]
    #[must_use]
    pub fn padded(self) -> Self {
        let pad = self.min.abs().max(self.max.abs()) * 4e-7 + 1e-30;
        Self { min: self.min - pad, max: self.max + pad }
    }

    /// A corner: bit `i` of `which` (below 8) picks the upper end of axis `i`.
    #[inline]
    #[must_use]
    pub fn corner(self, which: u32) -> Vec3A {
        let pick =
            |axis: usize| if which >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] };
        Vec3A::new(pick(0), pick(1), pick(2))
    }

    /// The smallest box around this one moved by `to_from` [Arvo 90b]. Empty stays empty;
    /// what is not bounded becomes endless.
    #[must_use]
    pub fn transformed(self, to_from: &Affine3A) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        if !self.is_bounded() {
            return Self::ENDLESS;
        }
        let mut moved = Self { min: to_from.translation, max: to_from.translation };
        for axis in 0..3 {
            let column = to_from.matrix3.col(axis);
            let (a, b) = (column * self.min[axis], column * self.max[axis]);
            moved.min += a.min(b);
            moved.max += a.max(b);
        }
        moved
    }
}

/// A ray's own part of the box test, worked out once per ray and family of boxes.
///
/// Rounds outwards: it may keep a box the ray just misses, never drop one that holds a
/// hit. Both ends are moved by a slack that bounds what rounding does to the box test and
/// to the shapes' own tests, relative to the largest coordinate in play [Ize 13; Woop 13].
#[derive(Clone, Copy, Debug, Default)]
pub struct Clip {
    /// [`Ray::inverse_dir`].
    pub inverse: Vec3A,
    /// `origin / dir` plus slack: what to take off where the ray enters.
    pub near: Vec3A,
    /// The same minus slack: where it leaves.
    pub far: Vec3A,
    /// Not −0, so that keys sort as integers.
    pub t_min: f32,
}

impl Clip {
    /// How far rounding may move a box, a hit or a distance, relative to the largest
    /// coordinate: 20 half-ulps. Twice what the triangle test and the box test add up to.
    pub const SLACK: f32 = 20.0 * f32::EPSILON / 2.0;

    /// For boxes whose coordinates are at most `reach`.
    #[inline(always)]
    #[must_use]
    pub fn new(ray: &Ray, reach: f32) -> Self {
        Self::with_slack(ray, reach, Self::SLACK)
    }

    /// With another relative slack than [`SLACK`](Self::SLACK).
    #[inline(always)]
    #[must_use]
    pub fn with_slack(ray: &Ray, reach: f32, slack: f32) -> Self {
        let origin = ray.origin();
        let inverse = ray.inverse_dir();
        let farthest = origin.abs().max_element();
        let reach = if farthest > reach { farthest } else { reach };
        let slack = inverse.abs() * (reach * slack);
        let middle = origin * inverse;
        Self { inverse, near: middle + slack, far: middle - slack, t_min: ray.t_min() }
    }

    /// Where the ray is inside `bounds`, as `(enter, leave)` clipped to its range and to
    /// `limit`; none if it is not.
    #[inline(always)]
    #[must_use]
    pub fn cut(&self, bounds: &Aabb, limit: f32) -> Option<(f32, f32)> {
        let (a, b) = (bounds.min * self.inverse, bounds.max * self.inverse);
        let forward = self.inverse.cmpge(Vec3A::ZERO);
        let enter = (Vec3A::select(forward, a, b) - self.near).max_element().max(self.t_min);
        let leave = (Vec3A::select(forward, b, a) - self.far).min_element().min(limit);
        (enter <= leave).then_some((enter, leave))
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;
    use crate::ray::RayKind;

    #[test]
    fn a_ray_in_a_face_or_along_an_edge_is_inside() {
        let unit = Aabb { min: Vec3A::ZERO, max: Vec3A::ONE };
        for origin in [Vec3A::new(0.0, 0.5, -1.0), Vec3A::new(1.0, 1.0, -1.0), Vec3A::NEG_Z] {
            for zero in [0.0, -0.0] {
                let ray = Ray::new(origin, Vec3A::new(zero, zero, 1.0), RayKind::Camera);
                let (enter, leave) =
                    Clip::new(&ray, 1.0).cut(&unit, f32::INFINITY).expect("it grazes the box");
                assert!(enter <= 1.0 && leave >= 2.0, "{enter} {leave}");
            }
        }
        let past = Ray::new(Vec3A::new(1.1, 0.5, -1.0), Vec3A::Z, RayKind::Camera);
        assert!(Clip::new(&past, 1.0).cut(&unit, f32::INFINITY).is_none());
        assert!(Clip::new(&past, 1.0).cut(&Aabb::EMPTY, f32::INFINITY).is_none());
    }

    #[test]
    fn a_moved_box_holds_the_moved_corners() {
        let b = Aabb { min: Vec3A::new(-1.0, 2.0, 0.0), max: Vec3A::new(0.5, 3.0, 4.0) };
        let m = Affine3A::from_rotation_translation(
            Quat::from_xyzw(0.1, 0.7, -0.2, 0.3).normalize(),
            glam::Vec3::new(5.0, -6.0, 7.0),
        );
        let moved = b.transformed(&m).padded();
        for corner in 0..8 {
            let point = m.transform_point3a(b.corner(corner));
            assert!(moved.contains(&Aabb { min: point, max: point }));
        }
        assert!(Aabb::EMPTY.transformed(&m).is_empty());
    }
}
