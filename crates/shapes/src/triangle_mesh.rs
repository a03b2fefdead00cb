//! Triangles, tested eight at a time, without a gap between neighbours.

mod beam;
mod bodies;
mod exact;
mod kernel;
mod layout;
mod leaf;
mod part;
mod polygon;
mod shear;
mod surface;
mod test;
mod together;
mod triangles;

use std::marker::PhantomData;
use std::sync::Arc;

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::children::Children;
use nestray_core::cost::{Cost, CostModel};
use nestray_core::hit::{Hit, InstancePath};
use nestray_core::huge::Huge;
use nestray_core::names::Names;
use nestray_core::packet::Packet;
use nestray_core::ray::{Ray, Source};
use nestray_core::scratch::Scratch;
use nestray_core::simd::Simd;
use nestray_core::surface::Surface;
use nestray_core::technique::{Leaf, Leaves};

use crate::shape::Sides;

use self::bodies::Bodies;
use self::part::Part;

pub use self::kernel::{Shared, Soup};
pub use self::layout::Layout;
pub use self::shear::{Probe, Shear};
pub use self::together::Probes;
pub use self::triangles::{MeshError, Triangles};

/// Triangles that share their vertices in packed leaves.
pub type TriangleMesh = Mesh<Shared>;

/// Triangles that do not: smaller leaves where few neighbours meet.
pub type TriangleSoup = Mesh<Soup>;

/// A family of triangles; each triangle is a child, none is an object. `L` says how leaves
/// are packed, and never changes an answer.
#[derive(Clone, Debug)]
pub struct Mesh<L> {
    bodies: Bodies,
    sides: Sides,
    part: Part,
    blocks: Huge<[u32; 8]>,
    /// The numbers of the triangles of all blocks, in order.
    numbers: Huge<u32>,
    layout: PhantomData<L>,
}

impl<L: Layout> Mesh<L> {
    /// Geometry number `geometry`; triangle `i` reports `primitive == i`. Triangles with a corner
    /// that is not finite, or farther out than [`Ray::FARTHEST`], are never hit.
    #[must_use]
    pub fn new(geometry: u32, triangles: Arc<Triangles>) -> Self {
        Self::over(Bodies::one(geometry, triangles), Sides::Both, Part::default())
    }

    fn over(bodies: Bodies, sides: Sides, part: Part) -> Self {
        let (blocks, numbers, layout) = (Huge::default(), Huge::default(), PhantomData);
        Self { bodies, sides, part, blocks, numbers, layout }
    }

    /// The same mesh seen from some sides only.
    #[must_use]
    pub fn seen_from(self, sides: Sides) -> Self {
        Self { sides, ..self }
    }

    /// The triangles of a packed leaf, by geometry and primitive; for reports and viewers.
    #[must_use]
    pub fn named_in(&self, leaf: Leaf) -> Vec<[u32; 2]> {
        let mut names = Vec::new();
        for block in self.chain(leaf) {
            let first = self.blocks[L::place(block)][6] as usize;
            let numbers = &self.numbers[first..][..L::len(block)];
            names.extend(numbers.iter().map(|&number| self.bodies.name(number)));
        }
        names
    }

    /// The blocks of a leaf.
    fn chain(&self, leaf: Leaf) -> impl Iterator<Item = Leaf> + '_ {
        std::iter::successors(Some(leaf), |&block| match self.blocks[L::place(block)][7] {
            layout::LAST => None,
            next => Some(Leaf(next)),
        })
    }

    /// The mesh that a child is of, and which triangle.
    #[inline]
    fn find(&self, child: u32) -> (&Triangles, u32) {
        self.bodies.find(self.part.number(child))
    }

    /// Offers a hit of a triangle.
    #[inline(always)]
    fn offer(&self, hit: &mut Hit, t: f32, uv: [f32; 2], number: u32) -> bool {
        let [geometry, primitive] = self.bodies.name(number);
        hit.offer(t, uv, geometry, primitive)
    }

    /// The number of the triangle that `source` lies on, or [`Hit::NOTHING`]. One that is not in
    /// this part is no child either.
    #[inline(always)]
    fn left(&self, source: &Source) -> u32 {
        if source.geometry == Hit::NOTHING || source.path != InstancePath::NONE {
            return Hit::NOTHING;
        }
        self.bodies.number([source.geometry, source.primitive]).unwrap_or(Hit::NOTHING)
    }
}

impl<L: Layout> Children for Mesh<L> {
    const PACKED: bool = true;
    type Probe = Probe;
    type Probes = Probes;

    fn count(&self) -> u32 {
        self.count()
    }

    fn kind(&self, _child: u32) -> &'static str {
        "triangle"
    }

    fn bounds(&self, child: u32) -> Aabb {
        let (triangles, primitive) = self.find(child);
        triangles.bounds(primitive)
    }

    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb {
        let (triangles, primitive) = self.find(child);
        triangles.clipped(primitive, cell)
    }

    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2] {
        let (triangles, primitive) = self.find(child);
        triangles.along(primitive, direction)
    }

    fn meets(&self, child: u32, rays: &Beam) -> Option<[f32; 2]> {
        let (triangles, primitive) = self.find(child);
        beam::meets(&triangles.corners(primitive), &triangles.bounds(primitive), rays)
    }

    fn blocks(&self, child: u32, rays: &Beam) -> Option<f32> {
        let (triangles, primitive) = self.find(child);
        // What has one side only lets rays through that come the other way.
        let blocks = self.sides == Sides::Both && triangles.is_usable(primitive);
        if blocks { beam::blocks(&triangles.corners(primitive), rays) } else { None }
    }

    fn facing(&self, child: u32, rays: &Beam) -> Facing {
        let (triangles, primitive) = self.find(child);
        beam::facing(&triangles.corners(primitive), rays)
    }

    fn cost(&self, _child: u32, model: &CostModel) -> Cost {
        Cost::primitive(model.primitive("triangle"), 0.3, size_of::<[u32; 3]>() as u64)
    }

    fn closest_hit(&self, child: u32, ray: &Ray, hit: &mut Hit, _scratch: &mut Scratch) -> bool {
        let number = self.part.number(child);
        self.alone(number, &self.probe(ray), hit.t)
            .is_some_and(|(t, uv)| self.offer(hit, t, uv, number))
    }

    fn any_hit(&self, child: u32, ray: &Ray, _scratch: &mut Scratch) -> bool {
        self.alone(self.part.number(child), &self.probe(ray), ray.t_max()).is_some()
    }

    fn all_hits(&self, child: u32, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        let mut hit = Hit::none(ray.t_max());
        if self.closest_hit(child, ray, &mut hit, scratch) {
            hits.push(hit);
        }
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Option<Surface> {
        let child = self.child_called([hit.geometry, hit.primitive], hit.path)?;
        let (triangles, primitive) = self.find(child);
        Some(triangles.surface(primitive, [hit.u, hit.v]))
    }

    fn child_of(&self, source: &Source) -> Option<u32> {
        self.child_called([source.geometry, source.primitive], source.path)
    }

    fn pack(&mut self, leaves: &Leaves, names: &Names) -> Vec<Leaf> {
        let number = |child: u32| self.part.number(names.child(child));
        let packed = layout::pack::<L>(&self.bodies, &number, leaves);
        (self.blocks, self.numbers) = (packed.blocks, packed.numbers);
        packed.leaves
    }

    #[inline(always)]
    fn probe(&self, ray: &Ray) -> Probe {
        Probe { shear: Shear::new(ray), skip: self.left(&ray.source()), sides: self.sides }
    }

    #[inline(always)]
    fn closest_in_leaf<S: Simd>(&self, simd: S, leaf: Leaf, probe: &Probe, hit: &mut Hit) -> bool {
        self.closest_of(simd, leaf, probe, hit)
    }

    #[inline(always)]
    fn any_in_leaf<S: Simd>(&self, simd: S, leaf: Leaf, probe: &Probe, t_max: f32) -> bool {
        self.any_of(simd, leaf, probe, t_max)
    }

    #[inline(always)]
    fn all_in_leaf<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        probe: &Probe,
        t_max: f32,
        out: &mut Vec<Hit>,
    ) {
        self.all_of(simd, leaf, probe, t_max, out);
    }

    #[inline(always)]
    fn probe_all<S: Simd>(&self, simd: S, packet: &Packet, rays: &[Ray], probes: &mut Probes) {
        self.set_probes(simd, packet, rays, probes);
    }

    #[inline(always)]
    fn closest_in_leaf_by<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        mask: u32,
        packet: &mut Packet,
        probes: &mut Probes,
        hits: &[Hit],
    ) {
        self.closest_by(simd, leaf, mask, packet, probes, hits);
    }

    #[inline(always)]
    fn tell_hits(&self, packet: &Packet, probes: &Probes, hits: &mut [Hit]) {
        self.tell(packet, probes, hits);
    }

    #[inline(always)]
    fn any_in_leaf_by<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        mask: u32,
        packet: &mut Packet,
        probes: &mut Probes,
    ) -> u32 {
        self.any_by(simd, leaf, mask, packet, probes)
    }

    fn leaf_len(&self, leaf: Leaf) -> u32 {
        self.chain(leaf).map(|block| L::len(block) as u32).sum()
    }

    #[inline(always)]
    fn address(&self, leaf: Leaf) -> *const u8 {
        L::address(&self.blocks, leaf)
    }

    fn packed_bytes(&self) -> u64 {
        let packed = size_of_val::<[[u32; 8]]>(&self.blocks);
        let names = size_of_val::<[u32]>(&self.numbers) + self.bodies.bytes();
        (packed + names + self.part.bytes()) as u64
    }
}
