//! The folder of scenes that are not ours to give away, if it is there.

use std::path::{Path, PathBuf};

use nestray_io::load::{LoadOptions, load};
use nestray_scene::scene::Scene;

/// The files of a folder of test scenes with one of some endings, in order, no larger than
/// `most` bytes. Says so if the folder is not there.
#[must_use]
pub fn files(folder: &str, endings: &[&str], most: u64) -> Vec<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes");
    let folder = std::env::var_os("NESTRAY_SCENES").map_or(beside, PathBuf::from).join(folder);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        eprintln!("skipped: no test scenes at {}; set NESTRAY_SCENES", folder.display());
        return Vec::new();
    };
    let fits = |path: &PathBuf| {
        let ending = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        let size = std::fs::metadata(path).map_or(u64::MAX, |data| data.len());
        endings.contains(&ending) && size <= most
    };
    let mut files: Vec<PathBuf> =
        entries.filter_map(|entry| Some(entry.ok()?.path())).filter(fits).collect();
    files.sort();
    files
}

/// What a file is called in messages.
#[must_use]
pub fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The scene of a file.
///
/// # Panics
/// If it cannot be read: these files are known to be sound.
#[must_use]
pub fn scene(path: &Path) -> Scene {
    match load(path, &LoadOptions::default()) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}"),
    }
}
