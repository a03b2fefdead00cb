//! What surfaces are made of.

/// How a surface scatters light: metallic-roughness as glTF has it, glass, and, where a
/// file gives them, the coefficients of Whitted's model. Colours are linear, per channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// What it is called; may be empty.
    pub name: String,
    /// Reflectance, in `[0, 1]`; multiplied by the texture and by vertex colours.
    pub base_color: [f32; 3],
    /// Texture of the base colour and alpha.
    pub base_texture: Option<usize>,
    /// 0 for plastics, wood, stone; 1 for metals.
    pub metallic: f32,
    /// 0 for a mirror, 1 for chalk.
    pub roughness: f32,
    /// Texture of roughness (green) and metalness (blue).
    pub metallic_roughness_texture: Option<usize>,
    /// Tangent-space normal map.
    pub normal_texture: Option<usize>,
    /// How strongly the normal map counts.
    pub normal_scale: f32,
    /// Radiance given off, per channel; not negative.
    pub emission: [f32; 3],
    /// Texture that emission is multiplied by.
    pub emission_texture: Option<usize>,
    /// Share of the light that is not reflected and passes through, in `[0, 1]`.
    pub transmission: f32,
    /// Index of refraction, at least 1 for anything solid.
    pub ior: f32,
    /// Opacity, multiplied by the alpha of texture and vertex colours.
    pub alpha: f32,
    /// What alpha means.
    pub alpha_mode: AlphaMode,
    /// Coefficients of Whitted's model, if the file has them; made up from the rest if not.
    pub whitted: Option<Whitted>,
}

/// What alpha means.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Nothing: the surface is opaque.
    #[default]
    Opaque,
    /// Below this it is not there at all.
    Mask(f32),
    /// The chance that it is there.
    Blend,
}

/// Coefficients of [Whitted 80] as NFF has them; the colour is the base colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// Diffuse coefficient.
    pub kd: f32,
    /// Specular coefficient, of highlights and reflected rays.
    pub ks: f32,
    /// Phong exponent of highlights.
    pub shine: f32,
    /// Transmitted share.
    pub t: f32,
}

impl Default for Material {
    /// Grey plaster.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [0.7; 3],
            base_texture: None,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emission: [0.0; 3],
            emission_texture: None,
            transmission: 0.0,
            ior: 1.5,
            alpha: 1.0,
            alpha_mode: AlphaMode::Opaque,
            whitted: None,
        }
    }
}

impl Material {
    /// Whether it gives off light.
    #[must_use]
    pub fn glows(&self) -> bool {
        self.emission.iter().any(|&x| x > 0.0)
    }
}
