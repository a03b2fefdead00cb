//! Planar polygons.

use std::sync::Arc;

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::surface::Surface;

use crate::outline::pass;
use crate::rounding::slack;
use crate::shadow::{self, Images};
use crate::shape::{Crossing, NOWHERE, Shape, interval_from};

/// A polygon with any number of vertices, which may be concave. Polygons that share vertices
/// leave no gap between them.
///
/// A point is inside if a line from it crosses the outline an odd number of times, so where
/// an outline meets itself there are holes. Vertices may be a little off a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    vertices: Arc<[[f32; 3]]>,
    /// Of unit length; zero if the polygon cannot be hit.
    normal: DVec3,
    /// How far the vertices reach along the normal.
    slab: [f64; 2],
}

impl Polygon {
    /// A polygon whose vertices run counter-clockwise seen from its front. With fewer than
    /// three, with a NaN or without an area it is never hit.
    #[must_use]
    pub fn new(vertices: impl Into<Arc<[[f32; 3]]>>) -> Self {
        let vertices = vertices.into();
        let normal = newell(&vertices).unwrap_or(DVec3::ZERO);
        let heights = || vertices.iter().map(|&v| normal.dot(place(v)));
        let slab =
            [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
        Self { vertices, normal, slab }
    }

    /// The vertices in order.
    #[must_use]
    pub fn vertices(&self) -> &[[f32; 3]] {
        &self.vertices
    }

    /// The unit normal of its front, as a whole [Newell 72]; zero if it cannot be hit.
    #[must_use]
    pub fn normal(&self) -> Vec3A {
        self.normal.as_vec3a()
    }

    fn is_sound(&self) -> bool {
        self.normal != DVec3::ZERO
    }

    fn pass(&self, ray: &Ray) -> Option<f64> {
        pass(ray, self.vertices.len(), |i| place(self.vertices[i]))
    }

    /// Where the ray passes through it.
    pub(crate) fn point(&self, ray: &Ray, crossing: &Crossing) -> DVec3 {
        let t = self.pass(ray).unwrap_or(f64::from(crossing.t));
        ray.origin().as_dvec3() + ray.dir().as_dvec3() * t
    }

    /// The first edge that has a length, made one long, and the direction across.
    fn frame(&self) -> [DVec3; 2] {
        let first = place(self.vertices[0]);
        let edge = self.vertices.iter().map(|&v| place(v) - first).find(|e| *e != DVec3::ZERO);
        let edge = edge.unwrap_or(DVec3::X);
        let along = (edge - self.normal * edge.dot(self.normal)).normalize_or_zero();
        [along, self.normal.cross(along)]
    }

    /// Where `point` is in the rectangle around the polygon that has a side along the first
    /// edge: from 0 to 1 both ways.
    fn uv(&self, point: DVec3) -> [f32; 2] {
        self.frame().map(|axis| {
            let [low, high] = reach(&self.vertices, axis);
            ((axis.dot(point) - low) / (high - low)).clamp(0.0, 1.0) as f32
        })
    }

    /// Whether all these points of its plane, and so their hull, see the whole outline from
    /// inside, with some room.
    fn surround(&self, points: &[DVec3], room: f64) -> bool {
        let n = self.vertices.len();
        let size = points.iter().fold(DVec3::ZERO, |size, p| size.max(p.abs())).max_element();
        (0..n).all(|i| {
            let (a, b) = (place(self.vertices[i]), place(self.vertices[(i + 1) % n]));
            let inward = self.normal.cross(b - a);
            let room = (slack(size as f32) + room) * inward.length();
            points.iter().all(|&point| inward.dot(point - a) >= room)
        })
    }
}

impl Shape for Polygon {
    fn kind(&self) -> &'static str {
        "polygon"
    }

    fn bounds(&self) -> Aabb {
        if !self.is_sound() {
            return Aabb::EMPTY;
        }
        self.vertices.iter().fold(Aabb::EMPTY, |all, &v| all.with(Vec3A::from_array(v)))
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        if !self.is_sound() {
            return NOWHERE;
        }
        let [low, high] = reach(&self.vertices, direction.as_dvec3());
        interval_from(low, high)
    }

    fn hull_area(&self) -> f32 {
        if !self.is_sound() {
            return 0.0;
        }
        let [u, v] = self.frame();
        let flat = |&vertex: &[f32; 3]| [u.dot(place(vertex)), v.dot(place(vertex))];
        2.0 * area_of_hull(self.vertices.iter().map(flat).collect()) as f32
    }

    /// The plane is asked before the box: the box takes a look at every vertex.
    fn touches(&self, cell: &Aabb) -> bool {
        crosses(self.normal, self.slab, cell) && self.bounds().padded().overlaps(cell)
    }

    fn facing(&self, beam: &Beam) -> Facing {
        if self.is_sound() { shadow::facing(self.normal, beam) } else { Facing::Mixed }
    }

    fn blocks(&self, beam: &Beam) -> Option<f32> {
        if !self.is_sound() {
            return None;
        }
        let images = Images::new(beam, place(self.vertices[0]), self.normal)?;
        // What is not quite in a plane is seen elsewhere at a slant.
        let depth = (self.slab[1] - self.slab[0]) * images.lean;
        if !self.surround(&images.points, depth) {
            return None;
        }
        // Where an outline runs round twice there is a hole.
        let origin = beam.origin.corner(0);
        let ray = Ray::new(origin, images.points[0].as_vec3a() - origin, RayKind::Custom(0));
        self.pass(&ray).and_then(|_| shadow::beyond(images.farthest + depth))
    }

    #[inline]
    fn crossings(&self, ray: &Ray, mut found: impl FnMut(Crossing)) {
        if !self.is_sound() {
            return;
        }
        if let Some(t) = self.pass(ray) {
            let front = self.normal.dot(ray.dir().as_dvec3()) < 0.0;
            found(Crossing { t: t as f32, uv: [0.0; 2], front });
        }
    }

    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let point = self.point(ray, crossing);
        let farthest = self.vertices.iter().fold(DVec3::ZERO, |far, &v| far.max(place(v).abs()));
        Surface {
            error: flat_error(farthest),
            tangent: self.frame()[0].as_vec3a(),
            mirrored: true,
            uv: self.uv(point),
            ..Surface::new(point.as_vec3a(), self.normal.as_vec3a())
        }
    }

    fn is_flat(&self) -> bool {
        true
    }
}

pub(crate) fn place(vertex: [f32; 3]) -> DVec3 {
    DVec3::from_array(vertex.map(f64::from))
}

/// As far as a neighbour in the same plane may seem off by its own arithmetic.
pub(crate) fn flat_error(farthest: DVec3) -> Vec3A {
    farthest.as_vec3a() * (4.0 * f32::EPSILON)
}

/// Whether a cell meets the slab between two planes, with room for rounding.
pub(crate) fn crosses(normal: DVec3, slab: [f64; 2], cell: &Aabb) -> bool {
    let (min, max) = (cell.min.as_dvec3(), cell.max.as_dvec3());
    let (a, b) = (normal * min, normal * max);
    let room = slack(cell.reach()) * 3.0;
    // An endless cell gives a NaN or an infinity; neither may say no.
    let misses = a.max(b).element_sum() < slab[0] - room || a.min(b).element_sum() > slab[1] + room;
    !misses
}

fn reach(vertices: &[[f32; 3]], direction: DVec3) -> [f64; 2] {
    vertices
        .iter()
        .map(|&v| direction.dot(place(v)))
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// The unit normal of a polygon; none without an area, or out of range.
fn newell(vertices: &[[f32; 3]]) -> Option<DVec3> {
    if !vertices.as_flattened().iter().all(|x| x.abs() <= Ray::FARTHEST) {
        return None;
    }
    let first = place(*vertices.first()?);
    let mut before = place(*vertices.last()?) - first;
    let (mut sum, mut size) = (DVec3::ZERO, 0.0);
    for &vertex in vertices {
        let at = place(vertex) - first;
        sum += before.cross(at);
        size += (at - before).length_squared();
        before = at;
    }
    // Less than this is rounding.
    (sum.length() > 1e-14 * size).then(|| sum.normalize())
}

/// The area of the convex hull of points, found with two chains [Andrew 79].
fn area_of_hull(mut points: Vec<[f64; 2]>) -> f64 {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut hull: Vec<[f64; 2]> = Vec::with_capacity(points.len() + 1);
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let back: Vec<_> = points.iter().rev().skip(1).copied().collect();
    let mut kept = 1;
    for (i, &point) in points.iter().chain(&back).enumerate() {
        if i == points.len() {
            kept = hull.len();
        }
        while hull.len() > kept && turn(hull[hull.len() - 2], hull[hull.len() - 1], point) <= 0.0 {
            hull.pop();
        }
        hull.push(point);
    }
    let doubled: f64 = hull.windows(2).map(|w| turn(hull[0], w[0], w[1])).sum();
    doubled / 2.0
}
