//! Where `cargo xtask peers` installs libraries.

use std::env;
use std::path::{Path, PathBuf};

/// Files whose names are right in a folder called `peers`, or in one in it: beside this program or
/// above, or in a `target` above the working folder.
pub(crate) fn installed(is_right: &dyn Fn(&str) -> bool) -> Vec<PathBuf> {
    let program = env::current_exe().unwrap_or_default();
    let working = env::current_dir().unwrap_or_default();
    let above = program.ancestors().map(|folder| folder.join("peers"));
    let targets = working.ancestors().map(|folder| folder.join("target/peers"));
    let mut found: Vec<PathBuf> = Vec::new();
    for folder in above.chain(targets) {
        let inside = entries(&folder).into_iter().filter(|path| path.is_dir());
        let files = entries(&folder).into_iter().chain(inside.flat_map(|path| entries(&path)));
        found.extend(files.filter(|path| {
            let name = path.file_name().and_then(|name| name.to_str());
            path.is_file() && name.is_some_and(is_right)
        }));
    }
    found
}

/// What is in a folder, in order; nothing if it is none.
fn entries(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = folder.read_dir() else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    paths
}
