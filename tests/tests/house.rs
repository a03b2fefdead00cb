//! The house is in order: which crate knows which, how long files and functions are, where
//! `unsafe` stands, and that every technique has its page.

use std::fs;
use std::path::{Path, PathBuf};

use nestray_registry::TECHNIQUES;

/// Longest file and function, in lines.
const FILE: usize = 300;
const FUNCTION: usize = 60;

/// Which crates of ours each may depend on.
const MAY_KNOW: &[(&str, &[&str])] = &[
    ("core", &[]),
    ("shapes", &["core"]),
    ("techniques", &["core"]),
    ("registry", &["core", "shapes", "techniques"]),
    ("scene", &["core", "shapes"]),
    ("io", &["core", "shapes", "scene"]),
    ("plan", &["core", "shapes", "registry", "scene"]),
    ("render", &["core", "shapes", "scene"]),
    ("peers", &[]),
    ("rust-peers", &["peers"]),
    ("nestray", &["core", "shapes", "techniques", "registry", "scene", "io", "plan", "render"]),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All Rust files below a folder of the repository.
fn sources(folder: &str) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    let mut open = vec![root().join(folder)];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of the repository") {
            let path = entry.expect("readable").path();
            if path.is_dir() && !path.ends_with("target") {
                open.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).expect("a text");
                found.push((path, text));
            }
        }
    }
    found
}

fn all_sources() -> Vec<(PathBuf, String)> {
    ["crates", "apps", "benches", "tests", "xtask"].into_iter().flat_map(sources).collect()
}

/// Asserts that nothing was found wrong, and lists what was.
fn check(what: &str, wrong: Vec<String>) {
    assert!(wrong.is_empty(), "{what}:\n  {}", wrong.join("\n  "));
}

#[test]
fn crates_know_only_those_below_them() {
    let mut wrong = Vec::new();
    for (name, may_know) in MAY_KNOW {
        let manifest = root().join("crates").join(name).join("Cargo.toml");
        let text = fs::read_to_string(&manifest).expect("every crate has a manifest");
        let own = text.split("[dev-dependencies]").next().unwrap_or_default();
        for line in own.lines().filter(|line| line.starts_with("nestray-")) {
            let known = line["nestray-".len()..].split([' ', '.', '=']).next().unwrap_or_default();
            if !may_know.contains(&known) {
                wrong.push(format!("{name} depends on {known}"));
            }
        }
    }
    check("dependencies against the direction", wrong);
}

#[test]
fn every_crate_has_its_place_in_the_order() {
    let known: Vec<&str> = MAY_KNOW.iter().map(|(name, _)| *name).collect();
    let mut wrong = Vec::new();
    for entry in fs::read_dir(root().join("crates")).expect("there are crates") {
        let name = entry.expect("readable").file_name().into_string().expect("a plain name");
        if !known.contains(&name.as_str()) {
            wrong.push(name);
        }
    }
    check("crates that the order does not name", wrong);
}

#[test]
fn files_are_one_idea_long() {
    let long = all_sources()
        .into_iter()
        .map(|(path, text)| (path, text.lines().count()))
        .filter(|(_, lines)| *lines > FILE)
        .map(|(path, lines)| format!("{} has {lines} lines", path.display()))
        .collect();
    check("files of more than 300 lines", long);
}

#[test]
fn functions_fit_a_page() {
    let mut long = Vec::new();
    for (path, text) in all_sources() {
        let lines: Vec<&str> = text.lines().collect();
        for (start, line) in lines.iter().enumerate() {
            let body = line.trim_start();
            let words = ["fn ", "pub fn ", "pub(super) fn ", "pub(crate) fn ", "const fn "];
            if !words.iter().any(|word| body.starts_with(word)) {
                continue;
            }
            let indent = line.len() - body.len();
            let head =
                lines[start..].iter().find(|line| line.ends_with('{') || line.ends_with(';'));
            if head.is_some_and(|line| line.ends_with(';')) {
                continue;
            }
            let close = format!("{}}}", " ".repeat(indent));
            let end = lines[start..].iter().position(|line| *line == close).unwrap_or(0);
            if end + 1 > FUNCTION {
                long.push(format!("{}:{}: {} lines", path.display(), start + 1, end + 1));
            }
        }
    }
    check("functions of more than 60 lines", long);
}

#[test]
fn unsafe_code_stands_in_kernels_only() {
    let keyword = ["uns", "afe "].concat();
    let wrong = all_sources()
        .into_iter()
        .filter(|(path, _)| !path.ends_with("kernel.rs") && !path.ends_with("house.rs"))
        .filter(|(_, text)| {
            text.lines().any(|line| {
                let code = line.split("//").next().unwrap_or_default();
                [" ", "{", "(", "="]
                    .iter()
                    .any(|before| code.contains(&format!("{before}{keyword}")))
                    || code.starts_with(&keyword)
            })
        })
        .map(|(path, _)| path.display().to_string())
        .collect();
    check("files with unsafe code that are not kernels", wrong);
}

#[test]
fn every_file_says_what_it_is() {
    let wrong = all_sources()
        .into_iter()
        .filter(|(path, text)| !text.starts_with("//!") && !path.ends_with("tests.rs"))
        .map(|(path, _)| path.display().to_string())
        .collect();
    check("files without a head", wrong);
}

#[test]
fn every_technique_has_its_page() {
    let wrong = TECHNIQUES
        .iter()
        .map(|entry| format!("docs/techniques/{}.md", entry.name))
        .filter(|page| !root().join(page).is_file())
        .collect();
    check("techniques without a page", wrong);
}

#[test]
fn there_is_one_list_of_everything_technical() {
    let names: Vec<&str> = TECHNIQUES.iter().map(|entry| entry.name).collect();
    let mut sorted = names.clone();
    sorted.sort_unstable();
    sorted.dedup();
    assert_eq!(sorted.len(), names.len(), "a name is used twice");
}

#[test]
fn every_source_cited_is_in_the_list_of_references() {
    let list = fs::read_to_string(root().join("docs/references.md")).expect("there is a list");
    let mut wrong = Vec::new();
    for (path, text) in all_sources() {
        for cited in text.split('[').skip(1).filter_map(|rest| rest.split(']').next()) {
            for key in cited.split(';').map(|key| key.split(',').next().unwrap_or_default().trim())
            {
                let mut words = key.split(' ');
                let (name, year) =
                    (words.next().unwrap_or_default(), words.next().unwrap_or_default());
                let is_key = words.next().is_none()
                    && name.len() > 2
                    && name.starts_with(|c: char| c.is_ascii_uppercase())
                    && name.chars().all(|c| c.is_ascii_alphabetic())
                    && (2..=3).contains(&year.len())
                    && year.starts_with(|c: char| c.is_ascii_digit())
                    && year[1..].starts_with(|c: char| c.is_ascii_digit());
                if is_key && !list.contains(&format!("**[{key}]**")) {
                    wrong.push(format!("{}: [{key}]", path.display()));
                }
            }
        }
    }
    check("sources that docs/references.md does not name", wrong);
}
