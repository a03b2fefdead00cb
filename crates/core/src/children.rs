//! The collection an aggregate is built over.

mod objects;

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::beam::{Beam, Facing};
use crate::cost::{Cost, CostModel};
use crate::hit::Hit;
use crate::names::Names;
use crate::object::Object;
use crate::packet::Packet;
use crate::ray::{Ray, Source};
use crate::scratch::Scratch;
use crate::simd::Simd;
use crate::surface::Surface;
use crate::technique::{Leaf, Leaves};

/// An indexed collection of things to test: a `Vec` of objects, or the triangles
/// of a mesh without an object for each. Children are numbered from 0.
///
/// This is where static and dynamic nesting meet. `Vec<DynObject>` pays one
/// virtual call per child, `Vec<Bvh<_>>` none, and a triangle mesh is tested in
/// packed blocks, all through the same [`Accel`](crate::accel::Accel).
///
/// The questions are those of [`Object`], asked of one child.
pub trait Children: Send + Sync {
    /// Whether it copies its members into leaf order ([`pack`](Self::pack)) and is then
    /// tested leaf by leaf instead of child by child.
    const PACKED: bool = false;

    /// What is worth working out once per ray.
    type Probe: Copy + Default + Send;

    /// What is worth working out once per packet of rays.
    type Probes: Default;

    /// How many there are.
    fn count(&self) -> u32;

    /// [`Object::kind`] for one child.
    fn kind(&self, child: u32) -> &'static str;

    /// A box around one child, from its data as stored (not recomputed): a vertex
    /// on a face must be inside. Empty if the child can never be hit.
    fn bounds(&self, child: u32) -> Aabb;

    /// [`Object::bounds_during`] for one child.
    fn bounds_during(&self, child: u32, _time: [f32; 2]) -> Aabb {
        self.bounds(child)
    }

    /// [`Object::moves_evenly`] for one child.
    fn moves_evenly(&self, _child: u32, _time: [f32; 2]) -> bool {
        false
    }

    /// [`Object::clipped`] for one child.
    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb {
        self.bounds(child).meet(*cell)
    }

    /// [`Object::along`] for one child.
    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2] {
        self.bounds(child).along(direction)
    }

    /// [`Object::touches`] for one child.
    fn touches(&self, child: u32, cell: &Aabb) -> bool {
        self.bounds(child).overlaps(cell)
    }

    /// [`Object::meets`] for one child.
    fn meets(&self, child: u32, beam: &Beam) -> Option<[f32; 2]> {
        beam.meets(&self.bounds(child))
    }

    /// [`Object::blocks`] for one child.
    fn blocks(&self, _child: u32, _beam: &Beam) -> Option<f32> {
        None
    }

    /// [`Object::facing`] for one child.
    fn facing(&self, _child: u32, _beam: &Beam) -> Facing {
        Facing::Mixed
    }

    /// Expected cost of testing one child with a ray that meets its box.
    fn cost(&self, child: u32, model: &CostModel) -> Cost;

    /// [`Object::closest_hit`] for one child.
    fn closest_hit(&self, child: u32, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool;

    /// [`Object::any_hit`] for one child.
    fn any_hit(&self, child: u32, ray: &Ray, scratch: &mut Scratch) -> bool;

    /// [`Object::all_hits`] for one child.
    fn all_hits(&self, child: u32, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch);

    /// [`Object::closest_hits`] for one child.
    fn closest_hits(&self, child: u32, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        for (ray, hit) in rays.iter().zip(hits) {
            self.closest_hit(child, ray, hit, scratch);
        }
    }

    /// [`Object::any_hits`] for one child.
    fn any_hits(&self, child: u32, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked = *blocked || self.any_hit(child, ray, scratch);
        }
    }

    /// [`Object::surface`] for whichever child the hit is of.
    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface>;

    /// The child that `source` lies on.
    fn child_of(&self, _source: &Source) -> Option<u32> {
        None
    }

    /// Whether `source` lies on one child: quicker than to find out on which it lies.
    fn holds(&self, child: u32, source: &Source) -> bool {
        self.child_of(source) == Some(child)
    }

    /// [`Object::paths`] of all children together.
    fn paths(&self) -> u32 {
        1
    }

    /// Lays its members out leaf after leaf and says what each leaf is called from now on.
    /// `names` maps the numbers in `leaves` to children.
    ///
    /// # Panics
    /// If the collection is not [`PACKED`](Self::PACKED); so do the other questions about
    /// packed leaves.
    fn pack(&mut self, _leaves: &Leaves, _names: &Names) -> Vec<Leaf> {
        unreachable!("not packed")
    }

    /// Works out the probe of a ray.
    fn probe(&self, ray: &Ray) -> Self::Probe;

    /// [`Object::closest_hit`] for a packed leaf.
    fn closest_in_leaf<S: Simd>(
        &self,
        _simd: S,
        _leaf: Leaf,
        _probe: &Self::Probe,
        _hit: &mut Hit,
    ) -> bool {
        unreachable!("not packed")
    }

    /// [`Object::any_hit`] for a packed leaf, up to `t_max`.
    fn any_in_leaf<S: Simd>(
        &self,
        _simd: S,
        _leaf: Leaf,
        _probe: &Self::Probe,
        _t_max: f32,
    ) -> bool {
        unreachable!("not packed")
    }

    /// [`Object::all_hits`] for a packed leaf, up to `t_max`.
    fn all_in_leaf<S: Simd>(
        &self,
        _simd: S,
        _leaf: Leaf,
        _probe: &Self::Probe,
        _t_max: f32,
        _hits: &mut Vec<Hit>,
    ) {
        unreachable!("not packed")
    }

    /// Works out the probes of a packet, made of `rays`.
    fn probe_all<S: Simd>(
        &self,
        _simd: S,
        _packet: &Packet,
        _rays: &[Ray],
        _probes: &mut Self::Probes,
    ) {
    }

    /// [`Object::closest_hit`] for a packed leaf and those rays of a packet that are in `mask`;
    /// their limits shrink. `hits` are those from before the packet: new ones are
    /// [told](Self::tell_hits) in the end.
    fn closest_in_leaf_by<S: Simd>(
        &self,
        _simd: S,
        _leaf: Leaf,
        _mask: u32,
        _packet: &mut Packet,
        _probes: &mut Self::Probes,
        _hits: &[Hit],
    ) {
        unreachable!("not packed")
    }

    /// Replaces the hits of those rays of a packet that have hit something.
    fn tell_hits(&self, _packet: &Packet, _probes: &Self::Probes, _hits: &mut [Hit]) {}

    /// [`Object::any_hit`] for a packed leaf and those rays of a packet that are in `mask`: those
    /// that hit something, whose limits become −∞.
    fn any_in_leaf_by<S: Simd>(
        &self,
        _simd: S,
        _leaf: Leaf,
        _mask: u32,
        _packet: &mut Packet,
        _probes: &mut Self::Probes,
    ) -> u32 {
        unreachable!("not packed")
    }

    /// How many members a packed leaf holds; for counters and reports.
    fn leaf_len(&self, _leaf: Leaf) -> u32 {
        unreachable!("not packed")
    }

    /// Where a packed leaf begins; to fetch early, never to read.
    fn address(&self, _leaf: Leaf) -> *const u8 {
        std::ptr::null()
    }

    /// Memory of the packed leaves.
    fn packed_bytes(&self) -> u64 {
        0
    }

    /// Shows each child that is an object of its own.
    fn visit(&self, _visit: &mut dyn FnMut(&dyn Object)) {}
}
