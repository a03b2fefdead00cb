//! A tree of boxes that move [Woop 17]: eight children to a node, each with a box that is linear
//! in time and the part of the shutter in which it is there.
//!
//! What `motion-bvh` and `spacetime` make. Where nothing moves, nodes are those of a
//! [`WideTree`]; how the boxes of the others change is kept apart.

mod emit;
mod expected;
mod grow;
mod linear;
mod moves;
mod reference;
#[cfg(test)]
pub(crate) mod tests;

use nestray_core::family::Family;
use nestray_core::simd::Simd;
use nestray_core::technique::{Expected, Index, Leaf, Leaves, Query, Repeats, Step, Visit, Walk};

use self::moves::Moves;
use crate::wide_tree::{self, WideTree, next, turn};

pub(crate) use self::grow::{Growing, Manner, Open, Timed, grow};
pub use self::linear::Linear;
pub(crate) use self::reference::Reference;

/// A tree of boxes that move, eight to a node.
#[derive(Debug)]
pub struct TimedTree {
    /// Boxes as they are when their time begins. The note of a node in which something moves
    /// is its place in `moves`, and 1.
    tree: WideTree,
    moves: Vec<Moves>,
    visits: Visits,
}

/// How often a ray may be shown one child.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Visits {
    /// Once: where a child stands in several leaves, those are there at different times.
    Once,
    /// In every leaf it stands in.
    Often,
}

/// One part of a node.
#[derive(Clone, Copy, Debug)]
pub struct Part {
    /// Its box.
    pub bounds: Linear,
    /// When it is there: `[from, until)`, or up to and with 1.
    pub time: [f32; 2],
    /// What it is.
    pub step: Step,
}

impl Part {
    /// How often a random line at a random time meets it, times the surface of all.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.bounds.mean_area() * f64::from(self.time[1] - self.time[0])
    }
}

/// Where a ray stands, and when.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    boxes: wide_tree::Cursor,
    time: f32,
}

impl TimedTree {
    /// A tree in which nothing moves.
    pub(crate) fn still(tree: WideTree) -> Self {
        Self { tree, moves: Vec::new(), visits: Visits::Once }
    }

    /// All nodes, root first, each with its parts; for reports and viewers.
    pub fn nodes(&self) -> impl Iterator<Item = Vec<Part>> + '_ {
        (0..).zip(self.tree.nodes()).map(|(node, parts)| {
            let moves = match self.tree.note(Step::onward(node)) {
                0 => None,
                note => Some(&self.moves[note as usize - 1]),
            };
            let part = |(lane, (begin, step))| match moves {
                Some(moves) => {
                    Part { bounds: moves.bounds(begin, lane), time: moves.time(lane), step }
                }
                None => Part { bounds: Linear::still(begin), time: [0.0, 1.0], step },
            };
            parts.into_iter().enumerate().map(part).collect()
        })
    }
}

impl Index for TimedTree {
    const REPEATS: Repeats = Repeats::ByRule;
    type Cursor = Cursor;

    /// A box is met as often as its surface, on average over its time, is to that of the box
    /// around all, times how long it is there.
    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected {
        expected::expected(self, family, leaves)
    }

    fn rename_leaves(&mut self, leaves: &[Leaf]) {
        self.tree.rename_leaves(leaves);
    }

    fn bytes(&self) -> u64 {
        self.tree.bytes() + size_of_val(self.moves.as_slice()) as u64
    }

    #[inline(always)]
    fn start<S: Simd>(&self, _simd: S, walk: &mut Walk<'_>, _limit: f32) -> (Cursor, Step) {
        let cursor = Cursor { time: walk.ray.time(), boxes: self.tree.cursor(walk) };
        (cursor, Step::onward(0))
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
        let (near, far, there) = match self.tree.note(at) {
            0 => {
                let (near, far) = self.tree.cut(simd, &cursor.boxes, at, limit);
                (near, far, 0xff)
            }
            note => {
                let moves = &self.moves[note as usize - 1];
                let (rows, there) = moves.rows_at(simd, self.tree.rows(at), cursor.time);
                let (near, far) = cursor.boxes.cut(simd, &rows, limit);
                (near, far, there)
            }
        };
        let (mask, words) = (simd.le(near, far) & there, self.tree.words(at));
        turn::<S, Q>(simd, walk.trail, &mut cursor.boxes.top, mask, near, words, limit)
    }

    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        limit: f32,
    ) -> Step {
        next::<S, Q>(simd, walk.trail, &mut cursor.boxes.top, limit)
    }

    #[inline(always)]
    fn address(&self, cursor: &Cursor, at: Step) -> *const u8 {
        self.tree.address(&cursor.boxes, at)
    }

    #[inline(always)]
    fn visit(&self, _cursor: &Cursor, _child: u32) -> Visit {
        match self.visits {
            Visits::Once => Visit::First,
            Visits::Often => Visit::Unknown,
        }
    }
}
