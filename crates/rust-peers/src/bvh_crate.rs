//! The crate called bvh: it shows candidates, nearest boxes first; the triangle test is ours.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::{Bvh, BvhNode};
use bvh::ray::Ray;
use glam::Vec3;
use nalgebra::{Point3, Vector3};
use nestray_peers::rays::{HitRecord, RayRecord};
use nestray_peers::world::Mesh;

use crate::{Built, Peer, Scene};

pub(crate) fn new(mesh: Mesh) -> Box<dyn Peer> {
    let corners = mesh.faces.iter().map(|&face| mesh.corners(face));
    let triangle = |corners: [[f32; 3]; 3]| Triangle { corners: corners.map(Vec3::from), node: 0 };
    Box::new(Scene::<Tree>::Given(corners.map(triangle).collect()))
}

struct Tree {
    tree: Bvh<f32, 3>,
    triangles: Vec<Triangle>,
}

struct Triangle {
    corners: [Vec3; 3],
    node: usize,
}

impl Bounded<f32, 3> for Triangle {
    fn aabb(&self) -> Aabb<f32, 3> {
        let [a, b, c] = self.corners;
        let point = |v: Vec3| Point3::new(v.x, v.y, v.z);
        Aabb::with_bounds(point(a.min(b).min(c)), point(a.max(b).max(c)))
    }
}

impl BHShape<f32, 3> for Triangle {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Triangle {
    /// By two edges and their cross products, as Möller and Trumbore do.
    #[inline]
    fn distance(&self, origin: Vec3, dir: Vec3) -> Option<f32> {
        let [a, b, c] = self.corners;
        let (e1, e2) = (b - a, c - a);
        let p = dir.cross(e2);
        let inverse = 1.0 / e1.dot(p);
        let s = origin - a;
        let (u, q) = (s.dot(p) * inverse, s.cross(e1));
        let v = dir.dot(q) * inverse;
        let t = e2.dot(q) * inverse;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0).then_some(t)
    }
}

/// Its rays have directions of length one; so their distances count otherwise.
fn ray(record: &RayRecord) -> Ray<f32, 3> {
    Ray::new(Point3::from(record.origin), Vector3::from(record.dir))
}

impl Built for Tree {
    type Given = Vec<Triangle>;

    fn build(mut triangles: Vec<Triangle>) -> Self {
        let tree = Bvh::build(&mut triangles);
        Self { tree, triangles }
    }

    fn bytes(&self) -> u64 {
        let nodes = self.tree.nodes.len() * size_of::<BvhNode<f32, 3>>();
        (nodes + size_of_val(self.triangles.as_slice())) as u64
    }

    #[inline]
    fn closest(&self, record: &RayRecord) -> HitRecord {
        let (origin, dir) = (Vec3::from(record.origin), Vec3::from(record.dir));
        let (ray, length) = (ray(record), dir.length());
        let mut best = HitRecord { t: record.t_max, ..HitRecord::MISS };
        for triangle in self.tree.nearest_traverse_iterator(&ray, &self.triangles) {
            let entry = ray.intersection_slice_for_aabb(&triangle.aabb());
            // All later boxes begin farther away; what rounding hides is a millionth.
            if entry.is_some_and(|(entry, _)| entry > best.t * length * 1.000_001) {
                break;
            }
            if let Some(t) = triangle.distance(origin, dir).filter(|&t| t < best.t) {
                best = HitRecord { t, uv: [0.0; 2], primitive: 0 };
            }
        }
        if best.primitive == HitRecord::MISS.primitive { HitRecord::MISS } else { best }
    }

    #[inline]
    fn any(&self, record: &RayRecord) -> bool {
        let (origin, dir) = (Vec3::from(record.origin), Vec3::from(record.dir));
        let ray = ray(record);
        let mut candidates = self.tree.traverse_iterator(&ray, &self.triangles);
        candidates.any(|one| one.distance(origin, dir).is_some_and(|t| t <= record.t_max))
    }
}
