//! Some rays of a packet, and children that are objects of their own.

use crate::accel::Accel;
use crate::children::Children;
use crate::hit::Hit;
use crate::mailbox::Stamp;
use crate::packet;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::technique::{Index, Leaf};

/// Fewest rays that are handed on as a batch.
const FEWEST: u32 = 4;
/// In so many batches, each within the one before, rays are handed on one by one: what is in flight
/// takes about 80 KiB of stack each time, and nests are up to 192 levels deep.
const DEEPEST: u32 = 2;

/// The rays in a mask, by number.
pub(super) fn lanes(mut mask: u32) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (lane < packet::RAYS).then_some(lane)
    })
}

/// Some rays and their answers so far, next to each other.
struct Few {
    rays: [Ray; packet::RAYS],
    hits: [Hit; packet::RAYS],
    count: usize,
}

impl Few {
    #[inline(always)]
    fn of(mask: u32, rays: &[Ray], hit: impl Fn(usize) -> Hit) -> Self {
        let none = Hit::none(0.0);
        let mut few = Self { rays: [rays[0]; packet::RAYS], hits: [none; packet::RAYS], count: 0 };
        for lane in lanes(mask) {
            few.rays[few.count % packet::RAYS] = rays[lane];
            few.hits[few.count % packet::RAYS] = hit(lane);
            few.count += 1;
        }
        few
    }
}

impl<I: Index, C: Children> Accel<I, C> {
    /// The rays of `mask` that have not yet been tested with a member.
    fn fresh(
        &self,
        seen: &mut Option<Stamp>,
        member: u32,
        mask: u32,
        scratch: &mut Scratch,
    ) -> u32 {
        let Some(stamp) = seen else { return mask };
        scratch.mailbox.first_visits(stamp, member, self.members.names.count(), mask)
    }

    /// Tests the children in a leaf with the rays of a mask, which stay a batch.
    pub(super) fn closest_of_members(
        &self,
        (leaf, mask): (Leaf, u32),
        seen: &mut Option<Stamp>,
        rays: &[Ray],
        hits: &mut [Hit],
        scratch: &mut Scratch,
    ) {
        let children = &self.members.children;
        let mut together = None;
        for &member in self.members_at(leaf) {
            let child = self.members.names.child(member);
            let left = self.fresh(seen, member, mask, scratch);
            if left.count_ones() < FEWEST || scratch.batches >= DEEPEST {
                for lane in lanes(left) {
                    children.closest_hit(child, &rays[lane], &mut hits[lane], scratch);
                }
                together = None;
                continue;
            }
            let of = |few: &(u32, Few)| few.0 == left;
            let (_, few) = match &mut together {
                Some(few) if of(few) => few,
                other => other.insert((left, Few::of(left, rays, |lane| hits[lane]))),
            };
            scratch.batches += 1;
            let count = few.count;
            children.closest_hits(child, &few.rays[..count], &mut few.hits[..count], scratch);
            scratch.batches -= 1;
            for (hit, lane) in few.hits.iter().zip(lanes(left)) {
                hits[lane] = *hit;
            }
        }
    }

    /// Which rays of a mask hit any of the children in a leaf.
    pub(super) fn any_of_members(
        &self,
        (leaf, mask): (Leaf, u32),
        seen: &mut Option<Stamp>,
        rays: &[Ray],
        scratch: &mut Scratch,
    ) -> u32 {
        let children = &self.members.children;
        let mut open = mask;
        for &member in self.members_at(leaf) {
            let child = self.members.names.child(member);
            let left = self.fresh(seen, member, open, scratch);
            if left.count_ones() < FEWEST || scratch.batches >= DEEPEST {
                for lane in lanes(left) {
                    open &= !(u32::from(children.any_hit(child, &rays[lane], scratch)) << lane);
                }
                continue;
            }
            let few = Few::of(left, rays, |_| Hit::none(0.0));
            let mut blocked = [false; packet::RAYS];
            scratch.batches += 1;
            children.any_hits(child, &few.rays[..few.count], &mut blocked[..few.count], scratch);
            scratch.batches -= 1;
            for (blocked, lane) in blocked.into_iter().zip(lanes(left)) {
                open &= !(u32::from(blocked) << lane);
            }
        }
        mask & !open
    }
}
