//! The aggregate object: a technique over children.

mod barrel;
mod divide;
mod few;
mod leaf;
mod members;
mod method;
mod packets;
mod single;

use std::sync::OnceLock;

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::children::Children;
use crate::cost::{Cost, CostModel};
use crate::counters::{Own, Site};
use crate::dispatch;
use crate::hit::Hit;
use crate::object::{Aggregate, DynObject, Object};
use crate::ray::{Ray, RayKind, Source};
use crate::scratch::Scratch;
use crate::simd::Level;
use crate::surface::Surface;
use crate::technique::{Expected, Index, Leaves, Technique};

use self::members::Members;
use self::method::Method;

pub use self::divide::{Division, divide};

/// An aggregate: children `C` that some technique put in order, as an index `I`. Every
/// technique becomes an object through this one type.
#[derive(Debug)]
pub struct Accel<I: Index, C: Children> {
    technique: Box<dyn Method<I>>,
    /// None while there is nothing to put in order.
    index: Option<I>,
    /// Leaves of children that are not packed: a length, then that many numbers of members,
    /// at each place that a leaf is called by.
    table: Vec<u32>,
    /// The children in the index, and what each is called there.
    members: Members<C>,
    /// What the technique expects; of packed children only the sum, as the first.
    expected: Expected,
    /// Children no box can hold, tested for every ray.
    unbounded: Vec<u32>,
    /// Children from here on were added after the last build.
    built: u32,
    /// Whether there are children outside the index.
    is_loose: bool,
    bounds: Aabb,
    /// What it costs by the usual prices: asked by every parent, and asking all below it
    /// again each time would take forever in a deep hierarchy of instances.
    usual_cost: OnceLock<Cost>,
}

impl<I: Index, C: Children> Accel<I, C> {
    /// Puts `children` in order. An empty collection is fine: nothing is hit.
    #[must_use]
    pub fn new<T: Technique<Index = I>>(technique: T, children: C) -> Self {
        let mut accel = Self {
            technique: Box::new(technique),
            index: None,
            table: Vec::new(),
            members: Members::unnamed(children),
            expected: Expected::default(),
            unbounded: Vec::new(),
            built: 0,
            is_loose: false,
            bounds: Aabb::EMPTY,
            usual_cost: OnceLock::new(),
        };
        accel.rebuild();
        accel
    }

    /// The index, if there is anything to put in order; for reports and tests.
    pub fn index(&self) -> Option<&I> {
        self.index.as_ref()
    }

    /// The collection.
    pub fn children(&self) -> &C {
        &self.members.children
    }

    /// What the index expects of a random ray.
    pub fn expected(&self) -> &Expected {
        &self.expected
    }

    fn rebuild(&mut self) {
        self.usual_cost = OnceLock::new();
        self.built = self.members.children.count();
        (self.bounds, self.unbounded) = self.members.name();
        self.is_loose = !self.unbounded.is_empty();
        (self.index, self.table) = (None, Vec::new());
        if self.members.names.count() == 0 {
            return;
        }
        let mut leaves = Leaves::default();
        let mut index = self.technique.build(&self.members, &mut leaves);
        self.expected = index.expected(&self.members, &leaves);
        if C::PACKED && !I::LISTS {
            self.expected.tests = vec![self.expected.tests.iter().sum()];
            index.rename_leaves(&self.members.children.pack(&leaves, &self.members.names));
        } else {
            leaves.sort_by(&self.members.promises());
            let (table, leaves) = leaves.into_table();
            self.table = table;
            index.rename_leaves(&leaves);
        }
        self.index = Some(index);
    }

    /// Children outside the index: unbounded, or added since the last build.
    #[inline(always)]
    fn loose(&self) -> impl Iterator<Item = u32> + '_ {
        self.unbounded.iter().copied().chain(self.built..self.members.children.count())
    }

    /// What one random ray costs, children outside the index included, and all memory.
    fn whole_cost(&self, model: &CostModel) -> Cost {
        let mut cost = match &self.index {
            Some(index) => self.index_cost(index, model),
            None => Cost::default(),
        };
        for child in self.loose() {
            let one = self.members.children.cost(child, model);
            cost = cost.plus(one.nanos(), one.bytes);
        }
        cost.plus(model.call, size_of::<Self>() as u64)
    }

    /// What one random ray costs in the index, and its memory.
    fn index_cost(&self, index: &I, model: &CostModel) -> Cost {
        let children = &self.members.children;
        let mut bytes = index.bytes() + children.packed_bytes();
        bytes += size_of_val(self.table.as_slice()) as u64 + self.members.names.bytes();
        let mut nanos = self.expected.steps * model.step(self.technique.name());
        let mut missed = 1.0;
        if C::PACKED && !I::LISTS {
            nanos += f64::from(self.expected.tests[0]) * children.cost(0, model).nanos();
            missed = 0.5;
        } else {
            for (number, &tests) in (0..).zip(&self.expected.tests) {
                let cost = children.cost(self.members.names.child(number), model);
                nanos += f64::from(tests) * cost.nanos();
                missed *= 1.0 - (f64::from(tests) * cost.hit_rate).min(1.0);
                bytes += cost.bytes;
            }
        }
        // A ray that hits stops on the way: on average half way [Arvo 90].
        Cost { hit_nanos: nanos / 2.0, miss_nanos: nanos, hit_rate: 1.0 - missed, bytes }
    }
}

impl<I: Index, C: Children> Object for Accel<I, C> {
    fn kind(&self) -> &'static str {
        self.technique.name()
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        let children = &self.members.children;
        (0..children.count())
            .map(|child| children.bounds_during(child, time))
            .filter(|bounds| !bounds.is_empty())
            .fold(Aabb::EMPTY, Aabb::join)
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let children = &self.members.children;
        let none = [f32::INFINITY, f32::NEG_INFINITY];
        (0..children.count())
            .filter(|&child| !children.bounds(child).is_empty())
            .map(|child| children.along(child, direction))
            .fold(none, |[low, high], [a, b]| [low.min(a), high.max(b)])
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        dispatch!(scratch.level, simd => self.closest(simd, ray, hit, scratch))
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        dispatch!(scratch.level, simd => self.any(simd, ray, scratch))
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        dispatch!(scratch.level, simd => self.all(simd, ray, hits, scratch));
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        assert_eq!(rays.len(), hits.len(), "one hit per ray");
        if let Level::Counting(simd) = scratch.level {
            for (ray, hit) in rays.iter().zip(hits) {
                self.closest(simd, ray, hit, scratch);
            }
            return;
        }
        for child in self.loose() {
            self.members.children.closest_hits(child, rays, hits, scratch);
        }
        if let Some(index) = &self.index {
            let out = (hits, &mut [][..]);
            dispatch!(scratch.level, simd =>
                self.batch::<_, false>(simd, index, rays, out, scratch));
        }
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        assert_eq!(rays.len(), blocked.len(), "one answer per ray");
        if let Level::Counting(simd) = scratch.level {
            for (ray, blocked) in rays.iter().zip(blocked) {
                *blocked = *blocked || self.any(simd, ray, scratch);
            }
            return;
        }
        for child in self.loose() {
            self.members.children.any_hits(child, rays, blocked, scratch);
        }
        if let Some(index) = &self.index {
            let out = (&mut [][..], blocked);
            dispatch!(scratch.level, simd =>
                self.batch::<_, true>(simd, index, rays, out, scratch));
        }
    }

    fn parts(&self, kind: RayKind) -> bool {
        I::LEADS && self.index.as_ref().is_some_and(|index| !index.leads(kind))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.members.children.surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.members.children.child_of(source).is_some()
    }

    fn paths(&self) -> u32 {
        self.members.children.paths()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        if std::ptr::eq(model, CostModel::usual()) {
            return *self.usual_cost.get_or_init(|| self.whole_cost(model));
        }
        self.whole_cost(model)
    }

    fn own(&self) -> Option<Own> {
        let tests = self.expected.tests.iter().map(|&tests| f64::from(tests)).sum::<f64>();
        let loose = self.loose().count() as f64;
        Some(Own { site: Site::of(self), steps: self.expected.steps, tests: tests + loose })
    }

    fn settings(&self) -> String {
        self.technique.settings()
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        self.members.children.visit(visit);
    }
}

impl<I: Index> Aggregate for Accel<I, Vec<DynObject>> {
    fn add_child(&mut self, child: DynObject) {
        self.usual_cost = OnceLock::new();
        self.is_loose = true;
        let bounds = child.bounds();
        if !bounds.is_empty() {
            self.bounds = self.bounds.join(bounds);
        }
        self.members.children.push(child);
    }

    fn build(&mut self) {
        self.rebuild();
    }
}
