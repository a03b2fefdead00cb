//! Animations: the keys of nodes.

use glam::{Quat, Vec3};
use nestray_scene::animation::{Track, Way};

use super::Reader;
use super::document::AnimationSampler;
use super::nodes::{Nodes, Tracks, named};

impl Reader<'_> {
    /// Reads the first animation into the scene.
    pub(super) fn read_animation(&mut self, nodes: &Nodes) -> Result<(), String> {
        let document = self.document;
        let Some(animation) = document.animations.first() else { return Ok(()) };
        if document.animations.len() > 1 {
            let (name, count) = (animation.name.escape_debug(), document.animations.len());
            self.warn(format!("one of {count} animations is read: the first, `{name}`"));
        }
        let mut tracks: Vec<Tracks> = Vec::new();
        tracks.resize_with(nodes.all.len(), Tracks::default);
        for (number, channel) in animation.channels.iter().enumerate() {
            let Some(node) = channel.target.node else { continue };
            if node >= document.nodes.len() {
                return Err(format!("animations[0].channels[{number}]: there is no nodes[{node}]"));
            }
            let Some(at) = nodes.number(node) else { continue };
            let Some(sampler) = animation.samplers.get(channel.sampler) else {
                let missing = channel.sampler;
                return Err(format!(
                    "animations[0].channels[{number}]: there is no samplers[{missing}]"
                ));
            };
            let fail = |why: String| format!("animations[0].samplers[{}]: {why}", channel.sampler);
            match channel.target.path.as_str() {
                "translation" => {
                    tracks[at].translation =
                        self.track(sampler, |x, _| Vec3::from_array(x)).map_err(fail)?;
                }
                "scale" => {
                    tracks[at].scale =
                        self.track(sampler, |x, _| Vec3::from_array(x)).map_err(fail)?;
                }
                "rotation" => {
                    tracks[at].rotation = self.track(sampler, turn).map_err(fail)?;
                }
                "weights" => {
                    let name = named(&document.nodes[node].name, "node", node);
                    self.warn(format!("morph targets of {name} do not move: shown at rest"));
                }
                other => {
                    self.warn(format!("animated `{}` is not read", other.escape_debug()));
                }
            }
        }
        self.animate(nodes, tracks);
        Ok(())
    }

    /// The keys of a sampler; `make` is told whether its numbers are a value, not a tangent.
    fn track<T, const N: usize>(
        &mut self,
        sampler: &AnimationSampler,
        make: impl Fn([f32; N], bool) -> T,
    ) -> Result<Track<T>, String> {
        let way = match sampler.interpolation.as_deref() {
            None | Some("LINEAR") => Way::Linear,
            Some("STEP") => Way::Step,
            Some("CUBICSPLINE") => Way::Cubic,
            Some(other) => return Err(format!("interpolation `{}`", other.escape_debug())),
        };
        let each = if way == Way::Cubic { 3 } else { 1 };
        let times = self.elements(sampler.input, &[1])?;
        let values = self.elements(sampler.output, &[N])?;
        if times.count.checked_mul(each) != Some(values.count) {
            return Err(format!("{} values for {} keys", values.count, times.count));
        }
        self.keep(values.count)?;
        let mut keys = Vec::with_capacity(values.count);
        let mut last = f32::NEG_INFINITY;
        for key in 0..times.count {
            let time = times.float(key, 0);
            if !(time.is_finite() && time >= last) {
                return Err(format!("the time of key {key} is not later than the one before"));
            }
            last = time;
            for part in 0..each {
                let numbers: [f32; N] = values.array(key * each + part);
                if numbers.iter().any(|x| !x.is_finite()) {
                    return Err(format!("the value of key {key} is no number"));
                }
                keys.push((time, make(numbers, each == 1 || part == 1)));
            }
        }
        Ok(Track { keys, way })
    }
}

/// A rotation is made a unit one; a tangent of rotations is not one.
fn turn(numbers: [f32; 4], value: bool) -> Quat {
    let turn = Quat::from_array(numbers);
    let length = turn.length_squared();
    match value {
        true if length.is_finite() && length > 0.0 => turn.normalize(),
        true => Quat::IDENTITY,
        false => turn,
    }
}
