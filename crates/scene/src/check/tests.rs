use std::sync::Arc;

use glam::{Affine3A, Vec3, Vec3A};
use nestray_shapes::sphere::Sphere;

use super::*;
use crate::animation::{Pose, Track, Way};
use crate::camera::Camera;
use crate::geometry::Geometry;
use crate::light::Light;
use crate::procedural::{SCENES, generate};
use crate::texture::Image;

/// A scene with one of everything that can be named.
fn sound() -> Scene {
    let mut scene = Scene::new();
    let pixels = Pixels::Linear(vec![[0; 4]; 6]);
    scene.textures.push(Texture::new("", Arc::new(Image { width: 3, height: 2, pixels })));
    scene.add_material(Material { base_texture: Some(0), ..Material::default() });
    let ball = Sphere { center: Vec3A::ZERO, radius: 1.0 };
    scene.add(Geometry::shapes("", 0, vec![ball.into()]));
    let group = scene.add_group(Group::default());
    scene.place(group, Motion::Node(0));
    scene.animation.nodes.push(Node {
        parent: None,
        rest: Pose::Matrix(Affine3A::IDENTITY),
        translation: Track { keys: vec![(0.0, Vec3::ZERO), (1.0, Vec3::X)], way: Way::Linear },
        rotation: Track::default(),
        scale: Track::default(),
    });
    scene.cameras.push(Camera::default());
    scene.lights.push(Light::point(Vec3A::ONE, [1.0; 3]));
    scene
}

#[test]
fn every_scene_made_by_program_is_sound() {
    assert_eq!(sound().check(), Ok(()));
    for entry in SCENES {
        let scene = generate(entry.name, Some(*entry.sizes.start())).expect("it can be made");
        assert_eq!(scene.check(), Ok(()), "{}", entry.name);
    }
}

#[test]
fn what_is_named_must_be_there() {
    let wrong = |change: fn(&mut Scene), expected: &str| {
        let mut scene = sound();
        change(&mut scene);
        assert_eq!(scene.check_names().expect_err(expected).to_string(), expected);
    };
    wrong(|s| s.root = 2, "root: there is no group 2");
    wrong(|s| s.geometries[0].material = 1, "geometries[0].material: there is no material 1");
    wrong(|s| s.groups[1].geometries.push(9), "groups[1].geometries[0]: there is no geometry 9");
    wrong(|s| s.groups[0].places[0].group = 5, "groups[0].places[0].group: there is no group 5");
    wrong(|s| s.groups[0].places[0].group = 0, "groups: group 0 stands in itself");
    wrong(
        |s| s.groups[0].places[0].motion = Motion::Node(1),
        "groups[0].places[0].motion: there is no node 1",
    );
    wrong(
        |s| s.materials[0].emission_texture = Some(1),
        "materials[0].emission_texture: there is no texture 1",
    );
    wrong(
        |s| s.background = Background::Environment { texture: 4, radians: 0.0, scale: 1.0 },
        "background.environment.texture: there is no texture 4",
    );
    wrong(|s| s.lights[0].node = Some(1), "lights[0].node: there is no node 1");
    wrong(|s| s.cameras[0].node = Some(7), "cameras[0].node: there is no node 7");
    wrong(
        |s| s.animation.nodes[0].parent = Some(0),
        "animation[0].parent: there is no earlier node 0",
    );
}

#[test]
fn values_must_make_sense() {
    const NONE: &str = "a number is infinite, or none";
    let wrong = |change: fn(&mut Scene), path: &str, problem: &str| {
        let mut scene = sound();
        change(&mut scene);
        assert_eq!(scene.check().expect_err(path).to_string(), format!("{path}: {problem}"));
    };
    wrong(|s| s.materials[0].roughness = f32::NAN, "materials[0].roughness", NONE);
    wrong(|s| s.materials[0].emission[1] = -1.0, "materials[0].emission", "it is negative");
    wrong(|s| s.ambient[2] = f32::INFINITY, "ambient", NONE);
    wrong(|s| s.cameras[0].from.x = f32::NAN, "cameras[0].from", NONE);
    wrong(|s| s.lights[0].color[0] = f32::INFINITY, "lights[0].color", NONE);
    wrong(|s| s.background = Background::Color([f32::NAN; 3]), "background.color", NONE);
    wrong(
        |s| s.animation.nodes[0].translation.keys.reverse(),
        "animation[0].translation",
        "times do not ascend",
    );
    wrong(
        |s| s.animation.nodes[0].translation.way = Way::Cubic,
        "animation[0].translation",
        "keys of a spline are not threes",
    );
    let image = |width, height| {
        let mut scene = sound();
        let pixels = Pixels::Linear(vec![[0; 4]; 6]);
        scene.textures[0].image = Arc::new(Image { width, height, pixels });
        scene.check().map_err(|error| error.to_string())
    };
    assert_eq!(image(2, 3), Ok(()));
    for (width, height) in [(3, 3), (0, 6), (usize::MAX, 2)] {
        let told = image(width, height).expect_err("pixels are missing");
        assert!(told.starts_with("textures[0].image: "), "{told}");
    }
}
