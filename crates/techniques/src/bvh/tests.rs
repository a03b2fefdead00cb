use nestray_core::aabb::Aabb;
use nestray_core::dispatch;
use nestray_core::simd::Level;
use nestray_core::technique::{Leaves, Technique};

use super::part::{Around, Part};
use super::plane::{Cutting, partition, shared_partition};
use super::*;
use crate::cells::tests::boxes;
use crate::counted::Numbers;
use crate::sbvh::Sbvh;

/// Small boxes all over the place; every third weighs more.
fn parts(count: u32) -> Vec<Part> {
    let mut numbers = Numbers::new(3);
    let part = |number: u32| {
        let min = numbers.point();
        let weight = if number.is_multiple_of(3) { 2.0 } else { 1.0 };
        Part::new(&Aabb { min, max: min + numbers.point() * 0.1 }, number, weight)
    };
    (0..count).map(part).collect()
}

/// What both sides cost.
fn cost(sides: [&[Part]; 2]) -> f32 {
    let weight = |parts: &[Part]| parts.iter().map(Part::weight).sum::<f32>();
    sides.iter().map(|side| Around::all(side).half_area() * weight(side)).sum()
}

#[test]
fn a_plane_costs_what_its_sides_do_and_is_as_good_as_any_cut_in_the_middle() {
    for (count, is_even) in [(5, false), (12, false), (100, true), (1000, false)] {
        let mut cut = parts(count);
        if is_even {
            cut = cut
                .iter()
                .map(|one| Part::new(&one.around().bounds(), one.number(), 1.0))
                .collect();
        }
        let cutting = Cutting { bins: 32, is_even };
        let mut planes = Vec::new();
        for level in Level::available() {
            let plane = dispatch!(level, simd => cutting.best_plane(simd, &cut));
            planes.push(format!("{plane:?}"));
        }
        assert!(planes.iter().all(|plane| *plane == planes[0]), "the same by all vector levels");
        let plane = cutting.shared_plane(&cut).expect("centres are apart");
        let middle = partition(&mut cut, &plane);
        let (left, right) = cut.split_at(middle);
        for (side, around) in [left, right].into_iter().zip(plane.sides) {
            assert_eq!(Around::all(side).bounds(), around.bounds());
        }
        let found = cost([left, right]);
        for axis in 0..3 {
            cut.sort_by(|a, b| a.center()[axis].total_cmp(&b.center()[axis]));
            let halves = cut.split_at(cut.len() / 2);
            assert!(found <= 1.01 * cost(halves.into()), "axis {axis} of {count}");
        }
    }
}

#[test]
fn all_cores_put_the_same_on_each_side() {
    let mut all = parts(100_000);
    let plane = Cutting { bins: 32, is_even: false }.shared_plane(&all).expect("apart");
    let mut alone = all.clone();
    let counts = [shared_partition(&mut all, &plane), partition(&mut alone, &plane)];
    assert_eq!(counts[0], counts[1]);
    let numbers = |parts: &[Part]| {
        let mut numbers: Vec<u32> = parts.iter().map(Part::number).collect();
        numbers.sort_unstable();
        numbers
    };
    assert_eq!(numbers(&all[..counts[0]]), numbers(&alone[..counts[0]]));
    assert_eq!(numbers(&all), (0..100_000).collect::<Vec<_>>());
}

#[test]
fn trees_are_the_same_for_any_number_of_threads() {
    fn check<T: Technique<Index = WideTree>>(technique: &T, count: usize) {
        let family = boxes(4, count);
        let build = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads can be had").install(|| {
                let mut leaves = Leaves::default();
                let tree = technique.build(&family, &mut leaves);
                let leaves: Vec<Vec<u32>> =
                    (0..leaves.count()).map(|leaf| leaves.of(leaf).to_vec()).collect();
                (tree.nodes().collect::<Vec<_>>(), leaves)
            })
        };
        let one = build(1);
        assert!([2, 7].into_iter().all(|threads| build(threads) == one), "{}", T::NAME);
    }
    check(&Bvh::default(), 100_000);
    check(&Sbvh::default(), 40_000);
}

#[test]
fn what_fits_one_pack_is_not_cut() {
    assert_eq!([few(8, 8), few(4, 8), few(64, 8), few(8, 1), few(512, 64)], [8, 4, 8, 1, 64]);
}
