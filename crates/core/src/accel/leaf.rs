//! What an aggregate does with a leaf.

use crate::accel::Accel;
use crate::children::Children;
use crate::counters::Site;
use crate::hit::Hit;
use crate::mailbox::Stamp;
use crate::ray::Ray;
use crate::scratch::Scratch;
use crate::simd::Simd;
use crate::technique::{Index, Leaf, Repeats, Visit};

/// One ray in an aggregate: what a leaf test needs of it.
pub(super) struct This<'a, I: Index, C: Children> {
    pub(super) index: &'a I,
    pub(super) ray: &'a Ray,
    pub(super) probe: &'a C::Probe,
    pub(super) cursor: &'a I::Cursor,
}

impl<I: Index, C: Children> Accel<I, C> {
    /// Whether leaves are tested whole.
    pub(super) const PACKED: bool = C::PACKED && !I::LISTS;

    /// The members in a leaf that is not packed.
    #[inline(always)]
    fn members_in<'a>(&'a self, this: &This<'a, I, C>, leaf: Leaf) -> &'a [u32] {
        if I::LISTS {
            return this.index.listed(this.cursor, leaf);
        }
        self.members_at(leaf)
    }

    /// The same, where the technique does not list them itself.
    #[inline(always)]
    pub(super) fn members_at(&self, leaf: Leaf) -> &[u32] {
        let at = leaf.0 as usize;
        &self.table[at + 1..][..self.table[at] as usize]
    }

    /// Whether a member was not tested before in this traversal.
    #[inline(always)]
    fn is_new<S: Simd>(
        &self,
        this: &This<'_, I, C>,
        member: u32,
        stamp: &mut Stamp,
        scratch: &mut Scratch,
    ) -> bool {
        let visit = match I::REPEATS {
            Repeats::Never => Visit::First,
            Repeats::ByRule => this.index.visit(this.cursor, member),
            Repeats::Anywhere => Visit::Unknown,
        };
        let new = match visit {
            Visit::First => true,
            Visit::Again => false,
            Visit::Unknown => {
                let count = self.members.names.count();
                scratch.mailbox.first_visit(stamp, member, count)
            }
        };
        if S::COUNTS && !new {
            scratch.counters.repeat(this.ray.kind());
        }
        new
    }

    /// Counts a test of a child, if this is the counting level.
    #[inline(always)]
    pub(super) fn count_test<S: Simd>(&self, ray: &Ray, child: u32, scratch: &mut Scratch) {
        if S::COUNTS {
            let what = self.members.children.kind(child);
            scratch.counters.tests(ray.kind(), what, Site::of(self), 1);
        }
    }

    /// Counts the tests of a packed leaf, if this is the counting level.
    #[inline(always)]
    fn count_leaf<S: Simd>(&self, ray: &Ray, leaf: Leaf, scratch: &mut Scratch) {
        if S::COUNTS {
            let children = &self.members.children;
            let count = u64::from(children.leaf_len(leaf));
            scratch.counters.tests(ray.kind(), children.kind(0), Site::of(self), count);
        }
    }

    #[inline(always)]
    pub(super) fn closest_in_leaf<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        this: &This<'_, I, C>,
        (hit, stamp): (&mut Hit, &mut Stamp),
        scratch: &mut Scratch,
    ) -> bool {
        if Self::PACKED {
            self.count_leaf::<S>(this.ray, leaf, scratch);
            return self.members.children.closest_in_leaf(simd, leaf, this.probe, hit);
        }
        let mut found = false;
        for &member in self.members_in(this, leaf) {
            if self.is_new::<S>(this, member, stamp, scratch) {
                let child = self.members.names.child(member);
                self.count_test::<S>(this.ray, child, scratch);
                found |= self.members.children.closest_hit(child, this.ray, hit, scratch);
            }
        }
        found
    }

    #[inline(always)]
    pub(super) fn any_in_leaf<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        this: &This<'_, I, C>,
        stamp: &mut Stamp,
        scratch: &mut Scratch,
    ) -> bool {
        if Self::PACKED {
            self.count_leaf::<S>(this.ray, leaf, scratch);
            return self.members.children.any_in_leaf(simd, leaf, this.probe, this.ray.t_max());
        }
        for &member in self.members_in(this, leaf) {
            if self.is_new::<S>(this, member, stamp, scratch) {
                let child = self.members.names.child(member);
                self.count_test::<S>(this.ray, child, scratch);
                if self.members.children.any_hit(child, this.ray, scratch) {
                    return true;
                }
            }
        }
        false
    }

    #[inline(always)]
    pub(super) fn all_in_leaf<S: Simd>(
        &self,
        simd: S,
        leaf: Leaf,
        this: &This<'_, I, C>,
        (hits, stamp): (&mut Vec<Hit>, &mut Stamp),
        scratch: &mut Scratch,
    ) {
        if Self::PACKED {
            self.count_leaf::<S>(this.ray, leaf, scratch);
            let t_max = this.ray.t_max();
            return self.members.children.all_in_leaf(simd, leaf, this.probe, t_max, hits);
        }
        for &member in self.members_in(this, leaf) {
            if self.is_new::<S>(this, member, stamp, scratch) {
                let child = self.members.names.child(member);
                self.count_test::<S>(this.ray, child, scratch);
                self.members.children.all_hits(child, this.ray, hits, scratch);
            }
        }
    }
}
