//! Small documents, each about one thing.

use glam::{Vec3A, vec3a};
use nestray_scene::group::Motion;
use nestray_scene::light::LightKind;
use nestray_scene::material::AlphaMode;

use super::broken::binary;
use super::{bytes, mesh, text, triangles};

/// A document of one primitive: places in floats or something shorter, indices.
pub(super) fn plain(places: &str, indices: &str, mode: u32) -> String {
    format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],"meshes":[{{"primitives":[
{{"attributes":{{"POSITION":0}},"indices":1,"mode":{mode}}}]}}],"accessors":[
{{"bufferView":0,"componentType":{places},"count":4,"type":"VEC3","normalized":true}},
{{"bufferView":1,"componentType":{indices},"count":4,"type":"SCALAR"}}],"bufferViews":[
{{"buffer":0,"byteLength":48}},{{"buffer":0,"byteOffset":48,"byteLength":16}}],"buffers":[{{}}]}}"#
    )
}

fn inside(places: &[u8], indices: &[u8]) -> Vec<u8> {
    let mut inside = places.to_vec();
    inside.resize(48, 0);
    inside.extend(indices);
    inside.resize(64, 0);
    inside
}

#[test]
fn strips_and_fans_turn_all_their_faces_the_same_way() {
    for (mode, faces) in [(5, [[0, 1, 2], [1, 3, 2]]), (6, [[1, 2, 0], [2, 3, 0]])] {
        let file = binary(&plain("5126", "5121", mode), &inside(&[], &[0, 1, 2, 3]));
        let loaded = bytes(&file).expect("sound");
        assert_eq!(mesh(&loaded.scene, 0).faces(), faces);
    }
    let lines = binary(&plain("5126", "5121", 1), &inside(&[], &[0, 1, 2, 3]));
    let loaded = bytes(&lines).expect("sound");
    assert_eq!(triangles(&loaded.scene), 0);
    assert_eq!(loaded.warnings[0].message, "points and lines are left out");
}

#[test]
fn short_numbers_stand_for_fractions() {
    let places = [127u8, 0, 128, 0, 0, 64, 1, 2, 3, 4, 5, 6];
    let file = binary(&plain("5120", "5121", 4), &inside(&places, &[0, 1, 2, 3]));
    let loaded = bytes(&file).expect("sound");
    assert_eq!(mesh(&loaded.scene, 0).positions()[0], [1.0, 0.0, -1.0]);
    assert_eq!(mesh(&loaded.scene, 0).positions()[1], [0.0, 0.0, 64.0 / 127.0]);
}

#[test]
fn only_vertices_in_use_are_kept_and_an_index_out_of_range_is_named() {
    let file = |last: u8| binary(&plain("5126", "5121", 4), &inside(&[], &[1, 3, 3, last]));
    let loaded = bytes(&file(0)).expect("sound");
    assert_eq!(mesh(&loaded.scene, 0).positions().len(), 2);
    assert_eq!(mesh(&loaded.scene, 0).faces(), [[0, 1, 1]]);
    let error = bytes(&file(4)).expect_err("no such vertex").to_string();
    let expected = "made.glb: meshes[0].primitives[0]: indices name vertex 4, but there are 4";
    assert_eq!(error, expected);
}

#[test]
fn a_child_stands_on_its_parent_and_cycles_are_refused() {
    let nodes = |last: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[
{{"translation":[1,0,0],"scale":[2,2,2],"children":[1]}},{{"camera":0,"translation":[0,1,0]{last}}}],
"cameras":[{{"perspective":{{"yfov":1}}}}]}}"#
        )
    };
    let loaded = text(&nodes("")).expect("sound");
    assert_eq!(loaded.scene.cameras[0].from, vec3a(1.0, 2.0, 0.0));
    for cycle in [r#","children":[0]"#, r#","children":[1]"#] {
        let error = text(&nodes(cycle)).expect_err("a cycle").to_string();
        assert!(error.contains("stands in itself"), "{error}");
    }
    let error = text(&nodes(r#","children":[7]"#)).expect_err("no such node").to_string();
    assert!(error.contains("there is no nodes[7]"), "{error}");
}

#[test]
fn lights_shine_along_their_nodes() {
    let json = r#"{"asset":{"version":"2.0"},"nodes":[{"translation":[0,3,0],
"rotation":[-0.70710678,0,0,0.70710678],"extensions":{"KHR_lights_punctual":{"light":0}}}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":10,"color":[1,0.5,0],
"spot":{"innerConeAngle":0,"outerConeAngle":1}}]}}}"#;
    let light = &text(json).expect("sound").scene.lights[0];
    assert_eq!(light.color, [10.0, 5.0, 0.0]);
    let LightKind::Spot { position, direction, cos_inner, cos_outer } = light.kind else {
        panic!("a spot")
    };
    assert_eq!((position, cos_inner), (vec3a(0.0, 3.0, 0.0), 1.0));
    assert!(direction.abs_diff_eq(Vec3A::NEG_Y, 1e-6), "{direction}");
    assert!((cos_outer - 1f32.cos()).abs() < 1e-6);
}

#[test]
fn materials_say_what_the_file_says() {
    let material = |fields: &str| {
        let json = plain("5126", "5121", 4)
            .replace(r#""mode""#, r#""material":0,"mode""#)
            .replacen('{', &format!(r#"{{"materials":[{{{fields}}}],"#), 1);
        let loaded = bytes(&binary(&json, &inside(&[], &[0, 1, 2, 3]))).expect("sound");
        loaded.scene.materials[0].clone()
    };
    let glass = material(
        r#""alphaMode":"MASK","alphaCutoff":0.25,"extensions":{"KHR_materials_ior":{"ior":1.3},
"KHR_materials_transmission":{"transmissionFactor":0.9},
"KHR_materials_emissive_strength":{"emissiveStrength":5}},"emissiveFactor":[1,0,2]"#,
    );
    assert_eq!((glass.ior, glass.transmission), (1.3, 0.9));
    assert_eq!((glass.metallic, glass.roughness), (1.0, 1.0));
    assert_eq!(glass.emission, [5.0, 0.0, 10.0]);
    assert_eq!(glass.alpha_mode, AlphaMode::Mask(0.25));
    let unlit = material(
        r#""pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]},
"extensions":{"KHR_materials_unlit":{}}"#,
    );
    assert_eq!((unlit.emission, unlit.base_color), ([1.0, 0.5, 0.0], [0.0; 3]));
}

#[test]
fn instances_of_the_extension_stand_in_a_group_of_their_own() {
    let loaded = bytes(&super::broken::rich()).expect("sound");
    let scene = &loaded.scene;
    let place = &scene.groups[scene.root].places[1];
    assert!(matches!(place.motion, Motion::Node(1)), "it hangs on a node that moves");
    let group = &scene.groups[place.group];
    assert_eq!((group.places.len(), group.geometries.len()), (2, 0));
    let Motion::Still(second) = group.places[1].motion else { panic!("still") };
    assert_eq!(second.translation, vec3a(2.0, 0.0, 0.0));
}

#[test]
fn what_is_not_read_is_told_by_name() {
    let json = |extra: &str| format!(r#"{{"asset":{{"version":"2.0"}},{extra}}}"#);
    let loaded = text(&json(
        r#""extensionsUsed":["KHR_a","KHR_b","KHR_materials_ior"],"extensionsRequired":["KHR_b"]"#,
    ));
    let told: Vec<String> =
        loaded.expect("survived").warnings.into_iter().map(|w| w.message).collect();
    assert_eq!(
        told,
        [
            "extension KHR_b is required, but not read: it may look wrong",
            "extension KHR_a is not read"
        ]
    );
    let draco = json(
        r#""nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},
"extensions":{"KHR_draco_mesh_compression":{"bufferView":0}}}]}],
"accessors":[{"componentType":5126,"count":4,"type":"VEC3"}]"#,
    );
    let error = text(&draco).expect_err("packed").to_string();
    assert!(error.contains("needs KHR_draco_mesh_compression, which is not read"), "{error}");
    let error = text(r#"{"asset":{"version":"1.0"}}"#).expect_err("old").to_string();
    assert_eq!(error, "made.glb: is glTF 1.0; 2.0 is read");
    let error = text("{\"asset\":{\"version\":\"2.0\"},\n \"nodes\":[{\"mesh\":-1}]}");
    let error = error.expect_err("negative").to_string();
    assert!(error.starts_with("made.glb:2:20: invalid value"), "{error}");
}
