//! PLY: meshes as text or as numbers, little or big end first [Turk 94].

mod body;

mod header;

#[cfg(test)]
mod tests;

use nestray_scene::texture::linear_from_srgb;

use crate::error::{LoadError, Spot};
use crate::load::{Loaded, Source};
use crate::mesh::{Polygons, Vertices};
use crate::ply::body::{Big, Binary, Little, Numbers};
use crate::ply::header::{Element, Encoding, Header, Kind, Property};
use crate::words::Words;

/// Whether a file may be PLY.
pub(crate) fn begins(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r")
}

/// Reads a mesh: polygons and triangle strips; normals, texture coordinates and colours of
/// vertices. Whatever else a file holds is skipped.
///
/// # Errors
/// If the bytes are no PLY file, end too early, or a face names a vertex that is not there.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    let header = Header::read(bytes, source)?;
    let mesh = match header.encoding {
        Encoding::Ascii => Mesh::read(&header, &mut Words::from(bytes, source, &header), source)?,
        Encoding::Little => {
            Mesh::read(&header, &mut Binary::<Little>::new(bytes, header.bytes, source), source)?
        }
        Encoding::Big => {
            Mesh::read(&header, &mut Binary::<Big>::new(bytes, header.bytes, source), source)?
        }
    };
    mesh.finish(source)
}

/// What has been read.
#[derive(Debug, Default)]
struct Mesh {
    vertices: Vertices,
    polygons: Polygons,
    /// Triangles of strips.
    strips: Vec<[u32; 3]>,
}

/// Where in a row of a vertex a property goes.
const SLOTS: &[(usize, &[&str])] = &[
    (0, &["x"]),
    (1, &["y"]),
    (2, &["z"]),
    (3, &["nx", "normal_x"]),
    (4, &["ny", "normal_y"]),
    (5, &["nz", "normal_z"]),
    (6, &["s", "u", "texture_u", "texture_s"]),
    (7, &["t", "v", "texture_v", "texture_t"]),
    (8, &["red", "r", "diffuse_red"]),
    (9, &["green", "g", "diffuse_green"]),
    (10, &["blue", "b", "diffuse_blue"]),
    (11, &["alpha", "a", "diffuse_alpha"]),
];

/// The slot of what is not wanted.
const NOWHERE: usize = 12;

impl Mesh {
    fn read(
        header: &Header,
        numbers: &mut impl Numbers,
        source: &Source,
    ) -> Result<Self, LoadError> {
        let mut mesh = Self::default();
        let mut rows = header.elements.iter().filter(|element| !element.properties.is_empty());
        let vertices = rows.find(|element| element.name == "vertex");
        let count = vertices.map_or(0, |element| element.count);
        for element in &header.elements {
            // A row without properties takes no bytes; there may be any number of them.
            if element.properties.is_empty() {
                continue;
            }
            if element.count as u128 * element.least_bytes(header.encoding) as u128
                > numbers.left() as u128 + 1
            {
                let message = format!(
                    "{} elements `{}` do not fit in the {} bytes that are left",
                    element.count,
                    element.name,
                    numbers.left()
                );
                return Err(source.line(element.line).error(message));
            }
            match element.name.as_str() {
                "vertex" if mesh.vertices.positions.is_empty() => {
                    mesh.vertices(element, numbers)?
                }
                "face" => mesh.faces(element, count, numbers)?,
                "tristrips" => mesh.tristrips(element, count, numbers)?,
                _ => skip_all(element, numbers)?,
            }
        }
        Ok(mesh)
    }

    fn vertices(&mut self, element: &Element, numbers: &mut impl Numbers) -> Result<(), LoadError> {
        let slot = |property: &Property| {
            let wanted = |(_, names): &&(usize, &[&str])| names.contains(&property.name.as_str());
            let found = SLOTS.iter().find(wanted).map_or(NOWHERE, |&(slot, _)| slot);
            (found, scale(found, property.kind))
        };
        let slots: Vec<(usize, f32)> = element.properties.iter().map(slot).collect();
        let has = |wanted: std::ops::Range<usize>| {
            wanted.into_iter().all(|slot| {
                let mut given = element.properties.iter().zip(&slots);
                given.any(|(property, found)| found.0 == slot && property.length.is_none())
            })
        };
        let curve =
            element.properties.iter().zip(&slots).any(|(p, s)| s.0 == 8 && p.kind.is_whole());
        let (normals, uvs, colors) = (has(3..6), has(6..8), has(8..11));
        if !has(0..3) {
            let message = "vertices without properties `x`, `y` and `z`";
            return Err(Spot { line: element.line, column: 0, ..numbers.here() }.error(message));
        }
        self.vertices.positions.reserve_exact(element.count);
        for _ in 0..element.count {
            let mut row = [0.0; NOWHERE + 1];
            row[11] = 1.0;
            for (property, &(slot, scale)) in element.properties.iter().zip(&slots) {
                match property.length {
                    Some(length) => skip_list(length, property.kind, numbers)?,
                    None => row[slot] = numbers.real(property.kind)? * scale,
                }
            }
            let [x, y, z, nx, ny, nz, s, t, r, g, b, a, _] = row;
            self.vertices.positions.push([x, y, z]);
            if normals {
                self.vertices.normals.push([nx, ny, nz]);
            }
            if uvs {
                self.vertices.uvs.push([s, 1.0 - t]);
            }
            if colors {
                let linear = |x| if curve { linear_from_srgb(x) } else { x };
                self.vertices.colors.push([linear(r), linear(g), linear(b), a]);
            }
        }
        Ok(())
    }

    fn faces(
        &mut self,
        element: &Element,
        vertices: usize,
        numbers: &mut impl Numbers,
    ) -> Result<(), LoadError> {
        let corners = element.corners();
        self.polygons.ends.reserve_exact(element.count);
        for _ in 0..element.count {
            for (i, property) in element.properties.iter().enumerate() {
                match property.length {
                    Some(length) if Some(i) == corners => {
                        for _ in 0..list_length(length, numbers)? {
                            let index = numbers.whole(property.kind)?;
                            self.polygons.corners.push(in_range(index, vertices, numbers)?);
                        }
                    }
                    Some(length) => skip_list(length, property.kind, numbers)?,
                    None => numbers.skip(property.kind)?,
                }
            }
            self.polygons.end_face();
        }
        Ok(())
    }

    /// Strips in which every second triangle turns the other way, and −1 begins a new one.
    fn tristrips(
        &mut self,
        element: &Element,
        vertices: usize,
        numbers: &mut impl Numbers,
    ) -> Result<(), LoadError> {
        let corners = element.corners();
        for _ in 0..element.count {
            for (i, property) in element.properties.iter().enumerate() {
                let Some(length) = property.length else {
                    numbers.skip(property.kind)?;
                    continue;
                };
                if Some(i) != corners {
                    skip_list(length, property.kind, numbers)?;
                    continue;
                }
                let (mut so_far, mut last) = (0, [0; 2]);
                for _ in 0..list_length(length, numbers)? {
                    let index = numbers.whole(property.kind)?;
                    if index == -1 {
                        so_far = 0;
                        continue;
                    }
                    let index = in_range(index, vertices, numbers)?;
                    let [a, b] = last;
                    if so_far >= 2 && a != b && b != index && index != a {
                        let even = so_far % 2 == 0;
                        self.strips.push(if even { [a, b, index] } else { [b, a, index] });
                    }
                    last = [b, index];
                    so_far += 1;
                }
            }
        }
        Ok(())
    }

    fn finish(self, source: &Source) -> Result<Loaded, LoadError> {
        let mut warnings = Vec::new();
        let mut faces = self.polygons.triangles(&self.vertices.positions, source, &mut warnings);
        faces.extend(self.strips);
        self.vertices.finish(faces, source, warnings)
    }
}

/// What whole numbers of a colour are multiplied by.
fn scale(slot: usize, kind: Kind) -> f32 {
    match kind {
        Kind::U8 | Kind::I8 if (8..NOWHERE).contains(&slot) => 1.0 / 255.0,
        Kind::U16 | Kind::I16 if (8..NOWHERE).contains(&slot) => 1.0 / 65535.0,
        _ => 1.0,
    }
}

fn in_range(index: i64, vertices: usize, numbers: &impl Numbers) -> Result<u32, LoadError> {
    let found = u32::try_from(index).ok().filter(|&index| (index as usize) < vertices);
    found.ok_or_else(|| {
        numbers.here().error(format!("a face names vertex {index}, but there are {vertices}"))
    })
}

/// How long a list says it is, if there can be as much.
fn list_length(kind: Kind, numbers: &mut impl Numbers) -> Result<usize, LoadError> {
    let length = numbers.whole(kind)?;
    usize::try_from(length).ok().filter(|&length| length <= numbers.left()).ok_or_else(|| {
        let message = format!("a list of {length} in the {} bytes that are left", numbers.left());
        numbers.here().error(message)
    })
}

fn skip_list(length: Kind, kind: Kind, numbers: &mut impl Numbers) -> Result<(), LoadError> {
    (0..list_length(length, numbers)?).try_for_each(|_| numbers.skip(kind))
}

fn skip_all(element: &Element, numbers: &mut impl Numbers) -> Result<(), LoadError> {
    for _ in 0..element.count {
        for property in &element.properties {
            match property.length {
                Some(length) => skip_list(length, property.kind, numbers)?,
                None => numbers.skip(property.kind)?,
            }
        }
    }
    Ok(())
}
