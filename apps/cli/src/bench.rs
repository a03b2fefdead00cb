//! `nestray bench`: plans against each other on one scene.

mod contest;
pub(crate) mod rays;
mod sets;
mod versus;

use std::fmt::Write as _;
use std::time::Instant;

use nestray::core::cost::CostModel;
use nestray::io::load::LoadOptions;
use nestray::plan::build::build;
use nestray::plan::describe::bytes;
use nestray::plan::single::single;
use nestray::prelude::{DynObject, Object as _, Scene};
use nestray::registry;
use nestray::render::watch::Watch as _;
use serde_json::{Value, json};

use self::contest::Taken;
use self::rays::RaySet;
use crate::args::{BenchArgs, Talk};
use crate::errors::Failure;
use crate::progress::Progress;
use crate::{input, output, stats, stop};

/// Most rays of each kind.
const RAYS: usize = 65_536;

/// A plan and what was built from it.
struct Contender {
    name: String,
    world: DynObject,
    seconds: f64,
    bytes: u64,
}

pub(crate) fn run(args: &BenchArgs, talk: &Talk) -> Result<(), Failure> {
    if !args.vs.is_empty() {
        return versus::run(args, talk);
    }
    let progress = Progress::new(talk);
    let scene = input::scene(&args.scene, &LoadOptions::default(), &progress)?;
    let contenders = contenders(args, &scene, progress)?;
    // The first plan may be a slow one.
    let sets = rays::sets(&scene, &alone("auto", &scene)?, args.rays.unwrap_or(RAYS), 1)?;
    let mut report = Report::new(&contenders);
    let watching = progress.watch("bench");
    let worlds: Vec<DynObject> = contenders.iter().map(|c| c.world.clone()).collect();
    let oracle = if args.verify { Some(alone("list", &scene)?) } else { None };
    for (i, set) in (0..).zip(&sets) {
        watching.advanced(i, sets.len() as u64, 0);
        let taken = contest::run(&worlds, set, args.rounds)?;
        report.add(set, &contenders, &taken);
        if let Some(oracle) = &oracle {
            report.verify(set, &contenders, oracle, &scene)?;
        }
    }
    drop(watching);
    if args.json {
        output::say(&format!("{:#}\n", report.json))?;
    } else {
        output::say(&report.text)?;
    }
    if report.differences > 0 {
        let message = format!("{} answers differ", report.differences);
        return Err(Failure::new(Failure::DIFFERENT, message));
    }
    Ok(())
}

/// Builds every plan.
fn contenders(
    args: &BenchArgs,
    scene: &Scene,
    progress: Progress,
) -> Result<Vec<Contender>, Failure> {
    let all: Vec<String> = registry::names().map(Into::into).collect();
    let names = if args.plans.is_empty() { &all } else { &args.plans };
    let mut contenders = Vec::new();
    for name in names {
        stop::check()?;
        let choice = input::choose(name)?;
        let begun = Instant::now();
        let built = choice
            .plan(scene)
            .and_then(|plan| build(&plan, scene).map_err(|error| choice.failure(&error)));
        match built {
            Ok(world) => {
                let seconds = begun.elapsed().as_secs_f64();
                let bytes = world.cost(CostModel::usual()).bytes;
                contenders.push(Contender { name: name.clone(), world, seconds, bytes });
            }
            // A technique that cannot serve this scene was not asked for by name.
            Err(failure) if args.plans.is_empty() => progress.note(&format!("{name}: {failure}")),
            Err(failure) => return Err(failure),
        }
    }
    Ok(contenders)
}

/// One technique over everything.
fn alone(technique: &str, scene: &Scene) -> Result<DynObject, Failure> {
    let failure = |error| input::plan_failure(&error, None);
    let plan = single(technique, Default::default(), scene).map_err(failure)?;
    build(&plan, scene).map_err(failure)
}

/// What is said in the end.
struct Report {
    text: String,
    json: Value,
    differences: usize,
}

impl Report {
    fn new(contenders: &[Contender]) -> Self {
        let mut text = format!("one thread, {}\n\n", stats::level());
        let _ = writeln!(text, "{:<24} {:>10} {:>12}", "plan", "build s", "memory");
        for contender in contenders {
            let Contender { name, seconds, bytes: size, .. } = contender;
            let _ = writeln!(text, "{name:<24} {seconds:>10.3} {:>12}", bytes(*size));
        }
        let plans: Vec<Value> = contenders
            .iter()
            .map(|c| json!({ "plan": c.name, "build_seconds": c.seconds, "bytes": c.bytes }))
            .collect();
        let json = json!({ "vector_level": stats::level(), "plans": plans, "rays": [] });
        Self { text, json, differences: 0 }
    }

    /// Times and counts of one kind of rays; answers against those of the fastest plan.
    fn add(&mut self, set: &RaySet, contenders: &[Contender], taken: &[Taken]) {
        let query = if set.any { "any hit" } else { "closest hit" };
        let _ = writeln!(self.text, "\n{} rays, {query}: {}", set.name, set.rays.len());
        let _ = writeln!(
            self.text,
            "{:<24} {:>10} {:>10} {:>10} {:>10} {:>10}",
            "plan", "Mray/s", "single", "steps/ray", "tests/ray", "differ"
        );
        let mut rows = Vec::new();
        for (contender, one) in contenders.iter().zip(taken) {
            let other = one.differ;
            self.differences += other;
            let few = if one.rays < set.rays.len() {
                format!("  ({} of them)", one.rays)
            } else {
                String::new()
            };
            let (batch, alone) = (1e3 / one.batch, 1e3 / one.single);
            let Taken { steps, tests, late, bytes: more, .. } = one;
            let late_too = if *late > 0.05 || *more > 0 {
                format!("  built late: {late:.2} s, {}", bytes(*more))
            } else {
                String::new()
            };
            let name = &contender.name;
            let _ = writeln!(
                self.text,
                "{name:<24} {batch:>10.4} {alone:>10.4} {steps:>10.2} {tests:>10.2} {other:>10}{few}{late_too}"
            );
            rows.push(json!({ "plan": name, "rays": one.rays, "batch_mrays_per_second": batch,
                "single_mrays_per_second": alone, "steps_per_ray": steps,
                "tests_per_ray": tests, "answers_that_differ": other,
                "late_seconds": late, "late_bytes": more }));
        }
        let rays = json!({ "kind": set.name, "query": query, "rays": set.rays.len(), "of": rows });
        if let Some(all) = self.json["rays"].as_array_mut() {
            all.push(rays);
        }
    }

    /// Answers against exhaustive search, for as many rays as that can bear.
    fn verify(
        &mut self,
        set: &RaySet,
        contenders: &[Contender],
        oracle: &DynObject,
        scene: &Scene,
    ) -> Result<(), Failure> {
        /// Tests of primitives in all.
        const TESTS: u64 = 500_000_000;
        let most = (TESTS / scene.primitives().max(1)).clamp(1, 1 << 20) as usize;
        // Spread over all of them.
        let step = set.rays.len().div_ceil(most).max(1);
        let rays: Vec<_> = set.rays.iter().copied().step_by(step).collect();
        let expected = contest::single(oracle, &rays, set.any);
        let _ = writeln!(self.text, "verified against exhaustive search: {} rays", rays.len());
        for contender in contenders.iter().filter(|contender| contender.name != "list") {
            stop::check()?;
            let batch = contest::batch(&contender.world, &rays, set.any);
            let single = contest::single(&contender.world, &rays, set.any);
            let differ = expected.differences(&batch) + expected.differences(&single);
            if differ > 0 {
                let _ = writeln!(self.text, "  {}: {differ} answers differ", contender.name);
            }
            self.differences += differ;
        }
        Ok(())
    }
}
