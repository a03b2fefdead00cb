//! Random solids made of solids, in any nest.

use std::sync::Arc;

use glam::{Affine3A, Vec3A};
use nestray_core::instance::Instance;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_registry::Members;
use nestray_shapes::any::AnyShape;
use nestray_shapes::csg::{Csg, Operation};
use nestray_shapes::shape::Single;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};

use crate::numbers::Numbers;
use crate::shapes;

/// How the parts of a solid are combined.
#[derive(Clone, Debug)]
pub enum Solid {
    /// Closed shapes side by side.
    Shapes(Vec<Single<AnyShape>>),
    /// A closed mesh.
    Mesh(Arc<Triangles>),
    /// Another solid, somewhere else.
    Placed(Box<Self>, Affine3A),
    /// Two solids.
    Pair(Operation, Box<[Self; 2]>),
}

impl Solid {
    /// A pair of solids, in which pairs go `depth` deep.
    #[must_use]
    pub fn random(numbers: &mut Numbers, depth: usize) -> Self {
        let operation = *numbers.pick(&[
            Operation::Union,
            Operation::Intersection,
            Operation::Difference,
            Operation::Difference,
        ]);
        let part = |numbers: &mut Numbers| operand(numbers, depth.saturating_sub(1));
        Self::Pair(operation, Box::new([part(numbers), part(numbers)]))
    }

    /// The solid as a primitive; `aggregate` nests the parts of its parts.
    pub fn object(
        &self,
        (geometry, primitive): (u32, u32),
        aggregate: &mut dyn FnMut(Members) -> DynObject,
    ) -> DynObject {
        match self {
            Self::Shapes(shapes) => aggregate(Members::Shapes(shapes.clone())),
            Self::Mesh(triangles) => {
                aggregate(Members::Triangles(TriangleMesh::new(geometry, Arc::clone(triangles))))
            }
            Self::Placed(solid, place) => {
                let inside = solid.object((geometry, primitive), aggregate);
                Arc::new(Instance::new(1, inside, *place))
            }
            Self::Pair(operation, parts) => {
                let [left, right] =
                    [0, 1].map(|i| parts[i].object((geometry, primitive), aggregate));
                Arc::new(Csg::new(geometry, primitive, *operation, left, right))
            }
        }
    }
}

fn operand(numbers: &mut Numbers, depth: usize) -> Solid {
    match numbers.below(6) {
        0 | 1 if depth > 0 => Solid::random(numbers, depth),
        2 if depth > 0 => {
            // Between the unit cube and a smaller one.
            let solid = operand(numbers, depth - 1);
            Solid::Placed(Box::new(solid), numbers.place(0.8))
        }
        3 => Solid::Mesh(Arc::new(octahedron(numbers))),
        _ => {
            let count = 1 + numbers.below(3) as u32;
            let single =
                |primitive| Single { primitive, ..Single::new(0, shapes::closed(numbers)) };
            Solid::Shapes((0..count).map(single).collect())
        }
    }
}

fn octahedron(numbers: &mut Numbers) -> Triangles {
    let (center, size) = (numbers.point(), numbers.between(0.1, 0.4));
    let corner = |axis: usize, way: f32| (center + Vec3A::AXES[axis] * (size * way)).to_array();
    let positions = (0..3).flat_map(|axis| [corner(axis, 1.0), corner(axis, -1.0)]).collect();
    let face = |i: u32| {
        let [x, y, z] = [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2 & 1)];
        // An odd number of mirrors turns a face over.
        if i.count_ones().is_multiple_of(2) { [x, y, z] } else { [x, z, y] }
    };
    Triangles::new(positions, (0..8).map(face).collect()).expect("indices in range")
}

/// Points worth aiming at: of the box, and where random lines cross the surface.
#[must_use]
pub fn aims(object: &dyn Object, numbers: &mut Numbers) -> Vec<Vec3A> {
    let bounds = object.bounds();
    if bounds.is_empty() || !bounds.is_bounded() {
        return Vec::new();
    }
    let mut aims: Vec<Vec3A> = (0..8).map(|i| bounds.corner(i)).chain([bounds.center()]).collect();
    for _ in 0..12 {
        let target = bounds.min + bounds.size() * numbers.point();
        let origin = target - numbers.direction() * bounds.size().length();
        let ray = Ray::new(origin, target - origin, RayKind::Camera);
        let mut hits = Vec::new();
        object.all_hits(&ray, &mut hits, &mut Scratch::new());
        aims.extend(hits.iter().map(|hit| ray.at(hit.t)));
    }
    aims
}
