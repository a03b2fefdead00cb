//! Cones and frustums without caps.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::plane::across;
use crate::rounding::{slack, unrounded};
use crate::shape::{Crossing, NOWHERE, Shape, bounds_from, interval_from};

/// A cone, whole or cut off, open at its ends; rays hit it from outside and from inside.
/// Texture coordinates are the angle in turns and the height from 0 at the base to 1 at
/// the apex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Centre of one end.
    pub base: Vec3A,
    /// Radius there, not negative.
    pub base_radius: f32,
    /// Centre of the other end.
    pub apex: Vec3A,
    /// Radius there, not negative.
    pub apex_radius: f32,
}

impl Cone {
    fn is_sound(&self) -> bool {
        let (a, b) = (self.base_radius, self.apex_radius);
        // Written so that NaN is refused.
        self.base.abs().max_element() + a <= Ray::FARTHEST
            && self.apex.abs().max_element() + b <= Ray::FARTHEST
            && self.base.is_finite()
            && self.apex.is_finite()
            && a >= 0.0
            && b >= 0.0
            && a.max(b) > 0.0
            && self.axis() != DVec3::ZERO
    }

    fn axis(&self) -> DVec3 {
        self.apex.as_dvec3() - self.base.as_dvec3()
    }

    fn radius(&self, height: f64) -> f64 {
        let (a, b) = (f64::from(self.base_radius), f64::from(self.apex_radius));
        a + (b - a) * height
    }

    /// How far it reaches along a direction.
    fn reach(&self, direction: DVec3) -> [f64; 2] {
        let aside = self.axis().normalize().cross(direction).length();
        let end = |center: Vec3A, radius: f32| {
            let (middle, half) = (center.as_dvec3().dot(direction), f64::from(radius) * aside);
            [middle - half, middle + half]
        };
        let (a, b) = (end(self.base, self.base_radius), end(self.apex, self.apex_radius));
        [a[0].min(b[0]), a[1].max(b[1])]
    }

    /// Roots of `|x⊥|² = r(z)²`, with `z` from 0 at the base to 1 at the apex, taken about the
    /// point of the line nearest the middle so that little is lost to a far origin.
    #[inline]
    fn roots(&self, ray: &Ray, mut found: impl FnMut(f64, bool)) {
        if !self.is_sound() {
            return;
        }
        let (base, axis, dir) = (self.base.as_dvec3(), self.axis(), ray.dir().as_dvec3());
        let from_base = ray.origin().as_dvec3() - base;
        let nearest = (axis * 0.5 - from_base).dot(dir) / dir.length_squared();
        let from = from_base + dir * nearest;
        let per_axis = axis / axis.length_squared();
        let (z, dz) = (from.dot(per_axis), dir.dot(per_axis));
        let (side, dside) = (from - axis * z, dir - axis * dz);
        let (radius, dradius) = (self.radius(z), self.radius(dz) - self.radius(0.0));
        let a = dside.length_squared() - dradius * dradius;
        let b = side.dot(dside) - radius * dradius;
        let c = side.length_squared() - radius * radius;
        // b² − ac without its cancellation, after Lagrange's identity.
        let left = (dside * radius - side * dradius).length();
        let right = side.cross(dside).length();
        let square = (left - right) * (left + right);
        if square.is_nan() || square < 0.0 {
            return;
        }
        let root = square.sqrt();
        let q = if b > 0.0 { -b - root } else { root - b };
        // Half the slope of `|x⊥|² − r²` at the two is q + b and its opposite.
        for (t, front) in [(q / a, b > 0.0), (c / q, b <= 0.0)] {
            // Nothing beyond the ends: no sheet beyond the apex. NaN is refused.
            if (0.0..=1.0).contains(&(z + dz * t)) {
                found(nearest + t, front);
            }
        }
    }
}

impl Shape for Cone {
    fn kind(&self) -> &'static str {
        "cone"
    }

    fn bounds(&self) -> Aabb {
        if !self.is_sound() {
            return Aabb::EMPTY;
        }
        let reach = DVec3::AXES.map(|axis| self.reach(axis));
        bounds_from(reach.map(|[low, _]| low), reach.map(|[_, high]| high))
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        if !self.is_sound() {
            return NOWHERE;
        }
        let [low, high] = self.reach(direction.as_dvec3());
        interval_from(low, high)
    }

    /// With caps, which its hull has.
    fn hull_area(&self) -> f32 {
        if !self.is_sound() {
            return 0.0;
        }
        let (a, b) = (f64::from(self.base_radius), f64::from(self.apex_radius));
        let side = (self.axis().length_squared() + (a - b) * (a - b)).sqrt();
        (std::f64::consts::PI * ((a + b) * side + a * a + b * b)) as f32
    }

    /// Judged by the ball around the cell: the heights and the distances from the axis that
    /// it covers.
    fn touches(&self, cell: &Aabb) -> bool {
        let bounds = self.bounds();
        if !bounds.padded().overlaps(cell) {
            return false;
        }
        let (axis, middle) = (self.axis(), cell.center().as_dvec3() - self.base.as_dvec3());
        let ball = cell.size().as_dvec3().length() / 2.0 + 4.0 * slack(bounds.reach());
        let z = middle.dot(axis) / axis.length_squared();
        let away = (middle - axis * z).length();
        let half = ball / axis.length();
        let radii = [z - half, z + half].map(|z| self.radius(z.clamp(0.0, 1.0)));
        // An endless cell gives a NaN or an infinity; neither may say no.
        let misses = z + half < 0.0
            || z - half > 1.0
            || away + ball < radii[0].min(radii[1])
            || away - ball > radii[0].max(radii[1]);
        !misses
    }

    #[inline]
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        self.roots(ray, |t, front| found(Crossing::of_solid(t as f32, front)));
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let t = unrounded(crossing, |found| self.roots(ray, found));
        let (base, axis) = (self.base.as_dvec3(), self.axis());
        let from = ray.origin().as_dvec3() + ray.dir().as_dvec3() * t - base;
        let z = (from.dot(axis) / axis.length_squared()).clamp(0.0, 1.0);
        let unit = axis.normalize();
        let [x, y] = across(unit);
        // At the tip every side is as good.
        let side = (from - unit * from.dot(unit)).try_normalize().unwrap_or(x);
        let rise = self.radius(0.0) - self.radius(1.0);
        let normal = (side * axis.length() + unit * rise).normalize();
        // Put back onto the cone.
        let position = base + axis * z + side * self.radius(z);
        let turn = libm::atan2(side.dot(y), side.dot(x)) / std::f64::consts::TAU;
        let surface = Surface::new(position.as_vec3a(), normal.as_vec3a());
        let size = self.base_radius.max(self.apex_radius).max(axis.length() as f32);
        Surface {
            // The roots of the next ray are off by far less, but not by nothing.
            error: surface.error + size * (f32::EPSILON / 2.0),
            tangent: unit.cross(side).as_vec3a(),
            mirrored: true,
            uv: [(if turn < 0.0 { turn + 1.0 } else { turn }) as f32, z as f32],
            ..surface
        }
    }
}
