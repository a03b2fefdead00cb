use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::technique::{Index, Leaves, Technique};

use super::*;
use crate::bvh::Bvh;
use crate::cells::tests::{Boxes, boxes};
use crate::counted::{Numbers, expected_and_counted, spheres};

/// Long boxes along all axes, crosswise.
fn bars(count: usize) -> Boxes {
    let mut numbers = Numbers::new(9);
    let mut next = |i: usize| {
        let min = numbers.point();
        let mut size = numbers.point() * 0.01;
        size[i % 3] = 0.5 * numbers.next();
        Aabb { min, max: min + size }
    };
    Boxes((0..count).map(&mut next).collect())
}

fn tree<T: Technique<Index = WideTree>>(technique: &T, family: &Boxes) -> (WideTree, Leaves) {
    let mut leaves = Leaves::default();
    let tree = technique.build(family, &mut leaves);
    (tree, leaves)
}

fn entries(leaves: &Leaves) -> usize {
    (0..leaves.count()).map(|leaf| leaves.of(leaf).len()).sum()
}

/// What a random ray is expected to cost, in visits of a node.
fn cost<T: Technique<Index = WideTree>>(technique: &T, family: &Boxes) -> f64 {
    let (tree, leaves) = tree(technique, family);
    let expected = tree.expected(family, &leaves);
    expected.steps + 2.0 * expected.tests.iter().copied().map(f64::from).sum::<f64>()
}

#[test]
fn every_point_of_a_child_is_in_a_leaf_with_it() {
    let (mut numbers, family) = (Numbers::new(2), bars(500));
    let (tree, leaves) = tree(&Sbvh::default(), &family);
    assert!(entries(&leaves) > 600, "{} entries", entries(&leaves));
    let mut places = vec![Vec::new(); 500];
    for (bounds, step) in tree.nodes().flatten().filter(|(_, step)| !step.is_onward()) {
        for &child in leaves.of(step.as_leaf().0 as usize) {
            places[child as usize].push(bounds);
        }
    }
    for child in 0..family.count() {
        let bounds = family.bounds(child);
        for i in 0..40 {
            let within = bounds.min + numbers.point() * bounds.size();
            let point = if i < 8 { bounds.corner(i) } else { within };
            let point = Aabb { min: point, max: point };
            let mut places = places[child as usize].iter();
            assert!(places.any(|place| place.contains(&point)), "child {child} at {point:?}");
        }
    }
}

#[test]
fn there_are_no_more_copies_than_allowed() {
    for family in [bars(2000), boxes(1, 2000)] {
        for copies in [1.0, 1.2, 2.0] {
            let (_, leaves) = tree(&Sbvh { copies, ..Sbvh::default() }, &family);
            assert!(entries(&leaves) >= 2000);
            assert!(entries(&leaves) as f32 <= copies * 2000.0, "{} entries", entries(&leaves));
        }
    }
}

#[test]
fn long_children_are_cheaper_cut() {
    let family = bars(3000);
    let part = cost(&Sbvh::default(), &family) / cost(&Bvh::default(), &family);
    assert!(part < 0.9, "{part}");
}

#[test]
fn nothing_is_cut_that_does_not_overlap() {
    let cube = |i: usize| {
        let min = [i % 10, i / 10 % 10, i / 100].map(|x| x as f32).into();
        Aabb { min, max: min + 0.5 }
    };
    let family = Boxes((0..1000).map(cube).collect());
    let [(split, a), (whole, b)] =
        [tree(&Sbvh::default(), &family), tree(&Bvh::default(), &family)];
    assert!(split.nodes().eq(whole.nodes()), "it is the tree of bvh");
    assert_eq!(entries(&a), entries(&b));
}

#[test]
fn random_lines_do_what_is_expected() {
    let params = Sbvh { copies: 2.0, ..Sbvh::default() };
    let [steps, tests] = expected_and_counted(&params, &spheres(500, 1), 2);
    assert!((steps[1] / steps[0] - 1.0).abs() < 0.03, "{steps:?}");
    assert!((tests[1] / tests[0] - 1.0).abs() < 0.2, "{tests:?}");
}

#[test]
fn no_input_takes_long_or_makes_it_deep() {
    let one = Aabb { min: [0.0; 3].into(), max: [1.0; 3].into() };
    let shell = |i: usize| {
        let half = 0.5f32.powi(i as i32 % 120);
        Aabb { min: [-half; 3].into(), max: [half; 3].into() }
    };
    // Centres are off by rounding.
    let shell_off = |i: usize| {
        let half = 0.5f32.powi(i as i32 % 100);
        Aabb { min: [1.0 - half; 3].into(), max: [1.0 + half; 3].into() }
    };
    let point = |i: usize| {
        let at = [i as f32, 0.0, 0.0].into();
        Aabb { min: at, max: at }
    };
    let across = |i: usize| {
        let at = i as f32 * 1e-5;
        Aabb { min: [-1.0, at, at].into(), max: [1.0, at, at].into() }
    };
    let many = 100_000;
    for all in [
        vec![one; many],
        (0..many).map(shell).collect(),
        (0..many).map(shell_off).collect(),
        (0..many).map(point).collect(),
        (0..many).map(across).collect(),
    ] {
        let (tree, leaves) = tree(&Sbvh::default(), &Boxes(all));
        assert!((many..=many * 3 / 2).contains(&entries(&leaves)), "{}", entries(&leaves));
        assert!(tree.nodes().count() < 2 * many);
    }
}

#[test]
fn settings_next_to_the_usual_are_in_range() {
    let usual = Sbvh::default();
    assert_eq!(usual.check(), Ok(()));
    assert!(usual.neighbours().iter().all(|next| next.check().is_ok() && *next != usual));
}
