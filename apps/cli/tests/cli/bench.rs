//! `nestray bench`.

use serde_json::Value;

use crate::program::{nestray, nestray_with};

#[test]
fn plans_are_compared_on_every_kind_of_ray() {
    let args =
        ["bench", "builtin:balls@2", "--plans", "bvh,grid", "--rays", "900", "--rounds", "1"];
    let said = nestray(&[&args[..], &["--verify", "--json"]].concat()).succeeds().output;
    let report: Value = serde_json::from_str(&said).expect("JSON");
    let kinds: Vec<&str> = report["rays"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|set| set["kind"].as_str().expect("a name"))
        .collect();
    assert_eq!(kinds, ["camera", "shadow", "reflect", "diffuse", "chords"]);
    for set in report["rays"].as_array().expect("a list") {
        for plan in set["of"].as_array().expect("a list") {
            assert_eq!(plan["answers_that_differ"], 0, "{set}");
            assert!(plan["tests_per_ray"].as_f64().expect("a number") > 0.0, "{set}");
            assert!(plan["batch_mrays_per_second"].as_f64().expect("a number") > 0.0, "{set}");
        }
    }
    let text = nestray(&[&args[..], &["--verify"]].concat()).succeeds().output;
    assert!(text.contains("verified against exhaustive search: 900 rays"), "{text}");
}

#[test]
fn without_plans_every_technique_takes_part() {
    let said = nestray(&["inspect", "--list", "techniques", "--json"]).succeeds().output;
    let list: Value = serde_json::from_str(&said).expect("JSON");
    let bench = ["bench", "builtin:tetra@2", "--rays", "100", "--rounds", "1"];
    let table = nestray(&bench).succeeds().output;
    let named = |technique: &Value| {
        let name = technique["name"].as_str().expect("a name");
        assert!(table.lines().any(|line| line.starts_with(name)), "{name} in {table}");
    };
    let list = list.as_array().or_else(|| list["techniques"].as_array()).expect("a list");
    assert!(!list.is_empty());
    list.iter().for_each(named);
}

#[test]
fn a_bench_of_nothing_is_refused() {
    nestray(&["bench", "builtin:tetra@2", "--plans", "bhv"]).fails(2, &["bhv", "bvh"]);
    nestray(&["bench", "builtin:tetra@2", "--rays", "0"]).fails(2, &["1 to 100000000 rays"]);
    nestray(&["bench", "nowhere.obj"]).fails(3, &["nowhere.obj"]);
}

/// A bench against Embree, found or not.
fn against(path: Option<&str>) -> Value {
    let mut args =
        vec!["bench", "builtin:truss@4", "--plans", "bvh,grid", "--rays", "3000", "--rounds", "1"];
    args.extend(["--vs", "embree", "--json"]);
    let values: Vec<(&str, &str)> = path.map(|path| ("NESTRAY_EMBREE", path)).into_iter().collect();
    serde_json::from_str(&nestray_with(&args, &values).succeeds().output).expect("JSON")
}

#[test]
fn a_library_that_is_not_there_is_named_and_left_out() {
    let report = against(Some("nowhere/libembree4.so"));
    let missing = report["missing"].as_array().expect("a list");
    assert_eq!(missing.len(), 1, "{missing:?}");
    assert_eq!(missing[0]["peer"], "Embree");
    assert!(missing[0]["reason"].as_str().expect("text").contains("nowhere/libembree4.so"));
    let contenders = report["contenders"].as_array().expect("a list");
    assert_eq!(contenders.len(), 4, "two plans, in batches and one ray at a time: {contenders:?}");
}

#[test]
fn libraries_agree_on_every_kind_of_ray() {
    let report = against(None);
    let missing = report["missing"].as_array().expect("a list");
    if !missing.is_empty() {
        eprintln!("without Embree: {missing:?}");
    }
    let sets = report["sets"].as_array().expect("a list");
    let names: Vec<&str> = sets.iter().map(|set| set["name"].as_str().expect("a name")).collect();
    assert_eq!(names, ["primary", "bounce", "chords", "shadow", "ao", "long"]);
    let contenders = report["contenders"].as_array().expect("a list");
    for set in sets {
        let rays = set["rays"].as_u64().expect("a number");
        assert!((1..=3000).contains(&rays), "{set}");
        let of = set["of"].as_array().expect("a list");
        assert_eq!(of.len(), contenders.len());
        for (taken, contender) in of.iter().zip(contenders) {
            let differ = |what: &str| taken[what].as_u64().expect("a number");
            let differ = differ("other_hits") + differ("other_distances");
            // Others round otherwise: a ray along an edge may go by.
            let ours = contender["peer"] == "bvh" || contender["peer"] == "grid";
            assert!(differ <= if ours { 0 } else { rays / 500 }, "{contender}, {set}");
            assert!(taken["mrays_per_second"].as_f64().expect("a number") > 0.0);
        }
    }
}

#[test]
fn only_libraries_that_are_known_and_scenes_of_triangles_are_compared() {
    let vs = |scene, name| nestray(&["bench", scene, "--rays", "256", "--vs", name]);
    vs("builtin:teapot@2", "embre").fails(2, &["embre", "did you mean \"embree\"?"]);
    vs("builtin:mixed@1", "embree").fails(2, &["triangles only"]);
    vs("builtin:balls@1", "embree").succeeds();
}
