//! Whether something has an inside, and which side that is.

use std::collections::HashMap;

use glam::DVec3;
use nestray_core::aabb::Aabb;
use nestray_shapes::any::AnyShape;
use nestray_shapes::quadric::Quadric;
use nestray_shapes::shape::Shape;
use nestray_shapes::triangle_mesh::Triangles;
use thiserror::Error;

use super::Solid;

/// Why something is no solid.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolidError {
    /// It has no inside.
    #[error("a {kind} has no inside (closed are sphere, torus, block, quadric and plane)")]
    Open {
        /// What it is.
        kind: &'static str,
    },
    /// The box of a quadric opens it.
    #[error("the box opens the quadric: leave it out, and intersect the quadric with a block")]
    Cut,
    /// Its front is inside.
    #[error("the {kind} is inside out: its front must be outside")]
    InsideOut {
        /// What it is.
        kind: &'static str,
    },
    /// An edge of a mesh has not as many faces one way as the other.
    #[error("the mesh is open at the edge from {from:?} to {to:?}")]
    Edge {
        /// Where the edge begins.
        from: [f32; 3],
        /// Where it ends.
        to: [f32; 3],
    },
    /// A place that flattens, or is none.
    #[error("the place is flat, or not finite")]
    Place,
    /// There are too many levels.
    #[error("solids within each other more than {} deep", Solid::DEEPEST)]
    TooDeep,
}

/// Whether a shape is closed, its front outside.
pub(super) fn check_shape(shape: &AnyShape) -> Result<(), SolidError> {
    match shape {
        AnyShape::Sphere(_) | AnyShape::Torus(_) | AnyShape::Block(_) | AnyShape::Plane(_) => {
            Ok(())
        }
        AnyShape::Quadric(quadric) => check_quadric(quadric),
        other => Err(SolidError::Open { kind: other.kind() }),
    }
}

fn check_quadric(quadric: &Quadric) -> Result<(), SolidError> {
    let whole = Quadric { clip: Aabb::ENDLESS, ..*quadric }.bounds();
    if quadric.clip != Aabb::ENDLESS && !(whole.is_bounded() && quadric.clip.contains(&whole)) {
        return Err(SolidError::Cut);
    }
    // Only ellipsoids have bounds; their value falls towards the middle.
    if whole.is_bounded() && quadric.squares[0] < 0.0 {
        return Err(SolidError::InsideOut { kind: "quadric" });
    }
    Ok(())
}

/// Whether a mesh is closed, its front outside. Vertices in the same place are the same.
pub(super) fn check_mesh(mesh: &Triangles) -> Result<(), SolidError> {
    let usable = || (0..mesh.count()).filter(|&i| mesh.is_usable(i)).map(|i| mesh.corners(i));
    let edges = |[a, b, c]: [[f32; 3]; 3]| [(a, b), (b, c), (c, a)];
    let name = |(a, b): ([f32; 3], [f32; 3])| {
        let (a, b) = (a.map(f32::to_bits), b.map(f32::to_bits));
        if a < b { ((a, b), 1) } else { ((b, a), -1) }
    };
    let mut excess = HashMap::<_, i64>::new();
    let mut volume = 0.0;
    for corners in usable() {
        for edge in edges(corners).into_iter().filter(|(a, b)| a != b) {
            let (name, way) = name(edge);
            *excess.entry(name).or_default() += way;
        }
        let [a, b, c] = corners.map(|corner| DVec3::from(corner.map(f64::from)));
        volume += a.dot(b.cross(c));
    }
    let open = |&edge: &([f32; 3], [f32; 3])| edge.0 != edge.1 && excess[&name(edge).0] != 0;
    if let Some((from, to)) = usable().flat_map(edges).find(open) {
        return Err(SolidError::Edge { from, to });
    }
    if volume > 0.0 {
        Ok(())
    } else if volume < 0.0 {
        Err(SolidError::InsideOut { kind: "mesh" })
    } else {
        Err(SolidError::Open { kind: "flat mesh" })
    }
}
