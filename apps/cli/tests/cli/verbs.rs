//! What each verb does when all is well.

use std::fs;

use crate::program::{Folder, nestray, rays};

#[test]
fn a_render_is_the_same_with_any_plan_and_any_threads() {
    let folder = Folder::new();
    let render = |name: &str, more: &[&str]| {
        let out = folder.path(name);
        let mut args = vec!["render", "builtin:jacks", "-o", &out, "--resolution", "64x48"];
        args.extend(["--spp", "2", "--max-depth", "3"]);
        args.extend(more);
        nestray(&args).succeeds();
        fs::read(&out).expect("it was written")
    };
    let first = render("a.pfm", &[]);
    assert_eq!(first.len(), 64 * 48 * 12 + b"PF\n64 48\n-1.0\n".len());
    assert!(render("b.pfm", &["--plan", "grid", "--threads", "1"]) == first);
    assert!(render("c.pfm", &["--plan", "list"]) == first);
    assert!(render("e.pfm", &["--plan", "lazy-bvh"]) == first);
    assert!(render("f.pfm", &["--plan", "scherson-caspary"]) == first);
    assert!(render("d.pfm", &["--seed", "1"]) != first);
}

#[test]
fn solids_are_the_same_in_any_nest_and_from_a_file() {
    let folder = Folder::new();
    let made = folder.path("mixed.json");
    nestray(&["convert", "builtin:mixed@2", "-o", &made]).succeeds();
    for integrator in ["whitted", "path"] {
        let render = |scene: &str, plan: &str| {
            let out = folder.path("a.pfm");
            let mut args = vec!["render", scene, "-o", &out, "--resolution", "80x60"];
            args.extend(["--spp", "1", "--max-depth", "4", "--plan", plan]);
            args.extend(["--integrator", integrator]);
            nestray(&args).succeeds();
            fs::read(&out).expect("it was written")
        };
        let first = render("builtin:mixed@2", "list");
        assert!(render("builtin:mixed@2", "bvh") == first, "{integrator}, bvh");
        assert!(render("builtin:mixed@2", "grid") == first, "{integrator}, grid");
        assert!(render(&made, "bvh") == first, "{integrator}, from a file");
    }
    let said = nestray(&["inspect", &made, "--tree"]).succeeds().output;
    assert!(said.contains("8 × csg") && said.contains("csg  Difference"), "{said}");
}

#[test]
fn the_standard_procedure_takes_the_model_it_implies_and_no_other() {
    let folder = Folder::new();
    let render = |name: &str, more: &[&str]| {
        let out = folder.path(name);
        let args = ["render", "builtin:tetra@2", "-o", &out, "--resolution", "32x32", "--spd"];
        nestray(&[&args[..], more].concat())
    };
    render("a.png", &[]).succeeds();
    render("b.png", &["--integrator", "whitted"]).succeeds();
    let read = |name: &str| fs::read(folder.path(name)).expect("written");
    assert!(read("a.png") == read("b.png"));
    for other in ["path", "ao", "cost"] {
        render("c.png", &["--integrator", other]).fails(2, &["--spd", "--integrator whitted"]);
    }
    render("c.png", &["--spp", "4"]).fails(2, &["--spd", "--spp"]);
}

#[test]
fn several_pictures_and_statistics_come_of_one_render() {
    let folder = Folder::new();
    let names = ["a.png", "a.exr", "a.pfm"].map(|name| folder.path(name));
    let stats = folder.path("s.json");
    let mut args = vec!["render", "builtin:tetra@3", "--integrator", "whitted", "--spp", "1"];
    args.extend(["--resolution", "40x30", "--crop", "10,30,5,25", "--stats", &stats]);
    for name in &names {
        args.extend(["-o", name]);
    }
    let said = nestray(&args).succeeds();
    assert!(said.errors.contains("20 x 20 pixels"), "{}", said.errors);
    assert!(names.iter().all(|name| fs::metadata(name).expect("written").len() > 100));
    let stats: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(stats).expect("written")).expect("JSON");
    assert_eq!(stats["rays"]["camera"]["cast"], 400);
    assert_eq!(stats["complete"], true);
    assert_eq!(stats["plan"]["hash"].as_str().map(str::len), Some(64));
    for stage in ["load", "build", "render", "write"] {
        assert!(stats["stages"][stage].as_f64().is_some_and(|s| s >= 0.0), "{stage}");
    }
}

#[test]
fn frames_are_numbered_and_things_move() {
    let folder = Folder::new();
    let scene = folder.write(
        "moving.json",
        r#"{ "nestray_scene": 1,
             "geometries": [ { "shapes": [ { "sphere": { "center": [0, 0, 0], "radius": 0.5 } } ] } ],
             "groups": [ { "places": [ { "group": 1, "motion": { "node": 0 } } ] }, { "geometries": [ 0 ] } ],
             "cameras": [ { "from": [0, 0, 5], "at": [0, 0, 0] } ],
             "animation": [ { "translation": { "keys": [ [0, [-1, 0, 0]], [1, [1, 0, 0]] ] } } ] }"#,
    );
    let out = folder.path("film.pfm");
    let args = ["render", &scene, "-o", &out, "--frames", "0-20x10", "--fps", "20", "--spp", "1"];
    nestray(&[&args[..], &["--resolution", "32x24", "--integrator", "whitted"]].concat())
        .succeeds();
    let frames = ["0000", "0010", "0020"].map(|number| {
        fs::read(folder.path(&format!("film.{number}.pfm"))).expect("it was written")
    });
    assert!(frames[0] != frames[1] && frames[1] != frames[2]);
}

#[test]
fn rays_are_answered_in_order() {
    let folder = Folder::new();
    let scene = folder.write("one.off", "OFF\n3 1 0\n-1 -1 0\n1 -1 0\n0 1 0\n3 0 1 2\n");
    let nan = f64::NAN;
    let list = [
        [0.0, 0.0, 5.0, 0.0, 0.0, -1.0],
        [9.0, 0.0, 5.0, 0.0, 0.0, -1.0],
        [nan, 0.0, 5.0, 0.0, 0.0, -1.0],
        [0.0, 0.0, 5.0, 0.0, 0.0, 0.0],
        [0.0, 0.0, 5.0, 0.0, 0.0, f64::INFINITY],
        [0.0, 0.0, 5.0, 0.0, 0.0, -2.0],
    ];
    let (rays, out) = (folder.write_bytes("rays.npy", &rays(&list)), folder.path("hits.npy"));
    nestray(&["query", &scene, "--rays", &rays, "-o", &out]).succeeds();
    let bytes = fs::read(&out).expect("it was written");
    let header = String::from_utf8_lossy(&bytes[10..bytes.len() - 6 * 24]).into_owned();
    assert!(header.contains("('instance', '<u4')], 'fortran_order': False, 'shape': (6,)"));
    let data = &bytes[bytes.len() - 6 * 24..];
    let hits: Vec<(f32, u32)> = data
        .chunks_exact(24)
        .map(|hit| {
            let t = f32::from_le_bytes(hit[..4].try_into().expect("4 bytes"));
            (t, u32::from_le_bytes(hit[12..16].try_into().expect("4 bytes")))
        })
        .collect();
    let miss = (f32::INFINITY, u32::MAX);
    assert_eq!(hits, [(5.0, 0), miss, miss, miss, miss, (2.5, 0)]);

    nestray(&["query", &scene, "--rays", &rays, "-o", &out, "--any"]).succeeds();
    let bytes = fs::read(&out).expect("it was written");
    assert_eq!(bytes[bytes.len() - 6..], [1, 0, 0, 0, 0, 1]);

    nestray(&["query", &scene, "--rays", &rays, "-o", &out, "--all", "--plan", "grid"]).succeeds();
    let bytes = fs::read(&out).expect("it was written");
    assert!(String::from_utf8_lossy(&bytes).contains("'shape': (2,)"));
    assert_eq!(bytes[bytes.len() - 32..][..8], 5u64.to_le_bytes());
}

#[test]
fn scenes_are_made_converted_and_looked_at() {
    let folder = Folder::new();
    let (made, again) = (folder.path("made.json"), folder.path("again.json"));
    nestray(&["generate", "tetra", "--size", "2", "-o", &made]).succeeds();
    nestray(&["convert", &made, "-o", &again]).succeeds();
    assert!(fs::read(&made).expect("made") == fs::read(&again).expect("converted"));
    let said = nestray(&["inspect", &again, "--json"]).succeeds().output;
    let json: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!(json["primitives"], 16);
    let said = nestray(&["inspect", &again, "--tree", "--plan", "grid", "--ray", "320,200"]);
    let said = said.succeeds().output;
    assert!(said.contains("\ngrid ") && said.contains("  hits      "), "{said}");
}

#[test]
fn everything_there_is_to_choose_from_is_listed() {
    for (list, expected) in [
        ("techniques", "density"),
        ("presets", "max_leaf"),
        ("scenes", "sphereflake"),
        ("shapes", "torus"),
    ] {
        let said = nestray(&["inspect", "--list", list]).succeeds().output;
        assert!(said.contains(expected), "{said}");
        let said = nestray(&["inspect", "--list", list, "--json"]).succeeds().output;
        assert!(serde_json::from_str::<serde_json::Value>(&said).expect("JSON").is_array());
    }
}

#[test]
fn plans_are_looked_at_and_used() {
    let folder = Folder::new();
    let plan = folder.write(
        "plan.json",
        r#"{ "version": 1, "root": { "nest": { "technique": "grid", "children": [
             { "nest": { "technique": "bvh", "children": [ { "pick": 0 } ] } },
             { "pick": "rest" } ] } } }"#,
    );
    let said = nestray(&["inspect", &plan]).succeeds().output;
    assert!(said.contains("nests     2") && said.contains("\n    pick 0\n"), "{said}");
    let out = folder.path("a.png");
    nestray(&["render", "builtin:mount@2", "--plan", &plan, "-o", &out, "--spp", "1"]).succeeds();
    assert!(fs::read(&out).expect("it was written").starts_with(b"\x89PNG"));
}

#[test]
fn what_rays_of_each_kind_do_is_counted_in_every_part_of_a_nest() {
    let folder = Folder::new();
    let plan = folder.write(
        "plan.json",
        r#"{ "version": 1, "root": { "nest": { "technique": "grid", "children": [
             { "nest": { "technique": "bvh", "children": [ { "pick": 0 } ] } },
             { "pick": "rest" } ] } } }"#,
    );
    let args = ["inspect", "builtin:mount@2", "--plan", &plan];
    let said = nestray(&args).succeeds().output;
    for word in ["\ngrid ", "\n  bvh ", "visits", "expected", "shadow 0", "diffuse", "chords"] {
        assert!(said.contains(word), "{word}: {said}");
    }
    assert_eq!(said, nestray(&args).succeeds().output, "the same rays are sent");
    let said = nestray(&[&args[..], &["--json"]].concat()).succeeds().output;
    let json: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    let counted = |part: &serde_json::Value| {
        let camera = part["counted"].as_array().expect("it was met").first().expect("by some");
        assert_eq!(camera["rays"], "camera");
        ["visits", "steps", "tests"].map(|what| camera[what].as_f64().expect("a number"))
    };
    let root = counted(&json["tree"]);
    assert!(root[0] == 1.0 && root[1] > 1.0, "{root:?}");
    let bvh = json["tree"]["children"].as_array().expect("some").iter();
    let bvh = bvh.into_iter().find(|part| part["kind"] == "bvh").expect("it is in the plan");
    let inner = counted(bvh);
    assert!(inner[0] > 0.0 && inner[0] < 1.0 && inner[1] >= 1.0, "{inner:?}");
    assert!(bvh["expected"]["steps"].as_f64().expect("a number") >= 1.0);
    assert_eq!(json["rays_sent"]["camera"], 4096);
}

#[test]
fn a_plan_made_for_a_scene_is_used_with_no_other() {
    let folder = Folder::new();
    let said = nestray(&["inspect", "builtin:tetra@2", "--json"]).succeeds().output;
    let json: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    let mark = json["fingerprint"].as_str().expect("there is one");
    let plan = format!(r#"{{ "version": 1, "scene": "{mark}", "root": {{ "pick": "*" }} }}"#);
    let plan = folder.write("plan.json", &plan);
    let out = folder.path("a.pfm");
    let render = |scene: &str| {
        nestray(&["render", scene, "-o", &out, "--plan", &plan, "--resolution", "8x8"])
    };
    render("builtin:tetra@2").succeeds();
    let words = ["plan.json: scene: made for the scene", mark, "1 geometries and 64 primitives"];
    render("builtin:tetra@3").fails(3, &words);
    assert!(nestray(&["inspect", &plan]).succeeds().output.contains(mark));
}

#[test]
fn quiet_is_quiet_and_progress_is_json_if_asked() {
    let folder = Folder::new();
    let out = folder.path("a.png");
    let args = ["render", "builtin:tetra@2", "-o", &out, "--spp", "1", "--resolution", "32x32"];
    assert_eq!(nestray(&[&args[..], &["-q"]].concat()).succeeds().errors, "");
    let said = nestray(&[&args[..], &["--progress", "json"]].concat()).succeeds().errors;
    for line in said.lines() {
        assert!(serde_json::from_str::<serde_json::Value>(line).is_ok(), "{line}");
    }
    assert!(said.contains("\"stage\":\"render\""), "{said}");
}
