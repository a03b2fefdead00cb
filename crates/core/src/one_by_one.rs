//! Children without any order.

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::children::Children;
use crate::cost::{Cost, CostModel};
use crate::counters::{Own, Site};
use crate::hit::Hit;
use crate::object::Object;
use crate::ray::{Ray, Source};
use crate::scratch::Scratch;
use crate::simd::Level;
use crate::surface::Surface;

/// Tests every child, one after the other. It answers as a list does, keeps nothing but the
/// children and is made at once: for what stands in until something better is built.
#[derive(Clone, Debug)]
pub struct OneByOne<C> {
    children: C,
    bounds: Aabb,
}

impl<C: Children> OneByOne<C> {
    /// All these children.
    #[must_use]
    pub fn new(children: C) -> Self {
        let bounds = (0..children.count())
            .map(|child| children.bounds(child))
            .filter(|bounds| !bounds.is_empty())
            .fold(Aabb::EMPTY, Aabb::join);
        Self { children, bounds }
    }

    /// The children; counts a test of each, if this is the counting level.
    fn counted(&self, ray: &Ray, scratch: &mut Scratch) -> std::ops::Range<u32> {
        let all = 0..self.children.count();
        if let Level::Counting(_) = scratch.level {
            let site = Site::of(self);
            scratch.counters.visit(ray.kind(), site);
            for child in all.clone() {
                scratch.counters.tests(ray.kind(), self.children.kind(child), site, 1);
            }
        }
        all
    }
}

impl<C: Children> Object for OneByOne<C> {
    fn kind(&self) -> &'static str {
        "list"
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        (0..self.children.count())
            .map(|child| self.children.bounds_during(child, time))
            .filter(|bounds| !bounds.is_empty())
            .fold(Aabb::EMPTY, Aabb::join)
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        (0..self.children.count())
            .filter(|&child| !self.children.bounds(child).is_empty())
            .map(|child| self.children.along(child, direction))
            .fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [a, b]| {
                [low.min(a), high.max(b)]
            })
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        let mut found = false;
        for child in self.counted(ray, scratch) {
            found |= self.children.closest_hit(child, ray, hit, scratch);
        }
        found
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.counted(ray, scratch).any(|child| self.children.any_hit(child, ray, scratch))
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        for child in self.counted(ray, scratch) {
            self.children.all_hits(child, ray, hits, scratch);
        }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.children.surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.children.child_of(source).is_some()
    }

    fn paths(&self) -> u32 {
        self.children.paths()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        let (mut cost, mut missed) = (Cost::default(), 1.0);
        for child in 0..self.children.count() {
            let one = self.children.cost(child, model);
            cost = cost.plus(one.nanos(), one.bytes);
            missed *= 1.0 - one.hit_rate;
        }
        let cost = cost.plus(model.call, size_of::<Self>() as u64);
        Cost { hit_rate: 1.0 - missed, ..cost }
    }

    fn own(&self) -> Option<Own> {
        Some(Own { site: Site::of(self), steps: 0.0, tests: self.children.count().into() })
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        self.children.visit(visit);
    }
}
