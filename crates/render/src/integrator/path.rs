//! All light there is, along random paths from the eye [Kajiya 86].
//!
//! At every surface a light is picked and, by the material, a direction; where both could
//! have found the same light, each counts by how likely it was to [Veach 95].

mod met;

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::ray::Ray;

use self::met::Met;
use super::{Integrate, note};
use crate::background;
use crate::eye::{Seen, Start};
use crate::light_sampling::Lights;
use crate::look::Look;
use crate::sampler::Set;
use crate::tracer::{Tracer, source};

/// See [`Integrator::Path`](crate::options::Integrator).
pub(crate) struct Path<'a> {
    pub(crate) lights: Lights<'a>,
    pub(crate) max_depth: u32,
    /// Most that light counts for which came over two surfaces or more.
    pub(crate) most: f32,
    pub(crate) direct: Direct,
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

/// A path on its way.
#[derive(Clone, Copy, Debug)]
struct Walk {
    /// Which of the starts.
    start: u32,
    /// What light from here on is multiplied by.
    share: Vec3A,
    /// Where it was scattered last.
    from: Vec3A,
    /// With what density; of no use if `sharp`.
    density: f32,
    /// Whether only this path can find the light it meets.
    sharp: bool,
}

/// Light that waits for its shadow ray.
#[derive(Clone, Copy, Debug)]
struct Waiting {
    start: u32,
    light: Vec3A,
    ray: Ray,
}

impl Integrate for Path<'_> {
    fn trace(&self, tracer: &mut Tracer<'_>, starts: &[Start], seen: &mut Vec<Seen>) {
        seen.clear();
        seen.resize(starts.len(), Seen::NOTHING);
        let fresh = |(i, start): (usize, &Start)| Walk {
            start: i as u32,
            share: Vec3A::ONE,
            from: start.ray.origin(),
            density: 0.0,
            sharp: true,
        };
        let mut walks: Vec<Walk> = starts.iter().enumerate().map(fresh).collect();
        let mut rays: Vec<Ray> = starts.iter().map(|start| start.ray).collect();
        let mut hits = Vec::new();
        // One more than surfaces are shaded: the last ray only looks for light.
        for depth in 1..=self.max_depth + 1 {
            tracer.closest_solid(&mut rays, &mut hits, |i, tries, alpha| {
                passes_by_chance(&starts[walks[i].start as usize], depth, tries, alpha)
            });
            let mut waiting = Vec::new();
            let mut next = (Vec::new(), Vec::new());
            for ((walk, ray), hit) in walks.iter().zip(&rays).zip(&hits) {
                let seen = &mut seen[walk.start as usize];
                let start = &starts[walk.start as usize];
                let Some(met) = self.meet(tracer, depth, walk, start, ray, hit, seen) else {
                    continue;
                };
                waiting.extend(self.light(&met, depth, walk, start, ray, hit));
                if let Some((walk, ray)) = scatter(&met, depth, walk, start, ray, hit) {
                    next.0.push(walk);
                    next.1.push(ray);
                }
            }
            settle(tracer, waiting, seen);
            (walks, rays) = next;
            if walks.is_empty() {
                return;
            }
        }
    }
}

impl Path<'_> {
    /// Takes the light a path finds where it arrives; the surface, if it is to be shaded.
    #[expect(clippy::too_many_arguments, reason = "everything about one path")]
    fn meet(
        &self,
        tracer: &Tracer<'_>,
        depth: u32,
        walk: &Walk,
        start: &Start,
        ray: &Ray,
        hit: &Hit,
        seen: &mut Seen,
    ) -> Option<Met> {
        let scene = tracer.scene();
        let dir = ray.dir().normalize();
        if !hit.is_some() {
            let light = background::radiance(scene, dir);
            let light = walk.share * light * self.weight(walk, self.lights.density_of_sky(dir));
            seen.color += self.limited(light, depth - 1);
            return None;
        }
        let point = tracer.point(ray, hit);
        let look = Look::at(scene, &point);
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
        if depth > self.max_depth {
            return None;
        }
        let [.., part] = start.sampler.four(Set::Light(depth));
        Some(Met::new(point, &look, -dir, part))
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
        depth: u32,
        walk: &Walk,
        start: &Start,
        ray: &Ray,
        hit: &Hit,
    ) -> Option<Waiting> {
        if met.bsdf.is_sharp() {
            return None;
        }
        let [u, v, w, _] = start.sampler.four(Set::Light(depth));
        let at = met.point.surface.position;
        let towards = self.lights.sample(at, ray.time(), [u, v, w])?;
        let to_light = met.frame.local(towards.dir);
        // A light must be on the same side of the true surface and of the smooth one.
        if met.normal.dot(towards.dir) * to_light.z <= 0.0 {
            return None;
        }
        let (value, density) = met.bsdf.evaluate(met.to_eye, to_light);
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
        let origin = met.point.surface.leave(towards.dir);
        let shadow = match towards.end {
            Some(end) => Ray::new(origin, end - origin, towards.kind).between(0.0, BEFORE),
            None => Ray::new(origin, towards.dir, towards.kind),
        };
        let ray = shadow.at_time(ray.time()).leaving(source(hit));
        Some(Waiting { start: walk.start, light: self.limited(light, depth), ray })
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
    depth: u32,
    walk: &Walk,
    start: &Start,
    ray: &Ray,
    hit: &Hit,
) -> Option<(Walk, Ray)> {
    let [which, u, v, stay] = start.sampler.four(Set::Scatter(depth));
    let scatter = met.bsdf.sample(met.to_eye, [which, u, v])?;
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
    let surface = &met.point.surface;
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

/// Casts the shadow rays, light by light, and adds what arrives.
fn settle(tracer: &mut Tracer<'_>, mut waiting: Vec<Waiting>, seen: &mut [Seen]) {
    waiting.sort_by_key(|waiting| waiting.ray.kind());
    let rays: Vec<Ray> = waiting.iter().map(|waiting| waiting.ray).collect();
    let mut passing = Vec::new();
    tracer.passing(&rays, &mut passing);
    for (waiting, passing) in waiting.iter().zip(passing) {
        seen[waiting.start as usize].color += waiting.light * passing;
    }
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
