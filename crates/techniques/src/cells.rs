//! Trees of cells: space cut in two by axis-aligned planes, again and again. What the kd-tree,
//! the BSP tree and the octree share.
//!
//! A ray keeps the part of its way that is inside the cell it stands in. A plane cuts that in
//! two: the cell on this side first, the other one put off with its own part, so that cells
//! come in exact order [Havran 00]. Both parts reach beyond the plane by the slack of box tests
//! ([`Clip`]): a hit belongs to a cell that its child stands in, however it was rounded.

mod build;
mod children;
#[cfg(test)]
pub(crate) mod tests;

use std::fmt::Debug;

use nestray_core::aabb::{Aabb, Clip};
use nestray_core::family::Family;
use nestray_core::huge::Huge;
use nestray_core::simd::Simd;
use nestray_core::technique::{Expected, Index, Leaf, Leaves, Query, Repeats, Step, Walk};
use nestray_core::trail::{self, Top};

use crate::union::Standing;

pub use self::children::{Cell, Children};

/// A tree of cells.
#[derive(Debug)]
pub struct Cells {
    nodes: Huge<Node>,
    /// The word of a [`Step`].
    root: u32,
    bounds: Aabb,
    /// Whether packed leaves are tested whole.
    packed: bool,
}

/// Where cells are cut.
pub trait Rule: Debug {
    /// What a cell knows of how the cells around it were cut.
    type Memory: Copy + Default;

    /// Where to cut a cell; none to leave it whole.
    fn cut(&self, cell: &Cell<'_>, memory: Self::Memory) -> Option<(Plane, Self::Memory)>;
}

/// Where a cell is cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Across which axis.
    pub axis: usize,
    /// Where on it; inside the cell.
    pub at: f32,
}

/// A cut.
#[derive(Clone, Copy, Debug)]
struct Node {
    at: f32,
    axis: u32,
    /// What is below and above: a [`Step`] each, [`EMPTY`] if nothing.
    words: [u32; 2],
}

/// The word of a cell with nothing in it.
const EMPTY: u32 = Step::DONE.word();

/// Where a ray stands, and its own part of the tests of planes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    inverse: [f32; 3],
    /// `origin / dir`, plus slack: what to take off where the far side begins.
    near: [f32; 3],
    /// The same minus slack: where the near side ends.
    far: [f32; 3],
    /// The part of the ray inside the cell.
    span: [f32; 2],
    top: Top,
}

impl Cells {
    /// Cuts up the space around all `children` as `rule` says.
    pub fn new<R: Rule>(rule: &R, children: &Children, leaves: &mut Leaves) -> Self {
        build::build(rule, children, leaves)
    }

    /// All cells that have anything in them, with what that is: the number of a leaf, or none
    /// where the cell is cut further; for reports and viewers.
    #[must_use]
    pub fn cells(&self) -> Vec<(Aabb, Option<Leaf>)> {
        let mut cells = Vec::new();
        let mut open = vec![(self.root, self.bounds)];
        while let Some((word, bounds)) = open.pop() {
            let step = Step::from_word(word);
            if step.is_onward() {
                cells.push((bounds, None));
                let node = &self.nodes[word as usize];
                let [below, above] = halves(bounds, node.axis as usize, node.at);
                open.extend([(node.words[1], above), (node.words[0], below)]);
            } else if !step.is_done() {
                cells.push((bounds, Some(step.as_leaf())));
            }
        }
        cells
    }

    /// What all cells together span.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }
}

/// What is below and above a plane.
fn halves(bounds: Aabb, axis: usize, at: f32) -> [Aabb; 2] {
    let (mut below, mut above) = (bounds, bounds);
    below.max[axis] = at;
    above.min[axis] = at;
    [below, above]
}

impl Index for Cells {
    const REPEATS: Repeats = Repeats::Anywhere;
    type Cursor = Cursor;

    /// A cell is visited as often as its surface is to that of all; a child is tested once
    /// however many cells it is in, whenever one of them is crossed. Packed
    /// children are tested in every cell.
    fn expected(&self, family: &dyn Family, leaves: &Leaves) -> Expected {
        let whole = f64::from(self.bounds.surface_area()).max(f64::MIN_POSITIVE);
        let share = |bounds: Aabb| (f64::from(bounds.surface_area()) / whole).min(1.0);
        let mut expected = Expected { steps: 0.0, tests: vec![0.0; family.count() as usize] };
        let mut standing = Standing::default();
        for (bounds, leaf) in self.cells() {
            let Some(leaf) = leaf else {
                expected.steps += share(bounds);
                continue;
            };
            let inside = leaves.of(leaf.0 as usize);
            if self.packed {
                let chance = share(bounds) as f32;
                inside.iter().for_each(|&child| expected.tests[child as usize] += chance);
            } else {
                standing.add(bounds, inside);
            }
        }
        if !self.packed {
            expected.tests = standing.chances(family.count(), whole);
        }
        expected
    }

    fn rename_leaves(&mut self, leaves: &[Leaf]) {
        let rename = |word: &mut u32| *word = Step::from_word(*word).renamed(leaves).word();
        let mut nodes = self.nodes.to_vec();
        nodes.iter_mut().flat_map(|node| &mut node.words).for_each(rename);
        rename(&mut self.root);
        self.nodes = Huge::new(&nodes, 0);
    }

    fn bytes(&self) -> u64 {
        size_of_val::<[Node]>(&self.nodes) as u64
    }

    #[inline(always)]
    fn start<S: Simd>(&self, _simd: S, walk: &mut Walk<'_>, limit: f32) -> (Cursor, Step) {
        let clip = Clip::new(walk.ray, self.bounds.reach());
        let Some((enter, leave)) = clip.cut(&self.bounds, limit) else {
            return (Cursor::default(), Step::DONE);
        };
        let cursor = Cursor {
            inverse: clip.inverse.to_array(),
            near: clip.near.to_array(),
            far: clip.far.to_array(),
            span: [enter, leave],
            top: walk.trail.reset(),
        };
        (cursor, Step::from_word(self.root))
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
        let axis = node.axis as usize;
        let inverse = cursor.inverse[axis];
        let crossing = node.at * inverse;
        let begin = (crossing - cursor.near[axis]).max(cursor.span[0]);
        let end = (crossing - cursor.far[axis]).min(cursor.span[1]);
        let first = (inverse.to_bits() >> 31) as usize;
        let (near, far) = (node.words[first & 1], node.words[first & 1 ^ 1]);
        let is_near = (near != EMPTY) & (cursor.span[0] <= end);
        let is_far = (far != EMPTY) & (begin <= cursor.span[1]);
        if !(is_near | is_far) {
            return self.resume::<S, Q>(simd, walk, cursor, limit);
        }
        let put_off = [begin, cursor.span[1]];
        trail::put_off_span(walk.trail, &mut cursor.top, far, put_off, is_near & is_far);
        cursor.span = if is_near { [cursor.span[0], end] } else { put_off };
        Step::from_word(if is_near { near } else { far })
    }

    #[inline(always)]
    fn resume<S: Simd, Q: Query>(
        &self,
        _simd: S,
        walk: &mut Walk<'_>,
        cursor: &mut Cursor,
        limit: f32,
    ) -> Step {
        let (word, [begin, end]) = trail::take_span(walk.trail, &mut cursor.top, limit);
        cursor.span = [begin, end.min(limit)];
        Step::from_word(word)
    }

    #[inline(always)]
    fn address(&self, _cursor: &Cursor, at: Step) -> *const u8 {
        self.nodes.as_ptr().wrapping_add(at.word() as usize).cast()
    }
}
