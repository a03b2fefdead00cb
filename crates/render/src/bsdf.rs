//! How a surface scatters light: what share of it goes where.
//!
//! Directions are local: `z` is the shading normal, on the side of `to_eye`. Both directions
//! point away from the surface.

mod albedo;
mod fresnel;
mod ggx;
mod glass;
mod glass_albedo;
mod layered;

use glam::Vec3A;
use nestray_core::ray::RayKind;

use crate::look::Look;

use self::glass::Glass;
use self::layered::Layered;

/// How a surface scatters light at one point, towards the eye.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Bsdf {
    /// Opaque: a coat that mirrors over a diffuse ground, or metal.
    Layered(Layered),
    /// Clear: mirrors and refracts.
    Glass(Glass),
}

/// A direction that light may come from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scatter {
    /// The direction.
    pub(crate) dir: Vec3A,
    /// Share of the light from there, times the cosine, over the density.
    pub(crate) weight: Vec3A,
    /// Density per solid angle; of a sharp direction, nothing.
    pub(crate) density: f32,
    /// Whether it is the only direction of its kind, which no light is sampled for.
    pub(crate) sharp: bool,
    /// What a ray there is cast for.
    pub(crate) kind: RayKind,
}

impl Bsdf {
    /// Of a material at a point, seen from its front or its back along `to_eye`. A material
    /// that is partly clear is either, by chance: `u` in `[0, 1)`.
    pub(crate) fn new(look: &Look, front: bool, u: f32, to_eye: Vec3A) -> Self {
        let clear = look.transmission * (1.0 - look.metallic);
        if u < clear {
            let eta = if front { look.ior } else { 1.0 / look.ior };
            Self::Glass(Glass::new(eta, look.roughness, look.base, to_eye))
        } else {
            Self::Layered(Layered::new(look, to_eye))
        }
    }

    /// Share of the light from `to_light` times its cosine, and the density with which
    /// [`sample`](Self::sample) picks that direction; sharp directions left out.
    pub(crate) fn evaluate(&self, to_light: Vec3A) -> (Vec3A, f32) {
        match self {
            Self::Layered(layered) => layered.evaluate(to_light),
            Self::Glass(glass) => glass.evaluate(to_light),
        }
    }

    /// Picks a direction, more often where more light comes from; none if it absorbs.
    pub(crate) fn sample(&self, u: [f32; 3]) -> Option<Scatter> {
        match self {
            Self::Layered(layered) => layered.sample(u),
            Self::Glass(glass) => glass.sample(u),
        }
    }

    /// Whether it scatters in sharp directions only.
    pub(crate) fn is_sharp(&self) -> bool {
        match self {
            Self::Layered(layered) => layered.is_sharp(),
            Self::Glass(glass) => glass.is_sharp(),
        }
    }
}

/// Share of light that a smooth clear boundary mirrors; see [`fresnel::dielectric`].
pub(crate) fn mirrored_by_glass(cosine: f32, eta: f32) -> f32 {
    fresnel::dielectric(cosine, eta)
}

/// Share of light that a smooth coat mirrors; see [`fresnel::schlick`].
pub(crate) fn mirrored_by_coat(straight: Vec3A, edge: f32, cosine: f32) -> Vec3A {
    fresnel::schlick(straight, edge, cosine)
}

#[cfg(test)]
mod tests;
