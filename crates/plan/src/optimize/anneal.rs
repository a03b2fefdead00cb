//! Simulated annealing over plans [Arvo 90], by parallel tempering: replicas at several
//! temperatures, which change places when that helps.
//!
//! Rounds are synchronous and every replica has numbers of its own, so that the same seed and the
//! same number of plans give the same result, however many threads there are.

use std::collections::BTreeMap;

use nestray_scene::scene::Scene;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

use super::Limits;
use super::archive::{Archive, Goal, Name};
use super::moves::Move;
use super::pins::Pins;
use super::score::Scorer;
use super::start::tell;
use crate::check::check;
use crate::plan::Plan;

/// What happened in one round.
#[derive(Clone, Debug)]
pub struct Round {
    /// Plans tried so far.
    pub evaluations: usize,
    /// What the best plan for the mix costs, in nanoseconds per ray.
    pub best: f64,
    /// What the plan of each replica costs after its goal.
    pub energies: Vec<f64>,
    /// Its temperature, as a part of what the best plan costs.
    pub temperatures: Vec<f64>,
    /// Steps that were proposed and taken.
    pub steps: Vec<(&'static str, bool)>,
    /// Neighbouring temperatures that changed places.
    pub exchanges: usize,
}

/// Temperatures of the replicas of one goal at the start: how much dearer, as a part of the best,
/// a plan is that is still taken one time in three.
const TEMPERATURES: [f64; 3] = [0.02, 0.08, 0.3];
/// How much colder it is in the end.
const COOLING: f64 = 0.05;
/// How often a replica tries to find a step that is possible.
const TRIES: usize = 16;
/// Rounds without a new plan after which there are no more to be found.
const IDLE: usize = 40;

/// Replicas of all goals.
#[derive(Debug)]
pub(super) struct Tempering<'a> {
    pub(super) scene: &'a Scene,
    pub(super) allowed: &'a [&'static str],
    pub(super) pins: &'a Pins,
    pub(super) seed: u64,
}

/// One plan on its way.
struct Replica {
    goal: Goal,
    temperature: f64,
    /// Its plan, as a number in the archive.
    current: usize,
    numbers: Pcg64Mcg,
}

/// A step that a replica would take.
struct Proposal {
    step: Move,
    plan: Plan,
    hash: String,
}

impl Tempering<'_> {
    /// Goes on until the limits are reached.
    pub(super) fn run(
        &self,
        scorer: &Scorer<'_>,
        limits: &Limits<'_>,
        archive: &mut Archive,
        trace: &mut Vec<Round>,
    ) {
        let mut replicas = self.replicas(archive);
        let mut idle = 0;
        while idle < IDLE && !replicas.is_empty() && !limits.reached(archive.evaluations()) {
            let before = archive.evaluations();
            let proposals: Vec<Option<Proposal>> =
                replicas.par_iter_mut().map(|replica| self.propose(replica, archive)).collect();
            try_new(&proposals, scorer, limits, archive);
            let heat = COOLING.powf(limits.progress(archive.evaluations()));
            let mut steps = Vec::new();
            for (replica, proposal) in replicas.iter_mut().zip(&proposals) {
                let Some(proposal) = proposal else { continue };
                let taken = replica.take(proposal, archive, heat);
                steps.push((proposal.step.name(), taken));
            }
            let exchanges = exchange(&mut replicas, archive, heat);
            idle = if archive.evaluations() == before { idle + 1 } else { 0 };
            trace.push(round(&replicas, archive, (heat, steps, exchanges)));
            tell(limits, archive);
        }
    }

    /// For each goal one replica at each temperature, from the best plans so far.
    fn replicas(&self, archive: &Archive) -> Vec<Replica> {
        let mut replicas = Vec::new();
        for (i, goal) in (0..).zip(archive.goals()) {
            let best = archive.best(goal);
            for (j, temperature) in (0..).zip(TEMPERATURES) {
                let Some(&current) = best.get(j).or(best.first()) else { continue };
                let stream = u128::from(self.seed) << 64 | (i << 32 | j as u128) << 1 | 1;
                let numbers = Pcg64Mcg::new(stream.wrapping_mul(0x9e37_79b9_7f4a_7c15));
                replicas.push(Replica { goal, temperature, current, numbers });
            }
        }
        replicas
    }

    /// A step to a plan that can be built.
    fn propose(&self, replica: &mut Replica, archive: &Archive) -> Option<Proposal> {
        let current = &archive.get(replica.current).plan;
        (0..TRIES).find_map(|_| {
            let step = Move::random(&mut replica.numbers);
            let plan = step.apply(current, self.scene, self.allowed, &mut replica.numbers)?;
            if !self.pins.are_in(&plan) {
                return None;
            }
            check(&plan, self.scene).ok()?;
            let hash = plan.hash();
            Some(Proposal { step, plan, hash })
        })
    }
}

/// Tries the plans that are new, as many as may be and as there is time for.
fn try_new(
    proposals: &[Option<Proposal>],
    scorer: &Scorer<'_>,
    limits: &Limits<'_>,
    archive: &mut Archive,
) {
    let mut new = BTreeMap::new();
    let (mut order, mut seconds) = (Vec::new(), Vec::new());
    for proposal in proposals.iter().flatten() {
        let room = !limits.reached(archive.evaluations() + order.len());
        if room
            && archive.known(&proposal.hash).is_none()
            && new.insert(&proposal.hash, ()).is_none()
        {
            seconds.push(archive.efforts.expected(&proposal.plan));
            if limits.is_time_for(&seconds) {
                order.push(&proposal.plan);
            } else {
                seconds.pop();
            }
        }
    }
    let all: Vec<_> = order.par_iter().map(|plan| limits.try_out(scorer, plan)).collect();
    for (plan, (counted, seconds)) in order.into_iter().zip(all) {
        archive.efforts.note(plan, seconds);
        archive.add(plan.clone(), counted.ok(), Name::None, scorer);
    }
}

impl Replica {
    /// Takes a step, or not: the dearer and the colder, the less likely.
    fn take(&mut self, proposal: &Proposal, archive: &Archive, heat: f64) -> bool {
        let chance: f64 = self.numbers.random();
        let Some(Some(next)) = archive.known(&proposal.hash) else { return false };
        let (old, new) = (archive.cost(self.current, self.goal), archive.cost(next, self.goal));
        let rise = (new - old) / old.max(f64::MIN_POSITIVE);
        let taken = new <= old || chance < (-rise / (self.temperature * heat)).exp();
        if taken {
            self.current = next;
        }
        taken
    }
}

/// Lets replicas of neighbouring temperatures change places; how many did.
fn exchange(replicas: &mut [Replica], archive: &Archive, heat: f64) -> usize {
    let mut exchanges = 0;
    for at in 1..replicas.len() {
        let (left, right) = replicas.split_at_mut(at);
        let (cold, warm) = (&mut left[at - 1], &mut right[0]);
        if cold.goal != warm.goal {
            continue;
        }
        let chance: f64 = cold.numbers.random();
        let (a, b) = (archive.cost(cold.current, cold.goal), archive.cost(warm.current, cold.goal));
        let gain = (a - b) / a.max(f64::MIN_POSITIVE);
        let colder = 1.0 / (cold.temperature * heat) - 1.0 / (warm.temperature * heat);
        if chance < (gain * colder).exp() && cold.current != warm.current {
            std::mem::swap(&mut cold.current, &mut warm.current);
            exchanges += 1;
        }
    }
    exchanges
}

fn round(
    replicas: &[Replica],
    archive: &Archive,
    (heat, steps, exchanges): (f64, Vec<(&'static str, bool)>, usize),
) -> Round {
    let best = archive.best(Goal::Mix);
    Round {
        evaluations: archive.evaluations(),
        best: best.first().map_or(f64::INFINITY, |&best| archive.cost(best, Goal::Mix)),
        energies: replicas.iter().map(|r| archive.cost(r.current, r.goal)).collect(),
        temperatures: replicas.iter().map(|r| r.temperature * heat).collect(),
        steps,
        exchanges,
    }
}
