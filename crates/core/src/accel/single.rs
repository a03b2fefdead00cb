//! One ray at a time.

use std::ops::ControlFlow;

use crate::accel::Accel;
use crate::accel::leaf::This;
use crate::children::Children;
use crate::counters::Site;
use crate::hit::Hit;
use crate::mailbox::Stamp;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::simd::Simd;
use crate::technique::{Asks, Every, Index, Leaf, Query, Walk};
use crate::trail::Trail;

/// Nearest hit, one ray.
type Nearest = Asks<false, false>;
/// Any hit, one ray.
type Unordered = Asks<true, false>;

impl<I: Index, C: Children> Accel<I, C> {
    #[inline(always)]
    pub(super) fn closest<S: Simd>(
        &self,
        simd: S,
        ray: &Ray,
        hit: &mut Hit,
        scratch: &mut Scratch,
    ) -> bool {
        let mut found = self.is_loose && self.closest_of_loose::<S>(ray, hit, scratch);
        let mut stamp = Stamp::NONE;
        self.walk::<S, Nearest>(
            simd,
            ray,
            hit.t,
            scratch,
            #[inline(always)]
            |leaf, this, scratch| {
                found |= self.closest_in_leaf(simd, leaf, this, (hit, &mut stamp), scratch);
                ControlFlow::Continue(hit.t)
            },
        );
        scratch.mailbox.close(stamp);
        found
    }

    #[inline(always)]
    pub(super) fn any<S: Simd>(&self, simd: S, ray: &Ray, scratch: &mut Scratch) -> bool {
        if self.is_loose && self.any_of_loose::<S>(ray, scratch) {
            return true;
        }
        let (mut stamp, mut blocked) = (Stamp::NONE, false);
        let told = self.walk::<S, Unordered>(
            simd,
            ray,
            ray.t_max(),
            scratch,
            #[inline(always)]
            |leaf, this, scratch| {
                blocked = self.any_in_leaf(simd, leaf, this, &mut stamp, scratch);
                if blocked { ControlFlow::Break(()) } else { ControlFlow::Continue(ray.t_max()) }
            },
        );
        scratch.mailbox.close(stamp);
        blocked | told
    }

    #[inline(always)]
    pub(super) fn all<S: Simd>(
        &self,
        simd: S,
        ray: &Ray,
        hits: &mut Vec<Hit>,
        scratch: &mut Scratch,
    ) {
        for child in self.loose() {
            self.count_test::<S>(ray, child, scratch);
            self.members.children.all_hits(child, ray, hits, scratch);
        }
        let mut stamp = Stamp::NONE;
        self.walk::<S, Every>(
            simd,
            ray,
            ray.t_max(),
            scratch,
            #[inline(always)]
            |leaf, this, scratch| {
                self.all_in_leaf(simd, leaf, this, (hits, &mut stamp), scratch);
                ControlFlow::Continue(ray.t_max())
            },
        );
        scratch.mailbox.close(stamp);
    }

    /// The children outside the index; whether one is hit nearer than `hit`.
    #[inline(never)]
    fn closest_of_loose<S: Simd>(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        let mut found = false;
        for child in self.loose() {
            self.count_test::<S>(ray, child, scratch);
            found |= self.members.children.closest_hit(child, ray, hit, scratch);
        }
        found
    }

    /// Whether a child outside the index is hit.
    #[inline(never)]
    fn any_of_loose<S: Simd>(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.loose().any(|child| {
            self.count_test::<S>(ray, child, scratch);
            self.members.children.any_hit(child, ray, scratch)
        })
    }

    /// Shows every leaf the ray meets to `test`, which says how far to go on, or to stop. Returns
    /// whether the index says that something is hit.
    #[inline(always)]
    fn walk<S: Simd, Q: Query>(
        &self,
        simd: S,
        ray: &Ray,
        mut limit: f32,
        scratch: &mut Scratch,
        mut test: impl FnMut(Leaf, &This<'_, I, C>, &mut Scratch) -> ControlFlow<(), f32>,
    ) -> bool {
        if S::COUNTS {
            scratch.counters.visit(ray.kind(), Site::of(self));
        }
        let Some(index) = &self.index else { return false };
        // Many rays never come to a leaf.
        let mut probe = None;
        let mut trail = Trail::new();
        let mut walk = Walk { ray, trail: &mut trail, family: &self.members };
        let (mut cursor, mut at) = index.start(simd, &mut walk, limit);
        loop {
            while at.is_onward() {
                if S::COUNTS {
                    let technique = self.technique.name();
                    scratch.counters.steps(ray.kind(), technique, Site::of(self), 1);
                }
                at = index.step::<S, Q>(simd, &mut walk, &mut cursor, at, limit);
            }
            if at.is_done() {
                return false;
            }
            if I::TELLS && at.is_hit() {
                return true;
            }
            let probe = probe.get_or_insert_with(|| self.members.children.probe(ray));
            let this = This { index, ray, probe, cursor: &cursor };
            match test(at.as_leaf(), &this, scratch) {
                ControlFlow::Continue(nearer) => limit = nearer,
                ControlFlow::Break(()) => return false,
            }
            at = index.resume::<S, Q>(simd, &mut walk, &mut cursor, limit);
        }
    }
}
