//! Timing the plans that a search ends with: what is fastest then is taken.

use std::time::Instant;

use nestray_core::cost::CostModel;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object as _};
use nestray_core::scratch::Scratch;
use nestray_scene::scene::Scene;

use super::archive::composed;
use super::ray_log::{RayLog, RaySet};
use super::score::Score;
use super::{Observer, Options};
use crate::build::build;
use crate::check::check;
use crate::error::PlanError;
use crate::plan::{Node, Plan};

/// A plan to be timed.
#[derive(Clone, Debug)]
pub struct Finalist {
    /// What it is called in reports.
    pub name: String,
    /// The plan.
    pub plan: Plan,
    /// What it is expected to cost; none if it was put together of others.
    pub predicted: Option<Score>,
    /// Whether it is one technique over everything.
    pub is_single: bool,
}

/// A plan that was timed.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Which.
    pub finalist: Finalist,
    /// Median nanoseconds per ray of each set, in batches on one thread.
    pub nanos: Vec<f64>,
    /// What a ray of the mix took.
    pub mix: f64,
    /// The same, and what building took spread over the rays that are expected.
    pub total: f64,
    /// Building it, and what was built when the first rays came.
    pub build_seconds: f64,
    /// Memory after all rays were shot.
    pub bytes: u64,
    /// How often it was timed: once, if it was far from the best.
    pub rounds: usize,
}

/// Rays of each set that are timed in a turn.
const RAYS: usize = 32_768;
/// Rays of each set that tell what is far from the best.
const FIRST: usize = 512;
/// So many times as slow as the best is far from it, at first and after a full turn.
const FAR: f64 = 3.0;
const STILL_FAR: f64 = 1.4;
/// How much faster a nest must be than something simpler.
const SIMPLER: f64 = 1.02;

/// One that is still in the race.
struct Runner {
    world: DynObject,
    measured: Measured,
    /// Seconds of each round, for each set.
    times: Vec<Vec<f64>>,
}

/// What is fastest so far.
struct Best {
    mix: f64,
    nanos: Vec<f64>,
}

impl Best {
    fn note(&mut self, measured: &Measured) {
        self.mix = self.mix.min(measured.mix);
        for (best, &nanos) in self.nanos.iter_mut().zip(&measured.nanos) {
            *best = best.min(nanos);
        }
    }

    /// Whether something is more than `times` as slow for the mix, and the best for no kind of rays.
    fn is_far(&self, mix: f64, nanos: &[f64], times: f64) -> bool {
        mix > times * self.mix && nanos.iter().zip(&self.nanos).all(|(nanos, best)| nanos > best)
    }
}

/// Builds and times all, in turns; those far from the best only once.
///
/// # Errors
/// If one cannot be built.
pub(super) fn race(
    scene: &Scene,
    finalists: Vec<Finalist>,
    log: &RayLog,
    options: &Options,
    observer: &dyn Observer,
) -> Result<Vec<Measured>, PlanError> {
    let logs = [log.thinned(FIRST), log.thinned(RAYS)];
    let (mut runners, mut out) = (Vec::<Runner>::new(), Vec::new());
    let mut best = Best { mix: f64::INFINITY, nanos: vec![f64::INFINITY; log.sets.len()] };
    for finalist in finalists {
        // What was put together of others may not go together.
        if finalist.predicted.is_none() && check(&finalist.plan, scene).is_err() {
            continue;
        }
        let runner = enter(scene, finalist, &logs, options, &best)?;
        best.note(&runner.measured);
        runners.push(runner);
        let is_far = |runner: &mut Runner| {
            let Measured { mix, nanos, .. } = &runner.measured;
            best.is_far(*mix, nanos, STILL_FAR)
        };
        out.extend(runners.extract_if(.., is_far).map(|runner| runner.measured));
        if observer.stop() {
            break;
        }
    }
    run(&mut runners, &logs[1], options, observer);
    if let Some(finalist) = joined(&runners, log)
        && check(&finalist.plan, scene).is_ok()
        && !observer.stop()
    {
        // Against what is best so far, in turns with it.
        let runner = enter(scene, finalist, &logs, options, &best)?;
        let fastest = (0..runners.len())
            .min_by(|&a, &b| runners[a].measured.total.total_cmp(&runners[b].measured.total));
        let mut last = vec![runner];
        last.extend(fastest.map(|fastest| runners.swap_remove(fastest)));
        run(&mut last, &logs[1], options, observer);
        runners.extend(last);
    }
    out.extend(runners.into_iter().map(|runner| runner.measured));
    Ok(out)
}

/// Builds one and lets it shoot for the first time.
fn enter(
    scene: &Scene,
    finalist: Finalist,
    [first, all]: &[RayLog; 2],
    options: &Options,
    best: &Best,
) -> Result<Runner, PlanError> {
    let begun = Instant::now();
    let world = build(&finalist.plan, scene)?;
    let mut build_seconds = begun.elapsed().as_secs_f64();
    let (mut nanos, late) = warm(&world, first);
    build_seconds += late;
    if !best.is_far(mixed(&nanos, first), &nanos, FAR) {
        let (more, late) = warm(&world, all);
        (nanos, build_seconds) = (more, build_seconds + late);
    }
    let mix = mixed(&nanos, first);
    let total = mix + build_seconds * 1e9 / options.rays_expected.max(1.0);
    let bytes = world.cost(&CostModel::usual().clone()).bytes;
    let times = vec![Vec::new(); all.sets.len()];
    let measured = Measured { finalist, nanos, mix, total, build_seconds, bytes, rounds: 1 };
    Ok(Runner { world, measured, times })
}

/// Nanoseconds per ray of each set the second time, and seconds that the first time took longer:
/// what is built when rays come.
fn warm(world: &DynObject, log: &RayLog) -> (Vec<f64>, f64) {
    let mut late = 0.0;
    let nanos = log.sets.iter().map(|set| {
        let (first, second) = (shoot(world, set), shoot(world, set));
        late += (first - second).max(0.0);
        per_ray(second, set)
    });
    (nanos.collect(), late)
}

/// Lets all shoot, in turns.
fn run(runners: &mut [Runner], log: &RayLog, options: &Options, observer: &dyn Observer) {
    for _ in 0..options.rounds {
        if observer.stop() {
            break;
        }
        for runner in runners.iter_mut() {
            for (set, times) in log.sets.iter().zip(&mut runner.times) {
                times.push(per_ray(shoot(&runner.world, set), set));
            }
        }
    }
    for Runner { measured, times, .. } in runners {
        let rounds = times.first().map_or(0, Vec::len);
        if rounds > 0 {
            measured.nanos = times.iter_mut().map(|times| median(times)).collect();
            measured.mix = mixed(&measured.nanos, log);
            measured.total =
                measured.mix + measured.build_seconds * 1e9 / options.rays_expected.max(1.0);
            measured.rounds = rounds;
        }
    }
}

/// For each kind of rays what was fastest for those, if that is not the same for all.
fn joined(runners: &[Runner], log: &RayLog) -> Option<Finalist> {
    let fastest = |set: usize| {
        let nanos = |runner: &Runner| runner.measured.nanos[set];
        runners.iter().min_by(|a, b| nanos(a).total_cmp(&nanos(b)))
    };
    let plans: Vec<&Plan> = (0..log.sets.len())
        .map(|set| fastest(set).map(|runner| &runner.measured.finalist.plan))
        .collect::<Option<_>>()?;
    // What is made for some kinds already cannot stand in it.
    if plans.iter().any(|plan| matches!(plan.root, Node::ByKind(_))) {
        return None;
    }
    let plan = composed(log, &plans)?;
    Some(Finalist { name: "by kind, as timed".into(), plan, predicted: None, is_single: false })
}

/// The number of the fastest, or of something simpler that is hardly slower.
pub(super) fn choose(all: &[Measured]) -> usize {
    let best = all.iter().map(|one| one.total).fold(f64::INFINITY, f64::min);
    let good = (0..all.len()).filter(|&i| all[i].total <= best * SIMPLER);
    let order = |&i: &usize| (!all[i].finalist.is_single, nodes(&all[i].finalist.plan));
    let chosen =
        good.min_by(|a, b| order(a).cmp(&order(b)).then(all[*a].total.total_cmp(&all[*b].total)));
    chosen.expect("at least one was timed")
}

/// How many nodes a plan has.
fn nodes(plan: &Plan) -> usize {
    fn count(node: &Node) -> usize {
        let mut nodes = 1;
        node.visit_children(|_, child| nodes += count(child));
        nodes
    }
    count(&plan.root) + plan.shared.values().map(count).sum::<usize>()
}

fn per_ray(seconds: f64, set: &RaySet) -> f64 {
    seconds * 1e9 / set.rays.len().max(1) as f64
}

fn mixed(nanos: &[f64], log: &RayLog) -> f64 {
    nanos.iter().zip(&log.sets).map(|(nanos, set)| nanos * set.weight).sum()
}

/// Seconds that the rays of a set take, in batches.
fn shoot(world: &DynObject, set: &RaySet) -> f64 {
    /// Rays in a batch.
    const BATCH: usize = 4096;
    let mut scratch = Scratch::new();
    let mut hits: Vec<Hit> = Vec::new();
    let mut blocked = Vec::new();
    let begun = Instant::now();
    for rays in set.rays.chunks(BATCH) {
        if set.any {
            blocked.clear();
            blocked.resize(rays.len(), false);
            world.any_hits(rays, &mut blocked, &mut scratch);
        } else {
            hits.clear();
            hits.extend(rays.iter().map(|ray| Hit::none(ray.t_max())));
            world.closest_hits(rays, &mut hits, &mut scratch);
        }
    }
    begun.elapsed().as_secs_f64()
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::INFINITY)
}
