//! `cargo xtask peers`: installs the libraries that `nestray bench --vs` compares with, in `peers`
//! in the folder of builds. What cannot be installed is named; the rest goes on.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// tinybvh's header, as this crate has it.
const TINYBVH: (&str, &str) = ("tinybvh-rs", "0.1.0-beta.3");

/// Puts a library into a folder, and says which.
type Install = fn(&Path) -> Result<String, String>;

/// Installs all; says what was done.
pub(crate) fn install(_: &[String]) -> Result<(), String> {
    let folder = target().join("peers");
    let peers: [(&str, Install); 3] = [("embree", embree), ("tinybvh", tinybvh), ("rust", rust)];
    let mut failed = Vec::new();
    for (name, install) in peers {
        println!("\n> {name}");
        let own = folder.join(name);
        let done = fs::create_dir_all(&own).map_err(text).and_then(|()| install(&own));
        match done {
            Ok(done) => println!("{name}: {done}"),
            Err(error) => {
                println!("{name}: not installed: {error}");
                failed.push(name);
            }
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("without {}", failed.join(", "))) }
}

/// The folder of builds.
pub(crate) fn target() -> PathBuf {
    let named = env::var_os("CARGO_TARGET_DIR").map(PathBuf::from);
    named.unwrap_or_else(|| root().join("target"))
}

/// The folder of the repository.
pub(crate) fn root() -> PathBuf {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    own.parent().map_or_else(|| own.to_owned(), Path::to_owned)
}

fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Runs a command to its end.
pub(crate) fn run(command: &mut Command) -> Result<(), String> {
    let name = command.get_program().to_string_lossy().into_owned();
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{name}: {status}")),
        Err(error) => Err(format!("{name} cannot be started: {error}")),
    }
}

/// The libraries in the wheel of the Python package embreex.
fn embree(folder: &Path) -> Result<String, String> {
    let wheels = folder.join("wheel");
    let python = ["python3", "python"]
        .into_iter()
        .find(|python| Command::new(python).arg("--version").output().is_ok())
        .ok_or("there is no Python to fetch it with; set NESTRAY_EMBREE instead")?;
    let fetch = ["-m", "pip", "download", "--no-deps", "--only-binary=:all:", "embreex", "--dest"];
    run(Command::new(python).args(fetch).arg(&wheels))?;
    let wheel = files(&wheels)?.into_iter().rfind(|path| ends(path, ".whl"));
    let wheel = wheel.ok_or("pip fetched no wheel")?;
    let open = folder.join("open");
    run(Command::new(python).args(["-m", "zipfile", "-e"]).args([&wheel, &open]))?;
    let mut names = Vec::new();
    for library in files(&open)?.iter().filter(|path| is_library(path)) {
        let name = library.file_name().ok_or("a file has a name")?;
        fs::copy(library, folder.join(name)).map_err(text)?;
        names.push(name.to_string_lossy().into_owned());
    }
    fs::remove_dir_all(&open).map_err(text)?;
    if !names.iter().any(|name| name.contains("embree4")) {
        return Err(format!("{} has no libembree4", wheel.display()));
    }
    Ok(names.join(", "))
}

/// Whether it is a shared library beside a Python module, not one itself.
fn is_library(path: &Path) -> bool {
    let folder = path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy();
    let beside = folder.ends_with(".libs") || folder == ".dylibs";
    beside && path.file_name().is_some_and(|name| name.to_string_lossy().contains(DLL_SUFFIX))
}

/// All files in a folder and below, in order.
fn files(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let (mut found, mut open) = (Vec::new(), vec![folder.to_owned()]);
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).map_err(text)? {
            let path = entry.map_err(text)?.path();
            if path.is_dir() { open.push(path) } else { found.push(path) }
        }
    }
    found.sort();
    Ok(found)
}

fn ends(path: &Path, with: &str) -> bool {
    path.to_string_lossy().ends_with(with)
}

/// A small library of our own around tinybvh's header, compiled for this machine.
fn tinybvh(folder: &Path) -> Result<String, String> {
    let (name, version) = TINYBVH;
    let manifest = format!(
        "[package]\nname = \"header\"\nedition = \"2024\"\n\n[dependencies]\n\
         {name} = \"={version}\"\n\n[workspace]\n"
    );
    fs::create_dir_all(folder.join("src")).map_err(text)?;
    fs::write(folder.join("src/lib.rs"), "").map_err(text)?;
    fs::write(folder.join("Cargo.toml"), manifest).map_err(text)?;
    // Packages of other systems are fetched too, but only one header is used.
    let vendor = ["vendor", "--quiet", "--versioned-dirs"];
    run(Command::new(env!("CARGO")).args(vendor).current_dir(folder))?;
    let header = folder.join(format!("vendor/{name}-{version}/ffi/tinybvh"));
    let compiler = env::var_os("CXX").unwrap_or_else(|| "c++".into());
    let library = folder.join(format!("{DLL_PREFIX}nestray_peers_tinybvh{DLL_SUFFIX}"));
    let flags = ["-std=c++20", "-O3", "-march=native", "-fPIC", "-shared", "-w", "-I"];
    let own = root().join("crates/peers/tinybvh/tinybvh.cpp");
    run(Command::new(compiler).args(flags).args([&header, &own]).arg("-o").arg(&library))?;
    Ok(library.display().to_string())
}

/// The libraries in Rust, compiled for this machine.
fn rust(folder: &Path) -> Result<String, String> {
    let name = format!("{DLL_PREFIX}nestray_peers_rust{DLL_SUFFIX}");
    let build = ["build", "--release", "-p", "nestray-rust-peers", "--target-dir"];
    let mut cargo = Command::new(env!("CARGO"));
    cargo.current_dir(root()).args(build).arg(folder.join("build"));
    run(cargo.env("RUSTFLAGS", "-C target-cpu=native"))?;
    let library = folder.join(&name);
    fs::copy(folder.join("build/release").join(&name), &library).map_err(text)?;
    Ok(library.display().to_string())
}
