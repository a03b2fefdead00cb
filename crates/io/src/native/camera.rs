//! Cameras.

use glam::Vec3A;
use nestray_scene::camera::{Camera as SceneCamera, Projection as SceneProjection};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;

/// A camera; it looks at a point, or forward.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Camera {
    /// What it is called.
    name: String,
    /// The eye.
    from: [f32; 3],
    /// The point it looks at.
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<[f32; 3]>,
    /// Where it looks, if at no point: a direction of any length but zero.
    #[serde(skip_serializing_if = "Option::is_none")]
    forward: Option<[f32; 3]>,
    /// Roughly up in the picture.
    up: [f32; 3],
    /// How the world is projected.
    projection: Projection,
    /// Rays start this far along the view.
    hither: f32,
    /// Pixels across and down.
    #[serde(skip_serializing_if = "Option::is_none")]
    resolution: Option<[u32; 2]>,
    /// Radius of the lens; 0 for a pinhole.
    aperture: f32,
    /// Distance along the view that is in focus.
    focus: f32,
    /// The node of the animation it hangs on; then it is relative to that.
    #[serde(skip_serializing_if = "Option::is_none")]
    node: Option<usize>,
}

/// How the world is projected.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Projection {
    /// Lines meet in the eye.
    Perspective {
        /// Angle from the bottom of the picture to the top, below 180.
        degrees: f32,
    },
    /// Lines are parallel.
    Orthographic {
        /// Height of the picture in the world.
        height: f32,
    },
}

impl Default for Camera {
    fn default() -> Self {
        let camera = Self::of(&SceneCamera::default());
        Self { forward: None, ..camera }
    }
}

impl Camera {
    pub(super) fn build(&self, nodes: usize) -> Result<SceneCamera, String> {
        let from = Vec3A::from_array(self.from);
        let forward = match (self.at, self.forward) {
            (Some(_), Some(_)) => return Err(": either at or forward, not both".into()),
            (Some(at), None) => Vec3A::from_array(at) - from,
            (None, Some(forward)) => Vec3A::from_array(forward),
            (None, None) => SceneCamera::default().forward,
        };
        if !(forward.is_finite() && forward != Vec3A::ZERO) {
            return Err(": it looks nowhere".into());
        }
        let projection = match self.projection {
            Projection::Perspective { degrees } if degrees > 0.0 && degrees < 180.0 => {
                SceneProjection::Perspective { degrees }
            }
            Projection::Orthographic { height } if height > 0.0 && height.is_finite() => {
                SceneProjection::Orthographic { height }
            }
            Projection::Perspective { degrees } => {
                return Err(format!(
                    ".projection.perspective.degrees: {degrees} is not between 0 and 180"
                ));
            }
            Projection::Orthographic { height } => {
                return Err(format!(".projection.orthographic.height: {height} is not positive"));
            }
        };
        if self.resolution.is_some_and(|size| size.contains(&0)) {
            return Err(".resolution: no pixels".into());
        }
        if !(self.aperture >= 0.0 && (self.aperture == 0.0 || self.focus > 0.0)) {
            return Err(": a lens has a radius, and a focus in front of it".into());
        }
        let node = match self.node {
            Some(node) => Some(number(".node", node, nodes, "node")?),
            None => None,
        };
        Ok(SceneCamera {
            name: self.name.clone(),
            from,
            forward,
            up: self.up.into(),
            projection,
            hither: self.hither,
            resolution: self.resolution,
            aperture: self.aperture,
            focus: self.focus,
            node,
        })
    }

    pub(super) fn of(camera: &SceneCamera) -> Self {
        Self {
            name: camera.name.clone(),
            from: camera.from.into(),
            at: None,
            forward: Some(camera.forward.into()),
            up: camera.up.into(),
            projection: match camera.projection {
                SceneProjection::Perspective { degrees } => Projection::Perspective { degrees },
                SceneProjection::Orthographic { height } => Projection::Orthographic { height },
            },
            hither: camera.hither,
            resolution: camera.resolution,
            aperture: camera.aperture,
            focus: camera.focus,
            node: camera.node,
        }
    }
}
