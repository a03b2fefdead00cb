//! What holds of all grids within grids.

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::technique::{Leaf, Leaves, Step, Technique};

use super::Grids;
use super::block::Block;
use super::frame::Frame;
use crate::adaptive_grid::AdaptiveGrid;
use crate::cells::tests::{Boxes, boxes};
use crate::counted::{Numbers, expected_and_counted, spheres, walk};
use crate::macro_regions::MacroRegions;
use crate::nested_grid::NestedGrid;

pub(super) fn made<T: Technique<Index = Grids>>(technique: &T, family: &Boxes) -> (Grids, Leaves) {
    let mut leaves = Leaves::default();
    let grids = technique.build(family, &mut leaves);
    (grids, leaves)
}

/// Sends a ray through; returns the leaves shown and the number of steps.
pub(super) fn send(grids: &Grids, family: &Boxes, ray: &Ray) -> (Vec<u32>, usize) {
    let mut shown = Vec::new();
    let steps = walk(grids, family, ray, |leaf, _| shown.push(leaf.0));
    (shown, steps)
}

/// Rays from near and far, some along an axis, some along walls or nearly so; some end on the way.
pub(super) fn rays(seed: u64, grids: &Grids, count: usize) -> Vec<Ray> {
    let mut numbers = Numbers::new(seed);
    let bounds = grids.bounds();
    let ray = |i: usize| {
        let mut dir = numbers.direction();
        for axis in 0..3 {
            if i / 8 % 4 > axis {
                dir[(axis + i / 32) % 3] = [0.0, -0.0, 0.02, -0.003][i / 2 % 4];
            }
        }
        let dir = if dir == Vec3A::ZERO { Vec3A::X } else { dir };
        let away = [0.0, 2.0, 30.0, 1e3, 1e5, 1e6][i % 6] * bounds.size().max_element();
        let mut aim = bounds.min + numbers.point() * bounds.size();
        if i.is_multiple_of(5) {
            let frame = &grids.frames[i / 5 % grids.frames.len()];
            aim = Vec3A::new(frame.wall(1, 0), frame.wall(1, 1), frame.wall(1, 2));
        }
        let most = away + numbers.point().x * bounds.size().max_element();
        let ray = Ray::new(aim - dir * away, dir, RayKind::Camera);
        if i % 7 < 3 { ray.between(0.0, most) } else { ray }
    };
    let mut rays: Vec<Ray> = (0..count).map(ray).collect();
    rays.extend((0..count).map(|i| out_of(&grids.frames[i % grids.frames.len()], &mut numbers)));
    rays
}

/// A ray that leaves a grid at a flat angle, and ends before it comes to the outermost wall.
fn out_of(frame: &Frame, numbers: &mut Numbers) -> Ray {
    let (axis, up) = ((numbers.point().x * 3.0) as usize % 3, numbers.point().x < 0.5);
    let mut dir = numbers.direction() * frame.bounds.size().max_element();
    let mut at = frame.bounds.min + numbers.point() * frame.bounds.size();
    at[axis] = if up { frame.bounds.max[axis] } else { frame.bounds.min[axis] };
    dir[axis] = frame.pad[axis] * if up { 1.0 } else { -1.0 };
    Ray::new(at - dir, dir, RayKind::Camera).between(0.0, 1.0 + numbers.point().x)
}

fn nothing_is_missed<T: Technique<Index = Grids>>(technique: &T) {
    let mut shown_far = 0;
    for (seed, offset) in [(1, 0.0), (2, 3.0), (3, 300.0)] {
        let mut family = boxes(seed, 400);
        for bounds in &mut family.0 {
            (bounds.min, bounds.max) = (bounds.min + offset, bounds.max + offset);
        }
        let (grids, leaves) = made(technique, &family);
        for (i, ray) in rays(seed, &grids, 600).iter().enumerate() {
            let (mut shown, steps) = send(&grids, &family, ray);
            let count = shown.len();
            shown.sort_unstable();
            shown.dedup();
            assert_eq!(shown.len(), count, "{} {offset}, ray {i}: a leaf twice", T::NAME);
            assert!(steps <= grids.words.len(), "{} {offset}, ray {i}", T::NAME);
            shown_far += if i % 6 > 2 { count } else { 0 };
            let mut met = vec![false; family.0.len()];
            for leaf in shown {
                leaves.of(leaf as usize).iter().for_each(|&child| met[child as usize] = true);
            }
            let clip = Clip::new(ray, grids.reach);
            for (child, &met) in met.iter().enumerate() {
                let hit = clip.cut(&family.bounds(child as u32), ray.t_max()).is_some();
                assert!(met || !hit, "{} {offset}, ray {i}: child {child}", T::NAME);
            }
        }
    }
    assert!(shown_far > 200, "{}: rays from far away meet something", T::NAME);
}

#[test]
fn a_ray_is_shown_all_children_it_meets_and_no_leaf_twice() {
    nothing_is_missed(&AdaptiveGrid::default());
    nothing_is_missed(&AdaptiveGrid { density: 0.5, max_depth: 6, max_leaf: 2 });
    nothing_is_missed(&NestedGrid::default());
    nothing_is_missed(&NestedGrid { density: 0.3, max_depth: 5, max_leaf: 3 });
    nothing_is_missed(&MacroRegions::default());
    nothing_is_missed(&MacroRegions { density: 64.0 });
}

/// All leaves, with the box of their cell.
fn cells(grids: &Grids) -> Vec<(Aabb, Leaf)> {
    let mut found = Vec::new();
    for frame in &grids.frames {
        for cell in frame.all().cells() {
            let step = Step::from_word(grids.words[frame.slot(cell) as usize]);
            if !step.is_onward() {
                found.push((frame.box_of(&Block::new(cell, cell)), step.as_leaf()));
            }
        }
    }
    found
}

fn cells_hold_what_is_in_them<T: Technique<Index = Grids>>(technique: &T) {
    let family = boxes(4, 300);
    let (grids, leaves) = made(technique, &family);
    let cells = cells(&grids);
    let mut numbers = Numbers::new(5);
    for child in 0..family.count() {
        let bounds = family.bounds(child);
        for corner in 0..8 {
            let within = bounds.min + numbers.point() * bounds.size();
            for point in [within, bounds.corner(corner)] {
                let point = Aabb { min: point, max: point };
                let has = |&&(cell, leaf): &&(Aabb, Leaf)| {
                    cell.padded().contains(&point) && leaves.of(leaf.0 as usize).contains(&child)
                };
                assert!(cells.iter().find(has).is_some(), "{}: child {child}", T::NAME);
            }
        }
    }
    for (i, (a, _)) in cells.iter().enumerate() {
        for (b, _) in &cells[..i] {
            let both = a.meet(*b).size();
            assert!(both.min_element() <= 1e-6, "{}: {a:?} and {b:?} overlap", T::NAME);
        }
    }
}

#[test]
fn every_point_of_a_child_is_in_a_cell_with_it_and_cells_do_not_overlap() {
    cells_hold_what_is_in_them(&AdaptiveGrid::default());
    cells_hold_what_is_in_them(&NestedGrid { density: 0.5, max_depth: 4, max_leaf: 3 });
    cells_hold_what_is_in_them(&MacroRegions::default());
}

#[test]
fn crowded_cells_hold_grids_within_their_cells() {
    let family = boxes(6, 3000);
    let adaptive = made(&AdaptiveGrid::default(), &family).0;
    let nested = made(&NestedGrid { density: 0.3, max_depth: 3, max_leaf: 3 }, &family).0;
    for grids in [adaptive, nested] {
        assert!(grids.frames.len() > 10, "{} grids", grids.frames.len());
        for frame in &grids.frames[1..] {
            let outer = frame.outer.expect("in a cell");
            let around = &grids.frames[outer.grid as usize];
            let cell = outer.cell.map(u32::from);
            let bounds = around.box_of(&Block::new(cell, cell));
            assert!(bounds.contains(&frame.bounds), "{bounds:?} {:?}", frame.bounds);
            assert!(frame.least_pad <= around.least_pad);
        }
    }
}

fn random_lines_do_what_is_expected<T: Technique<Index = Grids>>(technique: &T, seed: u64) {
    let [steps, tests] = expected_and_counted(technique, &spheres(2000, seed), seed + 1);
    let share = steps[1] / steps[0];
    assert!((0.98..1.02).contains(&share), "{}: steps {share} of {}", T::NAME, steps[0]);
    let share = tests[1] / tests[0];
    assert!((0.8..1.2).contains(&share), "{}: tests {share} of {}", T::NAME, tests[0]);
}

#[test]
fn random_lines_take_the_expected_steps_and_tests() {
    random_lines_do_what_is_expected(&AdaptiveGrid::default(), 1);
    random_lines_do_what_is_expected(&AdaptiveGrid { density: 0.5, max_depth: 4, max_leaf: 4 }, 3);
    random_lines_do_what_is_expected(&NestedGrid::default(), 5);
    random_lines_do_what_is_expected(&NestedGrid { density: 0.25, max_depth: 4, max_leaf: 3 }, 7);
    random_lines_do_what_is_expected(&MacroRegions::default(), 9);
    random_lines_do_what_is_expected(&MacroRegions { density: 64.0 }, 11);
}

fn refinement_ends<T: Technique<Index = Grids>>() {
    let one = Aabb { min: Vec3A::ZERO, max: Vec3A::ONE };
    let flat = Aabb { min: Vec3A::ZERO, max: Vec3A::new(1.0, 1.0, 0.0) };
    let point = Aabb { min: Vec3A::ONE, max: Vec3A::ONE };
    let far = Aabb { min: Vec3A::splat(1e6), max: Vec3A::splat(1e6) };
    for of in [one, flat, point] {
        for last in [of, far] {
            let mut all = vec![of; 100_000];
            all.push(last);
            let family = Boxes(all);
            let (grids, leaves) = made(&T::default(), &family);
            let entries: usize = (0..leaves.count()).map(|leaf| leaves.of(leaf).len()).sum();
            assert!(entries <= 17 * family.0.len(), "{}: {entries} entries", T::NAME);
            let words = grids.words.len();
            assert!(words <= 65 * family.0.len(), "{}: {words} cells", T::NAME);
        }
    }
}

#[test]
fn children_in_one_place_are_given_up_on() {
    refinement_ends::<AdaptiveGrid>();
    refinement_ends::<NestedGrid>();
    refinement_ends::<MacroRegions>();
}

#[test]
fn settings_next_to_the_usual_are_in_range() {
    fn check<T: Technique<Index = Grids>>() {
        let usual = T::default();
        assert_eq!(usual.check(), Ok(()));
        assert!(usual.neighbours().iter().all(|next| next.check().is_ok() && *next != usual));
    }
    check::<AdaptiveGrid>();
    check::<NestedGrid>();
    check::<MacroRegions>();
}
