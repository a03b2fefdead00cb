//! What is to be built, with everything looked up.

use std::sync::Arc;

use nestray_core::by_kind::{ByKind, Case};
use nestray_core::instance::Instance;
use nestray_core::lazy::Lazy;
use nestray_core::moving::Moving;
use nestray_core::object::DynObject;
use nestray_registry::Members;
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::Motion;
use nestray_scene::scene::Scene;
use nestray_scene::solid::Solid;
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::Single;
use nestray_shapes::triangle_mesh::TriangleMesh;

use super::fences;
use super::order::{Order, Part, Placed, Whole, aggregate};
use crate::check::{Resolved, Tree};
use crate::plan::{Bounds, Nest};
use crate::single::AUTO;

/// What is needed to build a part of a plan, and nothing else: a lazy part keeps one.
#[derive(Clone)]
pub(super) enum Recipe {
    /// Geometries, side by side.
    Parts(Vec<Part>),
    /// A technique.
    Nest { order: Box<Order>, children: Vec<Self> },
    /// By kind; the last is `other`.
    ByKind(Vec<(Option<Case>, Self)>),
    /// Built late.
    Lazy(Arc<Self>),
    /// Each part behind a fence.
    Fence(Bounds, Box<Self>),
}

/// Looks up whatever a subtree names; `shared` are the subtrees built so far.
pub(super) fn recipe(
    tree: &Tree<'_>,
    group: usize,
    scene: &Scene,
    resolved: &Resolved<'_>,
    shared: &[Whole],
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
                placed(numbers[place], &shared[subtree], motion, scene)
            });
            Recipe::Parts(parts.collect())
        }
        Tree::Nest { order, children } => {
            Recipe::Nest { order: order.clone(), children: children.iter().map(inner).collect() }
        }
        Tree::ByKind { cases, .. } => {
            Recipe::ByKind(cases.iter().map(|(case, tree)| (*case, inner(tree))).collect())
        }
        Tree::Lazy(tree) => Recipe::Lazy(Arc::new(inner(tree))),
        Tree::Fence(by, tree) => Recipe::Fence(*by, Box::new(inner(tree))),
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
    let small = mesh.count() <= Nest::TINY;
    let order = if small { Order::list() } else { Order::by(AUTO) };
    order.build(Members::Triangles(mesh)).object
}

fn placed(number: u32, whole: &Whole, motion: &Motion, scene: &Scene) -> Part {
    let object = Arc::clone(&whole.object);
    let place = match motion {
        Motion::Keys(keys) => {
            return Part::Object(Arc::new(Moving::new(number, object, keys.clone())));
        }
        Motion::Still(place) => *place,
        Motion::Node(node) => scene.animation.world_from_node(*node, 0.0),
    };
    let instance = Arc::new(Instance::new(number, object, place));
    Part::Placed(Placed { instance, parts: whole.parts.clone() })
}

impl Recipe {
    /// As one object.
    pub(super) fn whole(&self) -> Whole {
        match self {
            Self::Nest { order, children } => {
                let parts = children.iter().flat_map(Self::parts).collect();
                aggregate(order, parts)
            }
            _ => match &self.parts()[..] {
                [Part::Object(object)] => Whole::from(Arc::clone(object)),
                parts => aggregate(&Order::list(), parts.to_vec()),
            },
        }
    }

    /// As what a nest around it finds.
    fn parts(&self) -> Vec<Part> {
        match self {
            Self::Parts(parts) => parts.clone(),
            Self::Nest { .. } => vec![Part::Object(self.whole().object)],
            Self::ByKind(cases) => {
                let mut cases: Vec<_> =
                    cases.iter().map(|(case, recipe)| (*case, recipe.whole().object)).collect();
                let (_, other) = cases.pop().expect("there always is an `other`");
                let cases = cases.into_iter().filter_map(|(case, object)| Some((case?, object)));
                vec![Part::Object(Arc::new(ByKind::new(cases.collect(), other)))]
            }
            Self::Lazy(inner) => {
                let mut flat = Vec::new();
                inner.flatten(&mut flat);
                let stand_in = aggregate(&Order::list(), flat).object;
                let inner = Arc::clone(inner);
                vec![Part::Object(Arc::new(Lazy::new(stand_in, move || inner.whole().object)))]
            }
            Self::Fence(by, inner) => fences::around(*by, inner.parts()),
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
            Self::Fence(_, inner) => inner.flatten(parts),
        }
    }
}
