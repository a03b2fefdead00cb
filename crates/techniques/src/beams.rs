//! A tree of boxes with lists beside it: of what rays of a narrow beam may meet.
//!
//! Rays that have much in common, because they pass one point or leave one object, are told
//! apart by few numbers. Space of these numbers is cut into cells; all rays of a cell lie in a
//! [`Beam`](nestray_core::beam::Beam), and a list of the parts of the tree that the beam meets is
//! made when the first of them comes. Whoever has no list goes through the tree from its root, so
//! every ray is answered, and nobody waits for a list that another thread is making.
//!
//! What the light buffer, the eye buffer and their kin share.

mod arena;
mod cells;
mod classes;
mod cut;
mod emitter;
mod guide;
mod list;
mod origins;
mod path;

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::packet::Packet;
use nestray_core::ray::RayKind;
use nestray_core::simd::Simd;
use nestray_core::technique::{
    Expected, Index, Lead, Leaf, Leaves, Led, Query, Repeats, Step, Walk,
};
use nestray_core::trail::{self, Trail};

use self::cells::{Cells, Maker, Next, Place};
use self::guide::{Ask, Guide, Search};
use self::list::{Parts, Serves};
use crate::lines;
use crate::wide_tree::{self, WideTree};

pub(crate) use self::cells::Limits;
pub(crate) use self::classes::Classes;
pub(crate) use self::cut::Forest;
pub(crate) use self::emitter::Emitters;
pub(crate) use self::origins::Origins;

/// A tree of boxes, and lists for beams of rays.
#[derive(Debug)]
pub struct Beams {
    forest: Forest,
    guide: Box<dyn Guide>,
    cells: Cells,
}

/// Where a ray stands in the tree, or on the way to its list.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    tree: wide_tree::Cursor,
    search: Search,
}

/// Lines sent to see what lists save.
const LINES: u32 = 256;

/// From here on places are lines of lists, not nodes of the tree.
const LISTS: u32 = 1 << 29;
/// From here on they are words of cells.
const CELLS: u32 = 1 << 30;
/// The place of a ray whose cell is still to be looked up.
const LOOK_UP: u32 = (1 << 31) - 1;

const _: () = assert!(CELLS + Place::END == 1 << 31, "places fit in the bits there are");

impl Beams {
    /// A tree over all children, and the lists of the cells of `roots` that `guide` knows.
    pub(crate) fn new(
        tree: WideTree,
        leaves: &Leaves,
        guide: Box<dyn Guide>,
        (roots, limits): (usize, Limits),
    ) -> Self {
        Self { forest: Forest::new(tree, leaves), guide, cells: Cells::new(roots, limits) }
    }

    /// The tree.
    #[must_use]
    pub fn tree(&self) -> &WideTree {
        &self.forest.tree
    }

    /// Goes through the tree.
    #[inline(always)]
    fn go_to_root(&self, walk: &mut Walk<'_>, cursor: &mut Cursor) -> Step {
        cursor.tree = self.forest.tree.cursor(walk);
        Step::onward(0)
    }

    /// Finds out which cell a ray is in.
    #[inline(always)]
    fn look_up(&self, walk: &mut Walk<'_>, cursor: &mut Cursor, ask: &Ask<'_>) -> Step {
        let Some(found) = self.guide.search(&self.forest, walk.family, &self.cells, ask) else {
            return self.go_to_root(walk, cursor);
        };
        cursor.search = Search { bits: self.cells.first(), ..found };
        match self.cells.enter(found.root, found.path) {
            Some(place) => Step::onward(CELLS + place.0),
            None => self.go_to_root(walk, cursor),
        }
    }

    /// Goes from a cell to the part of it that the ray is in, or to its list.
    #[inline(always)]
    fn go_on(&self, walk: &mut Walk<'_>, cursor: &mut Cursor, place: Place) -> Step {
        let search = &mut cursor.search;
        let rest = search.path.after(search.bits);
        let mut next = self.cells.next(place, rest);
        if next == Next::Unknown {
            self.know(walk, search, place);
            next = self.cells.next(place, rest);
        }
        match next {
            Next::Cell(part) => {
                search.bits += 4;
                Step::onward(CELLS + part.0)
            }
            Next::List(line) => Step::onward(LISTS + line),
            Next::Leaf(word) => Step::from_word(word),
            Next::Done => Step::DONE,
            Next::Nowhere | Next::Unknown => self.go_to_root(walk, cursor),
        }
    }

    /// Makes what there is to know of a cell.
    #[cold]
    #[inline(never)]
    fn know(&self, walk: &Walk<'_>, search: &Search, place: Place) {
        let (forest, family) = (&self.forest, walk.family);
        let beam = |cell| self.guide.beam((forest, family), walk.ray, search.root, cell);
        let cell = search.path.cell(search.bits);
        self.cells.know(place, cell, &Maker { forest, family, beam: &beam });
    }

    /// Puts off what is in the list of a ray, nearest last, and takes that; goes to the root if
    /// the list does not serve.
    #[inline(always)]
    fn put_off<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        mut line: u32,
        limit: f32,
    ) -> Step {
        let search = cursor.search;
        let mut parts = Parts::read(self.cells.line(line));
        match parts.serves(search.range, search.nearest, walk.family, &walk.ray.source()) {
            Serves::All => {}
            // Any hit will do, and there is one.
            Serves::Hidden if Q::ANY => return Step::HIT,
            Serves::Hidden => {}
            Serves::Nothing => return self.go_to_root(walk, cursor),
        }
        if parts.has_trees {
            cursor.tree = self.forest.tree.cursor(walk);
        }
        let tree = &mut cursor.tree;
        loop {
            let begin = simd.load(&parts.begin);
            let mask = simd.le(begin, simd.splat(search.to));
            let from = simd.sub(begin, simd.splat(search.from));
            let enter = simd.max(simd.mul(from, simd.splat(search.scale)), simd.splat(0.0));
            trail::put_off_all(simd, walk.trail, &mut tree.top, mask, enter, &parts.words);
            if !parts.goes_on {
                break;
            }
            line += 1;
            parts = Parts::read(self.cells.line(line));
        }
        self.forest.tree.resume::<S, Q>(simd, walk, tree, limit)
    }
}

impl Beams {
    /// Where a ray is before its cell was looked up.
    #[inline(always)]
    fn before(&self, walk: &mut Walk<'_>) -> Cursor {
        Cursor { tree: self.forest.tree.idle_cursor(walk), search: Search::default() }
    }
}

impl Index for Beams {
    const REPEATS: Repeats = Repeats::Never;
    const TELLS: bool = true;
    const LEADS: bool = true;
    type Cursor = Cursor;

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
        self.cells.forget();
        self.forest.tree.rename_leaves(leaves);
    }

    fn bytes(&self) -> u64 {
        self.forest.bytes() + self.guide.bytes() + self.cells.bytes()
    }

    #[inline(always)]
    fn start<S: Simd>(&self, _simd: S, walk: &mut Walk<'_>, _limit: f32) -> (Cursor, Step) {
        let mut cursor = Cursor::default();
        if self.guide.may_know(walk.ray.kind()) {
            return (self.before(walk), Step::onward(LOOK_UP));
        }
        let at = self.go_to_root(walk, &mut cursor);
        (cursor, at)
    }

    #[inline(always)]
    fn leads(&self, kind: RayKind) -> bool {
        !self.guide.may_know(kind)
    }

    #[inline(always)]
    fn leads_again(&self) -> bool {
        self.forest.tree.leads_again()
    }

    #[inline(always)]
    fn lead_in<S: Simd>(&self, simd: S, packet: &mut Packet, trail: &mut Trail) -> Option<Lead> {
        self.forest.tree.lead_in(simd, packet, trail)
    }

    #[inline(always)]
    fn lead_on<S: Simd>(
        &self,
        simd: S,
        packet: &Packet,
        trail: &mut Trail,
        lead: &mut Lead,
    ) -> Led {
        self.forest.tree.lead_on(simd, packet, trail, lead)
    }

    #[inline(always)]
    fn step<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        at: Step,
        limit: f32,
    ) -> Step {
        match at.word() {
            LOOK_UP => {
                let ask = Ask { ray: walk.ray, limit, any: Q::ANY, all: Q::ALL };
                self.look_up(walk, cursor, &ask)
            }
            word @ CELLS.. => self.go_on(walk, cursor, Place(word - CELLS)),
            word @ LISTS.. => self.put_off::<S, Q>(simd, walk, cursor, word - LISTS, limit),
            _ => self.forest.tree.step::<S, Q>(simd, walk, &mut cursor.tree, at, limit),
        }
    }

    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        limit: f32,
    ) -> Step {
        self.forest.tree.resume::<S, Q>(simd, walk, &mut cursor.tree, limit)
    }

    #[inline(always)]
    fn address(&self, cursor: &Cursor, at: Step) -> *const u8 {
        match at.word() {
            word @ CELLS..=LOOK_UP => self.cells.address_of(Place(word - CELLS)),
            word @ LISTS..CELLS => self.cells.address(word - LISTS),
            _ => self.forest.tree.address(&cursor.tree, at),
        }
    }
}

#[cfg(test)]
mod tests;
