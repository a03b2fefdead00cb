//! Many rays in flight: while the node of one comes from memory, the others move on.
//!
//! Rays that stand at nodes and rays that stand at leaves are kept on separate lists and
//! served in turns, so that the code of one kind runs many times in a row without a branch
//! that depends on a ray. What is written per step is little: stores in flight hold up the loads
//! behind them. Rays that come to an object of its own (an instance, a nested
//! aggregate) are handed on one by one.

use std::hint::select_unpredictable;

use crate::accel::Accel;
use crate::accel::leaf::This;
use crate::accel::packets::Served;
use crate::children::Children;
use crate::hit::Hit;
use crate::mailbox::Stamp;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::simd::{Simd, prefetch};
use crate::technique::{Asks, Index, Step, Walk};
use crate::trail::Trail;

/// Rays in flight; with half as many, memory is not hidden, with twice as many they push
/// each other out of the cache.
const RAYS: usize = 32;
/// Leaves are served when no more rays than this stand at nodes.
const FEW: usize = 8;

/// One ray in flight: what every step touches first.
#[derive(Clone, Copy)]
#[repr(C, align(64))]
struct Slot<'a, Cursor, Probe> {
    cursor: Cursor,
    limit: f32,
    at: Step,
    ray: &'a Ray,
    /// Which of all rays it is.
    number: u32,
    stamp: Stamp,
    probe: Probe,
}

/// A list of slots with room to write one too many.
struct Slots {
    slots: [u32; 2 * RAYS],
    count: usize,
}

impl Slots {
    const NONE: Self = Self { slots: [0; 2 * RAYS], count: 0 };

    /// Appends `slot` if `really`, without a branch.
    #[inline(always)]
    fn push_if(&mut self, slot: u32, really: bool) {
        self.put(self.count, slot);
        self.count += usize::from(really);
    }

    #[inline(always)]
    fn put(&mut self, at: usize, slot: u32) {
        self.slots[at & (2 * RAYS - 1)] = slot;
    }

    /// Empties the list and says how many there were; they can still be read while fewer
    /// are pushed.
    #[inline(always)]
    fn drain(&mut self) -> usize {
        std::mem::take(&mut self.count)
    }

    #[inline(always)]
    fn get(&self, at: usize) -> u32 {
        self.slots[at & (2 * RAYS - 1)]
    }
}

/// Where the rays in flight stand.
struct Lists {
    /// At a node or cell.
    onward: Slots,
    /// At a leaf, or at the end.
    rest: Slots,
    /// Those at a leaf, once they are served.
    leaf: Slots,
    /// Slots without a ray.
    free: Slots,
}

impl Lists {
    #[inline(always)]
    fn sort_in(&mut self, slot: u32, at: Step) {
        self.onward.push_if(slot, at.is_onward());
        self.rest.push_if(slot, !at.is_onward());
    }
}

/// All rays in flight.
struct InFlight<'a, Cursor, Probe> {
    slots: [Slot<'a, Cursor, Probe>; RAYS],
    trails: [Trail; RAYS],
    lists: Lists,
    /// The next ray to let in.
    next: usize,
}

/// Where answers go: hits, or whether something is hit.
pub(super) type Answers<'a> = (&'a mut [Hit], &'a mut [bool]);

impl<'a, Cursor: Copy + Default, Probe: Copy + Default> InFlight<'a, Cursor, Probe> {
    #[inline(always)]
    fn new(rays: &'a [Ray]) -> Self {
        let empty = Slot {
            cursor: Cursor::default(),
            limit: 0.0,
            at: Step::DONE,
            ray: &rays[0],
            number: 0,
            stamp: Stamp::NONE,
            probe: Probe::default(),
        };
        let mut lists =
            Lists { onward: Slots::NONE, rest: Slots::NONE, leaf: Slots::NONE, free: Slots::NONE };
        for slot in 0..RAYS.min(rays.len()) {
            lists.free.push_if(slot as u32, true);
        }
        let trails = [const { Trail::new() }; RAYS];
        Self { slots: [empty; RAYS], trails, lists, next: 0 }
    }
}

impl<I: Index, C: Children> Accel<I, C> {
    /// Traces all `rays` that are not `served`; fills the hits, or whether something is hit if
    /// `ANY`.
    #[inline(always)]
    pub(super) fn barrel<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        rays: &[Ray],
        served: &Served,
        answers: &mut Answers<'_>,
        scratch: &mut Scratch,
    ) {
        if served.skip(0) >= rays.len() {
            return;
        }
        let mut flight = InFlight::<I::Cursor, C::Probe>::new(rays);
        loop {
            self.let_in::<S, ANY>(simd, index, (rays, served), answers, (&mut flight, scratch));
            if flight.lists.onward.count + flight.lists.rest.count == 0 {
                if flight.lists.free.count == 0 {
                    return;
                }
                continue;
            }
            while flight.lists.onward.count > FEW
                || (flight.lists.onward.count > 0 && flight.lists.rest.count == 0)
            {
                self.step_all::<S, ANY>(simd, index, answers, &mut flight);
            }
            self.serve_leaves::<S, ANY>(simd, index, answers, (&mut flight, scratch));
        }
    }

    /// Lets new rays in where others are done.
    #[inline(always)]
    fn let_in<'a, S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        (rays, served): (&'a [Ray], &Served),
        (hits, blocked): &Answers<'_>,
        (flight, scratch): (&mut InFlight<'a, I::Cursor, C::Probe>, &mut Scratch),
    ) {
        let InFlight { slots, trails, lists, next } = flight;
        for i in 0..lists.free.drain() {
            let id = lists.free.get(i);
            let (slot, trail) = (&mut slots[id as usize % RAYS], &mut trails[id as usize % RAYS]);
            scratch.mailbox.close(slot.stamp);
            slot.stamp = Stamp::NONE;
            *next = served.skip(*next);
            while ANY && *next < rays.len() && blocked[*next] {
                *next = served.skip(*next + 1);
            }
            let Some(ray) = rays.get(*next) else { continue };
            slot.limit = if ANY { ray.t_max() } else { hits[*next].t };
            let mut walk = Walk { ray, trail, family: &self.members };
            (slot.cursor, slot.at) = index.start(simd, &mut walk, slot.limit);
            slot.probe = self.members.children.probe(ray);
            (slot.ray, slot.number) = (ray, *next as u32);
            *next += 1;
            lists.sort_in(id, slot.at);
        }
    }

    /// Moves every ray that stands at a node or cell by one.
    #[inline(always)]
    fn step_all<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        (_, blocked): &mut Answers<'_>,
        flight: &mut InFlight<'_, I::Cursor, C::Probe>,
    ) {
        let InFlight { slots, trails, lists, .. } = flight;
        let Lists { onward, rest, .. } = lists;
        // Counted here, in registers.
        let (mut moving, mut resting) = (0, rest.count);
        for i in 0..onward.count {
            let id = onward.get(i);
            let (slot, trail) = (&mut slots[id as usize % RAYS], &mut trails[id as usize % RAYS]);
            let mut walk = Walk { ray: slot.ray, trail, family: &self.members };
            let (at, limit) = (slot.at, slot.limit);
            let mut at =
                index.step::<S, Asks<ANY, true>>(simd, &mut walk, &mut slot.cursor, at, limit);
            if I::TELLS && ANY && at.is_hit() {
                blocked[slot.number as usize] = true;
                at = Step::DONE;
            }
            slot.at = at;
            self.fetch(index, &slot.cursor, at);
            onward.put(moving, id);
            rest.put(resting, id);
            moving += usize::from(at.is_onward());
            resting += usize::from(!at.is_onward());
        }
        (onward.count, rest.count) = (moving, resting);
    }

    /// Tests the leaves that rays stand at, and moves those rays on; what others held is free.
    #[inline(always)]
    fn serve_leaves<S: Simd, const ANY: bool>(
        &self,
        simd: S,
        index: &I,
        (hits, blocked): &mut Answers<'_>,
        (flight, scratch): (&mut InFlight<'_, I::Cursor, C::Probe>, &mut Scratch),
    ) {
        let InFlight { slots, trails, lists, .. } = flight;
        for i in 0..lists.rest.drain() {
            let id = lists.rest.get(i);
            let done = slots[id as usize % RAYS].at.is_done();
            lists.free.push_if(id, done);
            lists.leaf.push_if(id, !done);
        }
        for i in 0..lists.leaf.drain() {
            let id = lists.leaf.get(i);
            let (slot, trail) = (&mut slots[id as usize % RAYS], &mut trails[id as usize % RAYS]);
            let nth = slot.number as usize;
            let ray = slot.ray;
            let this = This { index, ray, probe: &slot.probe, cursor: &slot.cursor };
            let leaf = slot.at.as_leaf();
            if ANY {
                let hit = self.any_in_leaf(simd, leaf, &this, &mut slot.stamp, scratch);
                blocked[nth] |= hit;
                slot.limit = if hit { f32::NEG_INFINITY } else { slot.limit };
            } else {
                let out = (&mut hits[nth], &mut slot.stamp);
                if self.closest_in_leaf(simd, leaf, &this, out, scratch) {
                    slot.limit = hits[nth].t;
                }
            }
            let mut walk = Walk { ray, trail, family: &self.members };
            let limit = slot.limit;
            slot.at = index.resume::<S, Asks<ANY, true>>(simd, &mut walk, &mut slot.cursor, limit);
            if ANY && slot.limit == f32::NEG_INFINITY {
                slot.at = Step::DONE;
            }
            self.fetch(index, &slot.cursor, slot.at);
            lists.sort_in(id, slot.at);
        }
    }

    /// Fetches what the next step or leaf test reads first.
    #[inline(always)]
    fn fetch(&self, index: &I, cursor: &I::Cursor, at: Step) {
        let leaf = if Self::PACKED {
            self.members.children.address(at.as_leaf())
        } else {
            self.table.as_ptr().wrapping_add(at.as_leaf().0 as usize).cast()
        };
        let place = index.address(cursor, at);
        let next = select_unpredictable(at.is_onward(), place, leaf);
        // What is nowhere takes long to look for.
        let near = std::ptr::from_ref(cursor).cast();
        // A node is four lines; so is a leaf, begun in the middle of the first.
        prefetch::<5>(select_unpredictable(at.is_done(), near, next));
    }
}
