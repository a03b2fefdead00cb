//! Flat disks.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::plane::across;
use crate::polygon::{crosses, flat_error};
use crate::rounding::{slack, unrounded};
use crate::shadow::{self, Images};
use crate::shape::{Crossing, NOWHERE, Shape, bounds_from, interval_from};

/// A flat disk. Texture coordinates are the angle around the centre, in turns, and the
/// distance from it, in radii.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// Centre.
    pub center: Vec3A,
    /// Points away from the front; of any length.
    pub normal: Vec3A,
    /// Radius, positive.
    pub radius: f32,
}

impl Disk {
    /// Unit normal; none if it cannot be hit.
    fn unit_normal(&self) -> Option<DVec3> {
        let sound = self.center.abs().max_element() + self.radius <= Ray::FARTHEST
            && self.center.is_finite()
            && self.radius > 0.0
            && self.normal.is_finite();
        if sound { self.normal.as_dvec3().try_normalize() } else { None }
    }

    /// How far it reaches from its centre along a direction.
    fn half(&self, normal: DVec3, direction: DVec3) -> f64 {
        f64::from(self.radius) * normal.cross(direction).length()
    }

    #[inline]
    fn roots(&self, ray: &Ray, mut found: impl FnMut(f64, bool)) {
        let Some(normal) = self.unit_normal() else { return };
        let (from, dir) =
            ((ray.origin().as_dvec3() - self.center.as_dvec3()), ray.dir().as_dvec3());
        let slope = normal.dot(dir);
        let t = -normal.dot(from) / slope;
        let radius = f64::from(self.radius);
        // Not true in the plane, where `t` is NaN or infinite.
        if (from + dir * t).length_squared() <= radius * radius {
            found(t, slope < 0.0);
        }
    }
}

impl Shape for Disk {
    fn kind(&self) -> &'static str {
        "disk"
    }

    fn bounds(&self) -> Aabb {
        let Some(normal) = self.unit_normal() else { return Aabb::EMPTY };
        let half = DVec3::from_array(DVec3::AXES.map(|axis| self.half(normal, axis)));
        let center = self.center.as_dvec3();
        bounds_from((center - half).to_array(), (center + half).to_array())
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let Some(normal) = self.unit_normal() else { return NOWHERE };
        let middle = self.center.as_dvec3().dot(direction.as_dvec3());
        let half = self.half(normal, direction.as_dvec3());
        interval_from(middle - half, middle + half)
    }

    fn hull_area(&self) -> f32 {
        match self.unit_normal() {
            Some(_) => 2.0 * std::f32::consts::PI * self.radius * self.radius,
            None => 0.0,
        }
    }

    fn touches(&self, cell: &Aabb) -> bool {
        self.unit_normal().is_some_and(|normal| {
            let height = normal.dot(self.center.as_dvec3());
            let room = slack(self.bounds().reach());
            let nearest = self.center.clamp(cell.min, cell.max) - self.center;
            nearest.as_dvec3().length() <= f64::from(self.radius) + room
                && crosses(normal, [height - room, height + room], cell)
                && self.bounds().padded().overlaps(cell)
        })
    }

    fn facing(&self, beam: &Beam) -> Facing {
        self.unit_normal().map_or(Facing::Mixed, |normal| shadow::facing(normal, beam))
    }

    fn blocks(&self, beam: &Beam) -> Option<f32> {
        let normal = self.unit_normal()?;
        let center = self.center.as_dvec3();
        let images = Images::new(beam, center, normal)?;
        let within = images.points.iter().all(|&point| {
            let room = slack(point.abs().max(center.abs()).max_element() as f32);
            (point - center).length() <= f64::from(self.radius) - room
        });
        if within { shadow::beyond(images.farthest) } else { None }
    }

    #[inline]
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        self.roots(ray, |t, front| found(Crossing { t: t as f32, uv: [0.0; 2], front }));
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let normal = self.unit_normal().unwrap_or(DVec3::Z);
        let center = self.center.as_dvec3();
        let t = unrounded(crossing, |found| self.roots(ray, found));
        let point = ray.origin().as_dvec3() + ray.dir().as_dvec3() * t;
        let position = point - normal * normal.dot(point - center);
        let from = position - center;
        let [x, y] = across(normal);
        let turn = libm::atan2(from.dot(y), from.dot(x)) / std::f64::consts::TAU;
        let turn = if turn < 0.0 { turn + 1.0 } else { turn };
        let away = from.length() / f64::from(self.radius);
        Surface {
            error: flat_error(center.abs() + f64::from(self.radius)),
            tangent: normal.cross(from).normalize_or_zero().as_vec3a(),
            uv: [turn as f32, away.min(1.0) as f32],
            ..Surface::new(position.as_vec3a(), normal.as_vec3a())
        }
    }

    fn is_flat(&self) -> bool {
        true
    }
}
