use nestray_core::technique::Technique;

use super::MotionBvh;
use crate::bvh::Bvh;
use crate::counted::{expected_and_counted, spheres};
use crate::timed_tree::tests::{Objects, Way, expected_and_counted as at_any_time, movers, tree};

#[test]
fn random_lines_at_random_times_do_what_is_expected() {
    for way in [Way::Still, Way::Straight(3.0), Way::Straight(30.0), Way::Around(12), Way::Keyed] {
        for [expected, counted] in at_any_time(&MotionBvh::default(), &movers(way, 500, 3)) {
            let off = (counted / expected - 1.0).abs();
            assert!(off < 0.03, "{way:?}: {counted} for {expected}");
        }
    }
}

#[test]
fn moving_boxes_save_tests_of_what_moves_fast() {
    for (way, share) in
        [(Way::Straight(3.0), 0.7), (Way::Straight(30.0), 0.1), (Way::Around(12), 0.1)]
    {
        let movers = movers(way, 2000, 5);
        let tests = |counted: [[f64; 2]; 2]| counted[1][1];
        let bvh = tests(at_any_time(&Bvh::default(), &movers));
        let moving = tests(at_any_time(&MotionBvh::default(), &movers));
        assert!(moving < share * bvh, "{way:?}: {moving} tests, {bvh} in still boxes");
    }
}

#[test]
fn splits_in_time_save_tests_of_what_turns() {
    let movers = movers(Way::Around(12), 1000, 6);
    let counted =
        |halvings| at_any_time(&MotionBvh { halvings, ..MotionBvh::default() }, &movers)[1];
    let [[whole, tested], [halved, tested_less]] = [counted(0), counted(4)];
    assert!(halved < 0.1 * whole, "expected {halved} tests instead of {whole}");
    assert!(tested_less < 0.1 * tested, "{tested_less} tests instead of {tested}");
}

#[test]
fn where_nothing_moves_it_is_a_bvh() {
    let spheres = spheres(500, 3);
    let bvh = expected_and_counted(&Bvh::default(), &spheres, 4);
    let moving = expected_and_counted(&MotionBvh::default(), &spheres, 4);
    for (a, b) in moving.into_iter().zip(bvh) {
        assert_eq!(a[1], b[1]);
        assert!((a[0] / b[0] - 1.0).abs() < 1e-6, "{a:?} expected, {b:?} in a bvh");
    }
}

#[test]
fn settings_have_ranges() {
    let wrong = [
        (MotionBvh { max_leaf: 65, ..MotionBvh::default() }, "max_leaf"),
        (MotionBvh { bins: 1, ..MotionBvh::default() }, "bins"),
        (MotionBvh { leaf_cost: 0.0, ..MotionBvh::default() }, "leaf_cost"),
        (MotionBvh { halvings: 9, ..MotionBvh::default() }, "halvings"),
        (MotionBvh { bias: f32::NAN, ..MotionBvh::default() }, "bias"),
    ];
    for (settings, name) in wrong {
        assert_eq!(settings.check().expect_err("out of range").setting, name);
    }
    for near in MotionBvh::default().neighbours() {
        assert!(near.check().is_ok() && near != MotionBvh::default(), "{near:?}");
    }
}

#[test]
fn no_split_in_time_makes_more_references_than_there_is_room_for() {
    let family = Objects(movers(Way::Around(40), 300, 8));
    let params = MotionBvh { halvings: 8, bias: 1.0, ..MotionBvh::default() };
    let (_, leaves) = tree(&params, &family);
    let entries: usize = (0..leaves.count()).map(|leaf| leaves.of(leaf).len()).sum();
    assert!((600..=4 * 300).contains(&entries), "{entries} references");
}
