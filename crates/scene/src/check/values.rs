//! Whether the numbers of a scene make sense.

use glam::Vec3A;

use super::{Checked, SceneError, each};
use crate::animation::{Node, Pose, Track, Way};
use crate::camera::{Camera, Projection};
use crate::light::{Background, Light, LightKind};
use crate::material::{AlphaMode, Material};
use crate::scene::Scene;
use crate::texture::Texture;

pub(super) fn check(scene: &Scene) -> Checked {
    each("materials", &scene.materials, material)?;
    each("textures", &scene.textures, texture)?;
    each("lights", &scene.lights, light)?;
    each("cameras", &scene.cameras, camera)?;
    each("animation", &scene.animation.nodes, node)?;
    background(&scene.background).map_err(|error| error.within("background"))?;
    finite("ambient", &scene.ambient)
}

fn material(material: &Material) -> Checked {
    finite("base_color", &material.base_color)?;
    finite("emission", &material.emission)?;
    if material.emission.iter().any(|&x| x < 0.0) {
        return Err(SceneError::value("emission", "it is negative"));
    }
    for (name, number) in [
        ("metallic", material.metallic),
        ("roughness", material.roughness),
        ("normal_scale", material.normal_scale),
        ("transmission", material.transmission),
        ("ior", material.ior),
        ("alpha", material.alpha),
    ] {
        finite(name, &[number])?;
    }
    if let AlphaMode::Mask(least) = material.alpha_mode {
        finite("alpha_mode", &[least])?;
    }
    let Some(whitted) = &material.whitted else { return Ok(()) };
    finite("whitted.color", &whitted.color)?;
    finite("whitted", &[whitted.kd, whitted.ks, whitted.shine, whitted.t])
}

fn light(light: &Light) -> Checked {
    finite("color", &light.color)?;
    match light.kind {
        LightKind::Point { position, .. } => point("position", position),
        LightKind::Directional { direction } => point("direction", direction),
        LightKind::Spot { position, direction, cos_inner, cos_outer } => {
            point("position", position)?;
            point("direction", direction)?;
            finite("cone", &[cos_inner, cos_outer])
        }
    }
}

fn camera(camera: &Camera) -> Checked {
    point("from", camera.from)?;
    point("forward", camera.forward)?;
    point("up", camera.up)?;
    let extent = match camera.projection {
        Projection::Perspective { degrees } => degrees,
        Projection::Orthographic { height } => height,
    };
    finite("projection", &[extent])?;
    finite("lens", &[camera.hither, camera.aperture, camera.focus])
}

fn background(background: &Background) -> Checked {
    match background {
        Background::Color(color) => finite("color", color),
        Background::Gradient(colors, up) => {
            finite("gradient", colors.as_flattened())?;
            point("gradient", *up)
        }
        Background::Environment { radians, scale, .. } => {
            finite("environment", &[*radians, *scale])
        }
    }
}

fn node(node: &Node) -> Checked {
    match node.rest {
        Pose::Matrix(matrix) => finite("rest", &matrix.to_cols_array())?,
        Pose::Parts { translation, rotation, scale } => {
            finite("rest.translation", &translation.to_array())?;
            finite("rest.rotation", &rotation.to_array())?;
            finite("rest.scale", &scale.to_array())?;
        }
    }
    track("translation", &node.translation)?;
    track("rotation", &node.rotation)?;
    track("scale", &node.scale)
}

fn track<T>(path: &str, track: &Track<T>) -> Checked {
    let times: Vec<f32> = track.keys.iter().map(|key| key.0).collect();
    finite(path, &times)?;
    if times.windows(2).any(|pair| pair[0] > pair[1]) {
        return Err(SceneError::value(path, "times do not ascend"));
    }
    if track.way == Way::Cubic && !times.len().is_multiple_of(3) {
        return Err(SceneError::value(path, "keys of a spline are not threes"));
    }
    Ok(())
}

fn texture(texture: &Texture) -> Checked {
    finite("scale", &texture.scale)?;
    finite("rotation", &[texture.rotation])?;
    finite("offset", &texture.offset)
}

fn finite(path: &str, numbers: &[f32]) -> Checked {
    if numbers.iter().all(|x| x.is_finite()) {
        return Ok(());
    }
    Err(SceneError::value(path, "a number is infinite, or none"))
}

fn point(path: &str, point: Vec3A) -> Checked {
    finite(path, &point.to_array())
}
