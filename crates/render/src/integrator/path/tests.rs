use glam::{Affine3A, Quat, Vec3};
use nestray_scene::geometry::Geometry;
use nestray_scene::group::Group;
use nestray_scene::light::{Background, Light, LightKind};
use nestray_scene::material::{AlphaMode, Material};
use nestray_scene::scene::Scene;
use nestray_scene::texture::{Image, Pixels, Texture};
use nestray_shapes::disk::Disk;
use nestray_shapes::triangle_mesh::Triangles;
use std::sync::Arc;

use super::*;
use crate::options::{Integrator, Options};
use crate::render::render_by;
use crate::testing::*;
use crate::watch::Unwatched;

/// The mean of a picture by one way to find lights.
fn mean_by(scene: &Scene, options: &Options, direct: Direct) -> f64 {
    let rendered = render_by(scene, &*world(scene), options, &Unwatched, direct);
    mean(&rendered.expect("it can be rendered").picture)
}

/// Looks straight down on the middle of a floor at z = 0, a narrow view.
fn above() -> Scene {
    let mut scene = empty();
    scene.cameras[0].projection = nestray_scene::camera::Projection::Perspective { degrees: 0.1 };
    scene
}

#[test]
fn a_white_thing_in_white_light_cannot_be_seen() {
    let rough = |roughness: f32, metallic: f32| Material {
        base_color: [1.0; 3],
        roughness,
        metallic,
        ..Material::default()
    };
    let glass = Material { transmission: 1.0, ..rough(0.0, 0.0) };
    for material in
        [chalk(1.0), rough(1.0, 0.0), rough(0.3, 0.0), rough(0.6, 1.0), rough(0.0, 1.0), glass]
    {
        let mut scene = empty();
        scene.background = sky(0.5);
        add(&mut scene, sphere([0.0; 3], 1.5), material.clone());
        let options = Options { max_depth: 64, ..quick(Integrator::Path, 64) };
        let picture = picture(&scene, &options).picture;
        assert!((mean(&picture) - 0.5).abs() < 0.0025, "{material:?}: {}", mean(&picture));
        let darkest = picture.layers[0].samples.iter().fold(1.0f32, |a, &b| a.min(b));
        assert!(darkest > 0.4, "{material:?}: {darkest}");
    }
}

#[test]
fn a_point_light_is_as_bright_as_its_law_says() {
    let mut scene = above();
    add(&mut scene, floor(0.0, 10.0), chalk(0.6));
    scene.lights.push(Light::point(Vec3A::new(3.0, 0.0, 4.0), [50.0; 3]));
    let found = mean(&picture(&scene, &quick(Integrator::Path, 4)).picture);
    // Albedo over π, times intensity over distance squared, times the cosine.
    let expected = 0.6 / std::f64::consts::PI * 50.0 / 25.0 * 0.8;
    assert!((found - expected).abs() < 1e-3 * expected, "{found} {expected}");
}

#[test]
fn directional_and_spot_lights_are_as_bright_as_their_laws_say() {
    let pi = std::f64::consts::PI;
    let straight = Vec3A::NEG_Z;
    let position = Vec3A::new(0.0, 0.0, 2.0);
    for (kind, expected) in [
        (LightKind::Directional { direction: Vec3A::new(0.6, 0.0, -0.8) }, 0.8 / pi * 3.0 * 0.8),
        (
            LightKind::Spot { position, direction: straight, cos_inner: 0.9, cos_outer: 0.8 },
            0.8 / pi * 3.0 / 4.0,
        ),
        (LightKind::Spot { position, direction: -straight, cos_inner: 0.9, cos_outer: 0.8 }, 0.0),
        (LightKind::Point { position, fades: false }, 0.8 * 3.0),
    ] {
        let mut scene = above();
        add(&mut scene, floor(0.0, 10.0), chalk(0.8));
        scene.lights.push(Light { kind, ..Light::point(position, [3.0; 3]) });
        let found = mean(&picture(&scene, &quick(Integrator::Path, 4)).picture);
        assert!((found - expected).abs() < 2e-3, "{kind:?}: {found} {expected}");
    }
}

#[test]
fn a_lamp_that_is_a_sphere_is_as_bright_as_its_law_says() {
    let mut scene = above();
    add(&mut scene, floor(0.0, 10.0), chalk(0.5));
    add(&mut scene, sphere([3.0, 0.0, 4.0], 1.0), lamp(7.0));
    let options = quick(Integrator::Path, 256);
    // Irradiance of a sphere: π · radiance · (radius / distance)² · cosine.
    let expected = 0.5 * 7.0 / 25.0 * 0.8;
    for (direct, slack) in
        [(Direct::Both, 0.005), (Direct::Lights, 0.005), (Direct::Scattering, 0.03)]
    {
        let found = mean_by(&scene, &options, direct);
        assert!((found - expected).abs() < slack * expected, "{direct:?}: {found} {expected}");
    }
}

#[test]
fn a_lamp_that_is_a_disk_or_a_triangle_counts_through_instances() {
    let pi = std::f32::consts::PI;
    // A disk of radius r at height h over a floor: π · radiance · r² / (r² + h²).
    for scale in [Vec3::ONE, Vec3::new(2.0, 2.0, 1.0), Vec3::new(-2.0, 2.0, 1.0)] {
        let mut scene = above();
        add(&mut scene, floor(0.0, 20.0), chalk(0.5));
        scene.cameras[0].from = Vec3A::new(0.0, 0.0, 1.0);
        let material = scene.add_material(lamp(2.0));
        let disk = Disk { center: Vec3A::ZERO, normal: Vec3A::Z, radius: 1.0 };
        let lamp = scene.add_apart(Geometry::shapes("lamp", material, vec![disk.into()]));
        let group = scene.add_group(Group { geometries: vec![lamp], ..Group::default() });
        let turned = Quat::from_rotation_x(pi);
        let place =
            Affine3A::from_scale_rotation_translation(scale, turned, Vec3::new(0.0, 0.0, 3.0));
        scene.place(group, nestray_scene::group::Motion::Still(place));
        let options = quick(Integrator::Path, 256);
        let r = f64::from(scale.y);
        let expected = 0.5 * 2.0 * r * r / (r * r + 9.0);
        for direct in [Direct::Both, Direct::Lights, Direct::Scattering] {
            let found = mean_by(&scene, &options, direct);
            assert!(
                (found - expected).abs() < 0.02 * expected,
                "{scale} {direct:?}: {found} {expected}"
            );
        }
    }
}

/// A box with a lamp under its ceiling and a glossy ball in it.
fn room(material: Material) -> Scene {
    let mut scene = empty();
    scene.cameras[0].from = Vec3A::new(0.0, 0.0, 1.8);
    scene.cameras[0].projection = nestray_scene::camera::Projection::Perspective { degrees: 60.0 };
    let inside = scene.add_material(chalk(0.5));
    let c = |x: f32, y: f32, z: f32| Vec3A::new(x, y, z) * 2.0;
    let corners: Vec<Vec3A> = (0..8u32)
        .map(|i| {
            c(
                (i & 1) as f32 * 2.0 - 1.0,
                (i >> 1 & 1) as f32 * 2.0 - 1.0,
                (i >> 2) as f32 * 2.0 - 1.0,
            )
        })
        .collect();
    let quads =
        [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let triangles: Vec<[Vec3A; 3]> = quads
        .iter()
        .flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]])
        .map(|t| t.map(|i: usize| corners[i]))
        .collect();
    scene.add(Geometry::mesh("room", inside, Triangles::from_corners(&triangles)));
    let glow = scene.add_material(lamp(4.0));
    let (a, b) = (0.8, 1.98);
    let lamp = [
        [Vec3A::new(-a, b, -a), Vec3A::new(a, b, -a), Vec3A::new(a, b, a)],
        [Vec3A::new(-a, b, -a), Vec3A::new(a, b, a), Vec3A::new(-a, b, a)],
    ];
    scene.add(Geometry::mesh("lamp", glow, Triangles::from_corners(&lamp)));
    add(&mut scene, sphere([0.3, -1.0, 0.0], 0.9), material);
    scene
}

#[test]
fn picked_and_scattered_light_agree_in_a_room() {
    let plastic = Material { roughness: 0.3, ..Material::default() };
    let metal = Material { metallic: 1.0, roughness: 0.25, ..Material::default() };
    let frosted = Material { transmission: 0.8, roughness: 0.5, ..Material::default() };
    for material in [plastic, metal, frosted] {
        let scene = room(material.clone());
        let options = Options { max_depth: 4, ..quick(Integrator::Path, 256) };
        let both = mean_by(&scene, &options, Direct::Both);
        for direct in [Direct::Lights, Direct::Scattering] {
            let one = mean_by(&scene, &options, direct);
            assert!((one - both).abs() < 0.02 * both, "{material:?} {direct:?}: {one} {both}");
        }
    }
}

#[test]
fn surroundings_are_found_alike_both_ways() {
    let mut scene = empty();
    let mut pixels = vec![[0.1, 0.2, 0.3]; 32 * 16];
    pixels[5 * 32 + 8] = [60.0, 50.0, 40.0];
    let image = Image { width: 32, height: 16, pixels: Pixels::Float(pixels) };
    scene.textures.push(Texture::new("sky", Arc::new(image)));
    scene.background = Background::Environment { texture: 0, radians: 0.7, scale: 2.0 };
    let shiny = Material { roughness: 0.4, ..Material::default() };
    add(&mut scene, sphere([0.0; 3], 1.0), shiny);
    add(&mut scene, sphere([0.0, -101.0, 0.0], 100.0), chalk(0.5));
    let options = Options { max_depth: 3, ..quick(Integrator::Path, 1024) };
    let both = mean_by(&scene, &options, Direct::Both);
    for direct in [Direct::Lights, Direct::Scattering] {
        let one = mean_by(&scene, &options, direct);
        assert!((one - both).abs() < 0.02 * both, "{direct:?}: {one} {both}");
    }
}

#[test]
fn half_a_surface_lets_half_the_light_through() {
    for (mode, alpha, expected) in [
        (AlphaMode::Blend, 0.25, 0.75),
        (AlphaMode::Mask(0.5), 0.4, 1.0),
        (AlphaMode::Mask(0.5), 0.6, 0.0),
        (AlphaMode::Opaque, 0.25, 0.0),
    ] {
        let mut scene = above();
        let veil = Material { alpha, alpha_mode: mode, ..chalk(0.0) };
        add(&mut scene, floor(1.0, 10.0), veil.clone());
        add(&mut scene, floor(0.0, 10.0), lamp(1.0));
        let seen = mean(&picture(&scene, &quick(Integrator::Path, 64)).picture);
        assert!((seen - expected).abs() < 0.02, "seen through {mode:?}: {seen}");

        let mut scene = above();
        scene.cameras[0].from = Vec3A::new(0.0, 0.0, 0.5);
        add(&mut scene, floor(1.0, 10.0), veil);
        add(&mut scene, floor(0.0, 10.0), chalk(1.0));
        let direction = Vec3A::NEG_Z;
        scene.lights.push(Light {
            kind: LightKind::Directional { direction },
            ..Light::point(Vec3A::ZERO, [std::f32::consts::PI; 3])
        });
        let lit = mean(&picture(&scene, &quick(Integrator::Path, 4)).picture);
        assert!((lit - expected).abs() < 0.02, "lit through {mode:?}: {lit}");
    }
}

#[test]
fn the_clamp_limits_light_over_several_surfaces_only() {
    let scene = room(Material { metallic: 1.0, roughness: 0.25, ..Material::default() });
    let seen = |max_depth: u32, clamp: Option<f32>| {
        let options = Options { max_depth, clamp, ..quick(Integrator::Path, 64) };
        mean(&picture(&scene, &options).picture)
    };
    assert_eq!(seen(1, Some(1e-3)), seen(1, None), "light over one surface is never limited");
    let (all, limited, none) = (seen(5, None), seen(5, Some(0.2)), seen(1, None));
    assert!(none < limited && limited < 0.98 * all, "{none} < {limited} < {all}");
    assert_eq!(seen(5, Some(1e6)), all);
}
