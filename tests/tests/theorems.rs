//! The two theorems that every expected cost rests on, held against lines: of the lines that meet a
//! convex body, the part that meets one inside it is the ratio of their surfaces, and a convex body
//! is seen, in the mean over all directions, as a quarter of its surface [Cauchy 1841].
//!
//! Bodies are hulls of random points as meshes in several techniques, boxes, and spheres; areas are
//! worked out here. Four standard deviations are allowed.
#![expect(clippy::print_stdout, reason = "the table is what one looks at")]

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec3, Vec3A};
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_registry::{Members, find};
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use nestray_tests::numbers::Numbers;
use serde_json::Value;

/// Lines for each pair of bodies; `NESTRAY_LINES` asks for another number.
fn lines() -> u64 {
    let asked = std::env::var("NESTRAY_LINES").ok().and_then(|n| n.parse().ok());
    asked.unwrap_or(1_000_000)
}

/// Standard deviations that chance may be off.
const ALLOWED: f64 = 4.0;

/// Whether a ray meets it.
type Meets = dyn Fn(&Ray, &mut Scratch) -> bool;

/// A convex body, and what its surface is.
struct Body {
    meets: Box<Meets>,
    surface: f64,
}

/// The faces of the hull of points in general position: all to one side of each.
fn hull(points: &[DVec3]) -> Vec<[DVec3; 3]> {
    let mut faces = Vec::new();
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().skip(i + 1) {
            for (k, &c) in points.iter().enumerate().skip(j + 1) {
                let normal = (b - a).cross(c - a);
                let rest = points.iter().enumerate().filter(|(at, _)| ![i, j, k].contains(at));
                let mut sides = rest.map(|(_, &point)| normal.dot(point - a) > 0.0);
                let first = sides.next().unwrap_or(true);
                if sides.all(|side| side == first) {
                    faces.push(if first { [a, c, b] } else { [a, b, c] });
                }
            }
        }
    }
    faces
}

fn mesh(points: &[DVec3], technique: &str) -> Body {
    let faces = hull(points);
    assert!(faces.len() >= 4, "a hull has four faces or more");
    let surface = faces.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum();
    let corners: Vec<_> = faces.iter().map(|face| face.map(|p| p.as_vec3().into())).collect();
    let mesh = TriangleMesh::new(0, Arc::new(Triangles::from_corners(&corners)));
    let entry = find(technique).expect("it is there");
    let nest: DynObject =
        (entry.build)(&Value::Null, Members::Triangles(mesh)).expect("the defaults are sound");
    Body { meets: Box::new(move |ray, scratch| nest.any_hit(ray, scratch)), surface }
}

/// A box as nests cut rays by it; its surface is what they price it by.
fn boxed(bounds: Aabb) -> Body {
    let reach = bounds.reach().max(2.0);
    let meets = move |ray: &Ray, _: &mut Scratch| {
        Clip::with_slack(ray, reach, 0.0).cut(&bounds, f32::INFINITY).is_some()
    };
    Body { meets: Box::new(meets), surface: bounds.surface_area().into() }
}

fn ball(center: Vec3A, radius: f32) -> Body {
    let ball = Single::new(0, Sphere { center, radius });
    let surface = 4.0 * PI * f64::from(radius).powi(2);
    Body { meets: Box::new(move |ray, scratch| ball.any_hit(ray, scratch)), surface }
}

/// Pairs of bodies within the unit ball, the second inside the first.
fn pairs() -> Vec<(&'static str, [Body; 2])> {
    let mut numbers = Numbers::new(1841);
    let mut points = |count: usize, scale: DVec3| -> Vec<DVec3> {
        let mut point = || numbers.direction().as_dvec3() * f64::from(numbers.between(0.6, 0.99));
        (0..count).map(|_| point() * scale).collect()
    };
    let (round, flat, thin) = (
        points(24, DVec3::ONE),
        points(16, DVec3::new(1.0, 0.8, 0.05)),
        points(10, DVec3::new(1.0, 0.06, 0.03)),
    );
    let middle = round.iter().sum::<DVec3>() / round.len() as f64;
    let shrunk = |points: &[DVec3], size: f64| -> Vec<DVec3> {
        let middle = points.iter().sum::<DVec3>() / points.len() as f64;
        points.iter().map(|&point| middle + (point - middle) * size).collect()
    };
    let (low, high) = (Vec3A::new(-0.5, -0.4, -0.6), Vec3A::new(0.5, 0.55, 0.4));
    let large = Aabb { min: low, max: high };
    let small = Aabb { min: low * 0.5, max: Vec3A::new(0.5, 0.1, -0.2) };
    vec![
        ("a hull in a hull", [mesh(&round, "bvh"), mesh(&shrunk(&round, 0.6), "grid")]),
        // Corners are shared.
        ("some corners of a hull", [mesh(&round, "kd-tree"), mesh(&round[..9], "octree")]),
        ("flat in flat", [mesh(&flat, "bvh"), mesh(&shrunk(&flat, 0.3), "list")]),
        ("thin in thin", [mesh(&thin, "goldsmith-salmon"), mesh(&shrunk(&thin, 0.8), "slabs")]),
        ("a ball in a hull", [mesh(&round, "bvh"), ball(middle.as_vec3().into(), 0.2)]),
        ("a box in a box, a corner shared", [boxed(large), boxed(small)]),
        ("a box in a ball", [ball(Vec3A::ZERO, 0.98), boxed(large)]),
    ]
}

/// A line such that all that meet the ball of radius 1 are as likely: in any direction, through any
/// point of the disk across it.
fn line(numbers: &mut Numbers) -> Ray {
    let dir = numbers.direction();
    let (u, v) = dir.any_orthonormal_pair();
    loop {
        let (x, y) = (numbers.between(-1.0, 1.0), numbers.between(-1.0, 1.0));
        if x * x + y * y <= 1.0 {
            return Ray::new(u * x + v * y - dir * 2.0, dir, RayKind::Camera);
        }
    }
}

/// How many standard deviations a count of hits is off.
fn off(hits: u64, of: u64, chance: f64) -> f64 {
    let of = of as f64;
    (hits as f64 - of * chance) / (of * chance * (1.0 - chance)).sqrt()
}

#[test]
fn lines_meet_convex_bodies_by_their_surface() {
    let (mut numbers, mut scratch, mut wrong) = (Numbers::new(4), Scratch::new(), Vec::new());
    let all = lines();
    println!("{:34} {:>9} {:>9} {:>7}", "", "expected", "counted", "sigmas");
    for (name, [outer, inner]) in pairs() {
        let (mut outside, mut inside, mut both) = (0u64, 0u64, 0u64);
        for _ in 0..all {
            let ray = line(&mut numbers);
            let (a, b) = ((outer.meets)(&ray, &mut scratch), (inner.meets)(&ray, &mut scratch));
            outside += u64::from(a);
            inside += u64::from(b);
            both += u64::from(a && b);
        }
        // Seen from everywhere: the disk has the area π.
        let seen = |body: &Body| body.surface / 4.0 / PI;
        let rows = [
            ("the outer, seen", outside, all, seen(&outer)),
            ("the inner, seen", inside, all, seen(&inner)),
            ("the inner, of the outer", both, outside, inner.surface / outer.surface),
        ];
        println!("{name}");
        for (what, hits, of, chance) in rows {
            assert!(chance > 0.0 && chance < 1.0, "{name}: {what} {chance}");
            let (counted, sigmas) = (hits as f64 / of as f64, off(hits, of, chance));
            println!("    {what:30} {chance:>9.5} {counted:>9.5} {sigmas:>+7.2}");
            if sigmas.abs() > ALLOWED {
                wrong.push(format!("{name}: {what}: {counted} for {chance}"));
            }
        }
        // What meets the inner body meets the outer, but for a hair's breadth at shared corners.
        let outside = inside - both;
        assert!(outside <= inside / 10_000, "{name}: {outside} lines meet the inner body only");
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_surface_that_is_wrong_by_a_hundredth_is_noticed() {
    let cube = Aabb { min: Vec3A::splat(-0.5), max: Vec3A::splat(0.5) };
    let (body, mut numbers, mut scratch) = (boxed(cube), Numbers::new(7), Scratch::new());
    let all = 1_000_000;
    let meets =
        |numbers: &mut Numbers, scratch: &mut Scratch| (body.meets)(&line(numbers), scratch);
    let hits = (0..all).filter(|_| meets(&mut numbers, &mut scratch)).count() as u64;
    let chance = body.surface / 4.0 / PI;
    assert!(off(hits, all, chance).abs() < ALLOWED);
    assert!(off(hits, all, 1.01 * chance).abs() > ALLOWED);
}
