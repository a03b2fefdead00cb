//! Where Embree's shared library may be.

use std::env;
use std::path::{Path, PathBuf};

use super::kernel::Device;
use crate::find;

/// Opens the first Embree 4 there is: `NESTRAY_EMBREE`, then by name wherever the system's loader
/// looks, then what `cargo xtask peers` has installed.
pub(super) fn open(threads: usize) -> Result<Device, String> {
    if let Some(path) = env::var_os("NESTRAY_EMBREE") {
        let path = Path::new(&path);
        return device(path, threads)
            .map_err(|error| format!("NESTRAY_EMBREE={}: {error}", path.display()));
    }
    let named = NAMES.iter().map(PathBuf::from);
    let is_right = |file: &str| file.trim_start_matches("lib").starts_with("embree4");
    for path in named.chain(find::installed(&is_right)) {
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
