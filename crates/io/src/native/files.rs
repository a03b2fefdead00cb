//! Other files that a scene takes geometry from.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::Affine3A;
use nestray_scene::geometry::Content;
use nestray_scene::group::{Motion, Place};
use nestray_scene::scene::Scene;

use crate::error::Warning;
use crate::load::{LoadOptions, Loaded, Source, read};

/// The files that are being read, each named by the one before.
#[derive(Clone, Debug, Default)]
pub(super) struct Chain {
    open: Vec<PathBuf>,
}

/// Files a scene has taken something from.
#[derive(Debug, Default)]
pub(super) struct Files {
    scenes: BTreeMap<PathBuf, Loaded>,
    /// The group that is the world of each, once it is part of this scene.
    worlds: BTreeMap<PathBuf, usize>,
}

impl Chain {
    /// The chain with one more file.
    pub(super) fn with(&self, source: &Source) -> Self {
        let mut open = self.open.clone();
        open.push(whole(source.path.clone()));
        Self { open }
    }
}

fn whole(path: PathBuf) -> PathBuf {
    std::fs::canonicalize(&path).unwrap_or(path)
}

impl Files {
    /// The scene in a file that `source` names.
    fn load(&mut self, name: &str, source: &Source, chain: &Chain) -> Result<PathBuf, String> {
        let path = source.companion(name);
        let key = whole(path.clone());
        if chain.open.contains(&key) {
            return Err(format!("{} takes its geometry from itself", path.display()));
        }
        if !self.scenes.contains_key(&key) {
            let options = LoadOptions { complete: false, ..source.options };
            let inner = Source { path, options };
            let loaded = source.companion_bytes(&inner.path).and_then(|bytes| {
                if super::begins(&bytes) {
                    super::read_in(&bytes, &inner, chain)
                } else {
                    read(&bytes, &inner)
                }
            });
            self.scenes.insert(key.clone(), loaded.map_err(|error| error.to_string())?);
        }
        Ok(key)
    }

    /// The one geometry in a file.
    pub(super) fn content(
        &mut self,
        name: &str,
        source: &Source,
        chain: &Chain,
    ) -> Result<Content, String> {
        let key = self.load(name, source, chain)?;
        match self.scenes[&key].scene.geometries.as_slice() {
            [one] => Ok(one.content.clone()),
            all => Err(format!("{name} holds {} geometries: a group can take them", all.len())),
        }
    }

    /// Adds what stands in a file to a group of `scene`.
    pub(super) fn add_world(
        &mut self,
        name: &str,
        source: &Source,
        chain: &Chain,
        scene: &mut Scene,
        group: usize,
    ) -> Result<(), String> {
        let key = self.load(name, source, chain)?;
        if let Some(&world) = self.worlds.get(&key) {
            // Placed whole, not copied again: many groups may name one large file.
            let motion = Motion::Still(Affine3A::IDENTITY);
            scene.groups[group].places.push(Place { name: String::new(), group: world, motion });
            return Ok(());
        }
        let world = append(scene, &self.scenes[&key].scene);
        let all = scene.groups[world].clone();
        scene.groups[group].geometries.extend(all.geometries);
        scene.groups[group].places.extend(all.places);
        self.worlds.insert(key, world);
        Ok(())
    }

    /// What was odd about them.
    pub(super) fn warnings(self) -> Vec<Warning> {
        self.scenes.into_values().flat_map(|loaded| loaded.warnings).collect()
    }
}

/// Adds all that stands in another scene; returns the group that is its world.
fn append(scene: &mut Scene, other: &Scene) -> usize {
    let geometries = scene.geometries.len();
    let groups = scene.groups.len();
    let materials = scene.materials.len();
    let textures = scene.textures.len();
    let nodes = scene.animation.nodes.len();
    scene.textures.extend(other.textures.iter().cloned());
    for material in &other.materials {
        let mut material = material.clone();
        let used = [
            &mut material.base_texture,
            &mut material.metallic_roughness_texture,
            &mut material.normal_texture,
            &mut material.emission_texture,
        ];
        used.into_iter().flatten().for_each(|texture| *texture += textures);
        scene.materials.push(material);
    }
    for geometry in &other.geometries {
        let mut geometry = geometry.clone();
        geometry.material += materials;
        scene.geometries.push(geometry);
    }
    for group in &other.groups {
        let mut group = group.clone();
        group.geometries.iter_mut().for_each(|geometry| *geometry += geometries);
        for place in &mut group.places {
            place.group += groups;
            if let Motion::Node(node) = &mut place.motion {
                *node += nodes;
            }
        }
        scene.groups.push(group);
    }
    for node in &other.animation.nodes {
        let mut node = node.clone();
        node.parent = node.parent.map(|parent| parent + nodes);
        scene.animation.nodes.push(node);
    }
    groups + other.root
}
