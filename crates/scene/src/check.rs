//! Whether the parts of a scene fit together, and its numbers make sense.

mod values;

#[cfg(test)]
mod tests;

use thiserror::Error;

use crate::animation::{Animation, Node};
use crate::group::{Group, Motion};
use crate::light::Background;
use crate::material::Material;
use crate::paths::{Paths, PathsError};
use crate::scene::Scene;
use crate::texture::{Pixels, Texture};

/// What is wrong with a scene, and where: `materials[2].base_texture: there is no texture 7`.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum SceneError {
    /// Something is named that is not there.
    #[error("{path}: there is no {what} {number}")]
    Missing {
        /// What names it.
        path: String,
        /// What it should be.
        what: &'static str,
        /// Its number.
        number: usize,
    },
    /// A value makes no sense.
    #[error("{path}: {problem}")]
    Value {
        /// Which.
        path: String,
        /// Why not.
        problem: &'static str,
    },
    /// The groups cannot be placed.
    #[error("groups: {0}")]
    Places(#[from] PathsError),
}

type Checked = Result<(), SceneError>;

impl Scene {
    /// Checks that everything that is named is there, that no group stands in itself, and that
    /// numbers are finite where a picture depends on them. Corners of meshes and numbers of
    /// shapes may be any: those that make no sense are not seen.
    ///
    /// Readers hand out scenes that pass.
    ///
    /// # Errors
    /// The first thing that is wrong, and where.
    pub fn check(&self) -> Result<(), SceneError> {
        self.check_names()?;
        values::check(self)
    }

    /// Checks that everything that is named is there, and that no group stands in itself: what
    /// a renderer relies on.
    ///
    /// # Errors
    /// The first thing that is wrong, and where.
    pub fn check_names(&self) -> Result<(), SceneError> {
        self.check_places()?;
        let (materials, textures) = (self.materials.len(), self.textures.len());
        for (i, geometry) in self.geometries.iter().enumerate() {
            let path = || format!("geometries[{i}].material");
            there(path, "material", geometry.material, materials)?;
        }
        each("materials", &self.materials, |material| self.material(material))?;
        each("textures", &self.textures, texture)?;
        let node = |node| there_is_node(|| "node".into(), node, &self.animation);
        each("lights", &self.lights, |light| node(light.node))?;
        each("cameras", &self.cameras, |camera| node(camera.node))?;
        match self.background {
            Background::Environment { texture, .. } => {
                there(|| "background.environment.texture".into(), "texture", texture, textures)
            }
            _ => Ok(()),
        }
    }

    /// Checks what says where things are: geometries, groups, places and nodes, but not what
    /// they look like.
    ///
    /// # Errors
    /// The first thing that is wrong, and where.
    pub fn check_places(&self) -> Result<(), SceneError> {
        there(|| "root".into(), "group", self.root, self.groups.len())?;
        for (i, node) in self.animation.nodes.iter().enumerate() {
            check_node(node, i).map_err(|error| error.within(&format!("animation[{i}]")))?;
        }
        each("groups", &self.groups, |group| self.group(group))?;
        Ok(Paths::new(self).map(|_| ())?)
    }

    fn group(&self, group: &Group) -> Checked {
        for (i, &geometry) in group.geometries.iter().enumerate() {
            there(|| format!("geometries[{i}]"), "geometry", geometry, self.geometries.len())?;
        }
        for (i, place) in group.places.iter().enumerate() {
            there(|| format!("places[{i}].group"), "group", place.group, self.groups.len())?;
            if let Motion::Node(node) = place.motion {
                there_is_node(|| format!("places[{i}].motion"), Some(node), &self.animation)?;
            }
        }
        Ok(())
    }

    fn material(&self, material: &Material) -> Checked {
        for (name, texture) in [
            ("base_texture", material.base_texture),
            ("metallic_roughness_texture", material.metallic_roughness_texture),
            ("normal_texture", material.normal_texture),
            ("emission_texture", material.emission_texture),
        ] {
            let Some(texture) = texture else { continue };
            there(|| name.into(), "texture", texture, self.textures.len())?;
        }
        Ok(())
    }
}

fn check_node(node: &Node, number: usize) -> Checked {
    if let Some(parent) = node.parent.filter(|&parent| parent >= number) {
        let (path, what) = ("parent".into(), "earlier node");
        return Err(SceneError::Missing { path, what, number: parent });
    }
    Ok(())
}

fn texture(texture: &Texture) -> Checked {
    let image = &texture.image;
    let pixels = match &image.pixels {
        Pixels::Srgb(pixels) | Pixels::Linear(pixels) => pixels.len(),
        Pixels::Float(pixels) => pixels.len(),
    };
    if pixels == 0 || image.width.checked_mul(image.height) != Some(pixels) {
        return Err(SceneError::value("image", "it has not as many pixels as it says, or none"));
    }
    Ok(())
}

/// Checks each part of a list, and says which is wrong.
fn each<T>(path: &str, parts: &[T], check: impl Fn(&T) -> Checked) -> Checked {
    let check = |(i, part)| check(part).map_err(|error| error.within(&format!("{path}[{i}]")));
    parts.iter().enumerate().try_for_each(check)
}

/// Checks that a number names one of `count` things.
fn there(
    path: impl FnOnce() -> String,
    what: &'static str,
    number: usize,
    count: usize,
) -> Checked {
    if number < count { Ok(()) } else { Err(SceneError::Missing { path: path(), what, number }) }
}

fn there_is_node(
    path: impl FnOnce() -> String,
    node: Option<usize>,
    animation: &Animation,
) -> Checked {
    node.map_or(Ok(()), |node| there(path, "node", node, animation.nodes.len()))
}

impl SceneError {
    fn value(path: &str, problem: &'static str) -> Self {
        Self::Value { path: path.into(), problem }
    }

    /// The same, in a larger part.
    fn within(self, outer: &str) -> Self {
        let longer = |path: String| format!("{outer}.{path}");
        match self {
            Self::Missing { path, what, number } => {
                Self::Missing { path: longer(path), what, number }
            }
            Self::Value { path, problem } => Self::Value { path: longer(path), problem },
            Self::Places(error) => Self::Places(error),
        }
    }
}
