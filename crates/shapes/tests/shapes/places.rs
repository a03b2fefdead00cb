//! Where a shape is: along directions, in cells.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::shape::Shape;
use nestray_shapes::sphere::Sphere;

use crate::hits::{crossings, each_crossing, grain};
use crate::numbers::Numbers;
use crate::samples::{Form, near};

#[test]
fn an_interval_along_a_direction_holds_every_hit() {
    let mut numbers = Numbers(4);
    each_crossing(400, |seed, sample, ray, crossing| {
        let position = sample.shape.surface(ray, crossing).position.as_dvec3();
        for _ in 0..4 {
            let direction = (numbers.unit() * numbers.size(-3.0, 3.0)).as_vec3a();
            let [low, high] = sample.shape.along(direction);
            let direction = direction.as_dvec3();
            let room = 2.0 * grain(sample) * direction.length();
            let along = position.dot(direction);
            assert!(f64::from(low) - room <= along, "seed {seed} {sample:?} {direction}");
            assert!(along <= f64::from(high) + room, "seed {seed} {sample:?} {direction}");
        }
    });
}

#[test]
fn an_interval_along_a_direction_is_no_longer_than_it_must_be() {
    for seed in 0..4 {
        for sample in near(seed).iter().filter(|sample| sample.form != Form::Other) {
            let mut numbers = Numbers(seed ^ 0x719);
            let points: Vec<DVec3> = (0..4_000)
                .flat_map(|_| {
                    let ray = numbers.ray_near(sample.center, sample.size);
                    let surface = |c| sample.shape.surface(&ray, &c).position.as_dvec3();
                    crossings(&sample.shape, &ray).into_iter().map(surface).collect::<Vec<_>>()
                })
                .collect();
            for _ in 0..5 {
                let direction = numbers.unit();
                let [low, high] = sample.shape.along(direction.as_vec3a()).map(f64::from);
                let along = |p: &DVec3| p.dot(direction);
                let least = points.iter().map(along).fold(f64::INFINITY, f64::min);
                let most = points.iter().map(along).fold(f64::NEG_INFINITY, f64::max);
                // Corners are seldom hit.
                let room = 0.12 * sample.size;
                assert!(low > least - room && high < most + room, "seed {seed} {sample:?}");
            }
        }
    }
}

#[test]
fn a_cell_with_a_hit_in_it_is_touched() {
    let mut numbers = Numbers(5);
    each_crossing(400, |seed, sample, ray, crossing| {
        let position = sample.shape.surface(ray, crossing).position;
        for case in 0..4 {
            // Cells of all sizes, some with the hit in a wall, some that are a point.
            let size = sample.size * numbers.size(-4.0, 1.0);
            let mut half = || (numbers.cube().abs() * size).as_vec3a();
            let (mut below, above) = (half(), half());
            below[case % 3] *= if case < 3 { 0.0 } else { 1.0 };
            let mut cell = Aabb { min: position - below, max: position + above };
            if numbers.below(8) == 0 {
                cell = Aabb { min: position, max: position };
            }
            assert!(sample.shape.touches(&cell), "seed {seed} {sample:?} {cell:?}");
        }
    });
}

#[test]
fn a_cell_inside_a_shell_or_beside_a_face_is_not_touched() {
    let sphere = Sphere { center: Vec3A::new(5.0, 0.0, 0.0), radius: 1.0 };
    let cell = |at: Vec3A, half: f32| Aabb { min: at - half, max: at + half };
    assert!(!sphere.touches(&cell(sphere.center, 0.5)));
    assert!(!sphere.touches(&cell(sphere.center + 0.9, 0.2)), "a corner of its box");
    let triangle = Polygon::new(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    assert!(!triangle.touches(&cell(Vec3A::splat(0.1), 0.1)));
    assert!(triangle.touches(&cell(Vec3A::splat(0.3), 0.1)));
    // Most shapes leave most of their box empty.
    let mut empty = 0;
    for sample in near(3).iter().filter(|sample| sample.shape.bounds().is_bounded()) {
        let bounds = sample.shape.bounds();
        let mut numbers = Numbers(6);
        for _ in 0..200 {
            let part = (numbers.cube() * 0.5 + 0.5).as_vec3a();
            let at = bounds.min + bounds.size() * part;
            empty += usize::from(!sample.shape.touches(&cell(at, 0.02)));
        }
    }
    assert!(empty > 1_200, "only {empty} cells were empty");
}
