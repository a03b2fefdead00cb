//! `nestray optimize`.

use serde_json::Value;

use crate::program::{Folder, nestray};

/// A small search: as many plans, no time.
const SEARCH: &[&str] =
    &["optimize", "builtin:tetra@3", "--budget", "40evals", "--rays", "600", "--rounds", "1"];

#[test]
fn a_plan_is_found_that_serves_its_scene_and_no_other() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name).to_str().expect("a plain name").to_owned();
    let (plan, report, picture) = (path("plan.json"), path("report.json"), path("picture.png"));
    let page = path("report.html");
    let files = ["-o", &plan, "--report", &report, "--report", &page];
    let said = nestray(&[SEARCH, &files].concat()).succeeds().output;
    assert!(said.contains("plans tried") && said.contains("the best single technique"), "{said}");

    let read = |path: &str| -> Value {
        serde_json::from_slice(&std::fs::read(path).expect("it was written")).expect("JSON")
    };
    let found = read(&report);
    assert!(found["evaluations"].as_u64().is_some_and(|count| count <= 40), "{found}");
    let finalists = found["finalists"].as_array().expect("a list");
    assert_eq!(finalists[0]["plan"]["root"], read(&plan)["root"]);
    for one in finalists {
        assert!(one["total"].as_f64().is_some_and(|total| total > 0.0), "{one}");
    }
    let moves = found["moves"].as_object().expect("an object");
    for counts in moves.values() {
        assert!(counts["taken"].as_u64() <= counts["proposed"].as_u64(), "{counts}");
    }
    let mixes: Vec<f64> = found["candidates"]
        .as_array()
        .expect("a list")
        .iter()
        .map(|one| one["expected_mix"].as_f64().expect("a number"))
        .collect();
    assert!(mixes.len() > 10 && mixes.is_sorted(), "{mixes:?}");
    assert!(found["spent"]["total"].as_f64().is_some_and(|nanos| nanos > 0.0));
    let page = std::fs::read_to_string(page).expect("it was written");
    assert_eq!(page.matches("<svg").count(), page.matches("</svg>").count());
    assert_eq!(page.matches("<tr").count(), 2 + finalists.len() + moves.len());
    for one in finalists {
        let name = one["name"].as_str().expect("a name");
        assert!(page.contains(&format!("<td>{name}")), "{name}");
    }
    // Nothing from elsewhere but the picture it brings along, and nothing that runs.
    let (before, rest) = page.split_once("href=\"data:image/png;base64,").expect("a picture");
    let (_, after) = rest.split_once('"').expect("it ends");
    let page = [before, after].concat();
    for word in ["<script", "src=", "href=", "url(", "@import", "NaN"] {
        assert!(!page.contains(word), "{word}");
    }

    let render = ["render", "builtin:tetra@3", "-o", &picture, "--plan", &plan];
    nestray(&[&render[..], &["--resolution", "8x8", "--spp", "1"]].concat()).succeeds();
    let other = ["render", "builtin:tetra@2", "-o", &picture, "--plan", &plan];
    nestray(&other).fails(3, &["made for the scene"]);
}

#[test]
fn a_search_begins_with_a_plan_and_keeps_what_is_pinned() {
    let folder = Folder::new();
    let text = r#"{ "version": 1, "root": { "nest": { "technique": "grid", "children": [
        { "nest": { "technique": "octree", "children": [ { "pick": 0 } ] } } ] } } }"#;
    let (start, found) = (folder.write("start.json", text), folder.path("found.json"));
    let search =
        |more: &[&str]| nestray(&[SEARCH, &["-o", &found, "--start", &start], more].concat());
    search(&["--pin", "root/nest/children/0"]).succeeds();
    let found = std::fs::read_to_string(&found).expect("it was written");
    assert!(found.contains("octree"), "{found}");
    search(&["--pin", "root/nest/children/1"]).fails(2, &["--pin", "\"root/nest/children/0\""]);
    let other = text.replace("\"pick\": 0", "\"pick\": 7");
    let other = folder.write("other.json", &other);
    nestray(&[SEARCH, &["-o", "never.json", "--start", &other]].concat()).fails(3, &["other.json"]);
    nestray(&[SEARCH, &["-o", "never.json", "--pin", "root"]].concat()).fails(2, &["--start"]);
}

#[test]
fn the_plan_goes_to_standard_output_if_asked() {
    let said = nestray(&[SEARCH, &["-o", "-"]].concat()).succeeds().output;
    let plan: Value = serde_json::from_str(&said).expect("nothing but the plan");
    assert!(plan["root"].is_object(), "{plan}");
}

#[test]
fn what_cannot_be_searched_is_refused_by_name() {
    let search = |more: &[&str]| nestray(&[SEARCH, &["-o", "never.json"], more].concat());
    search(&["--techniques", "gird"]).fails(2, &["gird", "grid"]);
    search(&["--weights", "camra=1"]).fails(2, &["camra", "camera"]);
    search(&["--weights", "camera=0"]).fails(2, &["--weights"]);
    search(&["--rays-expected", "0"]).fails(2, &["--rays-expected"]);
    search(&["--max-memory", "4X"]).fails(2, &["--max-memory"]);
    nestray(&["optimize", "builtin:tetra@2", "-o", "never.json", "--budget", "soon"])
        .fails(2, &["soon", "2000evals"]);
    nestray(&["optimize", "nowhere.obj", "-o", "never.json"]).fails(3, &["nowhere.obj"]);
    assert!(!std::path::Path::new("never.json").exists());
}

#[test]
fn prices_come_from_a_file_or_with_the_program() {
    let folder = Folder::new();
    let usual = include_str!("../../../../crates/plan/src/prices/usual.json");
    let file = folder.write("prices.json", usual);
    let [mine, theirs] = ["mine.plan.json", "theirs.plan.json"].map(|name| folder.path(name));
    nestray(&[SEARCH, &["-o", &mine, "--prices", &file]].concat()).succeeds();
    nestray(&[SEARCH, &["-o", &theirs, "--prices", "usual"]].concat()).succeeds();
    let cut = folder.write("cut.json", &usual[..usual.len() / 2]);
    let negative = folder.write("negative.json", &usual.replacen("\"far\": ", "\"far\": -", 1));
    for (path, why) in [
        (folder.path("missing.json"), "missing.json"),
        (cut, "line"),
        (negative, "numbers from 0 on"),
    ] {
        let plan = folder.path("never.plan.json");
        nestray(&[SEARCH, &["-o", &plan, "--prices", &path]].concat()).fails(3, &[why]);
        assert!(!folder.names().contains(&"never.plan.json".to_owned()));
    }
}
