//! What is known of the children while cells are cut.

use nestray_core::aabb::{Aabb, Clip};
use nestray_core::family::{Family, boxes};

/// All children.
#[derive(Debug)]
pub struct Children {
    /// Their boxes.
    pub boxes: Vec<Aabb>,
    /// What testing each costs, in nanoseconds.
    pub weights: Vec<f32>,
    /// [`Family::together`].
    pub together: u32,
    /// A box around all.
    pub bounds: Aabb,
}

/// A cell that may be cut.
#[derive(Clone, Copy, Debug)]
pub struct Cell<'a> {
    /// Where it is.
    pub bounds: Aabb,
    /// How many cells are around it.
    pub depth: u32,
    /// The children in it.
    pub inside: &'a [u32],
    /// All children.
    pub children: &'a Children,
}

impl Children {
    pub(crate) fn new(family: &dyn Family) -> Self {
        let boxes = boxes(family);
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.join(*b));
        let weights = family.weights();
        Self { boxes, weights, together: family.together(), bounds }
    }

    /// Whether leaves are packed and tested whole.
    #[must_use]
    pub fn are_packed(&self) -> bool {
        self.together > 1
    }

    /// How deep a tree of cells should be, after [Pharr 23].
    #[must_use]
    pub fn usual_depth(&self) -> u32 {
        let doublings = usize::BITS - self.boxes.len().leading_zeros();
        8 + (doublings * 13).div_ceil(10)
    }

    /// Cells with more children are cut: as many as set, or else a pack, or else `usual`.
    #[must_use]
    pub fn most_in_leaf(&self, set: usize, usual: usize) -> usize {
        match set {
            0 if self.are_packed() => self.together as usize,
            0 => usual,
            set => set,
        }
    }

    /// What testing `count` children of joint weight `weight` in one leaf costs, in
    /// nanoseconds: packed ones are tested several at a time.
    #[must_use]
    pub fn price(&self, count: usize, weight: f64) -> f64 {
        if !self.are_packed() || count == 0 {
            return weight;
        }
        weight / count as f64 * count.next_multiple_of(self.together as usize) as f64
    }
}

impl Cell<'_> {
    /// What testing all children in it costs, in nanoseconds.
    #[must_use]
    pub fn price(&self) -> f64 {
        let weights = self.inside.iter().map(|&child| self.children.weights[child as usize]);
        self.children.price(self.inside.len(), weights.map(f64::from).sum())
    }

    /// Where it begins and ends along an axis.
    #[must_use]
    pub fn extent(&self, axis: usize) -> [f32; 2] {
        [self.bounds.min[axis], self.bounds.max[axis]]
    }

    /// The middle along an axis; none if halves would be narrower than rounding.
    #[must_use]
    pub fn middle(&self, axis: usize) -> Option<f32> {
        let [low, high] = self.extent(axis);
        let least = 16.0 * Clip::SLACK * self.children.bounds.reach();
        (high - low > least).then_some(low * 0.5 + high * 0.5)
    }

    /// The part of a child's extent along an axis that is in the cell.
    #[must_use]
    pub fn part(&self, child: u32, axis: usize) -> [f32; 2] {
        let ([low, high], bounds) = (self.extent(axis), &self.children.boxes[child as usize]);
        [bounds.min[axis].max(low), bounds.max[axis].min(high)]
    }

    /// Whether a plane leaves a child out of either side.
    #[must_use]
    pub fn separates(&self, axis: usize, at: f32) -> bool {
        self.inside.iter().any(|&child| {
            let bounds = &self.children.boxes[child as usize];
            bounds.max[axis] <= at || bounds.min[axis] >= at
        })
    }
}
