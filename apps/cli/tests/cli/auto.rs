//! `render --plan auto`: what it searches for, keeps, and does without.

use std::fs;

use serde_json::Value;

use crate::program::{Folder, Ran, nestray_with};

/// Pictures of a scene, and a cache of their own.
struct Pictures(Folder);

impl Pictures {
    fn new() -> Self {
        Self(Folder::new())
    }

    fn cache(&self) -> String {
        self.0.path("cache")
    }

    /// The picture, and what was said.
    fn render(&self, more: &[&str]) -> (Vec<u8>, Ran) {
        let out = self.0.path("a.pfm");
        let args = ["render", "builtin:gears@2", "-o", &out, "--resolution", "64x48"];
        let samples: &[&str] = if more.contains(&"--spp") { &[] } else { &["--spp", "4"] };
        let args = [&args[..], samples, more].concat();
        let ran = nestray_with(&args, &[("XDG_CACHE_HOME", &self.cache())]);
        let ran = ran.succeeds();
        (fs::read(&out).expect("it was written"), ran)
    }

    /// The files that were kept.
    fn kept(&self) -> Vec<std::path::PathBuf> {
        let Ok(entries) = fs::read_dir(self.0.path("cache/nestray/plans")) else {
            return Vec::new();
        };
        entries.map(|entry| entry.expect("readable").path()).collect()
    }
}

/// A search even for a small picture.
const SEARCH: &[&str] = &["--search", "400ms"];

#[test]
fn what_was_searched_for_is_kept_and_taken_the_next_time() {
    let pictures = Pictures::new();
    let (usual, ran) = pictures.render(&["--plan", "bvh"]);
    assert!(!ran.errors.contains("plan auto"), "{}", ran.errors);
    let (found, ran) = pictures.render(SEARCH);
    assert!(ran.errors.contains("plan auto: searched for"), "{}", ran.errors);
    assert!(found == usual, "the picture does not depend on the plan");
    let [kept] = &pictures.kept()[..] else { panic!("{:?}", pictures.kept()) };
    let text = fs::read_to_string(kept).expect("readable");
    let entry: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(entry["key"]["nestray"], env!("CARGO_PKG_VERSION"));
    let seconds = |plan: &str| entry[plan]["sample"].as_f64().expect("a number");
    assert!(seconds("best") <= seconds("default") && seconds("best") > 0.0, "{text}");
    let (again, ran) = pictures.render(SEARCH);
    assert!(ran.errors.contains("cache") && !ran.errors.contains("searched"), "{}", ran.errors);
    assert!(again == usual);
    assert_eq!(fs::read_to_string(kept).expect("readable"), text);
    // Much more time is for a search of its own.
    let (again, ran) = pictures.render(&["--search", "5s"]);
    assert!(ran.errors.contains("plan auto: searched for"), "{}", ran.errors);
    assert!(again == usual);
}

#[test]
fn a_small_picture_is_not_searched_for() {
    let pictures = Pictures::new();
    let (_, ran) = pictures.render(&[]);
    assert!(
        ran.errors.contains("not searched: the picture has only 12288 samples"),
        "{}",
        ran.errors
    );
    let (_, ran) = pictures.render(&["--spp", "24"]);
    assert!(ran.errors.contains("not searched: the picture takes about"), "{}", ran.errors);
    let (_, ran) = pictures.render(&["--search", "0s"]);
    assert!(ran.errors.contains("not searched: no time for it"), "{}", ran.errors);
    let (_, ran) = pictures.render(&["--integrator", "cost", "--search", "9s"]);
    assert!(ran.errors.contains("not searched: the picture shows"), "{}", ran.errors);
    assert!(pictures.kept().is_empty());
}

#[test]
fn without_a_cache_nothing_is_kept() {
    let pictures = Pictures::new();
    let (_, ran) = pictures.render(&[SEARCH, &["--no-cache"]].concat());
    assert!(ran.errors.contains("plan auto: searched for"), "{}", ran.errors);
    assert!(!fs::exists(pictures.cache()).expect("it can be asked"));
}

#[test]
fn a_cache_that_is_of_no_use_is_worked_without() {
    let pictures = Pictures::new();
    let (usual, _) = pictures.render(SEARCH);
    let [kept] = &pictures.kept()[..] else { panic!("{:?}", pictures.kept()) };
    let text = fs::read_to_string(kept).expect("readable");
    let older = text.replace(&format!(":\"{}\"", env!("CARGO_PKG_VERSION")), ":\"0.0.1\"");
    assert_ne!(older, text);
    let check = |text: &[u8], word: &str| {
        fs::write(kept, text).expect("writable");
        let (picture, ran) = pictures.render(SEARCH);
        let said = |line: &&str| line.contains("the cache is not used");
        let lines: Vec<&str> = ran.errors.lines().filter(said).collect();
        assert!(lines.len() == 1 && lines[0].contains(word), "{}", ran.errors);
        assert!(ran.errors.contains("plan auto: searched for") && picture == usual);
        assert!(pictures.render(SEARCH).1.errors.contains("cache"), "a new one was kept");
    };
    check(older.as_bytes(), "0.0.1");
    check(&text.as_bytes()[..text.len() / 2], "EOF");
    check(b"\xff\xfe", "UTF-8");
    // What can be neither read nor written.
    fs::remove_dir_all(pictures.cache()).expect("it goes");
    fs::write(pictures.cache(), "in the way").expect("writable");
    let (picture, ran) = pictures.render(SEARCH);
    assert_eq!(ran.errors.matches("the cache is not used").count(), 1, "{}", ran.errors);
    assert!(picture == usual);
    assert_eq!(fs::read(pictures.cache()).expect("there"), b"in the way");
}
