//! Clear boundaries, smooth or rough: they mirror and refract.
//!
//! What is followed is radiance over the square of the index, so that light that enters and
//! leaves again comes out as bright as it was.

use glam::Vec3A;
use nestray_core::ray::RayKind;

use crate::directions::{mirrored, refracted};

use super::Scatter;
use super::fresnel::dielectric;
use super::ggx::{Ggx, SMOOTHEST, Viewed};
use super::glass_albedo::kept;

/// A clear boundary, seen from one side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Glass {
    /// How much slower light is behind it.
    eta: f32,
    to_eye: Vec3A,
    /// None if it is smooth, or nothing at all.
    rough: Option<Rough>,
    /// What light that passes is multiplied by.
    tint: Vec3A,
}

/// What is known of a rough boundary.
#[derive(Clone, Copy, Debug)]
struct Rough {
    /// The small mirrors, from `to_eye`.
    viewed: Viewed,
    /// Share of the light that leaves after one bounce.
    kept: f32,
}

impl Glass {
    pub(crate) fn new(eta: f32, roughness: f32, tint: Vec3A, to_eye: Vec3A) -> Self {
        let smooth = roughness < SMOOTHEST || eta == 1.0;
        let rough = (!smooth).then(|| Rough {
            viewed: Ggx::new(roughness * roughness).viewed(to_eye),
            kept: kept(to_eye.z, roughness, eta),
        });
        Self { eta, to_eye, rough, tint }
    }

    pub(crate) fn is_sharp(&self) -> bool {
        self.rough.is_none()
    }

    pub(crate) fn evaluate(&self, l: Vec3A) -> (Vec3A, f32) {
        let Some(Rough { viewed, kept }) = &self.rough else { return (Vec3A::ZERO, 0.0) };
        let v = self.to_eye;
        if v.z <= 0.0 || l.z == 0.0 {
            return (Vec3A::ZERO, 0.0);
        }
        let through = l.z < 0.0;
        let scale = if through { self.eta } else { 1.0 };
        let h = (l * scale + v).normalize_or_zero();
        let h = if h.z < 0.0 { -h } else { h };
        let (along_v, along_l) = (v.dot(h), l.dot(h));
        // A small mirror seen from behind by either.
        if along_v <= 0.0 || along_l * l.z <= 0.0 {
            return (Vec3A::ZERO, 0.0);
        }
        let mirror = dielectric(along_v, self.eta);
        let seen = viewed.density(h);
        let both = viewed.both(l) / kept;
        let (density, tint) = if through {
            let spread = along_l + along_v / self.eta;
            (seen * along_l.abs() / (spread * spread) * (1.0 - mirror), self.tint)
        } else {
            (seen / (4.0 * along_v) * mirror, Vec3A::ONE)
        };
        (tint * (density * both), density)
    }

    pub(crate) fn sample(&self, [which, u, w]: [f32; 3]) -> Option<Scatter> {
        let to_eye = self.to_eye;
        let h = self.rough.as_ref().map_or(Vec3A::Z, |rough| rough.viewed.sample([u, w]));
        let mirror = dielectric(to_eye.dot(h), self.eta);
        let (dir, weight, kind) = if which < mirror {
            (mirrored(to_eye, h), Vec3A::ONE, RayKind::Reflect)
        } else {
            (refracted(to_eye, h, self.eta)?, self.tint, RayKind::Refract)
        };
        if self.rough.is_none() {
            return Some(Scatter { dir, weight, density: 0.0, sharp: true, kind });
        }
        if (dir.z > 0.0) != (kind == RayKind::Reflect) {
            return None;
        }
        let (value, density) = self.evaluate(dir);
        let weight = value / density;
        (density > 0.0).then_some(Scatter { dir, weight, density, sharp: false, kind })
    }
}
