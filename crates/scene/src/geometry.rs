//! Shapes with a name and a material.

use std::sync::Arc;

use nestray_core::aabb::Aabb;
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::{Shape, Sides};
use nestray_shapes::triangle_mesh::Triangles;

use crate::solid::Solid;

/// A set of primitives of one material. Hits count geometries in file order, and primitives
/// within each.
#[derive(Clone, Debug)]
pub struct Geometry {
    /// What it is called; may be empty.
    pub name: String,
    /// Its material.
    pub material: usize,
    /// Which sides can be seen.
    pub sides: Sides,
    /// The primitives.
    pub content: Content,
}

/// The primitives of a geometry; shared by all that use them.
#[derive(Clone, Debug)]
pub enum Content {
    /// Triangles.
    Mesh(Arc<Triangles>),
    /// Single shapes.
    Shapes(Arc<Vec<AnyShape>>),
    /// Solids made of solids. Where they glow, they are lights that only scattered rays find,
    /// as are shapes whose emission has a texture.
    Solids(Arc<Vec<Solid>>),
}

impl Geometry {
    /// A mesh, seen from both sides.
    #[must_use]
    pub fn mesh(name: impl Into<String>, material: usize, triangles: Triangles) -> Self {
        let content = Content::Mesh(Arc::new(triangles));
        Self { name: name.into(), material, sides: Sides::Both, content }
    }

    /// Single shapes, seen from both sides.
    #[must_use]
    pub fn shapes(name: impl Into<String>, material: usize, shapes: Vec<AnyShape>) -> Self {
        let content = Content::Shapes(Arc::new(shapes));
        Self { name: name.into(), material, sides: Sides::Both, content }
    }

    /// Solids made of solids, seen from both sides.
    #[must_use]
    pub fn solids(name: impl Into<String>, material: usize, solids: Vec<Solid>) -> Self {
        let content = Content::Solids(Arc::new(solids));
        Self { name: name.into(), material, sides: Sides::Both, content }
    }

    /// How many primitives there are.
    #[must_use]
    pub fn primitives(&self) -> u32 {
        match &self.content {
            Content::Mesh(triangles) => triangles.count(),
            Content::Shapes(shapes) => shapes.len() as u32,
            Content::Solids(solids) => solids.len() as u32,
        }
    }

    /// A box around everything in it that is bounded.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        let all: Vec<Aabb> = match &self.content {
            Content::Mesh(triangles) => {
                (0..triangles.count()).map(|triangle| triangles.bounds(triangle)).collect()
            }
            Content::Shapes(shapes) => shapes.iter().map(Shape::bounds).collect(),
            Content::Solids(solids) => solids.iter().map(Solid::bounds).collect(),
        };
        all.into_iter()
            .filter(|bounds| !bounds.is_empty() && bounds.is_bounded())
            .fold(Aabb::EMPTY, Aabb::join)
    }
}
