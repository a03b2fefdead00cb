//! glTF 2.0, as text and binary (GLB).
//!
//! Every mesh becomes a group, every node that has one a place of it, so that what the file
//! shares is stored once. Nodes that an animation moves, and what hangs on them, become nodes of
//! the scene's animation; all others stand still. Whatever a file promises is checked before
//! it is used.

mod accessor;
mod animation;
mod buffers;
mod camera;
mod document;
mod material;
mod mesh;
mod nodes;
mod primitive;
mod skin;
mod texture;

#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use nestray_scene::scene::Scene;

use self::buffers::Bytes;
use self::document::{Document, KNOWN_EXTENSIONS};
use crate::error::LoadError;
use crate::json;
use crate::load::{Loaded, Source};

/// The first bytes of a binary file.
const MAGIC: &[u8] = b"glTF";

/// Whether these may be the first bytes of a glTF file.
#[must_use]
pub fn begins(bytes: &[u8]) -> bool {
    if bytes.starts_with(MAGIC) {
        return true;
    }
    let head = json::without_mark(bytes);
    let head = String::from_utf8_lossy(&head[..head.len().min(1 << 16)]);
    head.trim_start().starts_with('{') && head.contains("\"asset\"")
}

/// Reads a scene from the bytes of a `.gltf` or `.glb` file.
///
/// Units are taken as they are: candela and lux become radiant intensity and irradiance of the
/// same number, as most viewers do it.
///
/// # Errors
/// If the bytes are no sound glTF 2.0 document, or geometry is packed in a way that is not
/// read.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    let fail = |message: String| source.spot().error(message);
    let (text, inside) = split(bytes).map_err(fail)?;
    let document: Document = serde_json::from_slice(json::without_mark(text))
        .map_err(|error| json::located(&error, source.spot()))?;
    match document.asset.min_version.as_ref().or(document.asset.version.as_ref()) {
        Some(version) if version.starts_with("2.") => {}
        Some(version) => {
            return Err(fail(format!("is glTF {}; 2.0 is read", version.escape_debug())));
        }
        None => return Err(fail("is no glTF file: it has no asset.version".into())),
    }
    let buffers = buffers::load(&document, inside, source);
    let mut reader = Reader::new(&document, &buffers, bytes.len(), source);
    reader.warn_of_extensions();
    reader.read().map_err(fail)?;
    let warnings = reader.warnings.into_iter().map(|text| source.spot().warning(text)).collect();
    Ok(Loaded { scene: reader.scene, warnings })
}

/// The JSON, and the bytes that a binary file carries along.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), String> {
    let Some(rest) = bytes.strip_prefix(MAGIC) else { return Ok((bytes, None)) };
    let (version, rest) = number(rest)?;
    if version != 2 {
        return Err(format!("is binary glTF of version {version}; 2 is read"));
    }
    let (length, rest) = number(rest)?;
    if length as usize > bytes.len() {
        return Err(format!("ends after {} bytes; {length} are promised", bytes.len()));
    }
    let (text, rest) = chunk(rest, b"JSON")?.ok_or("does not begin with JSON")?;
    Ok((text, chunk(rest, b"BIN\0")?.map(|(inside, _)| inside)))
}

/// Bytes in two.
type Parts<'a> = (&'a [u8], &'a [u8]);

/// The content of the next chunk, and what follows; none if it is of another kind or the file
/// ends.
fn chunk<'a>(bytes: &'a [u8], kind: &[u8]) -> Result<Option<Parts<'a>>, String> {
    if bytes.len() < 8 {
        return Ok(None);
    }
    let (length, rest) = number(bytes)?;
    let Some(rest) = rest.strip_prefix(kind) else { return Ok(None) };
    match rest.split_at_checked(length as usize) {
        Some(parts) => Ok(Some(parts)),
        None => Err(format!("a chunk of {length} bytes has only {}", rest.len())),
    }
}

fn number(bytes: &[u8]) -> Result<(u32, &[u8]), String> {
    let (number, rest) = bytes.split_first_chunk().ok_or("ends in its head")?;
    Ok((u32::from_le_bytes(*number), rest))
}

fn take(left: &mut usize, elements: usize) -> Result<(), String> {
    let too_much = || "there is far more data than the bytes of the file can mean".to_owned();
    *left = left.checked_sub(elements).ok_or_else(too_much)?;
    Ok(())
}

/// A document on its way to a scene.
struct Reader<'a> {
    document: &'a Document,
    buffers: &'a [Bytes<'a>],
    source: &'a Source,
    scene: Scene,
    warnings: Vec<String>,
    warned: BTreeSet<String>,
    /// The size of the document and its buffers.
    bytes: usize,
    /// How many elements may still be read.
    left: usize,
    /// How many elements may still become part of the scene.
    room: usize,
    textures: texture::Textures,
    materials: material::Materials,
    meshes: mesh::Meshes,
}

impl<'a> Reader<'a> {
    fn new(
        document: &'a Document,
        buffers: &'a [Bytes<'a>],
        bytes: usize,
        source: &'a Source,
    ) -> Self {
        /// How often each byte may be read on average. Sharing is good, but a small file must
        /// not take for ever,
        const OFTEN: usize = 256;
        /// nor become a huge scene: at worst a byte is a corner of a strip, and so a triangle.
        const GROWTH: usize = 16;
        let there = |bytes: &Bytes<'_>| if let Bytes::There(b) = bytes { b.len() } else { 0 };
        let bytes = buffers.iter().map(there).fold(bytes, usize::saturating_add);
        Self {
            document,
            buffers,
            source,
            scene: Scene::new(),
            warnings: Vec::new(),
            warned: BTreeSet::new(),
            bytes,
            left: bytes.saturating_mul(OFTEN),
            room: bytes.saturating_mul(GROWTH),
            textures: texture::Textures::default(),
            materials: material::Materials::default(),
            meshes: mesh::Meshes::default(),
        }
    }

    fn read(&mut self) -> Result<(), String> {
        let nodes = self.nodes()?;
        self.read_animation(&nodes)?;
        self.place_nodes(&nodes)
    }

    /// Says something once.
    fn warn(&mut self, text: String) {
        if self.warned.insert(text.clone()) {
            self.warnings.push(text);
        }
    }

    /// Counts elements that are read.
    fn spend(&mut self, elements: usize) -> Result<(), String> {
        take(&mut self.left, elements)
    }

    /// Counts elements that stay.
    fn keep(&mut self, elements: usize) -> Result<(), String> {
        take(&mut self.room, elements)
    }

    fn warn_of_extensions(&mut self) {
        let document = self.document;
        let unknown = |name: &&String| !KNOWN_EXTENSIONS.contains(&name.as_str());
        for name in document.extensions_required.iter().filter(unknown) {
            let name = name.escape_debug();
            self.warn(format!("extension {name} is required, but not read: it may look wrong"));
        }
        for name in document.extensions_used.iter().filter(unknown) {
            if !document.extensions_required.contains(name) {
                self.warn(format!("extension {} is not read", name.escape_debug()));
            }
        }
    }
}
