//! OFF: meshes as text, vertices and faces with or without colours.

use nestray_scene::texture::linear_from_srgb;

use crate::error::LoadError;
use crate::load::{Loaded, Source};
use crate::mesh::{Polygons, Vertices};
use crate::words::{Word, Words};

/// What a vertex has besides its place.
#[derive(Clone, Copy, Debug, Default)]
struct Extras {
    uvs: bool,
    colors: bool,
    normals: bool,
}

/// What has been read.
#[derive(Debug, Default)]
struct Mesh {
    vertices: Vertices,
    polygons: Polygons,
    /// Whether there are colours of faces, which are left out.
    colored_faces: bool,
}

/// Whether a file may be OFF.
pub(crate) fn begins(bytes: &[u8]) -> bool {
    let end = bytes.iter().position(u8::is_ascii_whitespace).unwrap_or(bytes.len());
    bytes[..end.min(8)].ends_with(b"OFF")
}

/// Reads a mesh: polygons of any number of corners; normals, colours and texture coordinates
/// of vertices.
///
/// # Errors
/// If the bytes are no OFF file, end too early, or a face names a vertex that is not there.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    let mut words = Words::new(bytes, source).with_comments();
    let mut first = words.expect("`OFF`")?;
    let mut extras = Extras::default();
    // Some files leave the word out.
    if first.whole().is_none() {
        extras = Extras::read(&words, &first)?;
        first = words.expect("the number of vertices")?;
        if first.bytes == b"BINARY" {
            let error = words.spot(&first).error("binary OFF files are not read");
            return Err(error.hint("save it as text, or as PLY"));
        }
    }
    let count = |found: Option<i64>| found.and_then(|count| usize::try_from(count).ok());
    let vertices =
        count(first.whole()).ok_or_else(|| words.unfit(&first, "the number of vertices"))?;
    let word = words.expect("the number of faces")?;
    let faces = count(word.whole()).ok_or_else(|| words.unfit(&word, "the number of faces"))?;
    // The number of edges is often wrong or not there.
    words.rest();
    // Three digits and blanks a vertex, two a face.
    if vertices as u128 * 6 + faces as u128 * 2 > words.left() as u128 + 1 {
        let message = format!(
            "{vertices} vertices and {faces} faces do not fit in the {} bytes that are left",
            words.left()
        );
        return Err(words.spot(&first).error(message));
    }
    let mut mesh = Mesh::default();
    mesh.vertices(&mut words, vertices, extras)?;
    mesh.faces(&mut words, faces)?;
    mesh.finish(source)
}

impl Extras {
    /// From the first word: any of `ST`, `C` and `N` before `OFF`.
    fn read(words: &Words<'_>, word: &Word<'_>) -> Result<Self, LoadError> {
        let prefix = word.bytes.strip_suffix(b"OFF");
        let mut prefix = prefix.ok_or_else(|| words.unfit(word, "`OFF`"))?;
        let mut take = |what: &[u8]| match prefix.strip_prefix(what) {
            Some(rest) => {
                prefix = rest;
                true
            }
            None => false,
        };
        let extras = Self { uvs: take(b"ST"), colors: take(b"C"), normals: take(b"N") };
        if !prefix.is_empty() {
            let error = words.spot(word).error(format!("OFF files of kind {word} are not read"));
            return Err(error.hint("points of four or more coordinates have no picture"));
        }
        Ok(extras)
    }
}

impl Mesh {
    fn vertices(
        &mut self,
        words: &mut Words<'_>,
        count: usize,
        extras: Extras,
    ) -> Result<(), LoadError> {
        self.vertices.positions.reserve_exact(count);
        for _ in 0..count {
            self.vertices.positions.push(words.triple("a coordinate")?);
            if extras.normals {
                self.vertices.normals.push(words.triple("a normal")?);
            }
            if extras.colors {
                let mut rest = Vec::with_capacity(6);
                while let Some(word) = words.on_line() {
                    rest.push(word);
                }
                let uv =
                    if extras.uvs { rest.split_off(rest.len().saturating_sub(2)) } else { vec![] };
                self.vertices.colors.push(color(words, &rest)?);
                if extras.uvs {
                    let [u, v] = *uv else {
                        return Err(words.here().error("a vertex without texture coordinates"));
                    };
                    let number = |word: &Word<'_>| {
                        word.number().ok_or_else(|| words.unfit(word, "a texture coordinate"))
                    };
                    self.vertices.uvs.push([number(&u)?, 1.0 - number(&v)?]);
                }
            } else if extras.uvs {
                let what = "a texture coordinate";
                self.vertices.uvs.push([words.number(what)?, 1.0 - words.number(what)?]);
            }
        }
        Ok(())
    }

    fn faces(&mut self, words: &mut Words<'_>, count: usize) -> Result<(), LoadError> {
        let vertices = self.vertices.positions.len();
        for _ in 0..count {
            let word = words.expect("a number of corners")?;
            let corners = word.whole().filter(|&n| n >= 0 && n as usize <= words.left());
            let corners = corners.ok_or_else(|| words.unfit(&word, "a number of corners"))?;
            for _ in 0..corners {
                let word = words.expect("a vertex")?;
                let index = word.whole().ok_or_else(|| words.unfit(&word, "a vertex"))?;
                let found = u32::try_from(index).ok().filter(|&index| (index as usize) < vertices);
                self.polygons.corners.push(found.ok_or_else(|| {
                    let message = format!("a face names vertex {index}, but there are {vertices}");
                    words.spot(&word).error(message)
                })?);
            }
            self.polygons.end_face();
            self.colored_faces |= !words.rest().is_empty();
        }
        Ok(())
    }

    fn finish(self, source: &Source) -> Result<Loaded, LoadError> {
        let mut warnings = Vec::new();
        if self.colored_faces {
            warnings.push(source.spot().warning("colours of faces are left out"));
        }
        let faces = self.polygons.triangles(&self.vertices.positions, source, &mut warnings);
        self.vertices.finish(faces, source, warnings)
    }
}

/// A colour of three or four numbers: whole ones up to 255, or fractions up to 1.
fn color(words: &Words<'_>, given: &[Word<'_>]) -> Result<[f32; 4], LoadError> {
    let fraction = given.iter().any(|word| word.bytes.contains(&b'.'));
    let mut color = [1.0; 4];
    if !(3..=4).contains(&given.len()) {
        let message = format!("a colour of {} numbers", given.len());
        return Err(words.here().error(message));
    }
    for (channel, word) in given.iter().enumerate() {
        let number = word.number().ok_or_else(|| words.unfit(word, "a colour"))?;
        color[channel] = if fraction { number } else { number / 255.0 };
    }
    let [r, g, b, a] = color;
    Ok([linear_from_srgb(r), linear_from_srgb(g), linear_from_srgb(b), a])
}

#[cfg(test)]
mod tests {
    use nestray_scene::geometry::Content;
    use nestray_shapes::triangle_mesh::Triangles;

    use super::*;

    fn mesh(text: &str) -> Triangles {
        let loaded = read(text.as_bytes(), &Source::new("a.off")).expect("it is sound");
        match &loaded.scene.geometries[0].content {
            Content::Mesh(triangles) => (**triangles).clone(),
            _ => unreachable!("OFF holds meshes"),
        }
    }

    const PLAIN: &str = "OFF # square\n\n4 2 0\n0 0 0\n1 0 0 # a\n1 1 0\n0 1 0\n3 0 1 2\n\
        3 0 2 3\n";

    #[test]
    fn comments_counts_and_polygons_are_read() {
        let plain = mesh(PLAIN);
        assert_eq!(plain.faces(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh("4 1\n0 0 0 1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3"), plain);
        let colored = PLAIN.replace("3 0 1 2", "3 0 1 2 255 0 0");
        assert_eq!(mesh(&colored), plain);
    }

    #[test]
    fn extras_of_vertices_are_read() {
        let text = "STCNOFF\n3 1 0\n0 0 0 0 0 1 255 0 0 0.5 0.25\n\
            1 0 0 0 0 1 0 255 0 1 0\n1 1 0 0 0 1 0 0 255 0 1\n3 0 1 2\n";
        // The fraction is that of a texture coordinate, not of the colour.
        let mesh = mesh(text);
        assert_eq!(mesh.normals()[0], [0.0, 0.0, 1.0]);
        assert_eq!(mesh.colors()[0], [1.0, 0.0, 0.0, 1.0]);
        assert_eq!(mesh.uvs()[0], [0.5, 0.75]);
        let text = "COFF\n3 1 0\n0 0 0 1.0 0 0 0.5\n1 0 0 0 255 0 255\n1 1 0 0 0 255 255\n3 0 1 2";
        assert_eq!(self::mesh(text).colors()[0], [1.0, 0.0, 0.0, 0.5]);
    }

    #[test]
    fn errors_name_the_line() {
        let change = |from: &str, to: &str| {
            let text = PLAIN.replace(from, to);
            read(text.as_bytes(), &Source::new("a.off")).expect_err("it is not sound").to_string()
        };
        assert_eq!(
            change("4 2 0", "4000000000 2 0"),
            "a.off:3:1: 4000000000 vertices and 2 faces do not fit in the 45 bytes that are left"
        );
        assert_eq!(
            change("3 0 2 3", "3 0 2 4"),
            "a.off:9:7: a face names vertex 4, but there are 4"
        );
        assert_eq!(
            change("3 0 2 3", "3 0 -2 3"),
            "a.off:9:5: a face names vertex -2, but there are 4"
        );
        assert_eq!(change("1 1 0\n", "1 x 0\n"), "a.off:6:3: expected a coordinate, found `x`");
        assert_eq!(
            change("OFF", "4OFF"),
            "a.off:1:1: OFF files of kind `4OFF` are not read \
             (hint: points of four or more coordinates have no picture)"
        );
        assert!(change("OFF", "COFF").starts_with("a.off:4:6: a colour of 0 numbers"));
        assert!(change("OFF", "OFF BINARY").contains("binary OFF files are not read"));
    }
}
