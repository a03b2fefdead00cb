use nestray_core::technique::Technique;

use super::Spacetime;
use super::cut::cut;
use crate::bvh::Bvh;
use crate::counted::{expected_and_counted, spheres};
use crate::timed_tree::tests::{Objects, Way, expected_and_counted as at_any_time, movers, tree};
use crate::timed_tree::{Growing, Linear, Manner, grow};
use crate::wide_tree::Contents;

/// Whether two boxes have more than faces in common at some of 16 moments.
fn overlap(a: &Linear, b: &Linear) -> bool {
    (0..16).any(|step| {
        let part = (step as f32 + 0.5) / 16.0;
        a.at(part).meet(b.at(part)).size().min_element() > 0.0
    })
}

#[test]
fn halves_of_cells_do_not_overlap_at_any_time() {
    let mut all_in_time = 0;
    for way in [Way::Still, Way::Straight(3.0), Way::Straight(30.0), Way::Around(12), Way::Keyed] {
        let family = Objects(movers(way, 400, 2));
        let (params, of) = (Spacetime::default(), Contents::new(&family));
        let mut growing = Growing::new(&family, &of);
        let (mut in_space, mut in_time) = (0, 0);
        grow(growing.all(8.0 * 400.0, Manner::Cells), |open| {
            let halves = cut(&params, &mut growing, open, 72)?;
            let [below, above] = &halves;
            if below.manner == Manner::Cells {
                let apart = below.time != above.time;
                assert!(apart || !overlap(&below.bounds(), &above.bounds()), "{way:?}");
                assert!(!apart || below.time[1] == above.time[0], "{way:?}");
                *(if apart { &mut in_time } else { &mut in_space }) += 1;
            }
            Ok(halves)
        });
        all_in_time += in_time;
        let moves = !matches!(way, Way::Still);
        assert!(moves || (in_space > 100 && in_time == 0), "{way:?}: {in_space} {in_time}");
    }
    assert!(all_in_time > 10, "{all_in_time} cuts in time");
}

#[test]
fn siblings_do_not_overlap_where_nothing_moves() {
    let family = Objects(movers(Way::Still, 400, 2));
    let (tree, _) = tree(&Spacetime::default(), &family);
    assert!(tree.nodes().count() > 20);
    for parts in tree.nodes() {
        for (i, a) in parts.iter().enumerate() {
            let beside = parts[..i].iter().find(|b| overlap(&a.bounds, &b.bounds));
            assert!(beside.is_none(), "{a:?} and {beside:?}");
        }
    }
}

#[test]
fn random_lines_at_random_times_do_what_is_expected() {
    for (way, allowed) in [
        (Way::Still, [0.03, 0.2]),
        (Way::Straight(3.0), [0.03, 0.2]),
        (Way::Straight(30.0), [0.03, 0.2]),
        (Way::Around(12), [0.03, 0.2]),
        (Way::Keyed, [0.03, 0.2]),
    ] {
        let counted = at_any_time(&Spacetime::default(), &movers(way, 500, 3));
        for ([expected, counted], allowed) in counted.into_iter().zip(allowed) {
            let off = (counted / expected - 1.0).abs();
            assert!(off < allowed, "{way:?}: {counted} for {expected}");
        }
    }
}

#[test]
fn cells_in_time_save_tests_of_what_moves_fast() {
    for (way, share) in
        [(Way::Straight(3.0), 0.7), (Way::Straight(30.0), 0.1), (Way::Around(12), 0.3)]
    {
        let movers = movers(way, 2000, 5);
        let tests = |counted: [[f64; 2]; 2]| counted[1][1];
        let bvh = tests(at_any_time(&Bvh::default(), &movers));
        let cells = tests(at_any_time(&Spacetime::default(), &movers));
        assert!(cells < share * bvh, "{way:?}: {cells} tests, {bvh} in still boxes");
    }
}

#[test]
fn lines_do_what_is_expected_where_nothing_moves() {
    let [steps, tests] = expected_and_counted(&Spacetime::default(), &spheres(500, 3), 4);
    assert!((steps[1] / steps[0] - 1.0).abs() < 0.03, "{steps:?}");
    assert!((tests[1] / tests[0] - 1.0).abs() < 0.2, "{tests:?}");
}

#[test]
fn settings_have_ranges() {
    let wrong = [
        (Spacetime { max_leaf: 0, ..Spacetime::default() }, "max_leaf"),
        (Spacetime { planes: 32, ..Spacetime::default() }, "planes"),
        (Spacetime { leaf_cost: 101.0, ..Spacetime::default() }, "leaf_cost"),
        (Spacetime { halvings: 9, ..Spacetime::default() }, "halvings"),
        (Spacetime { bias: 0.5, ..Spacetime::default() }, "bias"),
    ];
    for (settings, name) in wrong {
        assert_eq!(settings.check().expect_err("out of range").setting, name);
    }
    for near in Spacetime::default().neighbours() {
        assert!(near.check().is_ok() && near != Spacetime::default(), "{near:?}");
    }
}

#[test]
fn no_cut_makes_more_references_than_there_is_room_for() {
    for way in [Way::Still, Way::Straight(30.0), Way::Around(40)] {
        let family = Objects(movers(way, 300, 8));
        let params = Spacetime { halvings: 8, bias: 1.0, planes: 7, ..Spacetime::default() };
        let (_, leaves) = tree(&params, &family);
        let entries: usize = (0..leaves.count()).map(|leaf| leaves.of(leaf).len()).sum();
        assert!((300..=8 * 300).contains(&entries), "{way:?}: {entries} references");
    }
}
