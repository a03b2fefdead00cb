//! Finding the plan that is fastest for a scene.
//!
//! Rays of the kinds that will be cast say what counts: a [`RayLog`]. Plans are tried by building
//! them, sending some of the rays through them, and pricing what was counted ([`Scorer`]); the first of them
//! are timed too, which tells what prices are in this scene. Replicas at
//! different temperatures change plans step by step ([`anneal`]), each after a goal of its own: the
//! mix of all rays, or those of one kind, for a world may be put in order for each kind apart. In
//! the end the best of what was seen, and every single technique, are timed on other rays
//! ([`measure`]); what is fastest then is taken, whatever was expected.

pub mod anneal;
pub mod measure;
pub mod moves;
pub mod ray_log;
pub mod score;
pub mod start;

mod archive;
pub(crate) mod clock;
pub(crate) mod effort;
mod learn;
mod pins;
mod school;
mod shelf;

use std::time::Duration;

use nestray_scene::scene::Scene;

use self::anneal::Tempering;
use self::archive::Archive;
use self::clock::{Clock, Wall};
use self::measure::{Finalist, Measured};
use self::pins::Pins;
use self::ray_log::RayLog;
use self::school::School;
use self::score::{Counted, Score, Scorer};
use crate::error::PlanError;
use crate::fingerprint::fingerprint;
use crate::plan::Plan;
use crate::prices::Prices;

/// What may be spent, and on what.
#[derive(Clone, Debug)]
pub struct Options {
    /// Techniques that plans may use; all if there are none.
    pub techniques: Vec<String>,
    /// A plan to begin with, besides the usual ones.
    pub start: Option<Plan>,
    /// Paths of nodes of that plan that every other must hold as they are; the usual plans, which do
    /// not, are then not tried.
    pub pins: Vec<String>,
    /// Most plans to try; the same number finds the same plans on every machine.
    pub evaluations: Option<usize>,
    /// Most time to try them: none is begun that may take longer. What is timed in the end comes on
    /// top, as long again at most.
    pub time: Option<Duration>,
    /// Another number goes other ways.
    pub seed: u64,
    /// Rays that will be cast: what building takes is spread over them.
    pub rays_expected: f64,
    /// Most memory of the objects, in bytes.
    pub max_memory: u64,
    /// Times that finalists shoot in turns.
    pub rounds: usize,
}

impl Default for Options {
    /// Four seconds, ten million rays, no limit on memory.
    fn default() -> Self {
        Self {
            techniques: Vec::new(),
            start: None,
            pins: Vec::new(),
            evaluations: None,
            time: Some(Duration::from_secs(4)),
            seed: 0,
            rays_expected: 1e7,
            max_memory: u64::MAX,
            rounds: 5,
        }
    }
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Optimized {
    /// The plan that was fastest, made for this scene.
    pub plan: Plan,
    /// The plan that was expected to be fastest: the same for the same scene, rays, seed, prices and
    /// number of evaluations, on every machine and any number of threads.
    pub expected: Plan,
    /// The cheapest that were tried, by what was expected, for the mix.
    pub candidates: Vec<Candidate>,
    /// All that was timed, the winner first, then as fast as they were.
    pub finalists: Vec<Measured>,
    /// Plans that were tried.
    pub evaluations: usize,
    /// Seconds that took, without the timing.
    pub search_seconds: f64,
    /// How the search went.
    pub trace: Vec<anneal::Round>,
}

/// A plan that was tried.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Which.
    pub plan: Plan,
    /// What it is expected to cost.
    pub score: Score,
}

/// Is told how far it has come, and says when to stop.
pub trait Observer: Sync {
    /// After some plans were tried: how many, and what the best of them costs for the mix, in
    /// nanoseconds per ray.
    fn tried(&self, _evaluations: usize, _best: f64) {}

    /// Whether to end the search: what is best so far is taken.
    fn stop(&self) -> bool {
        false
    }
}

/// The fastest plan for a scene and the rays of `log`.
///
/// # Errors
/// If the parts of the scene do not fit together, a technique or a pinned node is not known, none can
/// serve, or the plan to begin with does not fit the scene.
pub fn optimize(
    scene: &Scene,
    log: &RayLog,
    prices: &Prices,
    options: &Options,
    observer: &dyn Observer,
) -> Result<Optimized, PlanError> {
    optimize_by(scene, log, prices, &Limits::new(&Wall::new(), options, observer))
}

/// [`optimize`], by any clock.
fn optimize_by(
    scene: &Scene,
    log: &RayLog,
    prices: &Prices,
    limits: &Limits<'_>,
) -> Result<Optimized, PlanError> {
    let options = limits.options;
    let allowed = start::allowed(&options.techniques)?;
    let pins = Pins::new(options.start.as_ref(), &options.pins)?;
    let (search_log, timed_log) = log.halves();
    let scorer = Scorer::new(scene, &search_log, prices, options.max_memory);
    let mut school = School::new(scorer, &search_log, limits);
    let mut archive = Archive::new(&search_log);
    if let Some(plan) = &options.start {
        start::given(plan, limits, &mut archive, &mut school)?;
    }
    if pins.are_none() {
        start::singles(&allowed, limits, &mut archive, &mut school)?;
    }
    school.learn(&mut archive);
    let mut trace = Vec::new();
    let tempering = Tempering { scene, allowed: &allowed, pins: &pins, seed: options.seed };
    if school.is_open() {
        let early = limits.earlier(School::AGAIN);
        tempering.run(&school.scorer, &early, &mut archive, &mut trace);
        school.look_at_nests(limits, &mut archive);
        school.learn(&mut archive);
    }
    tempering.run(&school.scorer, limits, &mut archive, &mut trace);
    let search_seconds = limits.clock.seconds();
    let evaluations = archive.evaluations();
    let (expected, candidates) = (archive.cheapest(), archive.candidates());
    let finalists: Vec<Finalist> = archive.finalists();
    let timing = limits.timing();
    let built = (&archive.efforts, school.shelf);
    let mut measured = measure::race(scene, finalists, &timed_log, &timing, built)?;
    let winner = measure::choice::choose(&measured);
    let mut plan = measured[winner].finalist.plan.clone();
    plan.scene = Some(fingerprint(scene));
    measured[..].swap(0, winner);
    measured[1..].sort_by(|a, b| a.total.total_cmp(&b.total));
    let finalists = measured;
    Ok(Optimized { plan, expected, candidates, finalists, evaluations, search_seconds, trace })
}

/// When to end.
#[derive(Clone)]
pub(crate) struct Limits<'a> {
    clock: &'a dyn Clock,
    options: &'a Options,
    observer: &'a dyn Observer,
    /// Seconds on the clock when no more plans may be tried.
    end: f64,
}

impl<'a> Limits<'a> {
    fn new(clock: &'a dyn Clock, options: &'a Options, observer: &'a dyn Observer) -> Self {
        let end = options.time.map_or(f64::INFINITY, |time| clock.seconds() + time.as_secs_f64());
        Self { clock, options, observer, end }
    }

    /// Those of the timing, which begins now.
    fn timing(&self) -> Self {
        // What the search took too much, it has less.
        let begun = self.clock.seconds().min(self.end);
        let time = self.options.time.map_or(f64::INFINITY, |time| time.as_secs_f64());
        let end = begun + time;
        Self { end, ..self.clone() }
    }

    /// Seconds that are left.
    fn left(&self) -> f64 {
        (self.end - self.clock.seconds()).max(0.0)
    }

    /// The same, ending when so much of the time that is left now is still to come.
    fn earlier(&self, part: f64) -> Self {
        let left = self.left();
        let end = if left.is_finite() { self.end - part * left } else { self.end };
        Self { end, ..self.clone() }
    }

    /// Whether no more plans may be tried after so many.
    pub(crate) fn reached(&self, evaluations: usize) -> bool {
        self.observer.stop()
            || self.options.evaluations.is_some_and(|most| evaluations >= most)
            || self.clock.seconds() >= self.end
    }

    /// Whether there is time for plans that take so many seconds each. Side by side they take as long as
    /// one after the other: each is built by all threads.
    pub(crate) fn is_time_for(&self, seconds: &[f64]) -> bool {
        self.clock.seconds() + seconds.iter().sum::<f64>() <= self.end
    }

    /// What rays do in a plan, and the seconds it took to find out.
    pub(crate) fn try_out(
        &self,
        scorer: &Scorer<'_>,
        plan: &Plan,
    ) -> (Result<Counted, PlanError>, f64) {
        let begun = self.clock.seconds();
        let counted = scorer.try_out(plan);
        (counted, self.clock.seconds() - begun)
    }

    /// How far the search is, from 0 to 1.
    pub(crate) fn progress(&self, evaluations: usize) -> f64 {
        let tried = self.options.evaluations.map(|most| evaluations as f64 / most.max(1) as f64);
        let spent = self.options.time.map(|most| {
            let most = most.as_secs_f64().max(f64::MIN_POSITIVE);
            1.0 - (self.end - self.clock.seconds()) / most
        });
        // Where plans are counted, the clock does not say what is done.
        tried.or(spent).unwrap_or(0.0).clamp(0.0, 1.0)
    }

    pub(crate) fn observer(&self) -> &dyn Observer {
        self.observer
    }
}

#[cfg(test)]
mod tests;
