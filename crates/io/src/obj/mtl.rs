//! MTL: the materials of OBJ files, with the usual additions for physically based ones.

use std::collections::HashMap;

use nestray_scene::material::{AlphaMode, Material};

use crate::error::{LoadError, Warning};
use crate::load::Source;
use crate::obj::image_map::Map;
use crate::words::Words;

/// A material as the file has it.
#[derive(Clone, Debug, Default)]
pub(super) struct Definition {
    pub(super) name: String,
    diffuse: Option<[f32; 3]>,
    specular: [f32; 3],
    exponent: Option<f32>,
    emission: [f32; 3],
    ior: Option<f32>,
    opacity: Option<f32>,
    filter: Option<[f32; 3]>,
    model: i64,
    roughness: Option<f32>,
    metallic: Option<f32>,
    pub(super) diffuse_map: Option<Map>,
    pub(super) emission_map: Option<Map>,
    pub(super) opacity_map: Option<Map>,
    pub(super) normal_map: Option<Map>,
}

/// Reads the definitions of a file; of those of one name the last counts.
///
/// # Errors
/// If a number makes no sense.
pub(super) fn read(
    bytes: &[u8],
    source: &Source,
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Definition>, LoadError> {
    let mut words = Words::new(bytes, source).with_comments().with_joined_lines();
    let mut definitions: Vec<Definition> = Vec::new();
    let mut left_out: HashMap<String, ()> = HashMap::new();
    loop {
        if let Some(word) = words.on_line() {
            let key = String::from_utf8_lossy(word.bytes).to_ascii_lowercase();
            if key == "newmtl" {
                let name = words.rest().into_owned();
                definitions.push(Definition { name, ..Definition::default() });
            } else if let Some(definition) = definitions.last_mut()
                && !definition.set(&key, &mut words)?
                && left_out.len() < 100
                && left_out.insert(key.clone(), ()).is_none()
            {
                let message = format!("{word} is not read; left out");
                warnings.push(words.spot(&word).warning(message));
            }
        }
        if !words.end_line() {
            return Ok(definitions);
        }
    }
}

impl Definition {
    /// Sets a property; false if it is not known.
    fn set(&mut self, key: &str, words: &mut Words<'_>) -> Result<bool, LoadError> {
        match key {
            "kd" => self.diffuse = Some(color(words)?),
            "ks" => self.specular = color(words)?,
            "ke" => self.emission = color(words)?,
            "tf" => self.filter = Some(color(words)?),
            "ns" => self.exponent = Some(number(words)?),
            "ni" => self.ior = Some(number(words)?),
            "d" => self.opacity = Some(number(words)?),
            "tr" => self.opacity = Some(1.0 - number(words)?),
            "pr" => self.roughness = Some(number(words)?),
            "pm" => self.metallic = Some(number(words)?),
            "illum" => self.model = number(words)? as i64,
            "map_kd" => self.diffuse_map = Map::read(words),
            "map_ke" => self.emission_map = Map::read(words),
            "map_d" => self.opacity_map = Map::read(words),
            "norm" | "map_kn" | "map_norm" => self.normal_map = Map::read(words),
            "bump" | "map_bump" if self.normal_map.is_none() => {
                self.normal_map = Map::read(words).map(Map::or_heights);
            }
            // Light from everywhere, sharpness of reflections.
            "ka" | "map_ka" | "sharpness" | "bump" | "map_bump" | "aniso" | "anisor" => {}
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The material without its textures.
    pub(super) fn material(&self) -> Material {
        let usual = Material::default();
        let unit = |x: f32| if x > 0.0 { x.min(1.0) } else { 0.0 };
        let diffuse = self.diffuse.map(|color| color.map(unit));
        let specular = self.specular.map(unit);
        let shines = specular.iter().any(|&x| x > 0.0);
        // Some programs write black where the texture is all there is.
        let black = diffuse.is_some_and(|color| color == [0.0; 3]);
        let textured = self.diffuse_map.is_some();
        let mirror = black && shines && !textured;
        let base = match diffuse {
            _ if textured && (black || diffuse.is_none()) => [1.0; 3],
            _ if mirror => specular,
            Some(color) => color,
            None => usual.base_color,
        };
        // The lobe of [Phong 75] with the same width.
        let lobe = |n: f32| libm::powf(2.0 / (n.max(0.0) + 2.0), 0.25);
        let matt = if shines { lobe(self.exponent.unwrap_or(10.0)) } else { 1.0 };
        let mut material = Material {
            name: self.name.clone(),
            base_color: base,
            metallic: unit(self.metallic.unwrap_or(if mirror { 1.0 } else { 0.0 })),
            roughness: unit(self.roughness.unwrap_or(matt)),
            emission: self.emission.map(|x| if x > 0.0 && x.is_finite() { x } else { 0.0 }),
            ior: self.ior.filter(|ior| (1.0..10.0).contains(ior)).unwrap_or(usual.ior),
            ..usual
        };
        let opacity = unit(self.opacity.unwrap_or(1.0));
        if matches!(self.model, 4 | 6 | 7 | 9) {
            // Glass: what is not opaque refracts, dyed by the filter.
            let filter = self.filter.map_or([1.0; 3], |color| color.map(unit));
            let clear = filter.into_iter().fold(0.0, f32::max);
            material.transmission = if opacity < 1.0 { 1.0 - opacity } else { clear };
            if clear > 0.0 && !textured {
                material.base_color = filter.map(|x| x / clear);
            }
            material.metallic = 0.0;
            material.roughness = unit(self.roughness.unwrap_or(0.0));
        } else if opacity < 1.0 {
            material.alpha = opacity;
            material.alpha_mode = AlphaMode::Blend;
        }
        material
    }
}

/// One number for all channels, or three.
fn color(words: &mut Words<'_>) -> Result<[f32; 3], LoadError> {
    let first = number(words)?;
    let second = words.on_line().and_then(|word| word.number());
    let third = words.on_line().and_then(|word| word.number());
    Ok(match (second, third) {
        (Some(second), Some(third)) => [first, second, third],
        _ => [first; 3],
    })
}

/// The next number of this line; `d -halo` has a word before it.
fn number(words: &mut Words<'_>) -> Result<f32, LoadError> {
    while let Some(word) = words.on_line() {
        if word.bytes == b"-halo" {
            continue;
        }
        return word.number().ok_or_else(|| words.unfit(&word, "a number"));
    }
    Err(words.here().error("the line ends where a number should be"))
}
