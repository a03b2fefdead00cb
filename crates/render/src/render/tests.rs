use std::sync::Mutex;

use glam::{Affine3A, Vec3, Vec3A};
use nestray_core::moving::Keys;
use nestray_core::simd::Level;
use nestray_scene::geometry::Geometry;
use nestray_scene::group::{Group, Motion};
use nestray_scene::light::Light;
use nestray_scene::material::{AlphaMode, Material};
use nestray_scene::solid::{Operand, Solid};
use nestray_shapes::csg::Operation;
use nestray_shapes::triangle_mesh::Triangles;

use super::*;
use crate::options::{Crop, Tree, WhittedOptions};
use crate::testing::*;
use crate::watch::Unwatched;

/// A little of everything: mirrors, glass, veils, lamps, lights, motion.
fn varied() -> Scene {
    let mut scene = empty();
    scene.background = sky(0.2);
    scene.ambient = [0.1; 3];
    scene.cameras[0].aperture = 0.05;
    scene.cameras[0].focus = 5.0;
    add(&mut scene, floor(-1.5, 30.0), chalk(0.6));
    add(
        &mut scene,
        sphere([1.0, 0.5, 0.0], 0.6),
        Material { metallic: 1.0, roughness: 0.2, ..chalk(0.9) },
    );
    let glass = Material { transmission: 0.9, ior: 1.5, roughness: 0.0, ..chalk(0.9) };
    add(&mut scene, sphere([-0.8, 0.0, 0.5], 0.7), glass);
    let veil = Material { alpha: 0.5, alpha_mode: AlphaMode::Blend, ..chalk(0.8) };
    add(&mut scene, sphere([0.0, -0.8, 1.0], 0.5), veil);
    let glow = scene.add_material(lamp(3.0));
    let up = [[Vec3A::new(-1.0, 1.4, -1.0), Vec3A::new(1.0, 1.4, -1.0), Vec3A::new(0.0, 1.9, 1.0)]];
    let lamp = scene.add_apart(Geometry::mesh("lamp", glow, Triangles::from_corners(&up)));
    let group = scene.add_group(Group { geometries: vec![lamp], ..Group::default() });
    let at = |x: f32| Affine3A::from_translation(Vec3::new(x, 0.0, 0.0));
    let keys = Keys::new(vec![(0.0, at(0.0)), (1.0, at(0.5))]).expect("times ascend");
    scene.place(group, Motion::Keys(keys));
    scene.lights.push(Light::point(Vec3A::new(2.0, 3.0, 4.0), [20.0; 3]));
    scene.lights.push(Light::point(Vec3A::new(-3.0, 1.0, 3.0), [9.0, 0.0, 3.0]));
    scene
}

fn all() -> [Integrator; 4] {
    let tree = Tree::Pruned;
    [
        Integrator::Path,
        Integrator::Whitted(WhittedOptions { tree }),
        Integrator::AmbientOcclusion { radius: Some(1.0) },
        Integrator::Cost,
    ]
}

/// Not a multiple of the side of a tile.
fn options(integrator: Integrator) -> Options {
    Options { resolution: [70, 45], ..quick(integrator, 3) }
}

fn bits(picture: &Picture) -> Vec<u32> {
    picture.layers.iter().flat_map(|layer| &layer.samples).map(|x| x.to_bits()).collect()
}

#[test]
fn the_picture_depends_on_nothing_but_scene_and_options() {
    let scene = varied();
    let world = world(&scene);
    let go = |options: Options| render(&scene, &*world, &options, &Unwatched).expect("it can be");
    for integrator in all() {
        let reference = go(options(integrator));
        let check = |what: String, changed: Options| {
            let other = go(changed);
            assert!(bits(&reference.picture) == bits(&other.picture), "{integrator:?}: {what}");
            assert_eq!(reference.rays, other.rays, "{integrator:?}: {what}");
        };
        for threads in [2, 3, 7] {
            check(format!("{threads} threads"), Options { threads, ..options(integrator) });
        }
        for wave in [1, 2, 7, 64, 4096] {
            check(format!("waves of {wave}"), Options { wave, ..options(integrator) });
        }
        for level in Level::available() {
            check(format!("{level:?}"), Options { level: Some(level), ..options(integrator) });
        }
        let shuffle = Some(5);
        check("shuffled".into(), Options { shuffle, threads: 2, ..options(integrator) });
    }
}

#[test]
fn another_seed_is_another_noise_of_the_same_picture() {
    let scene = varied();
    let go = |seed| picture(&scene, &Options { seed, samples: 64, ..quick(Integrator::Path, 64) });
    let (a, b) = (go(1).picture, go(2).picture);
    assert_ne!(bits(&a), bits(&b));
    assert!((mean(&a) - mean(&b)).abs() < 0.02 * mean(&a), "{} {}", mean(&a), mean(&b));
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let scene = varied();
    for filter in [Filter::Gaussian, Filter::Corners] {
        let whole = Options { filter, samples: 1, ..options(Integrator::Path) };
        let crop = Some(Crop { from: [13, 8], to: [60, 43] });
        let part = picture(&scene, &Options { crop, ..whole.clone() }).picture;
        let whole = picture(&scene, &whole).picture;
        assert_eq!((part.width, part.height), (47, 35));
        for (x, y) in [(0, 0), (46, 34), (20, 11)] {
            assert_eq!(pixel(&part, "", x, y), pixel(&whole, "", x + 13, y + 8));
            assert_eq!(pixel(&part, "depth", x, y), pixel(&whole, "depth", x + 13, y + 8));
        }
    }
}

#[test]
fn samples_in_two_parts_are_those_of_one() {
    let scene = varied();
    let go = |first_sample, samples| {
        let filter = Filter::Box;
        picture(&scene, &Options { first_sample, samples, filter, ..options(Integrator::Path) })
            .picture
    };
    let (first, rest, all) = (go(0, 3), go(3, 5), go(0, 8));
    for (i, all) in all.layers[0].samples.iter().enumerate() {
        let parts = (first.layers[0].samples[i] * 3.0 + rest.layers[0].samples[i] * 5.0) / 8.0;
        assert!((parts - all).abs() <= 1e-5 * all.abs(), "{parts} {all}");
    }
}

/// Stops after so many samples.
struct Impatient(u64, Mutex<u64>);

impl Watch for Impatient {
    fn advanced(&self, done_samples: u64, total: u64, rays: u64) {
        assert!(done_samples <= total && rays >= done_samples);
        *self.1.lock().expect("nobody panicked") = done_samples;
    }
    fn stop(&self) -> bool {
        *self.1.lock().expect("nobody panicked") >= self.0
    }
}

#[test]
fn a_stopped_render_gives_back_what_is_done() {
    let scene = varied();
    let world = world(&scene);
    let options = options(Integrator::Path);
    let whole = picture(&scene, &options);
    assert!(whole.complete);
    let watch = Impatient(2000, Mutex::new(0));
    let part = render(&scene, &*world, &options, &watch).expect("it can be rendered");
    assert!(!part.complete);
    let done = (0..70 * 45)
        .filter(|i| {
            part.picture.layers[0].samples[3 * i..3 * i + 3]
                == whole.picture.layers[0].samples[3 * i..3 * i + 3]
        })
        .count();
    assert!((600..2000).contains(&done), "{done} pixels are as they should be");
    assert_eq!(pixel(&part.picture, "", 69, 44), [0.0; 3], "the last are not there");
    let never = Impatient(0, Mutex::new(0));
    assert_eq!(render(&scene, &*world, &options, &never).expect("it can be").rays.total().cast, 0);
}

#[test]
fn layers_tell_what_is_seen_first() {
    let mut scene = empty();
    let red = Material { base_color: [0.8, 0.1, 0.2], ..Material::default() };
    add(&mut scene, sphere([9.0, 9.0, 9.0], 0.1), chalk(0.5));
    add(&mut scene, floor(1.0, 0.5), red);
    for integrator in all() {
        let picture = picture(&scene, &quick(integrator, 4)).picture;
        assert_eq!(pixel(&picture, "geometry", 12, 9), [1.0]);
        assert_eq!(pixel(&picture, "geometry", 0, 0), [-1.0]);
        assert!((pixel(&picture, "depth", 12, 9)[0] - 4.0).abs() < 0.05);
        assert_eq!(pixel(&picture, "depth", 0, 0), [f32::INFINITY]);
        assert_eq!(pixel(&picture, "normal", 12, 9), [0.0, 0.0, 1.0]);
        assert_eq!(pixel(&picture, "albedo", 12, 9), [0.8, 0.1, 0.2]);
    }
}

#[test]
fn counted_work_is_in_the_picture_and_in_the_sum() {
    let scene = varied();
    let rendered = picture(&scene, &quick(Integrator::Cost, 1));
    let total = rendered.counters.total();
    let layer = layer(&rendered.picture, "cost");
    let sum: f64 = layer.samples.iter().map(|&x| f64::from(x)).sum();
    assert_eq!(sum as u64, total.all_steps() + total.all_tests());
    assert!(sum > 0.0 && rendered.rays.camera.cast == 24 * 18);
}

#[test]
fn nasty_scenes_give_numbers() {
    let mut scene = varied();
    let glow = scene.add_material(lamp(1e30));
    let point = Vec3A::new(0.5, 0.5, 0.5);
    let flat = [[point; 3], [point, point + Vec3A::X, point + Vec3A::X * 2.0], [Vec3A::NAN; 3]];
    scene.add(Geometry::mesh("no area", glow, Triangles::from_corners(&flat)));
    let corners = vec![[-3.0, -3.0, -1.0], [3.0, -3.0, -1.0], [0.0, 3.0, -1.0]];
    let normals = vec![[0.0; 3], [f32::NAN; 3], [0.0, 0.0, -1.0]];
    let mesh = Triangles::new(corners, vec![[0, 1, 2]]).and_then(|t| t.with_normals(normals));
    let odd = scene.add_material(Material {
        ior: f32::NAN,
        roughness: f32::NAN,
        transmission: 0.5,
        metallic: 7.0,
        base_color: [f32::INFINITY, -1.0, f32::NAN],
        ..Material::default()
    });
    scene.add(Geometry::mesh("odd normals", odd, mesh.expect("as many as vertices")));
    add(&mut scene, sphere([0.0; 3], 0.0), lamp(f32::INFINITY));
    add(&mut scene, sphere([0.0, 0.0, 5.0], 1e-3), lamp(f32::NAN));
    scene.lights.push(Light::point(Vec3A::NAN, [1.0; 3]));
    scene.lights.push(Light::point(Vec3A::ZERO, [f32::NAN, f32::INFINITY, -1.0]));
    for integrator in all() {
        let picture = picture(&scene, &quick(integrator, 4)).picture;
        for layer in picture.layers.iter().filter(|layer| layer.name != "depth") {
            let all = layer.samples.iter().all(|x| x.is_finite());
            assert!(all, "{integrator:?} {}", layer.name);
        }
    }
}

#[test]
fn a_glowing_solid_gives_as_much_light_as_the_shape_it_is() {
    let scene = |solid: bool| {
        let mut scene = empty();
        add(&mut scene, floor(-0.6, 3.0), chalk(0.8));
        let lamp = scene.add_material(lamp(2.0));
        let ball = sphere([0.0, 0.0, 0.2], 0.7);
        if !solid {
            scene.add(Geometry::shapes("", lamp, vec![ball.into()]));
            return scene;
        }
        let (ball, around) = (Operand::shape(ball), Operand::shape(sphere([0.0; 3], 2.0)));
        let both =
            Solid::new(Operation::Intersection, ball.expect("closed"), around.expect("closed"));
        scene.add(Geometry::solids("", lamp, vec![both.expect("not deep")]));
        scene
    };
    for integrator in all() {
        let seen = |solid| mean(&picture(&scene(solid), &quick(integrator, 256)).picture);
        let (shape, solid) = (seen(false), seen(true));
        assert!((shape - solid).abs() <= 0.02 * shape, "{integrator:?}: {shape} {solid}");
    }
}

#[test]
fn a_scene_whose_parts_do_not_fit_together_is_refused() {
    let whole = varied();
    let refused = |change: fn(&mut Scene), expected: &str| {
        let mut scene = whole.clone();
        change(&mut scene);
        let error = render(&scene, &*world(&whole), &options(Integrator::Path), &Unwatched);
        assert_eq!(error.expect_err(expected).to_string(), expected);
    };
    refused(
        |scene| scene.geometries[1].material = 99,
        "scene: geometries[1].material: there is no material 99",
    );
    refused(
        |scene| scene.materials[0].base_texture = Some(3),
        "scene: materials[0].base_texture: there is no texture 3",
    );
    refused(|scene| scene.root = 5, "scene: root: there is no group 5");
}

#[test]
fn options_without_sense_are_refused_by_name() {
    let scene = varied();
    let good = options(Integrator::Path);
    let crop = Some(Crop { from: [3, 3], to: [3, 9] });
    let full = Integrator::Whitted(WhittedOptions { tree: Tree::Full });
    let radius = Integrator::AmbientOcclusion { radius: Some(f32::NAN) };
    for (options, name) in [
        (Options { resolution: [0, 5], ..good.clone() }, "resolution: 0 x 5"),
        (Options { resolution: [65_537, 1], ..good.clone() }, "resolution: 65537 x 1"),
        (Options { resolution: [65_536, 65_536], ..good.clone() }, "more than 268435456 pixels"),
        (Options { crop, ..good.clone() }, "crop: from 3,3 to 3,9"),
        (Options { samples: 0, ..good.clone() }, "samples: 0"),
        (Options { first_sample: u32::MAX, ..good.clone() }, "samples: 3"),
        (Options { filter: Filter::Corners, ..good.clone() }, "corners of pixels take 1"),
        (Options { wave: 0, ..good.clone() }, "wave"),
        (Options { max_depth: 0, ..good.clone() }, "max_depth: 0"),
        (Options { max_depth: 40, integrator: full, ..good.clone() }, "1 to 12"),
        (Options { clamp: Some(0.0), ..good.clone() }, "clamp: 0"),
        (Options { camera: 1, ..good.clone() }, "camera: number 1 of 1"),
        (Options { integrator: radius, ..good.clone() }, "radius: NaN"),
    ] {
        let error = render(&scene, &*world(&scene), &options, &Unwatched).expect_err(name);
        let text = error.to_string();
        assert!(text.contains(name) && !text.contains('\n'), "{text}");
    }
}
