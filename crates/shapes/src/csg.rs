//! Solids made of solids: union, intersection, difference [Roth 82].

mod combine;
mod track;

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::cost::{Cost, CostModel};
use nestray_core::hit::{Hit, InstancePath};
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, Source};
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;

use self::combine::{Change, Merge};
use self::track::{Memory, enters, is_told};
use crate::shape::Sides;

/// What is kept of two solids.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operation {
    /// What is in either.
    Union,
    /// What is in both.
    Intersection,
    /// What is in the left one and not in the right one.
    Difference,
}

/// A solid made of two, which may be such solids again, to any depth.
///
/// Operands are objects with a closed surface whose front is outside: a sphere, a block, an
/// instance, an aggregate over a closed mesh. One that is not bounded works too, such as a
/// plane for the half of space behind it. Parts of one operand should not overlap; where they
/// do, it reaches from the first front to the last back. Hits carry the numbers of the whole,
/// and `u` is 1 where the ray enters it, else 0.
///
/// Where both surfaces are crossed at exactly the same `t`, both change at once: so
/// `(A ∪ B) \ B` is `A \ B`, and nothing is left between a solid and its own surface.
#[derive(Clone, Debug)]
pub struct Csg<L = DynObject, R = DynObject> {
    geometry: u32,
    primitive: u32,
    operation: Operation,
    sides: Sides,
    left: L,
    right: R,
    /// Whether an operand's hits tell by themselves whether they enter it.
    told: [bool; 2],
    bounds: Aabb,
}

impl<L: Object, R: Object> Csg<L, R> {
    /// Combines two solids; hits will be of this primitive of this geometry.
    #[must_use]
    pub fn new(geometry: u32, primitive: u32, operation: Operation, left: L, right: R) -> Self {
        let told = [is_told(&left), is_told(&right)];
        let bounds = operation.bounds(left.bounds(), right.bounds());
        let sides = Sides::Both;
        Self { geometry, primitive, operation, sides, left, right, told, bounds }
    }

    /// The same solid seen from some sides only: where rays enter it, or where they leave it.
    /// One of which not both are seen is no operand of another.
    #[must_use]
    pub fn seen_from(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }

    /// What is kept.
    #[must_use]
    pub fn operation(&self) -> Operation {
        self.operation
    }

    /// The operands.
    #[must_use]
    pub fn operands(&self) -> (&L, &R) {
        (&self.left, &self.right)
    }

    /// Calls `found` with every change along the ray, nearest first, as long as it wants more.
    /// Changes lie within the bounds, where every nest looks.
    fn each_change(
        &self,
        ray: &Ray,
        scratch: &mut Scratch,
        mut found: impl FnMut(&Change) -> bool,
    ) {
        /// Less than techniques allow ([`Clip::SLACK`]), by what two such tests can differ.
        const SLACK: f32 = Clip::SLACK * 0.6;
        if self.bounds.is_empty() {
            return;
        }
        let (mut first, mut last) = (ray.t_min(), ray.t_max());
        if self.bounds.is_bounded() {
            let clip = Clip::with_slack(ray, self.bounds.reach(), SLACK);
            let Some(cut) = clip.cut(&self.bounds, ray.t_max()) else { return };
            (first, last) = cut;
        }
        let within = |change: &Change| change.t <= last && (change.t < first || found(change));
        let whole = ray.whole().leaving(Source::NONE);
        let mut memory = Memory::take();
        let left = memory.left.follow(&self.left, self.told[0], &whole, &mut memory.hits, scratch);
        // Without the left one there is no more than without anything.
        if left || self.operation == Operation::Union {
            memory.right.follow(&self.right, self.told[1], &whole, &mut memory.hits, scratch);
            Merge::new(self.operation, &memory.left, &memory.right).take_while(within);
        }
        memory.give_back();
    }

    /// The same for changes within the range of the ray.
    fn each_hit(&self, ray: &Ray, scratch: &mut Scratch, mut found: impl FnMut(&Hit) -> bool) {
        self.each_change(ray, scratch, |change| {
            if change.t < ray.t_min() || !self.sides.show(change.enters) {
                return true;
            }
            let (u, v) = (f32::from(change.enters), f32::from(change.right));
            let id =
                Hit { geometry: self.geometry, primitive: self.primitive, ..Hit::none(change.t) };
            change.t <= ray.t_max() && found(&Hit { u, v, ..id })
        });
    }

    fn source(&self) -> Source {
        Source { geometry: self.geometry, primitive: self.primitive, path: InstancePath::NONE }
    }
}

/// The surface of the hit of an operand at exactly `t`, preferably one that enters it or not
/// as wanted.
fn surface_at(operand: &dyn Object, ray: &Ray, t: f32, entering: bool) -> Option<Surface> {
    let mut memory = Memory::take();
    memory.hits.clear();
    operand.all_hits(ray, &mut memory.hits, &mut Scratch::new());
    memory.hits.retain(|hit| hit.t == t);
    memory.hits.sort_by_key(Hit::id);
    let surfaces = || memory.hits.iter().filter_map(|hit| operand.surface(ray, hit));
    let fits = surfaces().find(|surface| enters(surface, ray) == entering);
    let surface = fits.or_else(|| surfaces().next());
    memory.give_back();
    surface
}

impl<L: Object, R: Object> Object for Csg<L, R> {
    fn kind(&self) -> &'static str {
        "csg"
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        self.operation.bounds(self.left.bounds_during(time), self.right.bounds_during(time))
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        let (a, b) = (self.left.along(direction), self.right.along(direction));
        match self.operation {
            Operation::Union => [a[0].min(b[0]), a[1].max(b[1])],
            Operation::Intersection => [a[0].max(b[0]), a[1].min(b[1])],
            Operation::Difference => a,
        }
    }

    fn touches(&self, cell: &Aabb) -> bool {
        self.bounds.overlaps(cell) && (self.left.touches(cell) || self.right.touches(cell))
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        let mut nearer = false;
        self.each_hit(ray, scratch, |found| {
            nearer = hit.offer(found.t, [found.u, found.v], found.geometry, found.primitive);
            false
        });
        nearer
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        let mut any = false;
        self.each_hit(ray, scratch, |_| {
            any = true;
            false
        });
        any
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        self.each_hit(ray, scratch, |found| {
            hits.push(*found);
            true
        });
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        if hit.id() != (self.geometry, self.primitive, InstancePath::NONE) {
            return None;
        }
        let whole = ray.whole().leaving(Source::NONE);
        let right = hit.v != 0.0;
        // What is cut out shows its surface from behind.
        let turned = right && self.operation == Operation::Difference;
        let operand: &dyn Object = if right { &self.right } else { &self.left };
        let surface = surface_at(operand, &whole, hit.t, (hit.u != 0.0) != turned)?;
        if !turned {
            return Some(surface);
        }
        let (normal, shading) = (-surface.normal, -surface.shading);
        Some(Surface { normal, shading, mirrored: !surface.mirrored, ..surface })
    }

    fn holds(&self, source: &Source) -> bool {
        *source == self.source()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        let (a, b) = (self.left.cost(model), self.right.cost(model));
        let nanos = a.nanos() + b.nanos() + model.call;
        let rate = match self.operation {
            Operation::Union => 1.0 - (1.0 - a.hit_rate) * (1.0 - b.hit_rate),
            Operation::Intersection => a.hit_rate * b.hit_rate,
            Operation::Difference => a.hit_rate,
        };
        Cost::primitive(nanos, rate, a.bytes + b.bytes + size_of::<Self>() as u64)
    }

    fn settings(&self) -> String {
        format!("{:?}", self.operation)
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        visit(&self.left);
        visit(&self.right);
    }
}
