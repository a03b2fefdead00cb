//! All light there is, along random paths from the eye [Kajiya 86].
//!
//! At every surface a light is picked and, by the material, a direction; where both could
//! have found the same light, each counts by how likely it was to [Veach 95].

mod met;
mod shadows;
mod walk;

use std::mem;

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::ray::Ray;
use nestray_scene::scene::Scene;

use self::met::Met;
use self::shadows::{Shadows, Waiting};
use self::walk::{Step, Walk};
use super::{Integrate, note};
use crate::background;
use crate::eye::{Seen, Start};
use crate::light_sampling::Lights;
use crate::look::Look;
use crate::sampler::{Set, fours};
use crate::tracer::{Tracer, source};

/// See [`Integrator::Path`](crate::options::Integrator).
pub(crate) struct Path<'a> {
    pub(crate) lights: &'a Lights<'a>,
    pub(crate) max_depth: u32,
    /// Most that light counts for which came over two surfaces or more.
    pub(crate) most: f32,
    pub(crate) direct: Direct,
    pub(crate) room: Room,
}

/// Room for the paths of a wave, kept from wave to wave.
#[derive(Debug, Default)]
pub(crate) struct Room {
    walks: Vec<Walk>,
    /// One for each walk.
    rays: Vec<Ray>,
    hits: Vec<Hit>,
    /// The walks that go on, and their rays.
    next: (Vec<Walk>, Vec<Ray>),
    /// The numbers of those that hit something: for a light, and for the way on.
    lights: Vec<[f32; 4]>,
    onwards: Vec<[f32; 4]>,
    shadows: Shadows,
}

/// How light is found that comes straight from where it is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Direct {
    /// Both ways, each by its merits.
    Both,
    /// By picking lights, as far as possible; for tests.
    #[cfg(test)]
    Lights,
    /// By scattering, as far as possible; for tests.
    #[cfg(test)]
    Scattering,
}

/// From here on paths that carry little are cut short by chance.
const ROULETTE: u32 = 4;
/// Shadow rays end this part before the light, so that they do not meet it.
const BEFORE: f32 = 1.0 - 1e-5;

impl Integrate for Path<'_> {
    fn trace(&mut self, tracer: &mut Tracer<'_>, starts: &[Start], seen: &mut Vec<Seen>) {
        seen.clear();
        seen.resize(starts.len(), Seen::NOTHING);
        let mut room = mem::take(&mut self.room);
        let fresh = |(i, start): (usize, &Start)| Walk {
            start: i as u32,
            share: Vec3A::ONE,
            from: start.ray.origin(),
            density: 0.0,
            sharp: true,
        };
        let Room { walks, rays, hits, next, lights, onwards, shadows } = &mut room;
        walks.clear();
        walks.extend(starts.iter().enumerate().map(fresh));
        rays.clear();
        rays.extend(starts.iter().map(|start| start.ray));
        // One more than surfaces are shaded: the last ray only looks for light.
        for depth in 1..=self.max_depth + 1 {
            tracer.closest_solid(rays, hits, |i, tries, alpha| {
                passes_by_chance(&starts[walks[i].start as usize], depth, tries, alpha)
            });
            let which = walks.iter().zip(&*hits).filter(|(_, hit)| hit.is_some());
            let which = which.map(|(walk, _)| &starts[walk.start as usize].sampler);
            let level = tracer.scratch.level;
            fours(level, Set::Light(depth), which.clone(), lights);
            fours(level, Set::Scatter(depth), which, onwards);
            let mut numbers = lights.iter().zip(&*onwards);
            for (i, ((walk, ray), hit)) in walks.iter().zip(&*rays).zip(&*hits).enumerate() {
                tracer.touch(hits, i);
                let start = &starts[walk.start as usize];
                let step = Step { depth, walk, start, ray, hit };
                let seen = &mut seen[walk.start as usize];
                if !hit.is_some() {
                    self.missed(tracer.scene(), &step, seen);
                } else if let Some((&light, &onward)) = numbers.next() {
                    self.step(tracer, &step, (light, onward), seen, shadows, next);
                }
            }
            shadows.settle(tracer, seen);
            mem::swap(walks, &mut next.0);
            mem::swap(rays, &mut next.1);
            next.0.clear();
            next.1.clear();
            if walks.is_empty() {
                break;
            }
        }
        self.room = room;
    }
}

impl Path<'_> {
    /// All that one path does where its ray hit something.
    fn step(
        &self,
        tracer: &Tracer<'_>,
        step: &Step<'_>,
        (light, onward): ([f32; 4], [f32; 4]),
        seen: &mut Seen,
        shadows: &mut Shadows,
        next: &mut (Vec<Walk>, Vec<Ray>),
    ) {
        let Some(met) = self.meet(tracer, step, light[3], seen) else { return };
        if let Some((waiting, ray)) = self.light(&met, step, light) {
            shadows.push(waiting, ray);
        }
        if let Some((walk, ray)) = scatter(&met, step, onward) {
            next.0.push(walk);
            next.1.push(ray);
        }
    }

    /// Takes the light of the surroundings.
    fn missed(&self, scene: &Scene, &Step { depth, walk, ray, .. }: &Step<'_>, seen: &mut Seen) {
        let dir = ray.dir().normalize();
        let light = background::radiance(scene, dir);
        let light = walk.share * light * self.weight(walk, self.lights.density_of_sky(dir));
        seen.color += self.limited(light, depth - 1);
    }

    /// Takes the light of the surface that was hit; that surface, if it is to be shaded.
    fn meet(
        &self,
        tracer: &Tracer<'_>,
        &Step { depth, walk, start, ray, hit }: &Step<'_>,
        part: f32,
        seen: &mut Seen,
    ) -> Option<Met> {
        let point = tracer.point(ray, hit);
        let look = Look::at(tracer.scene(), &point);
        if depth == 1 {
            note(seen, start, ray, hit, &point, &look);
        }
        if look.emission != Vec3A::ZERO {
            let surface = &point.surface;
            let density = match walk.sharp {
                true => 0.0,
                false => self.lights.density_of_hit(walk.from, ray.time(), hit, surface),
            };
            let light = walk.share * look.emission * self.weight(walk, density);
            seen.color += self.limited(light, depth - 1);
        }
        let to_eye = -ray.dir().normalize();
        (depth <= self.max_depth).then(|| Met::new(point.surface, &look, to_eye, part))
    }

    /// How much light counts that was found by scattering, where picking lights finds it
    /// with `density`.
    fn weight(&self, walk: &Walk, density: f32) -> f32 {
        match self.direct {
            _ if walk.sharp || density == 0.0 => 1.0,
            Direct::Both => power(walk.density, density),
            #[cfg(test)]
            Direct::Lights => 0.0,
            #[cfg(test)]
            Direct::Scattering => 1.0,
        }
    }

    /// Light picked for a surface, and the ray that finds out whether it arrives.
    fn light(
        &self,
        met: &Met,
        &Step { depth, walk, ray, hit, .. }: &Step<'_>,
        [u, v, w, _]: [f32; 4],
    ) -> Option<(Waiting, Ray)> {
        if met.bsdf.is_sharp() {
            return None;
        }
        let towards = self.lights.sample(met.surface.position, ray.time(), [u, v, w])?;
        let to_light = met.frame.local(towards.dir);
        // A light must be on the same side of the true surface and of the smooth one.
        if met.normal.dot(towards.dir) * to_light.z <= 0.0 {
            return None;
        }
        let (value, density) = met.bsdf.evaluate(to_light);
        let weight = match self.direct {
            _ if towards.density == 0.0 => 1.0,
            Direct::Both => power(towards.density, density),
            #[cfg(test)]
            Direct::Lights => 1.0,
            #[cfg(test)]
            Direct::Scattering => 0.0,
        };
        let light = walk.share * value * towards.light * weight;
        if light.max_element() <= 0.0 || !light.is_finite() {
            return None;
        }
        let origin = met.surface.leave(towards.dir);
        let shadow = match towards.end {
            Some(end) => Ray::new(origin, end - origin, towards.kind).between(0.0, BEFORE),
            None => Ray::new(origin, towards.dir, towards.kind),
        };
        let ray = shadow.at_time(ray.time()).leaving(source(hit));
        Some((Waiting { start: walk.start, light: self.limited(light, depth) }, ray))
    }

    /// Light that came over so many surfaces, no more of it than may count.
    fn limited(&self, light: Vec3A, surfaces: u32) -> Vec3A {
        let bright = light.max_element();
        if surfaces > 1 && bright > self.most { light * (self.most / bright) } else { light }
    }
}

/// The next ray of a path; none if it ends.
fn scatter(
    met: &Met,
    &Step { depth, walk, ray, hit, .. }: &Step<'_>,
    [which, u, v, stay]: [f32; 4],
) -> Option<(Walk, Ray)> {
    let scatter = met.bsdf.sample([which, u, v])?;
    let dir = met.frame.world(scatter.dir);
    if met.normal.dot(dir) * scatter.dir.z <= 0.0 {
        return None;
    }
    let mut share = walk.share * scatter.weight;
    if depth >= ROULETTE {
        let chance = share.max_element().clamp(0.05, 1.0);
        if stay >= chance {
            return None;
        }
        share /= chance;
    }
    if share.max_element() <= 0.0 || !share.is_finite() {
        return None;
    }
    let surface = &met.surface;
    let onward =
        Ray::new(surface.leave(dir), dir, scatter.kind).at_time(ray.time()).leaving(source(hit));
    let walk = Walk {
        start: walk.start,
        share,
        from: surface.position,
        density: scatter.density,
        sharp: scatter.sharp,
    };
    Some((walk, onward))
}

/// The power heuristic.
fn power(of: f32, other: f32) -> f32 {
    // Divided first: squares of densities of narrow cones overflow.
    let ratio = other / of;
    1.0 / (1.0 + ratio * ratio)
}

/// Whether a ray passes a surface of some opacity, at a depth and try of a path.
pub(crate) fn passes_by_chance(start: &Start, depth: u32, tries: u32, alpha: f32) -> bool {
    match alpha {
        1.0 => false,
        0.0 => true,
        _ => start.sampler.four(Set::Pass(depth, tries))[0] >= alpha,
    }
}

#[cfg(test)]
mod tests;
