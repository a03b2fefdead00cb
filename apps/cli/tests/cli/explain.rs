//! `nestray inspect --explain` and `--diff`.

use serde_json::Value;

use crate::program::{Folder, nestray};

/// A grid over a hierarchy of boxes and the rest.
const PLAN: &str = r#"{ "version": 1, "root": { "nest": { "technique": "grid", "children": [
    { "nest": { "technique": "bvh", "children": [ { "pick": 0 } ] } }, { "pick": "rest" } ] } } }"#;

#[test]
fn a_technique_is_held_against_every_other_in_its_place() {
    let folder = Folder::new();
    let plan = folder.write("plan.json", PLAN);
    let explain = |more: &[&str]| {
        let args = ["inspect", "builtin:mount@2", "--plan", &plan, "--explain"];
        nestray(&[&args[..], more].concat())
    };
    let said = explain(&["root/nest/children/0"]).succeeds().output;
    for word in ["\n* bvh ", "\n  grid ", "\n  octree ", " 1.00 ", "expected", "are spent in it"] {
        assert!(said.contains(word), "{word}: {said}");
    }
    assert_eq!(said.matches("\nbvh ").count(), 1, "the part that it became: {said}");
    let said = explain(&["root/nest/children/0", "--json"]).succeeds().output;
    let json: Value = serde_json::from_str(&said).expect("JSON");
    let all = json["alternatives"].as_array().expect("a list");
    assert!(all.len() > 15 && all.iter().filter(|one| one["chosen"] == true).count() == 1);
    let parts = json["parts"].as_array().expect("a list");
    assert!(parts.len() == 1 && parts[0]["counted"][0]["visits"].as_f64() > Some(0.0), "{said}");
    let (spent, whole) = (json["spent"][0].as_f64(), json["spent_in_all"].as_f64());
    assert!(spent > Some(0.0) && spent < whole, "{spent:?} of {whole:?}");

    let said = explain(&["root"]).succeeds().output;
    assert!(said.contains("\n* grid "), "{said}");
    explain(&["root/nest/children/7"]).fails(2, &["unknown node", "\"root/nest/children/0\""]);
    explain(&["root/nest/children/1"]).fails(2, &["unknown nest", "\"root\""]);
    nestray(&["inspect", &plan, "--explain", "root"]).fails(2, &["depends on the scene"]);
}

#[test]
fn what_instances_place_is_explained_too() {
    let folder = Folder::new();
    let found = ["optimize", "builtin:forest@1", "--budget", "1evals", "--rays", "256", "-o"];
    let plan = folder.path("plan.json");
    nestray(&[&found[..], &[&plan]].concat()).succeeds();
    let text = std::fs::read_to_string(&plan).expect("it was written");
    let json: Value = serde_json::from_str(&text).expect("JSON");
    let shared = json["shared"].as_object().expect("it has instances");
    let path = format!("shared/{}", shared.keys().next().expect("one at least"));
    let said = nestray(&["inspect", "builtin:forest@1", "--plan", &plan, "--explain", &path]);
    let said = said.succeeds().output;
    assert!(said.contains("light-buffer         cannot serve there: "), "{said}");
    assert!(said.contains("are spent in it") && !said.contains("nothing stands"), "{said}");
}

#[test]
fn two_plans_are_compared_node_by_node() {
    let folder = Folder::new();
    let first = folder.write("first.json", PLAN);
    let other = PLAN.replace("\"bvh\"", "\"octree\"").replace("[ { \"pick\": 0 } ]", "[]");
    let second = folder.write("second.json", &other);
    let said = nestray(&["inspect", "--diff", &first, &second]).succeeds().output;
    for word in [
        "\nroot/nest/children/0/nest/children/0\n  first   {\"pick\":0}\n  second  –\n",
        "\nroot/nest/children/0/nest/technique\n  first   \"bvh\"\n  second  \"octree\"\n",
    ] {
        assert!(said.contains(word), "{word}: {said}");
    }
    let said = nestray(&["inspect", "--diff", &first, &first]).succeeds().output;
    assert!(said.contains("they are the same"), "{said}");
    let said = nestray(&["inspect", "--diff", &first, &second, "--json"]).succeeds().output;
    let json: Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!(json["differences"].as_array().map(Vec::len), Some(2));
    nestray(&["inspect", "--diff", &first]).fails(2, &["--diff"]);
    nestray(&["inspect", "--diff", &first, "nowhere.json"]).fails(3, &["nowhere.json"]);
}
