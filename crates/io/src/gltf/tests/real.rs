//! Real files, held against the counts that another reader made of them.

use std::path::PathBuf;

use nestray_scene::camera::Projection;
use nestray_scene::group::Motion;
use nestray_scene::paths::Paths;

use super::triangles;
use crate::load::{LoadOptions, Loaded, load};

/// A file of the shared scenes; none, and a word about it, if they are not here.
fn shared(name: &str) -> Option<Loaded> {
    let folder = std::env::var_os("NESTRAY_SCENES").map_or_else(
        || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/scenes")),
        PathBuf::from,
    );
    let path = folder.join("gltf").join(name);
    if !path.exists() {
        eprintln!("{} is not there: nothing is tested", path.display());
        return None;
    }
    let options = LoadOptions { complete: false, ..LoadOptions::default() };
    let loaded = load(&path, &options).unwrap_or_else(|error| panic!("{error}"));
    Paths::new(&loaded.scene).expect("no cycles");
    assert!(!loaded.scene.bounds().is_empty(), "{name}");
    Some(loaded)
}

#[test]
fn the_counts_are_those_of_the_catalogue() {
    // Name, instances of primitives, triangles each counted once, materials, textures.
    let files = [
        ("Duck.glb", 1, 4_212, 1, 1),
        ("CesiumMilkTruck.glb", 5, 2_856, 4, 2),
        ("BoxAnimated.glb", 2, 254, 2, 0),
        ("DamagedHelmet.glb", 1, 15_452, 1, 4),
        ("AnimatedMorphCube.glb", 1, 12, 1, 0),
        ("RiggedSimple.glb", 1, 188, 1, 0),
        ("CesiumMan.glb", 1, 4_672, 1, 1),
        ("BoxInterleaved.glb", 1, 12, 1, 0),
        ("BoxVertexColors.glb", 1, 12, 1, 0),
        ("SimpleMeshes.gltf", 2, 1, 1, 0),
        ("SimpleSparseAccessor.gltf", 1, 12, 1, 0),
        ("Cameras.gltf", 1, 2, 1, 0),
        ("TriangleWithoutIndices.gltf", 1, 1, 1, 0),
        ("many-cubes.gltf", 501, 6_012, 1, 0),
        // Of nine textures one is for ambient occlusion, which is not read.
        ("AlphaBlendModeTest.glb", 9, 61, 6, 8),
        ("Suzanne/Suzanne.gltf", 1, 3_936, 1, 2),
    ];
    for (name, instances, faces, materials, textures) in files {
        let Some(Loaded { scene, warnings }) = shared(name) else { continue };
        let places = scene.groups[scene.root].places.iter();
        let found = (
            places.map(|place| scene.groups[place.group].geometries.len()).sum(),
            triangles(&scene),
            scene.materials.len(),
            scene.textures.len(),
        );
        let expected: (usize, usize, usize, usize) = (instances, faces, materials, textures);
        assert_eq!(found, expected, "{name}");
        for warning in warnings {
            eprintln!("{warning}");
        }
    }
}

#[test]
fn wheels_of_a_truck_are_one_group_that_turns_in_two_places() {
    let Some(Loaded { scene, .. }) = shared("CesiumMilkTruck.glb") else { return };
    let places = &scene.groups[scene.root].places;
    let wheels: Vec<_> =
        places.iter().filter(|place| scene.groups[place.group].name == "Wheels").collect();
    assert_eq!(wheels.len(), 2);
    assert_eq!(wheels[0].group, wheels[1].group);
    let Motion::Node(node) = wheels[0].motion else { panic!("it turns") };
    let end = scene.animation.duration();
    assert!(end > 1.0);
    let at = |time: f32| scene.animation.world_from_node(node, time).matrix3;
    assert!(!at(0.0).abs_diff_eq(at(end * 0.3), 0.1));
    // As the last key has it, and the nodes above, which only move it.
    assert!(at(end).abs_diff_eq(glam::Mat3A::IDENTITY, 1e-6));
    let rest = scene.animation.world_from_node(node, 0.0).translation;
    assert!(rest.abs_diff_eq(glam::vec3a(1.432_67, 0.427_722, 0.0), 1e-5), "{rest}");
    let frame = scene.frame(0.3 * end, 0.02);
    assert!(frame.groups[frame.root].places.iter().any(|p| matches!(p.motion, Motion::Keys(_))));
}

#[test]
fn a_skinned_man_stands_on_his_feet() {
    let Some(Loaded { scene, warnings }) = shared("CesiumMan.glb") else { return };
    let bounds = scene.bounds();
    let size = bounds.max - bounds.min;
    assert!(size.y > 1.3 && size.y < 1.7 && size.x < 1.3 && size.z < 1.3, "{bounds:?}");
    assert!(bounds.min.y.abs() < 0.05, "{bounds:?}");
    assert!(warnings.iter().any(|w| w.message.contains("skin `Armature` does not move")));
    let Some(Loaded { warnings, .. }) = shared("AnimatedMorphCube.glb") else { return };
    let told = "morph targets of `AnimatedMorphCube` do not move";
    assert!(warnings.iter().any(|w| w.message.contains(told)), "{warnings:?}");
}

#[test]
fn cameras_come_along() {
    let Some(Loaded { scene, .. }) = shared("Cameras.gltf") else { return };
    assert_eq!(scene.cameras.len(), 2);
    assert_eq!(scene.cameras[0].from.to_array(), [0.5, 0.5, 3.0]);
    assert_eq!(scene.cameras[0].forward.to_array(), [0.0, 0.0, -1.0]);
    let Projection::Perspective { degrees } = scene.cameras[0].projection else { panic!() };
    assert!((degrees - 0.7f32.to_degrees()).abs() < 1e-4);
    assert_eq!(scene.cameras[1].projection, Projection::Orthographic { height: 2.0 });
}

#[test]
fn vertex_colours_and_bounds_of_a_duck_are_right() {
    if let Some(Loaded { scene, .. }) = shared("BoxVertexColors.glb") {
        assert_eq!(super::mesh(&scene, 0).colors().len(), super::mesh(&scene, 0).positions().len());
    }
    let Some(Loaded { scene, .. }) = shared("Duck.glb") else { return };
    let bounds = scene.bounds();
    let expected = [[-0.692_985, 0.099_293_7, -0.613_282], [0.961_799, 1.639_7, 0.539_252]];
    assert!(bounds.min.abs_diff_eq(expected[0].into(), 1e-4), "{bounds:?}");
    assert!(bounds.max.abs_diff_eq(expected[1].into(), 1e-4), "{bounds:?}");
}
