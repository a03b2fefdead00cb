//! Techniques over whatever stands in a nest.

use std::sync::Arc;

use nestray_core::instance::Instance;
use nestray_core::object::DynObject;
use nestray_core::opened::NearFar;
use nestray_registry::hybrid::{self, Filling};
use nestray_registry::{Entry, Members};
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::Single;
use nestray_shapes::triangle_mesh::TriangleMesh;
use rayon::prelude::*;
use serde_json::Value;

use super::open;
use crate::check::known;
use crate::plan::Nest;

/// How a nest is put in order.
#[derive(Clone, Debug)]
pub(crate) struct Order {
    pub(crate) entry: &'static Entry,
    pub(crate) params: Value,
    pub(crate) leaves: Option<Box<Filling>>,
    /// See [`Nest::open`].
    pub(crate) open: f32,
}

/// An object, and those that it orders, if it does.
#[derive(Clone)]
pub(super) struct Whole {
    pub(super) object: DynObject,
    pub(super) parts: Arc<[DynObject]>,
}

impl From<DynObject> for Whole {
    fn from(object: DynObject) -> Self {
        Self { object, parts: Arc::new([]) }
    }
}

/// A shared subtree somewhere.
#[derive(Clone)]
pub(super) struct Placed {
    pub(super) instance: Arc<Instance<DynObject>>,
    /// What it orders.
    pub(super) parts: Arc<[DynObject]>,
}

/// What a nest finds among its children.
#[derive(Clone)]
pub(super) enum Part {
    Mesh(TriangleMesh),
    Shape(Box<Single<AnyShape>>),
    Object(DynObject),
    Placed(Placed),
}

impl Order {
    /// A technique with its defaults.
    pub(super) fn by(technique: &str) -> Self {
        Self { entry: known(technique), params: Value::Null, leaves: None, open: 0.0 }
    }

    pub(super) fn list() -> Self {
        Self::by("list")
    }

    pub(super) fn build(&self, members: Members) -> Whole {
        let built = hybrid::with_parts(self.entry, &self.params, self.leaves.as_deref(), members);
        let (object, parts) = built.expect("the settings have been checked");
        Whole { object, parts: parts.into() }
    }
}

/// A technique over parts, in the fastest form there is for them; see [`Nest`].
pub(super) fn aggregate(order: &Order, parts: Vec<Part>) -> Whole {
    let parts = joined(parts);
    let shapes = parts.iter().all(|part| matches!(part, Part::Shape(_)));
    if let [Part::Mesh(mesh)] = &parts[..] {
        return order.build(Members::Triangles(mesh.clone()));
    }
    if shapes && !parts.is_empty() {
        let shapes = parts.into_iter().filter_map(|part| match part {
            Part::Shape(shape) => Some(*shape),
            _ => None,
        });
        return order.build(Members::Shapes(shapes.collect()));
    }
    let placed: Vec<_> = parts
        .iter()
        .map(|part| match part {
            Part::Placed(placed) => Some(placed.clone()),
            _ => None,
        })
        .collect();
    let object = |part| match part {
        Part::Object(object) => object,
        Part::Placed(placed) => placed.instance,
        Part::Shape(single) => {
            single.shape.into_object(single.geometry, single.primitive, single.sides)
        }
        Part::Mesh(mesh) if mesh.count() <= Nest::TINY => {
            Order::list().build(Members::Triangles(mesh)).object
        }
        Part::Mesh(mesh) => order.build(Members::Triangles(mesh)).object,
    };
    // One thread each; in order, and so always the same.
    let objects: Vec<DynObject> = parts.into_par_iter().map(object).collect();
    match open::opened(order.open, &objects, &placed) {
        Some((opened, reach)) => {
            let near = order.build(Members::Objects(opened)).object;
            let far = order.build(Members::Objects(objects));
            Whole { object: Arc::new(NearFar::new(near, far.object, reach)), ..far }
        }
        None => order.build(Members::Objects(objects)),
    }
}

/// The same parts with all meshes as one that are seen from the same sides, where the first of
/// them stood, unless there are too many triangles for one.
fn joined(parts: Vec<Part>) -> Vec<Part> {
    let mut joined = Vec::with_capacity(parts.len());
    let mut meshes: Vec<(usize, Vec<TriangleMesh>)> = Vec::new();
    for part in parts {
        let Part::Mesh(mesh) = part else {
            joined.push(part);
            continue;
        };
        match meshes.iter_mut().find(|(_, alike)| alike[0].sides() == mesh.sides()) {
            Some((_, alike)) => alike.push(mesh),
            None => {
                meshes.push((joined.len(), vec![mesh.clone()]));
                joined.push(Part::Mesh(mesh));
            }
        }
    }
    for (place, alike) in meshes {
        match TriangleMesh::joined(&alike) {
            Some(mesh) => joined[place] = Part::Mesh(mesh),
            None => joined.extend(alike.into_iter().skip(1).map(Part::Mesh)),
        }
    }
    joined
}
