//! Grids within grids, and boxes of empty cells crossed in one step [Devillers 89]: what nested
//! grids, adaptive grids and macro-regions share.
//!
//! A cell holds nothing, children, a grid of its own, or it is part of a *region*: a box of empty
//! cells. A grid within a cell knows that cell, so a ray that leaves it goes on outside without
//! having kept anything: where it crosses the next wall follows from the cell alone.
//!
//! At every moment a ray is in one cell of one grid, by where it crosses the walls along each
//! axis; that may be off by rounding, and boxes are widened by more before they are put into
//! cells. Rays from so far away that this is not enough take another way (`far.rs`).

mod block;
mod build;
mod expected;
mod far;
mod frame;
mod moves;
mod regions;
pub(crate) mod resolution;
#[cfg(test)]
mod tests;

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::family::Family;
use nestray_core::huge::Huge;
use nestray_core::simd::Simd;
use nestray_core::technique::{Expected, Index, Leaf, Leaves, Query, Repeats, Step, Visit, Walk};

use self::block::Block;
pub(crate) use self::build::{Crowd, Rule};
use self::frame::Frame;

/// Grids within grids.
#[derive(Debug)]
pub struct Grids {
    /// All grids, the outermost first.
    frames: Vec<Frame>,
    /// What is in each cell of each grid: nothing ([`EMPTY`]), the word of a leaf, the number of
    /// a grid, or that of a region and [`REGION`].
    words: Huge<u32>,
    /// Boxes of empty cells.
    regions: Vec<Block>,
    /// The largest coordinate.
    reach: f32,
    /// Children that would be in most cells: tested first, by every ray.
    wide: Option<Leaf>,
    /// The cells of each child; empty if there is more than one grid, or if packed leaves are
    /// tested whole.
    blocks: Vec<Block>,
    /// Whether packed leaves are tested whole.
    packed: bool,
}

/// The word of a cell with nothing in it; the outermost grid is in no cell.
const EMPTY: u32 = 0;
/// The words of cells in a region have this bit.
const REGION: u32 = 1 << 30;

/// Where a ray stands.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    /// The grid, and the cell of it.
    grid: u32,
    cell: [u32; 3],
    /// Where the ray leaves its cell along each axis, and where the grid.
    crossing: [f32; 3],
    exit: f32,
    /// The axis of the wall just crossed; [`FIRST`] if what is met is new to the ray. For rays
    /// from far away the axis they go along.
    axis: u8,
    /// Bit `i` is set if cells along axis `i` are crossed upwards.
    forward: u8,
    /// Whether the ray is from far away, for this grid.
    far: bool,
    /// Whether the first cell is still to come.
    before: bool,
}

/// What is met now was not met before.
const FIRST: u8 = 3;

impl Grids {
    /// How many grids there are, and how many regions; for reports and viewers.
    #[must_use]
    pub fn counts(&self) -> [usize; 2] {
        [self.frames.len(), self.regions.len()]
    }

    /// How many cells the outermost grid has along each axis.
    #[must_use]
    pub fn cells(&self) -> [u32; 3] {
        self.frames[0].cells
    }

    /// What all cells together span.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.frames[0].bounds
    }
}

impl Index for Grids {
    const REPEATS: Repeats = Repeats::ByRule;
    type Cursor = Cursor;

    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected {
        expected::expected(self, family, leaves)
    }

    fn rename_leaves(&mut self, leaves: &[Leaf]) {
        let rename = |&word: &u32| Step::from_word(word).renamed(leaves).word();
        self.words = Huge::new(&self.words.iter().map(rename).collect::<Vec<_>>(), 0);
        self.wide = self.wide.map(|leaf| leaves[leaf.0 as usize]);
    }

    fn bytes(&self) -> u64 {
        let blocks = self.regions.len() + self.blocks.len();
        let small = blocks * size_of::<Block>() + self.frames.len() * size_of::<Frame>();
        4 * self.words.len() as u64 + small as u64
    }

    #[inline(always)]
    fn start<S: Simd>(&self, _simd: S, walk: &mut Walk<'_>, limit: f32) -> (Cursor, Step) {
        let clip = Clip::new(walk.ray, self.reach);
        let Some(span) = self.span(&clip, 0, limit) else {
            return (Cursor::default(), Step::DONE);
        };
        let forward = clip.inverse.cmpge(Vec3A::ZERO).bitmask() as u8;
        let mut cursor = Cursor { axis: FIRST, forward, ..Cursor::default() };
        let first = self.place(walk.ray, &mut cursor, 0, span);
        match self.wide {
            Some(leaf) => (Cursor { before: true, ..cursor }, Step::leaf(leaf)),
            None => (cursor, first),
        }
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
        let word = self.words[at.word() as usize];
        let inside = Step::from_word(word);
        if !inside.is_onward() {
            return inside;
        }
        if word & REGION != 0 {
            if !cursor.far {
                self.cross(walk.ray, cursor, word & !REGION);
            }
        } else if word != EMPTY {
            let clip = Clip::new(walk.ray, self.reach);
            if let Some(span) = self.span(&clip, word, limit) {
                return self.place(walk.ray, cursor, word, span);
            }
        }
        let next = self.resume::<S, Q>(simd, walk, cursor, limit);
        // Who comes from an empty cell has not met what is in the next one.
        cursor.axis = if cursor.far { cursor.axis } else { FIRST };
        next
    }

    /// Steps over the nearest cell wall.
    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        _simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        limit: f32,
    ) -> Step {
        if cursor.before {
            cursor.before = false;
            return Step::onward(self.frames[cursor.grid as usize].slot(cursor.cell));
        }
        loop {
            if cursor.far {
                if let Some(step) = self.resume_far(walk.ray, cursor, limit) {
                    return step;
                }
            } else {
                let [x, y, z] = cursor.crossing;
                let axis = if x <= y && x <= z { 0 } else { 1 + usize::from(y > z) };
                // The outermost walls are beyond where the ray leaves its grid, for the next cell
                // of the one around it.
                if cursor.crossing[axis] > limit && cursor.exit > limit {
                    return Step::DONE;
                }
                let frame = &self.frames[cursor.grid as usize];
                // Below zero wraps around to more than there are.
                let way = if cursor.forward >> axis & 1 == 1 { 1 } else { u32::MAX };
                let next = cursor.cell[axis].wrapping_add(way);
                if cursor.crossing[axis] <= cursor.exit && next < frame.cells[axis] {
                    cursor.cell[axis] = next;
                    cursor.axis = axis as u8;
                    cursor.crossing[axis] = frame.crossing(walk.ray, cursor.forward, next, axis);
                    return Step::onward(frame.slot(cursor.cell));
                }
            }
            if !self.climb(walk.ray, cursor) {
                return Step::DONE;
            }
        }
    }

    #[inline(always)]
    fn address(&self, _cursor: &Cursor, at: Step) -> *const u8 {
        self.words.as_ptr().wrapping_add(at.word() as usize).cast()
    }

    /// A child of one grid is in every cell of a block, which a ray crosses in one go: it is new
    /// where the ray enters the block.
    #[inline(always)]
    fn visit(&self, cursor: &Cursor, child: u32) -> Visit {
        if cursor.far {
            return Visit::Unknown;
        }
        let Some(block) = self.blocks.get(child as usize) else { return Visit::Unknown };
        if cursor.axis == FIRST {
            return Visit::First;
        }
        let axis = usize::from(cursor.axis);
        let up = cursor.forward >> axis & 1 == 1;
        let wall = if up { block.low()[axis] } else { block.high()[axis] };
        if cursor.cell[axis] == wall { Visit::First } else { Visit::Again }
    }
}
