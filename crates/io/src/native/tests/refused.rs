//! What is refused, and how it is told.

use super::*;

/// The message for a document with these fields, without the name of the file.
fn message(fields: &str) -> String {
    let json = format!("{{\"nestray_scene\": 1,\n{fields}}}");
    let text = alone(&json).expect_err(fields).to_string();
    text.strip_prefix("nowhere/scene.json:").expect("the file is named").trim().to_owned()
}

#[test]
fn errors_of_form_have_a_line_and_a_column() {
    assert!(message("\"geometry\": []").starts_with("2:10: unknown field `geometry`"));
    assert!(message("\"ambient\": [1, 2]").starts_with("2:17: invalid length 2"));
    assert!(message("\"root\": -1").starts_with("2:10: invalid value: integer `-1`"));
    assert!(message("\"root\": 0,").starts_with("2:11: trailing comma"));
    let shape = message("\"geometries\": [{\"shapes\": [{\"ball\": {}}]}]");
    assert!(shape.contains("unknown variant `ball`, expected one of `sphere`"), "{shape}");
    let error = alone("{}").expect_err("no version").to_string();
    assert_eq!(error, "nowhere/scene.json:1:2: missing field `nestray_scene`");
}

#[test]
fn errors_of_sense_have_a_path() {
    for (fields, expected) in [
        (
            r#""groups":[{},{},{},{"places":[{"group":7}]}]"#,
            "groups[3].places[0].group: there is no group 7",
        ),
        (r#""groups":[{"geometries":[0]}]"#, "groups[0].geometries[0]: there is no geometry 0"),
        (r#""root":1"#, "root: there is no group 1"),
        (r#""geometries":[{}]"#, "geometries[0]: it needs one of mesh, shapes, solids and file"),
        (
            r#""geometries":[{"mesh":{"positions":[],"faces":[[0,1,2]]}}]"#,
            "geometries[0].mesh: face 0 names vertex 0, but there are 0",
        ),
        (
            r#""geometries":[{"shapes":[],"material":3}]"#,
            "geometries[0].material: there is no material 3",
        ),
        (
            r#""materials":[{"normal_texture":0}]"#,
            "materials[0].normal_texture: there is no texture 0",
        ),
        (r#""textures":[{"image":0}]"#, "textures[0].image: there is no image 0"),
        (
            r#""groups":[{"places":[{"group":0,"motion":{"still":{"matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0]],"scale":[1,1,1]}}}]}]"#,
            "groups[0].places[0].motion.still: either a matrix or its parts, not both",
        ),
        (
            r#""groups":[{"places":[{"group":0,"motion":{"keys":[]}}]}]"#,
            "groups[0].places[0].motion.keys: times must ascend, and be there",
        ),
        (r#""animation":[{"parent":0}]"#, "animation[0].parent: there is no earlier node 0"),
        (r#""cameras":[{"at":[0,0,5]}]"#, "cameras[0]: it looks nowhere"),
        (
            r#""cameras":[{"projection":{"perspective":{"degrees":180}}}]"#,
            "cameras[0].projection.perspective.degrees: 180 is not between 0 and 180",
        ),
        (
            r#""lights":[{"color":[1,1,1],"kind":{"directional":{"direction":[0,0,0]}}}]"#,
            "lights[0].kind.directional.direction: it has no length",
        ),
        (
            r#""background":{"environment":{"texture":0}}"#,
            "background.environment.texture: there is no texture 0",
        ),
        (
            r#""geometries":[{"shapes":[{"height_field":{"from":[0,0],"to":[1,1],"counts":[1,1],"heights":[]}}]}]"#,
            "geometries[0].shapes[0].height_field: 1 × 1 heights",
        ),
    ] {
        let found = message(fields);
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
}

#[test]
fn solids_that_are_none_are_refused_by_path() {
    let ball = r#"{"shape":{"sphere":{"center":[0,0,0],"radius":1}}}"#;
    let message = |operand: &str| {
        let solids =
            format!(r#"[{{"union":[{ball},{ball}]}},{{"difference":[{ball},{operand}]}}]"#);
        message(&format!(r#""geometries":[{{"solids":{solids}}}]"#))
    };
    let mesh = |faces| {
        let positions = "[[0,0,0],[1,0,0],[0,1,0],[0,0,1]]";
        format!(r#"{{"mesh":{{"positions":{positions},"faces":{faces}}}}}"#)
    };
    let flat = r#""at":{"scale":[1,0,1]}"#;
    for (operand, expected) in [
        ("{}", "[1]: it needs one of shape, mesh and solid"),
        (
            r#"{"shape":{"disk":{"center":[0,0,0],"normal":[0,0,1],"radius":1}}}"#,
            "[1].shape: a disk has no inside",
        ),
        (&mesh("[[0,2,1],[0,1,3],[0,3,2]]"), "[1].mesh: the mesh is open at the edge from "),
        (&mesh("[[0,1,2],[0,3,1],[0,2,3],[1,3,2]]"), "[1].mesh: the mesh is inside out"),
        (&mesh("[[0,1,9]]"), "[1].mesh: face 0 names vertex 9"),
        (
            &format!(r#"{{"solid":{{"union":[{ball},{{{flat}}}]}}}}"#),
            "[1].solid.union[1]: it needs one of",
        ),
        (&ball.replace("}}}", &format!("}}}},{flat}}}")), "[1].at: the place is flat"),
    ] {
        let found = message(operand);
        assert!(
            found.starts_with(&format!("geometries[0].solids[1].difference{expected}")),
            "{found}"
        );
    }
}

#[test]
fn solids_within_each_other_too_deep_are_refused() {
    let ball = r#"{"shape":{"sphere":{"center":[0,0,0],"radius":1}}}"#;
    let nested = |depth: usize| {
        let (open, close) =
            (r#"{"solid":{"union":["#.repeat(depth), format!(",{ball}]}}}}").repeat(depth));
        let operand = format!("{open}{ball}{close}");
        format!(r#""geometries":[{{"solids":[{{"union":[{operand},{ball}]}}]}}]"#)
    };
    let read = |depth| alone(&format!("{{\"nestray_scene\": 1,\n{}}}", nested(depth)));
    read(31).expect("not too deep");
    assert!(message(&nested(32)).ends_with(": solids within each other more than 32 deep"));
    for depth in [60, 100_000] {
        let found = message(&nested(depth));
        assert!(found.contains("recursion limit exceeded"), "{found}");
    }
}

#[test]
fn groups_that_stand_in_themselves_are_refused_by_name() {
    let cycle = r#""groups":[{"places":[{"group":1}]},{"places":[{"group":0}]}]"#;
    assert_eq!(message(cycle), "groups: group 0 stands in itself");
}

#[test]
fn other_versions_are_told_even_if_they_have_other_fields() {
    for json in [r#"{"nestray_scene": 2}"#, r#"{"nestray_scene": 2, "new": []}"#] {
        let error = alone(json).expect_err("another version").to_string();
        assert!(error.ends_with("nestray_scene: version 2 of the format; 1 is read"), "{error}");
    }
}

#[test]
fn broken_texts_are_errors() {
    const SEED: u64 = 5;
    eprintln!("seed {SEED}");
    let (_, written) = there_and_back(&everything::everything());
    let bytes = written.as_bytes();
    let mut state = SEED;
    let mut random = move |below: usize| {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for end in (0..bytes.len() - 2).step_by(7) {
        alone(&String::from_utf8_lossy(&bytes[..end])).expect_err("the end is missing");
    }
    let digits: Vec<usize> = (0..bytes.len()).filter(|&i| bytes[i].is_ascii_digit()).collect();
    for _ in 0..5_000 {
        let mut broken = bytes.to_vec();
        for _ in 0..1 + random(3) {
            match random(3) {
                0 => broken[random(bytes.len())] = random(256) as u8,
                _ => broken[digits[random(digits.len())]] = b"0123456789-e"[random(12)],
            }
        }
        if let Err(error) = alone(&String::from_utf8_lossy(&broken)) {
            assert!(!error.to_string().contains('\n'), "{error}");
        }
    }
}
