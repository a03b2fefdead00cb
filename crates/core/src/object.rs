//! What a ray can be tested against.

use std::sync::Arc;

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::beam::{Beam, Facing};
use crate::cost::{Cost, CostModel};
use crate::counters::Own;
use crate::hit::Hit;
use crate::ray::{Ray, RayKind, Source};
use crate::scratch::Scratch;
use crate::surface::Surface;

/// Anything a ray can be tested against: a primitive, an aggregate, an instance.
///
/// One interface for all of them is the whole idea [Arvo 90, §3]: whatever holds
/// an `Object` cannot tell a sphere from a grid of trees.
///
/// Objects do not change while rays fly. Questions with an answer here are optional: the
/// answer given is always right, a better one makes some technique faster.
pub trait Object: Send + Sync {
    /// The word for what it is, in reports and counters: `sphere`, `bvh`, `instance`.
    fn kind(&self) -> &'static str;

    /// A box around everything a ray can hit, over the whole shutter. May be
    /// unbounded, must not be too small; empty if nothing can be hit.
    fn bounds(&self) -> Aabb;

    /// A box around it during a part of the shutter, `[from, to]` within `[0, 1]`.
    fn bounds_during(&self, _time: [f32; 2]) -> Aabb {
        self.bounds()
    }

    /// Whether the box around it at any moment of `time` is, but for rounding, within one whose faces
    /// move evenly from where they are at the beginning to where they are in the end.
    fn moves_evenly(&self, _time: [f32; 2]) -> bool {
        false
    }

    /// The part of [`bounds`](Self::bounds) in which it may touch `cell`; empty if it does
    /// not. For spatial splits.
    fn clipped(&self, cell: &Aabb) -> Aabb {
        self.bounds().meet(*cell)
    }

    /// How far it reaches along `direction`: an interval around every value of
    /// `direction · point`. Answered from the box unless it can do better.
    fn along(&self, direction: Vec3A) -> [f32; 2] {
        self.bounds().along(direction)
    }

    /// Surface area of its convex hull: four times its mean shadow, so the chance that a
    /// random line meets a convex object [Arvo 90, Theorem 2].
    fn hull_area(&self) -> f32 {
        self.bounds().surface_area()
    }

    /// Whether any of it may lie in `cell`. Answered from the box unless it can do
    /// better; never false for something that is there.
    fn touches(&self, cell: &Aabb) -> bool {
        self.bounds().overlaps(cell)
    }

    /// At which distances along the main axis rays of `beam` may meet it; none if none can.
    fn meets(&self, beam: &Beam) -> Option<[f32; 2]> {
        beam.meets(&self.bounds())
    }

    /// The distance along the main axis beyond which no ray of `beam` passes it unblocked,
    /// whichever way it runs: none comes back through it either. None if some may pass, or
    /// nobody knows.
    fn blocks(&self, _beam: &Beam) -> Option<f32> {
        None
    }

    /// Which side it shows to the rays of `beam`.
    fn facing(&self, _beam: &Beam) -> Facing {
        Facing::Mixed
    }

    /// Looks for a hit nearer than `hit.t` (or equally near and of lower id, see
    /// [`Hit::offer`]). On success overwrites `hit` and returns true.
    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool;

    /// Whether anything lies within the range of the ray; stops at the first.
    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.closest_hit(ray, &mut Hit::none(ray.t_max()), scratch)
    }

    /// Appends every hit within the range of the ray, in no order. A hit may come
    /// twice; whoever asks sorts and removes repeats once, at the end.
    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch);

    /// [`closest_hit`](Self::closest_hit) for many rays, one hit each. Aggregates keep many
    /// of them in flight, which hides the memory; prefer this for incoherent rays.
    ///
    /// # Panics
    /// May panic if there are not as many hits as rays.
    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        for (ray, hit) in rays.iter().zip(hits) {
            self.closest_hit(ray, hit, scratch);
        }
    }

    /// [`any_hit`](Self::any_hit) for many rays: sets `blocked` where something is hit, and
    /// leaves the rest as it was.
    ///
    /// # Panics
    /// May panic if there are not as many answers as rays.
    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked = *blocked || self.any_hit(ray, scratch);
        }
    }

    /// [`all_hits`](Self::all_hits) for many rays, one list each.
    fn all_hits_each(&self, rays: &[Ray], hits: &mut [Vec<Hit>], scratch: &mut Scratch) {
        for (ray, hits) in rays.iter().zip(hits) {
            self.all_hits(ray, hits, scratch);
        }
    }

    /// Whether neighbouring rays of a kind are shown to what is inside one by one, where other objects
    /// would keep them together.
    fn parts(&self, _kind: RayKind) -> bool {
        false
    }

    /// What the surface looks like at a hit that this object reported for this ray; none if
    /// the hit is not of it. Primitives answer; aggregates ask their children one after the
    /// other, so a scene that knows its geometries is faster.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface>;

    /// Whether `source` names something in it.
    fn holds(&self, _source: &Source) -> bool {
        false
    }

    /// How many numbers an [`InstancePath`](crate::hit::InstancePath) inside it can have: 1
    /// without instances, for the path that is none.
    fn paths(&self) -> u32 {
        1
    }

    /// Expected cost of one uniformly random ray that meets [`bounds`](Self::bounds).
    fn cost(&self, model: &CostModel) -> Cost;

    /// What it expects to do itself for such a ray, for reports; none if it is no aggregate.
    fn own(&self) -> Option<Own> {
        None
    }

    /// Its settings, for reports; empty if it has none.
    fn settings(&self) -> String {
        String::new()
    }

    /// Shows the direct children, for reports and viewers. Primitives have none.
    fn visit_children(&self, _visit: &mut dyn FnMut(&dyn Object)) {}
}

/// An object of a kind known only at run time, shared by all its parents.
pub type DynObject = Arc<dyn Object>;

/// An object made of other objects: the one extra operation is `add_child`
/// [Kirk 88].
///
/// No aggregate can come to hold itself: a child is finished and shared when it is added,
/// and what is shared cannot be added to any more.
pub trait Aggregate: Object {
    /// Puts an object under this one. It takes part at once: until the next
    /// [`build`](Self::build) new children are simply tested one by one.
    fn add_child(&mut self, child: DynObject);

    /// Puts the children added so far in order.
    fn build(&mut self);
}

/// Passes every question on, for a pointer to an object.
macro_rules! ask_inside {
    () => {
        fn kind(&self) -> &'static str {
            (**self).kind()
        }
        fn bounds(&self) -> Aabb {
            (**self).bounds()
        }
        fn bounds_during(&self, time: [f32; 2]) -> Aabb {
            (**self).bounds_during(time)
        }
        fn moves_evenly(&self, time: [f32; 2]) -> bool {
            (**self).moves_evenly(time)
        }
        fn clipped(&self, cell: &Aabb) -> Aabb {
            (**self).clipped(cell)
        }
        fn along(&self, direction: Vec3A) -> [f32; 2] {
            (**self).along(direction)
        }
        fn hull_area(&self) -> f32 {
            (**self).hull_area()
        }
        fn touches(&self, cell: &Aabb) -> bool {
            (**self).touches(cell)
        }
        fn meets(&self, beam: &Beam) -> Option<[f32; 2]> {
            (**self).meets(beam)
        }
        fn blocks(&self, beam: &Beam) -> Option<f32> {
            (**self).blocks(beam)
        }
        fn facing(&self, beam: &Beam) -> Facing {
            (**self).facing(beam)
        }
        #[inline]
        fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
            (**self).closest_hit(ray, hit, scratch)
        }
        #[inline]
        fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
            (**self).any_hit(ray, scratch)
        }
        fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
            (**self).all_hits(ray, hits, scratch);
        }
        fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
            (**self).closest_hits(rays, hits, scratch);
        }
        fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
            (**self).any_hits(rays, blocked, scratch);
        }
        fn all_hits_each(&self, rays: &[Ray], hits: &mut [Vec<Hit>], scratch: &mut Scratch) {
            (**self).all_hits_each(rays, hits, scratch);
        }
        fn parts(&self, kind: RayKind) -> bool {
            (**self).parts(kind)
        }
        fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
            (**self).surface(ray, hit)
        }
        fn holds(&self, source: &Source) -> bool {
            (**self).holds(source)
        }
        fn paths(&self) -> u32 {
            (**self).paths()
        }
        fn cost(&self, model: &CostModel) -> Cost {
            (**self).cost(model)
        }
        fn own(&self) -> Option<Own> {
            (**self).own()
        }
        fn settings(&self) -> String {
            (**self).settings()
        }
        fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
            (**self).visit_children(visit);
        }
    };
}

impl<O: Object + ?Sized> Object for Arc<O> {
    ask_inside!();
}

impl<O: Object + ?Sized> Object for Box<O> {
    ask_inside!();
}
