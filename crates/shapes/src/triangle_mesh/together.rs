//! Testing a leaf with the rays of a packet, one in each lane.
//!
//! The same arithmetic as with a triangle in each lane, and so the same bits.

use nestray_core::hit::{Hit, InstancePath};
use nestray_core::packet::{GROUPS, Lanes, Packet, RAYS, eight, eight_mut};
use nestray_core::ray::Ray;
use nestray_core::simd::Simd;
use nestray_core::technique::Leaf;

use super::kernel::Soup;
use super::layout::{Block, LAST, Layout};
use super::test::{Hits, Probe, Rays, STILL, Shear, axes, crossed, hits, settled};
use super::{Children, Mesh};
use crate::shape::Sides;

/// Up to so many of eight rays are tested one after the other, each with all triangles of a block.
const FEW: u32 = 3;
/// No block has more vertices; a power of two.
const VERTICES: usize = 32;

/// What a packet brings to the triangles of a mesh: its rays, each in its own [`Shear`].
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Probes {
    origin: [Lanes; 3],
    slope: [Lanes; 3],
    reach: Lanes,
    /// The rays that move along x, along y.
    moves: [u32; 2],
    axes: [usize; 3],
    is_forward: bool,
    /// The triangle that each has left.
    skip: [u32; RAYS],
    /// The rays that have left one.
    leaving: u32,
    /// Where each hits so far: which triangle, as the bits of a number, and where on it. How far
    /// away is its limit.
    number: Lanes,
    weights: [Lanes; 2],
    /// The vertices of a block, as eight of the rays see them.
    places: [[[f32; 8]; 3]; VERTICES],
}

impl Default for Probes {
    fn default() -> Self {
        let zero = [0.0; RAYS];
        Self {
            origin: [zero; 3],
            slope: [zero; 3],
            reach: zero,
            moves: [0; 2],
            axes: [0, 1, 2],
            is_forward: true,
            skip: [Hit::NOTHING; RAYS],
            leaving: 0,
            number: zero,
            weights: [zero; 2],
            places: [[[0.0; 8]; 3]; VERTICES],
        }
    }
}

impl Probes {
    #[inline(always)]
    fn set<S: Simd>(&mut self, simd: S, packet: &Packet) {
        self.axes = axes(packet.beam.axis);
        let [x, y, z] = self.axes;
        self.is_forward = !packet.beam.backward;
        self.moves = [0; 2];
        let size = |a: S::F32| simd.max(a, simd.sub(simd.splat(0.0), a));
        for from in GROUPS {
            let part = |lanes: &Lanes| simd.load(eight(lanes, from));
            let inverse = simd.div(simd.splat(1.0), part(&packet.dir[z]));
            let slopes = [
                simd.mul(part(&packet.dir[x]), inverse),
                simd.mul(part(&packet.dir[y]), inverse),
                inverse,
            ];
            let mut far = simd.splat(0.0);
            for (axis, slope) in slopes.into_iter().enumerate() {
                let origin = part(&packet.origin[self.axes[axis]]);
                *eight_mut(&mut self.origin[axis], from) = simd.array(origin);
                *eight_mut(&mut self.slope[axis], from) = simd.array(slope);
                far = simd.max(far, size(origin));
            }
            *eight_mut(&mut self.reach, from) = simd.array(simd.add(far, far));
            for (moves, slope) in self.moves.iter_mut().zip(slopes) {
                *moves |= (!simd.le(size(slope), simd.splat(STILL)) & 255) << from;
            }
        }
        self.number = [f32::from_bits(Hit::NOTHING); RAYS];
    }

    /// One ray.
    #[inline(always)]
    fn probe(&self, packet: &Packet, lane: usize, sides: Sides) -> Probe {
        let at = |lanes: &[Lanes; 3]| [lanes[0][lane], lanes[1][lane], lanes[2][lane]];
        let shear = Shear {
            origin: at(&self.origin),
            slope: at(&self.slope),
            t_min: packet.t_min[lane],
            axes: self.axes.map(|axis| axis as u8),
        };
        Probe { shear, skip: self.skip[lane], sides }
    }

    /// Eight rays, from number `half` on.
    #[inline(always)]
    fn rays<S: Simd>(&self, simd: S, packet: &Packet, half: usize) -> Rays<S> {
        let lanes = |lanes: &Lanes| simd.load(eight(lanes, half));
        Rays {
            slope: [lanes(&self.slope[0]), lanes(&self.slope[1]), lanes(&self.slope[2])],
            moves: [self.moves[0] >> half & 255, self.moves[1] >> half & 255],
            reach: lanes(&self.reach),
            t_min: lanes(&packet.t_min),
            limit: lanes(&packet.limit),
            is_forward: self.is_forward,
        }
    }

    /// Moves the vertices of a block into the spaces of eight rays.
    #[inline(always)]
    fn shear<S: Simd>(&mut self, simd: S, from: usize, vertices: impl Iterator<Item = [f32; 3]>) {
        let lanes = |lanes: &Lanes| simd.load(eight(lanes, from));
        let origin = [lanes(&self.origin[0]), lanes(&self.origin[1]), lanes(&self.origin[2])];
        let slope = [lanes(&self.slope[0]), lanes(&self.slope[1])];
        for (place, at) in self.places.iter_mut().zip(vertices) {
            let off = |i: usize| simd.sub(simd.splat(at[self.axes[i] % 3]), origin[i]);
            let (x, y, z) = (off(0), off(1), off(2));
            place[0] = simd.array(simd.sub(x, simd.mul(slope[0], z)));
            place[1] = simd.array(simd.sub(y, simd.mul(slope[1], z)));
            place[2] = simd.array(z);
        }
    }

    /// One triangle of a block, as eight rays see it.
    #[inline(always)]
    fn triangle<S: Simd>(&self, simd: S, [a, b, c]: [usize; 3], lanes: u32) -> Block<S> {
        let corner = |vertex: usize| {
            let [x, y, z] = &self.places[vertex % VERTICES];
            [simd.load(x), simd.load(y), simd.load(z)]
        };
        let corners = [corner(a), corner(b), corner(c)];
        Block { corners, shared: None, lanes, first: 0, next: None }
    }

    /// The triangle that a ray hits so far.
    #[inline(always)]
    fn held(&self, lane: usize) -> u32 {
        self.number[lane].to_bits()
    }

    /// Takes a nearer hit for some of eight rays.
    #[inline(always)]
    fn hold<S: Simd>(
        &mut self,
        simd: S,
        (packet, from): (&mut Packet, usize),
        number: u32,
        nearer: u32,
        found: &Hits<S>,
    ) {
        let put = |lanes: &mut Lanes, new: S::F32| {
            let lanes = eight_mut(lanes, from);
            *lanes = simd.array(simd.choose(nearer, new, simd.load(lanes)));
        };
        put(&mut packet.limit, found.t);
        put(&mut self.number, simd.splat(f32::from_bits(number)));
        put(&mut self.weights[0], found.weights[0]);
        put(&mut self.weights[1], found.weights[1]);
    }
}

impl<L: Layout> Mesh<L> {
    /// See [`Children::probe_all`].
    #[inline(always)]
    pub(super) fn set_probes<S: Simd>(
        &self,
        simd: S,
        packet: &Packet,
        rays: &[Ray],
        probes: &mut Probes,
    ) {
        probes.set(simd, packet);
        probes.leaving = 0;
        for (i, ray) in rays.iter().enumerate().take(RAYS) {
            let source = ray.source();
            if source.geometry != Hit::NOTHING && source.path == InstancePath::NONE {
                let number = self.bodies.number([source.geometry, source.primitive]);
                probes.skip[i] = number.unwrap_or(Hit::NOTHING);
                probes.leaving |= u32::from(number.is_some()) << i;
            } else {
                probes.skip[i] = Hit::NOTHING;
            }
        }
    }

    /// Tests the leaf with some of eight rays, and shows what is hit to `found`: the number of a
    /// triangle, and where they hit it.
    #[inline(always)]
    fn test_by<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        (from, lanes): (usize, u32),
        (packet, probes): (&mut Packet, &mut Probes),
        mut found: impl FnMut(&mut Packet, &mut Probes, u32, Hits<S>),
    ) {
        let mut block = leaf;
        loop {
            let header = &self.blocks[L::place(block)];
            probes.shear(simd, from, L::places(&self.blocks, block));
            for triangle in 0..L::len(block) {
                let seen = probes.triangle(simd, L::corners(header, block, triangle), lanes);
                let (mask, edges) = crossed(simd, &seen);
                if mask == 0 {
                    continue;
                }
                let number = self.numbers[header[6] as usize + triangle];
                let rays = probes.rays(simd, packet, from);
                let mut hits = settled::<S, Soup>(simd, &rays, self.sides, &seen, (mask, edges));
                if probes.leaving >> from & hits.mask != 0 {
                    let left = |lane: usize| probes.skip[from + lane] == number;
                    let left = (0..8).fold(0, |mask, i| mask | u32::from(left(i)) << i);
                    hits.mask &= !left;
                }
                if hits.mask != 0 {
                    found(packet, probes, number, hits);
                }
            }
            match header[7] {
                LAST => return,
                next => block = Leaf(next),
            }
        }
    }

    /// See [`Children::closest_in_leaf_by`].
    #[inline(always)]
    pub(super) fn closest_by<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        mask: u32,
        packet: &mut Packet,
        probes: &mut Probes,
        before: &[Hit],
    ) {
        for from in GROUPS {
            let lanes = mask >> from & 255;
            if lanes.count_ones() <= FEW {
                let mut left = lanes;
                while left != 0 {
                    let lane = from + left.trailing_zeros() as usize;
                    left &= left - 1;
                    self.closest_by_one(simd, leaf, lane, packet, probes, &before[lane]);
                }
                continue;
            }
            self.test_by(
                simd,
                leaf,
                (from, lanes),
                (packet, probes),
                #[inline(always)]
                |packet, probes, number, found| {
                    let limit = simd.load(eight(&packet.limit, from));
                    let equal = simd.eq(found.t, limit) & found.mask;
                    let mut nearer = found.mask;
                    if equal != 0 {
                        for lane in (0..8).filter(|lane| equal >> lane & 1 == 1) {
                            let held = probes.held(from + lane);
                            let loses = !self.is_before(number, held, &before[from + lane]);
                            nearer &= !(u32::from(loses) << lane);
                        }
                    }
                    probes.hold(simd, (packet, from), number, nearer, &found);
                },
            );
        }
    }

    /// The same for one ray.
    #[inline(always)]
    fn closest_by_one<S: Simd>(
        &self,
        simd: S,
        mut leaf: Leaf,
        lane: usize,
        packet: &mut Packet,
        probes: &mut Probes,
        before: &Hit,
    ) {
        let probe = probes.probe(packet, lane, self.sides);
        loop {
            let block = L::load(simd, &self.blocks, leaf, &probe.shear);
            let number = |lane: usize| self.numbers[block.first as usize + lane];
            let limit = packet.limit[lane];
            if let Some(hits) = hits::<S, L>(simd, &probe, &block, limit, number) {
                let (nearest, t, [u, v]) = hits.nearest(simd);
                let number = number(nearest);
                if t < limit || self.is_before(number, probes.held(lane), before) {
                    packet.limit[lane] = t;
                    probes.number[lane] = f32::from_bits(number);
                    (probes.weights[0][lane], probes.weights[1][lane]) = (u, v);
                }
            }
            let Some(next) = block.next else { return };
            leaf = next;
        }
    }

    /// Whether a triangle comes before the one held, or the hit from before if none is, where
    /// both are as far away.
    #[cold]
    fn is_before(&self, number: u32, held: u32, before: &Hit) -> bool {
        if held != Hit::NOTHING {
            return number < held;
        }
        let [geometry, primitive] = self.bodies.name(number);
        (geometry, primitive, InstancePath::NONE) < before.id()
    }

    /// See [`Children::tell_hits`].
    #[inline(always)]
    pub(super) fn tell(&self, packet: &Packet, probes: &Probes, hits: &mut [Hit]) {
        for (lane, hit) in hits.iter_mut().enumerate().take(RAYS) {
            let held = probes.held(lane);
            if held != Hit::NOTHING {
                let [geometry, primitive] = self.bodies.name(held);
                let (u, v) = (probes.weights[0][lane], probes.weights[1][lane]);
                let path = InstancePath::NONE;
                *hit = Hit { t: packet.limit[lane], u, v, geometry, primitive, path };
            }
        }
    }

    /// See [`Children::any_in_leaf_by`].
    #[inline(always)]
    pub(super) fn any_by<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        mask: u32,
        packet: &mut Packet,
        probes: &mut Probes,
    ) -> u32 {
        let mut blocked = 0;
        for from in GROUPS {
            let lanes = mask >> from & 255;
            if lanes.count_ones() <= FEW {
                let mut left = lanes;
                while left != 0 {
                    let lane = from + left.trailing_zeros() as usize;
                    left &= left - 1;
                    let probe = probes.probe(packet, lane, self.sides);
                    if self.any_in_leaf(simd, leaf, &probe, packet.limit[lane]) {
                        blocked |= 1 << lane;
                        packet.limit[lane] = f32::NEG_INFINITY;
                    }
                }
                continue;
            }
            self.test_by(
                simd,
                leaf,
                (from, lanes),
                (packet, probes),
                #[inline(always)]
                |packet, _, _, found| {
                    blocked |= found.mask << from;
                    let limit = eight_mut(&mut packet.limit, from);
                    let none = simd.splat(f32::NEG_INFINITY);
                    *limit = simd.array(simd.choose(found.mask, none, simd.load(limit)));
                },
            );
        }
        blocked
    }
}
