//! Tori.

mod quartic;

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use self::quartic::Quartic;
use crate::rounding::unrounded;
use crate::shape::{Crossing, Shape, bounds_from, interval_from};

/// A torus: a tube around a circle; closed.
///
/// Both radii are positive. A tube thicker than its circle meets itself; of that only the
/// outside is there, as of an apple.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Centre.
    pub center: Vec3A,
    /// Axis of the circle, of any length but zero.
    pub axis: Vec3A,
    /// Radius of the circle, from the centre to the middle of the tube.
    pub major: f32,
    /// Radius of the tube.
    pub minor: f32,
}

/// The same in doubles, the axis a unit one.
struct Exact {
    center: DVec3,
    axis: DVec3,
    major: f64,
    minor: f64,
}

impl Torus {
    /// None if it makes no sense.
    fn exact(&self) -> Option<Exact> {
        let sound = |radius: f32| radius > 0.0 && radius <= Ray::FARTHEST;
        let axis = self.axis.as_dvec3().try_normalize()?;
        let [major, minor] = [self.major, self.minor].map(f64::from);
        (sound(self.major)
            && sound(self.minor)
            && self.center.abs().cmple(Vec3A::splat(Ray::FARTHEST)).all())
        .then(|| Exact { center: self.center.as_dvec3(), axis, major, minor })
    }

    /// Seen from the point of the line nearest the centre and with everything within reach
    /// of 1, the quartic has no cubic term and coefficients without cancellation.
    fn roots(&self, ray: &Ray, mut found: impl FnMut(f64, bool)) {
        let Some(torus) = self.exact() else { return };
        let reach = torus.major + torus.minor;
        let dir = ray.dir().as_dvec3();
        let length = dir.length();
        let dir = dir / length;
        let from = ray.origin().as_dvec3() - torus.center;
        let first = -from.dot(dir);
        let near = from + dir * first;
        // Once more: the first step was rounded as a long one.
        let second = -near.dot(dir);
        let near = (near + dir * second) / reach;
        let (major, minor) = (torus.major / reach, torus.minor / reach);
        let apart = near.length_squared();
        if apart > 1.0 {
            return;
        }
        let (slope, height) = (dir.dot(torus.axis), near.dot(torus.axis));
        let shift = apart + (major - minor) * (major + minor);
        let four = 4.0 * major * major;
        let quartic = Quartic {
            square: 2.0 * shift - four * (1.0 - slope * slope),
            linear: 2.0 * four * height * slope,
            constant: shift * shift - four * (apart - height * height),
        };
        // The ball around the torus, and a hair.
        let limit = (1.0 - apart).sqrt() + 1e-9;
        quartic.each_root(limit, |root, falling| {
            // The rest is the part of the tube that the tube hides.
            if major >= minor || root * root + shift >= 0.0 {
                found((first + (second + root * reach)) / length, falling);
            }
        });
    }
}

impl Exact {
    /// Along the axis, and away from it: height, distance and direction.
    fn around(&self, point: DVec3) -> (f64, f64, DVec3) {
        let from = point - self.center;
        let height = from.dot(self.axis);
        let away = from - self.axis * height;
        let distance = away.length();
        let outwards =
            if distance > 0.0 { away / distance } else { self.axis.any_orthonormal_vector() };
        (height, distance, outwards)
    }
}

impl Shape for Torus {
    fn kind(&self) -> &'static str {
        "torus"
    }

    fn bounds(&self) -> Aabb {
        let Some(torus) = self.exact() else { return Aabb::EMPTY };
        let across = (DVec3::ONE - torus.axis * torus.axis).max(DVec3::ZERO).map(f64::sqrt);
        // A hair more, for the rounding of the root.
        let half = (across * torus.major + torus.minor) * (1.0 + 1e-14);
        bounds_from((torus.center - half).to_array(), (torus.center + half).to_array())
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let Some(torus) = self.exact() else { return self.bounds().along(direction) };
        let direction = direction.as_dvec3();
        let across = direction - torus.axis * direction.dot(torus.axis);
        let middle = torus.center.dot(direction);
        let half = across.length() * torus.major + direction.length() * torus.minor;
        let slack = (half + torus.center.abs().dot(direction.abs())) * 1e-14;
        interval_from(middle - half - slack, middle + half + slack)
    }

    /// The outer half of the tube, and the two discs that close the hole.
    fn hull_area(&self) -> f32 {
        let Some(torus) = self.exact() else { return 0.0 };
        let (major, minor, pi) = (torus.major, torus.minor, std::f64::consts::PI);
        (2.0 * pi * (minor * (pi * major + 2.0 * minor) + major * major)) as f32
    }

    /// By the distance of the middle of the cell from the tube: neither the hole nor the
    /// inside of the tube touches it.
    fn touches(&self, cell: &Aabb) -> bool {
        let Some(torus) = self.exact() else { return false };
        if !self.bounds().overlaps(cell) || !cell.is_bounded() {
            return self.bounds().overlaps(cell);
        }
        let half = (cell.max.as_dvec3() - cell.min.as_dvec3()).length() / 2.0;
        let (height, distance, _) = torus.around((cell.min.as_dvec3() + cell.max.as_dvec3()) / 2.0);
        let from_circle = DVec3::new(distance - torus.major, height, 0.0).length();
        let slack = 1e-5 * (torus.major + torus.minor + f64::from(self.center.abs().max_element()));
        (from_circle - torus.minor).abs() <= half + slack
    }

    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        self.roots(ray, |t, front| found(Crossing::of_solid(t as f32, front)));
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let Some(torus) = self.exact() else { return Surface::new(ray.at(crossing.t), Vec3A::Z) };
        let t = unrounded(crossing, |found| self.roots(ray, found));
        let point = ray.origin().as_dvec3() + ray.dir().as_dvec3() * t;
        let (_, _, outwards) = torus.around(point);
        let middle = torus.center + outwards * torus.major;
        let normal = (point - middle).try_normalize().unwrap_or(torus.axis);
        // Put back onto the tube.
        let position = middle + normal * torus.minor;
        let (x, y) = torus.axis.any_orthonormal_pair();
        let turn = |y: f64, x: f64| {
            let turn = libm::atan2(y, x) / std::f64::consts::TAU;
            (if turn < 0.0 { turn + 1.0 } else { turn }) as f32
        };
        let around = turn(outwards.dot(y), outwards.dot(x));
        let tube = turn(normal.dot(torus.axis), normal.dot(outwards));
        // The way `turn` grows, seen along the axis.
        let tangent = x.cross(y).cross(outwards).normalize_or_zero();
        let surface = Surface::new(position.as_vec3a(), normal.as_vec3a());
        Surface {
            // The roots of the next ray are off by far less, but not by nothing.
            error: surface.error + (self.major + self.minor) * (f32::EPSILON / 2.0),
            tangent: tangent.as_vec3a(),
            mirrored: true,
            uv: [around, tube],
            ..surface
        }
    }
}
