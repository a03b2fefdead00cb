//! Where things stand and how they move.

use glam::{Affine3A, Mat3A, Quat, Vec3, Vec3A};
use nestray_core::moving::Keys;
use nestray_scene::animation::Pose;
use nestray_scene::group::Motion as SceneMotion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;

/// Where something is: a matrix, or a scale, a rotation and a move, done in this order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Transform {
    /// Three rows of four numbers; the last of each is the move.
    #[serde(skip_serializing_if = "Option::is_none")]
    matrix: Option<[[f32; 4]; 3]>,
    /// A factor for each axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    scale: Option<[f32; 3]>,
    /// A turn about an axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    rotate: Option<Turn>,
    /// A rotation as a unit quaternion: x, y, z, w.
    #[serde(skip_serializing_if = "Option::is_none")]
    quaternion: Option<[f32; 4]>,
    /// A move.
    #[serde(skip_serializing_if = "Option::is_none")]
    translate: Option<[f32; 3]>,
}

/// A turn about an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Turn {
    /// The axis, of any length but zero.
    axis: [f32; 3],
    /// Counter-clockwise, seen against the axis.
    degrees: f32,
}

/// How something moves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Motion {
    /// Not at all.
    Still(Transform),
    /// Through these places while the shutter is open, on straight lines between them.
    Keys(Vec<Key>),
    /// With a node of the animation.
    Node(usize),
}

/// A place at a time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Key {
    /// From 0, when the shutter opens, to 1, when it closes.
    time: f32,
    /// Where.
    at: Transform,
}

impl Transform {
    /// The matrix or parts it stands for.
    pub(super) fn pose(&self) -> Result<Pose, String> {
        let parts = self.scale.is_some()
            || self.rotate.is_some()
            || self.quaternion.is_some()
            || self.translate.is_some();
        let pose = match self.matrix {
            Some(_) if parts => return Err(": either a matrix or its parts, not both".into()),
            Some([x, y, z]) => Pose::Matrix(Affine3A {
                matrix3: Mat3A::from_cols_array(&[
                    x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2],
                ]),
                translation: Vec3A::new(x[3], y[3], z[3]),
            }),
            None => Pose::Parts {
                translation: self.translate.map_or(Vec3::ZERO, Vec3::from_array),
                rotation: self.rotation()?,
                scale: self.scale.map_or(Vec3::ONE, Vec3::from_array),
            },
        };
        if matrix(&pose).is_finite() { Ok(pose) } else { Err(": numbers out of range".into()) }
    }

    fn rotation(&self) -> Result<Quat, String> {
        match (self.rotate, self.quaternion) {
            (Some(_), Some(_)) => Err(": either rotate or quaternion, not both".into()),
            (None, None) => Ok(Quat::IDENTITY),
            (None, Some(numbers)) => unit(numbers).map_err(|why| format!(".quaternion{why}")),
            (Some(turn), None) => {
                let axis = Vec3::from_array(turn.axis).try_normalize();
                let axis = axis.ok_or(".rotate.axis: it has no length")?;
                let half = turn.degrees.to_radians() / 2.0;
                let part = axis * libm::sinf(half);
                Ok(Quat::from_xyzw(part.x, part.y, part.z, libm::cosf(half)))
            }
        }
    }

    /// `world_from_object`.
    pub(super) fn matrix(&self) -> Result<Affine3A, String> {
        self.pose().map(|pose| matrix(&pose))
    }

    pub(super) fn of_matrix(place: &Affine3A) -> Self {
        if *place == Affine3A::IDENTITY {
            return Self::default();
        }
        let row = |i: usize| {
            let m = &place.matrix3;
            [m.x_axis[i], m.y_axis[i], m.z_axis[i], place.translation[i]]
        };
        Self { matrix: Some([row(0), row(1), row(2)]), ..Self::default() }
    }

    pub(super) fn of_pose(pose: &Pose) -> Self {
        match *pose {
            // Even if it does nothing: a matrix cannot be animated, parts can.
            Pose::Matrix(place) if place == Affine3A::IDENTITY => Self {
                matrix: Some([[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]),
                ..Self::default()
            },
            Pose::Matrix(place) => Self::of_matrix(&place),
            Pose::Parts { translation, rotation, scale } => Self {
                scale: Some(scale.to_array()).filter(|_| scale != Vec3::ONE),
                quaternion: Some(rotation.to_array()).filter(|_| rotation != Quat::IDENTITY),
                translate: Some(translation.to_array()).filter(|_| translation != Vec3::ZERO),
                ..Self::default()
            },
        }
    }
}

/// A rotation; as it is if it is one up to rounding.
fn unit(numbers: [f32; 4]) -> Result<Quat, String> {
    let turn = Quat::from_array(numbers);
    let length = turn.length();
    if (length - 1.0).abs() < 1e-6 {
        return Ok(turn);
    }
    if length.is_finite() && length > 0.0 {
        Ok(turn.normalize())
    } else {
        Err(": no rotation".into())
    }
}

fn matrix(pose: &Pose) -> Affine3A {
    match *pose {
        Pose::Matrix(matrix) => matrix,
        Pose::Parts { translation, rotation, scale } => {
            Affine3A::from_scale_rotation_translation(scale, rotation, translation)
        }
    }
}

impl Motion {
    /// Checked; nodes are numbered from `nodes` to tell if one is missing.
    pub(super) fn build(&self, nodes: usize) -> Result<SceneMotion, String> {
        match self {
            Self::Still(at) => {
                let place = at.matrix().map_err(|why| format!(".still{why}"))?;
                Ok(SceneMotion::Still(place))
            }
            Self::Node(node) => Ok(SceneMotion::Node(number(".node", *node, nodes, "node")?)),
            Self::Keys(keys) => {
                let mut made = Vec::with_capacity(keys.len());
                for (i, key) in keys.iter().enumerate() {
                    let place = key.at.matrix().map_err(|why| format!(".keys[{i}].at{why}"))?;
                    made.push((key.time, place));
                }
                let keys = Keys::new(made).map_err(|_| ".keys: times must ascend, and be there")?;
                Ok(SceneMotion::Keys(keys))
            }
        }
    }

    pub(super) fn of(motion: &SceneMotion) -> Self {
        match motion {
            SceneMotion::Still(place) => Self::Still(Transform::of_matrix(place)),
            SceneMotion::Node(node) => Self::Node(*node),
            SceneMotion::Keys(keys) => {
                let key = |(time, place): &(f32, Affine3A)| Key {
                    time: *time,
                    at: Transform::of_matrix(place),
                };
                Self::Keys(keys.keys().iter().map(key).collect())
            }
        }
    }

    pub(super) fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl Default for Motion {
    fn default() -> Self {
        Self::Still(Transform::default())
    }
}
