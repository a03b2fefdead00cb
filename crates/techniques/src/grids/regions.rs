//! Boxes of empty cells, as large as they come [Devillers 89].
//!
//! How many cells of a block are occupied is a sum over its corners [Crow 84]. Empty cells
//! with the widest empty cube around them come first: the cube grows on all sides as long as it
//! stays empty, and becomes the region of all its cells that are in none where a line is expected
//! to go farther.

#[cfg(test)]
mod tests;

use super::block::Block;
use super::frame::Frame;
use super::{EMPTY, REGION};

/// Smaller blocks are not worth a region.
const LEAST: u64 = 8;
/// Cells looked at to hand out regions, at most, for each there is.
const WORK: u64 = 16;
/// Most regions: their numbers share a word with a bit.
const MOST: usize = (REGION - 1) as usize;

/// Finds regions and writes them into the words of empty cells.
pub(super) fn regions(frame: &Frame, words: &mut [u32]) -> Vec<Block> {
    let sums = Sums::new(frame, words);
    let cubes = cubes(frame, words, &sums);
    let widest = cubes.iter().copied().max().unwrap_or(0);
    let mut found = Found { frame, words, regions: Vec::new(), lengths: Vec::new() };
    let mut work = WORK * frame.count() as u64;
    // Widest first, in powers of two.
    let mut from = (widest + 1).next_power_of_two();
    let mut below = u16::MAX;
    while below > 0 {
        for (slot, &radius) in cubes.iter().enumerate() {
            if found.words[slot] != EMPTY || !(from..below).contains(&radius) {
                continue;
            }
            let cell = frame.cell_at(slot as u32);
            let region = grown(frame, &sums, around(frame, cell, radius.into()));
            if region.count() < LEAST {
                continue;
            }
            if region.count() > work || found.regions.len() == MOST {
                return found.regions;
            }
            work -= region.count();
            found.hand_out(region);
        }
        (from, below) = (from / 2, from);
    }
    found.regions
}

/// How many cells are occupied among those below each, along all axes.
struct Sums {
    sums: Vec<u32>,
    rows: [usize; 2],
}

impl Sums {
    fn new(frame: &Frame, words: &[u32]) -> Self {
        let [x, y, z] = frame.cells.map(|n| n as usize + 1);
        let rows = [x, x * y];
        let mut sums = vec![0; x * y * z];
        for [x, y, z] in frame.all().cells() {
            let at = Self::at(rows, [x + 1, y + 1, z + 1]);
            let [row, layer] = rows;
            let before: u32 =
                sums[at - 1] + sums[at - row] + sums[at - layer] + sums[at - 1 - row - layer];
            let twice = sums[at - 1 - row] + sums[at - 1 - layer] + sums[at - row - layer];
            let here = u32::from(words[frame.slot([x, y, z]) as usize] != EMPTY);
            sums[at] = here + before - twice;
        }
        Self { sums, rows }
    }

    fn at(rows: [usize; 2], [x, y, z]: [u32; 3]) -> usize {
        z as usize * rows[1] + y as usize * rows[0] + x as usize
    }

    fn is_empty(&self, block: &Block) -> bool {
        let (low, high) = (block.low(), block.high().map(|cell| cell + 1));
        let sum = |x: u32, y: u32, z: u32| self.sums[Self::at(self.rows, [x, y, z])];
        let layer = |z: u32| {
            sum(high[0], high[1], z) + sum(low[0], low[1], z)
                - (sum(low[0], high[1], z) + sum(high[0], low[1], z))
        };
        layer(high[2]) == layer(low[2])
    }
}

/// The block of cells no farther than `radius` from one.
fn around(frame: &Frame, cell: [u32; 3], radius: u32) -> Block {
    let high = [0, 1, 2].map(|axis| (cell[axis] + radius).min(frame.cells[axis] - 1));
    Block::new(cell.map(|at| at.saturating_sub(radius)), high)
}

/// How far from each empty cell all are empty. Neighbours differ by one at most.
fn cubes(frame: &Frame, words: &[u32], sums: &Sums) -> Vec<u16> {
    let widest = frame.cells.into_iter().max().unwrap_or(1);
    let mut radius = 0;
    let radius_of = |(slot, cell)| {
        if words[slot] != EMPTY {
            radius = 0;
            return 0;
        }
        radius = (radius + 1).min(widest);
        while radius > 0 && !sums.is_empty(&around(frame, cell, radius)) {
            radius -= 1;
        }
        radius as u16
    };
    frame.all().cells().enumerate().map(radius_of).collect()
}

/// Grows an empty block on all sides while it stays empty: by much first, and where it is
/// shortest first.
fn grown(frame: &Frame, sums: &Sums, mut block: Block) -> Block {
    let mut by = frame.cells.into_iter().max().unwrap_or(1).next_power_of_two();
    while by > 0 {
        let edges = edges(frame, &block);
        let mut axes = [0, 1, 2];
        axes.sort_by(|&a, &b| edges[a].total_cmp(&edges[b]));
        let mut grew = false;
        for axis in axes {
            let (mut low, mut high) = (block.low(), block.high());
            high[axis] += by;
            if high[axis] < frame.cells[axis] && sums.is_empty(&Block::new(low, high)) {
                block = Block::new(low, high);
                grew = true;
            }
            high = block.high();
            if low[axis] >= by {
                low[axis] -= by;
                if sums.is_empty(&Block::new(low, high)) {
                    block = Block::new(low, high);
                    grew = true;
                }
            }
        }
        // More than once the same only in single cells: larger ones were tried twice as large.
        by = if grew && by == 1 { 1 } else { by / 2 };
    }
    block
}

/// How long a block is along each axis.
fn edges(frame: &Frame, block: &Block) -> [f64; 3] {
    let size = frame.box_of(block).size();
    [size.x.into(), size.y.into(), size.z.into()]
}

/// Regions found, and the cells they are written to.
struct Found<'a> {
    frame: &'a Frame,
    words: &'a mut [u32],
    regions: Vec<Block>,
    /// How far a random line goes inside each.
    lengths: Vec<f64>,
}

impl Found<'_> {
    /// Gives a region to its cells, but for those in one where lines go farther.
    fn hand_out(&mut self, region: Block) {
        let [x, y, z] = edges(self.frame, &region);
        let length = 2.0 * x * y * z / (x * y + y * z + z * x);
        for cell in region.cells() {
            let word = &mut self.words[self.frame.slot(cell) as usize];
            if *word == EMPTY || self.lengths[(*word & !REGION) as usize] < length {
                *word = REGION | self.regions.len() as u32;
            }
        }
        self.regions.push(region);
        self.lengths.push(length);
    }
}
