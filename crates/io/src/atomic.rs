//! Files that are either written whole or not touched at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

/// Writes a file by way of a temporary one in the same folder, which takes its name once all
/// of it is on the disk. If anything goes wrong an old file stays as it was, and nothing new
/// is left behind. What is no plain file, such as a device, is written to directly.
///
/// # Errors
/// Those of `write`, and of the file system.
pub fn write_file(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let target = target(path)?;
    let old = match fs::metadata(&target) {
        Ok(old) if old.is_dir() => return Err(io::Error::other("it is a folder")),
        Ok(old) => Some(old),
        Err(_) => None,
    };
    if let Some(old) = &old {
        // Also refuses a file that may not be written to, which a rename would not.
        let file = OpenOptions::new().write(true).open(&target)?;
        if !old.is_file() {
            return fill(&file, write);
        }
    }
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let temporary = temporary(folder)?;
    fill(temporary.as_file(), write)?;
    if let Some(old) = old {
        fs::set_permissions(temporary.path(), old.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(&target).map_err(|error| error.error)?;
    // The new name too; a file system that cannot do that has still got the file.
    if let Ok(folder) = File::open(folder) {
        let _ = folder.sync_all();
    }
    Ok(())
}

/// The file meant by a path: links are followed, so that they stay links.
fn target(path: &Path) -> io::Result<PathBuf> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_symlink() => fs::canonicalize(path),
        _ => Ok(path.to_path_buf()),
    }
}

fn temporary(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".nestray-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // As any new file: the mask of the process still applies.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    // Without the name of the temporary file, which nobody asked for.
    builder.tempfile_in(folder).map_err(|error| io::Error::from(error.kind()))
}

fn fill(
    file: &File,
    write: impl FnOnce(&mut BufWriter<&File>) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, file);
    let written = write(&mut out).and_then(|()| out.flush());
    // What is left in the buffer must not be tried again when it is dropped.
    let _ = out.into_parts();
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("it is there");
        entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_failure_half_way_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        write_file(&path, |out| out.write_all(b"old")).expect("writable");
        let failed = write_file(&path, |out| {
            out.write_all(&[b'x'; 200_000])?;
            Err(io::Error::other("half way"))
        });
        assert_eq!(failed.expect_err("it failed").to_string(), "half way");
        assert_eq!(fs::read(&path).expect("there"), b"old");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_new_file_replaces_the_old_one_whole() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        for text in ["a longer first text", "second"] {
            write_file(&path, |out| out.write_all(text.as_bytes())).expect("writable");
            assert_eq!(fs::read_to_string(&path).expect("there"), text);
        }
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_folder_or_a_place_below_a_file_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(write_file(folder.path(), |_| Ok(())).is_err());
        let file = folder.path().join("file");
        fs::write(&file, "x").expect("writable");
        assert!(write_file(&file.join("below"), |_| Ok(())).is_err());
        assert!(write_file(&folder.path().join("none/here"), |_| Ok(())).is_err());
        assert_eq!(names(folder.path()), ["file"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_mode_stays_a_mode() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").expect("writable");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("ours");
        std::os::unix::fs::symlink("file", &link).expect("writable");
        write_file(&link, |out| out.write_all(b"new")).expect("writable");
        assert_eq!(fs::read(&file).expect("there"), b"new");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::metadata(&file).expect("there").permissions().mode() & 0o777, 0o640);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error() {
        let full = write_file(Path::new("/dev/full"), |out| out.write_all(b"x"));
        assert_eq!(full.expect_err("it is full").kind(), io::ErrorKind::StorageFull);
    }
}
