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

/// Coefficients of [Whitted 80] as NFF has them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// Colour of the diffuse part, multiplied by the texture and by vertex colours; stands
    /// for the base colour, which other models use.
    pub color: [f32; 3],
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
    /// The material of a fill of NFF: the coefficients as they are for Whitted's model, and
    /// for others what comes closest. Mirrors are sharp there whatever `shine` says, so they
    /// are here; what is not reflected is diffuse or, as far as `t` says, passes through.
    #[must_use]
    pub fn from_nff(color: [f32; 3], kd: f32, ks: f32, shine: f32, t: f32, ior: f32) -> Self {
        let share = |part: f32, whole: f32| if part > 0.0 { (part / whole).min(1.0) } else { 0.0 };
        let bright = (kd + ks + t).clamp(0.0, 1.0);
        let glass = t > 0.0;
        Self {
            base_color: color.map(|x| x * bright),
            metallic: if glass { 0.0 } else { share(ks, kd + ks) },
            roughness: if glass || ks > 0.0 { 0.0 } else { 1.0 },
            transmission: share(t, kd + t),
            ior: ior.max(1.0),
            whitted: Some(Whitted { color, kd, ks, shine, t }),
            ..Self::default()
        }
    }

    /// Whether it gives off light.
    #[must_use]
    pub fn glows(&self) -> bool {
        self.emission.iter().any(|&x| x > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fill_of_nff_keeps_its_coefficients() {
        let gold = Material::from_nff([1.0, 0.9, 0.7], 0.5, 0.5, 3.0827, 0.0, 0.0);
        let whitted = Whitted { color: [1.0, 0.9, 0.7], kd: 0.5, ks: 0.5, shine: 3.0827, t: 0.0 };
        assert_eq!(gold.whitted, Some(whitted));
        assert_eq!((gold.metallic, gold.roughness, gold.ior), (0.5, 0.0, 1.0));
        let chalk = Material::from_nff([1.0, 0.5, 0.0], 0.8, 0.0, 1e5, 0.0, 1.0);
        assert_eq!((chalk.base_color, chalk.metallic), ([0.8, 0.4, 0.0], 0.0));
        assert_eq!((chalk.roughness, chalk.transmission), (1.0, 0.0));
    }

    #[test]
    fn a_fill_of_nff_that_transmits_is_glass() {
        let glass = Material::from_nff([1.0; 3], 0.1, 0.1, 101.0, 0.9, 1.5);
        assert_eq!((glass.metallic, glass.roughness, glass.ior), (0.0, 0.0, 1.5));
        assert!((glass.transmission - 0.9).abs() < 1e-6);
        let black = Material::from_nff([1.0; 3], 0.0, 0.0, 1.0, 0.0, 0.0);
        assert_eq!((black.base_color, black.metallic, black.transmission), ([0.0; 3], 0.0, 0.0));
    }
}
