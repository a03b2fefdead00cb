//! Hits: where they are, what they look like, and that all three queries tell the same.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_shapes::shape::{Crossing, Shape, Sides, Single};

use crate::numbers::Numbers;
use crate::reference::{off, walk};
use crate::samples::{Sample, near, samples};

/// All crossings of a line.
pub(crate) fn crossings(shape: &impl Shape, ray: &Ray) -> Vec<Crossing> {
    let mut found = Vec::new();
    shape.crossings(ray, |crossing| found.push(crossing));
    found
}

/// Calls `check` with crossings of many random shapes.
pub(crate) fn each_crossing(rounds: u64, mut check: impl FnMut(u64, &Sample, &Ray, &Crossing)) {
    let mut kinds = std::collections::BTreeMap::new();
    for seed in 0..rounds {
        for sample in samples(seed) {
            let mut numbers = Numbers(seed ^ 0x5eed);
            for _ in 0..40 {
                let ray = numbers.ray_near(sample.center, sample.size);
                for crossing in crossings(&sample.shape, &ray) {
                    *kinds.entry(sample.shape.kind()).or_insert(0) += 1;
                    check(seed, &sample, &ray, &crossing);
                }
            }
        }
    }
    assert!(kinds.len() >= 9 && kinds.values().all(|&n| n > rounds), "hardly any hits: {kinds:?}");
}

/// How far apart two `f32` coordinates at a place may be.
pub(crate) fn grain(sample: &Sample) -> f64 {
    (sample.center.abs().max_element() + 2.0 * sample.size) * f64::from(f32::EPSILON)
}

#[test]
fn a_hit_lies_within_the_bounds_and_survives_pruning() {
    each_crossing(400, |seed, sample, ray, crossing| {
        let bounds = sample.shape.bounds().padded();
        if !bounds.is_bounded() {
            return;
        }
        let position = sample.shape.surface(ray, crossing).position;
        assert!(bounds.contains(&Aabb { min: position, max: position }), "seed {seed} {sample:?}");
        if crossing.t < 0.0 {
            return;
        }
        let clip = Clip::new(ray, bounds.reach());
        let (enter, leave) = clip.cut(&bounds, f32::INFINITY).unwrap_or((f32::NAN, f32::NAN));
        assert!(enter <= crossing.t && crossing.t <= leave, "seed {seed} {sample:?} {ray:?}");
    });
}

#[test]
fn a_hit_lies_on_the_surface() {
    each_crossing(400, |seed, sample, ray, crossing| {
        let position = sample.shape.surface(ray, crossing).position.as_dvec3();
        let Some(off) = off(&sample.shape, position) else { return };
        // A plane is hit far away as well.
        let grain = grain(sample).max(position.abs().max_element() * f64::from(f32::EPSILON));
        assert!(off <= 2.0 * grain, "seed {seed} {sample:?} {ray:?}: {off} > {grain}");
        // And it is where the ray is, as far as `t` can tell.
        let t = f64::from(crossing.t);
        let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
        let step = (dir * t).length() * f64::from(f32::EPSILON);
        let apart = (origin + dir * t - position).length();
        assert!(apart <= 2.0 * (grain + step), "seed {seed} {sample:?}: {apart}");
    });
}

#[test]
fn a_walk_along_the_line_finds_the_same_hits() {
    let (mut told, mut hit) = (0, 0);
    for seed in 0..60 {
        for sample in near(seed).into_iter().chain(samples(seed)) {
            let mut numbers = Numbers(seed ^ 0xa1c);
            for _ in 0..20 {
                let ray = numbers.ray_near(sample.center, sample.size);
                let walked = walk(&sample.shape, &ray, sample.center, sample.size);
                let Some(expected) = walked else { continue };
                let mut found: Vec<f32> =
                    crossings(&sample.shape, &ray).iter().map(|c| c.t).collect();
                found.sort_by(f32::total_cmp);
                assert_eq!(found.len(), expected.len(), "seed {seed} {sample:?} {ray:?}");
                let length = ray.dir().as_dvec3().length();
                for (a, b) in found.iter().zip(&expected) {
                    // A hit at a slant moves far for a little error of the corners.
                    let room = b.abs() * 2e-7 + 50.0 * grain(&sample) / length;
                    assert!((f64::from(*a) - b).abs() <= room, "seed {seed} {sample:?} {a} {b}");
                }
                told += 1;
                hit += usize::from(!found.is_empty());
            }
        }
    }
    assert!(told > 10_000 && hit > 3_000, "the walk told {told}, hit {hit}");
}

#[test]
fn normals_are_unit_and_tell_the_side() {
    each_crossing(400, |seed, sample, ray, crossing| {
        let surface = sample.shape.surface(ray, crossing);
        let unit = |v: Vec3A| (v.as_dvec3().length() - 1.0).abs() < 1e-6;
        assert!(unit(surface.normal) && unit(surface.shading), "seed {seed} {sample:?}");
        let tangent = surface.tangent.as_dvec3();
        assert!(tangent == DVec3::ZERO || unit(surface.tangent), "seed {seed} {sample:?}");
        assert!(tangent.dot(surface.normal.as_dvec3()).abs() < 1e-5, "seed {seed} {sample:?}");
        assert!(surface.error.cmpge(Vec3A::ZERO).all() && surface.error.is_finite());
        assert!(surface.uv.iter().all(|x| x.is_finite()), "seed {seed} {sample:?}");
        let slope = surface.normal.as_dvec3().dot(ray.dir().as_dvec3().normalize());
        if slope.abs() > 1e-5 {
            assert_eq!(crossing.front, slope < 0.0, "seed {seed} {sample:?} {ray:?}");
        }
    });
}

/// Rays that lie in faces, along edges and axes, or just miss.
fn awkward(numbers: &mut Numbers, sample: &Sample) -> Ray {
    let (bounds, size) = (sample.shape.bounds(), sample.size as f32);
    let center = sample.center.as_vec3a();
    let corner = |numbers: &mut Numbers| match bounds.is_bounded() {
        true => bounds.corner(numbers.below(8) as u32),
        false => center,
    };
    let zero = [0.0, -0.0][numbers.below(2)];
    let mut dir = Vec3A::splat(zero);
    dir[numbers.below(3)] = [1.0, -1.0][numbers.below(2)];
    if numbers.below(3) == 0 {
        dir[numbers.below(3)] = numbers.between(-1.0, 1.0) as f32;
    }
    let through = match numbers.below(3) {
        0 => corner(numbers),
        1 => center,
        _ => {
            // On a coordinate of a corner, elsewhere on the others.
            let mut through = center + (numbers.cube() * sample.size).as_vec3a();
            let axis = numbers.below(3);
            through[axis] = corner(numbers)[axis];
            through
        }
    };
    let origin = if numbers.below(2) == 0 { through } else { through - dir * (3.0 * size) };
    Ray::new(origin, dir, RayKind::Camera)
}

#[test]
fn all_queries_tell_the_same_also_in_a_face_or_along_an_edge() {
    for seed in 0..400 {
        for sample in samples(seed).into_iter().chain(near(seed)) {
            let mut numbers = Numbers(seed ^ 0xfac3);
            for i in 0..30 {
                let ray = match i % 3 {
                    0 => numbers.ray_near(sample.center, sample.size),
                    _ => awkward(&mut numbers, &sample),
                };
                let limit = match i % 2 {
                    0 => f32::INFINITY,
                    _ => (numbers.between(0.0, 6.0) * sample.size) as f32,
                };
                let ray = ray.between(0.0, limit);
                for sides in [Sides::Both, Sides::Front, Sides::Back] {
                    let single = Single { sides, ..Single::new(7, sample.shape.clone()) };
                    agree(&single, &ray, &format!("seed {seed} {sample:?} {ray:?} {sides:?}"));
                }
            }
        }
    }
}

fn agree(object: &impl Object, ray: &Ray, what: &str) {
    let mut scratch = Scratch::default();
    let mut closest = Hit::none(ray.t_max());
    let found = object.closest_hit(ray, &mut closest, &mut scratch);
    let mut all = Vec::new();
    object.all_hits(ray, &mut all, &mut scratch);
    assert_eq!(found, closest.is_some(), "{what}");
    assert_eq!(found, object.any_hit(ray, &mut scratch), "{what}");
    assert_eq!(found, !all.is_empty(), "{what}");
    assert!(all.iter().all(|hit| hit.t >= ray.t_min() && hit.t <= ray.t_max()), "{what}");
    if found {
        let nearest = all.iter().map(|hit| hit.t).fold(f32::INFINITY, f32::min);
        assert_eq!(nearest, closest.t, "{what}");
        let surface = object.surface(ray, &closest).expect("the hit is of it");
        assert!(surface.position.is_finite() && surface.normal.is_finite(), "{what}");
    }
}

#[test]
fn pictures_lie_as_tangents_say() {
    let mut told = std::collections::BTreeMap::<&str, [u32; 2]>::new();
    each_crossing(400, |_, sample, ray, crossing| {
        let surface = sample.shape.surface(ray, crossing);
        if surface.tangent == Vec3A::ZERO || surface.shading != surface.normal {
            return;
        }
        let step = 1e-3 * sample.size as f32;
        let up = surface.normal.cross(surface.tangent);
        let up = if surface.mirrored { -up } else { up };
        // What lies a little further, seen straight down.
        let beside = |along: Vec3A| {
            let from = surface.position + along * step + surface.normal * (2.0 * step);
            let down = Ray::new(from, -surface.normal, RayKind::Camera).between(0.0, 4.0 * step);
            let found = crossings(&sample.shape, &down);
            let found = found.first().map(|crossing| sample.shape.surface(&down, crossing))?;
            // Not of the next face of a mountain.
            (found.normal.dot(surface.normal) > 0.99).then_some(found.uv)
        };
        let (Some(right), Some(above)) = (beside(surface.tangent), beside(up)) else { return };
        let (across, down) = (right[0] - surface.uv[0], above[1] - surface.uv[1]);
        // Not over a seam, nor where a hit is told badly.
        if !(1e-5..0.4).contains(&across.abs()) || !(1e-5..0.4).contains(&down.abs()) {
            return;
        }
        let count = told.entry(sample.shape.kind()).or_default();
        count[usize::from(across > 0.0 && down < 0.0)] += 1;
    });
    for (kind, [wrong, right]) in told {
        // At edges, poles and steep slopes the neighbour may be of another face.
        assert!(wrong * 6 <= right, "{kind}: {wrong} wrong, {right} right");
    }
}
