//! Parallelograms, rectangles among them.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::outline::pass;
use crate::polygon::{crosses, flat_error};
use crate::rounding::slack;
use crate::shadow::{self, Images};
use crate::shape::{Crossing, NOWHERE, Shape, bounds_from, interval_from};

/// A parallelogram: a corner and the two edges from it. Its front is where `u × v` points.
/// A crossing has its place along the edges, from 0 to 1, as surface coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parallelogram {
    /// Corner.
    pub corner: Vec3A,
    /// First edge.
    pub u: Vec3A,
    /// Second edge.
    pub v: Vec3A,
}

impl Parallelogram {
    /// The corners in turn, in doubles: sums of two `f32` are exact there.
    fn corners(&self) -> [DVec3; 4] {
        let [corner, u, v] = [self.corner, self.u, self.v].map(|x| x.as_dvec3());
        [corner, corner + u, corner + u + v, corner + v]
    }

    /// Normal, as long as the area; none if it cannot be hit.
    fn normal(&self) -> Option<DVec3> {
        let reach = self.corner.abs().max(self.u.abs()).max(self.v.abs());
        let (u, v) = (self.u.as_dvec3(), self.v.as_dvec3());
        let normal = u.cross(v);
        // Written so that NaN is refused. Less area than this is rounding.
        let sound = reach.cmple(Vec3A::splat(Ray::FARTHEST / 4.0)).all()
            && self.corner.is_finite()
            && self.u.is_finite()
            && self.v.is_finite()
            && normal.length_squared() > 1e-28 * u.length_squared() * v.length_squared();
        sound.then_some(normal)
    }

    fn pass(&self, ray: &Ray) -> Option<f64> {
        let corners = self.corners();
        pass(ray, 4, |i| corners[i & 3])
    }

    /// Where on the edges a point is.
    fn uv(&self, point: DVec3, normal: DVec3) -> [f32; 2] {
        let from = point - self.corner.as_dvec3();
        let square = normal.length_squared();
        let u = from.cross(self.v.as_dvec3()).dot(normal) / square;
        let v = self.u.as_dvec3().cross(from).dot(normal) / square;
        [u, v].map(|x| x.clamp(0.0, 1.0) as f32)
    }
}

impl Shape for Parallelogram {
    fn kind(&self) -> &'static str {
        "parallelogram"
    }

    fn bounds(&self) -> Aabb {
        if self.normal().is_none() {
            return Aabb::EMPTY;
        }
        let [a, b, c, d] = self.corners();
        bounds_from(a.min(b).min(c.min(d)).to_array(), a.max(b).max(c.max(d)).to_array())
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        if self.normal().is_none() {
            return NOWHERE;
        }
        let [a, b, c, d] = self.corners().map(|corner| corner.dot(direction.as_dvec3()));
        interval_from(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    }

    fn hull_area(&self) -> f32 {
        self.normal().map_or(0.0, |normal| 2.0 * normal.length() as f32)
    }

    fn touches(&self, cell: &Aabb) -> bool {
        self.normal().is_some_and(|normal| {
            let normal = normal.normalize();
            let height = normal.dot(self.corner.as_dvec3());
            let room = slack(self.bounds().reach());
            crosses(normal, [height - room, height + room], cell)
                && self.bounds().padded().overlaps(cell)
        })
    }

    fn facing(&self, beam: &Beam) -> Facing {
        self.normal().map_or(Facing::Mixed, |normal| shadow::facing(normal.normalize(), beam))
    }

    fn blocks(&self, beam: &Beam) -> Option<f32> {
        let normal = self.normal()?.normalize();
        let corners = self.corners();
        let images = Images::new(beam, corners[0], normal)?;
        let within = (0..4).all(|i| {
            let inward = normal.cross(corners[(i + 1) % 4] - corners[i]).normalize();
            let room = |p: DVec3| slack(p.abs().max_element() as f32);
            images.points.iter().all(|&p| inward.dot(p - corners[i]) >= room(p))
        });
        if within { shadow::beyond(images.farthest) } else { None }
    }

    #[inline]
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        let Some(normal) = self.normal() else { return };
        if let Some(t) = self.pass(ray) {
            let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
            let uv = self.uv(origin + dir * t, normal);
            found(Crossing { t: t as f32, uv, front: normal.dot(dir) < 0.0 });
        }
    }

    fn surface(&self, _ray: &Ray, crossing: &Crossing) -> Surface {
        let [corner, u, v] = [self.corner, self.u, self.v].map(|x| x.as_dvec3());
        let [s, t] = crossing.uv.map(f64::from);
        let normal = u.cross(v).try_normalize().unwrap_or(DVec3::Z);
        let farthest = self.corners().iter().fold(DVec3::ZERO, |far, p| far.max(p.abs()));
        Surface {
            error: flat_error(farthest),
            tangent: u.normalize_or_zero().as_vec3a(),
            mirrored: true,
            uv: crossing.uv,
            ..Surface::new((corner + u * s + v * t).as_vec3a(), normal.as_vec3a())
        }
    }

    fn is_flat(&self) -> bool {
        true
    }
}
