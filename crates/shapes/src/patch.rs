//! Smooth patches: polygons that look curved.

use std::sync::Arc;

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::polygon::{Polygon, place};
use crate::shape::{Crossing, Shape};

/// A polygon with a normal at each vertex, blended between them for shading [Phong 75]. What
/// is hit is the polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Patch {
    polygon: Polygon,
    normals: Arc<[[f32; 3]]>,
}

impl Patch {
    /// A patch from the place and the normal of each vertex, see [`Polygon::new`]. Normals may
    /// have any length; zero or NaN is the normal of the polygon.
    #[must_use]
    pub fn new(corners: &[([f32; 3], [f32; 3])]) -> Self {
        let polygon = Polygon::new(corners.iter().map(|corner| corner.0).collect::<Vec<_>>());
        let smooth = |&(_, normal): &([f32; 3], [f32; 3])| {
            place(normal).try_normalize().map_or(polygon.normal(), |n| n.as_vec3a()).to_array()
        };
        let normals = corners.iter().map(smooth).collect();
        Self { polygon, normals }
    }

    /// What is hit.
    #[must_use]
    pub fn polygon(&self) -> &Polygon {
        &self.polygon
    }

    /// The unit normals to shade with, one per vertex.
    #[must_use]
    pub fn normals(&self) -> &[[f32; 3]] {
        &self.normals
    }

    /// The blended normal at a point of the polygon, on the side of its true normal.
    fn shading(&self, point: DVec3) -> Vec3A {
        let normal = self.polygon.normal();
        let mut sum = DVec3::ZERO;
        blend(self.polygon.vertices(), point, normal.as_dvec3(), |vertex, weight| {
            sum += place(self.normals[vertex]) * weight;
        });
        let smooth = sum.try_normalize().map_or(normal, |n| n.as_vec3a());
        if smooth.dot(normal) < 0.0 { -smooth } else { smooth }
    }
}

impl Shape for Patch {
    fn kind(&self) -> &'static str {
        "patch"
    }
    fn bounds(&self) -> Aabb {
        self.polygon.bounds()
    }
    fn along(&self, direction: Vec3A) -> [f32; 2] {
        self.polygon.along(direction)
    }
    fn hull_area(&self) -> f32 {
        self.polygon.hull_area()
    }
    fn touches(&self, cell: &Aabb) -> bool {
        self.polygon.touches(cell)
    }
    fn facing(&self, beam: &Beam) -> Facing {
        self.polygon.facing(beam)
    }
    fn blocks(&self, beam: &Beam) -> Option<f32> {
        self.polygon.blocks(beam)
    }
    #[inline]
    fn crossings(&self, ray: &Ray, found: impl FnMut(Crossing)) {
        self.polygon.crossings(ray, found);
    }
    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        let shading = self.shading(self.polygon.point(ray, crossing));
        Surface { shading, ..self.polygon.surface(ray, crossing) }
    }
    fn is_flat(&self) -> bool {
        true
    }
}

/// Mean value coordinates [Floater 03]: calls `add` with the weight of each vertex, up to a
/// common factor. In a triangle they are the barycentric ones, on an edge they blend its ends.
fn blend(vertices: &[[f32; 3]], point: DVec3, normal: DVec3, mut add: impl FnMut(usize, f64)) {
    let n = vertices.len();
    let spokes: Vec<DVec3> = vertices.iter().map(|&v| place(v) - point).collect();
    // Tangents of half the angles at which edges are seen.
    let mut tangents = Vec::with_capacity(n);
    for (i, &a) in spokes.iter().enumerate() {
        let b = spokes[(i + 1) % n];
        let (from, to) = (a.length(), b.length());
        let across = from * to + a.dot(b);
        // At a vertex or on an edge: the edge alone counts.
        if across <= 1e-12 * from * to {
            let (from, to) = if from + to > 0.0 { (from, to) } else { (1.0, 1.0) };
            add(i, to);
            add((i + 1) % n, from);
            return;
        }
        tangents.push(a.cross(b).dot(normal) / across);
    }
    for (i, spoke) in spokes.iter().enumerate() {
        add(i, (tangents[(i + n - 1) % n] + tangents[i]) / spoke.length());
    }
}
