//! Where Embree's shared library may be.

use std::env;
use std::path::{Path, PathBuf};

use super::kernel::Device;

/// Opens the first Embree 4 there is: `NESTRAY_EMBREE`, then by name wherever the system's loader
/// looks, then what `cargo xtask peers` has installed.
pub(super) fn open(threads: usize) -> Result<Device, String> {
    if let Some(path) = env::var_os("NESTRAY_EMBREE") {
        let path = Path::new(&path);
        return device(path, threads)
            .map_err(|error| format!("NESTRAY_EMBREE={}: {error}", path.display()));
    }
    let named = NAMES.iter().map(PathBuf::from);
    for path in named.chain(installed()) {
        if let Ok(device) = device(&path, threads) {
            return Ok(device);
        }
    }
    Err("no libembree4 found; `cargo xtask peers` installs it, NESTRAY_EMBREE names it".into())
}

/// What the library is called.
const NAMES: &[&str] = if cfg!(windows) {
    &["embree4.dll"]
} else if cfg!(target_os = "macos") {
    &["libembree4.dylib", "libembree4.4.dylib"]
} else {
    &["libembree4.so.4", "libembree4.so"]
};

fn device(path: &Path, threads: usize) -> Result<Device, String> {
    let device = Device::open(path, threads)?;
    match device.version() {
        [4, ..] => Ok(device),
        [major, ..] => Err(format!("is version {major}, not 4")),
    }
}

/// Libraries in `peers` in the folder of builds, the folder above this program or a `target` above
/// the working folder.
fn installed() -> Vec<PathBuf> {
    let program = env::current_exe().unwrap_or_default();
    let working = env::current_dir().unwrap_or_default();
    let above = program.ancestors().map(|folder| folder.join("peers"));
    let targets = working.ancestors().map(|folder| folder.join("target/peers"));
    above.chain(targets).flat_map(|folder| libraries(&folder)).collect()
}

/// All files in a folder and those in it that are called like the library.
fn libraries(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = folder.read_dir() else { return Vec::new() };
    let mut found: Vec<PathBuf> = Vec::new();
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        if path.is_dir() && name.starts_with("embree") {
            found.extend(libraries(&path));
        } else if name.starts_with("libembree4") || name.starts_with("embree4") {
            found.push(path);
        }
    }
    found.sort();
    found
}
