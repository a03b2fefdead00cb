//! Spheres.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::shape::{Crossing, Shape, bounds_from};

/// A sphere; rays hit it from outside and from inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub center: Vec3A,
    /// Radius, positive.
    pub radius: f32,
}

impl Sphere {
    fn is_sound(&self) -> bool {
        self.center.is_finite() && self.radius > 0.0 && self.radius.is_finite()
    }
}

impl Shape for Sphere {
    fn kind(&self) -> &'static str {
        "sphere"
    }

    fn bounds(&self) -> Aabb {
        if !self.is_sound() {
            return Aabb::EMPTY;
        }
        let (center, radius) = (self.center.as_dvec3(), f64::from(self.radius));
        bounds_from((center - radius).to_array(), (center + radius).to_array())
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let middle = self.center.dot(direction);
        let half = self.radius * direction.length() * (1.0 + 4.0 * f32::EPSILON);
        [middle - half, middle + half]
    }

    fn hull_area(&self) -> f32 {
        4.0 * std::f32::consts::PI * self.radius * self.radius
    }

    /// The shell: neither a cell outside nor one wholly inside touches it.
    fn touches(&self, cell: &Aabb) -> bool {
        let nearest = self.center.clamp(cell.min, cell.max) - self.center;
        let farthest = (cell.min - self.center).abs().max((cell.max - self.center).abs());
        let squared = self.radius * self.radius;
        nearest.length_squared() <= squared * (1.0 + 1e-5)
            && farthest.length_squared() >= squared * (1.0 - 1e-5)
            && self.bounds().overlaps(cell)
    }

    /// The roots about the point of the line nearest the centre, so that a sphere far away is
    /// not lost in rounding [Haines 19].
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        if !self.is_sound() {
            return;
        }
        let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
        let to_center = self.center.as_dvec3() - origin;
        let square = dir.length_squared();
        let middle = to_center.dot(dir) / square;
        let radius = f64::from(self.radius);
        let left = radius * radius - (to_center - dir * middle).length_squared();
        if left < 0.0 {
            return;
        }
        let half = (left / square).sqrt();
        found(Crossing { t: (middle - half) as f32, uv: [0.0; 2], front: true });
        found(Crossing { t: (middle + half) as f32, uv: [0.0; 2], front: false });
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let center = self.center.as_dvec3();
        let point = ray.origin().as_dvec3() + ray.dir().as_dvec3() * f64::from(crossing.t);
        let normal = (point - center).try_normalize().unwrap_or(DVec3::Z);
        // Put back onto the sphere: `t` was rounded.
        let position = center + normal * f64::from(self.radius);
        let around = DVec3::new(-normal.y, normal.x, 0.0).normalize_or_zero();
        let turn = libm::atan2(normal.y, normal.x) / std::f64::consts::TAU;
        let fall = libm::acos(normal.z.clamp(-1.0, 1.0)) / std::f64::consts::PI;
        Surface {
            tangent: around.as_vec3a(),
            uv: [(if turn < 0.0 { turn + 1.0 } else { turn }) as f32, fall as f32],
            ..Surface::new(position.as_vec3a(), normal.as_vec3a())
        }
    }
}
