//! Pictures out, in the format that the name of the file asks for.

use std::io;
use std::path::{Path, PathBuf};

use nestray_scene::picture::{Layer, Picture};

use crate::atomic::write_file;
use crate::{exr, pfm, png};

/// Formats pictures can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// Eight bits a channel, for looking at.
    Png,
    /// All layers, in floating point.
    Exr,
    /// The first layer, in floating point.
    Pfm,
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// The name of the file ends in no format that can be written.
    #[error("{}: unknown kind of file; {known} can be written", path.display())]
    Unknown {
        /// Which file.
        path: PathBuf,
        /// Endings that are known.
        known: &'static str,
    },
    /// What was to be written does not fit the format.
    #[error("{}: {reason}", path.display())]
    Content {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The file system said no.
    #[error("{}: cannot be written: {source}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What it said.
        source: io::Error,
    },
}

impl PictureFormat {
    /// The format that a name asks for: `.png`, `.exr` or `.pfm`, in any case.
    ///
    /// # Errors
    /// If it ends in something else.
    pub fn of(path: &Path) -> Result<Self, WriteError> {
        let ending = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
        match ending.as_deref() {
            Some("png") => Ok(Self::Png),
            Some("exr") => Ok(Self::Exr),
            Some("pfm") => Ok(Self::Pfm),
            _ => Err(WriteError::Unknown { path: path.into(), known: ".png, .exr and .pfm" }),
        }
    }
}

/// Writes a picture in the format that `path` asks for; see [`write_file`] for what happens
/// to an old file.
///
/// PNG files hold `shown`: three or four bytes a pixel, tone-mapped, on the sRGB curve. Without
/// it they hold the first layer on that curve, what is brighter than 1 cut off.
///
/// # Errors
/// If the format is not known, the picture is not sound (a layer of the wrong size, no colours
/// for a format that needs them), or the file cannot be written.
pub fn write_picture(
    path: &Path,
    picture: &Picture,
    shown: Option<&[u8]>,
) -> Result<(), WriteError> {
    let format = PictureFormat::of(path)?;
    let content = |reason| WriteError::Content { path: path.into(), reason };
    check(picture).map_err(content)?;
    match format {
        PictureFormat::Png => {
            let bytes = match shown {
                Some(bytes) => bytes.to_vec(),
                None => png::bytes(picture).map_err(content)?,
            };
            let pixels = picture.width * picture.height;
            if bytes.len() != 3 * pixels && bytes.len() != 4 * pixels {
                return Err(content(format!("{} bytes for {pixels} pixels", bytes.len())));
            }
            let size = [picture.width, picture.height];
            write_file(path, |out| png::write(out, size, &bytes))
        }
        PictureFormat::Exr => {
            write_file(path, |out| exr::write(out, picture, exr::Precision::Float))
        }
        PictureFormat::Pfm => {
            let layer = pfm::layer(picture).map_err(content)?;
            write_file(path, |out| pfm::write(out, [picture.width, picture.height], &layer))
        }
    }
    .map_err(|source| WriteError::File { path: path.into(), source })
}

/// Whether sizes agree and every channel has a name of its own.
fn check(picture: &Picture) -> Result<(), String> {
    let pixels = picture.width.checked_mul(picture.height).filter(|&pixels| pixels > 0);
    let Some(pixels) = pixels.filter(|_| picture.width.max(picture.height) < 1 << 31) else {
        return Err(format!("a picture of {} × {} pixels", picture.width, picture.height));
    };
    let mut names: Vec<String> = Vec::new();
    for layer in &picture.layers {
        if Some(layer.samples.len()) != pixels.checked_mul(layer.channels.len()) {
            let (found, channels) = (layer.samples.len(), layer.channels.len());
            return Err(format!("{found} samples for {pixels} pixels of {channels} channels"));
        }
        names.extend(layer.channels.iter().map(|channel| full_name(layer, channel)));
    }
    names.sort();
    match names.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(format!("two channels called `{}`", pair[0])),
        None if names.is_empty() => Err("a picture without channels".into()),
        None => Ok(()),
    }
}

/// What a channel is called in a file of many layers.
pub(crate) fn full_name(layer: &Layer, channel: &str) -> String {
    if layer.name.is_empty() { channel.into() } else { format!("{}.{channel}", layer.name) }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn picture() -> Picture {
        Picture::rgb(2, 2, &[[0.0; 3], [0.25; 3], [0.5; 3], [1.0; 3]])
    }

    #[test]
    fn the_name_decides_on_the_format() {
        for (name, format) in [
            ("a.png", PictureFormat::Png),
            ("b.c.EXR", PictureFormat::Exr),
            ("d.pfm", PictureFormat::Pfm),
        ] {
            assert_eq!(PictureFormat::of(Path::new(name)).expect("known"), format);
        }
        let unknown = write_picture(Path::new("a.tga"), &picture(), None).expect_err("unknown");
        assert_eq!(
            unknown.to_string(),
            "a.tga: unknown kind of file; .png, .exr and .pfm can be written"
        );
    }

    #[test]
    fn what_cannot_be_written_is_named_in_one_line_and_the_old_file_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        for ending in ["png", "exr", "pfm"] {
            let nowhere = folder.path().join("none").join("a").with_extension(ending);
            let error = write_picture(&nowhere, &picture(), None).expect_err("no such folder");
            let line = error.to_string();
            assert!(
                line.contains(&nowhere.display().to_string()) && !line.contains('\n'),
                "{line}"
            );
            assert!(!line.contains(".part"), "{line}");

            let old = folder.path().join("old").with_extension(ending);
            fs::write(&old, "old").expect("writable");
            let mut wrong = picture();
            wrong.layers[0].samples.pop();
            write_picture(&old, &wrong, None).expect_err("a sample is missing");
            assert_eq!(fs::read(&old).expect("there"), b"old");
            write_picture(&old, &picture(), None).expect("writable");
            assert_ne!(fs::read(&old).expect("there"), b"old");
        }
        assert_eq!(fs::read_dir(folder.path()).expect("there").count(), 3);
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        let folder = tempfile::tempdir().expect("a folder");
        let pixels: Vec<[f32; 3]> = (0..300 * 200).map(|i| [i as f32, 0.5, -1.0]).collect();
        let picture = Picture::rgb(300, 200, &pixels);
        for ending in ["png", "exr", "pfm"] {
            let [a, b] = ["a", "b"].map(|name| {
                let path = folder.path().join(name).with_extension(ending);
                write_picture(&path, &picture, None).expect("writable");
                fs::read(path).expect("there")
            });
            assert!(a == b, "{ending}");
        }
    }

    #[test]
    fn pictures_that_make_no_sense_are_refused() {
        let path = Path::new("never-written.exr");
        let refused = |picture: &Picture| {
            write_picture(path, picture, None).expect_err("it makes no sense").to_string()
        };
        assert!(refused(&Picture::default()).contains("0 × 0"));
        let mut twice = picture();
        twice.layers.push(twice.layers[0].clone());
        assert!(refused(&twice).contains("two channels called `B`"));
        assert!(refused(&Picture { layers: Vec::new(), ..picture() }).contains("without channels"));
        assert!(!path.exists());
    }
}
