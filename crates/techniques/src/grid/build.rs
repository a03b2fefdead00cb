//! Filling the cells.

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::family::{Family, boxes};
use nestray_core::huge::Huge;
use nestray_core::technique::{Leaves, Step};

use super::resolution::resolution;
use super::{EMPTY, Grid, GridIndex, Span};

/// Boxes are widened by this part of a cell: the more, the farther away rays may start
/// before neighbours of cells have to be shown.
const PAD: f32 = 0.02;

pub(super) fn build(params: &Grid, family: &dyn Family, leaves: &mut Leaves) -> GridIndex {
    let boxes = boxes(family);
    let bounds = boxes.iter().fold(Aabb::EMPTY, |all, b| all.join(*b));
    let bounds = thickened(bounds);
    let weights = family.weights();
    let cells = resolution(params, bounds, &boxes, &weights, family.together());
    let count = Vec3A::from_array(cells.map(|n| n as f32));
    let pad = (bounds.size() / count * PAD).max(Vec3A::splat(2.0 * Clip::SLACK * bounds.reach()));
    // Walls are crossed early: also the outermost must not be, before the last child is.
    let bounds = Aabb { min: bounds.min - pad, max: bounds.max + pad };
    let mut grid = GridIndex {
        bounds,
        cells,
        cell_size: bounds.size() / count,
        pad,
        words: Huge::default(),
        wide: None,
        spans: Vec::new(),
    };
    let spans: Vec<Span> = boxes.iter().map(|b| grid.span_of(b)).collect();
    let wide: Vec<u32> = (0..)
        .zip(&spans)
        .filter(|(_, span)| is_wide(span, cells))
        .map(|(child, _)| child)
        .collect();
    if !wide.is_empty() {
        grid.wide = Some(leaves.push(&wide));
    }
    grid.words = fill(&grid, &spans, leaves);
    grid.spans = if family.together() > 1 { Vec::new() } else { spans };
    grid
}

/// Not flat: cells must have a size along every axis.
fn thickened(bounds: Aabb) -> Aabb {
    let least = bounds.size().max_element().max(bounds.reach() * 1e-5).max(1e-30) * 1e-3;
    let missing = (Vec3A::splat(least) - bounds.size()).max(Vec3A::ZERO) * 0.5;
    Aabb { min: bounds.min - missing, max: bounds.max + missing }
}

/// Whether a child would be in so many cells that it is better tested first of all.
fn is_wide(span: &Span, cells: [u32; 3]) -> bool {
    let all: u64 = cells.iter().map(|&n| u64::from(n)).product();
    all > 64 && span.count() * 4 > all
}

impl Span {
    /// All cells.
    pub(super) fn all(cells: [u32; 3]) -> Self {
        Self { low: [0; 3], high: cells.map(|n| (n - 1) as u16) }
    }

    fn count(&self) -> u64 {
        (0..3).map(|axis| u64::from(self.high[axis] - self.low[axis]) + 1).product()
    }

    /// The cells, x fastest.
    pub(super) fn cells(self) -> impl Iterator<Item = [u32; 3]> {
        let along = move |axis: usize| u32::from(self.low[axis])..=u32::from(self.high[axis]);
        along(2).flat_map(move |z| along(1).flat_map(move |y| along(0).map(move |x| [x, y, z])))
    }
}

impl GridIndex {
    /// The cells a box touches, widened by the pad.
    fn span_of(&self, bounds: &Aabb) -> Span {
        let cells = |point: Vec3A| self.cell_of(point).map(|cell| cell as u16);
        Span { low: cells(bounds.min - self.pad), high: cells(bounds.max + self.pad) }
    }
}

/// Lists the children of every cell, in two passes: count, then fill.
fn fill(grid: &GridIndex, spans: &[Span], leaves: &mut Leaves) -> Huge<u32> {
    let count = grid.cells.iter().map(|&n| n as usize).product::<usize>();
    let narrow = || (0..).zip(spans).filter(|(_, span)| !is_wide(span, grid.cells));
    let mut ends = vec![0u32; count + 1];
    for (_, span) in narrow() {
        for cell in span.cells() {
            ends[grid.slot(cell) as usize] += 1;
        }
    }
    let mut total = 0u32;
    for end in &mut ends {
        total += std::mem::replace(end, total);
    }
    let mut children = vec![0u32; total as usize];
    for (child, span) in narrow() {
        for cell in span.cells() {
            let end = &mut ends[grid.slot(cell) as usize];
            children[*end as usize] = child;
            *end += 1;
        }
    }
    let mut start = 0;
    let words: Vec<u32> = ends[..count]
        .iter()
        .map(|&end| {
            let list = &children[start as usize..end as usize];
            start = end;
            if list.is_empty() { EMPTY } else { Step::leaf(leaves.push(list)).word() }
        })
        .collect();
    Huge::new(&words, 0)
}
