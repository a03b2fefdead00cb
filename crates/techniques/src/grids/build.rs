//! Filling the cells, and cutting crowded ones up again.

use std::fmt::Debug;

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::huge::Huge;
use nestray_core::technique::{Leaf, Leaves, Step};

use super::block::Block;
use super::frame::{Frame, Outer};
use super::resolution::{MOST_ENTRIES, MOST_EXTRA};
use super::{EMPTY, Grids, regions};
use crate::cells::Children;

/// Boxes are widened by at least this many times what rounding may be off among the children:
/// rays from half as many times as far away need no detour.
const FAR: f32 = 8.0;
/// Cells are at least so many times as wide as the least by which boxes are widened.
const NARROW: f32 = 4.0;
/// Most grids around a cell: they are built one inside the other.
const MAX_DEPTH: u32 = 8;

/// Which cells get a grid of their own.
pub(crate) trait Rule: Debug {
    /// The part of a cell to cut up, of a cell with children in `hull`.
    fn part(&self, cell: Aabb, hull: Aabb) -> Aabb;

    /// Into how many cells to cut it, along each axis; none to leave it whole. Always some if
    /// `depth` is 0.
    fn cut(&self, crowd: &Crowd<'_>) -> Option<[u32; 3]>;

    /// Whether to gather empty cells into regions.
    fn has_regions(&self) -> bool {
        false
    }
}

/// A cell that may be cut up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crowd<'a> {
    /// What would be cut up.
    pub(crate) bounds: Aabb,
    /// How many grids are around it.
    pub(crate) depth: u32,
    /// The children in it.
    pub(crate) inside: &'a [u32],
    /// All children.
    pub(crate) children: &'a Children,
    /// Cells must not be narrower.
    pub(crate) least: f32,
}

impl Crowd<'_> {
    /// The parts of the children's boxes that may be inside, and what testing each costs.
    pub(crate) fn parts(&self) -> (Vec<Aabb>, Vec<f32>) {
        let part = |&child: &u32| {
            let bounds = self.children.boxes[child as usize];
            let min = bounds.min.min(self.bounds.max).max(self.bounds.min);
            Aabb { min, max: bounds.max.min(self.bounds.max).max(min) }
        };
        let weight = |&child: &u32| self.children.weights[child as usize];
        (self.inside.iter().map(part).collect(), self.inside.iter().map(weight).collect())
    }
}

impl Grids {
    /// Puts all `children` into a grid, and those of its cells into grids again as `rule` says.
    pub(crate) fn new(rule: &dyn Rule, children: &Children, leaves: &mut Leaves) -> Self {
        let bounds = thickened(children.bounds);
        let reach = bounds.reach();
        let pad = FAR * Clip::SLACK * reach;
        let mut growing =
            Growing { rule, children, pad, frames: Vec::new(), words: Vec::new(), leaves };
        let inside: Vec<u32> = (0..children.boxes.len() as u32).collect();
        let crowd = Crowd { bounds, depth: 0, inside: &inside, children, least: NARROW * pad };
        let cells = rule.cut(&crowd).unwrap_or([1; 3]);
        let Outermost { frame, wide, narrow, room } = Outermost::new(&crowd, cells, pad);
        let blocks = children.boxes.iter().map(|bounds| frame.block_of(bounds)).collect();
        let wide: Option<Leaf> = (!wide.is_empty()).then(|| growing.leaves.push(&wide));
        growing.grow(frame, narrow, 0, room);
        let Growing { frames, mut words, .. } = growing;
        let regions =
            if rule.has_regions() { regions::regions(&frames[0], &mut words) } else { Vec::new() };
        let once = frames.len() == 1 && !children.are_packed();
        Self {
            frames,
            words: Huge::new(&words, 0),
            regions,
            reach,
            wide,
            blocks: if once { blocks } else { Vec::new() },
            packed: children.are_packed(),
        }
    }
}

/// Not flat: cells must have a size along every axis.
fn thickened(bounds: Aabb) -> Aabb {
    let least = bounds.size().max_element().max(bounds.reach() * 1e-5).max(1e-30) * 1e-3;
    let missing = (Vec3A::splat(least) - bounds.size()).max(Vec3A::ZERO) * 0.5;
    Aabb { min: bounds.min - missing, max: bounds.max + missing }
}

/// The outermost grid, before it is filled.
struct Outermost {
    frame: Frame,
    /// Children that would be in most cells, and all others.
    wide: Vec<u32>,
    narrow: Vec<u32>,
    /// Most entries in leaves.
    room: f64,
}

impl Outermost {
    /// With as many cells as asked for, or half as many along each axis until lists are short
    /// enough.
    fn new(crowd: &Crowd<'_>, mut cells: [u32; 3], pad: f32) -> Self {
        let boxes = &crowd.children.boxes;
        loop {
            let frame = Frame::new(crowd.bounds, cells, pad, Vec3A::INFINITY);
            let all = frame.count() as u64;
            let mut entries = 0;
            let (wide, narrow): (Vec<u32>, Vec<u32>) = crowd.inside.iter().partition(|&&child| {
                let count = frame.block_of(&boxes[child as usize]).count();
                let is_wide = all > 64 && count * 4 > all;
                entries += if is_wide { 0 } else { count };
                is_wide
            });
            let room = MOST_ENTRIES * narrow.len() as f64 + MOST_EXTRA;
            // If all are wide, many cells would be empty.
            if all == 1 || (entries as f64 <= room && !narrow.is_empty()) {
                return Self { frame, wide, narrow, room };
            }
            cells = if narrow.is_empty() { [1; 3] } else { cells.map(|n| n.div_ceil(2)) };
        }
    }
}

/// The children of every cell of a grid, one after the other.
struct Lists {
    children: Vec<u32>,
    /// Where the children of each cell end.
    ends: Vec<u32>,
}

impl Lists {
    /// In two passes: count, then fill; none if there are more than `room` entries.
    fn new(frame: &Frame, all: &[Aabb], inside: &[u32], room: f64) -> Option<Self> {
        let block = |child: u32| frame.block_of(&all[child as usize]);
        let mut ends = vec![0u32; frame.count() + 1];
        let mut entries = 0;
        for &child in inside {
            let block = block(child);
            entries += block.count();
            if entries as f64 > room {
                return None;
            }
            for cell in block.cells() {
                ends[(frame.slot(cell) - frame.base) as usize] += 1;
            }
        }
        let mut total = 0u32;
        for end in &mut ends {
            total += std::mem::replace(end, total);
        }
        let mut children = vec![0u32; total as usize];
        for &child in inside {
            for cell in block(child).cells() {
                let end = &mut ends[(frame.slot(cell) - frame.base) as usize];
                children[*end as usize] = child;
                *end += 1;
            }
        }
        ends.pop();
        Some(Self { children, ends })
    }

    /// The children of each cell, in the order of slots.
    fn each(&self) -> impl Iterator<Item = &[u32]> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let list = &self.children[start as usize..end as usize];
            start = end;
            list
        })
    }
}

struct Growing<'a> {
    rule: &'a dyn Rule,
    children: &'a Children,
    /// Boxes are widened by at least this.
    pad: f32,
    frames: Vec<Frame>,
    words: Vec<u32>,
    leaves: &'a mut Leaves,
}

impl Growing<'_> {
    /// Puts `inside` into the cells of a grid and cuts up those cells, with no more than `room`
    /// entries in leaves, if that is enough; returns the word for it, or else for a leaf.
    fn grow(&mut self, mut frame: Frame, inside: Vec<u32>, depth: u32, room: f64) -> u32 {
        let Some(lists) = Lists::new(&frame, &self.children.boxes, &inside, room) else {
            return Step::leaf(self.leaves.push(&inside)).word();
        };
        drop(inside);
        let (grid, base) = (self.frames.len() as u32, self.words.len());
        frame.base = base as u32;
        let (all, pad) = (frame.all(), frame.pad);
        self.words.resize(base + frame.count(), EMPTY);
        self.frames.push(frame);
        let each = room / lists.children.len().max(1) as f64;
        for (slot, (cell, list)) in all.cells().zip(lists.each()).enumerate() {
            if !list.is_empty() {
                let outer = Outer { grid, cell: cell.map(|at| at as u16) };
                let room = each * list.len() as f64;
                let bounds = self.frames[grid as usize].box_of(&Block::new(cell, cell));
                self.words[base + slot] = self.fill((bounds, list), outer, pad, depth + 1, room);
            }
        }
        grid
    }

    /// Makes a grid of a cell if that pays, and otherwise a leaf.
    fn fill(
        &mut self,
        (cell, inside): (Aabb, &[u32]),
        outer: Outer,
        pad: Vec3A,
        depth: u32,
        room: f64,
    ) -> u32 {
        let children = self.children;
        let hull = || {
            let boxes = inside.iter().map(|&child| children.boxes[child as usize]);
            let hull = boxes.fold(Aabb::EMPTY, Aabb::join);
            Aabb { min: hull.min - pad, max: hull.max + pad }
        };
        if depth < MAX_DEPTH && inside.len() > 1 {
            let bounds = self.rule.part(cell, hull());
            let crowd = Crowd { bounds, depth, inside, children, least: NARROW * self.pad };
            let has_size = bounds.size().min_element() > 0.0;
            let cells = if has_size { self.rule.cut(&crowd) } else { None };
            if let Some(cells) = cells.filter(|&cells| cells != [1; 3]) {
                let mut frame = Frame::new(bounds, cells, self.pad, pad);
                frame.outer = Some(outer);
                return self.grow(frame, inside.to_vec(), depth, room);
            }
        }
        Step::leaf(self.leaves.push(inside)).word()
    }
}
