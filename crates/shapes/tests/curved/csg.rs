//! Solids made of solids: the laws of sets on random rays.

use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::children::Children;
use nestray_core::cost::CostModel;
use nestray_core::hit::Hit;
use nestray_core::instance::Instance;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_shapes::block::Block;
use nestray_shapes::csg::{Csg, Operation};
use nestray_shapes::plane::Plane;
use nestray_shapes::shape::{Shape, Single};
use nestray_shapes::sphere::Sphere;
use nestray_shapes::torus::Torus;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};

use crate::numbers::Numbers;

use Operation::{Difference, Intersection, Union};

fn single<S: Shape + 'static>(shape: S) -> DynObject {
    Arc::new(Single::new(0, shape))
}

fn sphere(x: f32, radius: f32) -> DynObject {
    single(Sphere { center: Vec3A::X * x, radius })
}

fn block(half: f32) -> DynObject {
    single(Block { extent: Aabb { min: Vec3A::splat(-half), max: Vec3A::splat(half) } })
}

fn csg(operation: Operation, left: &DynObject, right: &DynObject) -> DynObject {
    Arc::new(Csg::new(7, 3, operation, left.clone(), right.clone()))
}

/// A ball of triangles, tested one by one: an object without a technique.
struct Ball(TriangleMesh);

impl Ball {
    fn object(radius: f32, rings: u32) -> DynObject {
        let mut positions = Vec::new();
        for i in 0..=rings {
            for j in 0..2 * rings {
                let (fall, turn) = (i as f32, j as f32);
                let [fall, turn] = [fall, turn].map(|x| x * std::f32::consts::PI / rings as f32);
                let ring = radius * libm::sinf(fall);
                positions.push([
                    ring * libm::cosf(turn),
                    ring * libm::sinf(turn),
                    radius * libm::cosf(fall),
                ]);
            }
        }
        let mut faces = Vec::new();
        for i in 0..rings {
            for j in 0..2 * rings {
                // The ends of all rings meet in the poles, as one vertex.
                let at = |i: u32, j: u32| {
                    let j = if i == 0 || i == rings { 0 } else { j % (2 * rings) };
                    i * 2 * rings + j
                };
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                faces.extend(
                    [[a, b, c], [a, c, d]]
                        .into_iter()
                        .filter(|f| f[0] != f[1] && f[1] != f[2] && f[2] != f[0]),
                );
            }
        }
        let triangles = Triangles::new(positions, faces).expect("faces name vertices");
        Arc::new(Self(TriangleMesh::new(1, Arc::new(triangles))))
    }
}

impl Object for Ball {
    fn kind(&self) -> &'static str {
        "ball"
    }
    fn bounds(&self) -> Aabb {
        (0..self.0.count()).map(|i| self.0.bounds(i)).fold(Aabb::EMPTY, Aabb::join)
    }
    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        (0..self.0.count()).fold(false, |any, i| self.0.closest_hit(i, ray, hit, scratch) | any)
    }
    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        (0..self.0.count()).for_each(|i| self.0.all_hits(i, ray, hits, scratch));
    }
    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<nestray_core::surface::Surface> {
        self.0.surface(ray, hit)
    }
    fn cost(&self, model: &CostModel) -> nestray_core::cost::Cost {
        self.0.cost(0, model)
    }
}

/// The distances along a ray, and whether it enters there, by the normal.
fn hits(object: &DynObject, ray: &Ray) -> Vec<(f32, bool)> {
    let mut hits = Vec::new();
    object.all_hits(ray, &mut hits, &mut Scratch::new());
    hits.sort_by(|a, b| a.t.total_cmp(&b.t));
    let enters =
        |hit: &Hit| object.surface(ray, hit).expect("its own hit").normal.dot(ray.dir()) < 0.0;
    hits.iter().map(|hit| (hit.t, enters(hit))).collect()
}

/// Holds two solids against each other on random rays.
fn same(seed: u64, rays: usize, a: &DynObject, b: &DynObject) {
    let mut numbers = Numbers(seed);
    let mut any = 0;
    for case in 0..rays {
        let distance = [0.3, 3.0, 10.0][case % 3];
        let target = numbers.vector(0.5);
        let ray = numbers.ray_at(target, 1.0, distance);
        let (x, y) = (hits(a, &ray), hits(b, &ray));
        assert_eq!(x, y, "seed {seed}, case {case} {ray:?}");
        any += usize::from(!x.is_empty());
    }
    assert!(any * 5 > rays, "only {any} of {rays} rays hit anything");
}

#[test]
fn the_laws_of_sets_hold() {
    let (a, b, c) = (sphere(0.0, 1.0), sphere(0.7, 0.9), block(0.75));
    let all = sphere(0.0, 4.0);
    let not = |x: &DynObject| csg(Difference, &all, x);
    let bare = csg(Intersection, &a, &all);
    // (A ∪ B) \ B = A \ B
    same(1, 100_000, &csg(Difference, &csg(Union, &a, &b), &b), &csg(Difference, &a, &b));
    // A ∩ A = A ∪ A = A
    same(2, 100_000, &csg(Intersection, &a, &a), &a);
    same(3, 20_000, &csg(Union, &a, &a), &a);
    same(4, 20_000, &bare, &a);
    // Not (A ∪ B) = not A ∩ not B, and the other way round.
    same(5, 100_000, &not(&csg(Union, &a, &c)), &csg(Intersection, &not(&a), &not(&c)));
    same(6, 20_000, &not(&csg(Intersection, &a, &c)), &csg(Union, &not(&a), &not(&c)));
    // A ∩ (B ∪ C) = (A ∩ B) ∪ (A ∩ C), and A \ B = A ∩ not B.
    let left = csg(Intersection, &a, &csg(Union, &b, &c));
    same(7, 20_000, &left, &csg(Union, &csg(Intersection, &a, &b), &csg(Intersection, &a, &c)));
    same(8, 20_000, &csg(Difference, &a, &b), &csg(Intersection, &a, &not(&b)));
}

#[test]
fn nothing_is_left_of_a_solid_without_itself() {
    let torus = single(Torus { center: Vec3A::ZERO, axis: Vec3A::Z, major: 0.7, minor: 0.3 });
    for object in [sphere(0.0, 1.0), block(0.5), torus, Ball::object(1.0, 6)] {
        let none = csg(Difference, &object, &object);
        let mut numbers = Numbers(1);
        for _ in 0..5_000 {
            let ray = numbers.ray_at(Vec3A::ZERO, 1.0, 3.0);
            assert_eq!(hits(&none, &ray), [], "seed 1 {ray:?}");
        }
    }
}

/// What the numbers of a query say must hold of every solid.
fn sound(seed: u64, solid: &DynObject) {
    let mut numbers = Numbers(seed);
    let mut scratch = Scratch::new();
    for case in 0..3_000 {
        let ray = numbers.ray_at(Vec3A::ZERO, 1.0, 4.0);
        let all = hits(solid, &ray);
        assert!(all.len().is_multiple_of(2), "seed {seed}, case {case}: {all:?}");
        for (i, (_, enters)) in all.iter().enumerate() {
            assert_eq!(*enters, i % 2 == 0, "seed {seed}, case {case}: {all:?}");
        }
        let mut hit = Hit::none(ray.t_max());
        let found = solid.closest_hit(&ray, &mut hit, &mut scratch);
        assert_eq!(found.then_some(hit.t), all.first().map(|first| first.0));
        assert_eq!(found, solid.any_hit(&ray, &mut scratch));
        // Only part of the way: the same hits, as far as they are there.
        let (low, high) = (numbers.between(0.0, 2.0), numbers.between(0.5, 4.0));
        let part = ray.between(low, high);
        let expected: Vec<_> = all.iter().filter(|h| low <= h.0 && h.0 <= high).copied().collect();
        assert_eq!(hits(solid, &part), expected, "seed {seed}, case {case}");
        assert_eq!(solid.any_hit(&part, &mut scratch), !expected.is_empty());
        let grown = solid.bounds().padded();
        for (t, _) in &all {
            let point = ray.at(*t);
            let near = Aabb { min: point - 1e-5, max: point + 1e-5 };
            assert!(grown.overlaps(&near), "seed {seed}, case {case}");
        }
    }
}

#[test]
fn meshes_shapes_and_instances_combine_three_deep() {
    let ball = Ball::object(1.0, 8);
    let torus = single(Torus { center: Vec3A::ZERO, axis: Vec3A::ONE, major: 0.9, minor: 0.25 });
    let one = csg(Difference, &ball, &sphere(0.6, 0.7));
    let two = csg(Union, &one, &torus);
    let turned = Affine3A::from_scale_rotation_translation(
        Vec3::new(-1.1, 0.8, 1.0),
        Quat::from_xyzw(0.2, 0.4, -0.1, 0.9).normalize(),
        Vec3::new(0.1, -0.2, 0.3),
    );
    let placed: DynObject = Arc::new(Instance::new(1, two.clone(), turned));
    let three = csg(Intersection, &placed, &block(0.95));
    for (seed, solid) in [&one, &two, &three].into_iter().enumerate() {
        sound(seed as u64, solid);
    }
    // Inside out and back: a mesh in a union of itself is no more than itself.
    same(9, 3_000, &csg(Intersection, &ball, &csg(Union, &ball, &one)), &csg(Union, &ball, &ball));
}

#[test]
fn a_mesh_with_a_bite_looks_like_a_ball_with_a_bite() {
    let fine = csg(Difference, &Ball::object(1.0, 24), &sphere(0.6, 0.7));
    let exact = csg(Difference, &sphere(0.0, 1.0), &sphere(0.6, 0.7));
    let mut numbers = Numbers(4);
    let mut differ = 0;
    for _ in 0..2_000 {
        let ray = numbers.ray_at(Vec3A::ZERO, 0.9, 3.0);
        let (a, b) = (hits(&fine, &ray), hits(&exact, &ray));
        let near = |(a, b): (&(f32, bool), &(f32, bool))| {
            a.1 == b.1 && ray.dir().length() * (a.0 - b.0).abs() < 0.1
        };
        differ += usize::from(a.len() != b.len() || !a.iter().zip(&b).all(near));
    }
    // Along the rims of both they may.
    assert!(differ < 60, "seed 4: {differ}");
}

#[test]
fn rays_at_vertices_and_edges_of_a_mesh_stay_outside_of_what_they_pass() {
    let ball = Ball::object(1.0, 4);
    let all = csg(Union, &ball, &sphere(8.0, 1.0));
    let mut numbers = Numbers(5);
    for case in 0..4_000 {
        let (fall, turn) = ((case % 5) as f32, (case / 5 % 8) as f32);
        let [fall, turn] = [fall, turn].map(|x| x * std::f32::consts::FRAC_PI_4);
        let ring = libm::sinf(fall);
        let vertex = Vec3A::new(ring * libm::cosf(turn), ring * libm::sinf(turn), libm::cosf(fall));
        // Through a vertex, from nearly every side.
        let dir = numbers.vector(1.0).normalize();
        let ray = Ray::new(vertex - dir * 4.0, dir, RayKind::Camera);
        let found = hits(&all, &ray);
        assert!(found.len().is_multiple_of(2), "seed 5, case {case}: {found:?}");
        for (i, (_, enters)) in found.iter().enumerate() {
            assert_eq!(*enters, i % 2 == 0, "seed 5, case {case}: {found:?}");
        }
    }
}

#[test]
fn what_cuts_shows_its_surface_turned() {
    let solid = csg(Difference, &sphere(0.0, 1.0), &sphere(1.0, 0.5));
    let ray = Ray::new(Vec3A::new(5.0, 0.0, 0.0), Vec3A::NEG_X, RayKind::Camera);
    let mut hit = Hit::none(f32::INFINITY);
    assert!(solid.closest_hit(&ray, &mut hit, &mut Scratch::new()));
    assert_eq!((hit.t, hit.geometry, hit.primitive), (4.5, 7, 3));
    let surface = solid.surface(&ray, &hit).expect("its own hit");
    assert_eq!((surface.normal, surface.position), (Vec3A::X, Vec3A::X * 0.5));
    assert_eq!(solid.surface(&ray, &Hit { primitive: 4, ..hit }), None);
}

#[test]
fn a_plane_is_the_half_of_space_behind_it() {
    let below = single(Plane { point: Vec3A::ZERO, normal: Vec3A::Y });
    let dome = csg(Difference, &sphere(0.0, 1.0), &below);
    let bowl = csg(Intersection, &sphere(0.0, 1.0), &below);
    sound(6, &dome);
    sound(7, &bowl);
    assert_eq!(bowl.bounds().max.y, 1.0);
    // A ray that never meets the plane knows on which side it is.
    let level = |y: f32| Ray::new(Vec3A::new(-4.0, y, 0.0), Vec3A::X, RayKind::Camera);
    for (solid, y, count) in [(&dome, 0.5, 2), (&dome, -0.5, 0), (&bowl, 0.5, 0), (&bowl, -0.5, 2)]
    {
        assert_eq!(hits(solid, &level(y)).len(), count, "{y}");
    }
}

#[test]
fn a_ray_at_an_edge_of_a_block_is_not_inside_before_it() {
    // It enters and leaves the block at the same `t`, nowhere near the sphere.
    let min = Vec3A::new(0.16823988, 0.48326603, 0.59633446);
    let max = Vec3A::new(0.16948433, 0.5454885, 0.7207793);
    let thin = single(Block { extent: Aabb { min, max } });
    let ball = single(Sphere { center: Vec3A::new(0.125, 0.75, 0.125), radius: 0.125 });
    let origin = Vec3A::new(0.21732652, 0.76190054, 0.04052216);
    let dir = Vec3A::new(-0.049086645, -0.21641207, 0.68025714);
    let ray = Ray::new(origin, dir, RayKind::Camera);
    assert_eq!(hits(&thin, &ray).len(), 2);
    assert_eq!(hits(&csg(Intersection, &thin, &ball), &ray), []);
    // What is cut out of the ball is all of the block, or nothing.
    assert_eq!(hits(&csg(Difference, &ball, &thin), &ray), hits(&ball, &ray));
}
