//! What a random ray is expected to do.

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::technique::{Expected, Leaves, Step};

use super::Grids;
use super::block::Block;
use crate::grid::resolution;
use crate::lines;
use crate::union::Standing;

/// Lines sent through a grid with regions, which no formula counts the steps in.
const LINES: u32 = 4096;

/// A cell is visited as often as its surface is to that of all; a child is tested once however
/// many cells it is in, whenever one of them is crossed ([`Standing`]). Packed children are tested
/// in every cell.
pub(super) fn expected(grids: &Grids, family: &dyn Family, leaves: &Leaves) -> Expected {
    let whole = f64::from(grids.bounds().surface_area()).max(f64::MIN_POSITIVE);
    let share = |bounds: Aabb| (f64::from(bounds.surface_area()) / whole).min(1.0);
    let mut expected = Expected { steps: 0.0, tests: vec![0.0; family.count() as usize] };
    let mut standing = Standing::default();
    for frame in &grids.frames {
        // Lines are as likely to cross a part of a grid as it is large.
        expected.steps += share(frame.bounds) * resolution::steps(frame.cells, frame.bounds);
        for (slot, cell) in (frame.base..).zip(frame.all().cells()) {
            let step = Step::from_word(grids.words[slot as usize]);
            if step.is_onward() {
                continue;
            }
            let bounds = frame.box_of(&Block::new(cell, cell));
            let inside = leaves.of(step.as_leaf().0 as usize);
            if grids.packed {
                let chance = share(bounds) as f32;
                inside.iter().for_each(|&child| expected.tests[child as usize] += chance);
            } else {
                standing.add(bounds, inside);
            }
        }
    }
    if !grids.packed {
        expected.tests = standing.chances(family.count(), whole);
    }
    if let Some(wide) = grids.wide {
        for &child in leaves.of(wide.0 as usize) {
            expected.tests[child as usize] = 1.0;
        }
    }
    if !grids.regions.is_empty() {
        expected.steps = lines::send(grids, (LINES, &grids.bounds()), family, |_| {});
    }
    expected
}
