//! Opaque surfaces: metallic-roughness as glTF has it, made to lose no energy.
//!
//! A mirror coat, smooth or rough, over a diffuse ground. What bounces more than once
//! between the small mirrors comes back as in [Turquin 19], and the ground gets the light
//! that the coat leaves over, as in [Kulla 17]: so a white surface in a white room cannot be
//! seen, whatever its roughness.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3A;
use nestray_core::ray::RayKind;

use crate::directions::{cosine_density, cosine_weighted, mirrored};
use crate::look::Look;

use super::Scatter;
use super::albedo::{Albedo, ROUGH};
use super::fresnel::{schlick, straight};
use super::ggx::{Ggx, SMOOTHEST};

/// An opaque surface: metal to one part, a coat over a ground to the rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layered {
    /// Colour of the ground, times its part.
    ground: Vec3A,
    metal: Mirror,
    coat: Mirror,
    /// None if it is smooth.
    rough: Option<(Ggx, f32)>,
    /// Share the coat leaves over for the ground, from all sides.
    left: f32,
}

/// Something that mirrors.
#[derive(Clone, Copy, Debug)]
struct Mirror {
    /// How much of the surface it is.
    part: f32,
    /// What it mirrors, seen straight on.
    straight: Vec3A,
    /// What it mirrors seen edge-on: nothing where nothing is mirrored at all, so that a coat
    /// of index 1 makes pure chalk.
    edge: f32,
}

impl Mirror {
    fn new(part: f32, straight: Vec3A) -> Self {
        Self { part, straight, edge: (50.0 * straight.max_element()).min(1.0) }
    }

    /// What a small mirror at this angle gives back, as part of the surface.
    fn at(&self, cosine: f32) -> Vec3A {
        schlick(self.straight, self.edge, cosine) * self.part
    }

    /// The same, with what rays add that bounce more than once.
    fn rough_at(&self, cosine: f32, albedo: Albedo) -> Vec3A {
        self.at(cosine) * (Vec3A::ONE + self.straight * albedo.lost())
    }

    /// Share it gives back, at most, over the colours.
    fn albedo(&self, albedo: Albedo) -> f32 {
        albedo.of(self.straight.max_element(), self.edge)
    }
}

impl Layered {
    pub(crate) fn new(look: &Look) -> Self {
        let rest = 1.0 - look.metallic;
        let smooth = look.roughness < SMOOTHEST;
        let mut layered = Self {
            ground: look.base * rest,
            metal: Mirror::new(look.metallic, look.base),
            coat: Mirror::new(rest, Vec3A::splat(straight(look.ior))),
            rough: (!smooth).then(|| (Ggx::new(look.roughness * look.roughness), look.roughness)),
            left: 1.0,
        };
        layered.left = (1.0 - layered.coat.albedo(layered.all_around())).max(0.0);
        layered
    }

    pub(crate) fn is_sharp(&self) -> bool {
        self.rough.is_none() && self.ground == Vec3A::ZERO
    }

    pub(crate) fn evaluate(&self, v: Vec3A, l: Vec3A) -> (Vec3A, f32) {
        if v.z <= 0.0 || l.z <= 0.0 {
            return (Vec3A::ZERO, 0.0);
        }
        let albedo = self.seen_from(v.z);
        let chance = self.chance_of_mirror(albedo);
        let mut value = self.ground * (self.through(albedo, l.z) * l.z * FRAC_1_PI);
        let mut density = (1.0 - chance) * cosine_density(l.z);
        if let Some((ggx, _)) = self.rough {
            let h = (v + l).normalize_or_zero();
            let along = v.dot(h);
            if h.z > 0.0 && along > 0.0 {
                let seen = ggx.density_seen(v, h) / (4.0 * along);
                let both = ggx.seen_by_both(v, l) / ggx.seen(v);
                let mirrored =
                    self.metal.rough_at(along, albedo) + self.coat.rough_at(along, albedo);
                value += mirrored * (seen * both);
                density += chance * seen;
            }
        }
        (value, density)
    }

    pub(crate) fn sample(&self, v: Vec3A, [which, u, w]: [f32; 3]) -> Option<Scatter> {
        if v.z <= 0.0 {
            return None;
        }
        let chance = self.chance_of_mirror(self.seen_from(v.z));
        let dir = if which >= chance {
            cosine_weighted([u, w])
        } else if let Some((ggx, _)) = self.rough {
            mirrored(v, ggx.sample(v, [u, w]))
        } else {
            let weight = (self.metal.at(v.z) + self.coat.at(v.z)) / chance;
            let dir = mirrored(v, Vec3A::Z);
            let kind = RayKind::Reflect;
            return Some(Scatter { dir, weight, density: 0.0, sharp: true, kind });
        };
        let (value, density) = self.evaluate(v, dir);
        let kind = if which >= chance { RayKind::Diffuse } else { RayKind::Reflect };
        let weight = value / density;
        (density > 0.0 && dir.z > 0.0).then_some(Scatter {
            dir,
            weight,
            density,
            sharp: false,
            kind,
        })
    }

    /// How often a mirrored direction is sampled, not one of those all around.
    fn chance_of_mirror(&self, albedo: Albedo) -> f32 {
        let coat = self.coat.albedo(albedo);
        let all = self.metal.part * self.metal.albedo(albedo) + self.coat.part * coat;
        // What comes back after several bounces is sampled as the ground is: few of the
        // directions after one would otherwise have to carry it.
        let mirror = all / (1.0 + albedo.lost());
        let again = all - mirror;
        let ground = self.ground.max_element() * (1.0 - coat);
        if ground <= 0.0 {
            return if mirror > 0.0 { mirror / (mirror + again) } else { 1.0 };
        }
        if mirror <= 0.0 {
            return 0.0;
        }
        (mirror / (mirror + ground + again)).clamp(0.1, 0.9)
    }

    /// What mirrors of this roughness give back of light from one side.
    fn seen_from(&self, cosine: f32) -> Albedo {
        match self.rough {
            Some((_, roughness)) => ROUGH.at(cosine, roughness),
            None => Albedo::smooth(cosine),
        }
    }

    /// The same of light from all sides.
    fn all_around(&self) -> Albedo {
        match self.rough {
            Some((_, roughness)) => ROUGH.average(roughness),
            None => Albedo::SMOOTH_AVERAGE,
        }
    }

    /// Share of light that gets through the coat to the ground and out again.
    fn through(&self, v: Albedo, l: f32) -> f32 {
        if self.left < 1e-4 {
            return 0.0;
        }
        (1.0 - self.coat.albedo(v)) * (1.0 - self.coat.albedo(self.seen_from(l))) / self.left
    }
}
