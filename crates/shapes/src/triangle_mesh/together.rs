//! Testing a leaf with the rays of a packet, one in each lane.
//!
//! The same arithmetic as with a triangle in each lane, and so the same bits.

mod probes;

use nestray_core::hit::{Hit, InstancePath};
use nestray_core::packet::{GROUPS, Packet, RAYS, eight, eight_mut};
use nestray_core::ray::Ray;
use nestray_core::simd::Simd;
use nestray_core::technique::Leaf;

use super::kernel::Soup;
use super::layout::{LAST, Layout};
use super::test::{Hits, crossed, hits, settled};
use super::{Children, Mesh};

pub use self::probes::Probes;

/// Up to so many of eight rays are tested one after the other, each with all triangles of a block.
const FEW: u32 = 3;
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
            probes.skip[i] = self.left(&ray.source());
            probes.leaving |= u32::from(probes.skip[i] != Hit::NOTHING) << i;
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
