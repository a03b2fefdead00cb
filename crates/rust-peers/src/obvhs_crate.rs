//! obvhs: eight-wide compressed and two-wide hierarchies, at its slow preset.

use std::time::Duration;

use glam::Vec3A;
use nestray_peers::rays::{HitRecord, RayRecord};
use nestray_peers::world::Mesh;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::cwbvh::{CwBvh, node::CwBvhNode};
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;

use crate::{Built, Peer, Scene};

pub(crate) fn eight(mesh: Mesh) -> Box<dyn Peer> {
    Box::new(Scene::<Eight>::Given(triangles(&mesh)))
}

pub(crate) fn two(mesh: Mesh) -> Box<dyn Peer> {
    Box::new(Scene::<Two>::Given(triangles(&mesh)))
}

fn triangles(mesh: &Mesh) -> Vec<Triangle> {
    let triangle = |&face: &[u32; 3]| {
        let [v0, v1, v2] = mesh.corners(face).map(Vec3A::from);
        Triangle { v0, v1, v2 }
    };
    mesh.faces.iter().map(triangle).collect()
}

/// Triangles in the order of the leaves, as obvhs advises.
fn ordered(given: &[Triangle], order: &[u32]) -> Vec<RtTriangle> {
    order.iter().map(|&i| RtTriangle::from(&given[i as usize])).collect()
}

fn ray(record: &RayRecord) -> Ray {
    Ray::new(record.origin.into(), record.dir.into(), record.t_min, record.t_max)
}

fn found(hit: &RayHit, order: &[u32]) -> HitRecord {
    HitRecord { t: hit.t, uv: [0.0; 2], primitive: order[hit.primitive_id as usize] }
}

struct Eight {
    tree: CwBvh,
    triangles: Vec<RtTriangle>,
}

struct Two {
    tree: Bvh2,
    triangles: Vec<RtTriangle>,
}

/// Both trees are asked in the same way.
macro_rules! built {
    ($name:ident, $build:ident, $node:ty) => {
        impl Built for $name {
            type Given = Vec<Triangle>;

            fn build(given: Vec<Triangle>) -> Self {
                let mut core_time = Duration::ZERO;
                let tree = $build(&given, BvhBuildParams::slow_build(), &mut core_time);
                let triangles = ordered(&given, &tree.primitive_indices);
                Self { tree, triangles }
            }

            fn bytes(&self) -> u64 {
                let order = size_of_val(self.tree.primitive_indices.as_slice());
                let triangles = size_of_val(self.triangles.as_slice());
                (self.tree.nodes.len() * size_of::<$node>() + order + triangles) as u64
            }

            #[inline]
            fn closest(&self, record: &RayRecord) -> HitRecord {
                let mut hit = RayHit::none();
                let test = |ray: &Ray, id: usize| self.triangles[id].intersect(ray);
                if self.tree.ray_traverse(ray(record), &mut hit, test) {
                    found(&hit, &self.tree.primitive_indices)
                } else {
                    HitRecord::MISS
                }
            }

            #[inline]
            fn any(&self, record: &RayRecord) -> bool {
                let test = |ray: &Ray, id: usize| self.triangles[id].intersect(ray);
                !self.tree.ray_traverse_miss(ray(record), test)
            }
        }
    };
}

built!(Eight, build_cwbvh_from_tris, CwBvhNode);
built!(Two, build_bvh2_from_tris, Bvh2Node);
