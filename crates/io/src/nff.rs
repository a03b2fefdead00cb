//! NFF, the neutral file format of the standard scenes [Haines 87].

mod general;

pub mod write;

#[cfg(test)]
mod tests;

use std::sync::Arc;

use glam::Vec3A;
use nestray_scene::camera::Camera;
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::light::{Background, Light, LightKind};
use nestray_scene::material::Material;
use nestray_scene::scene::Scene;
use nestray_shapes::any::AnyShape;
use nestray_shapes::cone::Cone;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::patch::Patch;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::shape::{Shape, Sides};
use nestray_shapes::sphere::Sphere;

use crate::error::{LoadError, Warning};
use crate::load::{Loaded, Source};
use crate::words::{Word, Words};

/// Whether a file may be NFF.
pub(crate) fn begins(bytes: &[u8]) -> bool {
    let source = Source::new("");
    let mut words = Words::new(bytes, &source).with_comments();
    let (first, second) = (words.next(), words.next());
    match (first.map(|word| word.bytes), second) {
        (Some(b"v"), Some(second)) => second.bytes == b"from",
        (Some(b"b" | b"l"), Some(second)) => second.number().is_some(),
        _ => false,
    }
}

/// Reads a scene: what follows a fill is one geometry, in the order of the file. Shapes are
/// seen from the front only, or, if their radius is negative, from the back only, unless they
/// let light through. Lights without a colour are `1 / √n` bright, if there are `n` of them,
/// and there is no ambient light: so the published pictures were made. None gets weaker with
/// distance.
///
/// # Errors
/// If a statement makes no sense, or the bytes end within one.
pub fn read(bytes: &[u8], source: &Source) -> Result<Loaded, LoadError> {
    let mut reader = Reader {
        words: Words::new(bytes, source).with_comments(),
        scene: Scene::new(),
        lights: Vec::new(),
        material: None,
        clear: false,
        sides: Sides::Front,
        shapes: Vec::new(),
        unseen: None,
    };
    while let Some(word) = reader.words.next() {
        reader.statement(&word)?;
    }
    Ok(reader.finish(source))
}

struct Reader<'a> {
    words: Words<'a>,
    scene: Scene,
    /// Where, and the colour if there is one.
    lights: Vec<(Vec3A, Option<[f32; 3]>)>,
    /// That of the latest fill.
    material: Option<usize>,
    /// Whether it lets light through.
    clear: bool,
    /// Those of `shapes`.
    sides: Sides,
    /// Of the geometry that grows.
    shapes: Vec<AnyShape>,
    /// How many shapes there are that cannot be hit, and the line of the first.
    unseen: Option<(usize, usize)>,
}

impl Reader<'_> {
    fn statement(&mut self, word: &Word<'_>) -> Result<(), LoadError> {
        match word.bytes {
            b"v" => self.view(word),
            b"b" => {
                self.scene.background = Background::Color(self.triple("a colour")?);
                Ok(())
            }
            b"l" => {
                let position = self.place()?;
                let ahead = self.words.clone().next();
                let colored = ahead.is_some_and(|word| word.number().is_some());
                let color = if colored { Some(self.triple("a colour")?) } else { None };
                self.lights.push((position, color));
                Ok(())
            }
            b"f" => self.fill(),
            b"s" => self.sphere(word),
            b"c" => self.cone(word),
            b"p" => {
                let count = self.count(word, 3)?;
                let corners: Result<Vec<_>, _> =
                    (0..count).map(|_| self.triple("a coordinate")).collect();
                self.add(Polygon::new(corners?), false, word);
                Ok(())
            }
            b"pp" => {
                let count = self.count(word, 6)?;
                let corners: Result<Vec<_>, _> = (0..count)
                    .map(|_| Ok((self.triple("a coordinate")?, self.triple("a normal")?)))
                    .collect();
                self.add(Patch::new(&corners?), false, word);
                Ok(())
            }
            _ => Err(self.words.unfit(word, "a statement of NFF")),
        }
    }

    /// `from`, `at` and the others, in any order; most have a usual value.
    fn view(&mut self, word: &Word<'_>) -> Result<(), LoadError> {
        let mut camera = Camera { up: Vec3A::Z, ..Camera::default() };
        let (mut from, mut at) = (None, None);
        let mut degrees = 45.0;
        loop {
            let mut ahead = self.words.clone();
            let part = ahead.next();
            match part.map_or(&b""[..], |part| part.bytes) {
                b"from" | b"at" | b"up" | b"angle" | b"hither" | b"resolution" => {}
                _ => break,
            }
            self.words = ahead;
            match part.map_or(&b""[..], |part| part.bytes) {
                b"from" => from = Some(self.place()?),
                b"at" => at = Some(self.place()?),
                b"up" => camera.up = self.place()?,
                b"angle" => degrees = self.within("an angle between 0 and 180", 0.0, 180.0)?,
                b"hither" => camera.hither = self.number("a distance")?.max(0.0),
                _ => camera.resolution = Some([self.pixels()?, self.pixels()?]),
            }
        }
        let (Some(from), Some(at)) = (from, at) else {
            return Err(self.words.spot(word).error("a view without `from` and `at`"));
        };
        if from == at {
            return Err(self.words.spot(word).error("a view from a place at the same place"));
        }
        let looking = Camera::looking(from, at, camera.up, degrees);
        self.scene.cameras.push(Camera {
            hither: camera.hither,
            resolution: camera.resolution,
            ..looking
        });
        Ok(())
    }

    fn fill(&mut self) -> Result<(), LoadError> {
        self.end_geometry();
        let color = self.triple("a colour")?;
        let [kd, ks, shine] = self.triple("a coefficient")?;
        let (t, ior) = (self.number("a transmittance")?, self.number("an index of refraction")?);
        self.clear = t > 0.0;
        let material = Material::from_nff(color, kd, ks, shine, t, ior);
        self.material = Some(self.scene.add_material(material));
        Ok(())
    }

    fn sphere(&mut self, word: &Word<'_>) -> Result<(), LoadError> {
        let (center, radius) = (self.place()?, self.number("a radius")?);
        self.add(Sphere { center, radius: radius.abs() }, radius < 0.0, word);
        Ok(())
    }

    fn cone(&mut self, word: &Word<'_>) -> Result<(), LoadError> {
        let (base, base_radius) = (self.place()?, self.number("a radius")?);
        let (apex, apex_radius) = (self.place()?, self.number("a radius")?);
        let inside = base_radius < 0.0 || apex_radius < 0.0;
        if inside && (base_radius > 0.0 || apex_radius > 0.0) {
            let message = format!("a cone with radii {base_radius} and {apex_radius}");
            return Err(self.words.spot(word).error(message).hint("negate both or none"));
        }
        let (base_radius, apex_radius) = (base_radius.abs(), apex_radius.abs());
        if base_radius == apex_radius {
            self.add(Cylinder { base, top: apex, radius: base_radius }, inside, word);
        } else {
            self.add(Cone { base, base_radius, apex, apex_radius }, inside, word);
        }
        Ok(())
    }

    fn add(&mut self, shape: impl Into<AnyShape>, inside: bool, word: &Word<'_>) {
        let sides = match inside {
            _ if self.clear => Sides::Both,
            true => Sides::Back,
            false => Sides::Front,
        };
        if sides != self.sides {
            self.end_geometry();
            self.sides = sides;
        }
        let shape = shape.into();
        if shape.bounds().is_empty() {
            self.unseen.get_or_insert((0, word.line)).0 += 1;
        }
        self.shapes.push(shape);
    }

    fn end_geometry(&mut self) {
        if self.shapes.is_empty() {
            return;
        }
        let material = match self.material {
            Some(material) => material,
            None => *self.material.insert(self.scene.add_material(Material::default())),
        };
        let content = Content::Shapes(Arc::new(std::mem::take(&mut self.shapes)));
        self.scene.add(Geometry { name: String::new(), material, sides: self.sides, content });
    }

    fn finish(mut self, source: &Source) -> Loaded {
        self.end_geometry();
        let usual = [1.0 / (self.lights.len() as f32).sqrt(); 3];
        for (position, color) in self.lights {
            let kind = LightKind::Point { position, fades: false };
            let color = color.unwrap_or(usual);
            self.scene.lights.push(Light { kind, ..Light::point(position, color) });
        }
        let unseen = |(count, line): (usize, usize)| -> Warning {
            let message = format!("{count} shapes from here on have no extent and are not seen");
            source.line(line).warning(message)
        };
        Loaded { scene: self.scene, warnings: self.unseen.map(unseen).into_iter().collect() }
    }

    /// How many corners follow, of so many numbers each.
    fn count(&mut self, word: &Word<'_>, numbers: u64) -> Result<usize, LoadError> {
        let what = "a number of corners, at least 3";
        let found = self.words.expect(what)?;
        let count = found.whole().filter(|&count| count >= 3);
        let count = count.ok_or_else(|| self.words.unfit(&found, what))? as u64;
        // A digit and a blank for each number.
        if count.saturating_mul(numbers * 2) > self.words.left() as u64 + 1 {
            let message = format!(
                "a polygon of {count} corners does not fit in the {} bytes that are left",
                self.words.left()
            );
            return Err(self.words.spot(word).error(message));
        }
        Ok(count as usize)
    }

    fn number(&mut self, what: &str) -> Result<f32, LoadError> {
        let word = self.words.expect(what)?;
        let number = word.number().filter(|number| number.is_finite());
        number.ok_or_else(|| self.words.unfit(&word, what))
    }

    fn within(&mut self, what: &str, above: f32, below: f32) -> Result<f32, LoadError> {
        let word = self.words.expect(what)?;
        let number = word.number().filter(|&number| number > above && number < below);
        number.ok_or_else(|| self.words.unfit(&word, what))
    }

    fn pixels(&mut self) -> Result<u32, LoadError> {
        /// Pictures larger than this are mistakes.
        const MOST: i64 = 1 << 20;
        let what = "a number of pixels";
        let word = self.words.expect(what)?;
        let pixels = word.whole().filter(|pixels| (1..=MOST).contains(pixels));
        pixels.map(|pixels| pixels as u32).ok_or_else(|| self.words.unfit(&word, what))
    }

    fn triple(&mut self, what: &str) -> Result<[f32; 3], LoadError> {
        Ok([self.number(what)?, self.number(what)?, self.number(what)?])
    }

    fn place(&mut self) -> Result<Vec3A, LoadError> {
        Ok(Vec3A::from_array(self.triple("a coordinate")?))
    }
}
