//! Timing the plans that a search ends with: what is fastest then is taken.

pub(super) mod choice;
mod joined;
pub(crate) mod shots;

use nestray_core::cost::CostModel;
use nestray_core::object::{DynObject, Object as _};
use nestray_scene::scene::Scene;

use self::joined::joined;
use self::shots::{median, mixed, per_ray, shoot};
use super::Limits;
use super::effort::Efforts;
use super::ray_log::RayLog;
use super::score::Score;
use super::shelf::Shelf;
use crate::build::build;
use crate::check::check;
use crate::error::PlanError;
use crate::plan::Plan;

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
    /// How often it was timed.
    pub rounds: usize,
}

/// Rays of each set that are timed in a turn, at least and at most.
const RAYS: [usize; 2] = [4096, 32_768];
/// So many turns there should be time for.
const ALL_TURNS: f64 = 240.0;
/// Rays of each set that tell what is far from the best.
const FIRST: usize = 512;
/// So many times as slow as the best is far from it, at first and later.
const FAR: f64 = 3.0;
const STILL_FAR: f64 = 1.4;
/// Turns in which something must be far from the best, each time, to be left out: others that want
/// the same processor and memory come and go.
const TURNS: usize = 3;
/// Part of the time that is left for what is put together of the fastest for each kind.
const LAST: f64 = 0.1;
/// How much faster a nest must be than something simpler.
const SIMPLER: f64 = 1.02;

/// One that may start.
struct Built {
    finalist: Finalist,
    world: DynObject,
    build_seconds: f64,
}

/// One that is still in the race.
struct Runner {
    world: DynObject,
    measured: Measured,
    /// Seconds of each round, for each set.
    times: Vec<Vec<f64>>,
}

/// What everything is timed by.
struct Race<'a> {
    scene: &'a Scene,
    limits: &'a Limits<'a>,
    /// What is built already.
    shelf: Shelf,
    /// Few rays, and all that are timed.
    few: RayLog,
    all: RayLog,
}

/// Builds and times all for which there is time, in turns; those far from the best a few times only.
///
/// # Errors
/// If one cannot be built.
pub(super) fn race(
    scene: &Scene,
    finalists: Vec<Finalist>,
    log: &RayLog,
    limits: &Limits<'_>,
    (efforts, shelf): (&Efforts, Shelf),
) -> Result<Vec<Measured>, PlanError> {
    let early = limits.earlier(LAST);
    let (few, all) = (log.thinned(FIRST), log.thinned(RAYS[1]));
    let mut race = Race { scene, limits: &early, shelf, few, all };
    let is_time_for = |finalist: &Finalist, shelf: &Shelf| {
        let is_built = shelf.holds(&finalist.plan);
        let seconds = if is_built { 0.0 } else { efforts.expected(&finalist.plan) };
        !limits.observer.stop() && early.is_time_for(&[seconds])
    };
    let (mut runners, mut out) = (Vec::<Runner>::new(), Vec::new());
    for finalist in finalists {
        if runners.is_empty() || is_time_for(&finalist, &race.shelf) {
            let runner = race.enter(finalist)?;
            if runners.is_empty() {
                race.all = log.thinned(race.rays_of_a_turn(&runner));
            }
            out.extend(race.admit(runner, &mut runners));
        }
    }
    race.run(&mut runners);
    if let Some(joined) = joined(&runners, log)
        && !limits.observer.stop()
        // What was made apart may not go together.
        && check(&joined.finalist.plan, scene).is_ok()
    {
        let race = Race { limits, ..race };
        // Against what is best so far, in turns with it.
        let mut last = vec![race.start(joined)];
        let fastest = (0..runners.len())
            .min_by(|&a, &b| runners[a].measured.total.total_cmp(&runners[b].measured.total));
        last.extend(fastest.map(|fastest| runners.swap_remove(fastest)));
        race.run(&mut last);
        runners.extend(last);
    }
    out.extend(runners.into_iter().map(|runner| runner.measured));
    Ok(out)
}

impl Race<'_> {
    /// Builds one, if it is not yet, and sends it a few rays.
    fn enter(&mut self, finalist: Finalist) -> Result<Runner, PlanError> {
        let begun = self.limits.clock.seconds();
        let (world, build_seconds) = match self.shelf.take(&finalist.plan) {
            Some(built) => built,
            None => {
                let world = build(&finalist.plan, self.scene)?;
                (world, self.limits.clock.seconds() - begun)
            }
        };
        Ok(self.start(Built { finalist, world, build_seconds }))
    }

    /// Sends one a few rays.
    fn start(&self, Built { finalist, world, build_seconds }: Built) -> Runner {
        let bytes = world.cost(&CostModel::usual().clone()).bytes;
        let times = vec![Vec::new(); self.all.sets.len()];
        let (nanos, mix, total) = (Vec::new(), 0.0, 0.0);
        let measured = Measured { finalist, nanos, mix, total, build_seconds, bytes, rounds: 1 };
        let mut runner = Runner { world, measured, times };
        self.warm(&mut runner, &self.few);
        runner
    }

    /// So many rays of each set that there is time for many turns, judged by the first to run.
    fn rays_of_a_turn(&self, first: &Runner) -> usize {
        let one_each: f64 = first.measured.nanos.iter().sum::<f64>() * 1e-9;
        let fit = self.limits.left() / (ALL_TURNS * one_each.max(f64::MIN_POSITIVE));
        // Endless time fits endlessly many.
        (fit as usize).clamp(RAYS[0], RAYS[1])
    }

    /// Lets one run with the others, unless it is far from the best; if it is the best itself,
    /// those stop that are far from it.
    fn admit(&self, mut new: Runner, runners: &mut Vec<Runner>) -> Vec<Measured> {
        let sets = 0..self.all.sets.len();
        let least = |runners: &[Runner]| -> Vec<f64> {
            let nanos = |set: usize| runners.iter().map(move |r| r.measured.nanos[set]);
            sets.clone().map(|set| nanos(set).fold(f64::INFINITY, f64::min)).collect()
        };
        let Some(best) = fastest(runners) else {
            self.warm(&mut new, &self.all);
            runners.push(new);
            return Vec::new();
        };
        let kinds = least(runners);
        if self.is_left_behind([&mut new, &mut runners[best]], &self.few, FAR, &kinds) {
            return vec![new.measured];
        }
        self.warm(&mut new, &self.all);
        if self.is_left_behind([&mut new, &mut runners[best]], &self.all, STILL_FAR, &kinds) {
            return vec![new.measured];
        }
        let kinds = new.measured.nanos.clone();
        let is_far = |other: &mut Runner| {
            other.measured.mix > STILL_FAR * new.measured.mix
                && self.is_left_behind([other, &mut new], &self.all, STILL_FAR, &kinds)
        };
        let out = runners.extract_if(.., is_far).map(|runner| runner.measured).collect();
        runners.push(new);
        out
    }

    /// Whether one is far from another in each of a few turns with it, and as fast as `kinds` for
    /// no kind of rays.
    fn is_left_behind(
        &self,
        [slow, fast]: [&mut Runner; 2],
        log: &RayLog,
        times: f64,
        kinds: &[f64],
    ) -> bool {
        (0..TURNS).all(|_| {
            let [best, nanos] = [&mut *fast, &mut *slow].map(|runner| self.turn(runner, log));
            mixed(&nanos, log) > times * mixed(&best, log)
                && nanos.iter().zip(kinds).all(|(nanos, best)| nanos > best)
        })
    }

    /// Nanoseconds per ray of each set. With all rays they are kept.
    fn turn(&self, runner: &mut Runner, log: &RayLog) -> Vec<f64> {
        let nanos: Vec<f64> = log
            .sets
            .iter()
            .map(|set| per_ray(shoot(&runner.world, set, self.limits.clock).worked, set))
            .collect();
        if std::ptr::eq(log, &self.all) {
            for (times, &nanos) in runner.times.iter_mut().zip(&nanos) {
                times.push(nanos);
            }
            let medians = runner.times.iter().map(|times| median(times)).collect();
            self.sum_up(&mut runner.measured, medians);
            runner.measured.rounds = runner.times.first().map_or(1, Vec::len);
        }
        nanos
    }

    /// Two turns that nobody keeps: the first builds what is built when rays come.
    fn warm(&self, runner: &mut Runner, log: &RayLog) {
        let clock = self.limits.clock;
        let nanos = log.sets.iter().map(|set| {
            let [first, second] = [0; 2].map(|_| shoot(&runner.world, set, clock));
            runner.measured.build_seconds += (first.passed - second.passed).max(0.0);
            per_ray(second.worked, set)
        });
        let nanos = nanos.collect();
        self.sum_up(&mut runner.measured, nanos);
    }

    /// Lets all shoot, in turns, while there is time.
    fn run(&self, runners: &mut [Runner]) {
        for _ in 0..self.limits.options.rounds {
            if self.limits.observer.stop() || !self.limits.is_time_for(&[]) {
                break;
            }
            for runner in runners.iter_mut() {
                self.turn(runner, &self.all);
            }
        }
    }

    /// Takes note of what rays take.
    fn sum_up(&self, measured: &mut Measured, nanos: Vec<f64>) {
        measured.nanos = nanos;
        measured.mix = mixed(&measured.nanos, &self.all);
        let rays = self.limits.options.rays_expected.max(1.0);
        measured.total = measured.mix + measured.build_seconds * 1e9 / rays;
    }
}

/// The fastest for the mix.
fn fastest(runners: &[Runner]) -> Option<usize> {
    let mix = |i: usize| runners[i].measured.mix;
    (0..runners.len()).min_by(|&a, &b| mix(a).total_cmp(&mix(b)))
}

#[cfg(test)]
mod tests;
