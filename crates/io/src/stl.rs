//! STL: triangles as stereolithography machines take them, as text or binary.

use std::collections::HashMap;

use nestray_shapes::triangle_mesh::Triangles;

use crate::error::LoadError;
use crate::load::{Loaded, Source};
use crate::mesh;
use crate::words::Words;

/// Bytes before the triangles of a binary file: a comment and a count.
const HEAD: usize = 84;

/// Bytes of a triangle: its normal, its corners, and two that mean nothing.
const TRIANGLE: usize = 50;

/// Whether a file may be STL.
pub(crate) fn begins(bytes: &[u8]) -> bool {
    is_text(bytes) || count(bytes).is_some_and(|count| bytes.len() == HEAD + count * TRIANGLE)
}

/// Reads a mesh. Corners in the same place become one vertex; normals are those of the
/// triangles, whatever the file says.
///
/// # Errors
/// If the bytes are no STL file, or end too early.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    let mut weld = Weld::default();
    let mut warnings = Vec::new();
    if is_text(bytes) {
        text(&mut weld, bytes, source)?;
    } else {
        let Some(count) = count(bytes) else {
            return Err(source.spot().error("is too short to be an STL file"));
        };
        let body = &bytes[HEAD..];
        if count > body.len() / TRIANGLE {
            let message = format!("{count} triangles do not fit in {} bytes", body.len());
            return Err(source.spot().error(message));
        }
        let left = body.len() - count * TRIANGLE;
        if left > 0 {
            let message = format!("{left} bytes after the last triangle are left out");
            warnings.push(source.spot().warning(message));
        }
        binary(&mut weld, &body[..count * TRIANGLE]);
    }
    let triangles = Triangles::new(weld.positions, weld.faces)
        .map_err(|error| mesh::refused(source, &error))?;
    Ok(mesh::scene(triangles, source, warnings))
}

/// Whether it is text. Binary files may begin with `solid`, too, but have the length they
/// say or are not all text.
fn is_text(bytes: &[u8]) -> bool {
    /// Enough to meet a byte that is no text: triangles begin within.
    const LOOKED_AT: usize = 512;
    let text = bytes.trim_ascii_start();
    let claimed = count(bytes).map(|count| HEAD as u64 + count as u64 * TRIANGLE as u64);
    text.starts_with(b"solid")
        && claimed != Some(bytes.len() as u64)
        && !bytes[..bytes.len().min(LOOKED_AT)].contains(&0)
}

/// How many triangles a binary file says it has.
fn count(bytes: &[u8]) -> Option<usize> {
    let &count = bytes.get(HEAD - 4..)?.first_chunk()?;
    Some(u32::from_le_bytes(count) as usize)
}

fn binary(weld: &mut Weld, body: &[u8]) {
    let (triangles, _) = body.as_chunks::<TRIANGLE>();
    for triangle in triangles {
        let (numbers, _) = triangle.as_chunks::<4>();
        let at = |i: usize| f32::from_le_bytes(numbers[i]);
        let face = [3, 6, 9].map(|i| weld.vertex([at(i), at(i + 1), at(i + 2)]));
        weld.faces.push(face);
    }
}

/// `facet normal x y z outer loop vertex x y z … endloop endfacet`, any number of times, in
/// any number of solids.
fn text(weld: &mut Weld, bytes: &[u8], source: &Source) -> Result<(), LoadError> {
    let mut words = Words::new(bytes, source);
    let mut corners = Vec::with_capacity(3);
    while let Some(word) = words.next() {
        match word.bytes.to_ascii_lowercase().as_slice() {
            b"solid" | b"endsolid" => {
                words.rest();
            }
            b"facet" => corners.clear(),
            b"normal" => {
                words.triple("a coordinate")?;
            }
            b"outer" | b"loop" | b"endloop" => {}
            b"vertex" => corners.push(weld.vertex(words.triple("a coordinate")?)),
            b"endfacet" => match *corners {
                [a, b, c] => weld.faces.push([a, b, c]),
                _ => {
                    let message = format!("a facet of {} corners", corners.len());
                    return Err(words.spot(&word).error(message));
                }
            },
            _ => return Err(words.unfit(&word, "a word of STL")),
        }
        if corners.len() > 3 {
            return Err(words.spot(&word).error("a facet of more than 3 corners"));
        }
    }
    Ok(())
}

/// Makes one vertex of corners in the same place.
#[derive(Debug, Default)]
struct Weld {
    positions: Vec<[f32; 3]>,
    faces: Vec<[u32; 3]>,
    vertices: HashMap<[u32; 3], u32>,
}

impl Weld {
    fn vertex(&mut self, position: [f32; 3]) -> u32 {
        // −0 and 0 are the same place.
        let position = position.map(|x| x + 0.0);
        *self.vertices.entry(position.map(f32::to_bits)).or_insert_with(|| {
            self.positions.push(position);
            self.positions.len() as u32 - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use nestray_scene::geometry::Content;

    use super::*;

    const CORNERS: [[[f32; 3]; 3]; 2] = [
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, -0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
    ];

    fn mesh(bytes: &[u8]) -> Triangles {
        let loaded = read(bytes, &Source::new("a.stl")).expect("it is sound");
        match &loaded.scene.geometries[0].content {
            Content::Mesh(triangles) => (**triangles).clone(),
            _ => unreachable!("STL holds meshes"),
        }
    }

    fn binary_file(comment: &[u8]) -> Vec<u8> {
        let mut file = comment.to_vec();
        file.resize(80, b' ');
        file.extend(2u32.to_le_bytes());
        for corners in CORNERS {
            file.extend([0; 12]);
            file.extend(corners.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
            file.extend([0; 2]);
        }
        file
    }

    #[test]
    fn text_and_binary_files_hold_the_same() {
        let mut text = String::from("solid a b vertex\n");
        for corners in CORNERS {
            text += " facet normal 0 0 1\n  outer loop\n";
            for [x, y, z] in corners {
                text += &format!("   vertex {x:e} {y} {z}\n");
            }
            text += "  endloop\n endfacet\n";
        }
        text += "endsolid a b vertex\n";
        let mesh = mesh(text.as_bytes());
        assert_eq!(mesh.faces(), [[0, 1, 2], [1, 3, 2]]);
        assert_eq!(self::mesh(&binary_file(b"made by hand")), mesh);
        assert_eq!(self::mesh(&binary_file(b"solid but binary")), mesh);
        assert!(begins(text.as_bytes()) && begins(&binary_file(b"")));
        let upper = text.to_uppercase().replace("SOLID", "solid");
        assert_eq!(self::mesh(upper.as_bytes()), mesh);
    }

    #[test]
    fn a_binary_file_that_begins_like_text_and_is_too_long_is_still_binary() {
        let mut file = binary_file(b"solid");
        file.extend([0; 7]);
        let loaded = read(&file, &Source::new("a.stl")).expect("it is sound");
        let warning = loaded.warnings[0].to_string();
        assert_eq!(warning, "a.stl: 7 bytes after the last triangle are left out");
    }

    #[test]
    fn lies_are_told() {
        let error = |bytes: &[u8]| {
            read(bytes, &Source::new("a.stl")).expect_err("it is not sound").to_string()
        };
        let file = binary_file(b"x");
        assert_eq!(error(&file[..file.len() - 1]), "a.stl: 2 triangles do not fit in 99 bytes");
        let mut file = file;
        file[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert_eq!(error(&file), "a.stl: 4294967295 triangles do not fit in 100 bytes");
        assert_eq!(
            error(b"solid\nfacet\nvertex 1 2"),
            "a.stl:3:11: the file ends where a coordinate should be"
        );
        assert_eq!(error(b"solid\nfacet endfacet"), "a.stl:2:7: a facet of 0 corners");
        assert_eq!(error(b"solid\nfacets"), "a.stl:2:1: expected a word of STL, found `facets`");
        assert_eq!(error(b""), "a.stl: is too short to be an STL file");
    }
}
