use nestray_scene::light::Light;
use nestray_scene::light::LightKind;
use nestray_scene::material::{AlphaMode, Material};
use nestray_scene::procedural::generate;
use nestray_scene::scene::Scene;

use super::*;
use crate::options::{Integrator, Options, WhittedOptions};
use crate::ray_counts::{Count, RayCounts};
use crate::testing::*;

const WHITTED: Integrator = Integrator::Whitted(WhittedOptions { tree: Tree::Pruned });

/// A light that does not fade, as in NFF.
fn light(position: Vec3A, color: f32) -> Light {
    let kind = LightKind::Point { position, fades: false };
    Light { kind, ..Light::point(position, [color; 3]) }
}

fn middle(scene: &Scene) -> f32 {
    let rendered = picture(scene, &quick(WHITTED, 1));
    pixel(&rendered.picture, "", 12, 9)[0]
}

#[test]
fn a_dull_floor_is_lit_by_the_cosine() {
    let mut scene = empty();
    add(&mut scene, floor(0.0, 50.0), Material::from_nff([1.0; 3], 0.5, 0.0, 1.0, 0.0, 1.0));
    scene.lights.push(light(Vec3A::new(3000.0, 0.0, 4000.0), 0.7));
    scene.ambient = [0.2; 3];
    assert!((middle(&scene) - 0.5 * (0.7 * 0.8 + 0.2)).abs() < 1e-3, "{}", middle(&scene));
}

#[test]
fn a_mirror_shows_what_is_before_it() {
    let mut scene = empty();
    add(&mut scene, floor(0.0, 50.0), Material::from_nff([0.0; 3], 0.0, 0.6, 1.0, 0.0, 1.0));
    scene.background = sky(0.5);
    assert!((middle(&scene) - 0.3).abs() < 1e-6, "{}", middle(&scene));
}

#[test]
fn what_glows_is_seen_glowing_itself_and_in_mirrors_but_lights_nothing() {
    let mut scene = empty();
    let at = add(&mut scene, floor(0.0, 50.0), lamp(0.25));
    assert!((middle(&scene) - 0.25).abs() < 1e-6, "{}", middle(&scene));
    // The same behind the eye, and a mirror before it.
    let mirror = Material::from_nff([0.0; 3], 0.0, 0.6, 1.0, 0.0, 1.0);
    add(&mut scene, floor(-1.0, 50.0), mirror);
    let square = nestray_shapes::any::AnyShape::from(floor(9.0, 50.0));
    scene.geometries[at] = nestray_scene::geometry::Geometry::shapes("", 0, vec![square]);
    assert!((middle(&scene) - 0.15).abs() < 1e-6, "{}", middle(&scene));
    scene.materials[1] = Material::from_nff([1.0; 3], 0.9, 0.0, 1.0, 0.0, 1.0);
    assert_eq!(middle(&scene), 0.0);
}

#[test]
fn glass_of_index_one_is_not_there() {
    let glass =
        Material { transmission: 1.0, ior: 1.0, base_color: [1.0; 3], ..Material::default() };
    let mut scene = empty();
    scene.background = nestray_scene::light::Background::Gradient([[0.0; 3], [1.0; 3]], Vec3A::Y);
    for integrator in [WHITTED, Integrator::Path] {
        let options = quick(integrator, 4);
        let without = picture(&scene, &options).picture;
        let mut with = scene.clone();
        add(&mut with, sphere([0.0; 3], 1.0), glass.clone());
        let with = picture(&with, &options).picture;
        let (with, without) = (&with.layers[0].samples, &without.layers[0].samples);
        for (a, b) in with.iter().zip(without) {
            assert!((a - b).abs() < 1e-4, "{integrator:?}: {a} {b}");
        }
    }
}

#[test]
fn light_cannot_leave_glass_at_a_flat_angle() {
    // From within glass, 45° is beyond the critical angle: the surface is a mirror.
    let glass =
        Material { transmission: 1.0, roughness: 0.0, base_color: [1.0; 3], ..Material::default() };
    let mut scene = empty();
    scene.cameras[0].from = Vec3A::new(0.0, -1.0, -1.0);
    scene.cameras[0].forward = Vec3A::new(0.0, 1.0, 1.0);
    scene.cameras[0].projection = nestray_scene::camera::Projection::Perspective { degrees: 1.0 };
    add(&mut scene, floor(0.0, 9.0), glass);
    add(&mut scene, floor(-5.0, 90.0), lamp(0.25));
    scene.background = sky(9.0);
    for integrator in [WHITTED, Integrator::Path] {
        let seen = mean(&picture(&scene, &quick(integrator, 4)).picture);
        assert!((seen - 0.25).abs() < 1e-4, "{integrator:?}: {seen}");
    }
}

#[test]
fn veils_are_seen_through_and_lit() {
    let mut scene = empty();
    let veil = Material { alpha: 0.25, alpha_mode: AlphaMode::Blend, ..chalk(1.0) };
    add(&mut scene, floor(0.0, 50.0), veil);
    scene.background = sky(0.5);
    scene.lights.push(light(Vec3A::new(0.0, 0.0, 4000.0), 0.8));
    assert!((middle(&scene) - (0.75 * 0.5 + 0.25 * 0.8)).abs() < 1e-3, "{}", middle(&scene));
}

/// Counts of a standard scene, by the standard procedure.
fn counts(name: &str, size: u32) -> RayCounts {
    let scene = generate(name, Some(size)).expect("it can be made");
    let options = Options { layers: false, ..Options::standard_test() };
    picture(&scene, &options).rays
}

fn near(what: &str, found: u64, published: u64) {
    let off = (found as f64 - published as f64).abs() / published as f64;
    assert!(off < 0.1, "{what}: {found} found, {published} published");
}

#[test]
fn standard_scenes_need_the_published_rays() {
    // [Havran 00]: hits from the eye, shadow rays, blocked ones, secondary rays, hits of them.
    for (name, size, [eye, shadow, blocked, secondary, hitting]) in [
        ("tetra", 6, [49_950, 46_262, 5_538, 0, 0]),
        ("balls", 4, [263_169, 959_244, 285_178, 179_884, 134_368]),
        ("tree", 11, [169_907, 1_110_323, 47_506, 0, 0]),
    ] {
        let rays = counts(name, size);
        assert_eq!(rays.camera.cast, 513 * 513);
        near(&format!("{name}, eye"), rays.camera.hit, eye);
        near(&format!("{name}, shadow"), rays.shadow.cast, shadow);
        near(&format!("{name}, blocked"), rays.shadow.hit, blocked);
        let Count { cast, hit } = rays.secondary();
        if secondary == 0 {
            assert_eq!((cast, hit), (0, 0), "{name} mirrors nothing");
        } else {
            near(&format!("{name}, secondary"), cast, secondary);
            near(&format!("{name}, hitting"), hit, hitting);
        }
    }
}
