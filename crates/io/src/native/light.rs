//! Lights, and what lies behind everything.

use glam::Vec3A;
use nestray_scene::light::{Background as SceneBackground, Light as SceneLight, LightKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;

/// A light without a surface.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Light {
    /// What it is called.
    #[serde(default)]
    name: String,
    /// Colour and strength, linear: radiant intensity of points and spots, irradiance of
    /// directional ones.
    color: [f32; 3],
    /// What kind it is, and where.
    kind: Kind,
    /// The node of the animation it hangs on; then places are relative to it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    node: Option<usize>,
}

/// Kinds of light. Directions are where the light goes, of any length but zero.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Kind {
    /// Shines alike in all directions.
    Point {
        position: [f32; 3],
        /// Whether it gets weaker with the square of the distance.
        #[serde(default = "yes")]
        fades: bool,
    },
    /// Comes from infinitely far away.
    Directional { direction: [f32; 3] },
    /// A point that shines in a cone: cosines of the angles up to which it is at its brightest,
    /// and from which on it is dark.
    Spot { position: [f32; 3], direction: [f32; 3], cos_inner: f32, cos_outer: f32 },
}

/// What rays see that hit nothing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Background {
    /// The same radiance everywhere.
    Color([f32; 3]),
    /// From below to above, evenly by height.
    Gradient { below: [f32; 3], above: [f32; 3], up: [f32; 3] },
    /// A picture of all directions, longitude by latitude, the middle towards −z and the top
    /// towards +y, turned about y.
    Environment {
        texture: usize,
        #[serde(default)]
        radians: f32,
        #[serde(default = "one")]
        scale: f32,
    },
}

fn yes() -> bool {
    true
}

fn one() -> f32 {
    1.0
}

impl Light {
    pub(super) fn build(&self, nodes: usize) -> Result<SceneLight, String> {
        // As it is if it is of length one, up to rounding.
        let unit = |direction: [f32; 3], kind: &str| {
            let direction = Vec3A::from_array(direction);
            if (direction.length() - 1.0).abs() < 1e-6 {
                return Ok(direction);
            }
            let unit = direction.try_normalize();
            unit.ok_or_else(|| format!(".kind.{kind}.direction: it has no length"))
        };
        let kind = match self.kind {
            Kind::Point { position, fades } => {
                LightKind::Point { position: position.into(), fades }
            }
            Kind::Directional { direction } => {
                LightKind::Directional { direction: unit(direction, "directional")? }
            }
            Kind::Spot { position, direction, cos_inner, cos_outer } => {
                if !(cos_inner >= cos_outer && cos_inner <= 1.0 && cos_outer >= -1.0) {
                    return Err(".kind.spot: 1 ≥ cos_inner ≥ cos_outer ≥ −1 does not hold".into());
                }
                let direction = unit(direction, "spot")?;
                LightKind::Spot { position: position.into(), direction, cos_inner, cos_outer }
            }
        };
        let node = match self.node {
            Some(node) => Some(number(".node", node, nodes, "node")?),
            None => None,
        };
        Ok(SceneLight { name: self.name.clone(), color: self.color, kind, node })
    }

    pub(super) fn of(light: &SceneLight) -> Self {
        let kind = match light.kind {
            LightKind::Point { position, fades } => {
                Kind::Point { position: position.into(), fades }
            }
            LightKind::Directional { direction } => {
                Kind::Directional { direction: direction.into() }
            }
            LightKind::Spot { position, direction, cos_inner, cos_outer } => {
                let (position, direction) = (position.into(), direction.into());
                Kind::Spot { position, direction, cos_inner, cos_outer }
            }
        };
        Self { name: light.name.clone(), color: light.color, kind, node: light.node }
    }
}

impl Default for Background {
    fn default() -> Self {
        Self::Color([0.0; 3])
    }
}

impl Background {
    pub(super) fn build(&self, textures: usize) -> Result<SceneBackground, String> {
        Ok(match *self {
            Self::Color(color) => SceneBackground::Color(color),
            Self::Gradient { below, above, up } => {
                SceneBackground::Gradient([below, above], up.into())
            }
            Self::Environment { texture, radians, scale } => SceneBackground::Environment {
                texture: number(".environment.texture", texture, textures, "texture")?,
                radians,
                scale,
            },
        })
    }

    pub(super) fn of(background: &SceneBackground) -> Self {
        match *background {
            SceneBackground::Color(color) => Self::Color(color),
            SceneBackground::Gradient([below, above], up) => {
                Self::Gradient { below, above, up: up.into() }
            }
            SceneBackground::Environment { texture, radians, scale } => {
                Self::Environment { texture, radians, scale }
            }
        }
    }
}
