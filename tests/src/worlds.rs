//! Worlds to ask about: the children, and points worth aiming at.

use std::sync::Arc;

use glam::{Affine3A, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_core::instance::Instance;
use nestray_core::moving::{Keys, Moving};
use nestray_core::object::{DynObject, Object};
use nestray_registry::{Members, find};
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::{Sides, Single};
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use serde_json::Value;

use crate::numbers::Numbers;
use crate::shapes;
use crate::solids::{self, Solid};

/// Children for an aggregate.
#[derive(Debug)]
pub struct World {
    /// What it is.
    pub name: &'static str,
    /// The children.
    pub members: Members,
    /// Points worth aiming at.
    pub aims: Vec<Vec3A>,
}

impl World {
    /// Exhaustive search.
    #[must_use]
    pub fn oracle(&self) -> DynObject {
        list(self.members.clone())
    }

    /// A box around what is bounded, not empty.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        let bounded = self.aims.iter().fold(Aabb::EMPTY, |all, &aim| all.with(aim));
        if bounded.is_empty() { Aabb { min: Vec3A::ZERO, max: Vec3A::ONE } } else { bounded }
    }
}

/// One world of each family, from a seed.
#[must_use]
pub fn families(seed: u64) -> Vec<World> {
    let mut numbers = Numbers::new(seed);
    vec![
        objects(&mut numbers, 60),
        side_by_side(&mut numbers, 84),
        connected(&mut numbers, 8),
        soup(&mut numbers, 120),
        together(&mut numbers, 40),
        instances(&mut numbers, 24),
        moving(&mut numbers, 24),
        unbounded(&mut numbers, 40),
        repeated(&mut numbers, 30),
        solids(&mut numbers, 12),
    ]
}

/// Worlds of many children.
#[must_use]
pub fn crowds(seed: u64) -> Vec<World> {
    let mut numbers = Numbers::new(seed);
    vec![
        side_by_side(&mut numbers, 900),
        connected(&mut numbers, 45),
        soup(&mut numbers, 3_000),
        instances(&mut numbers, 300),
    ]
}

fn corners(bounds: Aabb) -> impl Iterator<Item = Vec3A> {
    (0..8).map(move |i| bounds.corner(i)).chain([bounds.center()])
}

fn aims_at(shapes: &[Single<AnyShape>], numbers: &mut Numbers) -> Vec<Vec3A> {
    shapes.iter().flat_map(|single| shapes::aims(&single.shape, numbers)).collect()
}

fn object(single: Single<AnyShape>) -> DynObject {
    single.shape.into_object(single.geometry, single.primitive, single.sides)
}

/// Single shapes behind pointers.
fn objects(numbers: &mut Numbers, count: usize) -> World {
    let shapes = shapes::mixed(numbers, count, 0);
    let aims = aims_at(&shapes, numbers);
    let objects = shapes.into_iter().map(|shape| Arc::new(shape) as DynObject).collect();
    World { name: "objects", members: Members::Objects(objects), aims }
}

/// Single shapes side by side.
fn side_by_side(numbers: &mut Numbers, count: usize) -> World {
    let shapes = shapes::mixed(numbers, count, 5);
    let aims = aims_at(&shapes, numbers);
    World { name: "shapes", members: Members::Shapes(shapes), aims }
}

/// Solids made of solids.
fn solids(numbers: &mut Numbers, count: u32) -> World {
    let depth = 1 + numbers.below(3);
    let objects: Vec<DynObject> =
        (0..count).map(|i| Solid::random(numbers, depth).object((9, i), &mut list)).collect();
    let aims = objects.iter().flat_map(|object| solids::aims(object, numbers)).collect();
    World { name: "solids", members: Members::Objects(objects), aims }
}

/// A landscape of connected triangles, its vertices on round numbers.
fn connected(numbers: &mut Numbers, n: usize) -> World {
    let at = |i: usize| i as f32 / n as f32;
    let mut positions = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            positions.push([at(i), at(j), numbers.below(6) as f32 / 16.0]);
        }
    }
    let vertex = |i: usize, j: usize| (j * (n + 1) + i) as u32;
    let faces = (0..n * n)
        .flat_map(|cell| {
            let (i, j) = (cell % n, cell / n);
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i, j + 1), vertex(i + 1, j + 1)];
            [[a, b, c], [b, d, c]]
        })
        .collect();
    mesh(
        "connected triangles",
        Triangles::new(positions, faces).expect("indices in range"),
        Sides::Both,
    )
}

/// Triangles of their own, some flat, some slivers, some of no area at all.
fn soup(numbers: &mut Numbers, count: usize) -> World {
    let corners: Vec<[Vec3A; 3]> = (0..count)
        .map(|_| {
            let a = numbers.point();
            let (mut b, mut c) = (numbers.direction() * 0.2, numbers.direction() * 0.2);
            match numbers.below(10) {
                0 => (b.z, c.z) = (0.0, 0.0),
                1 => (b.x, c.x) = (0.0, 0.0),
                2 => c = b * 0.5,
                3 => c = b * 0.999 + c * 1e-4,
                4 => (b, c) = (b * 4.0, c * 4.0),
                _ => {}
            }
            [a, a + b, a + c]
        })
        .collect();
    let sides = *numbers.pick(&[Sides::Both, Sides::Front, Sides::Back]);
    mesh("loose triangles", Triangles::from_corners(&corners), sides)
}

/// Several meshes as one, with some triangles in two of them.
fn together(numbers: &mut Numbers, count: usize) -> World {
    let corners: Vec<[Vec3A; 3]> = (0..3 * count)
        .map(|_| {
            let a = numbers.point();
            [a, a + numbers.direction() * 0.2, a + numbers.direction() * 0.2]
        })
        .collect();
    let parts = [(7, 0..2 * count), (3, count..2 * count), (11, count / 2..3 * count)];
    let meshes = parts.map(|(geometry, part)| {
        TriangleMesh::new(geometry, Arc::new(Triangles::from_corners(&corners[part])))
    });
    let mesh = TriangleMesh::joined(&meshes).expect("all are seen from both sides");
    let aims = corners.iter().flat_map(|&[a, b, c]| [a, (a + b) * 0.5, (a + b + c) / 3.0]);
    World { name: "meshes together", members: Members::Triangles(mesh), aims: aims.collect() }
}

fn mesh(name: &'static str, triangles: Triangles, sides: Sides) -> World {
    let mut aims: Vec<Vec3A> =
        triangles.positions().iter().map(|&p| Vec3A::from_array(p)).collect();
    for triangle in 0..triangles.count() {
        let [a, b, c] = triangles.corners(triangle).map(Vec3A::from_array);
        aims.extend([(a + b) * 0.5, (b + c) * 0.5, a * 0.75 + c * 0.25]);
    }
    let mesh = TriangleMesh::new(2, Arc::new(triangles)).seen_from(sides);
    World { name, members: Members::Triangles(mesh), aims }
}

fn shared_inside(numbers: &mut Numbers) -> DynObject {
    match numbers.below(4) {
        0 | 1 => list(Members::Shapes(shapes::mixed(numbers, 14, 1))),
        2 => list(solids(numbers, 3).members),
        _ => list(connected(numbers, 3).members),
    }
}

/// Exhaustive search.
fn list(members: Members) -> DynObject {
    let entry = find("list").expect("there is a list");
    (entry.build)(&Value::Null, members).expect("it has no settings")
}

/// A few objects in many places, some of them the same.
fn instances(numbers: &mut Numbers, count: usize) -> World {
    let inside = [shared_inside(numbers), shared_inside(numbers)];
    let mut places: Vec<Affine3A> = (0..count).map(|_| numbers.place(0.4)).collect();
    places[1] = places[0];
    let objects: Vec<DynObject> = (1..)
        .zip(places)
        .map(|(number, place)| {
            Arc::new(Instance::new(number, Arc::clone(numbers.pick(&inside)), place)) as DynObject
        })
        .collect();
    placed("instances", objects)
}

/// The same, moving on straight and bent ways.
fn moving(numbers: &mut Numbers, count: usize) -> World {
    let inside = shared_inside(numbers);
    let objects = (0..count as u32)
        .map(|i| {
            let keys = 1 + numbers.below(3);
            let place = |k: usize, numbers: &mut Numbers| (k as f32 * 0.4, numbers.place(0.3));
            let keys = (0..keys).map(|k| place(k, numbers)).collect();
            let keys = Keys::new(keys).expect("times ascend");
            Arc::new(Moving::new(i + 1, Arc::clone(&inside), keys)) as DynObject
        })
        .collect();
    placed("moving", objects)
}

fn placed(name: &'static str, objects: Vec<DynObject>) -> World {
    let aims = objects.iter().flat_map(|object| corners(object.bounds())).collect();
    World { name, members: Members::Objects(objects), aims }
}

/// Some that no box can hold among some that one can, also in another space.
fn unbounded(numbers: &mut Numbers, count: usize) -> World {
    let mut shapes = shapes::mixed(numbers, count, 0);
    for (primitive, single) in (0..).zip(&mut shapes).step_by(10) {
        *single = Single { primitive, ..Single::new(10, shapes::endless(numbers)) };
    }
    let aims = aims_at(&shapes, numbers);
    let mut objects: Vec<DynObject> = shapes.into_iter().map(object).collect();
    let inside =
        vec![Single::new(11, shapes::endless(numbers)), Single::new(12, shapes::bounded(numbers))];
    let inside = list(Members::Shapes(inside));
    objects.push(Arc::new(Instance::new(1, inside, numbers.place(1.0))));
    World { name: "unbounded", members: Members::Objects(objects), aims }
}

/// All in the same place, or several times the same.
fn repeated(numbers: &mut Numbers, count: usize) -> World {
    let one = Single::new(0, shapes::bounded(numbers));
    let shapes: Vec<Single<AnyShape>> =
        (0..count).map(|i| Single { primitive: (i / 2) as u32, ..one.clone() }).collect();
    let aims = aims_at(&shapes[..1], numbers);
    World { name: "repeated", members: Members::Shapes(shapes), aims }
}
