//! Coefficients of Whitted's model, from a file or made up.

use glam::Vec3A;
use nestray_scene::material::Whitted;

use crate::look::Look;

/// How a surface shines, per colour channel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coefficients {
    /// Of light on a dull surface.
    pub(super) diffuse: Vec3A,
    /// Of highlights.
    pub(super) highlight: Vec3A,
    /// Phong exponent of highlights.
    pub(super) shine: f32,
    /// Of the reflected ray.
    pub(super) mirror: Vec3A,
    /// Of the refracted ray.
    pub(super) through: Vec3A,
    /// Index of refraction.
    pub(super) ior: f32,
}

impl Coefficients {
    /// Those of the file if it has some; else from metallic-roughness:
    ///
    /// * dull: the base colour, as far as it is neither metal nor clear; of metal the part
    ///   that one reflected ray does not show;
    /// * highlight: a lobe of Phong's as wide as the roughness, and as much light in it as
    ///   the surface mirrors; less on dull metal;
    /// * reflected ray: what is mirrored by Schlick's formula, times `(1 − roughness)⁴`, since
    ///   one ray cannot show a blurred image;
    /// * refracted ray: the rest of the base colour, as far as it is clear.
    pub(super) fn new(look: &Look, whitted: Option<Whitted>, cosine: f32, front: bool) -> Self {
        if let Some(Whitted { color, kd, ks, shine, t }) = whitted {
            return Self {
                diffuse: Vec3A::from(color) * look.tint * kd,
                highlight: Vec3A::splat(ks),
                shine,
                mirror: Vec3A::splat(ks),
                through: Vec3A::splat(t),
                ior: look.ior,
            };
        }
        let dull = 1.0 - look.metallic;
        let clear = look.transmission * dull;
        let part = (look.ior - 1.0) / (look.ior + 1.0);
        let straight = Vec3A::splat(part * part * dull) + look.base * look.metallic;
        let edge = (50.0 * straight.max_element()).min(1.0);
        let mirrored = if clear > 0.0 {
            let eta = if front { look.ior } else { 1.0 / look.ior };
            Vec3A::splat(crate::bsdf::mirrored_by_glass(cosine, eta))
        } else {
            crate::bsdf::mirrored_by_coat(straight, edge, cosine)
        };
        let alpha = (look.roughness * look.roughness).clamp(0.03, 1.0);
        let shine = 2.0 / (alpha * alpha) - 2.0;
        let sharp = 1.0 - look.roughness;
        let sharp = if clear > 0.0 { 1.0 } else { sharp * sharp * sharp * sharp };
        Self {
            diffuse: look.base * (dull - clear + look.metallic * (1.0 - sharp)),
            highlight: straight * (0.5 * (shine + 2.0) * (1.0 - alpha)),
            shine,
            mirror: mirrored * sharp,
            through: (Vec3A::ONE - mirrored) * look.base * clear,
            ior: look.ior,
        }
    }
}
