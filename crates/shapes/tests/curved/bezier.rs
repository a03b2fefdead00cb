//! Bézier patches: no root lost, none invented, no gap between neighbours.

use glam::{DVec2, DVec3, Vec3A};
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::bezier::BezierPatch;
use nestray_shapes::shape::Shape;

use crate::numbers::{Numbers, at, crossings};

/// A bumpy square of about `[0, 3]²`; with much noise it folds over itself.
fn patch(numbers: &mut Numbers, noise: f32) -> BezierPatch {
    let points = [0, 1, 2, 3]
        .map(|i| [0, 1, 2, 3].map(|j| Vec3A::new(i as f32, j as f32, 0.0) + numbers.vector(noise)));
    BezierPatch { points }
}

/// Place and derivatives, by the Bernstein polynomials as they stand.
fn evaluate(patch: &BezierPatch, u: f64, v: f64) -> [DVec3; 3] {
    let value = |u: f64| {
        [(1.0 - u).powi(3), 3.0 * u * (1.0 - u).powi(2), 3.0 * u * u * (1.0 - u), u.powi(3)]
    };
    let slope = |u: f64| {
        let w = 1.0 - u;
        [-3.0 * w * w, 3.0 * w * w - 6.0 * u * w, 6.0 * u * w - 3.0 * u * u, 3.0 * u * u]
    };
    let sum = |a: [f64; 4], b: [f64; 4]| {
        let mut sum = DVec3::ZERO;
        for (row, a) in patch.points.iter().zip(a) {
            for (point, b) in row.iter().zip(b) {
                sum += point.as_dvec3() * a * b;
            }
        }
        sum
    };
    [sum(value(u), value(v)), sum(slope(u), value(v)), sum(value(u), slope(v))]
}

/// All roots that a fine net of triangles shows, made exact: `(t, cosine with the normal)`.
fn dense_roots(patch: &BezierPatch, ray: &Ray) -> Vec<(f64, f64)> {
    const FINE: usize = 96;
    let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
    let (x, y) = dir.normalize().any_orthonormal_pair();
    let flat = |p: DVec3| DVec2::new((p - origin).dot(x), (p - origin).dot(y));
    let step = 1.0 / FINE as f64;
    let net: Vec<DVec2> = (0..=FINE * (FINE + 2))
        .map(|n| {
            flat(evaluate(patch, (n / (FINE + 1)) as f64 * step, (n % (FINE + 1)) as f64 * step)[0])
        })
        .collect();
    let mut roots: Vec<[f64; 4]> = Vec::new();
    for i in 0..FINE {
        for j in 0..FINE {
            let at = |i: usize, j: usize| net[i * (FINE + 1) + j];
            let corners = [at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)];
            // A hair around the cell: what is found twice is removed below.
            let low = corners.iter().fold(DVec2::INFINITY, |a, &b| a.min(b)) - 1e-3;
            let high = corners.iter().fold(DVec2::NEG_INFINITY, |a, &b| a.max(b)) + 1e-3;
            if low.max_element() > 0.0 || high.min_element() < 0.0 {
                continue;
            }
            let (mut u, mut v) = ((i as f64 + 0.5) * step, (j as f64 + 0.5) * step);
            let mut off = 1.0;
            for _ in 0..20 {
                let [p, pu, pv] = evaluate(patch, u, v);
                let (f, fu, fv) =
                    (flat(p), DVec2::new(pu.dot(x), pu.dot(y)), DVec2::new(pv.dot(x), pv.dot(y)));
                let turn = fu.perp_dot(fv);
                (u, v) = (u - f.perp_dot(fv) / turn, v - fu.perp_dot(f) / turn);
                off = f.length();
            }
            let inside = |u: f64| (0.0..=1.0).contains(&u);
            if off < 1e-12 && inside(u) && inside(v) {
                let [p, pu, pv] = evaluate(patch, u, v);
                let t = (p - origin).dot(dir) / dir.length_squared();
                let cosine = pu.cross(pv).normalize_or_zero().dot(dir.normalize());
                roots.push([u, v, t, cosine]);
            }
        }
    }
    let mut kept: Vec<[f64; 4]> = Vec::new();
    for root in roots {
        if !kept.iter().any(|k| (k[0] - root[0]).abs() + (k[1] - root[1]).abs() < 1e-7) {
            kept.push(root);
        }
    }
    kept.iter().map(|root| (root[2], root[3])).collect()
}

#[test]
fn no_root_of_a_patch_is_lost_or_invented() {
    let mut numbers = Numbers(1);
    let (mut seen, mut several) = (0, 0);
    for case in 0..1500 {
        let noise = [0.0, 0.3, 0.8, 2.0][case % 4];
        let patch = patch(&mut numbers, noise);
        let ray = numbers.ray_at(Vec3A::new(1.5, 1.5, 0.0), 1.5, 20.0);
        let found = crossings(&patch, &ray);
        let expected = dense_roots(&patch, &ray);
        several += usize::from(expected.len() > 1);
        for (t, cosine) in expected {
            seen += 1;
            let hit = found.iter().find(|hit| (f64::from(hit.t) - t).abs() <= 1e-6 * t.abs());
            let Some(hit) = hit else {
                panic!("seed 1, case {case}: lost t {t}, cosine {cosine}, {found:?}")
            };
            assert!(
                cosine.abs() < 1e-5 || hit.front == (cosine < 0.0),
                "seed 1, case {case}: side"
            );
        }
        for hit in &found {
            let [point, ..] = evaluate(&patch, hit.uv[0].into(), hit.uv[1].into());
            let off = (at(&ray, hit.t.into()) - point).length();
            assert!(off < 2e-5, "seed 1, case {case}: {off} off the patch");
        }
    }
    assert!(seen > 700 && several > 30, "{seen} roots, {several} times several");
}

#[test]
fn hits_lie_within_the_bounds_and_along_holds_them() {
    let mut numbers = Numbers(2);
    for case in 0..3000 {
        let patch = patch(&mut numbers, 1.0);
        let distance = if case % 2 == 0 { 5.0 } else { 5e4 };
        let ray = numbers.ray_at(Vec3A::new(1.5, 1.5, 0.0), 1.5, distance);
        let bounds = patch.bounds();
        let direction = numbers.vector(1.0);
        let [low, high] = patch.along(direction);
        for hit in crossings(&patch, &ray) {
            let (enter, leave) = Clip::new(&ray, bounds.reach())
                .cut(&bounds, f32::INFINITY)
                .unwrap_or_else(|| panic!("seed 2, case {case}: the ray misses the bounds"));
            assert!(enter <= hit.t && hit.t <= leave, "seed 2, case {case}");
            let surface = patch.surface(&ray, &hit);
            let grown = bounds.padded();
            assert!(grown.contains(&Aabb { min: surface.position, max: surface.position }));
            let reach = surface.position.dot(direction);
            assert!(low - 1e-5 <= reach && reach <= high + 1e-5, "seed 2, case {case}");
            let facing = surface.normal.dot(ray.dir().normalize());
            assert!(facing.abs() < 1e-4 || hit.front == (facing < 0.0), "seed 2, case {case}");
        }
    }
}

#[test]
fn neighbouring_patches_leave_no_gap() {
    let mut numbers = Numbers(3);
    for case in 0..4000 {
        let left = patch(&mut numbers, 0.4);
        let mut right = patch(&mut numbers, 0.4);
        for row in &mut right.points {
            for point in row {
                point.x += 3.0;
            }
        }
        right.points[0] = left.points[3];
        // As often the other way round: neighbours need not run the same way.
        if case % 2 == 0 {
            right.points.reverse();
            right.points.iter_mut().for_each(|row| row.reverse());
        }
        let v = numbers.next();
        let [border, ..] = evaluate(&left, 1.0, v.into());
        let distance = [3.0, 30.0, 3e3][case % 3];
        let from = border.as_vec3a()
            + Vec3A::new(numbers.between(-0.3, 0.3), numbers.between(-0.3, 0.3), 1.0) * distance;
        for (from, to) in
            [(from, border.as_vec3a()), (border.as_vec3a() * 2.0 - from, border.as_vec3a())]
        {
            let ray = Ray::new(from, to - from, RayKind::Camera);
            let hits = crossings(&left, &ray).len() + crossings(&right, &ray).len();
            assert!(hits > 0, "seed 3, case {case}: a ray slips through");
        }
    }
}

#[test]
fn a_pole_is_hit_and_has_a_normal() {
    // One edge drawn together at the top of a dome.
    let turn = [(1.0, 0.0), (1.0, 0.55), (0.55, 1.0), (0.0, 1.0f32)];
    let rings = [(0.0, 1.0), (0.55, 1.0), (1.0, 0.55), (1.0, 0.0f32)];
    let points = turn.map(|(x, y)| rings.map(|(r, z)| Vec3A::new(x * r, y * r, z)));
    let patch = BezierPatch { points };
    for tilt in [0.0, 0.1, -0.2f32] {
        let from = Vec3A::new(tilt, 2.0 * tilt, 3.0);
        let ray = Ray::new(from, Vec3A::Z - from, RayKind::Camera);
        let found = crossings(&patch, &ray);
        let hit = found.iter().find(|hit| (hit.t - 1.0).abs() < 1e-6).expect("the pole is hit");
        let normal = patch.surface(&ray, hit).normal;
        assert!(normal.z.abs() > 0.999, "{normal}");
        assert_eq!(hit.front, normal.dot(ray.dir()) < 0.0);
    }
    let normal = patch.surface(
        &Ray::new(Vec3A::ZERO, Vec3A::Z, RayKind::Camera),
        &nestray_shapes::shape::Crossing { t: 1.0, uv: [0.3, 1e-3], front: true },
    );
    assert!(normal.normal.z.abs() > 0.99);
}

#[test]
fn patches_without_sense_or_area_neither_panic_nor_hang() {
    let mut numbers = Numbers(4);
    let point = BezierPatch { points: [[Vec3A::ONE; 4]; 4] };
    let line = BezierPatch { points: [0, 1, 2, 3].map(|i| [Vec3A::X * i as f32; 4]) };
    let nan = BezierPatch { points: [[Vec3A::NAN; 4]; 4] };
    let huge = BezierPatch { points: [[Vec3A::splat(f32::MAX), Vec3A::X, Vec3A::Y, Vec3A::Z]; 4] };
    let flat = patch(&mut numbers, 0.0);
    for shape in [point, line, nan, huge, flat] {
        for _ in 0..50 {
            crossings(&shape, &numbers.ray_at(Vec3A::ONE, 0.0, 4.0));
            let inside = Ray::new(Vec3A::new(-5.0, numbers.next(), 0.0), Vec3A::X, RayKind::Camera);
            crossings(&shape, &inside);
        }
    }
    assert!(nan.bounds().is_empty());
}
