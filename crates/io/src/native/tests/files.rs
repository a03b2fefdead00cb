//! Scenes that take geometry from other files.

use std::fs;

use super::*;

const OFF: &str = "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n3 0 1 2\n3 2 1 3\n";

#[test]
fn a_geometry_can_be_that_of_a_file_and_has_its_own_material() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("square.off"), OFF).expect("writable");
    let json = r#"{"nestray_scene":1,"materials":[{},{"roughness":0.5}],
"geometries":[{"file":"square.off","material":1},{"shapes":[{"sphere":{"center":[0,0,0],"radius":1}}]}]}"#;
    let scene = text(json, folder.path()).expect("sound").scene;
    assert_eq!(scene.geometries.len(), 2);
    assert_eq!((scene.geometries[0].primitives(), scene.geometries[0].material), (2, 1));
    assert_eq!(scene.groups[0].geometries, [0, 1]);
    let missing = json.replace("square", "circle");
    let error = text(&missing, folder.path()).expect_err("no such file").to_string();
    assert!(error.contains("geometries[0].file: ") && error.contains("circle.off"), "{error}");
}

#[test]
fn a_group_can_take_a_whole_file_and_many_can_take_the_same() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("square.off"), OFF).expect("writable");
    let inner = r#"{"nestray_scene":1,"materials":[{"name":"inner"}],"animation":[{}],
"groups":[{"places":[{"group":1,"motion":{"node":0}}]},{"file":"square.off"}]}"#;
    fs::write(folder.path().join("inner.json"), inner).expect("writable");
    let json = r#"{"nestray_scene":1,"animation":[{"rest":{"translate":[1,0,0]}}],
"groups":[{"places":[{"group":1},{"group":2,"motion":{"still":{"translate":[5,0,0]}}}]},
{"file":"inner.json"},{"file":"inner.json"}]}"#;
    let scene = text(json, folder.path()).expect("sound").scene;
    assert_eq!(scene.primitives(), 4);
    assert_eq!(scene.geometries.len(), 1);
    assert_eq!(scene.animation.nodes.len(), 2);
    let bounds = scene.bounds();
    assert_eq!((bounds.min.x, bounds.max.x), (0.0, 6.0));
}

#[test]
fn files_that_take_from_themselves_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let naming = |name: &str| format!(r#"{{"nestray_scene":1,"groups":[{{"file":"{name}"}}]}}"#);
    fs::write(folder.path().join("scene.json"), naming("other.json")).expect("writable");
    fs::write(folder.path().join("other.json"), naming("scene.json")).expect("writable");
    let error = text(&naming("other.json"), folder.path()).expect_err("a cycle").to_string();
    assert!(error.contains("scene.json takes its geometry from itself"), "{error}");
    let error = text(&naming("scene.json"), folder.path()).expect_err("a cycle").to_string();
    assert!(error.contains("scene.json takes its geometry from itself"), "{error}");
}

#[test]
fn a_missing_image_is_white_and_a_warning() {
    let json = r#"{"nestray_scene":1,"images":[{"file":"none.png"}],"textures":[{"image":0}]}"#;
    let loaded = alone(json).expect("survived");
    assert_eq!(loaded.scene.textures[0].sample([0.5, 0.5]), [1.0; 4]);
    assert!(loaded.warnings[0].message.contains("none.png"), "{:?}", loaded.warnings);
}

#[test]
fn a_scene_of_a_few_lines_is_enough() {
    let json = r#"{"nestray_scene": 1, "$schema": "scene.schema.json",
  "geometries": [{"shapes": [{"sphere": {"center": [0, 0, 0], "radius": 1}}]}],
  "cameras": [{"from": [0, 2, 5], "at": [0, 0, 0]}],
  "groups": [{"places": [{"group": 1, "motion": {"still": {"rotate": {"axis": [0, 0, 1], "degrees": 90},
    "translate": [2, 0, 0]}}}]}, {"geometries": [0]}]}"#;
    let scene = alone(json).expect("sound").scene;
    assert_eq!(scene.primitives(), 1);
    let bounds = scene.bounds();
    assert!(bounds.max.abs_diff_eq(glam::vec3a(3.0, 1.0, 1.0), 1e-5), "{bounds:?}");
}
