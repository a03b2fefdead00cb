//! Spheres.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::beam::Beam;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::rounding::{slack, unrounded};
use crate::shadow::{Section, beyond};
use crate::shape::{Crossing, NOWHERE, Shape, bounds_from, interval_from};

/// A sphere; rays hit it from outside and from inside. Texture coordinates are the angle
/// around the z axis, in turns, and the angle from the top, in half turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub center: Vec3A,
    /// Radius, positive.
    pub radius: f32,
}

impl Sphere {
    fn is_sound(&self) -> bool {
        // Written so that NaN is refused.
        self.center.abs().max_element() + self.radius <= Ray::FARTHEST
            && self.center.is_finite()
            && self.radius > 0.0
    }

    /// The roots about the point of the line nearest the centre, so that a sphere far away is
    /// not lost in rounding [Haines 19].
    #[inline]
    fn roots(&self, ray: &Ray, mut found: impl FnMut(f64, bool)) {
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
        found(middle - half, true);
        found(middle + half, false);
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
        if !self.is_sound() {
            return NOWHERE;
        }
        let direction = direction.as_dvec3();
        let middle = self.center.as_dvec3().dot(direction);
        let half = f64::from(self.radius) * direction.length();
        interval_from(middle - half, middle + half)
    }

    fn hull_area(&self) -> f32 {
        if self.is_sound() { 4.0 * std::f32::consts::PI * self.radius * self.radius } else { 0.0 }
    }

    /// The shell: neither a cell outside nor one wholly inside touches it.
    fn touches(&self, cell: &Aabb) -> bool {
        let bounds = self.bounds();
        let (center, radius) = (self.center.as_dvec3(), f64::from(self.radius));
        let (min, max) = (cell.min.as_dvec3(), cell.max.as_dvec3());
        let room = 2.0 * slack(bounds.reach());
        let farthest = (min - center).abs().max((max - center).abs());
        bounds.padded().overlaps(cell)
            && (center.max(min).min(max) - center).length() <= radius + room
            && farthest.length() >= radius - room
    }

    /// By the square in it across the beam: rays from outside that pass through it have
    /// entered the sphere before.
    fn blocks(&self, beam: &Beam) -> Option<f32> {
        let (axis, center) = (beam.axis % 3, self.center.as_dvec3());
        let section = Section::new(beam, center[axis])?;
        let (min, max) = (beam.origin.min.as_dvec3(), beam.origin.max.as_dvec3());
        let room = 2.0 * slack(self.bounds().reach().max(beam.origin.reach()));
        let radius = f64::from(self.radius);
        let aside = [0, 1].map(|i| {
            let middle = center[(axis + 1 + i) % 3];
            (section.low[i] - middle).abs().max((section.high[i] - middle).abs())
        });
        // Written so that NaN is refused.
        let within = aside[0] * aside[0] + aside[1] * aside[1] <= (radius - room) * (radius - room)
            && radius > room
            && (center.max(min).min(max) - center).length() >= radius + room;
        if within { beyond(section.farthest) } else { None }
    }

    #[inline]
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        self.roots(ray, |t, front| found(Crossing::of_solid(t as f32, front)));
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let center = self.center.as_dvec3();
        let t = unrounded(crossing, |found| self.roots(ray, found));
        let point = ray.origin().as_dvec3() + ray.dir().as_dvec3() * t;
        let normal = (point - center).try_normalize().unwrap_or(DVec3::Z);
        // Put back onto the sphere.
        let position = center + normal * f64::from(self.radius);
        let around = DVec3::new(-normal.y, normal.x, 0.0).normalize_or_zero();
        let turn = libm::atan2(normal.y, normal.x) / std::f64::consts::TAU;
        let fall = libm::acos(normal.z.clamp(-1.0, 1.0)) / std::f64::consts::PI;
        let surface = Surface::new(position.as_vec3a(), normal.as_vec3a());
        Surface {
            // The roots of the next ray are off by far less, but not by nothing.
            error: surface.error + self.radius * (f32::EPSILON / 2.0),
            tangent: around.as_vec3a(),
            uv: [(if turn < 0.0 { turn + 1.0 } else { turn }) as f32, fall as f32],
            ..surface
        }
    }
}
