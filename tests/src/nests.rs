//! Random nests, to any depth, and the same world as nested lists.

use std::sync::Arc;

use glam::{Affine3A, Vec3A};
use nestray_core::by_kind::{ByKind, Case};
use nestray_core::instance::Instance;
use nestray_core::lazy::Lazy;
use nestray_core::moving::{Keys, Moving};
use nestray_core::object::{DynObject, Object};
use nestray_registry::hybrid::{self, Filling};
use nestray_registry::{Entry, Members, TECHNIQUES, find};
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::{Sides, Single};
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use serde_json::Value;

use crate::numbers::Numbers;
use crate::shapes;
use crate::solids::{self, Solid};

/// A world, whatever nest it is put in.
#[derive(Debug)]
pub struct Spec {
    parts: Vec<Part>,
    /// Groups that may stand in many places.
    shared: Vec<Vec<Part>>,
}

#[derive(Debug)]
enum Part {
    Shapes(Vec<Single<AnyShape>>),
    Solid(u32, Solid),
    Mesh(u32, Arc<Triangles>),
    /// Several parts as one child.
    Group(Vec<Self>),
    /// A shared group, at one place or moving through several.
    Placed(Vec<Affine3A>, usize),
}

/// How a [`Spec`] is made into an object.
#[derive(Clone, Debug)]
pub enum Way {
    /// Lists, and nothing else: exhaustive search.
    Lists,
    /// Any technique anywhere, by these numbers; some parts by kind of ray, some lazy, some with
    /// leaves by other techniques.
    Nested(Numbers),
}

impl Spec {
    /// A world whose groups go `depth` deep.
    #[must_use]
    pub fn random(numbers: &mut Numbers, depth: usize) -> Self {
        let mut spec = Self { parts: Vec::new(), shared: Vec::new() };
        let mut geometry = 0;
        for level in 0..depth.saturating_sub(1) {
            // A shared group may hold those before it: no cycles.
            let parts = parts(numbers, &mut geometry, level, level, 3);
            spec.shared.push(parts);
        }
        spec.parts = parts(numbers, &mut geometry, depth - 1, spec.shared.len(), 6);
        spec
    }

    /// The object, and the corners of its children.
    #[must_use]
    pub fn realise(&self, way: &mut Way) -> (DynObject, Vec<Vec3A>) {
        let mut shared: Vec<DynObject> = Vec::new();
        for parts in &self.shared {
            let made = group(parts, &shared, way, &mut 1).0;
            shared.push(made);
        }
        let (object, children) = group(&self.parts, &shared, way, &mut 1);
        let mut numbers = Numbers::new(3);
        let aims = children.iter().flat_map(|child| solids::aims(child, &mut numbers)).collect();
        (object, aims)
    }
}

fn parts(
    numbers: &mut Numbers,
    geometry: &mut u32,
    depth: usize,
    shared: usize,
    most: usize,
) -> Vec<Part> {
    let count = 1 + numbers.below(most);
    (0..count).map(|_| part(numbers, geometry, depth, shared)).collect()
}

fn part(numbers: &mut Numbers, geometry: &mut u32, depth: usize, shared: usize) -> Part {
    *geometry += 1;
    match numbers.below(7) {
        0 if depth > 0 => Part::Group(parts(numbers, geometry, depth - 1, shared, 3)),
        1..4 if shared > 0 => {
            let keys = if numbers.once_in(4) { 2 } else { 1 };
            let places = (0..keys).map(|_| numbers.place(0.7)).collect();
            Part::Placed(places, numbers.below(shared))
        }
        4 => Part::Mesh(*geometry, Arc::new(triangles(numbers))),
        5 => {
            let depth = 1 + numbers.below(2);
            Part::Solid(*geometry, Solid::random(numbers, depth))
        }
        _ => {
            let count = 1 + numbers.below(8);
            Part::Shapes(some_shapes(numbers, *geometry, count))
        }
    }
}

/// Shapes of any kind; now and then one without end.
fn some_shapes(numbers: &mut Numbers, geometry: u32, count: usize) -> Vec<Single<AnyShape>> {
    let endless = numbers.once_in(12);
    (0..count as u32)
        .map(|primitive| {
            let shape = match endless && primitive == 0 {
                true => shapes::endless(numbers),
                false => shapes::bounded(numbers),
            };
            let sides = *numbers.pick(&[Sides::Both, Sides::Both, Sides::Front, Sides::Back]);
            Single { geometry, primitive, sides, shape }
        })
        .collect()
}

/// A strip on round numbers, or loose triangles.
fn triangles(numbers: &mut Numbers) -> Triangles {
    let count = 2 + numbers.below(12);
    if numbers.once_in(2) {
        let mut corners = || {
            let a = numbers.point();
            [a, a + numbers.direction() * 0.3, a + numbers.direction() * 0.3]
        };
        let corners: Vec<[Vec3A; 3]> = (0..count).map(|_| corners()).collect();
        return Triangles::from_corners(&corners);
    }
    let positions = (0..count + 2)
        .map(|i| [i as f32 / 16.0, (i % 2) as f32 / 2.0, numbers.below(3) as f32 / 4.0])
        .collect();
    let faces = (0..count as u32).map(|i| [i, i + 1, i + 2]).collect();
    Triangles::new(positions, faces).expect("indices in range")
}

/// The parts as one aggregate, and its children.
fn group(
    parts: &[Part],
    shared: &[DynObject],
    way: &mut Way,
    number: &mut u32,
) -> (DynObject, Vec<DynObject>) {
    let children: Vec<DynObject> =
        parts.iter().map(|part| object(part, shared, way, number)).collect();
    (aggregate(Members::Objects(children.clone()), way), children)
}

fn object(part: &Part, shared: &[DynObject], way: &mut Way, number: &mut u32) -> DynObject {
    match part {
        Part::Shapes(shapes) => aggregate(Members::Shapes(shapes.clone()), way),
        Part::Solid(geometry, solid) => {
            solid.object((*geometry, 0), &mut |members| aggregate(members, way))
        }
        Part::Mesh(geometry, triangles) => {
            aggregate(Members::Triangles(TriangleMesh::new(*geometry, Arc::clone(triangles))), way)
        }
        Part::Group(parts) => group(parts, shared, way, number).0,
        Part::Placed(places, which) => {
            let inside = Arc::clone(&shared[*which]);
            let first = *number;
            *number += inside.paths();
            match places[..] {
                [place] => Arc::new(Instance::new(first, inside, place)),
                _ => {
                    let keys = (0..).zip(places).map(|(k, &place)| (k as f32, place)).collect();
                    Arc::new(Moving::new(first, inside, Keys::new(keys).expect("times ascend")))
                }
            }
        }
    }
}

fn aggregate(members: Members, way: &mut Way) -> DynObject {
    let Way::Nested(numbers) = way else {
        return build(find("list").expect("there is a list"), members);
    };
    match numbers.below(8) {
        0 => {
            let cases = [Case::Camera, Case::Shadow(None), Case::Shadow(Some(3)), Case::Diffuse];
            let mut any = || build(numbers.pick(TECHNIQUES), members.clone());
            let other = any();
            Arc::new(ByKind::new(cases.map(|case| (case, any())).to_vec(), other))
        }
        1 => {
            let stand_in = build(find("list").expect("there is a list"), members.clone());
            let entry = *numbers.pick(TECHNIQUES);
            Arc::new(Lazy::new(stand_in, move || build(&entry, members.clone())))
        }
        2 => {
            let (entry, filling) = (*numbers.pick(TECHNIQUES), filling(numbers));
            let nest = hybrid::build(&entry, &Value::Null, Some(&filling), members);
            nest.expect("defaults are in range")
        }
        _ => build(numbers.pick(TECHNIQUES), members),
    }
}

/// Some technique for the leaves of another, however small these are.
fn filling(numbers: &mut Numbers) -> Filling {
    Filling {
        more_than: 1 + numbers.below(4),
        per_leaf: 1 + numbers.below(8) as u32,
        is_lazy: numbers.once_in(3),
        leaves: numbers.once_in(3).then(|| Box::new(filling(numbers))),
        ..Filling::new(numbers.pick(TECHNIQUES))
    }
}

fn build(entry: &Entry, members: Members) -> DynObject {
    (entry.build)(&Value::Null, members).expect("defaults are in range")
}
