//! Materials.

use std::collections::BTreeMap;

use nestray_scene::material::{AlphaMode, Material};

use super::Reader;
use super::document::{self, TextureOf};
use crate::image::Curve;

/// Materials made so far; that of primitives without one is `None`.
#[derive(Debug, Default)]
pub(super) struct Materials {
    numbers: BTreeMap<Option<usize>, usize>,
}

impl Reader<'_> {
    /// The scene's number for a material of the document, made when it is first asked for.
    pub(super) fn material(&mut self, wanted: Option<usize>) -> Result<usize, String> {
        if let Some(&known) = self.materials.numbers.get(&wanted) {
            return Ok(known);
        }
        let document = self.document;
        let material = match wanted {
            None => {
                // As the format has it: white, metallic, rough.
                let white = Material { base_color: [1.0; 3], metallic: 1.0, ..Material::default() };
                Material { name: "default".into(), ..white }
            }
            Some(number) => {
                let found = document.materials.get(number);
                let found = found.ok_or_else(|| format!("there is no materials[{number}]"))?;
                self.convert(found).map_err(|why| format!("materials[{number}]: {why}"))?
            }
        };
        let number = self.scene.add_material(material);
        self.materials.numbers.insert(wanted, number);
        Ok(number)
    }

    /// Which set of texture coordinates a material wants: that of its first texture. A mesh
    /// has room for one.
    pub(super) fn uv_set(&mut self, material: Option<usize>) -> usize {
        let Some(found) = material.and_then(|number| self.document.materials.get(number)) else {
            return 0;
        };
        let metallic = &found.pbr_metallic_roughness;
        let gloss =
            found.extensions.gloss.as_ref().and_then(|gloss| gloss.diffuse_texture.as_ref());
        let textures = [
            metallic.base_color_texture.as_ref().or(gloss),
            found.emissive_texture.as_ref(),
            metallic.metallic_roughness_texture.as_ref(),
            found.normal_texture.as_ref(),
        ];
        let mut sets = textures.into_iter().flatten().map(Self::set_of);
        let first = sets.next().unwrap_or(0);
        if sets.any(|set| set != first) {
            self.warn("materials with several sets of texture coordinates use one".into());
        }
        first
    }

    fn convert(&mut self, found: &document::Material) -> Result<Material, String> {
        let metallic = &found.pbr_metallic_roughness;
        let extensions = &found.extensions;
        let [r, g, b, alpha] = metallic.base_color_factor.unwrap_or([1.0; 4]).map(unit);
        let strength = extensions.emissive.emissive_strength.unwrap_or(1.0);
        let light = |x: f32| (x * strength).clamp(0.0, f32::MAX);
        if extensions.transmission.transmission_texture.is_some() {
            self.warn("textures of transmission are left out".into());
        }
        let mut material = Material {
            name: found.name.clone(),
            base_color: [r, g, b],
            base_texture: self.texture(metallic.base_color_texture.as_ref(), Curve::Srgb)?,
            metallic: unit(metallic.metallic_factor.unwrap_or(1.0)),
            roughness: unit(metallic.roughness_factor.unwrap_or(1.0)),
            metallic_roughness_texture: self
                .texture(metallic.metallic_roughness_texture.as_ref(), Curve::Linear)?,
            normal_texture: self.texture(found.normal_texture.as_ref(), Curve::Linear)?,
            normal_scale: found.normal_texture.as_ref().and_then(normal_scale).unwrap_or(1.0),
            emission: found.emissive_factor.unwrap_or_default().map(light),
            emission_texture: self.texture(found.emissive_texture.as_ref(), Curve::Srgb)?,
            transmission: unit(extensions.transmission.transmission_factor),
            // 0 asks for endless refraction in old viewers; nothing real goes below 1.
            ior: extensions.ior.ior.unwrap_or(1.5).clamp(1.0, 100.0),
            alpha,
            alpha_mode: match found.alpha_mode.as_deref() {
                Some("MASK") => AlphaMode::Mask(unit(found.alpha_cutoff.unwrap_or(0.5))),
                Some("BLEND") => AlphaMode::Blend,
                _ => AlphaMode::Opaque,
            },
            whitted: None,
        };
        if let Some(gloss) = &extensions.gloss {
            self.apply_gloss(&mut material, gloss)?;
        }
        if extensions.unlit.is_some() {
            // Its colour whatever the light: it glows, and reflects nothing.
            material.emission = material.base_color;
            material.emission_texture = material.base_texture;
            (material.base_color, material.metallic) = ([0.0; 3], 0.0);
            (material.roughness, material.ior, material.transmission) = (1.0, 1.0, 0.0);
        }
        Ok(material)
    }

    /// The older model, as far as the newer one can say it: no coloured reflections.
    fn apply_gloss(
        &mut self,
        material: &mut Material,
        gloss: &document::Gloss,
    ) -> Result<(), String> {
        let [r, g, b, alpha] = gloss.diffuse_factor.unwrap_or([1.0; 4]).map(unit);
        (material.base_color, material.alpha) = ([r, g, b], alpha);
        material.base_texture = self.texture(gloss.diffuse_texture.as_ref(), Curve::Srgb)?;
        material.metallic = 0.0;
        material.roughness = 1.0 - unit(gloss.glossiness_factor.unwrap_or(1.0));
        material.metallic_roughness_texture = None;
        Ok(())
    }
}

fn normal_scale(texture: &TextureOf) -> Option<f32> {
    texture.scale.filter(|scale| scale.is_finite())
}

fn unit(x: f32) -> f32 {
    if x > 0.0 { x.min(1.0) } else { 0.0 }
}
