//! Rays with so much in common that an index can be searched once for all of them.
//!
//! Rays through neighbouring pixels take the same way through the upper part of a tree, and
//! most of what they do not meet none of them meets. So a technique may look up, once for a
//! *bundle*, the few places that any of its rays can meet: its [`Entrance`]. Every ray of
//! the bundle then starts there instead of at the root. What is found is the same.

use glam::Vec3A;

use crate::aabb::Aabb;
use crate::beam::Beam;
use crate::ray::{Ray, RayKind};

/// Most rays in a bundle.
pub const RAYS: usize = 16;

/// Neighbouring rays.
#[derive(Clone, Copy, Debug)]
pub struct Bundle {
    /// All of them lie in it.
    pub beam: Beam,
    /// What the first of them was cast for, and mostly all.
    pub kind: RayKind,
}

impl Bundle {
    /// Widest range of slopes of neighbours: a twentieth of what an eye sees.
    const WIDEST: f32 = 0.05;
    /// Fewest rays that are worth it.
    const FEWEST: usize = 4;

    /// The bundle of all of `rays`, if they are neighbours.
    #[inline]
    #[must_use]
    pub fn of(rays: &[Ray]) -> Option<Self> {
        let [first, .., last] = rays else { return None };
        // Most rays that are not neighbours are told apart here.
        let (a, b) = (first.dir(), last.dir());
        let size = a.abs().max_element();
        if rays.len() < Self::FEWEST || (a - b).abs().max_element() > size * (2.0 * Self::WIDEST) {
            return None;
        }
        let axis = if size == a.x.abs() {
            0
        } else if size == a.y.abs() {
            1
        } else {
            2
        };
        let (next, last) = ([1, 2, 0][axis], [2, 0, 1][axis]);
        let backward = a[axis] < 0.0;
        let mut slopes = [[f32::INFINITY, f32::NEG_INFINITY]; 2];
        let mut origin = Aabb::EMPTY;
        for ray in rays {
            let (dir, start) = (ray.dir(), ray.origin());
            let along = if backward { -dir[axis] } else { dir[axis] };
            // Not for a void ray either: it need not be anywhere near.
            if along < 0.25 * size || ray.t_min() > ray.t_max() {
                return None;
            }
            for (range, axis) in slopes.iter_mut().zip([next, last]) {
                let slope = dir[axis] / along;
                *range = [range[0].min(slope), range[1].max(slope)];
            }
            origin = origin.with(start);
        }
        if slopes.iter().any(|[low, high]| high - low > Self::WIDEST) {
            return None;
        }
        // A slope is rounded once.
        let [u, v] = slopes.map(|[low, high]| {
            let slack = low.abs().max(high.abs()) * f32::EPSILON;
            [low - slack, high + slack]
        });
        let beam = Beam { origin, axis, backward, u, v, farthest: f32::INFINITY };
        Some(Self { beam, kind: first.kind() })
    }

    /// Largest coordinate of an origin.
    #[inline]
    #[must_use]
    pub fn reach(&self) -> f32 {
        self.beam.origin.min.abs().max(self.beam.origin.max.abs()).max_element()
    }

    /// How far apart the rays start, along the axis where that is most.
    #[inline]
    #[must_use]
    pub fn spread(&self) -> f32 {
        (self.beam.origin.max - self.beam.origin.min).max(Vec3A::ZERO).max_element()
    }
}

/// Where the rays of a bundle start: up to sixteen boxes, in blocks of eight, and what a
/// technique calls what is in them. The block met first comes first.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Entrance {
    blocks: [Block; Self::BLOCKS],
    count: usize,
}

/// Lower x of eight boxes, upper x, lower y, …, and a word for each; boxes that are missing
/// are empty.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Block {
    /// The boxes.
    pub rows: [[f32; 8]; 6],
    /// What is in them, as [`Step::word`](crate::technique::Step::word)s.
    pub words: [u32; 8],
}

impl Block {
    const EMPTY: Self = {
        let (low, high) = ([f32::INFINITY; 8], [f32::NEG_INFINITY; 8]);
        Self { rows: [low, high, low, high, low, high], words: [0; 8] }
    };
}

impl Entrance {
    const BLOCKS: usize = 2;
    /// Most boxes.
    pub const ROOM: usize = 8 * Self::BLOCKS;

    /// With no boxes: nothing can be met.
    pub const EMPTY: Self = Self { blocks: [Block::EMPTY; Self::BLOCKS], count: 0 };

    /// Forgets all boxes.
    #[inline(always)]
    pub fn clear(&mut self) {
        for block in &mut self.blocks[..self.count.div_ceil(8)] {
            *block = Block::EMPTY;
        }
        self.count = 0;
    }

    /// How many boxes there are.
    #[inline(always)]
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Adds lane `lane` of eight boxes; false if there is no room.
    #[inline(always)]
    #[must_use]
    pub fn push(&mut self, rows: &[[f32; 8]; 6], lane: usize, word: u32) -> bool {
        let Some(block) = self.blocks.get_mut(self.count / 8) else { return false };
        for (to, from) in block.rows.iter_mut().zip(rows) {
            to[self.count % 8] = from[lane & 7];
        }
        block.words[self.count % 8] = word;
        self.count += 1;
        true
    }

    /// The blocks that hold something.
    #[inline(always)]
    #[must_use]
    pub fn blocks(&self) -> &[Block] {
        &self.blocks[..self.count.div_ceil(8)]
    }
}
