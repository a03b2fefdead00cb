//! Height fields: against their triangles one by one, and between them.

use glam::{DVec3, Vec3A};
use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_shapes::height_field::{HeightField, HeightFieldError, Relief};
use nestray_shapes::shape::{Shape, Single};

use crate::numbers::{Numbers, at, crossings};

fn field(numbers: &mut Numbers, counts: [usize; 2], center: Vec3A) -> HeightField {
    let heights: Vec<f32> =
        (0..counts[0] * counts[1]).map(|_| center.y + numbers.between(-0.3, 0.3)).collect();
    let (from, to) = ([center.x - 2.0, center.z - 1.0], [center.x + 2.0, center.z + 1.0]);
    HeightField::new(from, to, counts, heights).expect("it has an area")
}

/// All hits of all triangles, by solving three equations for each.
fn every_triangle(field: &HeightField, ray: &Ray) -> Vec<f64> {
    let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
    let [nx, nz] = field.counts();
    let mut found = Vec::new();
    for (x, z) in (0..nx - 1).flat_map(|x| (0..nz - 1).map(move |z| (x, z))) {
        let p = |i: usize, k: usize| field.sample(x + i, z + k).as_dvec3();
        for [a, b, c] in [[p(0, 0), p(0, 1), p(1, 1)], [p(0, 0), p(1, 1), p(1, 0)]] {
            let normal = (b - a).cross(c - a);
            let t = (a - origin).dot(normal) / dir.dot(normal);
            let from = origin + dir * t - a;
            let v = from.cross(c - a).dot(normal) / normal.length_squared();
            let w = (b - a).cross(from).dot(normal) / normal.length_squared();
            if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
                found.push(t);
            }
        }
    }
    found.sort_by(f64::total_cmp);
    found
}

#[test]
fn a_field_is_hit_where_its_triangles_are() {
    let mut numbers = Numbers(1);
    let mut several = 0;
    for case in 0..600 {
        let counts = [2 + case % 60, 2 + case % 37];
        let center = numbers.vector([0.0, 10.0, 1000.0][case % 3]);
        let field = field(&mut numbers, counts, center);
        for round in 0..10 {
            let flat = round % 2 == 0;
            let mut ray = numbers.ray_at(center, 1.0, if flat { 3.0 } else { 50.0 });
            if flat {
                // Nearly level: through many cells.
                let dir = ray.dir() * Vec3A::new(1.0, 0.05, 1.0);
                ray = Ray::new(center - dir.normalize() * 3.0, dir, RayKind::Camera);
            }
            let expected = every_triangle(&field, &ray);
            let found = crossings(&field, &ray);
            assert_eq!(found.len(), expected.len(), "seed 1, case {case} {ray:?}");
            several += usize::from(found.len() > 2);
            for (hit, t) in found.iter().zip(&expected) {
                let room = 1e-6 * t.abs().max(1.0);
                assert!((f64::from(hit.t) - t).abs() <= room, "seed 1, case {case} {hit:?} {t}");
            }
        }
    }
    assert!(several > 300, "{several}");
}

#[test]
fn no_ray_slips_through_a_vertex_an_edge_or_along_a_row() {
    let mut numbers = Numbers(2);
    for case in 0..2000 {
        let center = numbers.vector(if case % 2 == 0 { 1.0 } else { 300.0 });
        let field = field(&mut numbers, [17, 33], center);
        let (x, z) = (1 + case % 15, 1 + case % 31);
        let vertex = field.sample(x, z);
        let next = field.sample(x + case % 2, z + case % 3 / 2);
        let target = vertex + (next - vertex) * numbers.next();
        let up = Vec3A::new(0.0, [1.0, 30.0, 1e4][case % 3], 0.0);
        let side = numbers.vector(0.2);
        for target in [vertex, target] {
            let from = target + up + if case % 5 == 0 { Vec3A::ZERO } else { side };
            for (from, dir) in [(from, target - from), (target * 2.0 - from, from - target)] {
                let ray = Ray::new(from, dir, RayKind::Camera);
                let found = crossings(&field, &ray);
                assert!(!found.is_empty(), "seed 2, case {case} {ray:?}");
            }
        }
        // Straight along a line of samples, just below its lowest end.
        let (a, b) = (field.sample(x, 0), field.sample(x, 32));
        let low = Vec3A::Y * (a.y.min(b.y) - 0.4 - center.y);
        let ray = Ray::new(a - low, (b - a) * Vec3A::new(1.0, 0.0, 1.0), RayKind::Camera);
        crossings(&field, &ray);
    }
}

#[test]
fn a_hit_has_the_surface_of_its_triangle() {
    let mut numbers = Numbers(3);
    for case in 0..400 {
        let center = numbers.vector(if case % 2 == 0 { 0.0 } else { 100.0 });
        let facets = field(&mut numbers, [30, 20], center);
        let smooth = facets.clone().shaded(Relief::Smooth);
        let ray = numbers.ray_at(center, 1.0, 20.0);
        for hit in crossings(&facets, &ray) {
            let seen = facets.surface(&ray, &hit);
            let place = at(&ray, hit.t.into());
            let off = (seen.position.as_dvec3() - place).length();
            assert!(off < 1e-5 + f64::from(center.length()) * 1e-6, "seed 3, case {case}: {off}");
            assert!((seen.normal.length() - 1.0).abs() < 1e-6 && seen.normal.y > 0.0);
            let facing = seen.normal.dot(ray.dir().normalize());
            assert!(facing.abs() < 1e-5 || hit.front == (facing < 0.0), "seed 3, case {case}");
            let shaded = smooth.surface(&ray, &hit);
            assert_eq!((shaded.normal, shaded.position), (seen.normal, seen.position));
            assert!((shaded.shading.length() - 1.0).abs() < 1e-6 && shaded.shading.y > 0.0);
            let [u, v] = hit.uv;
            let over = DVec3::new(f64::from(u) * 4.0 - 2.0, 0.0, f64::from(v) * 2.0 - 1.0);
            let level = (center.as_dvec3() + over - place) * DVec3::new(1.0, 0.0, 1.0);
            assert!(level.length() < 1e-4, "seed 3, case {case}");
        }
    }
}

#[test]
fn the_nearest_hit_is_the_first_of_all() {
    let mut numbers = Numbers(4);
    let mut scratch = Scratch::new();
    let mut several = 0;
    for case in 0..3_000 {
        let counts = [2 + case % 90, 2 + case % 41];
        let object = Single::new(0, field(&mut numbers, counts, Vec3A::ZERO));
        let level = Vec3A::new(1.0, 0.1, 1.0);
        let ray = numbers.ray_at(Vec3A::ZERO, 1.0, 3.0);
        let ray = Ray::new(ray.origin() * level, ray.dir() * level, RayKind::Camera);
        for ray in [ray, ray.between(numbers.next(), numbers.between(0.5, 3.0))] {
            let mut all = Vec::new();
            object.all_hits(&ray, &mut all, &mut scratch);
            all.sort_by(|a, b| a.t.total_cmp(&b.t));
            let inside = |t: f32| ray.t_min() <= t && t <= ray.t_max();
            let line = crossings(&object.shape, &ray);
            let expected = line.iter().filter(|hit| inside(hit.t)).map(|hit| hit.t);
            assert!(all.iter().map(|hit| hit.t).eq(expected), "seed 4, case {case}");
            let mut hit = Hit::none(ray.t_max());
            let found = object.closest_hit(&ray, &mut hit, &mut scratch);
            assert_eq!(found.then_some(hit.t), all.first().map(|hit| hit.t), "seed 4, case {case}");
            assert_eq!(object.any_hit(&ray, &mut scratch), found, "seed 4, case {case}");
            several += usize::from(all.len() > 3);
        }
    }
    assert!(several > 300, "{several}");
}

#[test]
fn a_smooth_slope_is_shaded_by_its_slope() {
    let heights: Vec<f32> = (0..50).map(|i| (i % 10) as f32 * 0.5).collect();
    let field = HeightField::new([0.0; 2], [9.0, 4.0], [10, 5], heights)
        .expect("it has an area")
        .shaded(Relief::Smooth);
    let ray = Ray::new(Vec3A::new(4.3, 9.0, 2.2), Vec3A::NEG_Y, RayKind::Camera);
    let found = crossings(&field, &ray);
    let expected = Vec3A::new(-0.5, 1.0, 0.0).normalize();
    let surface = field.surface(&ray, &found[0]);
    assert!((surface.shading - expected).length() < 1e-6, "{surface:?}");
    assert!((surface.normal - expected).length() < 1e-6);
}

#[test]
fn numbers_that_make_no_field_are_told() {
    let new =
        |to: f32, counts, heights: &[f32]| HeightField::new([0.0; 2], [to; 2], counts, heights);
    assert_eq!(new(1.0, [1, 4], &[0.0; 4]), Err(HeightFieldError::TooFew([1, 4])));
    let counts = [usize::MAX, 3];
    assert_eq!(new(1.0, counts, &[0.0; 4]), Err(HeightFieldError::Count { found: 4, counts }));
    assert!(matches!(new(0.0, [2, 2], &[0.0; 4]), Err(HeightFieldError::Rectangle { .. })));
    assert!(matches!(new(f32::NAN, [2, 2], &[0.0; 4]), Err(HeightFieldError::Rectangle { .. })));
    let bad = new(1.0, [2, 2], &[0.0, 1.0, f32::INFINITY, 0.0]);
    assert_eq!(bad, Err(HeightFieldError::Height { index: 2, height: f32::INFINITY }));
}
