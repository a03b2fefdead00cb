//! One grid: where its cells are.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;

use super::block::Block;

/// Boxes are widened by this part of a cell: the more, the farther away rays may start
/// before they take the slow way.
const PAD: f32 = 0.02;

/// One grid, without what is in it.
#[derive(Debug)]
pub(super) struct Frame {
    /// What rays are in it for.
    pub(super) bounds: Aabb,
    /// The lowest corner of the first cell: the outermost walls are farther out than `bounds`, so
    /// that no ray crosses them before it leaves.
    origin: Vec3A,
    cell_size: Vec3A,
    /// How many cells there are along each axis.
    pub(super) cells: [u32; 3],
    /// Boxes were made wider by this on every side.
    pub(super) pad: Vec3A,
    /// The least of it.
    pub(super) least_pad: f32,
    /// The first cell's place among those of all grids.
    pub(super) base: u32,
    /// The cell it stands in.
    pub(super) outer: Option<Outer>,
}

/// A cell of another grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outer {
    pub(super) grid: u32,
    pub(super) cell: [u16; 3],
}

impl Frame {
    /// Cuts `bounds` into cells. Boxes are to be widened by `least` or more, and no more than
    /// `most`.
    pub(super) fn new(bounds: Aabb, cells: [u32; 3], least: f32, most: Vec3A) -> Self {
        let count = Vec3A::from_array(cells.map(|n| n as f32));
        let pad = (bounds.size() / count * PAD).max(Vec3A::splat(least)).min(most);
        Self {
            bounds,
            origin: bounds.min - pad,
            cell_size: (bounds.size() + pad * 2.0) / count,
            cells,
            pad,
            least_pad: pad.min_element(),
            base: 0,
            outer: None,
        }
    }

    /// The cell a point lies in, clamped to the grid.
    #[inline(always)]
    pub(super) fn cell_of(&self, point: Vec3A) -> [u32; 3] {
        let at = (point - self.origin) / self.cell_size;
        // NaN and negative become 0.
        let along = |axis: usize| (at[axis] as u32).min(self.cells[axis] - 1);
        [along(0), along(1), along(2)]
    }

    /// Where a cell's word is.
    #[inline(always)]
    pub(super) fn slot(&self, [x, y, z]: [u32; 3]) -> u32 {
        self.base + (z * self.cells[1] + y) * self.cells[0] + x
    }

    /// The cell with the word number `number` of the grid.
    pub(super) fn cell_at(&self, number: u32) -> [u32; 3] {
        let [x, y, _] = self.cells;
        [number % x, number / x % y, number / x / y]
    }

    /// How many cells there are in all.
    pub(super) fn count(&self) -> usize {
        self.cells.iter().map(|&n| n as usize).product()
    }

    /// Every cell, in the order of slots.
    pub(super) fn all(&self) -> Block {
        Block::new([0; 3], self.cells.map(|n| n - 1))
    }

    /// Where wall number `wall` across `axis` is.
    #[inline(always)]
    pub(super) fn wall(&self, wall: u32, axis: usize) -> f32 {
        self.origin[axis] + wall as f32 * self.cell_size[axis]
    }

    /// Where a ray leaves `cell` along `axis`.
    #[inline(always)]
    pub(super) fn crossing(&self, ray: &Ray, forward: u8, cell: u32, axis: usize) -> f32 {
        let wall = self.wall(cell + u32::from(forward >> axis & 1), axis);
        (wall - ray.origin()[axis]) * ray.inverse_dir()[axis]
    }

    /// The cells a box touches, widened by the pad.
    pub(super) fn block_of(&self, bounds: &Aabb) -> Block {
        Block::new(self.cell_of(bounds.min - self.pad), self.cell_of(bounds.max + self.pad))
    }

    /// What of `bounds` is in a block of cells.
    pub(super) fn box_of(&self, block: &Block) -> Aabb {
        let at = |cell: [u32; 3]| {
            self.origin + Vec3A::from_array(cell.map(|c| c as f32)) * self.cell_size
        };
        let cells = Aabb { min: at(block.low()), max: at(block.high().map(|cell| cell + 1)) };
        cells.meet(self.bounds)
    }

    /// The axis along which a ray crosses most cells.
    #[inline(always)]
    pub(super) fn far_axis(&self, ray: &Ray) -> u8 {
        let pace = ray.dir().abs() / self.cell_size;
        if pace.x >= pace.y && pace.x >= pace.z { 0 } else { 1 + u8::from(pace.y < pace.z) }
    }
}
