//! What stands in an aggregate, as it is told to the list of techniques.

use std::fmt;
use std::sync::Arc;

use nestray_core::accel::{Division, divide};
use nestray_core::family::Family;
use nestray_core::object::DynObject;
use nestray_core::one_by_one::OneByOne;
use nestray_core::technique::{Leaves, Technique};
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::Single;
use nestray_shapes::triangle_mesh::TriangleMesh;

/// What a leaf of a plan holds: each case gets its own fast inner loop.
#[derive(Clone)]
pub enum Members {
    /// Anything; one virtual call per child.
    Objects(Vec<DynObject>),
    /// Single shapes, each made an object as small as it is.
    Shapes(Vec<Single<AnyShape>>),
    /// Triangles, packed; none. Connected meshes and loose triangles are laid out differently.
    Triangles(TriangleMesh),
}

impl fmt::Debug for Members {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Objects(objects) => write!(f, "{} objects", objects.len()),
            Self::Shapes(shapes) => write!(f, "{} shapes", shapes.len()),
            Self::Triangles(mesh) => mesh.fmt(f),
        }
    }
}

impl Members {
    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        match self {
            Self::Objects(objects) => objects.len(),
            Self::Shapes(shapes) => shapes.len(),
            Self::Triangles(mesh) => mesh.count() as usize,
        }
    }

    /// Some of them, by number.
    ///
    /// # Panics
    /// If there are not so many.
    #[must_use]
    pub fn part(&self, children: &[u32]) -> Self {
        let all = children.iter().map(|&child| child as usize);
        match self {
            Self::Objects(objects) => Self::Objects(all.map(|i| Arc::clone(&objects[i])).collect()),
            Self::Shapes(shapes) => Self::Shapes(all.map(|i| shapes[i].clone()).collect()),
            Self::Triangles(mesh) => Self::Triangles(mesh.part(children)),
        }
    }

    /// The leaves that `build` makes of them; see [`divide`].
    pub(crate) fn divide(
        &self,
        per_leaf: u32,
        build: &dyn Fn(&dyn Family, &mut Leaves),
    ) -> Division {
        match self {
            Self::Objects(objects) => divide(objects.clone(), per_leaf, build),
            Self::Shapes(shapes) => divide(objects(shapes.clone()), per_leaf, build),
            Self::Triangles(mesh) => divide(mesh.clone(), per_leaf, build),
        }
    }

    /// The same with an object for each shape, so that copies share it.
    pub(crate) fn shared(self) -> Self {
        match self {
            Self::Shapes(shapes) => Self::Objects(objects(shapes)),
            other => other,
        }
    }

    /// All in one object, in no order.
    pub(crate) fn one_by_one(&self) -> DynObject {
        match self {
            Self::Objects(objects) => Arc::new(OneByOne::new(objects.clone())),
            Self::Shapes(shapes) => Arc::new(OneByOne::new(objects(shapes.clone()))),
            Self::Triangles(mesh) => Arc::new(OneByOne::new(mesh.clone())),
        }
    }
}

/// Whether triangles are packed without shared vertices: because they share few, or because
/// there are so many that the shared layout could run out of names for its blocks.
pub(crate) fn are_loose<T: Technique>(mesh: &TriangleMesh) -> bool {
    let most = 4_000_000 / T::COPIES;
    mesh.is_soup() || mesh.count() as usize > most
}

/// An object for each shape.
pub(crate) fn objects(shapes: Vec<Single<AnyShape>>) -> Vec<DynObject> {
    let object = |single: Single<AnyShape>| {
        single.shape.into_object(single.geometry, single.primitive, single.sides)
    };
    shapes.into_iter().map(object).collect()
}
