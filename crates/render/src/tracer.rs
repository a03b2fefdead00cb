//! One thread's rays: batches to the world, and what they pass through on the way.

use std::mem;

use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, Source};
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;
use nestray_scene::material::AlphaMode;
use nestray_scene::scene::Scene;
use nestray_scene::surfaces::{Point, Surfaces};

use crate::look;
use crate::ray_counts::RayCounts;

/// A surface more transparent than any number of others in front of it may hide.
const MOST_PASSES: u32 = 1024;

/// What a thread traces with.
pub(crate) struct Tracer<'a> {
    world: &'a dyn Object,
    surfaces: &'a Surfaces<'a>,
    pub(crate) scratch: Scratch,
    pub(crate) counts: RayCounts,
    /// Most rays in a batch.
    wave: usize,
    /// Whether any surface may let rays pass as if it were not there.
    see_through: bool,
    /// Room for answers.
    blocked: Vec<bool>,
}

impl<'a> Tracer<'a> {
    pub(crate) fn new(
        world: &'a dyn Object,
        surfaces: &'a Surfaces<'a>,
        scratch: Scratch,
        wave: usize,
    ) -> Self {
        let materials = &surfaces.scene().materials;
        let see_through = materials.iter().any(|m| m.alpha_mode != AlphaMode::Opaque);
        let (counts, blocked) = (RayCounts::default(), Vec::new());
        Self { world, surfaces, scratch, counts, wave, see_through, blocked }
    }

    pub(crate) fn scene(&self) -> &'a Scene {
        self.surfaces.scene()
    }

    /// What `ray` sees at `hit`.
    pub(crate) fn point(&self, ray: &Ray, hit: &Hit) -> Point {
        self.surfaces.at(ray, hit)
    }

    /// To be called for each of `hits` in turn, before [`point`](Self::point): brings near what
    /// that will read of it and of those after it.
    pub(crate) fn touch(&self, hits: &[Hit], turn: usize) {
        /// Few enough for what they read to fit next to everything else.
        const AHEAD: usize = 32;
        if turn.is_multiple_of(AHEAD) {
            self.surfaces.touch(&hits[turn..hits.len().min(turn + AHEAD)]);
        }
    }

    /// The nearest hit of each ray.
    pub(crate) fn closest(&mut self, rays: &[Ray], hits: &mut Vec<Hit>) {
        hits.clear();
        hits.extend(rays.iter().map(|ray| Hit::none(ray.t_max())));
        self.ask(rays, hits, <dyn Object>::closest_hit, <dyn Object>::closest_hits);
        for (ray, hit) in rays.iter().zip(hits) {
            self.counts.one(ray.kind(), hit.is_some());
        }
    }

    /// The nearest hit of each ray that does not pass: `passes` is asked with the number of
    /// the ray, how often it passed, and the opacity. Rays that passed go on from there.
    pub(crate) fn closest_solid(
        &mut self,
        rays: &mut [Ray],
        hits: &mut Vec<Hit>,
        mut passes: impl FnMut(usize, u32, f32) -> bool,
    ) {
        self.closest(rays, hits);
        if !self.see_through {
            return;
        }
        let mut which: Vec<usize> = (0..rays.len()).collect();
        let mut found = hits.clone();
        for tries in 0..MOST_PASSES {
            let (mut next, mut again) = (Vec::new(), Vec::new());
            for (&i, hit) in which.iter().zip(&found) {
                hits[i] = *hit;
                let Some((point, alpha)) = self.opacity(&rays[i], hit) else { continue };
                if passes(i, tries, alpha) {
                    rays[i] = onward(&rays[i], hit, &point.surface);
                    next.push(i);
                    again.push(rays[i]);
                }
            }
            if next.is_empty() {
                return;
            }
            which = next;
            self.closest(&again, &mut found);
        }
        for (&i, hit) in which.iter().zip(&found) {
            hits[i] = *hit;
        }
    }

    /// How much gets through to the end of each ray, from 0 to 1.
    pub(crate) fn passing(&mut self, rays: &[Ray], passing: &mut Vec<f32>) {
        let mut blocked = mem::take(&mut self.blocked);
        blocked.clear();
        blocked.resize(rays.len(), false);
        let one = |world: &dyn Object, ray: &Ray, blocked: &mut bool, scratch: &mut Scratch| {
            *blocked = world.any_hit(ray, scratch);
            *blocked
        };
        self.ask(rays, &mut blocked, one, <dyn Object>::any_hits);
        for (ray, &blocked) in rays.iter().zip(&blocked) {
            self.counts.one(ray.kind(), blocked);
        }
        passing.clear();
        passing.extend(blocked.iter().map(|&blocked| if blocked { 0.0 } else { 1.0 }));
        if self.see_through {
            self.look_through(rays, &blocked, passing);
        }
        self.blocked = blocked;
    }

    /// Asks the world about rays, one at a time or so many together.
    fn ask<T>(
        &mut self,
        rays: &[Ray],
        answers: &mut [T],
        one: impl Fn(&'a dyn Object, &Ray, &mut T, &mut Scratch) -> bool,
        many: impl Fn(&'a dyn Object, &[Ray], &mut [T], &mut Scratch),
    ) {
        if self.wave == 1 {
            for (ray, answer) in rays.iter().zip(answers) {
                one(self.world, ray, answer, &mut self.scratch);
            }
        } else {
            for (rays, answers) in rays.chunks(self.wave).zip(answers.chunks_mut(self.wave)) {
                many(self.world, rays, answers, &mut self.scratch);
            }
        }
    }

    /// Follows the blocked rays from surface to surface.
    fn look_through(&mut self, rays: &[Ray], blocked: &[bool], passing: &mut [f32]) {
        let mut which: Vec<usize> = (0..rays.len()).filter(|&i| blocked[i]).collect();
        let mut left: Vec<(Ray, f32)> = which.iter().map(|&i| (rays[i], 1.0)).collect();
        let mut hits = Vec::new();
        for _ in 0..MOST_PASSES {
            let current: Vec<Ray> = left.iter().map(|(ray, _)| *ray).collect();
            self.closest(&current, &mut hits);
            let (mut next, mut rest) = (Vec::new(), Vec::new());
            for ((&i, hit), (ray, part)) in which.iter().zip(&hits).zip(&left) {
                if !hit.is_some() {
                    passing[i] = *part;
                    continue;
                }
                let Some((point, alpha)) = self.opacity(ray, hit) else { continue };
                let part = part * (1.0 - alpha);
                if part > 0.0 {
                    next.push(i);
                    rest.push((onward(ray, hit, &point.surface), part));
                }
            }
            if next.is_empty() {
                return;
            }
            (which, left) = (next, rest);
        }
    }

    /// How much of a surface is there; none if all of it always is.
    pub(crate) fn opacity(&self, ray: &Ray, hit: &Hit) -> Option<(Point, f32)> {
        if !hit.is_some() {
            return None;
        }
        let scene = self.scene();
        let material = &scene.materials[scene.geometries[hit.geometry as usize].material];
        if material.alpha_mode == AlphaMode::Opaque {
            return None;
        }
        let point = self.point(ray, hit);
        let alpha = look::opacity(scene, &point);
        Some((point, alpha))
    }
}

/// The rest of a ray behind a surface. `t` keeps counting in multiples of the direction.
pub(crate) fn onward(ray: &Ray, hit: &Hit, surface: &Surface) -> Ray {
    Ray::new(surface.leave(ray.dir()), ray.dir(), ray.kind())
        .between(0.0, ray.t_max() - hit.t)
        .at_time(ray.time())
        .leaving(source(hit))
}

/// The primitive that was hit, to be left.
pub(crate) fn source(hit: &Hit) -> Source {
    Source { geometry: hit.geometry, primitive: hit.primitive, path: hit.path }
}
