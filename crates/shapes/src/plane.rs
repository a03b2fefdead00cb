//! Planes without end.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::polygon::{crosses, flat_error};
use crate::rounding::{slack, unrounded};
use crate::shadow::{self, Images};
use crate::shape::{Crossing, NOWHERE, Shape, interval_from};

/// A plane without end; its bounds are endless. Texture coordinates are lengths from
/// [`point`](Self::point).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Any point of it.
    pub point: Vec3A,
    /// Points away from the front; of any length.
    pub normal: Vec3A,
}

impl Plane {
    /// Unit normal; none if it cannot be hit.
    fn unit_normal(&self) -> Option<DVec3> {
        let near = self.point.abs().cmple(Vec3A::splat(Ray::FARTHEST)).all();
        if near && self.normal.is_finite() { self.normal.as_dvec3().try_normalize() } else { None }
    }

    #[inline]
    fn roots(&self, ray: &Ray, mut found: impl FnMut(f64, bool)) {
        let Some(normal) = self.unit_normal() else { return };
        let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
        let slope = normal.dot(dir);
        let t = normal.dot(self.point.as_dvec3() - origin) / slope;
        let point = origin + dir * t;
        // Not true in the plane, where `t` is NaN or infinite.
        if point.abs().cmple(DVec3::splat(f64::from(Ray::FARTHEST))).all() {
            found(t, slope < 0.0);
        }
    }
}

impl Shape for Plane {
    fn kind(&self) -> &'static str {
        "plane"
    }

    fn bounds(&self) -> Aabb {
        if self.unit_normal().is_some() { Aabb::ENDLESS } else { Aabb::EMPTY }
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let Some(normal) = self.unit_normal() else { return NOWHERE };
        let direction = direction.as_dvec3();
        if self.normal.as_dvec3().cross(direction) != DVec3::ZERO {
            return [f32::NEG_INFINITY, f32::INFINITY];
        }
        let height = self.point.as_dvec3().dot(normal) * normal.dot(direction);
        // Points of the plane far away are known to their own precision only.
        let room = slack(self.point.abs().max_element()) * direction.length();
        interval_from(height - room, height + room)
    }

    fn hull_area(&self) -> f32 {
        if self.unit_normal().is_some() { f32::INFINITY } else { 0.0 }
    }

    fn touches(&self, cell: &Aabb) -> bool {
        self.unit_normal().is_some_and(|normal| {
            let height = normal.dot(self.point.as_dvec3());
            let room = slack(self.point.abs().max_element());
            crosses(normal, [height - room, height + room], cell)
        })
    }

    fn facing(&self, beam: &Beam) -> Facing {
        self.unit_normal().map_or(Facing::Mixed, |normal| shadow::facing(normal, beam))
    }

    fn blocks(&self, beam: &Beam) -> Option<f32> {
        let images = Images::new(beam, self.point.as_dvec3(), self.unit_normal()?)?;
        shadow::beyond(images.farthest)
    }

    #[inline]
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        self.roots(ray, |t, front| found(Crossing { t: t as f32, uv: [0.0; 2], front }));
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let normal = self.unit_normal().unwrap_or(DVec3::Z);
        let middle = self.point.as_dvec3();
        let t = unrounded(crossing, |found| self.roots(ray, found));
        let point = ray.origin().as_dvec3() + ray.dir().as_dvec3() * t;
        let position = point - normal * normal.dot(point - middle);
        let [x, y] = across(normal);
        let from = position - middle;
        Surface {
            error: flat_error(position.abs().max(middle.abs())),
            tangent: x.as_vec3a(),
            mirrored: true,
            uv: [from.dot(x) as f32, from.dot(y) as f32],
            ..Surface::new(position.as_vec3a(), normal.as_vec3a())
        }
    }

    fn is_flat(&self) -> bool {
        true
    }
}

/// Two unit vectors across a unit normal: along x and y for a normal along z.
pub(crate) fn across(normal: DVec3) -> [DVec3; 2] {
    let size = normal.abs();
    let axis = if size.x <= size.y && size.x <= size.z {
        DVec3::X
    } else if size.y <= size.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let x = (axis - normal * normal.dot(axis)).normalize();
    [x, normal.cross(x)]
}
