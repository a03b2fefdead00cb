//! Geometries.

use std::sync::Arc;

use nestray_scene::geometry::{Content, Geometry as SceneGeometry};
use nestray_shapes::shape::Sides as SceneSides;
use nestray_shapes::triangle_mesh::Triangles;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;
use super::shape::Shape;
use super::solid::Solid;

/// A set of primitives of one material: one of `mesh`, `shapes`, `solids` and `file`.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Geometry {
    /// What it is called.
    pub(super) name: String,
    /// Its material.
    pub(super) material: usize,
    /// Which sides can be seen.
    pub(super) sides: Sides,
    /// Triangles.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) mesh: Option<Mesh>,
    /// Single shapes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) shapes: Option<Vec<Shape>>,
    /// Solids made of solids.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) solids: Option<Vec<Solid>>,
    /// A file beside this one that holds one geometry, of any format that is read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) file: Option<String>,
}

/// Which sides can be seen.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Sides {
    /// Both.
    #[default]
    Both,
    /// Only the front.
    Front,
    /// Only the back.
    Back,
}

/// Triangles.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Mesh {
    /// Places of the vertices.
    positions: Vec<[f32; 3]>,
    /// The three vertices of each triangle, counter-clockwise seen from its front.
    faces: Vec<[u32; 3]>,
    /// A normal for each vertex, or none at all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    normals: Vec<[f32; 3]>,
    /// Texture coordinates for each vertex, or none at all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    uvs: Vec<[f32; 2]>,
    /// A linear colour with alpha for each vertex, or none at all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    colors: Vec<[f32; 4]>,
}

impl Geometry {
    /// What it consists of; none if that is in a file.
    pub(super) fn content(&self) -> Result<Option<Content>, String> {
        match (&self.mesh, &self.shapes, &self.solids, &self.file) {
            (Some(mesh), None, None, None) => {
                let triangles = mesh.build().map_err(|why| format!(".mesh: {why}"))?;
                Ok(Some(Content::Mesh(Arc::new(triangles))))
            }
            (None, Some(shapes), None, None) => {
                let build = |(i, shape): (usize, &Shape)| {
                    shape.build().map_err(|why| format!(".shapes[{i}]{why}"))
                };
                let shapes = shapes.iter().enumerate().map(build).collect::<Result<_, _>>()?;
                Ok(Some(Content::Shapes(Arc::new(shapes))))
            }
            (None, None, Some(solids), None) => {
                let build = |(i, solid): (usize, &Solid)| {
                    solid.build().map_err(|why| format!(".solids[{i}]{why}"))
                };
                let solids = solids.iter().enumerate().map(build).collect::<Result<_, _>>()?;
                Ok(Some(Content::Solids(Arc::new(solids))))
            }
            (None, None, None, Some(_)) => Ok(None),
            _ => Err(": it needs one of mesh, shapes, solids and file".into()),
        }
    }

    pub(super) fn build(
        &self,
        materials: usize,
        content: Content,
    ) -> Result<SceneGeometry, String> {
        let material = number(".material", self.material, materials, "material")?;
        let sides = match self.sides {
            Sides::Both => SceneSides::Both,
            Sides::Front => SceneSides::Front,
            Sides::Back => SceneSides::Back,
        };
        Ok(SceneGeometry { name: self.name.clone(), material, sides, content })
    }

    pub(super) fn of(geometry: &SceneGeometry) -> Self {
        let mut made = Self::default();
        match &geometry.content {
            Content::Mesh(triangles) => made.mesh = Some(Mesh::of(triangles)),
            Content::Shapes(shapes) => made.shapes = Some(shapes.iter().map(Shape::of).collect()),
            Content::Solids(solids) => made.solids = Some(solids.iter().map(Solid::of).collect()),
        }
        let sides = match geometry.sides {
            SceneSides::Both => Sides::Both,
            SceneSides::Front => Sides::Front,
            SceneSides::Back => Sides::Back,
        };
        let (name, material) = (geometry.name.clone(), geometry.material);
        Self { name, material, sides, ..made }
    }
}

impl Mesh {
    pub(super) fn build(&self) -> Result<Triangles, String> {
        Triangles::new(self.positions.clone(), self.faces.clone())
            .and_then(|mesh| mesh.with_normals(self.normals.clone()))
            .and_then(|mesh| mesh.with_uvs(self.uvs.clone()))
            .and_then(|mesh| mesh.with_colors(self.colors.clone()))
            .map_err(|error| error.to_string())
    }

    pub(super) fn of(triangles: &Triangles) -> Self {
        // JSON has no words for what is no number. Triangles there are never seen; with a
        // corner as far out as this neither.
        let finite = |x: f32| if x.is_finite() { x } else { f32::MAX };
        Self {
            positions: triangles.positions().iter().map(|place| place.map(finite)).collect(),
            faces: triangles.faces().to_vec(),
            normals: triangles.normals().to_vec(),
            uvs: triangles.uvs().iter().map(|uv| uv.map(finite)).collect(),
            colors: triangles.colors().to_vec(),
        }
    }
}
