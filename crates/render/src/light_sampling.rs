//! Where light comes from: picks lights by their power and places on them.
//!
//! Lights without a surface, glowing triangles and shapes wherever their instances stand,
//! and pictures of the surroundings. Backgrounds of one colour or a gradient are left to
//! scattered rays, which find them best.

pub(crate) mod bare;
mod chances;
mod emitter;
mod gather;
mod outline;
mod surroundings;

use std::f32::consts::PI;

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::ray::RayKind;
use nestray_core::surface::Surface;
use nestray_scene::light::Background;
use nestray_scene::scene::Scene;
use nestray_scene::surfaces::Surfaces;

use self::chances::Chances;
use self::emitter::{Emitter, Standing};
use self::surroundings::Surroundings;

/// All lights of a scene that are sampled.
pub(crate) struct Lights<'a> {
    scene: &'a Scene,
    /// None if nothing shines. Lights of the scene, then emitters, then surroundings.
    chances: Option<Chances>,
    /// Where instances of emitters stand.
    standing: Vec<Standing>,
    /// By name, ascending.
    emitters: Vec<Emitter>,
    surroundings: Option<Surroundings>,
}

/// A direction that light comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Towards {
    /// Of length one.
    pub(crate) dir: Vec3A,
    /// Where the light is; none if infinitely far.
    pub(crate) end: Option<Vec3A>,
    /// Its radiance over the density.
    pub(crate) light: Vec3A,
    /// Density per solid angle; 0 for a light without a surface, which scattered rays
    /// cannot find.
    pub(crate) density: f32,
    /// What a shadow ray there is cast for.
    pub(crate) kind: RayKind,
}

impl<'a> Lights<'a> {
    pub(crate) fn new(surfaces: &Surfaces<'a>) -> Self {
        let scene = surfaces.scene();
        let (emitters, standing, powers) = gather::emitters(surfaces);
        let surroundings = Surroundings::new(scene);
        let reach = scene.bounds();
        let radius = if reach.is_empty() || !reach.is_bounded() {
            1.0
        } else {
            (0.5 * (reach.max - reach.min).length()).max(1e-6)
        };
        let middle = if reach.is_bounded() { (reach.min + reach.max) * 0.5 } else { Vec3A::ZERO };
        let bare = scene.lights.iter().map(|light| bare::power(light, middle, radius));
        let sky = surroundings.as_ref().map(|s| s.mean * 4.0 * PI * PI * radius * radius);
        let weights: Vec<f64> = bare.chain(powers).chain(sky).map(f64::from).collect();
        Self { scene, chances: Chances::new(&weights), standing, emitters, surroundings }
    }

    /// A direction from `at` that light comes from; none if none is found.
    pub(crate) fn sample(&self, at: Vec3A, time: f32, [u, v, w]: [f32; 3]) -> Option<Towards> {
        let (which, chance) = self.chances.as_ref()?.pick(u);
        let bare = self.scene.lights.len();
        if which < bare {
            let arriving = bare::arriving(&self.scene.lights[which], at)?;
            return Some(Towards {
                dir: arriving.dir,
                end: arriving.end,
                light: arriving.brightness * (PI / chance),
                density: 0.0,
                kind: shadow(which),
            });
        }
        if let Some(emitter) = self.emitters.get(which - bare) {
            let spot = emitter.sample(self.scene, &self.standing, at, time, [v, w])?;
            let density = spot.density * chance;
            return Some(Towards {
                dir: (spot.position - at).try_normalize()?,
                end: Some(spot.position),
                light: spot.emission / density,
                density,
                kind: shadow(bare),
            });
        }
        let (dir, density) = self.surroundings.as_ref()?.sample([v, w])?;
        let density = density * chance;
        let light = crate::background::radiance(self.scene, dir) / density;
        Some(Towards { dir, end: None, light, density, kind: shadow(bare + 1) })
    }

    /// The density with which [`sample`](Self::sample) would have picked the direction from
    /// `at` to a hit; 0 if it never does.
    pub(crate) fn density_of_hit(&self, at: Vec3A, time: f32, hit: &Hit, seen: &Surface) -> f32 {
        let name = (hit.geometry, hit.primitive, hit.path.number());
        let Ok(found) = self.emitters.binary_search_by_key(&name, Emitter::name) else {
            return 0.0;
        };
        let chance = self.chance(self.scene.lights.len() + found);
        if chance == 0.0 {
            return 0.0;
        }
        chance * self.emitters[found].density(self.scene, &self.standing, at, time, seen)
    }

    /// The same for a direction in which nothing is.
    pub(crate) fn density_of_sky(&self, dir: Vec3A) -> f32 {
        let Some(surroundings) = &self.surroundings else { return 0.0 };
        let chance = self.chance(self.scene.lights.len() + self.emitters.len());
        if chance == 0.0 { 0.0 } else { chance * surroundings.density(dir) }
    }

    fn chance(&self, which: usize) -> f32 {
        self.chances.as_ref().map_or(0.0, |chances| chances.of(which))
    }
}

/// The kind of a shadow ray: the number of its light in the scene; surfaces that glow share
/// the number after the last, and surroundings the one after that.
pub(crate) fn shadow(light: usize) -> RayKind {
    RayKind::Shadow { light: u16::try_from(light).unwrap_or(u16::MAX) }
}

/// How bright a colour looks.
pub(crate) fn luminance(color: Vec3A) -> f32 {
    color.dot(Vec3A::new(0.2126, 0.7152, 0.0722))
}

/// Whether the background is a picture, which is sampled.
fn picture_of(scene: &Scene) -> Option<(usize, f32, f32)> {
    match scene.background {
        Background::Environment { texture, radians, scale } => Some((texture, radians, scale)),
        Background::Color(_) | Background::Gradient(..) => None,
    }
}

#[cfg(test)]
mod tests;
