//! A tree of boxes with lists beside it: of what rays of a narrow beam may meet.
//!
//! Rays that have much in common, because they pass one point or leave one object, are told
//! apart by few numbers. Space of these numbers is cut into cells; all rays of a cell lie in a
//! [`Beam`](nestray_core::beam::Beam), and a list of the parts of the tree that the beam meets is
//! made when the first of them comes. Whoever has no list goes through the tree from its root, so
//! every ray is answered, and nobody waits for a list that another thread is making.
//!
//! What the light buffer, the eye buffer and their kin share.

mod cells;
mod classes;
mod cut;
mod emitter;
mod list;
mod origins;

use std::fmt::Debug;

use nestray_core::aabb::Aabb;
use nestray_core::bundle::{Bundle, Entrance};
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::simd::Simd;
use nestray_core::technique::{Expected, Index, Leaf, Leaves, Query, Repeats, Step, Walk};
use nestray_core::trail::{self, Trail};

use crate::lines;
use crate::wide_tree::{self, WideTree};

pub use self::cells::Limits;
pub(crate) use self::classes::Classes;
pub(crate) use self::cut::Forest;
pub(crate) use self::emitter::Emitters;
pub(crate) use self::list::List;
pub(crate) use self::origins::Origins;

/// A tree of boxes, and lists for beams of rays.
#[derive(Debug)]
pub struct Beams {
    forest: Forest,
    guide: Box<dyn Guide>,
}

/// Who knows the list for a ray.
pub(crate) trait Guide: Debug + Send + Sync {
    /// Whether it is worth asking for the lists of rays of this kind.
    fn may_know(&self, kind: RayKind) -> bool;

    /// Whether it has lists for rays of every kind, from anywhere.
    fn knows_all(&self) -> bool {
        false
    }

    /// Gives up lists made so far: leaves are about to be called otherwise.
    fn forget(&mut self) {}

    /// The list for a ray up to `limit`; made if there is none yet. None if there is none for
    /// this ray.
    fn find(&self, forest: &Forest, family: &dyn Family, ask: &Ask<'_>) -> Option<Found<'_>>;

    /// Memory in use.
    fn bytes(&self) -> u64;
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ask<'a> {
    pub(crate) ray: &'a Ray,
    /// Nothing farther counts.
    pub(crate) limit: f32,
    /// [`Query::ANY`].
    pub(crate) any: bool,
    /// [`Query::ALL`].
    pub(crate) all: bool,
}

/// A list for a ray, and the part of it that counts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<'a> {
    pub(crate) list: &'a List,
    /// What begins farther along the main axis, by the key of the list, does not count.
    pub(crate) to: f32,
    /// Where on the main axis the ray has parameter 0.
    pub(crate) from: f32,
    /// What the parameter grows by along the main axis; 0 if the order does not matter.
    pub(crate) scale: f32,
}

/// Lines sent to see what lists save.
const LINES: u32 = 256;

/// The place of a ray whose list is still to be looked up.
const LOOK_UP: Step = Step::onward((1 << 31) - 2);

impl Beams {
    /// A tree over all children, and the lists that `guide` knows.
    pub(crate) fn new(tree: WideTree, leaves: &Leaves, guide: Box<dyn Guide>) -> Self {
        Self { forest: Forest::new(tree, leaves), guide }
    }

    /// The tree.
    #[must_use]
    pub fn tree(&self) -> &WideTree {
        &self.forest.tree
    }

    /// Puts off what is in the list of a ray, nearest last, and takes that; goes to the root if
    /// there is no list.
    #[inline(always)]
    fn look_up<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut wide_tree::Cursor,
        limit: f32,
    ) -> Step {
        let ask = Ask { ray: walk.ray, limit, any: Q::ANY, all: Q::ALL };
        let Some(found) = self.guide.find(&self.forest, walk.family, &ask) else {
            return Step::onward(0);
        };
        for line in found.list.lines().iter().rev() {
            let begin = simd.load(&line.begin);
            let mask = simd.le(begin, simd.splat(found.to));
            let from = simd.sub(begin, simd.splat(found.from));
            let enter = simd.max(simd.mul(from, simd.splat(found.scale)), simd.splat(0.0));
            trail::put_off_all(simd, walk.trail, &mut cursor.top, mask, enter, &line.words);
        }
        self.resume::<S, Q>(simd, walk, cursor, limit)
    }
}

impl Index for Beams {
    const REPEATS: Repeats = Repeats::Never;
    const GATHERS: bool = true;
    type Cursor = wide_tree::Cursor;

    /// Of a random ray nothing is known, mostly: it goes through the tree. If there are lists for
    /// all rays, some lines say how much more or less they test.
    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected {
        let mut expected = self.forest.tree.expected(family, leaves);
        if self.guide.knows_all() {
            let root = self.forest.tree.nodes().next().into_iter().flatten();
            let bounds = root.fold(Aabb::EMPTY, |all, part| all.join(part.0));
            let mut tests = 0;
            expected.steps = lines::send(self, (LINES, &bounds), family, |leaf| {
                tests += leaves.of(leaf.0 as usize).len();
            });
            let through_tree: f32 = expected.tests.iter().sum();
            let change = tests as f32 / LINES as f32 / through_tree.max(f32::MIN_POSITIVE);
            expected.tests.iter_mut().for_each(|tests| *tests *= change);
        }
        expected
    }

    fn rename_leaves(&mut self, leaves: &[Leaf]) {
        self.guide.forget();
        self.forest.tree.rename_leaves(leaves);
    }

    fn bytes(&self) -> u64 {
        self.forest.bytes() + self.guide.bytes()
    }

    #[inline(always)]
    fn start<S: Simd>(
        &self,
        _simd: S,
        walk: &mut Walk<'_>,
        _limit: f32,
    ) -> (wide_tree::Cursor, Step) {
        let cursor = self.forest.tree.cursor(walk);
        (cursor, if self.guide.may_know(walk.ray.kind()) { LOOK_UP } else { Step::onward(0) })
    }

    #[inline(always)]
    fn gather<S: Simd>(
        &self,
        simd: S,
        bundle: &Bundle,
        trail: &mut Trail,
        entrance: &mut Entrance,
    ) -> bool {
        !self.guide.may_know(bundle.kind) && self.forest.tree.gather(simd, bundle, trail, entrance)
    }

    #[inline(always)]
    fn start_at<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        limit: f32,
        entrance: &Entrance,
    ) -> (wide_tree::Cursor, Step) {
        if self.guide.may_know(walk.ray.kind()) {
            return (self.forest.tree.cursor(walk), LOOK_UP);
        }
        self.forest.tree.start_at::<S, Q>(simd, walk, limit, entrance)
    }

    #[inline(always)]
    fn step<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut wide_tree::Cursor,
        at: Step,
        limit: f32,
    ) -> Step {
        if at == LOOK_UP {
            return self.look_up::<S, Q>(simd, walk, cursor, limit);
        }
        self.forest.tree.step::<S, Q>(simd, walk, cursor, at, limit)
    }

    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut wide_tree::Cursor,
        limit: f32,
    ) -> Step {
        self.forest.tree.resume::<S, Q>(simd, walk, cursor, limit)
    }

    #[inline(always)]
    fn address(&self, cursor: &wide_tree::Cursor, at: Step) -> *const u8 {
        self.forest.tree.address(cursor, at)
    }
}

#[cfg(test)]
mod tests;
