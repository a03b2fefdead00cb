//! Tight bounds around an object that is dear to test.

mod planes;

use std::sync::Arc;

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::beam::{Beam, Facing};
use crate::cost::{Cost, CostModel};
use crate::counters::{Own, Site};
use crate::hit::Hit;
use crate::object::{DynObject, Object};
use crate::ray::{Ray, Source};
use crate::scratch::Scratch;
use crate::simd::Level;
use crate::surface::Surface;

pub use self::planes::Planes;

/// An object behind a fence: a ray that does not come through never reaches it. Answers stay the
/// same; long, thin and flat objects that lie askew are reached far less often than through their
/// boxes [Kay 86].
#[derive(Clone)]
pub struct Fenced {
    object: DynObject,
    planes: Planes,
    /// Of the rays that meet the box of the object, how many come through.
    share: f64,
}

impl Fenced {
    /// The object behind these planes, which are [`around`](Planes::turned_box) it.
    #[must_use]
    pub fn new(object: DynObject, planes: Planes) -> Self {
        let share = planes.share(&object.bounds());
        Self { object, planes, share }
    }

    /// Behind the kind of fence that saves most by these prices; none if none saves anything.
    #[must_use]
    pub fn if_it_pays(object: &DynObject, model: &CostModel) -> Option<DynObject> {
        let cost = object.cost(model).nanos();
        let saves =
            |planes: &Planes| (1.0 - planes.share(&object.bounds())) * cost - planes.price();
        let all = [Planes::turned_box(&**object), Planes::slabs(&**object)];
        let best = all
            .into_iter()
            .flatten()
            .map(|planes| (saves(&planes), planes))
            .filter(|(saves, _)| *saves > 0.0)
            .max_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(_, planes)| Arc::new(Self::new(Arc::clone(object), planes)) as DynObject)
    }

    /// Of the rays that meet the box of the object, how many come through, in `[0, 1]`.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// Whether a ray comes through.
    #[inline]
    fn admits(&self, ray: &Ray, limit: f32, scratch: &mut Scratch) -> bool {
        let admits = self.planes.admit(ray, limit);
        if let Level::Counting(_) = scratch.level {
            let (kind, site) = (ray.kind(), Site::of(self));
            scratch.counters.visit(kind, site);
            if admits {
                scratch.counters.tests(kind, self.object.kind(), site, 1);
            }
        }
        admits
    }

    /// The rays that come through, and which they are.
    fn admitted(
        &self,
        rays: &[Ray],
        limit: impl Fn(usize) -> Option<f32>,
        scratch: &mut Scratch,
    ) -> (Vec<Ray>, Vec<usize>) {
        (0..rays.len())
            .filter(|&i| limit(i).is_some_and(|limit| self.admits(&rays[i], limit, scratch)))
            .map(|i| (rays[i], i))
            .unzip()
    }
}

impl std::fmt::Debug for Fenced {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fenced")
            .field("object", &self.object.kind())
            .field("planes", &self.planes)
            .finish_non_exhaustive()
    }
}

impl Object for Fenced {
    fn kind(&self) -> &'static str {
        "fence"
    }

    fn bounds(&self) -> Aabb {
        self.object.bounds()
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        self.object.bounds_during(time)
    }

    fn moves_evenly(&self, time: [f32; 2]) -> bool {
        self.object.moves_evenly(time)
    }

    fn clipped(&self, cell: &Aabb) -> Aabb {
        self.object.clipped(cell)
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        self.object.along(direction)
    }

    fn hull_area(&self) -> f32 {
        self.object.hull_area()
    }

    fn touches(&self, cell: &Aabb) -> bool {
        self.object.touches(cell)
    }

    fn meets(&self, beam: &Beam) -> Option<[f32; 2]> {
        self.object.meets(beam)
    }

    fn blocks(&self, beam: &Beam) -> Option<f32> {
        self.object.blocks(beam)
    }

    fn facing(&self, beam: &Beam) -> Facing {
        self.object.facing(beam)
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        self.admits(ray, hit.t, scratch) && self.object.closest_hit(ray, hit, scratch)
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.admits(ray, ray.t_max(), scratch) && self.object.any_hit(ray, scratch)
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        if self.admits(ray, ray.t_max(), scratch) {
            self.object.all_hits(ray, hits, scratch);
        }
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        let (inside, which) = self.admitted(rays, |i| Some(hits[i].t), scratch);
        let mut found: Vec<Hit> = which.iter().map(|&i| hits[i]).collect();
        self.object.closest_hits(&inside, &mut found, scratch);
        for (found, &i) in found.into_iter().zip(&which) {
            hits[i] = found;
        }
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        let open = |i: usize| (!blocked[i]).then(|| rays[i].t_max());
        let (inside, which) = self.admitted(rays, open, scratch);
        let mut found = vec![false; inside.len()];
        self.object.any_hits(&inside, &mut found, scratch);
        for (found, &i) in found.into_iter().zip(&which) {
            blocked[i] |= found;
        }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.object.surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.object.holds(source)
    }

    fn paths(&self) -> u32 {
        self.object.paths()
    }

    /// Rays that hit come through, and of the others as many as make up the share.
    fn cost(&self, model: &CostModel) -> Cost {
        let inside = self.object.cost(model);
        let missing = (1.0 - inside.hit_rate).max(f64::MIN_POSITIVE);
        let through = ((self.share - inside.hit_rate) / missing).clamp(0.0, 1.0);
        let bytes = size_of::<Self>() as u64 + self.planes.bytes();
        Cost { miss_nanos: inside.miss_nanos * through, ..inside }.plus(self.planes.price(), bytes)
    }

    fn own(&self) -> Option<Own> {
        Some(Own { site: Site::of(self), steps: 0.0, tests: self.share })
    }

    fn settings(&self) -> String {
        self.planes.settings()
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        visit(&self.object);
    }
}
