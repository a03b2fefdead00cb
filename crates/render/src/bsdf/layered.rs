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
use super::albedo::{Albedo, Row};
use super::fresnel::{schlick, straight};
use super::ggx::{Ggx, SMOOTHEST, Viewed};

/// An opaque surface: metal to one part, a coat over a ground to the rest, seen from one side.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Layered {
    /// Colour of the ground, times its part.
    ground: Vec3A,
    metal: Mirror,
    coat: Mirror,
    /// None if it is smooth.
    rough: Option<Rough>,
    /// Share the coat leaves over for the ground, from all sides.
    left: f32,
    /// The same from `to_eye`.
    left_there: f32,
    to_eye: Vec3A,
    /// How often a mirrored direction is sampled, not one of those all around.
    chance: f32,
}

/// What is known of a rough surface.
#[derive(Clone, Copy, Debug)]
struct Rough {
    /// The small mirrors, from `to_eye`.
    viewed: Viewed,
    /// What mirrors of this roughness give back.
    row: Row,
    /// What a perfect one loses, see [`Albedo::lost`].
    lost: f32,
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

    /// The same, with what rays add that bounce more than once, of which so much is `lost`.
    fn rough_at(&self, cosine: f32, lost: f32) -> Vec3A {
        self.at(cosine) * (Vec3A::ONE + self.straight * lost)
    }

    /// Share it gives back, at most, over the colours.
    fn albedo(&self, albedo: Albedo) -> f32 {
        albedo.of(self.straight.max_element(), self.edge)
    }
}

impl Layered {
    pub(crate) fn new(look: &Look, to_eye: Vec3A) -> Self {
        let rest = 1.0 - look.metallic;
        let ground = look.base * rest;
        let metal = Mirror::new(look.metallic, look.base);
        let coat = Mirror::new(rest, Vec3A::splat(straight(look.ior)));
        let smooth = look.roughness < SMOOTHEST;
        let row = (!smooth).then(|| Row::new(look.roughness));
        let (albedo, all_around) = match &row {
            Some(row) => (row.at(to_eye.z), row.average()),
            None => (Albedo::smooth(to_eye.z), Albedo::SMOOTH_AVERAGE),
        };
        let rough = row.map(|row| Rough {
            viewed: Ggx::new(look.roughness * look.roughness).viewed(to_eye),
            row,
            lost: albedo.lost(),
        });
        let left = (1.0 - coat.albedo(all_around)).max(0.0);
        let chance = chance_of_mirror(ground, &metal, &coat, albedo);
        let left_there = 1.0 - coat.albedo(albedo);
        Self { ground, metal, coat, rough, left, left_there, to_eye, chance }
    }

    pub(crate) fn is_sharp(&self) -> bool {
        self.rough.is_none() && self.ground == Vec3A::ZERO
    }

    pub(crate) fn evaluate(&self, l: Vec3A) -> (Vec3A, f32) {
        let v = self.to_eye;
        if v.z <= 0.0 || l.z <= 0.0 {
            return (Vec3A::ZERO, 0.0);
        }
        let mut value = self.ground * (self.through(l.z) * l.z * FRAC_1_PI);
        let mut density = (1.0 - self.chance) * cosine_density(l.z);
        if let Some(Rough { viewed, lost, .. }) = &self.rough {
            let h = (v + l).normalize_or_zero();
            let along = v.dot(h);
            if h.z > 0.0 && along > 0.0 {
                let seen = viewed.density(h) / (4.0 * along);
                let mut mirrored = self.coat.rough_at(along, *lost);
                if self.metal.part > 0.0 {
                    mirrored += self.metal.rough_at(along, *lost);
                }
                value += mirrored * (seen * viewed.both(l));
                density += self.chance * seen;
            }
        }
        (value, density)
    }

    pub(crate) fn sample(&self, [which, u, w]: [f32; 3]) -> Option<Scatter> {
        let v = self.to_eye;
        if v.z <= 0.0 {
            return None;
        }
        let mirror = which < self.chance;
        let dir = if !mirror {
            cosine_weighted([u, w])
        } else if let Some(Rough { viewed, .. }) = &self.rough {
            mirrored(v, viewed.sample([u, w]))
        } else {
            let weight = (self.metal.at(v.z) + self.coat.at(v.z)) / self.chance;
            let dir = mirrored(v, Vec3A::Z);
            let kind = RayKind::Reflect;
            return Some(Scatter { dir, weight, density: 0.0, sharp: true, kind });
        };
        let (value, density) = self.evaluate(dir);
        let kind = if mirror { RayKind::Reflect } else { RayKind::Diffuse };
        let weight = value / density;
        (density > 0.0 && dir.z > 0.0).then_some(Scatter {
            dir,
            weight,
            density,
            sharp: false,
            kind,
        })
    }

    /// Share of light that gets through the coat to the ground and out again.
    fn through(&self, cosine: f32) -> f32 {
        if self.left < 1e-4 {
            return 0.0;
        }
        let albedo = match &self.rough {
            Some(rough) => rough.row.at(cosine),
            None => Albedo::smooth(cosine),
        };
        self.left_there * (1.0 - self.coat.albedo(albedo)) / self.left
    }
}

/// How often a mirrored direction is sampled, not one of those all around.
fn chance_of_mirror(ground: Vec3A, metal: &Mirror, coat: &Mirror, albedo: Albedo) -> f32 {
    let on_top = coat.albedo(albedo);
    let all = metal.part * metal.albedo(albedo) + coat.part * on_top;
    // What comes back after several bounces is sampled as the ground is: few of the
    // directions after one would otherwise have to carry it.
    let mirror = all / (1.0 + albedo.lost());
    let again = all - mirror;
    let ground = ground.max_element() * (1.0 - on_top);
    if ground <= 0.0 {
        return if mirror > 0.0 { mirror / (mirror + again) } else { 1.0 };
    }
    if mirror <= 0.0 {
        return 0.0;
    }
    (mirror / (mirror + ground + again)).clamp(0.1, 0.9)
}
