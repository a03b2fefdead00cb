//! `nestray optimize`: the plan that is fastest for a scene.

mod html;
pub(crate) mod nest;
pub(crate) mod report;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use nestray::io::load::LoadOptions;
use nestray::plan::build::build;
use nestray::plan::check::check;
use nestray::plan::error::PlanError;
use nestray::plan::optimize::ray_log::{RayLog, RaySet};
use nestray::plan::optimize::{Observer, Optimized, Options, optimize};
use nestray::plan::prices::Prices;
use nestray::plan::single::{AUTO, single};
use nestray::prelude::{DynObject, Scene};
use nestray::render::watch::Watch as _;
use nestray::scene::camera::Camera;

use self::nest::Nest;
use crate::args::{Budget, OptimizeArgs, Talk, Weights};
use crate::bench::rays;
use crate::cache::Cache;
use crate::errors::Failure;
use crate::progress::{Progress, Watching};
use crate::{input, output, stop};

/// Rays of each kind, to search with and to time with.
const RAYS: usize = 65_536;
/// Lights that shadow rays go to, at most.
const LIGHTS: usize = 8;

pub(crate) fn run(args: &OptimizeArgs, talk: &Talk) -> Result<(), Failure> {
    let progress = Progress::new(talk);
    for path in std::iter::once(&args.output).chain(&args.report) {
        output::check(path)?;
    }
    let start = args.start.as_deref().map(input::read_plan).transpose()?;
    let scene = input::scene(&args.scene, &LoadOptions::default(), &progress)?;
    let log = log(&scene, &args.weights, args.rays.unwrap_or(RAYS))?;
    let fits =
        |plan| check(plan, &scene).map_err(|e| input::plan_failure(&e, args.start.as_deref()));
    start.as_ref().map_or(Ok(()), fits)?;
    let (evaluations, time) = match args.budget {
        Budget::Time(time) => (None, Some(time)),
        Budget::Plans(plans) => (Some(plans), None),
    };
    let options = Options {
        techniques: args.techniques.clone(),
        start,
        pins: args.pin.clone(),
        evaluations,
        time,
        seed: args.seed,
        rays_expected: args.rays_expected,
        max_memory: args.max_memory.unwrap_or(u64::MAX),
        rounds: args.rounds,
    };
    let prices = prices(args.prices.as_deref(), progress)?;
    let found = search(&scene, &log, &prices, &options, progress)?;
    output::write(&args.output, found.plan.to_json().as_bytes())?;
    if !args.report.is_empty() {
        let nest = Nest::new(&scene, &found, &log, &prices)?;
        for path in &args.report {
            let is_page =
                path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html"));
            let text = match is_page {
                true => html::page(&args.scene, &found, &log, &options, &nest),
                false => format!("{:#}\n", report::json(&found, &log, &options, &nest)),
            };
            output::write(path, text.as_bytes())?;
        }
    }
    if args.output.as_os_str() != "-" {
        output::say(&report::text(&found, &log))?;
    }
    if stop::asked() { Err(stop::interrupted("the best so far was written")) } else { Ok(()) }
}

/// Most bytes of a file of prices.
const MOST: u64 = 1 << 20;

/// The prices of a file, the usual ones, or those of this machine.
fn prices(from: Option<&Path>, progress: Progress) -> Result<Prices, Failure> {
    let Some(path) = from else { return Ok(Cache::open(true, progress).prices()) };
    if path.as_os_str() == "usual" {
        return Ok(Prices::usual().clone());
    }
    let wrong = |error: &dyn std::fmt::Display| {
        Failure::new(Failure::UNREADABLE, format!("{}: {error}", path.display()))
    };
    let mut text = String::new();
    let file = File::open(path).map_err(|error| wrong(&error))?;
    file.take(MOST).read_to_string(&mut text).map_err(|error| wrong(&error))?;
    let prices: Prices = serde_json::from_str(&text).map_err(|error| wrong(&error))?;
    if prices.are_sound() { Ok(prices) } else { Err(wrong(&"prices are numbers from 0 on")) }
}

/// Searches, and shows how far it is.
pub(crate) fn search(
    scene: &Scene,
    log: &RayLog,
    prices: &Prices,
    options: &Options,
    progress: Progress,
) -> Result<Optimized, Failure> {
    let screen = Screen { watching: progress.watch("optimize"), options };
    optimize(scene, log, prices, options, &screen).map_err(|error| match error {
        PlanError::At { problem, path } if path == "pins" => {
            Failure::usage(format!("--pin: {problem}"))
        }
        error => Failure::usage(error).hint("nestray inspect --list techniques"),
    })
}

/// Rays from the first camera and from what they hit, as heavy as asked for.
pub(crate) fn log(scene: &Scene, weights: &Weights, count: usize) -> Result<RayLog, Failure> {
    let failure = |error| input::plan_failure(&error, None);
    let plan = single(AUTO, Default::default(), scene).map_err(failure)?;
    let world = build(&plan, scene).map_err(failure)?;
    let log = log_from(scene.cameras.first(), scene, &world, weights, count)?;
    if log.sets.is_empty() {
        let failure = Failure::usage("--weights: there are no rays of these kinds");
        return Err(failure.hint("camera=1,shadow=4,reflect=1,diffuse=4,chords=0"));
    }
    Ok(log)
}

/// The same from some camera, with the objects of some plan; empty if no such rays are there.
pub(crate) fn log_from(
    eye: Option<&Camera>,
    scene: &Scene,
    world: &DynObject,
    weights: &Weights,
    count: usize,
) -> Result<RayLog, Failure> {
    let sets = rays::sets_from(eye, scene, world, count, LIGHTS)?;
    Ok(RayLog::new(
        sets.into_iter()
            .map(|set| RaySet {
                name: set.name.into(),
                weight: weights.of(set.name),
                rays: set.rays,
                any: set.any,
            })
            .collect(),
    ))
}

/// Shows how far the search is.
struct Screen<'a> {
    watching: Watching,
    options: &'a Options,
}

impl Observer for Screen<'_> {
    fn tried(&self, evaluations: usize, _best: f64) {
        let total = self.options.evaluations.unwrap_or(0).max(evaluations);
        self.watching.advanced(evaluations as u64, total as u64, 0);
    }

    fn stop(&self) -> bool {
        stop::asked()
    }
}
