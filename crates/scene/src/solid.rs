//! Solids made of solids, as a scene holds them [Roth 82].

mod closed;
mod shell;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::Affine3A;
use nestray_core::aabb::Aabb;
use nestray_core::instance::{Instance, Motion as _, Still};
use nestray_core::object::DynObject;
use nestray_shapes::any::AnyShape;
use nestray_shapes::csg::{Csg, Operation};
use nestray_shapes::shape::{Shape, Sides};
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};

pub use self::closed::SolidError;
pub use self::shell::Shell;

/// Two solids combined; see [`Csg`] for what comes of it. One primitive of one material.
#[derive(Clone, Debug)]
pub struct Solid {
    operation: Operation,
    operands: Box<[Operand; 2]>,
    depth: usize,
    bounds: Aabb,
}

/// One of the two, somewhere: a closed shape, a closed mesh, or a solid made of two again.
#[derive(Clone, Debug)]
pub struct Operand {
    part: Part,
    place: Affine3A,
    bounds: Aabb,
}

/// What an operand is. Made by [`Operand`], which has checked that it is closed.
#[derive(Clone, Debug)]
pub enum Part {
    /// A sphere, a torus, a block, a quadric that nothing cuts, or a plane for the half of
    /// space behind it.
    Shape(AnyShape),
    /// A mesh whose front is outside.
    Mesh(Arc<Triangles>),
    /// Two solids combined.
    Solid(Solid),
}

impl Solid {
    /// Most solids within each other: each takes room on the stack of a query.
    pub const DEEPEST: usize = 32;

    /// Combines two solids.
    ///
    /// # Errors
    /// [`SolidError::TooDeep`].
    pub fn new(operation: Operation, left: Operand, right: Operand) -> Result<Self, SolidError> {
        let depth = 1 + left.depth().max(right.depth());
        if depth > Self::DEEPEST {
            return Err(SolidError::TooDeep);
        }
        let bounds = operation.bounds(left.bounds, right.bounds);
        Ok(Self { operation, operands: Box::new([left, right]), depth, bounds })
    }

    /// What is kept of the two.
    #[must_use]
    pub fn operation(&self) -> Operation {
        self.operation
    }

    /// The two.
    #[must_use]
    pub fn operands(&self) -> &[Operand; 2] {
        &self.operands
    }

    /// A box around it; endless if it is.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// As an object whose hits are of this primitive of this geometry; `mesh` makes an object
    /// of each mesh in it.
    #[must_use]
    pub fn object(
        &self,
        [geometry, primitive]: [u32; 2],
        sides: Sides,
        mesh: &dyn Fn(TriangleMesh) -> DynObject,
    ) -> DynObject {
        let [left, right] = &*self.operands;
        let (left, right) = (left.object(mesh), right.object(mesh));
        Arc::new(Csg::new(geometry, primitive, self.operation, left, right).seen_from(sides))
    }
}

impl Operand {
    /// A shape.
    ///
    /// # Errors
    /// If it has no inside.
    pub fn shape(shape: impl Into<AnyShape>) -> Result<Self, SolidError> {
        let shape = shape.into();
        closed::check_shape(&shape)?;
        Ok(Self::here(Part::Shape(shape)))
    }

    /// A mesh.
    ///
    /// # Errors
    /// If it has no inside: at each edge as many faces must go one way as the other. If its
    /// front is inside.
    pub fn mesh(mesh: Arc<Triangles>) -> Result<Self, SolidError> {
        closed::check_mesh(&mesh)?;
        Ok(Self::here(Part::Mesh(mesh)))
    }

    /// The same, moved by `world_from_object` from where it is now.
    ///
    /// # Errors
    /// If that flattens it, or is not finite.
    pub fn placed(self, world_from_object: Affine3A) -> Result<Self, SolidError> {
        let place = world_from_object * self.place;
        let still = Still::new(place);
        if still.object_from_world(0.0).is_none() {
            return Err(SolidError::Place);
        }
        let bounds = still.sweep(self.part.bounds(), [0.0, 1.0]);
        let bounds = if bounds.is_empty() { Aabb::EMPTY } else { bounds.padded() };
        Ok(Self { part: self.part, place, bounds })
    }

    /// What it is.
    #[must_use]
    pub fn part(&self) -> &Part {
        &self.part
    }

    /// Where it is: `world_from_object`.
    #[must_use]
    pub fn place(&self) -> &Affine3A {
        &self.place
    }

    fn here(part: Part) -> Self {
        let bounds = part.bounds();
        Self { part, place: Affine3A::IDENTITY, bounds }
    }

    fn depth(&self) -> usize {
        match &self.part {
            Part::Solid(solid) => solid.depth,
            _ => 0,
        }
    }

    fn object(&self, mesh: &dyn Fn(TriangleMesh) -> DynObject) -> DynObject {
        let object = match &self.part {
            Part::Shape(shape) => shape.clone().into_object(0, 0, Sides::Both),
            Part::Mesh(triangles) => mesh(TriangleMesh::new(0, Arc::clone(triangles))),
            Part::Solid(solid) => solid.object([0, 0], Sides::Both, mesh),
        };
        if self.place == Affine3A::IDENTITY {
            return object;
        }
        Arc::new(Instance::new(1, object, self.place))
    }
}

impl Part {
    fn bounds(&self) -> Aabb {
        match self {
            Self::Shape(shape) => shape.bounds(),
            Self::Mesh(mesh) => {
                let bounds = (0..mesh.count()).map(|triangle| mesh.bounds(triangle));
                bounds.filter(|bounds| !bounds.is_empty()).fold(Aabb::EMPTY, Aabb::join)
            }
            Self::Solid(solid) => solid.bounds,
        }
    }
}

impl From<Solid> for Operand {
    fn from(solid: Solid) -> Self {
        Self::here(Part::Solid(solid))
    }
}
