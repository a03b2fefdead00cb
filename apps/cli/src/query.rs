//! `nestray query`.

mod npy;

use std::path::Path;

use nestray::batch;
use nestray::core::hit::Hit;
use nestray::core::object::DynObject;
use nestray::core::ray::{Ray, RayKind};
use nestray::glam::Vec3A;
use nestray::io::load::{LoadOptions, bytes_of};
use nestray::plan::build::build;
use nestray::render::watch::Watch as _;
use serde_json::json;

use crate::args::{QueryArgs, Talk};
use crate::errors::Failure;
use crate::input;
use crate::output;
use crate::progress::{Progress, rate};
use crate::stats::Stats;
use crate::stop;

use self::npy::Rays;

/// Rays between two looks at whether to stop.
const BLOCK: usize = 1 << 18;

pub(crate) fn run(args: &QueryArgs, talk: &Talk) -> Result<(), Failure> {
    let (progress, mut stats) = (Progress::new(talk), Stats::new());
    output::check(&args.output)?;
    if let Some(path) = &args.stats {
        output::check(path)?;
    }
    let choice = input::choose(&args.plan)?;
    let rays = stats.stage("rays", || read(&args.rays))?;
    let pool = input::pool(args.threads)?;
    let scene =
        stats.stage("load", || input::scene(&args.scene, &LoadOptions::default(), &progress))?;
    stats.set_scene(&scene);
    stop::check()?;
    // Nothing moves but what the shutter sees: rays are asked at its opening.
    let scene = scene.frame(0.0, 0.0);
    let plan = choice.plan(&scene)?;
    stats.set("plan", json!({ "name": args.plan, "hash": plan.hash() }));
    let world = stats.stage("build", || {
        pool.install(|| build(&plan, &scene)).map_err(|error| choice.failure(&error))
    })?;
    stop::check()?;
    let (bytes, done) =
        stats.stage("query", || pool.install(|| answer(args, &rays, &world, progress)));
    stats.stage("write", || output::write(&args.output, &bytes))?;
    let seconds = stats.seconds("query");
    stats.set("rays", json!({ "cast": done }));
    stats.set("rays_per_second", done as f64 / seconds.max(1e-9));
    stats.set("complete", done == rays.count());
    stats.write(args.stats.as_deref())?;
    if done < rays.count() {
        let message = format!("the first {done} of {} rays were answered", rays.count());
        return Err(stop::interrupted(message));
    }
    if args.output != Path::new("-") {
        let (file, rate) = (args.output.display(), rate(done as u64, seconds));
        progress.note(&format!("{file}: {done} rays, {seconds:.2} s, {rate}"));
    }
    Ok(())
}

/// The rays of a file, or of standard input.
fn read(path: &Path) -> Result<Rays, Failure> {
    let unreadable = |message: String| {
        Failure::new(Failure::UNREADABLE, format!("{}: {message}", path.display()))
    };
    let bytes = if path == Path::new("-") {
        let mut bytes = Vec::new();
        std::io::Read::read_to_end(&mut std::io::stdin().lock(), &mut bytes)
            .map_err(|error| unreadable(error.to_string()))?;
        bytes
    } else {
        bytes_of(path, &LoadOptions { max_bytes: 1 << 36, ..LoadOptions::default() })?
    };
    npy::rays(bytes).map_err(unreadable)
}

/// The answers as a file, and how many rays they are for: all, unless it is interrupted.
fn answer(
    args: &QueryArgs,
    rays: &Rays,
    world: &DynObject,
    progress: Progress,
) -> (Vec<u8>, usize) {
    let watching = progress.watch("query");
    let kind = if args.any { RayKind::Shadow { light: 0 } } else { RayKind::Camera };
    let (mut data, mut done, mut records) = (Vec::new(), 0, 0);
    while done < rays.count() && !stop::asked() {
        let end = rays.count().min(done + BLOCK);
        let block: Vec<Ray> = (done..end).map(|i| ray(rays.numbers(i), kind)).collect();
        if args.any {
            data.extend(batch::any_hits(world, &block).into_iter().map(u8::from));
            records += block.len();
        } else if args.all {
            for (i, hits) in (done as u64..).zip(batch::all_hits(world, &block)) {
                records += hits.len();
                for hit in &hits {
                    data.extend(i.to_le_bytes());
                    push(&mut data, hit);
                }
            }
        } else {
            batch::closest_hits(world, &block).iter().for_each(|hit| push(&mut data, hit));
            records += block.len();
        }
        done = end;
        watching.advanced(done as u64, rays.count() as u64, done as u64);
    }
    const HIT: &str = "('t', '<f4'), ('u', '<f4'), ('v', '<f4'), \
        ('geometry', '<u4'), ('primitive', '<u4'), ('instance', '<u4')";
    let kind = match (args.any, args.all) {
        (true, _) => "'|b1'".into(),
        (_, true) => format!("[('ray', '<u8'), {HIT}]"),
        _ => format!("[{HIT}]"),
    };
    (npy::file(&kind, records, &data), done)
}

/// A ray from 6 or 8 numbers; what is no ray hits nothing.
fn ray(numbers: &[f64], kind: RayKind) -> Ray {
    let vector = |from: usize| {
        Vec3A::new(numbers[from] as f32, numbers[from + 1] as f32, numbers[from + 2] as f32)
    };
    let ray = Ray::new(vector(0), vector(3), kind);
    match numbers.get(6..8) {
        Some(range) => ray.between(range[0] as f32, range[1] as f32),
        None => ray,
    }
}

fn push(data: &mut Vec<u8>, hit: &Hit) {
    let is = hit.is_some();
    let number = |number: u32| if is { number } else { u32::MAX }.to_le_bytes();
    for x in [if is { hit.t } else { f32::INFINITY }, hit.u, hit.v] {
        data.extend(x.to_le_bytes());
    }
    data.extend(number(hit.geometry));
    data.extend(number(hit.primitive));
    data.extend(number(hit.path.number()));
}
