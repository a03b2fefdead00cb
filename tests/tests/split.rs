//! Children that a technique cuts up are found where they are hit: needles, rays along the planes
//! they are cut by, rays that see them from the side, from near and from very far.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::object::DynObject;
use nestray_core::ray::{Ray, RayKind};
use nestray_registry::{Members, find};
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use nestray_tests::compare::assert_equal;
use nestray_tests::numbers::Numbers;
use serde_json::{Value, json};

/// Long triangles in all directions, most of them very thin; every other one has a twin that it
/// shares an edge with, and some stand in planes across an axis.
fn needles(numbers: &mut Numbers, count: usize) -> Vec<[Vec3A; 3]> {
    let mut corners = Vec::new();
    while corners.len() < count {
        let from = numbers.point();
        let mut to = from + (numbers.point() - 0.5) * 0.8;
        let thin = *numbers.pick(&[1e-1, 1e-2, 1e-4, 1e-6]);
        let mut aside = from + (numbers.point() - 0.5) * thin;
        if corners.len() % 5 == 0 {
            let axis = corners.len() / 5 % 3;
            (to[axis], aside[axis]) = (from[axis], from[axis]);
        }
        corners.push([from, aside, to]);
        if corners.len() % 2 == 0 {
            corners.push([from, to, to + (numbers.point() - 0.5) * thin]);
        }
    }
    corners
}

/// Rays at the needles: along their planes and axes, and through points of them.
fn rays(numbers: &mut Numbers, needles: &[[Vec3A; 3]], count: usize) -> Vec<Ray> {
    let mut rays = Vec::new();
    while rays.len() < count {
        let [a, b, c] = *numbers.pick(needles);
        let (u, v) = (numbers.unit(), numbers.unit());
        // Halves and quarters are where trees cut.
        let u = *numbers.pick(&[u, 0.5, 0.25, 0.0, 1.0]);
        let on = a + (b - a) * (v * (1.0 - u)) + (c - a) * u;
        let aside = (numbers.point() - 0.5) * *numbers.pick(&[1.0, 1e-3, 1e-6]);
        let mut dir = match numbers.below(4) {
            0 => (c - a) + aside,
            1 => (b - a) * 1e3 + (c - a) + aside,
            2 => numbers.point() - 0.5,
            _ => *numbers.pick(&Vec3A::AXES),
        };
        if numbers.once_in(5) {
            dir[numbers.below(3)] = 0.0;
        }
        let back = *numbers.pick(&[0.0, 0.3, 3.0, 1e3, 1e6]);
        let far = dir.length() > 0.0;
        let origin = if far { on - dir.normalize() * back } else { on };
        rays.push(Ray::new(origin, dir, RayKind::Camera));
    }
    rays
}

fn built(technique: &str, settings: &Value, triangles: &Arc<Triangles>) -> DynObject {
    let members = Members::Triangles(TriangleMesh::new(0, Arc::clone(triangles)));
    let entry = find(technique).expect("there is such a technique");
    (entry.build)(settings, members).expect("settings in range")
}

#[test]
fn needles_are_hit_as_in_the_list() {
    for seed in 0..8 {
        let mut numbers = Numbers::new(seed);
        let needles = needles(&mut numbers, 400);
        let triangles = Arc::new(Triangles::from_corners(&needles));
        let oracle = built("list", &Value::Null, &triangles);
        let rays = rays(&mut numbers, &needles, 10_000);
        for settings in [json!({}), json!({ "copies": 2.0, "overlap": 0.0, "max_leaf": 1 })] {
            let nest = built("sbvh", &settings, &triangles);
            assert_equal(&oracle, &nest, &rays, &format!("{settings}, seed {seed}"));
        }
    }
}
