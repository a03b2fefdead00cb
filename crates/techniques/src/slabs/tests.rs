use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::technique::Technique;

use super::Slabs;
use super::planes::SLANTING;
use super::volume::Volume;
use crate::counted::{expected_and_counted, spheres};

#[test]
fn the_surface_of_a_volume_is_that_of_the_body_between_its_planes() {
    let cube = Aabb { min: Vec3A::splat(-1.0), max: Vec3A::ONE };
    let area =
        |reach: f32| Volume { bounds: cube, reach: vec![[-reach, reach]; 4] }.area(&SLANTING[..4]);
    assert!((area(3.5) - 24.0).abs() < 1e-5, "planes that cut nothing off");
    assert!((area(1.0) - 48f64.sqrt()).abs() < 1e-5, "an octahedron");
    let flat = Aabb { min: Vec3A::ZERO, max: Vec3A::new(2.0, 3.0, 0.0) };
    let flat = Volume { bounds: flat, reach: vec![[-9.0, 9.0]; 4] };
    assert!((flat.area(&SLANTING[..4]) - 12.0).abs() < 1e-5, "both sides of a rectangle");
}

#[test]
fn random_lines_do_what_is_expected() {
    for sets in [3, 7, 9, 13] {
        let params = Slabs { sets, ..Slabs::default() };
        for [expected, counted] in expected_and_counted(&params, &spheres(500, 3), 4) {
            let off = (counted / expected - 1.0).abs();
            assert!(off < 0.03, "{sets} sets: {counted} for {expected}");
        }
    }
}

#[test]
fn more_planes_mean_fewer_tests() {
    let tests = |sets| {
        let params = Slabs { sets, ..Slabs::default() };
        expected_and_counted(&params, &spheres(500, 3), 4)[1][1]
    };
    let (boxes, diagonals, all) = (tests(3), tests(7), tests(13));
    assert!(diagonals < 0.9 * boxes && all < diagonals, "{boxes} {diagonals} {all}");
}

#[test]
fn only_the_numbers_of_sets_that_exist_are_taken() {
    for sets in 0..20 {
        let params = Slabs { sets, ..Slabs::default() };
        assert_eq!(params.check().is_ok(), [3, 7, 9, 13].contains(&sets));
    }
    assert_eq!(Slabs::default().neighbours().len(), 5);
}
