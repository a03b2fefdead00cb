//! Bicubic Bézier patches, hit as they are: nothing is cut into triangles.

mod lens;
mod net;
mod place;
mod search;

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use self::net::Net;
use self::place::Place;
use self::search::Search;
use crate::shape::{Crossing, Shape, interval_from};

/// A bicubic Bézier patch.
///
/// Row `i` of the control points goes with `u`, column `j` with `v`, both in `[0, 1]`: the
/// corners `(u, v)` are `points[0][0]` for (0, 0), `points[3][0]` for (1, 0) and
/// `points[0][3]` for (0, 1). Its front is where `∂u × ∂v` points. Edges may be drawn
/// together into a point.
///
/// Patches that share the control points of an edge leave no gap there. A flat patch seen
/// exactly from its side is not hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BezierPatch {
    /// The control points.
    pub points: [[Vec3A; 4]; 4],
}

impl BezierPatch {
    /// The box around the control points, which holds the patch; empty if one is out of range.
    #[must_use]
    pub fn hull(&self) -> Aabb {
        let points = self.points.as_flattened();
        if !points.iter().all(|point| point.abs().cmple(Vec3A::splat(Ray::FARTHEST)).all()) {
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

    /// The point at `(u, v)`.
    #[must_use]
    pub fn at(&self, uv: [f32; 2]) -> Vec3A {
        Place::new(&self.points, uv.map(f64::from)).point.as_vec3a()
    }
}

impl Shape for BezierPatch {
    fn kind(&self) -> &'static str {
        "bezier"
    }

    fn bounds(&self) -> Aabb {
        self.hull()
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let direction = direction.as_dvec3();
        let reach = self.points.as_flattened().iter().map(|point| point.as_dvec3().dot(direction));
        let [low, high] = reach
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        interval_from(low, high)
    }

    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        if self.hull().is_empty() {
            return;
        }
        let net = Net::new(&self.points, ray);
        for root in Search::new(&net).roots() {
            let front = if root.touches {
                let normal = Place::normal(&self.points, root.uv);
                normal.is_some_and(|(normal, _)| normal.dot(ray.dir().as_dvec3()) < 0.0)
            } else {
                (root.turn > 0.0) != net.along
            };
            let t = net.depth(root.uv) as f32;
            if t.is_finite() {
                found(Crossing { t, uv: root.uv.map(|x| x as f32), front });
            }
        }
    }

    fn surface(&self, _ray: &Ray, crossing: &Crossing) -> Surface {
        let uv = crossing.uv.map(f64::from);
        let place = Place::new(&self.points, uv);
        let (normal, tangent) = Place::normal(&self.points, uv).unwrap_or((DVec3::Z, DVec3::X));
        Surface {
            tangent: tangent.as_vec3a(),
            mirrored: true,
            uv: crossing.uv,
            ..Surface::new(place.point.as_vec3a(), normal.as_vec3a())
        }
    }
}

/// For those who keep it elsewhere.
impl Shape for Box<BezierPatch> {
    fn kind(&self) -> &'static str {
        (**self).kind()
    }
    fn bounds(&self) -> Aabb {
        (**self).bounds()
    }
    fn along(&self, direction: Vec3A) -> [f32; 2] {
        (**self).along(direction)
    }
    fn crossings(&self, ray: &Ray, found: impl FnMut(Crossing)) {
        (**self).crossings(ray, found);
    }
    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        (**self).surface(ray, crossing)
    }
}
