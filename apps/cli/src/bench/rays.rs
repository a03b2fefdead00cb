//! The rays of a bench: from the eye, from what those hit, and from everywhere.

use nestray::batch::closest_hits;
use nestray::core::surface::Surface;
use nestray::prelude::{DynObject, Object as _, Ray, RayKind, Scene, Surfaces, Vec3A};
use nestray::scene::camera::Camera;
use nestray::scene::light::{Light, LightKind};

use crate::errors::Failure;

/// Rays of one kind.
pub(crate) struct RaySet {
    pub(crate) name: &'static str,
    pub(crate) rays: Vec<Ray>,
    /// Whether it only matters that something is hit.
    pub(crate) any: bool,
}

/// Sets of at most `count` rays each, from the first camera and what those hit towards each of the
/// first `lights`; those without a ray are left out.
pub(crate) fn sets(
    scene: &Scene,
    world: &DynObject,
    count: usize,
    lights: usize,
) -> Result<Vec<RaySet>, Failure> {
    sets_from(scene.cameras.first(), scene, world, count, lights)
}

/// The same from some camera.
pub(crate) fn sets_from(
    eye: Option<&Camera>,
    scene: &Scene,
    world: &DynObject,
    count: usize,
    lights: usize,
) -> Result<Vec<RaySet>, Failure> {
    let camera = camera(eye, count);
    let mut sets = vec![RaySet { name: "camera", rays: camera, any: false }];
    let lights = &scene.lights[..lights.min(scene.lights.len())];
    sets.extend(bounces(scene, lights, world, &sets[0].rays)?);
    sets.push(RaySet { name: "chords", rays: chords(world, count), any: false });
    sets.retain(|set| !set.rays.is_empty());
    Ok(sets)
}

/// Through the middles of the pixels of a square picture, in the order that pictures are rendered
/// in: first neighbours in twos, then in fours of those, and so on.
fn camera(eye: Option<&Camera>, count: usize) -> Vec<Ray> {
    let Some(camera) = eye else { return Vec::new() };
    let (side, view) = (count.isqrt().max(1) as u32, camera.view(1.0));
    let mut pixels: Vec<[u32; 2]> = (0..side * side).map(|i| [i % side, i / side]).collect();
    pixels.sort_by_cached_key(|&[x, y]| spread_bits(x) | spread_bits(y) << 1);
    let through = |pixel: [u32; 2]| view.through(pixel, [side; 2]);
    pixels
        .into_iter()
        .map(through)
        .map(|(origin, dir)| Ray::new(origin, dir, RayKind::Camera))
        .collect()
}

/// The bits of a number, each with room for another behind it.
fn spread_bits(x: u32) -> u64 {
    (0..32).map(|bit| u64::from(x >> bit & 1) << (2 * bit)).sum()
}

/// From what rays hit: to lights, one light after the other as renderers do, mirrored, and
/// scattered.
fn bounces(
    scene: &Scene,
    lights: &[Light],
    world: &DynObject,
    rays: &[Ray],
) -> Result<[RaySet; 3], Failure> {
    let surfaces = Surfaces::new(scene).map_err(|e| Failure::new(Failure::UNREADABLE, e))?;
    let mut shadow = vec![Vec::new(); lights.len()];
    let (mut mirrored, mut diffuse) = (Vec::new(), Vec::new());
    for (i, (ray, hit)) in rays.iter().zip(&closest_hits(world, rays)).enumerate() {
        if !hit.is_some() {
            continue;
        }
        let at = surfaces.at(ray, hit).surface;
        let normal = if at.normal.dot(ray.dir()) > 0.0 { -at.normal } else { at.normal };
        let to = |dir: Vec3A, kind: RayKind| Ray::new(at.leave(dir), dir, kind);
        for ((number, light), shadow) in (0..).zip(lights).zip(&mut shadow) {
            shadow.push(to_light(&at, number, light));
        }
        let dir = ray.dir().normalize();
        mirrored.push(to(dir - normal * (2.0 * dir.dot(normal)), RayKind::Reflect));
        // A point on the sphere that touches the surface: scattered by Lambert's law.
        diffuse.push(to(normal * 1.0001 + on_sphere(i), RayKind::Diffuse));
    }
    Ok([
        RaySet { name: "shadow", rays: shadow.concat(), any: true },
        RaySet { name: "reflect", rays: mirrored, any: false },
        RaySet { name: "diffuse", rays: diffuse, any: false },
    ])
}

/// From a surface to a light, up to just before it.
pub(crate) fn to_light(at: &Surface, number: u16, light: &Light) -> Ray {
    let kind = RayKind::Shadow { light: number };
    match light.kind {
        LightKind::Directional { direction } => Ray::new(at.leave(-direction), -direction, kind),
        LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
            let from = at.leave(position - at.position);
            Ray::new(from, position - from, kind).between(0.0, 0.999)
        }
    }
}

/// Between points spread over a sphere around everything: random lines, in no order.
fn chords(world: &DynObject, count: usize) -> Vec<Ray> {
    let bounds = world.bounds();
    if bounds.is_empty() || !bounds.is_bounded() {
        return Vec::new();
    }
    let (center, radius) = (bounds.center(), 0.5 * bounds.size().length());
    let point = |i: usize| center + on_sphere(i) * radius;
    (0..count)
        .map(|i| Ray::new(point(2 * i), point(2 * i + 1) - point(2 * i), RayKind::Custom(0)))
        .collect()
}

/// Points that fill the unit sphere evenly, each far from the last.
fn on_sphere(i: usize) -> Vec3A {
    // Steps of irrational length, without a pattern between neighbours.
    let part = |step: f64| ((i as f64 + 0.5) * step).fract();
    let z = (2.0 * part(0.754_877_666_246_692_7) - 1.0) as f32;
    let turn = (std::f64::consts::TAU * part(0.569_840_290_998_053_3)) as f32;
    let across = (1.0 - z * z).max(0.0).sqrt();
    Vec3A::new(across * turn.cos(), across * turn.sin(), z)
}
