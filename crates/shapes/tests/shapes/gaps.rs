//! Polygons that share edges leave no gap between them.

use glam::{DQuat, DVec3, Vec3A};
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::polygon::Polygon;
use nestray_shapes::shape::Shape;

use crate::hits::crossings;
use crate::numbers::Numbers;

/// A wheel with teeth, as wide as it is thick, turned and moved; two faces of `2 · teeth`
/// vertices each and a quadrilateral for each of their edges. Its corners are a little off
/// their planes once they are rounded.
fn gear(numbers: &mut Numbers, teeth: usize) -> Vec<Polygon> {
    let turn = DQuat::from_axis_angle(numbers.unit(), numbers.between(0.0, 6.0));
    let at = numbers.cube() * numbers.size(-1.0, 3.0);
    let count = 2 * teeth;
    let ring = |height: f64| -> Vec<[f32; 3]> {
        (0..count)
            .map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / count as f64;
                let radius = if i % 2 == 0 { 1.0 } else { 0.8 };
                let flat = DVec3::new(libm::cos(angle) * radius, libm::sin(angle) * radius, height);
                (at + turn * flat).as_vec3a().to_array()
            })
            .collect()
    };
    let (mut low, high) = (ring(-0.5), ring(0.5));
    let mut faces: Vec<Polygon> = (0..count)
        .map(|i| {
            let j = (i + 1) % count;
            Polygon::new(vec![low[i], low[j], high[j], high[i]])
        })
        .collect();
    low.reverse();
    faces.push(Polygon::new(low));
    faces.push(Polygon::new(high));
    faces
}

#[test]
fn no_ray_from_inside_gets_out_between_polygons() {
    for seed in 0..30 {
        let mut numbers = Numbers(seed);
        let faces = gear(&mut numbers, [3, 4, 8, 72][seed as usize % 4]);
        let corners: Vec<DVec3> = faces
            .iter()
            .flat_map(|face| face.vertices())
            .map(|&v| Vec3A::from_array(v).as_dvec3())
            .collect();
        let middle = corners.iter().copied().sum::<DVec3>() / corners.len() as f64;
        for case in 0..1_000 {
            let inside = (middle + numbers.cube() * 0.2).as_vec3a();
            // Straight at a corner, or at a place on an edge.
            let face = &faces[numbers.below(faces.len())];
            let i = numbers.below(face.vertices().len());
            let a = Vec3A::from_array(face.vertices()[i]);
            let b = Vec3A::from_array(face.vertices()[(i + 1) % face.vertices().len()]);
            let target = if case % 2 == 0 { a } else { a + (b - a) * numbers.next() as f32 };
            let ray = Ray::new(inside, target - inside, RayKind::Camera);
            let ahead = faces.iter().flat_map(|face| crossings(face, &ray)).filter(|c| c.t >= 0.0);
            let outward = ahead.filter(|crossing| !crossing.front).count();
            assert!(outward > 0, "seed {seed}, case {case}: {ray:?}");
            // From outside a line goes in as often as it comes out.
            let all = faces.iter().map(|face| crossings(face, &ray).len()).sum::<usize>();
            assert_eq!(all % 2, 0, "seed {seed}, case {case}: {ray:?}");
        }
    }
}

#[test]
fn one_of_two_polygons_with_a_common_edge_is_hit_never_both() {
    // A square cut in four along lines that are not straight, in whole numbers.
    let [a, b, c, d] = [[0.0, 0.0], [8.0, 0.0], [8.0, 8.0], [0.0, 8.0]];
    let [n, e, s, w, m] = [[3.0, 8.0], [8.0, 5.0], [4.0, 0.0], [0.0, 3.0], [4.0, 4.0]];
    let (p, q) = ([5.0, 3.0], [2.0, 6.0]);
    let pieces =
        [vec![a, s, p, m, w], vec![s, b, e, m, p], vec![m, e, c, n, q], vec![w, m, q, n, d]];
    for height in [0.0, 1.0, 0.3] {
        let polygons = pieces.clone().map(|piece| {
            Polygon::new(piece.iter().map(|&[x, y]| [x, y, height]).collect::<Vec<_>>())
        });
        let mut numbers = Numbers(2);
        for case in 0..4_000 {
            let piece = &pieces[numbers.below(4)];
            let i = numbers.below(piece.len());
            let (from, to) = (piece[i], piece[(i + 1) % piece.len()]);
            let part = [0.0, 0.5, 0.25][case % 3];
            let [x, y] = [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * part);
            if x == 0.0 || y == 0.0 || x == 8.0 || y == 8.0 {
                continue;
            }
            let dir = match case % 2 {
                0 => Vec3A::NEG_Z,
                _ => Vec3A::new(numbers.below(5) as f32 - 2.0, numbers.below(5) as f32 - 2.0, -1.0),
            };
            let origin = Vec3A::new(x, y, height) - dir * 2.0;
            let ray = Ray::new(origin, dir, RayKind::Camera);
            let hits: usize = polygons.iter().map(|polygon| crossings(polygon, &ray).len()).sum();
            assert_eq!(hits, 1, "case {case}: {ray:?}");
        }
    }
}

#[test]
fn a_hit_of_a_bent_polygon_still_lies_within_its_bounds() {
    let mut numbers = Numbers(3);
    for case in 0..2_000 {
        let corners: Vec<[f32; 3]> = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| [x, y, numbers.between(-0.5, 0.5) as f32])
            .to_vec();
        let polygon = Polygon::new(corners);
        let ray = numbers.ray_near(DVec3::ZERO, 1.0);
        for crossing in crossings(&polygon, &ray) {
            let point = polygon.surface(&ray, &crossing).position;
            let bounds = polygon.bounds().padded();
            assert!(point.cmpge(bounds.min).all() && point.cmple(bounds.max).all(), "case {case}");
        }
    }
}

#[test]
fn a_polygon_faces_where_its_first_corner_says() {
    let mut numbers = Numbers(4);
    for case in 0..500 {
        let normal = numbers.unit().as_vec3a();
        let radius = [1.0, 0.4];
        // From an outer vertex on, so that the first corner is convex.
        let mut vertices = crate::samples::ring(12, Vec3A::ONE, normal, |i| radius[i % 2]);
        vertices.rotate_left(11);
        let [a, b, c] = [0, 1, 2].map(|i| Vec3A::from_array(vertices[i]));
        let first = (b - a).cross(c - b);
        let polygon = Polygon::new(vertices);
        assert!(polygon.normal().dot(first) > 0.0, "case {case}");
        assert!(polygon.normal().dot(normal) > 0.999, "case {case}");
    }
}
