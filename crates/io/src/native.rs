//! Our own scene format: JSON that can say all a scene can.
//!
//! [`schema`] describes every field. Parts name each other by their place in a list, from 0.
//! Meshes may be written out, or taken from files of any other format; so may whole groups.

mod animation;
mod camera;
mod files;
mod geometry;
mod group;
mod layout;
mod light;
mod material;
mod shape;
mod solid;
mod texture;
mod transform;

#[cfg(test)]
mod tests;

use std::path::Path;

use nestray_scene::geometry::Content;
use nestray_scene::paths::Paths;
use nestray_scene::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use self::files::{Chain, Files};
use crate::atomic::write_file;
use crate::error::{LoadError, Warning};
use crate::json;
use crate::load::{Loaded, Source};
use crate::write::WriteError;

/// The version of the format that is read and written.
pub const VERSION: u32 = 1;

/// A scene of Nestray. Parts name each other by their place in a list, from 0.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Document {
    /// Version of the format: 1.
    nestray_scene: u32,
    /// Where editors find the schema; not read.
    #[serde(rename = "$schema", default, skip_serializing_if = "String::is_empty")]
    schema: String,
    /// Geometries; a hit names one of them.
    #[serde(default)]
    geometries: Vec<geometry::Geometry>,
    /// Groups of geometries and of other groups. Without any, all geometries are the world.
    #[serde(default)]
    groups: Vec<group::Group>,
    /// The group that is the world.
    #[serde(default)]
    root: usize,
    /// Materials. Without any, everything is grey plaster.
    #[serde(default)]
    materials: Vec<material::Material>,
    /// Pictures for textures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    images: Vec<texture::Image>,
    /// Textures.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    textures: Vec<texture::Texture>,
    /// Lights without a surface.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    lights: Vec<light::Light>,
    /// Cameras; the first is used unless another is asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    cameras: Vec<camera::Camera>,
    /// What rays see that hit nothing.
    #[serde(default)]
    background: light::Background,
    /// Light from everywhere, in Whitted's model.
    #[serde(default)]
    ambient: [f32; 3],
    /// How nodes move over the frames of a film, each after its parent.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    animation: Vec<animation::Node>,
}

/// The JSON Schema of the format.
#[must_use]
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(Document).to_value()
}

/// Whether these may be the first bytes of a scene of ours.
#[must_use]
pub fn begins(bytes: &[u8]) -> bool {
    let head = json::without_mark(bytes);
    let head = String::from_utf8_lossy(&head[..head.len().min(1 << 12)]);
    head.trim_start().starts_with('{') && head.contains("\"nestray_scene\"")
}

/// Reads a scene.
///
/// # Errors
/// If it is no JSON, or not as the schema says, with line and column; if parts do not fit
/// together, with their path (`groups[3].places[0].group: there is no group 7`); if files it
/// needs cannot be read.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    read_in(bytes, source, &Chain::default())
}

/// Reads a scene that other files of ours have named.
fn read_in(bytes: &[u8], source: &Source, chain: &Chain) -> Result<Loaded, LoadError> {
    let bytes = json::without_mark(bytes);
    let document: Document =
        serde_json::from_slice(bytes).map_err(|error| match other_version(bytes) {
            Some(version) => source.spot().error(foreign(version)),
            None => json::located(&error, source.spot()),
        })?;
    if document.nestray_scene != VERSION {
        return Err(source.spot().error(foreign(document.nestray_scene)));
    }
    let mut warnings = Vec::new();
    let scene = document.build(source, &chain.with(source), &mut warnings);
    let scene = scene.map_err(|why| source.spot().error(why))?;
    Ok(Loaded { scene, warnings })
}

/// The version a document says it has, if that is not ours.
fn other_version(bytes: &[u8]) -> Option<u32> {
    #[derive(Deserialize)]
    struct Head {
        nestray_scene: u32,
    }
    let head: Head = serde_json::from_slice(bytes).ok()?;
    Some(head.nestray_scene).filter(|&version| version != VERSION)
}

fn foreign(version: u32) -> String {
    format!("nestray_scene: version {version} of the format; {VERSION} is read")
}

/// Writes a scene, whole or not at all; images go into the file as well. Reading it gives the
/// same scene again.
///
/// # Errors
/// If the scene has a number that JSON cannot say, or the file cannot be written.
pub fn write_native(scene: &Scene, path: &Path) -> Result<(), WriteError> {
    let content = |reason| WriteError::Content { path: path.into(), reason };
    let document = Document::of(scene).map_err(content)?;
    let written = write_file(path, |out| {
        let layout = layout::Layout::default();
        let mut writer = serde_json::Serializer::with_formatter(&mut *out, layout);
        document.serialize(&mut writer)?;
        std::io::Write::write_all(out, b"\n")
    });
    written.map_err(|source| WriteError::File { path: path.into(), source })
}

/// A number that names one of `count` things, if there is such a one.
fn number(path: &str, number: usize, count: usize, what: &str) -> Result<usize, String> {
    if number < count { Ok(number) } else { Err(format!("{path}: there is no {what} {number}")) }
}

/// Builds each part of a list, and says where one cannot be.
fn each<T, U>(
    path: &str,
    parts: &[T],
    mut build: impl FnMut(usize, &T) -> Result<U, String>,
) -> Result<Vec<U>, String> {
    let build = |(i, part): (usize, &T)| build(i, part).map_err(|why| format!("{path}[{i}]{why}"));
    parts.iter().enumerate().map(build).collect()
}

impl Document {
    fn build(
        &self,
        source: &Source,
        chain: &Chain,
        warnings: &mut Vec<Warning>,
    ) -> Result<Scene, String> {
        let nodes = self.animation.len();
        let images: Vec<_> =
            self.images.iter().map(|image| image.build(source, warnings)).collect();
        let textures = each("textures", &self.textures, |_, texture| texture.build(&images))?;
        let mut scene = Scene {
            materials: each("materials", &self.materials, |_, m| m.build(textures.len()))?,
            lights: each("lights", &self.lights, |_, light| light.build(nodes))?,
            cameras: each("cameras", &self.cameras, |_, camera| camera.build(nodes))?,
            background: self
                .background
                .build(textures.len())
                .map_err(|why| format!("background{why}"))?,
            ambient: self.ambient,
            textures,
            ..Scene::default()
        };
        scene.animation.nodes = each("animation", &self.animation, |i, node| node.build(i))?;
        if scene.materials.is_empty() {
            scene.materials.push(nestray_scene::material::Material::default());
        }
        let mut files = Files::default();
        let materials = scene.materials.len();
        scene.geometries = each("geometries", &self.geometries, |_, geometry| {
            let content = content(geometry, source, chain, &mut files)?;
            geometry.build(materials, content)
        })?;
        self.build_groups(&mut scene, |scene, group, name| {
            files.add_world(name, source, chain, scene, group)
        })?;
        warnings.extend(files.warnings());
        Paths::new(&scene).map_err(|error| format!("groups: {error}"))?;
        Ok(scene)
    }

    /// The groups of the document, and those of files it names.
    fn build_groups(
        &self,
        scene: &mut Scene,
        mut add_world: impl FnMut(&mut Scene, usize, &str) -> Result<(), String>,
    ) -> Result<(), String> {
        if self.groups.is_empty() {
            number("root", self.root, 1, "group")?;
            let geometries = (0..self.geometries.len()).collect();
            scene.groups = vec![nestray_scene::group::Group { geometries, ..Default::default() }];
            return Ok(());
        }
        scene.root = number("root", self.root, self.groups.len(), "group")?;
        let counts = [self.geometries.len(), self.groups.len(), self.animation.len()];
        scene.groups = each("groups", &self.groups, |_, group| group.build(counts))?;
        for (i, group) in self.groups.iter().enumerate() {
            let Some(file) = &group.file else { continue };
            add_world(scene, i, file).map_err(|why| format!("groups[{i}].file: {why}"))?;
        }
        Ok(())
    }

    fn of(scene: &Scene) -> Result<Self, String> {
        let (textures, images) = texture::textures(&scene.textures)?;
        Ok(Self {
            nestray_scene: VERSION,
            schema: String::new(),
            geometries: scene.geometries.iter().map(geometry::Geometry::of).collect(),
            groups: scene.groups.iter().map(group::Group::of).collect(),
            root: scene.root,
            materials: scene.materials.iter().map(material::Material::of).collect(),
            images,
            textures,
            lights: scene.lights.iter().map(light::Light::of).collect(),
            cameras: scene.cameras.iter().map(camera::Camera::of).collect(),
            background: light::Background::of(&scene.background),
            ambient: scene.ambient,
            animation: scene.animation.nodes.iter().map(animation::Node::of).collect(),
        })
    }
}

fn content(
    geometry: &geometry::Geometry,
    source: &Source,
    chain: &Chain,
    files: &mut Files,
) -> Result<Content, String> {
    match (geometry.content()?, &geometry.file) {
        (Some(content), _) => Ok(content),
        (None, Some(file)) => {
            files.content(file, source, chain).map_err(|why| format!(".file: {why}"))
        }
        (None, None) => Err(": it needs one of mesh, shapes, solids and file".into()),
    }
}
