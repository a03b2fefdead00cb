//! A closed mesh that rays are tested against now and then.

use nestray_core::aabb::{Aabb, Clip};
use nestray_core::children::Children;
use nestray_core::cost::{Cost, CostModel};
use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, Source};
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;
use nestray_shapes::triangle_mesh::TriangleMesh;

/// Triangles in runs of neighbours, each with a box: enough to look up the surface of a hit that
/// some technique has found, by the same arithmetic.
#[derive(Clone, Debug)]
pub struct Shell {
    mesh: TriangleMesh,
    /// A box around each run, a little larger.
    runs: Vec<Aabb>,
    /// As those of any aggregate over it: a solid asks for them.
    bounds: Aabb,
}

/// Neighbours in a file are mostly neighbours in space.
const RUN: u32 = 32;

impl Shell {
    /// Over a mesh that is not packed.
    #[must_use]
    pub fn new(mesh: TriangleMesh) -> Self {
        let bounds = |run: std::ops::Range<u32>| {
            let boxes = run.map(|triangle| mesh.bounds(triangle));
            boxes.filter(|bounds| !bounds.is_empty()).fold(Aabb::EMPTY, Aabb::join)
        };
        let count = mesh.count();
        let end = |from: u32| from.saturating_add(RUN).min(count);
        let runs: Vec<Aabb> =
            (0..count).step_by(RUN as usize).map(|from| bounds(from..end(from))).collect();
        let present = |run: &&Aabb| !run.is_empty();
        let whole = runs.iter().filter(present).copied().fold(Aabb::EMPTY, Aabb::join);
        let padded = |run: &Aabb| if run.is_empty() { *run } else { run.padded() };
        let runs = runs.iter().map(padded).collect();
        Self { mesh, runs, bounds: whole }
    }
}

impl Object for Shell {
    fn kind(&self) -> &'static str {
        "shell"
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        let mut hits = Vec::new();
        self.all_hits(ray, &mut hits, scratch);
        let offer =
            |found: Hit| hit.offer(found.t, [found.u, found.v], found.geometry, found.primitive);
        hits.into_iter().map(offer).fold(false, |any, nearer| any | nearer)
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        let mut hits = Vec::new();
        self.all_hits(ray, &mut hits, scratch);
        !hits.is_empty()
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        let clip = Clip::new(ray, self.bounds.reach());
        let count = self.mesh.count();
        for (from, run) in (0..count).step_by(RUN as usize).zip(&self.runs) {
            if !run.is_empty() && clip.cut(run, ray.t_max()).is_some() {
                for triangle in from..from.saturating_add(RUN).min(count) {
                    self.mesh.all_hits(triangle, ray, hits, scratch);
                }
            }
        }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.mesh.surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.mesh.child_of(source).is_some()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        let nanos = model.primitive("triangle") * self.runs.len() as f64;
        Cost::primitive(nanos, 0.5, size_of_val::<[Aabb]>(&self.runs) as u64)
    }
}
