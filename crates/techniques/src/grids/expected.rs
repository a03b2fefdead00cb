//! What a random ray is expected to do.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::simd::SCALAR;
use nestray_core::technique::{Asks, Expected, Index, Leaves, Step, Walk};
use nestray_core::trail::Trail;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::Grids;
use super::block::Block;
use crate::grid::resolution;

/// Lines sent through a grid with regions, which no formula counts the steps in.
const LINES: u32 = 4096;

/// A cell is visited as often as its surface is to that of all; a child is tested once however
/// many cells it is in, whenever one of them is crossed: about as often as the box around them.
/// Packed children are tested in every cell.
pub(super) fn expected(grids: &Grids, family: &dyn Family, leaves: &Leaves) -> Expected {
    let whole = f64::from(grids.bounds().surface_area()).max(f64::MIN_POSITIVE);
    let share = |bounds: Aabb| (f64::from(bounds.surface_area()) / whole).min(1.0);
    let mut expected = Expected { steps: 0.0, tests: vec![0.0; family.count() as usize] };
    let mut hulls = vec![Aabb::EMPTY; if grids.packed { 0 } else { expected.tests.len() }];
    for frame in &grids.frames {
        // Lines are as likely to cross a part of a grid as it is large.
        expected.steps += share(frame.bounds) * resolution::steps(frame.cells, frame.bounds);
        for (slot, cell) in (frame.base..).zip(frame.all().cells()) {
            let step = Step::from_word(grids.words[slot as usize]);
            if step.is_onward() {
                continue;
            }
            let bounds = frame.box_of(&Block::new(cell, cell));
            for &child in leaves.of(step.as_leaf().0 as usize) {
                match hulls.get_mut(child as usize) {
                    Some(hull) => *hull = hull.join(bounds),
                    None => expected.tests[child as usize] += share(bounds) as f32,
                }
            }
        }
    }
    for (tests, hull) in expected.tests.iter_mut().zip(hulls) {
        *tests = share(hull) as f32;
    }
    if let Some(wide) = grids.wide {
        for &child in leaves.of(wide.0 as usize) {
            expected.tests[child as usize] = 1.0;
        }
    }
    if !grids.regions.is_empty() {
        expected.steps = steps_of_lines(grids, family);
    }
    expected
}

/// Steps of random lines on average, by sending some.
fn steps_of_lines(grids: &Grids, family: &dyn Family) -> f64 {
    let mut numbers = Pcg64Mcg::seed_from_u64(0);
    let (mut steps, mut trail) = (0, Trail::new());
    for _ in 0..LINES {
        let ray = line(grids.bounds(), &mut numbers);
        let mut walk = Walk { ray: &ray, trail: &mut trail, family };
        let limit = f32::INFINITY;
        let (mut cursor, mut at) = grids.start(SCALAR, &mut walk, limit);
        while !at.is_done() {
            at = if at.is_onward() {
                steps += 1;
                grids.step::<_, Asks<true, false>>(SCALAR, &mut walk, &mut cursor, at, limit)
            } else {
                grids.resume::<_, Asks<true, false>>(SCALAR, &mut walk, &mut cursor, limit)
            };
        }
    }
    f64::from(steps) / f64::from(LINES)
}

/// A random line through a box, all as likely: it comes in through any point of a face, the more
/// likely the straighter.
fn line(bounds: Aabb, numbers: &mut Pcg64Mcg) -> Ray {
    let mut next = || numbers.random::<f32>();
    let size = bounds.size();
    let areas = [size.y * size.z, size.z * size.x, size.x * size.y];
    let mut pick = next() * (areas[0] + areas[1] + areas[2]);
    let axis = areas.iter().position(|area| {
        pick -= area;
        pick < 0.0
    });
    let axis = axis.unwrap_or(2);
    let mut point = bounds.min + Vec3A::new(next(), next(), next()) * size;
    let is_low = next() < 0.5;
    point[axis] = if is_low { bounds.min[axis] } else { bounds.max[axis] };
    loop {
        let (u, v) = (next() * 2.0 - 1.0, next() * 2.0 - 1.0);
        let inwards = 1.0 - u * u - v * v;
        if inwards > 0.0 {
            let mut dir = Vec3A::ZERO;
            dir[axis] = inwards.sqrt() * if is_low { 1.0 } else { -1.0 };
            dir[(axis + 1) % 3] = u;
            dir[(axis + 2) % 3] = v;
            return Ray::new(point, dir, RayKind::Camera);
        }
    }
}
