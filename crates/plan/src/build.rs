//! From a plan and a scene to the objects.

mod rests;

use std::sync::Arc;

use nestray_core::by_kind::{ByKind, Case};
use nestray_core::instance::Instance;
use nestray_core::lazy::Lazy;
use nestray_core::moving::Moving;
use nestray_core::object::DynObject;
use nestray_registry::hybrid::{self, Filling};
use nestray_registry::{Entry, Members};
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::Motion;
use nestray_scene::scene::Scene;
use nestray_scene::solid::Solid;
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::Single;
use nestray_shapes::triangle_mesh::TriangleMesh;
use rayon::prelude::*;
use serde_json::Value;

use crate::check::{Resolved, Tree, filling, known, resolve};
use crate::error::PlanError;
use crate::fingerprint;
use crate::plan::{Nest, Plan};
use crate::single::AUTO;

/// The objects of a plan. Hits name geometries, primitives and instances as the scene counts
/// them, whatever the plan; the same plan and scene make the same objects.
///
/// Nodes of an animation stand where they are at its start: ask for a
/// [`frame`](Scene::frame) of the scene first.
///
/// # Errors
/// If the plan does not pass [`check`](crate::check::check).
pub fn build(plan: &Plan, scene: &Scene) -> Result<DynObject, PlanError> {
    Builder::new(plan).build(scene)
}

/// A nest over these members instead of its children; it must be sound.
pub(crate) fn over(nest: &Nest, members: Members) -> DynObject {
    let (entry, params) = (known(&nest.technique), Value::Object(nest.params.clone()));
    Order { entry, params, leaves: nest.leaves.as_deref().map(filling) }.build(members)
}

/// Builds the objects of a plan for one frame of a scene after the other. Shared subtrees in
/// which nothing moved since the frame before are kept.
#[expect(missing_debug_implementations, reason = "objects say what they are by other ways")]
pub struct Builder<'a> {
    plan: &'a Plan,
    /// The frame before, and its shared subtrees.
    before: Option<(Scene, Vec<DynObject>)>,
}

impl<'a> Builder<'a> {
    /// For this plan.
    #[must_use]
    pub fn new(plan: &'a Plan) -> Self {
        Self { plan, before: None }
    }

    /// The objects for a scene; see [`build()`].
    ///
    /// # Errors
    /// If the plan does not pass [`check`](crate::check::check).
    pub fn build(&mut self, scene: &Scene) -> Result<DynObject, PlanError> {
        let resolved = resolve(self.plan, scene)?;
        if self.before.is_none() {
            // Frames of one scene do not differ in it.
            fingerprint::check(self.plan, scene)?;
        }
        let rests = match &self.before {
            Some((before, _)) => rests::rests(before, scene),
            None => vec![false; scene.groups.len()],
        };
        let mut shared = Vec::with_capacity(resolved.subtrees.len());
        for (i, (group, tree)) in resolved.subtrees.iter().enumerate() {
            shared.push(match &self.before {
                Some((_, before)) if rests[*group] => Arc::clone(&before[i]),
                _ => recipe(tree, *group, scene, &resolved, &shared).object(),
            });
        }
        let root = recipe(&resolved.root, scene.root, scene, &resolved, &shared).object();
        self.before = Some((scene.clone(), shared));
        Ok(root)
    }
}

/// What is needed to build a part of a plan, and nothing else: a lazy part keeps one.
#[derive(Clone)]
enum Recipe {
    /// Geometries, side by side.
    Parts(Vec<Part>),
    /// A technique.
    Nest { order: Order, children: Vec<Self> },
    /// By kind; the last is `other`.
    ByKind(Vec<(Option<Case>, Self)>),
    /// Built late.
    Lazy(Arc<Self>),
}

/// How a nest is put in order.
#[derive(Clone)]
struct Order {
    entry: &'static Entry,
    params: Value,
    leaves: Option<Box<Filling>>,
}

/// What a nest finds among its children.
#[derive(Clone)]
enum Part {
    Mesh(TriangleMesh),
    Shape(Box<Single<AnyShape>>),
    Object(DynObject),
}

/// Looks up whatever a subtree names; `shared` are the subtrees built so far.
fn recipe(
    tree: &Tree<'_>,
    group: usize,
    scene: &Scene,
    resolved: &Resolved<'_>,
    shared: &[DynObject],
) -> Recipe {
    let inner = |tree: &Tree<'_>| recipe(tree, group, scene, resolved, shared);
    match tree {
        Tree::Pick(leaf) => {
            let parts = leaf.items.iter().flat_map(|&item| parts(item, &scene.geometries[item]));
            Recipe::Parts(parts.collect())
        }
        Tree::Place { leaf, subtrees, .. } => {
            let numbers = resolved.paths.numbers(group);
            let parts = leaf.items.iter().zip(subtrees).map(|(&place, &subtree)| {
                let motion = &scene.groups[group].places[place].motion;
                let object = Arc::clone(&shared[subtree]);
                Part::Object(placed(numbers[place], object, motion, scene))
            });
            Recipe::Parts(parts.collect())
        }
        Tree::Nest { entry, params, leaves, children } => Recipe::Nest {
            order: Order { entry, params: params.clone(), leaves: leaves.clone() },
            children: children.iter().map(inner).collect(),
        },
        Tree::ByKind { cases, .. } => {
            Recipe::ByKind(cases.iter().map(|(case, tree)| (*case, inner(tree))).collect())
        }
        Tree::Lazy(tree) => Recipe::Lazy(Arc::new(inner(tree))),
    }
}

/// The primitives of a geometry: a mesh as a whole, shapes and solids one by one.
fn parts(number: usize, geometry: &Geometry) -> Vec<Part> {
    let (id, sides) = (number as u32, geometry.sides);
    match &geometry.content {
        Content::Mesh(triangles) => {
            vec![Part::Mesh(TriangleMesh::new(id, Arc::clone(triangles)).seen_from(sides))]
        }
        Content::Shapes(shapes) => {
            let single = |(primitive, shape): (u32, &AnyShape)| {
                let shape = shape.clone();
                Part::Shape(Box::new(Single { geometry: id, primitive, sides, shape }))
            };
            (0..).zip(shapes.iter()).map(single).collect()
        }
        Content::Solids(solids) => {
            let object = |(primitive, solid): (u32, &Solid)| {
                Part::Object(solid.object([id, primitive], sides, &operand))
            };
            (0..).zip(solids.iter()).map(object).collect()
        }
    }
}

/// A mesh within a solid, which is asked for all hits and has to answer wherever it stands.
fn operand(mesh: TriangleMesh) -> DynObject {
    let small = mesh.triangles().count() <= Nest::TINY;
    let order = if small { Order::list() } else { Order::by(AUTO) };
    order.build(Members::Triangles(mesh))
}

fn placed(number: u32, object: DynObject, motion: &Motion, scene: &Scene) -> DynObject {
    match motion {
        Motion::Still(place) => Arc::new(Instance::new(number, object, *place)),
        Motion::Keys(keys) => Arc::new(Moving::new(number, object, keys.clone())),
        Motion::Node(node) => {
            let place = scene.animation.world_from_node(*node, 0.0);
            Arc::new(Instance::new(number, object, place))
        }
    }
}

impl Recipe {
    /// As one object.
    fn object(&self) -> DynObject {
        let mut parts = self.parts();
        match &parts[..] {
            [Part::Object(_)] => match parts.pop() {
                Some(Part::Object(object)) => object,
                _ => unreachable!("it is one object"),
            },
            _ => aggregate(&Order::list(), parts),
        }
    }

    /// As what a nest around it finds.
    fn parts(&self) -> Vec<Part> {
        match self {
            Self::Parts(parts) => parts.clone(),
            Self::Nest { order, children } => {
                let parts = children.iter().flat_map(Self::parts).collect();
                vec![Part::Object(aggregate(order, parts))]
            }
            Self::ByKind(cases) => {
                let mut cases: Vec<_> =
                    cases.iter().map(|(case, recipe)| (*case, recipe.object())).collect();
                let (_, other) = cases.pop().expect("there always is an `other`");
                let cases = cases.into_iter().filter_map(|(case, object)| Some((case?, object)));
                vec![Part::Object(Arc::new(ByKind::new(cases.collect(), other)))]
            }
            Self::Lazy(inner) => {
                let mut flat = Vec::new();
                inner.flatten(&mut flat);
                let stand_in = aggregate(&Order::list(), flat);
                let inner = Arc::clone(inner);
                vec![Part::Object(Arc::new(Lazy::new(stand_in, move || inner.object())))]
            }
        }
    }

    /// Everything in it, in no order: what any of its structures holds.
    fn flatten(&self, parts: &mut Vec<Part>) {
        match self {
            Self::Parts(own) => parts.extend(own.iter().cloned()),
            Self::Nest { children, .. } => {
                for child in children {
                    child.flatten(parts);
                }
            }
            Self::ByKind(cases) => {
                if let Some((_, other)) = cases.last() {
                    other.flatten(parts);
                }
            }
            Self::Lazy(inner) => inner.flatten(parts),
        }
    }
}

impl Order {
    /// A technique with its defaults.
    fn by(technique: &str) -> Self {
        Self { entry: known(technique), params: Value::Null, leaves: None }
    }

    fn list() -> Self {
        Self::by("list")
    }

    fn build(&self, members: Members) -> DynObject {
        hybrid::build(self.entry, &self.params, self.leaves.as_deref(), members)
            .expect("the settings have been checked")
    }
}

/// A technique over parts, in the fastest form there is for them; see [`Nest`].
fn aggregate(order: &Order, parts: Vec<Part>) -> DynObject {
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
    let object = |part| match part {
        Part::Object(object) => object,
        Part::Shape(single) => {
            single.shape.into_object(single.geometry, single.primitive, single.sides)
        }
        Part::Mesh(mesh) if mesh.triangles().count() <= Nest::TINY => {
            Order::list().build(Members::Triangles(mesh))
        }
        Part::Mesh(mesh) => order.build(Members::Triangles(mesh)),
    };
    // One thread each; in order, and so always the same.
    let objects = parts.into_par_iter().map(object).collect();
    order.build(Members::Objects(objects))
}

#[cfg(test)]
mod hybrids;
#[cfg(test)]
mod tests;
