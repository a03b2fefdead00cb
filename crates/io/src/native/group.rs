//! Groups, and where they stand.

use nestray_scene::group::{Group as SceneGroup, Place as ScenePlace};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;
use super::transform::Motion;

/// Geometries that stand together, and groups placed among them.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Group {
    /// What it is called.
    pub(super) name: String,
    /// Geometries that stand in it as they are.
    pub(super) geometries: Vec<usize>,
    /// Other groups, moved.
    pub(super) places: Vec<Place>,
    /// A file beside this one, of any format that is read: what stands in its world stands in
    /// this group, too. Its lights and cameras are left out.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) file: Option<String>,
}

/// A group, somewhere.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Place {
    /// What it is called.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    name: String,
    /// Which group.
    group: usize,
    /// Where; if left out, where it is.
    #[serde(default, skip_serializing_if = "Motion::is_none")]
    motion: Motion,
}

impl Group {
    /// Checked; `[geometries, groups, nodes]` are how many there are.
    pub(super) fn build(&self, counts: [usize; 3]) -> Result<SceneGroup, String> {
        let [geometries, groups, nodes] = counts;
        for (i, &geometry) in self.geometries.iter().enumerate() {
            number(&format!(".geometries[{i}]"), geometry, geometries, "geometry")?;
        }
        let mut places = Vec::with_capacity(self.places.len());
        for (i, place) in self.places.iter().enumerate() {
            let group = number(&format!(".places[{i}].group"), place.group, groups, "group")?;
            let motion = place.motion.build(nodes);
            let motion = motion.map_err(|why| format!(".places[{i}].motion{why}"))?;
            places.push(ScenePlace { name: place.name.clone(), group, motion });
        }
        Ok(SceneGroup { name: self.name.clone(), geometries: self.geometries.clone(), places })
    }

    pub(super) fn of(group: &SceneGroup) -> Self {
        let place = |place: &ScenePlace| Place {
            name: place.name.clone(),
            group: place.group,
            motion: Motion::of(&place.motion),
        };
        Self {
            name: group.name.clone(),
            geometries: group.geometries.clone(),
            places: group.places.iter().map(place).collect(),
            file: None,
        }
    }
}
