//! A tree of boxes, eight children to a node [Wald 08], whoever built it.
//!
//! Builders differ in how they put children together; what they make is a binary tree. It is cut
//! into nodes of eight here, and all go through it alike.

mod binary;
mod collapse;
mod emit;
mod forests;
mod kernel;
mod led;
mod parts;

use nestray_core::aabb::{Aabb, Clip};
use nestray_core::family::Family;
use nestray_core::huge::Huge;
use nestray_core::packet::Packet;
use nestray_core::simd::Simd;
use nestray_core::technique::{
    Expected, Index, Lead, Leaf, Leaves, Led, Query, Repeats, Step, Visit, Walk,
};
use nestray_core::trail::{self, Top, Trail};

use crate::union::Standing;

pub use self::binary::{Binary, Contents, Outlook, Pair, area, in_halves};
pub(crate) use self::collapse::MAX_DEPTH;
pub(crate) use self::forests::Forests;
pub use self::kernel::Cursor;

/// A tree of boxes, eight to a node.
#[derive(Debug)]
pub struct WideTree {
    nodes: Huge<Node>,
    /// Largest coordinate of the boxes, which rounding errors are relative to.
    reach: f32,
    /// How far rounding may move a box or a hit, relative to that.
    slack: f32,
    /// Whether children may stand in several leaves.
    is_split: bool,
}

/// How many children a leaf may have, and what it costs.
#[derive(Clone, Copy, Debug)]
pub struct LeafSize {
    /// Most children.
    pub most: usize,
    /// What testing a packed leaf costs, in visits of a node.
    pub cost: f32,
}

/// The boxes of eight children and what they are. Children that are missing have an
/// empty box. The largest child is last, where a search for any hit looks first.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
struct Node {
    /// Lower x of all, upper x, lower y, …
    rows: [[f32; 8]; 6],
    /// A [`Step`] each.
    words: [u32; 8],
    /// Room for a word about the node, which keeps nodes at four cache lines.
    spare: [u32; 8],
}

impl WideTree {
    /// The nodes of the binary tree that `build` makes. It is told from which level on it has to
    /// split in halves, so that no input makes the tree deep.
    pub fn new(
        size: LeafSize,
        family: &dyn Family,
        leaves: &mut Leaves,
        build: impl for<'a> Fn(&'a Contents, usize) -> Binary<'a>,
    ) -> Self {
        let of = Contents::new(family);
        let (nodes, is_split) =
            collapse::collapsed(size, leaves, |halves_from| build(&of, halves_from));
        let all = of.boxes.iter().fold(Aabb::EMPTY, |all, bounds| all.join(*bounds));
        let reach = all.reach();
        let slack = if is_split { SPLIT_SLACK } else { Clip::SLACK };
        Self { nodes: Huge::new(&nodes, 0), reach, slack, is_split }
    }

    /// Where a ray begins.
    #[inline(always)]
    pub(crate) fn cursor(&self, walk: &mut Walk<'_>) -> Cursor {
        Cursor::new(walk.ray, self.reach, self.slack, walk.trail.reset())
    }

    /// Nowhere, with nothing put off: of no use to go through the tree.
    #[inline(always)]
    pub(crate) fn idle_cursor(&self, walk: &mut Walk<'_>) -> Cursor {
        let mut cursor = Cursor::default();
        cursor.top = walk.trail.reset();
        cursor
    }

    /// What the lanes of a node are.
    #[inline(always)]
    pub(crate) fn words(&self, at: Step) -> &[u32; 8] {
        &self.nodes[at.word() as usize].words
    }

    /// A word about a node; 0 if there is none.
    #[inline(always)]
    pub(crate) fn note(&self, at: Step) -> u32 {
        self.nodes[at.word() as usize].spare[0]
    }

    /// The same tree with a word about each node.
    pub(crate) fn with_notes(mut self, notes: &[u32]) -> Self {
        for (node, &note) in self.nodes.iter_mut().zip(notes) {
            node.spare[0] = note;
        }
        self
    }

    /// Where a ray enters and leaves the boxes of a node, up to `limit`.
    #[inline(always)]
    pub(crate) fn cut<S: Simd>(
        &self,
        simd: S,
        cursor: &Cursor,
        at: Step,
        limit: f32,
    ) -> (S::F32, S::F32) {
        cursor.cut(simd, &self.nodes[at.word() as usize].rows, limit)
    }

    /// The largest coordinate of all boxes.
    pub(crate) fn reach(&self) -> f32 {
        self.reach
    }

    /// All nodes, root first, each with the boxes that are there and what is in them; for
    /// reports and viewers.
    pub fn nodes(&self) -> impl Iterator<Item = Vec<(Aabb, Step)>> + '_ {
        self.nodes.iter().map(|node| {
            (0..8)
                .map(|lane| (node.bounds(lane), Step::from_word(node.words[lane])))
                .filter(|(bounds, _)| bounds.is_bounded())
                .collect()
        })
    }
}

/// How far rounding may move a box or a hit, relative to the largest coordinate, where children
/// are split: a hit is near the part of its child in some leaf, but not cut to the box of it.
const SPLIT_SLACK: f32 = 3.0 * Clip::SLACK;

impl Index for WideTree {
    const REPEATS: Repeats = Repeats::ByRule;
    const COPIES: usize = 1;
    const LEADS: bool = true;
    const FEW: u32 = 4;
    type Cursor = Cursor;

    /// A node is visited as often as its box is met, its surface to the root's [Goldsmith 87]. A
    /// child in several leaves is tested once, if not packed.
    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected {
        let root = (0..8).map(|lane| self.nodes[0].bounds(lane)).fold(Aabb::EMPTY, Aabb::join);
        let whole = area(root).max(f64::MIN_POSITIVE);
        let mut expected = Expected { steps: 1.0, tests: vec![0.0; family.count() as usize] };
        let mut standing = Standing::default();
        let is_once = self.is_split && family.together() == 1;
        let lanes = self.nodes.iter().flat_map(|node| (0..8).map(move |lane| (node, lane)));
        for (node, lane) in lanes {
            let (bounds, step) = (node.bounds(lane), Step::from_word(node.words[lane]));
            if !bounds.is_bounded() {
                continue;
            }
            let chance = (area(bounds) / whole).min(1.0);
            if step.is_onward() {
                expected.steps += chance;
                continue;
            }
            let inside = leaves.of(step.as_leaf().0 as usize);
            if is_once {
                standing.add(bounds, inside);
            } else {
                inside.iter().for_each(|&child| expected.tests[child as usize] += chance as f32);
            }
        }
        if is_once {
            expected.tests = standing.chances(family.count(), whole);
        }
        expected
    }

    fn rename_leaves(&mut self, leaves: &[Leaf]) {
        for word in self.nodes.iter_mut().flat_map(|node| &mut node.words) {
            *word = Step::from_word(*word).renamed(leaves).word();
        }
    }

    fn bytes(&self) -> u64 {
        size_of_val::<[Node]>(&self.nodes) as u64
    }

    #[inline(always)]
    fn start<S: Simd>(&self, _simd: S, walk: &mut Walk<'_>, _limit: f32) -> (Cursor, Step) {
        (self.cursor(walk), Step::onward(0))
    }

    #[inline(always)]
    fn leads_again(&self) -> bool {
        self.is_split
    }

    #[inline(always)]
    fn lead_in<S: Simd>(&self, simd: S, packet: &mut Packet, trail: &mut Trail) -> Option<Lead> {
        self.packet_in(simd, packet, trail)
    }

    #[inline(always)]
    fn lead_on<S: Simd>(
        &self,
        simd: S,
        packet: &Packet,
        trail: &mut Trail,
        lead: &mut Lead,
    ) -> Led {
        self.packet_on(simd, packet, trail, lead)
    }

    #[inline(always)]
    fn part(&self, packet: &Packet, ray: usize, trail: &mut Trail) -> Cursor {
        Cursor::of(packet.clip(ray), trail.reset())
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
        let node = &self.nodes[at.word() as usize];
        let (mask, enter) = node.clip(simd, cursor, limit);
        turn::<S, Q>(simd, walk.trail, &mut cursor.top, mask, enter, &node.words, limit)
    }

    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        limit: f32,
    ) -> Step {
        next::<S, Q>(simd, walk.trail, &mut cursor.top, limit)
    }

    #[inline(always)]
    fn address(&self, _cursor: &Cursor, at: Step) -> *const u8 {
        self.nodes.as_ptr().wrapping_add(at.word() as usize).cast()
    }

    #[inline(always)]
    fn visit(&self, _cursor: &Cursor, _child: u32) -> Visit {
        if self.is_split { Visit::Unknown } else { Visit::First }
    }
}

/// Goes on to the nearest of the lanes in `mask`, which begin at `enter`, and puts off the rest.
#[inline(always)]
pub(crate) fn turn<S: Simd, Q: Query>(
    simd: S,
    trail: &mut Trail,
    top: &mut Top,
    mask: u32,
    enter: S::F32,
    words: &[u32; 8],
    limit: f32,
) -> Step {
    Step::from_word(match (Q::MANY, Q::ANY) {
        (true, true) => simd.turn(trail, top, mask, words),
        (true, false) => simd.turn_sorted(trail, top, mask, enter, words, limit),
        // One ray: the three cases are worth a branch each.
        (false, _) if mask == 0 => return next::<S, Q>(simd, trail, top, limit),
        (false, _) if mask & (mask - 1) == 0 => words[mask.trailing_zeros() as usize & 7],
        (false, true) => simd.put_off(trail, top, mask, words),
        (false, false) => simd.put_off_sorted(trail, top, mask, enter, words),
    })
}

/// Goes on to what was put off last, of all that begins within `limit`.
#[inline(always)]
pub(crate) fn next<S: Simd, Q: Query>(simd: S, trail: &Trail, top: &mut Top, limit: f32) -> Step {
    Step::from_word(match (Q::MANY, Q::ANY) {
        (_, true) => trail::take_last(trail, top),
        (true, false) => simd.take(trail, top, limit),
        (false, false) => trail::take(trail, top, limit),
    })
}
