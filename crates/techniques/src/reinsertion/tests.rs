use std::cell::Cell;

use nestray_core::aabb::Aabb;
use nestray_core::technique::{Index, Leaves, Technique};

use super::tree::Tree;
use super::*;
use crate::bvh::Bvh;
use crate::cells::tests::{Boxes, boxes};
use crate::counted::{Numbers, expected_and_counted, spheres};
use crate::wide_tree::area;

/// What a random ray is expected to cost, in visits of a node.
fn cost<T: Technique<Index = WideTree>>(technique: &T, family: &Boxes) -> f64 {
    let mut leaves = Leaves::default();
    let index = technique.build(family, &mut leaves);
    let expected = index.expected(family, &leaves);
    expected.steps + 2.0 * expected.tests.iter().copied().map(f64::from).sum::<f64>()
}

/// Long boxes of all directions, crosswise.
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

#[test]
fn it_is_cheaper_than_what_it_began_with() {
    let worlds = [boxes(1, 3000), boxes(2, 100), bars(3000), bars(20)];
    let part =
        worlds.map(|world| cost(&Reinsertion::default(), &world) / cost(&Bvh::default(), &world));
    assert!(part.iter().all(|part| *part <= 1.0), "{part:?}");
    assert!(part[2] < 0.95, "{part:?}");
}

/// All boxes fit what is in them, and all names agree.
fn is_sound(tree: &Tree) {
    let mut seen = vec![false; tree.nodes.len()];
    let mut open = vec![0];
    while let Some(name) = open.pop() {
        assert!(!std::mem::replace(&mut seen[name as usize], true), "{name} is in two places");
        let node = tree.node(name);
        if !node.is_child {
            let [left, right] = node.sides;
            assert_eq!(node.bounds, tree.node(left).bounds.join(tree.node(right).bounds));
            assert!(node.sides.iter().all(|&side| tree.node(side).parent == name));
            open.extend(node.sides);
        }
    }
    assert!(seen.iter().all(|seen| *seen), "a node is lost");
}

#[test]
fn a_move_gains_what_was_promised_and_can_be_taken_back() {
    let family = boxes(3, 500);
    let (mut leaves, moves) = (Leaves::default(), Cell::new(0));
    WideTree::new(LeafSize { most: 8, cost: 0.8 }, &family, &mut leaves, |of, halves_from| {
        let binary = build::split(32, 1, of, halves_from);
        let mut tree = Tree::new(&binary, &[]);
        let total = |tree: &Tree| tree.nodes.iter().map(|node| area(node.bounds)).sum::<f64>();
        for name in (1..tree.nodes.len() as u32).step_by(7) {
            let begin = total(&tree);
            if !tree.is_movable(name) {
                continue;
            }
            let Some(place) = search::best_place(&tree, name, &mut Vec::new()) else { continue };
            let (growth, from) = tree.put_beside(name, place.to);
            is_sound(&tree);
            assert!((growth + place.gain).abs() < 1e-6 * begin, "{growth} and {place:?}");
            assert!((total(&tree) - begin - growth).abs() < 1e-6 * begin);
            let (back, _) = tree.put_beside(name, from);
            is_sound(&tree);
            assert!((back + growth).abs() < 1e-6 * begin);
            tree.put_beside(name, place.to);
            moves.set(moves.get() + 1);
        }
        binary
    });
    assert!(moves.get() > 10, "{} moves", moves.get());
}

#[test]
fn it_is_the_same_for_any_number_of_threads() {
    let family = boxes(4, 5000);
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads can be had").install(|| {
            let tree = Reinsertion::default().build(&family, &mut Leaves::default());
            tree.nodes().collect::<Vec<_>>()
        })
    };
    assert_eq!(build(1), build(3));
}

#[test]
fn random_lines_do_what_is_expected() {
    let params = Reinsertion::default();
    for [expected, counted] in expected_and_counted(&params, &spheres(500, 1), 2) {
        assert!((counted / expected - 1.0).abs() < 0.03, "{counted} for {expected}");
    }
}

#[test]
fn no_input_takes_long_or_makes_it_deep() {
    let one = Aabb { min: [0.0; 3].into(), max: [1.0; 3].into() };
    let shell = |i: usize| {
        let half = 0.5f32.powi(i as i32 % 120);
        Aabb { min: [-half; 3].into(), max: [half; 3].into() }
    };
    let point =
        |i: usize| Aabb { min: [i as f32, 0.0, 0.0].into(), max: [i as f32, 0.0, 0.0].into() };
    let many = 100_000;
    for all in [vec![one; many], (0..many).map(shell).collect(), (0..many).map(point).collect()] {
        let mut leaves = Leaves::default();
        let family = Boxes(all);
        let tree = Reinsertion::default().build(&family, &mut leaves);
        let children: usize = (0..leaves.count()).map(|leaf| leaves.of(leaf).len()).sum();
        assert_eq!(children, many);
        assert!(tree.nodes().count() < many);
    }
}

#[test]
fn settings_next_to_the_usual_are_in_range() {
    let usual = Reinsertion::default();
    assert_eq!(usual.check(), Ok(()));
    assert!(usual.neighbours().iter().all(|next| next.check().is_ok() && *next != usual));
}
