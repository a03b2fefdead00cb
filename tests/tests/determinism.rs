//! The same scene and options give the same picture to the bit: for any number of threads,
//! order of tiles, size of batches, and vector instructions.

use glam::{Affine3A, Quat, Vec3, Vec3A};
use nestray_core::moving::Keys;
use nestray_core::scratch::Scratch;
use nestray_core::simd::Level;
use nestray_registry::TECHNIQUES;
use nestray_render::options::{Integrator, Options};
use nestray_scene::geometry::Geometry;
use nestray_scene::group::{Group, Motion};
use nestray_scene::procedural::generate;
use nestray_scene::scene::Scene;
use nestray_shapes::torus::Torus;
use nestray_tests::numbers::Numbers;
use nestray_tests::pictures::{Subject, whitted};
use nestray_tests::scene_files::{files, name, scene};

/// Pictures of each scene by each integrator; `NESTRAY_PICTURES` asks for another number.
fn pictures() -> u64 {
    std::env::var("NESTRAY_PICTURES").ok().and_then(|n| n.parse().ok()).unwrap_or(24)
}

/// One of every kind of shape, without end, in a mesh, and some that turn or stand elsewhere.
fn mixed() -> Scene {
    let mut scene = generate("mixed", None).expect("it is a scene of ours");
    let material = scene.materials.len() - 1;
    let ring = Torus { center: Vec3A::ZERO, axis: Vec3A::ONE, major: 0.8, minor: 0.3 };
    let ring = scene.add_apart(Geometry::shapes("ring", material, vec![ring.into()]));
    let group = scene.add_group(Group { geometries: vec![ring], ..Group::default() });
    let at = |x: f32, turn: f32| {
        let translation = Vec3::new(x, -2.0, 1.5);
        Affine3A::from_rotation_translation(Quat::from_rotation_y(turn), translation)
    };
    let keys = Keys::new(vec![(0.0, at(-1.0, 0.0)), (0.6, at(0.5, 0.7)), (1.0, at(1.0, 1.2))]);
    scene.place(group, Motion::Keys(keys.expect("times ascend")));
    scene.place(group, Motion::Still(at(-3.0, 2.0)));
    scene
}

fn by(integrator: Integrator) -> Options {
    match integrator {
        Integrator::Path => Options {
            integrator,
            resolution: [43, 37],
            samples: 2,
            threads: 1,
            ..Options::default()
        },
        _ => Options { integrator, resolution: [70, 45], threads: 1, ..whitted(1) },
    }
}

/// Renders the subject in ways that must not matter: each of them alone, then mixed at random.
fn assert_nothing_shows(subject: &Subject) {
    let whitted = whitted(1).integrator;
    for integrator in [Integrator::Path, whitted] {
        let usual = by(integrator);
        let worlds: Vec<_> = TECHNIQUES.iter().map(|entry| subject.world(entry.name)).collect();
        let expected = subject.print(&*worlds[1], &usual);
        assert!(expected.shows_something(), "{}: there is nothing to see", subject.name());
        for (number, options) in ways(&usual).into_iter().enumerate() {
            // Lists are slow in large scenes, and have nothing of their own here.
            let world = &worlds[1 + number % (worlds.len() - 1)];
            let found = subject.print(&**world, &options);
            let Options { threads, wave, shuffle, level, .. } = options;
            assert!(
                expected == found,
                "{}, {integrator:?}, way {number} with {threads} threads, batches of {wave}, \
                 order {shuffle:?}, {level:?}: {}",
                subject.name(),
                expected.difference(&found)
            );
        }
    }
}

/// Every number of threads, some sizes of batches and every level alone; then any together.
fn ways(usual: &Options) -> Vec<Options> {
    const THREADS: [usize; 4] = [1, 2, 3, 7];
    const WAVES: [usize; 8] = [1, 2, 7, 8, 63, 1000, 4095, 4096];
    let levels: Vec<Level> =
        Level::available().into_iter().chain([Scratch::counting().level]).collect();
    let mut ways = Vec::new();
    ways.extend(THREADS.map(|threads| Options { threads, ..usual.clone() }));
    ways.extend(WAVES.map(|wave| Options { wave, ..usual.clone() }));
    ways.extend(levels.iter().map(|&level| Options { level: Some(level), ..usual.clone() }));
    for seed in ways.len() as u64..pictures() {
        let mut numbers = Numbers::new(seed);
        ways.push(Options {
            threads: *numbers.pick(&THREADS),
            // Every size there is, if many pictures are asked for.
            wave: (seed * 2531 % 4096) as usize + 1,
            level: Some(*numbers.pick(&levels)),
            shuffle: Some(seed),
            ..usual.clone()
        });
    }
    ways
}

#[test]
fn every_kind_of_shape_also_moving_is_the_same_picture_always() {
    assert_nothing_shows(&Subject::new("mixed", &mixed()));
}

#[test]
fn instances_glass_and_lamps_are_the_same_picture_always() {
    for (scene, size) in [("stadium", 10), ("demo", 1)] {
        let made = generate(scene, Some(size)).expect("it is a scene of ours");
        assert_nothing_shows(&Subject::new(scene, &made));
    }
}

#[test]
fn files_with_textures_and_animations_are_the_same_picture_always() {
    let wanted = ["CesiumMilkTruck.glb", "BoxAnimated.glb", "AlphaBlendModeTest.glb"];
    for path in files("gltf", &["glb"], 2_000_000) {
        if wanted.contains(&&*name(&path)) {
            assert_nothing_shows(&Subject::new(name(&path), &scene(&path)));
        }
    }
}
