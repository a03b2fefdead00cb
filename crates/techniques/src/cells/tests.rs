//! What holds of all trees of cells.

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::beam::{Beam, Facing};
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind, Source};
use nestray_core::technique::{Index, Leaf, Leaves, Technique};

use super::{Cells, Children};
use crate::bsp::Bsp;
use crate::counted::{Numbers, walk};
use crate::kd_tree::KdTree;
use crate::octree::Octree;

/// Boxes that nothing else is known of.
pub(crate) struct Boxes(pub(crate) Vec<Aabb>);

impl Family for Boxes {
    fn count(&self) -> u32 {
        self.0.len() as u32
    }
    fn bounds(&self, child: u32) -> Aabb {
        self.0[child as usize].padded()
    }
    fn weight(&self, _child: u32) -> f32 {
        20.0
    }
    fn together(&self) -> u32 {
        1
    }
    fn bounds_during(&self, child: u32, _time: [f32; 2]) -> Aabb {
        self.bounds(child)
    }
    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb {
        self.bounds(child).meet(*cell)
    }
    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2] {
        self.bounds(child).along(direction)
    }
    fn touches(&self, child: u32, cell: &Aabb) -> bool {
        self.bounds(child).overlaps(cell)
    }
    fn meets(&self, child: u32, beam: &Beam) -> Option<[f32; 2]> {
        beam.meets(&self.bounds(child))
    }
    fn blocks(&self, _child: u32, _beam: &Beam) -> Option<f32> {
        None
    }
    fn facing(&self, _child: u32, _beam: &Beam) -> Facing {
        Facing::Mixed
    }
    fn child_of(&self, _source: &Source) -> Option<u32> {
        None
    }
}

/// Boxes of all sizes, more of them towards one corner.
pub(crate) fn boxes(seed: u64, count: usize) -> Boxes {
    let mut numbers = Numbers::new(seed);
    let mut next = || {
        let min = numbers.point() * numbers.point();
        let size = [0.01, 0.03, 0.1][(numbers.next() * 3.0) as usize];
        Aabb { min, max: min + numbers.point() * size }
    };
    Boxes((0..count).map(|_| next()).collect())
}

pub(crate) fn children(seed: u64, count: usize) -> Children {
    Children::new(&boxes(seed, count))
}

fn tree<T: Technique<Index = Cells>>(technique: &T, family: &Boxes) -> (Cells, Leaves) {
    let mut leaves = Leaves::default();
    let tree = technique.build(family, &mut leaves);
    (tree, leaves)
}

/// The cells with children in them.
fn full(tree: &Cells) -> Vec<(Aabb, Leaf)> {
    tree.cells().into_iter().filter_map(|(bounds, leaf)| Some((bounds, leaf?))).collect()
}

fn every_point_of_a_child_is_in_a_cell_with_it<T: Technique<Index = Cells>>() {
    let family = boxes(1, 300);
    let (tree, leaves) = tree(&T::default(), &family);
    let cells = full(&tree);
    assert!(cells.len() > 50, "{}: {} cells", T::NAME, cells.len());
    let mut numbers = Numbers::new(2);
    for child in 0..family.count() {
        let bounds = family.bounds(child);
        for corner in 0..8 {
            let within = bounds.min + numbers.point() * bounds.size();
            for point in [within, bounds.corner(corner)] {
                let point = Aabb { min: point, max: point };
                let has = |&&(cell, leaf): &&(Aabb, Leaf)| {
                    cell.contains(&point) && leaves.of(leaf.0 as usize).contains(&child)
                };
                assert!(cells.iter().find(has).is_some(), "{}: child {child}", T::NAME);
            }
        }
    }
    for (i, (a, _)) in cells.iter().enumerate() {
        for (b, _) in &cells[..i] {
            let both = a.meet(*b).size();
            assert!(both.min_element() <= 0.0, "{}: {a:?} and {b:?} overlap", T::NAME);
        }
    }
}

#[test]
fn every_point_of_a_child_is_in_a_cell_with_it_and_cells_do_not_overlap() {
    every_point_of_a_child_is_in_a_cell_with_it::<KdTree>();
    every_point_of_a_child_is_in_a_cell_with_it::<Bsp>();
    every_point_of_a_child_is_in_a_cell_with_it::<Octree>();
}

fn cells_come_in_order<T: Technique<Index = Cells>>() {
    let family = boxes(3, 1000);
    let (tree, _) = tree(&T::default(), &family);
    let cells = full(&tree);
    let mut numbers = Numbers::new(4);
    for i in 0..2000 {
        let (origin, mut dir) = (numbers.point() * 3.0 - 1.0, numbers.direction());
        if i % 4 == 0 {
            dir[i / 4 % 3] = 0.0;
        }
        let ray = Ray::new(origin, dir, RayKind::Camera);
        let clip = Clip::new(&ray, tree.bounds().reach());
        let (mut last, mut shown) = (0.0, Vec::new());
        walk(&tree, &family, &ray, |leaf, cursor| {
            let begin = cursor.span[0];
            assert!(begin >= last - 1e-4, "{}, ray {i}: {begin} after {last}", T::NAME);
            last = begin;
            shown.push(leaf.0);
        });
        shown.sort_unstable();
        let met: Vec<u32> = cells
            .iter()
            .filter(|(bounds, _)| clip.cut(bounds, ray.t_max()).is_some())
            .map(|(_, leaf)| leaf.0)
            .collect();
        assert_eq!(shown, met, "{}, ray {i}: all the cells it meets, once each", T::NAME);
    }
}

#[test]
fn a_ray_is_shown_all_cells_it_meets_once_and_in_order() {
    cells_come_in_order::<KdTree>();
    cells_come_in_order::<Bsp>();
    cells_come_in_order::<Octree>();
}

fn random_lines_do_what_is_expected<T: Technique<Index = Cells>>() {
    let family = boxes(5, 2000);
    let (tree, leaves) = tree(&T::default(), &family);
    let expected = tree.expected(&family, &leaves);
    let (bounds, mut numbers) = (tree.bounds(), Numbers::new(6));
    let radius = bounds.size().length() / 2.0;
    let (mut lines, mut steps, mut tests) = (0, 0, 0);
    while lines < 40_000 {
        let (dir, aside) = (numbers.direction(), numbers.point() * 2.0 - 1.0);
        let (u, v) = dir.any_orthonormal_pair();
        if aside.x * aside.x + aside.y * aside.y > 1.0 {
            continue;
        }
        let origin = bounds.center() + (u * aside.x + v * aside.y) * radius - dir * 2.0 * radius;
        let ray = Ray::new(origin, dir, RayKind::Camera);
        if Clip::new(&ray, bounds.reach()).cut(&bounds, f32::INFINITY).is_none() {
            continue;
        }
        lines += 1;
        let mut tested = Vec::<u32>::new();
        steps += walk(&tree, &family, &ray, |leaf, _| tested.extend(leaves.of(leaf.0 as usize)));
        tested.sort_unstable();
        tested.dedup();
        tests += tested.len();
    }
    let share = steps as f64 / f64::from(lines) / expected.steps;
    assert!((0.98..1.02).contains(&share), "{}: steps {share} of expected", T::NAME);
    let sum: f64 = expected.tests.iter().copied().map(f64::from).sum();
    let share = tests as f64 / f64::from(lines) / sum;
    assert!((0.8..1.2).contains(&share), "{}: tests {share} of expected", T::NAME);
}

#[test]
fn random_lines_take_the_expected_steps_and_tests() {
    random_lines_do_what_is_expected::<KdTree>();
    random_lines_do_what_is_expected::<Bsp>();
    random_lines_do_what_is_expected::<Octree>();
}

fn refinement_ends<T: Technique<Index = Cells>>() {
    let one = Aabb { min: Vec3A::ZERO, max: Vec3A::ONE };
    let flat = Aabb { min: Vec3A::ZERO, max: Vec3A::new(1.0, 1.0, 0.0) };
    let point = Aabb { min: Vec3A::ONE, max: Vec3A::ONE };
    let far = Aabb { min: Vec3A::splat(1e6), max: Vec3A::splat(1e6) };
    for of in [one, flat, point] {
        let mut all = vec![of; 1_000_000];
        all.push(far);
        let family = Boxes(all);
        let (tree, leaves) = tree(&T::default(), &family);
        let entries: usize = (0..leaves.count()).map(|leaf| leaves.of(leaf).len()).sum();
        assert!(entries <= 8 * family.0.len(), "{}: {entries} entries", T::NAME);
        assert!(tree.cells().len() < 1000, "{}: {} cells", T::NAME, tree.cells().len());
    }
}

#[test]
fn a_million_children_in_one_place_are_given_up_on() {
    refinement_ends::<KdTree>();
    refinement_ends::<Bsp>();
    refinement_ends::<Octree>();
}

fn edges_are_halves_of_halves<T: Technique<Index = Cells>>(technique: &T) {
    let (tree, _) = tree(technique, &boxes(7, 500));
    for (bounds, _) in tree.cells() {
        let times = tree.bounds().size() / bounds.size();
        for axis in 0..3 {
            let power = f64::from(times[axis]).log2();
            assert!((power - power.round()).abs() < 1e-3, "{}: {power}", T::NAME);
        }
    }
}

#[test]
fn cells_of_a_bsp_tree_and_an_octree_are_halves_of_halves() {
    edges_are_halves_of_halves::<Bsp>(&Bsp::default());
    edges_are_halves_of_halves::<Octree>(&Octree::default());
}

#[test]
fn settings_next_to_the_usual_are_in_range() {
    fn check<T: Technique<Index = Cells>>() {
        let usual = T::default();
        assert_eq!(usual.check(), Ok(()));
        assert!(usual.neighbours().iter().all(|next| next.check().is_ok() && *next != usual));
    }
    check::<KdTree>();
    check::<Bsp>();
    check::<Octree>();
}
