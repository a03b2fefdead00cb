//! `nestray convert`.

use std::path::Path;

use nestray::io::atomic::write_file;
use nestray::io::load::LoadOptions;
use nestray::io::native::write_native;
use nestray::io::nff::write::{NffError, write_nff};
use nestray::io::write::WriteError;
use nestray::scene::scene::Scene;

use crate::args::{ConvertArgs, Talk};
use crate::errors::Failure;
use crate::progress::Progress;
use crate::{input, output, stop};

/// A format that scenes can be written in.
enum Format {
    Native,
    Nff,
}

pub(crate) fn run(args: &ConvertArgs, talk: &Talk) -> Result<(), Failure> {
    let progress = Progress::new(talk);
    check(&args.output)?;
    output::check(&args.output)?;
    let options = LoadOptions { complete: false, ..LoadOptions::default() };
    let scene = input::scene(&args.scene, &options, &progress)?;
    stop::check()?;
    write(&args.output, &scene, progress)
}

/// Whether a file asks for a format that can be written.
pub(crate) fn check(path: &Path) -> Result<(), Failure> {
    Ok(format(path).map(|_| ())?)
}

fn format(path: &Path) -> Result<Format, WriteError> {
    let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match ending.as_deref() {
        Some("json") => Ok(Format::Native),
        Some("nff") => Ok(Format::Nff),
        _ => Err(WriteError::Unknown { path: path.into(), known: ".json and .nff" }),
    }
}

/// Writes a scene in the format that the file asks for.
pub(crate) fn write(path: &Path, scene: &Scene, progress: Progress) -> Result<(), Failure> {
    match format(path)? {
        Format::Native => write_native(scene, path)?,
        Format::Nff => write_file(path, |out| match write_nff(scene, out) {
            Err(NffError::Io(error)) => Err(error),
            other => other.map_err(std::io::Error::other),
        })
        .map_err(|error| {
            let message = format!("{}: cannot be written: {error}", path.display());
            Failure::new(Failure::FAILED, message)
        })?,
    }
    let primitives: u64 = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
    progress.note(&format!("{}: {primitives} primitives", path.display()));
    Ok(())
}
