//! How many cells.

use glam::Vec3A;
use nestray_core::aabb::Aabb;

use super::build::Crowd;
use super::frame::Frame;
use crate::grid::resolution::{self, Counted, Limits, STEP, cube_root, halves, steps};

/// Most entries in leaves for each child, and for all together.
pub(super) const MOST_ENTRIES: f64 = 16.0;
pub(super) const MOST_EXTRA: f64 = 4096.0;
/// Most cells along one axis, and most cells of one grid.
const MOST_CELLS: f64 = 1024.0;
const MOST_ALL: f64 = (1u32 << 23) as f64;

/// Densities to choose from where empty cells cost little, in cells per child.
const FINE: [f64; 8] = [0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];

/// About cubical cells, `wanted` in all but for rounding.
pub(crate) fn cubical(crowd: &Crowd<'_>, wanted: f64) -> [u32; 3] {
    let limits = Limits { least: crowd.least, along: MOST_CELLS, all: MOST_ALL };
    resolution::cubical(crowd.bounds, wanted, &limits)
}

/// As many cells as asked for, or the most below for which lists do not outgrow the children.
pub(crate) fn fitting(crowd: &Crowd<'_>, density: f64) -> [u32; 3] {
    let (boxes, weights) = crowd.parts();
    let counted = counted(crowd, &boxes, &weights);
    let count = crowd.inside.len() as f64;
    let mut tried = halves(density, count).map(|wanted| cubical(crowd, wanted));
    tried.find(|&cells| counted.fits(cells)).unwrap_or([1; 3])
}

/// What makes testing the children cheapest for a random line, of `densities` in cells a child;
/// and the costs of that and of testing them all, in nanoseconds.
pub(crate) fn cheapest(crowd: &Crowd<'_>, densities: &[f64]) -> ([u32; 3], f64, f64) {
    let (boxes, weights) = crowd.parts();
    let counted = counted(crowd, &boxes, &weights);
    let count = crowd.inside.len() as f64;
    let all = crowd.children.price(boxes.len(), weights.iter().map(|&w| f64::from(w)).sum());
    let (cells, cost) = densities
        .iter()
        .map(|&density| cubical(crowd, density * count))
        .filter(|&cells| counted.fits(cells))
        .map(|cells| (cells, counted.cost(cells)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap_or(([1; 3], all));
    (cells, cost, all)
}

/// As [`cheapest`], for an outermost grid whose cells with more than `few` children get grids of
/// their own, where that pays: as many cells as are cheapest for small children, `(2nt/s)^⅓` along
/// an edge if `n` children are in a cell and tests take `t` and steps `s`.
pub(crate) fn cheapest_around(crowd: &Crowd<'_>, densities: &[f64], few: usize) -> [u32; 3] {
    let (boxes, weights) = crowd.parts();
    let counted = counted(crowd, &boxes, &weights);
    let cost = |&cells: &[u32; 3]| {
        let frame = Frame::new(crowd.bounds, cells, 0.0, Vec3A::INFINITY);
        let slots: Vec<u32> = boxes.iter().map(|b| frame.slot(frame.cell_of(b.center()))).collect();
        let mut counts = vec![0u32; frame.count()];
        slots.iter().for_each(|&slot| counts[slot as usize] += 1);
        let size = crowd.bounds.size() / Vec3A::from_array(cells.map(|n| n as f32));
        let whole = area(crowd.bounds.size());
        let of_child = |(child, &slot): (usize, &u32)| {
            let (weight, edges) = (f64::from(weights[child]), boxes[child].size());
            // In how many cells it is, and how many children are in one of them.
            let many = ((edges + size) / size).as_dvec3().element_product();
            let together = f64::from(counts[slot as usize]) * many;
            let tests =
                |size: Vec3A| area((edges + size).min(crowd.bounds.size())) / whole * weight;
            if together <= few as f64 {
                return tests(size);
            }
            let along = cube_root(2.0 * together * weight / STEP).max(1.0);
            let steps = area(size) / whole * (along + 1.0) * STEP * many / together;
            tests(size).min(tests(size / along as f32) + steps)
        };
        let inside: f64 = slots.iter().enumerate().map(of_child).sum();
        steps(cells, crowd.bounds) * STEP + inside
    };
    let count = boxes.len() as f64;
    densities
        .iter()
        .map(|&density| cubical(crowd, density * count))
        .filter(|&cells| counted.fits(cells))
        .map(|cells| (cells, cost(&cells)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or([1; 3], |(cells, _)| cells)
}

/// Half the surface of a box.
fn area(size: Vec3A) -> f64 {
    let s = size.as_dvec3();
    s.x * s.y + s.y * s.z + s.z * s.x
}

/// Which part of the children in it a random line through a cell is shown, if the cell is cut up
/// so; weighted by what testing them costs.
pub(crate) fn shown(crowd: &Crowd<'_>, cells: [u32; 3]) -> f64 {
    let (boxes, weights) = crowd.parts();
    let all: f64 = weights.iter().map(|&weight| f64::from(weight)).sum();
    counted(crowd, &boxes, &weights).tests(cells) / all
}

fn counted<'a>(crowd: &Crowd<'_>, boxes: &'a [Aabb], weights: &'a [f32]) -> Counted<'a> {
    Counted { bounds: crowd.bounds, boxes, weights, together: crowd.children.together }
}

/// What is cheapest for a random line that crosses empty space in large steps.
pub(crate) fn sparsest(crowd: &Crowd<'_>) -> [u32; 3] {
    let (boxes, weights) = crowd.parts();
    let counted = counted(crowd, &boxes, &weights);
    let cost = |&cells: &[u32; 3]| {
        let occupied = occupied(crowd, &boxes, cells);
        // Between two occupied cells there is an empty one as often as cells are empty.
        let visited = occupied * (2.0 - occupied);
        steps(cells, crowd.bounds) * visited * STEP + counted.tests(cells)
    };
    let count = boxes.len() as f64;
    let found = FINE
        .iter()
        .map(|&density| cubical(crowd, density * count))
        .filter(|&cells| counted.fits(cells))
        .map(|cells| (cells, cost(&cells)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    // Where children overlap much, even these may be too many.
    let coarser = || halves(FINE[0], count).map(|wanted| cubical(crowd, wanted));
    found
        .map(|(cells, _)| cells)
        .or_else(|| coarser().find(|&cells| counted.fits(cells)))
        .unwrap_or([1; 3])
}

/// Which part of the cells has children in it, but for children in most of them.
fn occupied(crowd: &Crowd<'_>, boxes: &[Aabb], cells: [u32; 3]) -> f64 {
    let frame = Frame::new(crowd.bounds, cells, 0.0, Vec3A::INFINITY);
    let room = MOST_ENTRIES * boxes.len() as f64 + MOST_EXTRA;
    let mut entries = 0.0;
    let mut marked = vec![0u64; frame.count().div_ceil(64)];
    for block in boxes.iter().map(|bounds| frame.block_of(bounds)) {
        if block.count() * 4 <= frame.count() as u64 {
            entries += block.count() as f64;
            if entries > room {
                return 1.0;
            }
            for cell in block.cells() {
                let slot = frame.slot(cell) as usize;
                marked[slot / 64] |= 1 << (slot % 64);
            }
        }
    }
    let count: u32 = marked.iter().map(|word| word.count_ones()).sum();
    f64::from(count) / frame.count() as f64
}
