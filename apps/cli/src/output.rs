//! Where results go.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use nestray::io::atomic::write_file;
use nestray::io::write::PictureFormat;

use crate::errors::{Failure, unless_closed};

/// Whether pictures can be written in the end; asked before the work begins.
pub(crate) fn check_pictures<'a>(
    paths: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<(), Failure> {
    for path in paths {
        PictureFormat::of(path)?;
        check(path)?;
    }
    Ok(())
}

/// Whether a file can be written in the end.
pub(crate) fn check(path: &Path) -> Result<(), Failure> {
    if path == Path::new("-") {
        return Ok(());
    }
    let fail = |reason: String| {
        let message = format!("{}: cannot be written: {reason}", path.display());
        Err(Failure::new(Failure::FAILED, message))
    };
    if path.is_dir() {
        return fail("it is a folder".into());
    }
    if path.exists() {
        return match std::fs::OpenOptions::new().append(true).open(path) {
            Ok(_) => Ok(()),
            Err(error) => fail(error.to_string()),
        };
    }
    let folder = match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    match tempfile::tempfile_in(folder) {
        Ok(_) => Ok(()),
        Err(error) => fail(std::io::Error::from(error.kind()).to_string()),
    }
}

/// Writes a file, or to standard output if it is called `-`.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    if path == Path::new("-") {
        return say_bytes(bytes);
    }
    write_file(path, |out| out.write_all(bytes)).map_err(|error| {
        let message = format!("{}: cannot be written: {error}", path.display());
        Failure::new(Failure::FAILED, message)
    })
}

/// Says something on standard output.
pub(crate) fn say(text: &str) -> Result<(), Failure> {
    say_bytes(text.as_bytes())
}

fn say_bytes(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    unless_closed(out.write_all(bytes).and_then(|()| out.flush()), "standard output")
}
