//! Every technique over the same rays.

use std::fmt::Write as _;
use std::time::{Duration, Instant};

use nestray::batch::closest_hits;
use nestray::plan::build::build;
use nestray::plan::single::single;
use nestray::prelude::{DynObject, Hit, Ray, RayKind, Scene, Surfaces};
use nestray::registry;
use nestray::render::watch::Watch as _;

use crate::bench::rays::to_light;
use crate::errors::Failure;
use crate::progress::{Progress, rate};
use crate::stop;

/// How long one technique may take to shoot.
const TIME: Duration = Duration::from_millis(800);

/// Rays from the eye across and down; each that hits sends one to the first light.
const EYE: [u32; 2] = [320, 180];

/// Rays between two looks at the clock: few at first, for the slow.
const FIRST: usize = 256;

/// Shoots the same rays with every technique alone; a table of times.
pub(super) fn run(scene: &Scene, auto: &DynObject, progress: Progress) -> Result<String, Failure> {
    let rays = rays(scene, auto)?;
    let expected = closest_hits(auto, &rays);
    let mut text = String::new();
    let _ = writeln!(text, "\nEach technique alone, on the same {} rays", rays.len());
    let watching = progress.watch("compare");
    for (i, name) in (0..).zip(registry::names()) {
        stop::check()?;
        watching.advanced(i, registry::names().count() as u64, 0);
        let Ok(plan) = single(name, Default::default(), scene) else { continue };
        let begun = Instant::now();
        let world = match build(&plan, scene) {
            Ok(world) => world,
            Err(error) => {
                let _ = writeln!(text, "  {name:<20} {error}");
                continue;
            }
        };
        let built = begun.elapsed().as_secs_f64();
        let (hits, seconds) = shoot(&world, &rays);
        let agrees = hits.iter().zip(&expected).all(|(a, b)| a == b);
        let nanos = seconds * 1e9 / hits.len() as f64;
        let remark = match (agrees, hits.len() < rays.len()) {
            (false, _) => "  DIFFERS",
            (true, true) => "  (on the first of them)",
            (true, false) => "",
        };
        let rate = rate(hits.len() as u64, seconds);
        let _ = writeln!(
            text,
            "  {name:<20} built in {built:>6.2} s, {nanos:>9.0} ns a ray, {rate:>14}{remark}"
        );
    }
    Ok(text)
}

/// Answers as many of the rays as there is time for, and how long that took.
fn shoot(world: &DynObject, rays: &[Ray]) -> (Vec<Hit>, f64) {
    let (begun, mut hits, mut count) = (Instant::now(), Vec::new(), FIRST);
    while hits.len() < rays.len() && begun.elapsed() < TIME {
        let end = rays.len().min(hits.len() + count);
        let block = closest_hits(world, &rays[hits.len()..end]);
        hits.extend(block);
        count *= 2;
    }
    (hits, begun.elapsed().as_secs_f64())
}

/// Rays from the eye, and from what they see to the first light, in turns.
fn rays(scene: &Scene, world: &DynObject) -> Result<Vec<Ray>, Failure> {
    let surfaces = Surfaces::new(scene).map_err(|e| Failure::new(Failure::FAILED, e))?;
    let [width, height] = EYE;
    let Some(camera) = scene.cameras.first() else { return Ok(Vec::new()) };
    let view = camera.view(width as f32 / height as f32);
    let eye: Vec<Ray> = (0..width * height)
        .map(|i| {
            // A step that visits every pixel, far apart from the last: no two neighbours meet.
            let at = i * 8191 % (width * height);
            let (origin, dir) = view.through([at % width, at / width], EYE);
            Ray::new(origin, dir, RayKind::Camera)
        })
        .collect();
    let hits = closest_hits(world, &eye);
    let mut rays = Vec::with_capacity(2 * eye.len());
    for (ray, hit) in eye.iter().zip(&hits) {
        rays.push(*ray);
        if let (true, Some(light)) = (hit.is_some(), scene.lights.first()) {
            rays.push(to_light(&surfaces.at(ray, hit).surface, 0, light));
        }
    }
    Ok(rays)
}
