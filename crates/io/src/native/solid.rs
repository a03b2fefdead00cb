//! Solids made of solids.

use std::sync::Arc;

use nestray_scene::solid::{Operand as SceneOperand, Part, Solid as SceneSolid};
use nestray_shapes::csg::Operation;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::geometry::Mesh;
use super::shape::Shape;
use super::transform::Transform;

/// Two solids combined.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Solid {
    /// What is in either.
    Union(Box<[Operand; 2]>),
    /// What is in both.
    Intersection(Box<[Operand; 2]>),
    /// What is in the first and not in the second.
    Difference(Box<[Operand; 2]>),
}

/// One of the two: one of `shape`, `mesh` and `solid`.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Operand {
    /// A sphere, a torus, a block, a quadric that nothing cuts, or a plane for the half of
    /// space behind it.
    #[serde(skip_serializing_if = "Option::is_none")]
    shape: Option<Shape>,
    /// A closed mesh, its front outside.
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<Mesh>,
    /// Two solids combined.
    #[serde(skip_serializing_if = "Option::is_none")]
    solid: Option<Solid>,
    /// Where it is, relative to the whole.
    #[serde(skip_serializing_if = "is_here")]
    at: Transform,
}

fn is_here(at: &Transform) -> bool {
    *at == Transform::default()
}

impl Solid {
    /// Checked.
    pub(super) fn build(&self) -> Result<SceneSolid, String> {
        let (operation, name, [left, right]) = match self {
            Self::Union(operands) => (Operation::Union, "union", &**operands),
            Self::Intersection(operands) => (Operation::Intersection, "intersection", &**operands),
            Self::Difference(operands) => (Operation::Difference, "difference", &**operands),
        };
        let left = left.build().map_err(|why| format!(".{name}[0]{why}"))?;
        let right = right.build().map_err(|why| format!(".{name}[1]{why}"))?;
        SceneSolid::new(operation, left, right).map_err(|error| format!(": {error}"))
    }

    pub(super) fn of(solid: &SceneSolid) -> Self {
        let operands = Box::new(solid.operands().each_ref().map(Operand::of));
        match solid.operation() {
            Operation::Union => Self::Union(operands),
            Operation::Intersection => Self::Intersection(operands),
            Operation::Difference => Self::Difference(operands),
        }
    }
}

impl Operand {
    fn build(&self) -> Result<SceneOperand, String> {
        let operand = match (&self.shape, &self.mesh, &self.solid) {
            (Some(shape), None, None) => {
                let shape = shape.build().map_err(|why| format!(".shape{why}"))?;
                SceneOperand::shape(shape).map_err(|error| format!(".shape: {error}"))?
            }
            (None, Some(mesh), None) => {
                let mesh = mesh.build().map_err(|why| format!(".mesh: {why}"))?;
                SceneOperand::mesh(Arc::new(mesh)).map_err(|error| format!(".mesh: {error}"))?
            }
            (None, None, Some(solid)) => {
                solid.build().map_err(|why| format!(".solid{why}"))?.into()
            }
            _ => return Err(": it needs one of shape, mesh and solid".into()),
        };
        if is_here(&self.at) {
            return Ok(operand);
        }
        let place = self.at.matrix().map_err(|why| format!(".at{why}"))?;
        operand.placed(place).map_err(|error| format!(".at: {error}"))
    }

    fn of(operand: &SceneOperand) -> Self {
        let mut made = Self { at: Transform::of_matrix(operand.place()), ..Self::default() };
        match operand.part() {
            Part::Shape(shape) => made.shape = Some(Shape::of(shape)),
            Part::Mesh(mesh) => made.mesh = Some(Mesh::of(mesh)),
            Part::Solid(solid) => made.solid = Some(Solid::of(solid)),
        }
        made
    }
}
