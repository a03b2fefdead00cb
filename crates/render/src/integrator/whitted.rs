//! Mirrors, glass and lights without a surface, as a tree of rays [Whitted 80].
//!
//! A tree is followed level by level, for many pixels at once: all rays of a level, then the
//! shadow rays of what they hit, light by light, then the next level.

mod branches;
mod coefficients;

use std::mem;

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::ray::{Ray, RayKind, Source};
use nestray_core::surface::Surface;
use nestray_scene::scene::Scene;

use super::{Integrate, note};
use crate::background;
use crate::directions::{mirrored, refracted};
use crate::eye::{Seen, Start};
use crate::light_sampling::{bare, shadow};
use crate::look::{self, Look};
use crate::options::Tree;
use crate::tracer::{Tracer, onward, source};

use self::branches::{Branch, Branches, Shadows};
use self::coefficients::Coefficients;

/// See [`Integrator::Whitted`](crate::options::Integrator).
pub(crate) struct Whitted {
    tree: Tree,
    max_depth: u32,
    room: Room,
}

/// Room for the trees of a wave, kept from wave to wave.
#[derive(Debug, Default)]
struct Room {
    branches: Branches,
    hits: Vec<Hit>,
    /// What they hit.
    met: Vec<Met>,
    /// Rays that go on behind what is not all there.
    passed: Branches,
    /// Those of the next level.
    next: Branches,
    shadows: Shadows,
}

/// Rays that count for less of a pixel are not followed.
const CUT_OFF: f32 = 1.0 / 512.0;
/// Shadow rays end this part before the light.
const BEFORE: f32 = 1.0 - 1e-5;
/// Most surfaces that a ray shines through on its way to the next level.
const MOST_PASSES: usize = 1024;

/// A surface to be lit.
#[derive(Debug)]
struct Met {
    branch: Branch,
    time: f32,
    source: Source,
    surface: Surface,
    /// Unit, on the side of the eye.
    normal: Vec3A,
    to_eye: Vec3A,
    front: bool,
    coefficients: Coefficients,
}

impl Integrate for Whitted {
    fn trace(&mut self, tracer: &mut Tracer<'_>, starts: &[Start], seen: &mut Vec<Seen>) {
        seen.clear();
        seen.resize(starts.len(), Seen::NOTHING);
        let mut room = mem::take(&mut self.room);
        room.branches.clear();
        for (i, start) in starts.iter().enumerate() {
            room.branches.push(Branch { start: i as u32, share: Vec3A::ONE }, start.ray);
        }
        for depth in 1..=self.max_depth {
            for _ in 0..MOST_PASSES {
                self.meet(tracer, depth, &mut room, starts, seen);
                self.light(tracer, &room.met, &mut room.shadows, seen);
                if depth < self.max_depth {
                    room.met.iter().for_each(|met| self.branch(met, &mut room.next));
                }
                mem::swap(&mut room.branches, &mut room.passed);
                if room.branches.rays.is_empty() {
                    break;
                }
            }
            mem::swap(&mut room.branches, &mut room.next);
            room.next.clear();
            if room.branches.rays.is_empty() {
                break;
            }
        }
        self.room = room;
    }

    /// A full tree doubles with every level.
    fn starts(&self, wave: usize) -> usize {
        (wave >> self.max_depth.saturating_sub(6).min(16)).max(1)
    }
}

impl Whitted {
    pub(crate) fn new(tree: Tree, max_depth: u32) -> Self {
        Self { tree, max_depth, room: Room::default() }
    }

    /// What the rays hit, and the rays that go on behind what is not all there.
    fn meet(
        &self,
        tracer: &mut Tracer<'_>,
        depth: u32,
        room: &mut Room,
        starts: &[Start],
        seen: &mut [Seen],
    ) {
        let Room { branches: Branches { branches, rays }, hits, met, passed, .. } = room;
        tracer.closest(rays, hits);
        met.clear();
        passed.clear();
        let scene = tracer.scene();
        for (i, ((branch, ray), hit)) in branches.iter().zip(&*rays).zip(&*hits).enumerate() {
            tracer.touch(hits, i);
            let seen = &mut seen[branch.start as usize];
            if !hit.is_some() {
                seen.color += branch.share * background::radiance(scene, ray.dir().normalize());
                continue;
            }
            let point = tracer.point(ray, hit);
            let alpha = look::opacity(scene, &point);
            if alpha < 1.0 {
                let share = branch.share * (1.0 - alpha);
                passed.push(Branch { share, ..*branch }, onward(ray, hit, &point.surface));
            }
            if alpha == 0.0 {
                continue;
            }
            let look = Look::at(scene, &point);
            if depth == 1 && seen.geometry < 0.0 {
                note(seen, &starts[branch.start as usize], ray, hit, &point, &look);
            }
            let branch = Branch { share: branch.share * alpha, ..*branch };
            let new = Met::new(scene, branch, ray, hit, &point.surface, &look);
            let ambient = new.coefficients.diffuse * Vec3A::from(scene.ambient);
            seen.color += branch.share * (look.emission + ambient);
            met.push(new);
        }
    }

    /// Adds the light of every light that is not in shadow, light by light.
    fn light(
        &self,
        tracer: &mut Tracer<'_>,
        all: &[Met],
        shadows: &mut Shadows,
        seen: &mut [Seen],
    ) {
        let Shadows { waiting, rays, passing } = shadows;
        for (number, light) in tracer.scene().lights.iter().enumerate() {
            waiting.clear();
            rays.clear();
            for met in all {
                let Some(arriving) = bare::arriving(light, met.surface.position) else { continue };
                if met.normal.dot(arriving.dir) <= 0.0 {
                    continue;
                }
                let Branch { start, share } = met.branch;
                let share = share * met.lit(arriving.dir);
                if self.tree == Tree::Pruned && share.max_element() <= 0.0 {
                    continue;
                }
                let origin = met.surface.leave(arriving.dir);
                let ray = match arriving.end {
                    Some(end) => {
                        Ray::new(origin, end - origin, shadow(number)).between(0.0, BEFORE)
                    }
                    None => Ray::new(origin, arriving.dir, shadow(number)),
                };
                rays.push(ray.at_time(met.time).leaving(met.source));
                waiting.push(Branch { start, share: share * arriving.brightness });
            }
            tracer.passing(rays, passing);
            for (light, passing) in waiting.iter().zip(&*passing) {
                seen[light.start as usize].color += light.share * *passing;
            }
        }
    }

    /// Reflected and refracted rays.
    fn branch(&self, met: &Met, next: &mut Branches) {
        let Coefficients { mut mirror, through, ior, .. } = met.coefficients;
        let clear = through.max_element() > 0.0;
        let eta = if met.front { ior } else { 1.0 / ior };
        let behind = if clear { refracted(met.to_eye, met.normal, eta) } else { None };
        if clear && behind.is_none() {
            // All is mirrored that would have passed.
            mirror += through;
        }
        let mut grow = |share: Vec3A, dir: Vec3A, kind: RayKind| {
            let share = met.branch.share * share;
            if self.tree == Tree::Full || share.max_element() >= CUT_OFF {
                let ray = Ray::new(met.surface.leave(dir), dir, kind)
                    .at_time(met.time)
                    .leaving(met.source);
                next.push(Branch { share, ..met.branch }, ray);
            }
        };
        if clear || mirror.max_element() > 0.0 {
            grow(mirror, mirrored(met.to_eye, met.normal), RayKind::Reflect);
        }
        if let Some(dir) = behind {
            grow(through, dir, RayKind::Refract);
        }
    }
}

impl Met {
    fn new(
        scene: &Scene,
        branch: Branch,
        ray: &Ray,
        hit: &Hit,
        surface: &Surface,
        look: &Look,
    ) -> Self {
        let to_eye = -ray.dir().normalize();
        let front = surface.normal.dot(to_eye) >= 0.0;
        let side = if front { 1.0 } else { -1.0 };
        let mut normal = look.normal * side;
        if normal.dot(to_eye) <= 0.0 {
            normal = surface.normal * side;
        }
        let whitted = scene.materials[look.material].whitted;
        Self {
            branch,
            time: ray.time(),
            source: source(hit),
            surface: *surface,
            normal,
            to_eye,
            front,
            coefficients: Coefficients::new(look, whitted, normal.dot(to_eye), front),
        }
    }

    /// How bright a light of brightness 1 in a direction makes it.
    fn lit(&self, dir: Vec3A) -> Vec3A {
        let Coefficients { diffuse, highlight, shine, .. } = self.coefficients;
        let mut lit = diffuse * self.normal.dot(dir);
        if highlight.max_element() > 0.0 {
            let along = mirrored(dir, self.normal).dot(self.to_eye);
            if along > 0.0 {
                lit += highlight * libm::powf(along, shine);
            }
        }
        lit
    }
}

#[cfg(test)]
mod tests;
