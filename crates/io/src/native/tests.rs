//! What our own files become, and back.

mod everything;
mod files;
mod refused;

use std::path::Path;

use nestray_scene::scene::Scene;

use super::*;
use crate::load::LoadOptions;

/// Reads a text that stands beside `folder/scene.json`.
fn text(json: &str, folder: &Path) -> Result<Loaded, LoadError> {
    let options = LoadOptions { complete: false, ..LoadOptions::default() };
    read(json.as_bytes(), &Source { path: folder.join("scene.json"), options })
}

/// Reads a text that needs no other file.
fn alone(json: &str) -> Result<Loaded, LoadError> {
    text(json, Path::new("nowhere"))
}

/// Writes a scene and reads it again, by way of a file.
fn there_and_back(scene: &Scene) -> (Scene, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.json");
    write_native(scene, &path).expect("writable");
    let written = std::fs::read_to_string(&path).expect("there");
    let options = LoadOptions { complete: false, ..LoadOptions::default() };
    let loaded = crate::load::load(&path, &options).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(loaded.warnings, []);
    (loaded.scene, written)
}
