//! Materials, light and cameras that our own scenes share.

use glam::{Affine3A, Mat3A};
use glam::{DAffine3, DMat3, DVec3, Vec3A};

use crate::camera::Camera;
use crate::group::Motion;
use crate::light::{Background, Light, LightKind};
use crate::material::Material;
use crate::scene::Scene;

/// Something matte.
pub(super) fn matte(name: &str, base_color: [f32; 3]) -> Material {
    Material { name: name.into(), base_color, ..Material::default() }
}

/// Something painted, from 0, wet, to 1, dusty.
pub(super) fn paint(name: &str, base_color: [f32; 3], roughness: f32) -> Material {
    Material { roughness, ..matte(name, base_color) }
}

/// A metal, from 0, polished, to 1, blasted.
pub(super) fn metal(name: &str, base_color: [f32; 3], roughness: f32) -> Material {
    Material { metallic: 1.0, ..paint(name, base_color, roughness) }
}

/// Clear glass.
pub(super) fn glass(name: &str, base_color: [f32; 3]) -> Material {
    Material { transmission: 1.0, ior: 1.5, ..paint(name, base_color, 0.0) }
}

/// A world with nothing in it but a pale sky above, up being +z, and a sun.
pub(super) fn outdoors() -> Scene {
    let mut scene = Scene::new();
    scene.background = Background::Gradient([[0.78, 0.82, 0.86], [0.22, 0.42, 0.78]], Vec3A::Z);
    scene.ambient = [0.16, 0.18, 0.22];
    let towards = Vec3A::new(-0.45, -0.6, 0.66).normalize();
    let kind = LightKind::Directional { direction: -towards };
    scene.lights.push(Light {
        name: "sun".into(),
        kind,
        ..Light::point(Vec3A::ZERO, [2.5, 2.3, 2.0])
    });
    scene
}

/// A camera for a wide picture.
pub(super) fn camera(name: &str, from: DVec3, at: DVec3, degrees: f32) -> Camera {
    let (from, at) = (from.as_vec3a(), at.as_vec3a());
    Camera {
        name: name.into(),
        resolution: Some([960, 540]),
        ..Camera::looking(from, at, Vec3A::Z, degrees)
    }
}

/// A place that does not move.
pub(super) fn still(place: DAffine3) -> Motion {
    let [x, y, z] = [0, 1, 2].map(|i| place.matrix3.col(i).as_vec3a());
    Motion::Still(Affine3A {
        matrix3: Mat3A::from_cols(x, y, z),
        translation: place.translation.as_vec3a(),
    })
}

/// Upright, turned about the z-axis, scaled, then moved.
pub(super) fn upright(radians: f64, scale: f64, at: DVec3) -> DAffine3 {
    let turned = super::standard::rotation(DVec3::Z, radians);
    DAffine3::from_mat3_translation(DMat3::from_diagonal(DVec3::splat(scale)) * turned, at)
}
