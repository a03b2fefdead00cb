//! An object built when the first ray comes.

use std::fmt;

use crate::aabb::Aabb;
use crate::cost::{Cost, CostModel};
use crate::hit::Hit;
use crate::object::Object;
use crate::ray::{Ray, Source};
use crate::scratch::Scratch;
use crate::slot::Slot;
use crate::surface::Surface;

/// Answers by a stand-in until it is built. The first ray that asks builds it; others that
/// come meanwhile are answered by the stand-in and do not wait. Shared instances share it,
/// and so it is built once for all of them.
pub struct Lazy<O, S> {
    /// Holds the same geometry, cheap to make and slow to search: a list.
    stand_in: S,
    build: Box<dyn Fn() -> O + Send + Sync>,
    built: Slot<O>,
}

impl<O: Object, S: Object> Lazy<O, S> {
    /// `build` must make an object that answers as `stand_in` does; it is called once at most.
    #[must_use]
    pub fn new(stand_in: S, build: impl Fn() -> O + Send + Sync + 'static) -> Self {
        Self { stand_in, build: Box::new(build), built: Slot::new() }
    }

    /// Whether it has been built.
    pub fn is_built(&self) -> bool {
        self.built.get().is_some()
    }

    /// What answers now, building it if nobody has begun to.
    #[inline]
    fn now(&self) -> &dyn Object {
        self.built
            .get_or_make(|| (self.build)())
            .map_or(&self.stand_in as &dyn Object, |built| built)
    }

    /// What answers now, without building.
    fn so_far(&self) -> &dyn Object {
        self.built.get().map_or(&self.stand_in as &dyn Object, |built| built)
    }
}

impl<O, S: fmt::Debug> fmt::Debug for Lazy<O, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Lazy")
            .field("stand_in", &self.stand_in)
            .field("built", &self.built.get().is_some())
            .finish_non_exhaustive()
    }
}

impl<O: Object, S: Object> Object for Lazy<O, S> {
    fn kind(&self) -> &'static str {
        "lazy"
    }

    fn bounds(&self) -> Aabb {
        self.stand_in.bounds()
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        self.stand_in.bounds_during(time)
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        self.now().closest_hit(ray, hit, scratch)
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.now().any_hit(ray, scratch)
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        self.now().all_hits(ray, hits, scratch);
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        self.now().closest_hits(rays, hits, scratch);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        self.now().any_hits(rays, blocked, scratch);
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.so_far().surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.so_far().holds(source)
    }

    fn paths(&self) -> u32 {
        self.stand_in.paths()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        self.so_far().cost(model)
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        visit(self.so_far());
    }
}
