//! Reading a scene of whatever format.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;
use glam::Vec3A;
use nestray_scene::scene::Scene;

use crate::complete;
use crate::error::{LoadError, Spot, Warning};
use crate::{gltf, native, nff, obj, off, ply, stl};

/// What readers may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LoadOptions {
    /// Most bytes a file may have, after unpacking.
    pub max_bytes: u64,
    /// Whether a scene without a camera or light is given one.
    pub complete: bool,
}

/// A scene, and what was odd about the file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene.
    pub scene: Scene,
    /// What was passed over or put right.
    pub warnings: Vec<Warning>,
}

/// Where bytes come from: the file named in messages, and whose folder other files it names
/// are looked for in.
#[derive(Clone, Debug)]
pub struct Source {
    /// The file.
    pub path: PathBuf,
    /// What may be done.
    pub options: LoadOptions,
}

/// A format of scene files.
struct Format {
    /// Lower case, without dot.
    extensions: &'static [&'static str],
    /// Whether a file may be of it, by its first bytes; asked if the extension says nothing.
    begins: fn(&[u8]) -> bool,
    /// Which way is up where nothing says so.
    up: Vec3A,
    read: fn(&[u8], &Source) -> Result<Loaded, LoadError>,
}

/// All formats; of those that a file may be of by its first bytes, the first.
const FORMATS: &[Format] = &[
    Format { extensions: &["nff"], begins: nff::begins, up: Vec3A::Y, read: nff::read },
    Format { extensions: &["obj"], begins: obj::begins, up: Vec3A::Y, read: obj::read },
    Format { extensions: &["ply"], begins: ply::begins, up: Vec3A::Y, read: ply::read },
    Format { extensions: &["stl"], begins: stl::begins, up: Vec3A::Z, read: stl::read },
    Format { extensions: &["off"], begins: off::begins, up: Vec3A::Y, read: off::read },
    Format { extensions: &["gltf", "glb"], begins: gltf::begins, up: Vec3A::Y, read: gltf::read },
    Format { extensions: &["json"], begins: native::begins, up: Vec3A::Y, read: native::read },
];

impl Default for LoadOptions {
    /// Files up to 4 GiB; scenes are completed.
    fn default() -> Self {
        Self { max_bytes: 4 << 30, complete: true }
    }
}

impl Source {
    /// A file, read with the usual options.
    #[must_use]
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into(), options: LoadOptions::default() }
    }

    /// The file as a whole, in messages.
    #[must_use]
    pub fn spot(&self) -> Spot {
        Spot::file(&self.path)
    }

    /// A line of the file, in messages.
    #[must_use]
    pub fn line(&self, line: usize) -> Spot {
        Spot { line, ..self.spot() }
    }

    /// Where a file that this one names is, or should be: as named, with backslashes between
    /// folders, or else, whatever folder is named, next to this one.
    #[must_use]
    pub fn companion(&self, name: &str) -> PathBuf {
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let slashed = name.replace('\\', "/");
        let alone = slashed.rsplit('/').next().unwrap_or_default();
        let places = [name, &slashed, alone].map(|name| folder.join(name));
        let found = places.iter().find(|place| place.is_file());
        found.unwrap_or(&places[1]).clone()
    }

    /// The bytes of another file, unpacked; only of a true file, no device or pipe.
    ///
    /// # Errors
    /// If it cannot be read or is too large.
    pub fn companion_bytes(&self, path: &Path) -> Result<Vec<u8>, LoadError> {
        let spot = Spot::file(path);
        let data = std::fs::metadata(path).map_err(|e| spot.clone().error(e.to_string()))?;
        if !data.is_file() {
            return Err(spot.error("is not a file"));
        }
        bytes_of(path, &self.options)
    }
}

/// Reads a scene. Its format is told by the extension, before any `.gz`, or else by its
/// content.
///
/// # Errors
/// If the file cannot be read, or makes no scene.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, LoadError> {
    let bytes = bytes_of(path, options)?;
    read(&bytes, &Source { path: path.to_owned(), options: *options })
}

/// Reads a scene from bytes; see [`load`].
///
/// # Errors
/// If the bytes make no scene.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    let unpacked;
    let bytes = if is_packed(bytes) {
        unpacked = unpack(bytes, &source.spot(), &source.options)?;
        &unpacked
    } else {
        bytes
    };
    let extension = extension(&source.path);
    let format = FORMATS
        .iter()
        .find(|format| format.extensions.contains(&extension.as_str()))
        .or_else(|| FORMATS.iter().find(|format| (format.begins)(bytes)));
    let Some(format) = format else {
        let known: Vec<&str> =
            FORMATS.iter().flat_map(|format| format.extensions).copied().collect();
        let message = if bytes.is_empty() { "is empty" } else { "is of no known format" };
        return Err(source.spot().error(message).hint(format!("known are {}", known.join(", "))));
    };
    let mut loaded = (format.read)(bytes, source)?;
    if source.options.complete {
        complete::complete(&mut loaded.scene, format.up);
    }
    loaded.scene.check().map_err(|error| source.spot().error(error.to_string()))?;
    Ok(loaded)
}

/// The extension in lower case, that before `.gz` if it is that; may be empty.
fn extension(path: &Path) -> String {
    let of = |path: &Path| {
        path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase()).unwrap_or_default()
    };
    match of(path).as_str() {
        "gz" => of(Path::new(path.file_stem().unwrap_or_default())),
        other => other.to_owned(),
    }
}

/// The bytes of a file, unpacked if it is packed by gzip.
///
/// # Errors
/// If it cannot be read, or is larger than the options allow.
pub fn bytes_of(path: &Path, options: &LoadOptions) -> Result<Vec<u8>, LoadError> {
    let spot = Spot::file(path);
    let fail = |e: std::io::Error| spot.clone().error(e.to_string());
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(fail)?;
    file.take(options.max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(fail)?;
    if bytes.len() as u64 > options.max_bytes {
        return Err(spot.error(format!("has more than {} bytes", options.max_bytes)));
    }
    if is_packed(&bytes) { unpack(&bytes, &spot, options) } else { Ok(bytes) }
}

fn is_packed(bytes: &[u8]) -> bool {
    bytes.starts_with(&[0x1f, 0x8b])
}

/// Undoes gzip, as far as allowed: a small file may claim to be, and be, endless.
fn unpack(bytes: &[u8], spot: &Spot, options: &LoadOptions) -> Result<Vec<u8>, LoadError> {
    /// Scenes of text or numbers pack to a third or a tenth; this much is no scene.
    const RATIO: u64 = 250;
    /// So small that the ratio does not matter.
    const SMALL: u64 = 64 << 20;
    let limit = options.max_bytes.min((bytes.len() as u64).saturating_mul(RATIO).max(SMALL));
    let mut unpacked = Vec::new();
    MultiGzDecoder::new(bytes)
        .take(limit + 1)
        .read_to_end(&mut unpacked)
        .map_err(|e| spot.clone().error(format!("cannot be unpacked: {e}")))?;
    if unpacked.len() as u64 > limit {
        return Err(spot.clone().error(format!("unpacks to more than {limit} bytes")));
    }
    Ok(unpacked)
}
