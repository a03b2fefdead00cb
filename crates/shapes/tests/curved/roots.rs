//! Tori and quadrics: as many roots as there are, in turn from the front and from the back.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::quadric::Quadric;
use nestray_shapes::shape::Shape;
use nestray_shapes::torus::Torus;

use crate::numbers::{Numbers, at, crossings};

#[test]
fn a_torus_is_entered_and_left_in_turn() {
    let mut numbers = Numbers(1);
    let mut counts = [0; 5];
    for case in 0..60_000 {
        let minor = [0.3, 0.01, 1e-4, 0.99, 1.5][case % 5];
        let center = numbers.vector([0.0, 5.0, 1e3][case % 3]);
        let torus = Torus { center, axis: numbers.vector(2.0), major: 1.0, minor };
        // Every other one in the plane of the circle, where it may be crossed four times.
        let distance = [3.0, 300.0, 1e5][case / 5 % 3];
        let mut ray = numbers.ray_at(center, 0.9, distance);
        if case % 2 == 0 {
            let axis = torus.axis.normalize();
            let level = |v: Vec3A| v - axis * axis.dot(v);
            ray =
                Ray::new(center + level(ray.origin() - center), level(ray.dir()), RayKind::Camera);
        }
        let found = crossings(&torus, &ray);
        assert!(found.len().is_multiple_of(2) && found.len() <= 4, "seed 1, case {case}");
        for (i, hit) in found.iter().enumerate() {
            assert_eq!(hit.front, i % 2 == 0, "seed 1, case {case} {torus:?} {ray:?} {found:?}");
        }
        counts[found.len()] += 1;
    }
    assert!(counts[2] > 5_000 && counts[4] > 5_000, "{counts:?}");
}

#[test]
fn an_apple_has_no_core() {
    let apple = Torus { center: Vec3A::ZERO, axis: Vec3A::Z, major: 0.5, minor: 1.0 };
    let level = |z: f32| Ray::new(Vec3A::new(-4.0, 0.0, z), Vec3A::X, RayKind::Camera);
    let along: Vec<f32> = crossings(&apple, &level(0.0)).iter().map(|hit| hit.t).collect();
    assert_eq!(along, [2.5, 5.5]);
    // Over the dimple at the stalk.
    assert_eq!(crossings(&apple, &level(0.95)).len(), 4);
    let down = Ray::new(Vec3A::new(0.01, 0.02, 4.0), Vec3A::NEG_Z, RayKind::Camera);
    assert_eq!(crossings(&apple, &down).len(), 2);
}

/// Value of a quadric at a point of a ray, in doubles.
fn value(q: &Quadric, ray: &Ray, t: f64) -> f64 {
    let p = at(ray, t);
    let [[a, b, c], [d, e, f], [g, h, i]] =
        [q.squares, q.products, q.linear].map(|part| part.map(f64::from));
    a * p.x * p.x
        + b * p.y * p.y
        + c * p.z * p.z
        + d * p.x * p.y
        + e * p.y * p.z
        + f * p.z * p.x
        + g * p.x
        + h * p.y
        + i * p.z
        + f64::from(q.constant)
}

#[test]
fn a_quadric_is_hit_wherever_its_value_changes_sign_in_the_box() {
    let mut numbers = Numbers(2);
    let clip = Aabb { min: Vec3A::splat(-1.0), max: Vec3A::new(1.0, 0.8, 1.2) };
    let (mut one, mut two) = (0, 0);
    for case in 0..20_000 {
        // Now and then a sheet, a cylinder, a pair of planes, a single plane.
        let keep = [1.0, 1.0, 1.0, 0.0][case % 4];
        let some = numbers.vector(2.0).to_array().map(|x| if case % 3 == 0 { x * keep } else { x });
        let quadric = Quadric {
            squares: some,
            products: (numbers.vector(1.0) * keep).to_array(),
            linear: numbers.vector(1.0).to_array(),
            constant: numbers.between(-0.3, 0.3),
            clip,
        };
        let ray = numbers.ray_at(Vec3A::ZERO, 0.9, [2.5, 40.0][case % 2]);
        let length = f64::from(ray.dir().length());
        let inside = |t: f64| {
            let p = at(&ray, t).as_vec3a();
            clip.contains(&Aabb { min: p, max: p })
        };
        let middle = -ray.origin().as_dvec3().dot(ray.dir().as_dvec3()) / (length * length);
        let mut expected = Vec::new();
        let steps = 500;
        let t_of = |i: i32| middle + 2.0 * (f64::from(i) / f64::from(steps) * 2.0 - 1.0) / length;
        for i in 0..steps {
            let (mut low, mut high) = (t_of(i), t_of(i + 1));
            let front = value(&quadric, &ray, low) > 0.0;
            if front == (value(&quadric, &ray, high) > 0.0) {
                continue;
            }
            for _ in 0..60 {
                let t = (low + high) / 2.0;
                if (value(&quadric, &ray, t) > 0.0) == front { low = t } else { high = t }
            }
            if inside(low) {
                expected.push((low, front));
            }
        }
        let found = crossings(&quadric, &ray);
        // What the walk steps over, or cannot tell to be inside, is next to nothing.
        let close = found.windows(2).any(|pair| f64::from(pair[1].t - pair[0].t) * length < 0.02);
        if !close && found.len() != expected.len() {
            let edge = |t: f64| inside(t - 1e-5 / length) != inside(t + 1e-5 / length);
            assert!(
                found.iter().any(|hit| edge(hit.t.into())) || expected.iter().any(|e| edge(e.0)),
                "seed 2, case {case} {quadric:?} {ray:?} {found:?} {expected:?}"
            );
            continue;
        }
        for (hit, (t, front)) in found.iter().zip(&expected).filter(|_| !close) {
            assert!((f64::from(hit.t) - t).abs() * length < 1e-5, "seed 2, case {case}");
            assert_eq!(hit.front, *front, "seed 2, case {case}");
        }
        one += usize::from(found.len() == 1);
        two += usize::from(found.len() == 2);
    }
    assert!(one > 2_000 && two > 1_000, "{one} {two}");
}

#[test]
fn an_ellipsoid_knows_its_bounds() {
    let mut numbers = Numbers(3);
    for case in 0..2_000 {
        let quadric = Quadric {
            squares: (numbers.vector(1.0) + 2.0).to_array(),
            products: numbers.vector(0.9).to_array(),
            linear: numbers.vector(3.0).to_array(),
            constant: -1.0,
            clip: Aabb::ENDLESS,
        };
        let bounds = quadric.bounds();
        assert!(bounds.is_bounded() && !bounds.is_empty(), "seed 3, case {case}");
        let mut reach = Aabb::EMPTY;
        for _ in 0..200 {
            let ray = numbers.ray_at(bounds.center(), 0.7, 5.0);
            for hit in crossings(&quadric, &ray) {
                let surface = quadric.surface(&ray, &hit);
                reach = reach.with(surface.position);
                assert!(
                    value(&quadric, &Ray::new(surface.position, Vec3A::X, RayKind::Camera), 0.0)
                        .abs()
                        < 1e-5
                );
            }
        }
        assert!(bounds.padded().contains(&reach), "seed 3, case {case}");
        assert!(reach.size().cmpge(bounds.size() * 0.8).all(), "seed 3, case {case}: too large");
    }
}

#[test]
fn nonsense_is_never_hit() {
    let o = Vec3A::ZERO;
    let good = Torus { center: o, axis: Vec3A::Z, major: 1.0, minor: 0.2 };
    let ray = Ray::new(Vec3A::new(-4.0, 0.0, 0.0), Vec3A::X, RayKind::Camera);
    assert_eq!(crossings(&good, &ray).len(), 4);
    for torus in [
        Torus { axis: o, ..good },
        Torus { axis: Vec3A::NAN, ..good },
        Torus { center: Vec3A::new(0.0, f32::NAN, 0.0), ..good },
        Torus { major: 0.0, ..good },
        Torus { minor: f32::INFINITY, ..good },
        Torus { minor: -0.2, ..good },
    ] {
        assert!(torus.bounds().is_empty() && crossings(&torus, &ray).is_empty(), "{torus:?}");
    }
    let good = Quadric {
        squares: [1.0; 3],
        products: [0.0; 3],
        linear: [0.0; 3],
        constant: -1.0,
        clip: Aabb::ENDLESS,
    };
    assert_eq!(crossings(&good, &ray).len(), 2);
    for quadric in [
        Quadric { squares: [0.0; 3], ..good },
        Quadric { squares: [f32::NAN, 1.0, 1.0], ..good },
        Quadric { constant: f32::INFINITY, ..good },
        Quadric { clip: Aabb::EMPTY, ..good },
        Quadric { clip: Aabb { min: Vec3A::NAN, max: Vec3A::NAN }, ..good },
    ] {
        assert!(quadric.bounds().is_empty() && crossings(&quadric, &ray).is_empty(), "{quadric:?}");
    }
    // A sphere of imaginary radius is there, but nowhere.
    assert_eq!(crossings(&Quadric { constant: 1.0, ..good }, &ray), []);
}
