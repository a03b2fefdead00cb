//! parry3d: a mesh of triangles. It has no query that stops at the first hit.

use nestray_peers::rays::{HitRecord, RayRecord};
use nestray_peers::world::Mesh;
use parry3d::math::Vector;
use parry3d::query::{Ray, RayCast as _};
use parry3d::shape::TriMesh;

use crate::{Built, Peer, Scene};

pub(crate) fn new(mesh: Mesh) -> Box<dyn Peer> {
    let vector = |p: &[f32; 3]| Vector::new(p[0], p[1], p[2]);
    Box::new(Scene::<TriMesh>::Given((mesh.positions.iter().map(vector).collect(), mesh.faces)))
}

fn ray(record: &RayRecord) -> Ray {
    let vector = |p: [f32; 3]| Vector::new(p[0], p[1], p[2]);
    Ray::new(vector(record.origin), vector(record.dir))
}

impl Built for TriMesh {
    type Given = (Vec<Vector>, Vec<[u32; 3]>);

    fn build((positions, faces): Self::Given) -> Self {
        Self::new(positions, faces).expect("there are triangles")
    }

    fn bytes(&self) -> u64 {
        self.total_memory_size() as u64
    }

    #[inline]
    fn closest(&self, record: &RayRecord) -> HitRecord {
        match self.cast_local_ray(&ray(record), record.t_max, false) {
            // It does not say which without working out more.
            Some(t) => HitRecord { t, uv: [0.0; 2], primitive: 0 },
            None => HitRecord::MISS,
        }
    }

    #[inline]
    fn any(&self, record: &RayRecord) -> bool {
        self.cast_local_ray(&ray(record), record.t_max, false).is_some()
    }
}
