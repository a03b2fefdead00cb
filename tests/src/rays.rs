//! Rays that ask hard questions.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::aim::{Aims, Emitter};
use nestray_core::hit::{Hit, InstancePath};
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind, Source};
use nestray_core::scratch::Scratch;

use crate::numbers::Numbers;

/// Rays at a world within `bounds`, some aimed exactly at points of `aims` (vertices, edge
/// points, corners of boxes). The same for the same seed.
#[must_use]
pub fn hard(seed: u64, bounds: Aabb, aims: &[Vec3A], count: usize) -> Vec<Ray> {
    let mut numbers = Numbers::new(seed);
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count {
        let first = ray(&mut numbers, bounds, aims);
        if numbers.once_in(100) {
            rays.extend(neighbours(&mut numbers, &first, bounds, aims));
        } else {
            rays.push(first);
        }
    }
    rays.truncate(count);
    rays
}

/// Rays as through neighbouring pixels: from one point or from a lens, a little apart, some
/// of them at points exactly, some along an axis. Among them are rays with limits of their own,
/// that have left a surface, or that are none.
fn neighbours(numbers: &mut Numbers, first: &Ray, bounds: Aabb, aims: &[Vec3A]) -> Vec<Ray> {
    let apart =
        *numbers.pick(&[0.0, 1e-4, 1e-3, 0.01, 0.03, 0.15]) * first.dir().abs().max_element();
    let lens = *numbers.pick(&[0.0, 0.0, 1e-3]) * bounds.size().max_element();
    let mut rays = Vec::new();
    let mixed = numbers.once_in(3);
    for _ in 0..4 + numbers.below(124) {
        let origin = first.origin() + (numbers.point() - 0.5) * lens;
        let mut dir = first.dir() + (numbers.point() - 0.5) * apart;
        if !aims.is_empty() && numbers.once_in(3) {
            // The nearest direction of a few that meets a point exactly.
            let off = |aim: Vec3A| (aim - origin).normalize_or_zero().dot(dir.normalize_or_zero());
            let tries: Vec<Vec3A> = (0..8).map(|_| *numbers.pick(aims)).collect();
            let best = tries.into_iter().max_by(|a, b| off(*a).total_cmp(&off(*b)));
            dir = best.map_or(dir, |aim| (aim - origin) * (dir.length() / (aim - origin).length()));
        }
        if numbers.once_in(40) {
            dir[numbers.below(3)] = 0.0;
        }
        let ray = Ray::new(origin, dir, first.kind()).at_time(first.time());
        let ray = ray.between(first.t_min(), first.t_max());
        rays.push(match numbers.below(40) {
            0 if mixed => ray.between(numbers.between(0.0, 2.0), numbers.between(0.0, 2.0)),
            1 if mixed => ray.between(f32::NAN, 1.0),
            2..6 if mixed => {
                let (geometry, primitive) = (numbers.below(12) as u32, numbers.below(200) as u32);
                ray.leaving(Source { geometry, primitive, path: InstancePath::NONE })
            }
            _ => ray,
        });
    }
    rays
}

/// The rays that follow: from where each of `first` hits `world`, along the surface, away from
/// it as reflected and refracted light goes, and past it from outside.
#[must_use]
pub fn following(seed: u64, world: &dyn Object, first: &[Ray]) -> Vec<Ray> {
    let mut numbers = Numbers::new(seed);
    let mut scratch = Scratch::new();
    let mut next = |ray: &Ray| {
        let mut hit = Hit::none(ray.t_max());
        world.closest_hit(ray, &mut hit, &mut scratch);
        let surface = hit.is_some().then(|| world.surface(ray, &hit))??;
        let along = surface.normal.cross(numbers.direction());
        let source = Source { geometry: hit.geometry, primitive: hit.primitive, path: hit.path };
        let dir = match numbers.below(3) {
            0 => along,
            1 => numbers.direction(),
            // Past the point, from outside or from within.
            _ => return Some(Ray::new(surface.position - along, along, ray.kind())),
        };
        let left = Ray::new(surface.leave(dir), dir, ray.kind());
        Some(if numbers.once_in(3) { left } else { left.leaving(source) })
    };
    first.iter().filter_map(|ray| Some(next(ray)?.at_time(ray.time()))).collect()
}

fn ray(numbers: &mut Numbers, bounds: Aabb, aims: &[Vec3A]) -> Ray {
    let origin = origin(numbers, bounds, aims);
    let dir = direction(numbers, bounds, aims, origin);
    let kind = *numbers.pick(&[
        RayKind::Camera,
        RayKind::Shadow { light: 0 },
        RayKind::Shadow { light: 3 },
        RayKind::Reflect,
        RayKind::Refract,
        RayKind::Diffuse,
        RayKind::Custom(7),
    ]);
    let ray = Ray::new(origin, dir, kind).at_time(numbers.unit());
    match numbers.below(8) {
        0 => ray.between(numbers.between(0.0, 0.5), numbers.between(0.3, 1.5)),
        1 => ray.between(0.0, numbers.between(0.0, 2.0)),
        _ => ray,
    }
}

/// Outside, inside, far away, on a point, in a plane.
fn origin(numbers: &mut Numbers, bounds: Aabb, aims: &[Vec3A]) -> Vec3A {
    let size = bounds.size();
    let inside = bounds.min + numbers.point() * size;
    let around = bounds.min + (numbers.point() * 3.0 - 1.0) * size;
    match numbers.below(16) {
        0..4 => inside,
        4 if !aims.is_empty() => *numbers.pick(aims),
        5 => {
            // In the plane of a face.
            let mut origin = around;
            let axis = numbers.below(3);
            origin[axis] = if numbers.once_in(2) { bounds.min[axis] } else { bounds.max[axis] };
            origin
        }
        6 if !aims.is_empty() => {
            // In a plane with a point.
            let mut origin = around;
            let axis = numbers.below(3);
            origin[axis] = numbers.pick(aims)[axis];
            origin
        }
        7 => {
            let far = *numbers.pick(&[10.0, 100.0, 1e4, 1e6]);
            bounds.center() + numbers.direction() * (size.max_element() * far)
        }
        _ => around,
    }
}

/// At a point, along an axis with either zero, or anywhere; of any length.
fn direction(numbers: &mut Numbers, bounds: Aabb, aims: &[Vec3A], origin: Vec3A) -> Vec3A {
    let dir = match numbers.below(8) {
        0 | 1 => {
            let mut dir = Vec3A::ZERO;
            for axis in 0..3 {
                dir[axis] = if numbers.once_in(2) { 0.0 } else { -0.0 };
            }
            dir[numbers.below(3)] = if numbers.once_in(2) { 1.0 } else { -1.0 };
            dir
        }
        2 => {
            let mut dir = numbers.direction();
            dir[numbers.below(3)] = if numbers.once_in(2) { 0.0 } else { -0.0 };
            dir
        }
        3 | 4 if !aims.is_empty() => *numbers.pick(aims) - origin,
        5 | 6 => bounds.min + numbers.point() * bounds.size() - origin,
        _ => numbers.direction(),
    };
    let length = *numbers.pick(&[1.0, 1.0, 1.0, 0.01, 700.0]);
    dir * length
}

/// Lights and eyes inside and around `bounds`, for techniques that ask where they are.
#[must_use]
pub fn lamps(bounds: Aabb) -> Aims {
    let bounds =
        if bounds.is_bounded() { bounds } else { Aabb { min: Vec3A::ZERO, max: Vec3A::ONE } };
    let (middle, size) = (bounds.center(), bounds.size());
    let lamp = Aabb { min: middle + size * 0.7, max: middle + size * 0.8 };
    let emitters = vec![
        Emitter::Point(middle.into()),
        Emitter::Box { min: lamp.min.into(), max: lamp.max.into() },
        Emitter::Direction([0.5, 2.0, -1.0]),
    ];
    Aims { lights: emitters.clone(), eyes: emitters }
}

/// Shadow rays from where `rays` start to each light, and rays of eyes back again.
#[must_use]
pub fn lit(seed: u64, lamps: &Aims, rays: &[Ray]) -> Vec<Ray> {
    let mut numbers = Numbers::new(seed ^ 0x11917);
    let mut out = Vec::new();
    for ray in rays {
        for (light, lamp) in (0..).zip(&lamps.lights) {
            let from = ray.at(2.0 * numbers.point().x);
            let (dir, end) = match *lamp {
                Emitter::Point(at) => (Vec3A::from_array(at) - from, 1.0),
                Emitter::Box { min, max } => {
                    let (min, max) = (Vec3A::from_array(min), Vec3A::from_array(max));
                    (min + (max - min) * numbers.point() - from, 1.0)
                }
                Emitter::Direction(toward) => (toward.into(), f32::INFINITY),
            };
            let kind = RayKind::Shadow { light };
            out.push(Ray::new(from, dir, kind).between(0.0, end).at_time(ray.time()));
            out.push(Ray::new(from + dir, -dir, RayKind::Camera).at_time(ray.time()));
        }
    }
    out
}
