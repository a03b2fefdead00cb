//! Nodes that move over the frames of a film.

use glam::{Quat, Vec3};
use nestray_scene::animation::{Node as SceneNode, Track as SceneTrack, Way as SceneWay};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;
use super::transform::Transform;

/// A node of the animation.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Node {
    /// The node it hangs on, which comes before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    parent: Option<usize>,
    /// Where it rests, relative to its parent.
    rest: Transform,
    /// Where it is moved to, over time.
    #[serde(skip_serializing_if = "Track::is_empty")]
    translation: Track<[f32; 3]>,
    /// How it is turned, over time: unit quaternions, x, y, z, w.
    #[serde(skip_serializing_if = "Track::is_empty")]
    rotation: Track<[f32; 4]>,
    /// How it is scaled, over time.
    #[serde(skip_serializing_if = "Track::is_empty")]
    scale: Track<[f32; 3]>,
}

/// How a value changes over time.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Track<T> {
    /// How it goes from key to key.
    way: Way,
    /// Times in seconds, ascending, and values then.
    keys: Vec<(f32, T)>,
}

/// How a track goes from key to key.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum Way {
    /// It jumps.
    Step,
    /// At even speed.
    #[default]
    Linear,
    /// By cubic splines: for each time an in-tangent, a value and an out-tangent, in turn.
    Cubic,
}

impl<T> Default for Track<T> {
    fn default() -> Self {
        Self { way: Way::default(), keys: Vec::new() }
    }
}

impl<T: Copy> Track<T> {
    fn is_empty(&self) -> bool {
        self.keys.is_empty()
    }

    fn build<U>(&self, make: impl Fn(T) -> U) -> Result<SceneTrack<U>, String> {
        let way = match self.way {
            Way::Step => SceneWay::Step,
            Way::Linear => SceneWay::Linear,
            Way::Cubic => SceneWay::Cubic,
        };
        if matches!(self.way, Way::Cubic) && !self.keys.len().is_multiple_of(3) {
            return Err(".keys: cubic ones come by threes".into());
        }
        // Written so that NaN is refused.
        let ascend = self.keys.windows(2).all(|pair| pair[0].0 <= pair[1].0);
        if !ascend || self.keys.iter().any(|key| !key.0.is_finite()) {
            return Err(".keys: times must ascend".into());
        }
        Ok(SceneTrack { way, keys: self.keys.iter().map(|&(time, x)| (time, make(x))).collect() })
    }

    fn of<U: Copy>(track: &SceneTrack<U>, make: impl Fn(U) -> T) -> Self {
        let way = match track.way {
            SceneWay::Step => Way::Step,
            SceneWay::Linear => Way::Linear,
            SceneWay::Cubic => Way::Cubic,
        };
        Self { way, keys: track.keys.iter().map(|&(time, x)| (time, make(x))).collect() }
    }
}

impl Node {
    /// Checked; `before` nodes come before it.
    pub(super) fn build(&self, before: usize) -> Result<SceneNode, String> {
        let parent = match self.parent {
            Some(parent) => Some(number(".parent", parent, before, "earlier node")?),
            None => None,
        };
        Ok(SceneNode {
            parent,
            rest: self.rest.pose().map_err(|why| format!(".rest{why}"))?,
            translation: self
                .translation
                .build(Vec3::from_array)
                .map_err(|why| format!(".translation{why}"))?,
            rotation: self
                .rotation
                .build(Quat::from_array)
                .map_err(|why| format!(".rotation{why}"))?,
            scale: self.scale.build(Vec3::from_array).map_err(|why| format!(".scale{why}"))?,
        })
    }

    pub(super) fn of(node: &SceneNode) -> Self {
        Self {
            parent: node.parent,
            rest: Transform::of_pose(&node.rest),
            translation: Track::of(&node.translation, |x| x.to_array()),
            rotation: Track::of(&node.rotation, |x| x.to_array()),
            scale: Track::of(&node.scale, |x| x.to_array()),
        }
    }
}
