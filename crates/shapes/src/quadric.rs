//! Quadrics: ellipsoids, paraboloids, hyperboloids, saddles, cones, cut by a box.

use glam::{DMat3, DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::rounding::unrounded;
use crate::shape::{Crossing, Shape, bounds_from, interval_from};

/// The points in a box where `a x² + b y² + c z² + d xy + e yz + f zx + g x + h y + i z + j`
/// is zero. Its front is where that is positive.
///
/// The box cuts: where it opens an ellipsoid, one can look inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    /// Factors of x², y², z².
    pub squares: [f32; 3],
    /// Factors of xy, yz, zx.
    pub products: [f32; 3],
    /// Factors of x, y, z.
    pub linear: [f32; 3],
    /// The rest.
    pub constant: f32,
    /// What is outside is not there. May be [`Aabb::ENDLESS`]: an ellipsoid knows its own
    /// bounds, the others have none.
    pub clip: Aabb,
}

/// The same in doubles: `p · matrix p + linear · p + constant`.
struct Exact {
    matrix: DMat3,
    linear: DVec3,
    constant: f64,
}

impl Quadric {
    /// None if it makes no sense.
    fn exact(&self) -> Option<Exact> {
        let parts = [self.squares, self.products, self.linear];
        let sound = parts.as_flattened().iter().all(|x| x.is_finite())
            && parts.as_flattened().iter().any(|&x| x != 0.0)
            && self.constant.is_finite()
            && !self.clip.is_empty();
        if !sound {
            return None;
        }
        let [[a, b, c], [d, e, f], linear] = parts.map(|part| part.map(f64::from));
        let matrix = DMat3::from_cols(
            DVec3::new(a, d / 2.0, f / 2.0),
            DVec3::new(d / 2.0, b, e / 2.0),
            DVec3::new(f / 2.0, e / 2.0, c),
        );
        Some(Exact { matrix, linear: DVec3::from_array(linear), constant: self.constant.into() })
    }

    /// Every `(t, front)` at which the line meets it.
    fn roots(&self, ray: &Ray, mut found: impl FnMut(f64, bool)) {
        let Some(quadric) = self.exact() else { return };
        let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
        let length = dir.length();
        let dir = dir / length;
        let along = quadric.matrix * dir;
        let square = dir.dot(along);
        // From the point of the line nearest the middle, so that nothing far away is lost in
        // rounding: of the box, or else of the two roots.
        let middle = if self.clip.is_bounded() {
            (self.clip.center().as_dvec3() - origin).dot(dir)
        } else {
            -quadric.gradient(origin).dot(dir) / (2.0 * square)
        };
        let middle = if middle.is_finite() { middle } else { 0.0 };
        let near = origin + dir * middle;
        let half = quadric.gradient(near).dot(dir) / 2.0;
        let constant = quadric.at(near);
        let reach = if self.clip.is_bounded() { f64::from(self.clip.reach()) * 1e-13 } else { 0.0 };
        let (low, high) = (self.clip.min.as_dvec3() - reach, self.clip.max.as_dvec3() + reach);
        let mut offer = |s: f64, front: bool| {
            let point = near + dir * s;
            let t = (middle + s) / length;
            let inside = low.cmple(point).all() && point.cmple(high).all();
            if (t as f32).is_finite() && inside {
                found(t, front);
            }
        };
        let left = half * half - square * constant;
        if left < 0.0 || left.is_nan() {
            return;
        }
        // The root of which no part cancels, and the other from the product of both. Along the
        // ray the value falls at the first of `(-half ∓ root) / square`, and rises at the other.
        let root = left.sqrt();
        if half > 0.0 {
            offer((-half - root) / square, true);
            offer(constant / (-half - root), false);
        } else if half < 0.0 || root > 0.0 {
            offer(constant / (root - half), true);
            offer((root - half) / square, false);
        } else if square != 0.0 {
            offer(0.0, true);
            offer(0.0, false);
        }
    }
}

impl Exact {
    fn at(&self, point: DVec3) -> f64 {
        point.dot(self.matrix * point + self.linear) + self.constant
    }

    fn gradient(&self, point: DVec3) -> DVec3 {
        self.matrix * point * 2.0 + self.linear
    }

    /// The ellipsoid that it is; none if it is not one, or so long that doubles cannot tell.
    fn ellipsoid(&self) -> Option<Ellipsoid> {
        let m = &self.matrix;
        let sign = m.x_axis.x.signum();
        let minor = m.x_axis.x * m.y_axis.y - m.x_axis.y * m.y_axis.x;
        let (volume, size) =
            (m.determinant() * sign, (m.x_axis.x + m.y_axis.y + m.z_axis.z) * sign);
        // 1/27 for a sphere.
        let round = volume / (size * size * size);
        if !(m.x_axis.x != 0.0 && minor > 0.0 && round > 1e-9) {
            return None;
        }
        let inverse = m.inverse();
        let center = inverse * self.linear * -0.5;
        let lift = self.linear.dot(center) / 2.0;
        let rounding = 1e-15 / round;
        // On the surface `(p − center) · matrix (p − center)` is this.
        let level = -(self.constant + lift) * sign + (lift.abs() + self.constant.abs()) * rounding;
        let spread = inverse * (level.max(0.0) * sign * (1.0 + rounding));
        (level >= 0.0).then_some(Ellipsoid { center, spread, rounding })
    }
}

/// How far an ellipsoid reaches.
struct Ellipsoid {
    center: DVec3,
    /// Along a direction it reaches `√(direction · spread direction)` from the centre.
    spread: DMat3,
    /// Relative to the centre and to the reach.
    rounding: f64,
}

impl Ellipsoid {
    fn along(&self, direction: DVec3) -> [f64; 2] {
        let middle = self.center.dot(direction);
        let reach = direction.dot(self.spread * direction).max(0.0).sqrt();
        let half = reach + (reach + self.center.abs().dot(direction.abs())) * self.rounding;
        [middle - half, middle + half]
    }
}

impl Shape for Quadric {
    fn kind(&self) -> &'static str {
        "quadric"
    }

    fn bounds(&self) -> Aabb {
        let Some(quadric) = self.exact() else { return Aabb::EMPTY };
        let Some(ellipsoid) = quadric.ellipsoid() else { return self.clip };
        let [x, y, z] = DVec3::AXES.map(|axis| ellipsoid.along(axis));
        bounds_from([x[0], y[0], z[0]], [x[1], y[1], z[1]]).meet(self.clip)
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let boxed = self.bounds().along(direction);
        let Some(ellipsoid) = self.exact().and_then(|quadric| quadric.ellipsoid()) else {
            return boxed;
        };
        let [low, high] = ellipsoid.along(direction.as_dvec3());
        let own = interval_from(low, high);
        [own[0].max(boxed[0]), own[1].min(boxed[1])]
    }

    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        self.roots(ray, |t, front| found(Crossing::of_solid(t as f32, front)));
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let Some(quadric) = self.exact() else { return Surface::new(ray.at(crossing.t), Vec3A::Z) };
        let t = unrounded(crossing, |found| self.roots(ray, found));
        let mut point = ray.origin().as_dvec3() + ray.dir().as_dvec3() * t;
        // Put back onto the surface.
        for _ in 0..2 {
            let gradient = quadric.gradient(point);
            let step = gradient * (quadric.at(point) / gradient.length_squared());
            point = if step.is_finite() { point - step } else { point };
        }
        let normal = quadric.gradient(point).try_normalize().unwrap_or(DVec3::Z);
        let bounds = self.bounds();
        let center = if bounds.is_bounded() { bounds.center().as_dvec3() } else { DVec3::ZERO };
        let from = (point - center).normalize_or_zero();
        let turn = libm::atan2(from.y, from.x) / std::f64::consts::TAU;
        let fall = libm::acos(from.z.clamp(-1.0, 1.0)) / std::f64::consts::PI;
        let around = DVec3::new(-from.y, from.x, 0.0);
        let surface = Surface::new(point.as_vec3a(), normal.as_vec3a());
        let reach = if bounds.is_bounded() { bounds.reach() } else { 0.0 };
        Surface {
            // The roots of the next ray are off by far less, but not by nothing.
            error: surface.error + reach * (f32::EPSILON / 2.0),
            tangent: (around - normal * around.dot(normal)).normalize_or_zero().as_vec3a(),
            // Normals may point to the center.
            mirrored: normal.dot(from) < 0.0,
            uv: [(if turn < 0.0 { turn + 1.0 } else { turn }) as f32, fall as f32],
            ..surface
        }
    }
}
