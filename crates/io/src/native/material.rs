//! Materials.

use nestray_scene::material as scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number;

/// How a surface scatters light; what is left out is grey plaster.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Material {
    /// What it is called.
    name: String,
    /// Reflectance, linear, from 0 to 1; multiplied by texture and vertex colours.
    base_color: [f32; 3],
    /// Texture of the base colour and alpha.
    #[serde(skip_serializing_if = "Option::is_none")]
    base_texture: Option<usize>,
    /// 0 for plastics, wood, stone; 1 for metals.
    metallic: f32,
    /// 0 for a mirror, 1 for chalk.
    roughness: f32,
    /// Texture of roughness (green) and metalness (blue).
    #[serde(skip_serializing_if = "Option::is_none")]
    metallic_roughness_texture: Option<usize>,
    /// Tangent-space normal map.
    #[serde(skip_serializing_if = "Option::is_none")]
    normal_texture: Option<usize>,
    /// How strongly the normal map counts.
    normal_scale: f32,
    /// Radiance given off.
    emission: [f32; 3],
    /// Texture that emission is multiplied by.
    #[serde(skip_serializing_if = "Option::is_none")]
    emission_texture: Option<usize>,
    /// Share of the light that is not reflected and passes through, from 0 to 1.
    transmission: f32,
    /// Index of refraction.
    ior: f32,
    /// Opacity.
    alpha: f32,
    /// What alpha means.
    alpha_mode: AlphaMode,
    /// Coefficients of Whitted's model.
    #[serde(skip_serializing_if = "Option::is_none")]
    whitted: Option<Whitted>,
}

/// What alpha means.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(super) enum AlphaMode {
    /// Nothing: the surface is opaque.
    Opaque,
    /// Below this it is not there at all.
    Mask(f32),
    /// The chance that it is there.
    Blend,
}

/// Coefficients of Whitted's model.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(super) struct Whitted {
    /// Colour of the diffuse part, instead of the base colour.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    color: Option<[f32; 3]>,
    /// Diffuse coefficient.
    kd: f32,
    /// Specular coefficient.
    ks: f32,
    /// Phong exponent.
    shine: f32,
    /// Transmitted share.
    t: f32,
}

impl Default for Material {
    fn default() -> Self {
        Self::of(&scene::Material::default())
    }
}

impl Material {
    pub(super) fn build(&self, textures: usize) -> Result<scene::Material, String> {
        let texture = |name: &str, wanted: Option<usize>| match wanted {
            Some(wanted) => number(&format!(".{name}"), wanted, textures, "texture").map(Some),
            None => Ok(None),
        };
        let whitted = self.whitted.map(|Whitted { color, kd, ks, shine, t }| {
            let color = color.unwrap_or(self.base_color);
            scene::Whitted { color, kd, ks, shine, t }
        });
        Ok(scene::Material {
            name: self.name.clone(),
            base_color: self.base_color,
            base_texture: texture("base_texture", self.base_texture)?,
            metallic: self.metallic,
            roughness: self.roughness,
            metallic_roughness_texture: texture(
                "metallic_roughness_texture",
                self.metallic_roughness_texture,
            )?,
            normal_texture: texture("normal_texture", self.normal_texture)?,
            normal_scale: self.normal_scale,
            emission: self.emission,
            emission_texture: texture("emission_texture", self.emission_texture)?,
            transmission: self.transmission,
            ior: self.ior,
            alpha: self.alpha,
            alpha_mode: match self.alpha_mode {
                AlphaMode::Opaque => scene::AlphaMode::Opaque,
                AlphaMode::Mask(below) => scene::AlphaMode::Mask(below),
                AlphaMode::Blend => scene::AlphaMode::Blend,
            },
            whitted,
        })
    }

    pub(super) fn of(material: &scene::Material) -> Self {
        let m = material.clone();
        Self {
            name: m.name,
            base_color: m.base_color,
            base_texture: m.base_texture,
            metallic: m.metallic,
            roughness: m.roughness,
            metallic_roughness_texture: m.metallic_roughness_texture,
            normal_texture: m.normal_texture,
            normal_scale: m.normal_scale,
            emission: m.emission,
            emission_texture: m.emission_texture,
            transmission: m.transmission,
            ior: m.ior,
            alpha: m.alpha,
            alpha_mode: match m.alpha_mode {
                scene::AlphaMode::Opaque => AlphaMode::Opaque,
                scene::AlphaMode::Mask(below) => AlphaMode::Mask(below),
                scene::AlphaMode::Blend => AlphaMode::Blend,
            },
            whitted: m.whitted.map(|w| Whitted {
                color: Some(w.color),
                kd: w.kd,
                ks: w.ks,
                shine: w.shine,
                t: w.t,
            }),
        }
    }
}
