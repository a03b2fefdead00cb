//! `nestray bench`.

use serde_json::Value;

use crate::program::nestray;

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
