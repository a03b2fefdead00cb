//! Mirrors, glass and lights without a surface, as a tree of rays [Whitted 80].
//!
//! A tree is followed level by level, for many pixels at once: all rays of a level, then the
//! shadow rays of what they hit, light by light, then the next level.

mod coefficients;

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::surface::Surface;

use super::{Integrate, note};
use crate::background;
use crate::directions::{mirrored, refracted};
use crate::eye::{Seen, Start};
use crate::light_sampling::{bare, shadow};
use crate::look::{self, Look};
use crate::options::Tree;
use crate::tracer::{Tracer, onward, source};

use self::coefficients::Coefficients;

/// See [`Integrator::Whitted`](crate::options::Integrator).
pub(crate) struct Whitted {
    pub(crate) tree: Tree,
    pub(crate) max_depth: u32,
}

/// Rays that count for less of a pixel are not followed.
const CUT_OFF: f32 = 1.0 / 512.0;
/// Shadow rays end this part before the light.
const BEFORE: f32 = 1.0 - 1e-5;
/// Most surfaces that a ray shines through on its way to the next level.
const MOST_PASSES: usize = 1024;

/// A ray of a tree.
#[derive(Clone, Copy, Debug)]
struct Branch {
    /// Which of the starts.
    start: u32,
    /// What it counts for.
    share: Vec3A,
    ray: Ray,
}

/// A surface to be lit.
struct Met {
    start: u32,
    share: Vec3A,
    ray: Ray,
    hit: Hit,
    surface: Surface,
    /// Unit, on the side of the eye.
    normal: Vec3A,
    to_eye: Vec3A,
    front: bool,
    coefficients: Coefficients,
}

impl Integrate for Whitted {
    fn trace(&self, tracer: &mut Tracer<'_>, starts: &[Start], seen: &mut Vec<Seen>) {
        seen.clear();
        seen.resize(starts.len(), Seen::NOTHING);
        let root = |(i, start): (usize, &Start)| Branch {
            start: i as u32,
            share: Vec3A::ONE,
            ray: start.ray,
        };
        let mut branches: Vec<Branch> = starts.iter().enumerate().map(root).collect();
        for depth in 1..=self.max_depth {
            let mut next = Vec::new();
            for _ in 0..MOST_PASSES {
                let (met, passed) = self.meet(tracer, depth, &branches, starts, seen);
                self.light(tracer, &met, seen);
                if depth < self.max_depth {
                    met.iter().for_each(|met| self.branch(met, &mut next));
                }
                branches = passed;
                if branches.is_empty() {
                    break;
                }
            }
            branches = next;
            if branches.is_empty() {
                return;
            }
        }
    }

    /// A full tree doubles with every level.
    fn starts(&self, wave: usize) -> usize {
        (wave >> self.max_depth.saturating_sub(6).min(16)).max(1)
    }
}

impl Whitted {
    /// What the rays hit, and the rays that go on behind what is not all there.
    fn meet(
        &self,
        tracer: &mut Tracer<'_>,
        depth: u32,
        branches: &[Branch],
        starts: &[Start],
        seen: &mut [Seen],
    ) -> (Vec<Met>, Vec<Branch>) {
        let rays: Vec<Ray> = branches.iter().map(|branch| branch.ray).collect();
        let mut hits = Vec::new();
        tracer.closest(&rays, &mut hits);
        let scene = tracer.scene();
        let (mut all, mut passed) = (Vec::new(), Vec::new());
        for (branch, hit) in branches.iter().zip(&hits) {
            let seen = &mut seen[branch.start as usize];
            let ray = &branch.ray;
            if !hit.is_some() {
                seen.color += branch.share * background::radiance(scene, ray.dir().normalize());
                continue;
            }
            let point = tracer.point(ray, hit);
            let alpha = look::opacity(scene, &point);
            if alpha < 1.0 {
                let (ray, share) = (onward(ray, hit, &point.surface), branch.share * (1.0 - alpha));
                passed.push(Branch { share, ray, ..*branch });
            }
            if alpha == 0.0 {
                continue;
            }
            let look = Look::at(scene, &point);
            if depth == 1 && seen.geometry < 0.0 {
                note(seen, &starts[branch.start as usize], ray, hit, &point, &look);
            }
            let met = Met::new(tracer, branch, hit, &point.surface, &look, alpha);
            let ambient = met.coefficients.diffuse * Vec3A::from(scene.ambient);
            seen.color += met.share * (look.emission + ambient);
            all.push(met);
        }
        (all, passed)
    }

    /// Adds the light of every light that is not in shadow, light by light.
    fn light(&self, tracer: &mut Tracer<'_>, all: &[Met], seen: &mut [Seen]) {
        for (number, light) in tracer.scene().lights.iter().enumerate() {
            let (mut rays, mut waiting) = (Vec::new(), Vec::new());
            for met in all {
                let Some(arriving) = bare::arriving(light, met.surface.position) else { continue };
                if met.normal.dot(arriving.dir) <= 0.0 {
                    continue;
                }
                let share = met.share * met.lit(arriving.dir);
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
                rays.push(ray.at_time(met.ray.time()).leaving(source(&met.hit)));
                waiting.push((met.start, share * arriving.brightness));
            }
            let mut passing = Vec::new();
            tracer.passing(&rays, &mut passing);
            for ((start, light), passing) in waiting.into_iter().zip(passing) {
                seen[start as usize].color += light * passing;
            }
        }
    }

    /// Reflected and refracted rays.
    fn branch(&self, met: &Met, next: &mut Vec<Branch>) {
        let Coefficients { mut mirror, through, ior, .. } = met.coefficients;
        let clear = through.max_element() > 0.0;
        let eta = if met.front { ior } else { 1.0 / ior };
        let behind = if clear { refracted(met.to_eye, met.normal, eta) } else { None };
        if clear && behind.is_none() {
            // All is mirrored that would have passed.
            mirror += through;
        }
        let mut grow = |share: Vec3A, dir: Vec3A, kind: RayKind| {
            let share = met.share * share;
            if self.tree == Tree::Full || share.max_element() >= CUT_OFF {
                let ray = Ray::new(met.surface.leave(dir), dir, kind)
                    .at_time(met.ray.time())
                    .leaving(source(&met.hit));
                next.push(Branch { start: met.start, share, ray });
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
        tracer: &Tracer<'_>,
        branch: &Branch,
        hit: &Hit,
        surface: &Surface,
        look: &Look,
        alpha: f32,
    ) -> Self {
        let to_eye = -branch.ray.dir().normalize();
        let front = surface.normal.dot(to_eye) >= 0.0;
        let side = if front { 1.0 } else { -1.0 };
        let mut normal = look.normal * side;
        if normal.dot(to_eye) <= 0.0 {
            normal = surface.normal * side;
        }
        let whitted = tracer.scene().materials[look.material].whitted;
        Self {
            start: branch.start,
            share: branch.share * alpha,
            ray: branch.ray,
            hit: *hit,
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
