//! OBJ: meshes as text, with materials in files of their own.

mod image_map;

mod materials;

mod mtl;

mod part;

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, HashMap};

use nestray_scene::scene::Scene;
use nestray_scene::texture::linear_from_srgb;

use crate::error::{LoadError, Spot};
use crate::load::{Loaded, Source};
use crate::mesh;
use crate::obj::materials::Materials;
use crate::obj::part::{Corner, NONE, Part, Pools};
use crate::polygon::Cutter;
use crate::words::{Word, Words};

/// Whether a file may be OBJ.
pub(crate) fn begins(bytes: &[u8]) -> bool {
    let source = Source::new("");
    let mut words = Words::new(bytes, &source).with_comments();
    let (first, second) = (words.next(), words.next());
    match (first.map(|word| word.bytes), second) {
        (Some(b"v" | b"vn" | b"vt"), Some(second)) => second.number().is_some(),
        (Some(b"o" | b"g" | b"mtllib" | b"usemtl"), Some(_)) => true,
        _ => false,
    }
}

/// Reads meshes: one geometry for each material of each object or group. Polygons are cut
/// into triangles, concave ones too. Curves, lines and points are left out.
///
/// # Errors
/// If a line makes no sense, or a face names a vertex that is not there.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    let words = Words::new(bytes, source).with_comments().with_joined_lines();
    let mut reader = Reader {
        words,
        source,
        pools: Pools::default(),
        materials: Materials::new(source),
        parts: Vec::new(),
        numbers: HashMap::new(),
        object: String::new(),
        group: String::new(),
        current: None,
        highest: [(0, Spot::default()), (0, Spot::default()), (0, Spot::default())],
        left_out: BTreeMap::new(),
    };
    loop {
        if let Some(word) = reader.words.on_line() {
            reader.statement(&word)?;
        }
        if !reader.words.end_line() {
            break;
        }
    }
    reader.finish()
}

struct Reader<'a> {
    words: Words<'a>,
    source: &'a Source,
    pools: Pools,
    materials: Materials<'a>,
    parts: Vec<Part>,
    /// The part of an object, a group and a material.
    numbers: HashMap<(String, String, usize), usize>,
    object: String,
    group: String,
    /// The part that faces go to, until something changes.
    current: Option<usize>,
    /// The highest place, texture coordinate and normal named, counted from 1, and where.
    highest: [(u32, Spot); 3],
    /// Statements left out: how many, and where first.
    left_out: BTreeMap<String, (usize, usize)>,
}

impl Reader<'_> {
    fn statement(&mut self, word: &Word<'_>) -> Result<(), LoadError> {
        match word.bytes {
            b"v" => self.vertex(),
            b"vt" => {
                let u = self.number("a texture coordinate")?;
                let v = self.next_number().unwrap_or(0.0);
                self.pools.uvs.push([u, 1.0 - v]);
                Ok(())
            }
            b"vn" => {
                let normal = self.triple("a normal")?;
                self.pools.normals.push(normal);
                Ok(())
            }
            b"f" | b"fo" => self.face(word),
            b"o" => {
                self.object = short(&self.words.rest());
                self.current = None;
                Ok(())
            }
            b"g" => {
                self.group = short(&self.words.rest());
                self.current = None;
                Ok(())
            }
            b"usemtl" => {
                let name = self.words.rest();
                self.materials.choose(&name, word.line);
                self.current = None;
                Ok(())
            }
            b"mtllib" => {
                let names = self.words.rest();
                self.materials.open(&names, word.line)
            }
            // Smoothing, display and level of detail.
            b"s" | b"lod" | b"bevel" | b"c_interp" | b"d_interp" | b"shadow_obj" | b"trace_obj" => {
                Ok(())
            }
            other if other.iter().all(|b| b.is_ascii_alphanumeric() || *b == b'_') => {
                let name = String::from_utf8_lossy(&other[..other.len().min(20)]).into_owned();
                // As many as a file of garbage can make names for.
                if self.left_out.len() < 100 || self.left_out.contains_key(&name) {
                    self.left_out.entry(name).or_insert((0, word.line)).0 += 1;
                }
                Ok(())
            }
            _ => Err(self.words.unfit(word, "a statement of OBJ")),
        }
    }

    /// A place, and perhaps a weight or a colour.
    fn vertex(&mut self) -> Result<(), LoadError> {
        let place = self.triple("a coordinate")?;
        let mut more = [0.0; 4];
        let mut count = 0;
        while let Some(number) = self.next_number() {
            if count < 4 {
                more[count] = number;
            }
            count += 1;
        }
        self.pools.positions.push(place);
        if count >= 3 {
            let [r, g, b, _] = more.map(linear_from_srgb);
            self.pools.colors.resize(self.pools.positions.len() - 1, [1.0; 4]);
            self.pools.colors.push([r, g, b, 1.0]);
        }
        Ok(())
    }

    fn face(&mut self, word: &Word<'_>) -> Result<(), LoadError> {
        let current = match self.current {
            Some(current) => current,
            None => {
                let key = (self.object.clone(), self.group.clone(), self.materials.chosen());
                let next = self.parts.len();
                let number = *self.numbers.entry(key).or_insert(next);
                if number == next {
                    let name = name(&self.object, &self.group);
                    self.parts.push(Part::new(name, self.materials.chosen()));
                }
                *self.current.insert(number)
            }
        };
        let start = self.parts[current].corners.len();
        while let Some(word) = self.words.on_line() {
            let corner = self.corner(&word)?;
            self.parts[current].corners.push(corner);
        }
        let part = &mut self.parts[current];
        if part.corners.len() - start < 3 {
            part.corners.truncate(start);
            self.left_out.entry("f of fewer than 3".into()).or_insert((0, word.line)).0 += 1;
        } else {
            part.ends.push(part.corners.len());
        }
        Ok(())
    }

    /// `place`, `place/texture`, `place//normal` or `place/texture/normal`; counted from 1, or
    /// backwards from −1.
    fn corner(&mut self, word: &Word<'_>) -> Result<Corner, LoadError> {
        let counts = [self.pools.positions.len(), self.pools.uvs.len(), self.pools.normals.len()];
        let mut corner = [NONE; 3];
        for (which, text) in word.bytes.split(|&byte| byte == b'/').enumerate() {
            if text.is_empty() && which > 0 {
                continue;
            }
            let part = Word { bytes: text, ..*word };
            let Some(index) = part.whole().filter(|_| which < 3) else {
                return Err(self.words.unfit(word, "a corner of a face"));
            };
            let number =
                if index < 0 { index.saturating_add(counts[which] as i64 + 1) } else { index };
            let number = u32::try_from(number).unwrap_or(0);
            if number == 0 || number == NONE {
                let what = ["vertex", "texture coordinate", "normal"][which];
                let message =
                    format!("a face names {what} {index}, but there are {}", counts[which]);
                return Err(self.words.spot(word).error(message));
            }
            if number > self.highest[which].0 {
                self.highest[which] = (number, self.words.spot(word));
            }
            corner[which] = number - 1;
        }
        Ok(corner)
    }

    fn finish(mut self) -> Result<Loaded, LoadError> {
        let places = self.pools.positions.len();
        let (highest, spot) = &self.highest[0];
        if *highest as usize > places {
            let message = format!("a face names vertex {highest}, but there are {places}");
            return Err(spot.clone().error(message));
        }
        let mut scene = Scene::new();
        let mut warnings = self.materials.finish(&mut scene);
        let counts = [self.pools.uvs.len(), self.pools.normals.len()];
        for (which, what) in ["texture coordinate", "normal"].into_iter().enumerate() {
            let (highest, spot) = &self.highest[which + 1];
            if *highest as usize > counts[which] {
                let message = format!(
                    "a face names {what} {highest}, but there are {}; left out",
                    counts[which]
                );
                warnings.push(spot.clone().warning(message));
            }
        }
        for (name, (count, line)) in &self.left_out {
            let message = format!("`{name}` is not read; left out {count} times");
            warnings.push(self.source.line(*line).warning(message));
        }
        if !self.pools.colors.is_empty() {
            self.pools.colors.resize(places, [1.0; 4]);
        }
        let mut cutter = Cutter::default();
        for part in self.parts.into_iter().filter(|part| !part.ends.is_empty()) {
            let (name, material) = (part.name.clone(), part.material);
            let triangles = part
                .build(&self.pools, &mut cutter)
                .map_err(|error| mesh::refused(self.source, &error))?;
            mesh::warn_unusable(&triangles, self.source, &mut warnings);
            scene.add(nestray_scene::geometry::Geometry::mesh(name, material, triangles));
        }
        mesh::warn_given_up(&cutter, self.source, &mut warnings);
        if scene.geometries.is_empty() {
            let message = format!("holds {places} points without faces, which are not seen");
            warnings.push(self.source.spot().warning(message));
        }
        Ok(Loaded { scene, warnings })
    }

    /// The next number of this line.
    fn number(&mut self, what: &str) -> Result<f32, LoadError> {
        let Some(word) = self.words.on_line() else {
            return Err(self.words.here().error(format!("the line ends where {what} should be")));
        };
        word.number().ok_or_else(|| self.words.unfit(&word, what))
    }

    fn triple(&mut self, what: &str) -> Result<[f32; 3], LoadError> {
        Ok([self.number(what)?, self.number(what)?, self.number(what)?])
    }

    fn next_number(&mut self) -> Option<f32> {
        self.words.on_line()?.number()
    }
}

/// A name of no more than a line: it is kept for every part.
fn short(name: &str) -> String {
    name.chars().take(200).collect()
}

/// What a geometry is called.
fn name(object: &str, group: &str) -> String {
    match (object, group) {
        (object, "" | "default") => object.to_owned(),
        ("", group) => group.to_owned(),
        (object, group) if object == group => group.to_owned(),
        _ => format!("{object}/{group}"),
    }
}
