//! Broken files: an error or a scene, never a panic, and never more than the bytes can mean.

use super::{bytes, text, triangles};

/// A small file with all that a reader can stumble over: an animation, a skin, morph targets,
/// sparse accessors, a camera, a light, a texture.
pub(super) fn rich() -> Vec<u8> {
    let mut inside: Vec<u8> = Vec::new();
    let floats = |inside: &mut Vec<u8>, values: &[f32]| {
        values.iter().for_each(|x| inside.extend(x.to_le_bytes()));
    };
    // 0: four places, 48 bytes. 48: indices, 8 bytes. 56: joints, 16 bytes. 72: weights, 64 bytes.
    floats(&mut inside, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    inside.extend([0, 1, 2, 2, 1, 3, 0, 0]);
    inside.extend([0, 0, 0, 0].repeat(4));
    floats(&mut inside, &[1.0, 0.0, 0.0, 0.0].repeat(4));
    // 136: times, 8 bytes. 144: moves, 24 bytes. 168: a sparse index, 4 bytes, and 172: a value.
    floats(&mut inside, &[0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0]);
    inside.extend([3, 0, 0, 0]);
    floats(&mut inside, &[0.0, 0.0, 5.0]);
    let json = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1,2]}],
"nodes":[{"mesh":0,"children":[3],"weights":[0.5]},{"mesh":0,"skin":0,"scale":[1,2,1]},
{"camera":0,"rotation":[0,0,0,1],"extensions":{"KHR_lights_punctual":{"light":0}}},
{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,3,0,0,1],"extensions":{"EXT_mesh_gpu_instancing":
{"attributes":{"TRANSLATION":4}}}}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,"WEIGHTS_0":3},"indices":1,
"targets":[{"POSITION":5}],"material":0}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
{"bufferView":1,"componentType":5121,"count":6,"type":"SCALAR"},
{"bufferView":2,"componentType":5121,"count":4,"type":"VEC4"},
{"bufferView":3,"componentType":5126,"count":4,"type":"VEC4"},
{"bufferView":4,"byteOffset":8,"componentType":5126,"count":2,"type":"VEC3"},
{"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":5,
"componentType":5121},"values":{"bufferView":5,"byteOffset":4}}},
{"bufferView":4,"componentType":5126,"count":2,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":48,"byteStride":12},{"buffer":0,"byteOffset":48,
"byteLength":8},{"buffer":0,"byteOffset":56,"byteLength":16},{"buffer":0,"byteOffset":72,
"byteLength":64},{"buffer":0,"byteOffset":136,"byteLength":32},{"buffer":0,"byteOffset":168,
"byteLength":16}],"buffers":[{"byteLength":184}],
"skins":[{"joints":[0]}],"cameras":[{"type":"perspective","perspective":{"yfov":0.7}}],
"animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"translation"}}],
"samplers":[{"input":6,"output":4}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
"textures":[{"source":0}],"images":[{"uri":"data:,x"}],
"extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":4}]}}}"#;
    binary(json, &inside)
}

/// A GLB file.
pub(super) fn binary(json: &str, inside: &[u8]) -> Vec<u8> {
    let mut text = json.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut inside = inside.to_vec();
    inside.resize(inside.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + inside.len();
    let mut file = b"glTF".to_vec();
    let number = |file: &mut Vec<u8>, n: usize| file.extend((n as u32).to_le_bytes());
    number(&mut file, 2);
    number(&mut file, length);
    number(&mut file, text.len());
    file.extend(b"JSON");
    file.extend(&text);
    number(&mut file, inside.len());
    file.extend(b"BIN\0");
    file.extend(&inside);
    file
}

fn check(file: &[u8]) {
    match bytes(file) {
        Ok(loaded) => {
            assert!(triangles(&loaded.scene) <= 64 * file.len());
            // Walks over everything that refers to something else.
            let _ = loaded.scene.frame(0.5, 0.1).bounds();
            nestray_scene::paths::Paths::new(&loaded.scene).expect("no cycles");
            for geometry in &loaded.scene.geometries {
                assert!(geometry.material < loaded.scene.materials.len());
            }
        }
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
}

#[test]
fn the_rich_file_itself_is_sound() {
    let loaded = bytes(&rich()).expect("sound");
    let scene = &loaded.scene;
    assert_eq!(scene.groups[scene.root].places.len(), 3);
    assert_eq!((scene.cameras.len(), scene.lights.len()), (1, 1));
    assert_eq!(scene.animation.duration(), 1.0);
    // The sparse target moves the last corner, half as far.
    assert_eq!(super::mesh(scene, 0).positions()[3], [1.0, 1.0, 2.5]);
    let told: Vec<String> = loaded.warnings.iter().map(|w| w.message.clone()).collect();
    assert!(told.iter().any(|t| t.contains("images[0] is left out")), "{told:?}");
}

#[test]
fn files_that_end_anywhere_are_refused_or_read() {
    let whole = rich();
    for end in 0..whole.len() {
        check(&whole[..end]);
    }
}

#[test]
fn mutants_never_panic() {
    const SEED: u64 = 20;
    eprintln!("seed {SEED}");
    let mut state = SEED;
    let mut random = move |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut read = 0;
    for small in [rich(), binary(&super::made::plain("5126", "5121", 4), &[1; 64])] {
        let digits: Vec<usize> = (0..small.len()).filter(|&i| small[i].is_ascii_digit()).collect();
        for _ in 0..10_000 {
            let mut file = small.clone();
            for _ in 0..1 + random(3) {
                match random(4) {
                    // Most mutants of the rest are no JSON: numbers are where it hurts.
                    0 | 1 => file[digits[random(digits.len())]] = b"0123456789-e"[random(12)],
                    2 => {
                        let at = random(small.len());
                        file[at] = random(256) as u8;
                    }
                    _ => {
                        let at = small.len() - 1 - random(180.min(small.len() - 1));
                        file[at] = random(256) as u8;
                    }
                }
            }
            read += usize::from(bytes(&file).is_ok());
            check(&file);
        }
    }
    eprintln!("{read} of 20000 mutants are sound");
    assert!(read > 1_000, "mutants should get past the JSON: {read}");
}

#[test]
fn promises_of_endless_data_are_refused() {
    let huge = 9_007_199_254_740_991u64;
    for count in [huge, u64::from(u32::MAX), 1 << 24] {
        let zeros = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
"accessors":[{{"componentType":5126,"count":{count},"type":"VEC3"}}]}}"#
        );
        let error = text(&zeros).expect_err("too many").to_string();
        assert!(error.contains("far"), "{error}");
    }
    let deep = format!("{{\"asset\":{}1{}}}", "[".repeat(100_000), "]".repeat(100_000));
    text(&deep).expect_err("too deep");
}

#[test]
fn sharing_cannot_make_a_small_file_huge() {
    let view = |i: usize| format!(r#"{{"buffer":0,"byteOffset":{i},"byteLength":12000}}"#);
    let accessor = |i: usize| {
        format!(r#"{{"bufferView":{i},"componentType":5126,"count":1000,"type":"VEC3"}}"#)
    };
    let primitive = |i: usize| format!(r#"{{"attributes":{{"POSITION":{i}}}}}"#);
    let list = |item: &dyn Fn(usize) -> String| (0..400).map(item).collect::<Vec<_>>().join(",");
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{}]}}],"accessors":[{}],"bufferViews":[{}],"buffers":[{{}}]}}"#,
        list(&primitive),
        list(&accessor),
        list(&view)
    );
    check(&binary(&json, &[0; 12_400]));
    let error = bytes(&binary(&json.replace("5126", "5121"), &[0; 12_400])).err();
    assert!(error.is_none_or(|error| error.to_string().contains("far more data")));
}
