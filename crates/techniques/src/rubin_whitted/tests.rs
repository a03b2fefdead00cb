use glam::Vec3A;
use nestray_shapes::any::AnyShape;
use nestray_shapes::cone::Cone;

use super::*;
use crate::counted::{Numbers, expected_and_counted, spheres};

/// Long thin rods, all nearly along one slant.
fn rods(count: u32, seed: u64) -> Vec<AnyShape> {
    let mut numbers = Numbers::new(seed);
    let slant = Vec3A::new(1.0, 2.0, 1.5);
    (0..count)
        .map(|_| {
            let base = numbers.point() * 10.0;
            AnyShape::from(Cone {
                base,
                base_radius: 0.02,
                apex: base + slant + numbers.point() * 0.2,
                apex_radius: 0.02,
            })
        })
        .collect()
}

#[test]
fn turned_boxes_save_tests_of_slanting_rods() {
    let tests = |gain| {
        let params = RubinWhitted { gain, ..Default::default() };
        expected_and_counted(&params, &rods(500, 3), 4)[1][1]
    };
    let (turned, straight) = (tests(1.0), tests(100.0));
    assert!(turned < 0.3 * straight, "{turned} {straight}");
}

#[test]
fn random_lines_do_what_is_expected() {
    for shapes in [spheres(500, 3), rods(500, 3)] {
        let params = RubinWhitted::default();
        for [expected, counted] in expected_and_counted(&params, &shapes, 4) {
            assert!((counted / expected - 1.0).abs() < 0.2, "{counted} for {expected}");
        }
    }
}
