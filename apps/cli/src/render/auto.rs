//! `--plan auto`: a plan is searched for if the picture takes so long that this pays.
//!
//! A pilot with the default plan says how long that is. The search gets a small part of it, and what
//! it finds is held against the default in the same pilot: so whatever comes of it, the picture is
//! hardly later than without, and often earlier. What was found is kept for the next time.

mod deadline;
mod pilot;

use std::time::{Duration, Instant};

use nestray::core::cost::CostModel;
use nestray::plan::build::build;
use nestray::plan::error::PlanError;
use nestray::plan::fingerprint::fingerprint;
use nestray::plan::optimize::{Options as Search, optimize};
use nestray::plan::plan::Plan;
use nestray::plan::single::{AUTO, single};
use nestray::prelude::{DynObject, Object as _, Scene};
use nestray::render::options::{Crop, Integrator, Options};
use nestray::render::ray_counts::RayCounts;

use self::deadline::Deadline;
use self::pilot::Pilot;
use crate::args::Weights;
use crate::cache::{Cache, Entry, Key, Taken};
use crate::errors::Failure;
use crate::optimize::log_from;
use crate::progress::Progress;
use crate::{input, stats, stop};

/// The part of the predicted time that a search may take, timing included.
const PART: f64 = 0.015;
/// The shortest search that finds anything, in seconds, and in builds of the default plan: some
/// techniques take thirty times as long to build, and none is broken off.
const LEAST: f64 = 0.3;
const BUILDS: f64 = 100.0;
/// What is tried where there is no time for a search; so many times as long as the default it may
/// take to build, and that part of the predicted time.
const QUALITY: &str = "sbvh";
const TRY: f64 = 12.0;
const PART_TO_TRY: f64 = 0.02;
/// No search is longer, in seconds: more finds little more.
const MOST: f64 = 600.0;
/// Pictures of fewer samples are not worth a pilot.
const FEW: u64 = 1 << 16;
/// So many times as long as before must be allowed to search again.
const AGAIN: f64 = 8.0;
/// Rays of each kind to search with and to time with: least, and most.
const RAYS: [f64; 2] = [1024.0, 65_536.0];
/// Plans that there is to be time for to time.
const PLANS: f64 = 30.0;
/// How much faster a plan must be than the default.
const FASTER: f64 = 1.01;

/// What is to be rendered.
#[derive(Debug)]
pub(super) struct Auto<'a> {
    /// The first frame.
    pub(super) scene: &'a Scene,
    pub(super) options: &'a Options,
    /// How many frames there are.
    pub(super) frames: usize,
    /// How long may be searched, if somebody said.
    pub(super) asked: Option<Duration>,
    pub(super) cache: Cache,
    pub(super) progress: Progress,
}

/// The plan that was chosen, and why.
pub(super) struct Chosen {
    pub(super) plan: Plan,
    /// The objects of the first frame, if they are there already.
    pub(super) ready: Option<DynObject>,
    pub(super) why: String,
}

/// The default plan, tried.
struct Tried {
    plan: Plan,
    world: DynObject,
    taken: Taken,
    rays: RayCounts,
}

impl Auto<'_> {
    /// The plan that is expected to have the picture done first; says why.
    pub(super) fn choose(&self) -> Result<Chosen, Failure> {
        let chosen = self.chosen()?;
        self.progress.note(&format!("plan auto: {}", chosen.why));
        Ok(chosen)
    }

    fn chosen(&self) -> Result<Chosen, Failure> {
        let plan = single(AUTO, Default::default(), self.scene).map_err(failure)?;
        let default = |why: &str| Chosen {
            plan: plan.clone(),
            ready: None,
            why: format!("{AUTO}, not searched: {why}"),
        };
        if self.options.integrator == Integrator::Cost {
            return Ok(default("the picture shows what its nest does"));
        }
        if self.asked == Some(Duration::ZERO) {
            return Ok(default("no time for it"));
        }
        if self.asked.is_none() && self.samples() < FEW {
            return Ok(default(&format!("the picture has only {} samples", self.samples())));
        }
        let key = self.key();
        if let Some(entry) = self.cache.find(&key, self.scene)
            && let Some(chosen) = self.cached(entry, &plan)
        {
            return Ok(chosen);
        }
        let begun = Instant::now();
        let world = build(&plan, self.scene).map_err(failure)?;
        let build = begun.elapsed().as_secs_f64();
        let pilot = Pilot::new(self.options, self.samples(), self.threads());
        pilot.warm(self.scene, &world)?;
        let (sample, rays) = pilot.run(self.scene, &world)?;
        let tried = Tried { plan, world, taken: Taken { sample, build }, rays };
        match self.budget(&tried.taken) {
            Ok(budget) => self.search(key, tried, &pilot, Some(budget)),
            Err(_) if self.asked.is_none() && self.is_worth_a_try(&tried.taken) => {
                self.search(key, tried, &pilot, None)
            }
            Err(why) => {
                let why = format!("{AUTO}, not searched: {why}");
                Ok(Chosen { plan: tried.plan, ready: Some(tried.world), why })
            }
        }
    }

    /// What was found before, if a search of today would not be much longer.
    fn cached(&self, entry: Entry, default: &Plan) -> Option<Chosen> {
        let budget = self.budget(&entry.default).map_or(0.0, |budget| budget.as_secs_f64());
        if budget > AGAIN * entry.searched {
            return None;
        }
        let times = entry.default.sample / entry.best.sample.max(f64::MIN_POSITIVE);
        let pays = self.seconds(&entry.best) < self.seconds(&entry.default);
        let (plan, why) = match pays && entry.plan != *default {
            true => (entry.plan, format!("from the cache, {times:.2} times as fast as {AUTO}")),
            false => (default.clone(), format!("{AUTO}, as the cache says")),
        };
        Some(Chosen { plan, ready: None, why })
    }

    /// Whether there is time to build the one plan that is better most often, and to time it.
    fn is_worth_a_try(&self, default: &Taken) -> bool {
        TRY * default.build < PART_TO_TRY * self.seconds(default)
    }

    /// Searches, or without a budget takes the plan that is better most often, and holds what was
    /// found against the default.
    fn search(
        &self,
        key: Key,
        tried: Tried,
        pilot: &Pilot,
        budget: Option<Duration>,
    ) -> Result<Chosen, Failure> {
        let begun = Instant::now();
        let found = match budget {
            Some(budget) => self.found(&tried, pilot, budget)?,
            None => Some(single(QUALITY, Default::default(), self.scene).map_err(failure)?),
        };
        let searched = begun.elapsed().as_secs_f64();
        let predicted = self.seconds(&tried.taken);
        let took = match budget {
            Some(_) => format!("searched for {searched:.1} s of a predicted {predicted:.1} s"),
            None => format!("{QUALITY} tried, the picture takes about {predicted:.1} s"),
        };
        stop::check()?;
        let same = Plan { scene: None, ..found.clone().unwrap_or_else(|| tried.plan.clone()) };
        let mut entry = Entry {
            key,
            searched,
            default: tried.taken,
            best: tried.taken,
            plan: tried.plan.clone(),
        };
        let mut chosen = Chosen {
            plan: tried.plan.clone(),
            ready: Some(tried.world.clone()),
            why: format!("{took}: nothing is faster than {AUTO}"),
        };
        if same != tried.plan {
            let begun = Instant::now();
            let world = build(&same, self.scene).map_err(failure)?;
            let build = begun.elapsed().as_secs_f64();
            let [default, best] = pilot.in_turns(self.scene, [&tried.world, &world])?;
            entry.default.sample = default;
            entry.best = entry.default;
            let taken = Taken { sample: best, build };
            if self.seconds(&entry.default) > FASTER * self.seconds(&taken) {
                (entry.best, entry.plan) = (taken, same.clone());
                let why = format!("{took}: {:.2} times as fast as {AUTO}", default / best);
                chosen = Chosen { plan: same, ready: Some(world), why };
            }
        }
        stop::check()?;
        self.cache.keep(&entry);
        Ok(chosen)
    }

    /// The plan that was fastest for rays such as the pilot had.
    fn found(
        &self,
        tried: &Tried,
        pilot: &Pilot,
        budget: Duration,
    ) -> Result<Option<Plan>, Failure> {
        let eye = self.scene.cameras.get(self.options.camera);
        let weights = Weights::counted(&tried.rays);
        let per_sample = tried.rays.total().cast as f64 / pilot.samples() as f64;
        // Half of the time is for timing. Of four kinds of rays half are sent, three times.
        let each = budget.as_secs_f64() / 2.0 / PLANS;
        let count = each * per_sample / tried.taken.sample.max(1e-9) / 6.0;
        let count = count.clamp(RAYS[0], RAYS[1]) as usize;
        let log = log_from(eye, self.scene, &tried.world, &weights, count)?;
        if log.sets.is_empty() {
            return Ok(None);
        }
        let memory = tried.world.cost(CostModel::usual()).bytes;
        let options = Search {
            time: Some(budget / 2),
            // Rays are timed on one thread, and cast by all.
            rays_expected: per_sample * self.share(),
            max_memory: memory.saturating_mul(4).max(1 << 28),
            rounds: 3,
            ..Search::default()
        };
        let prices = self.cache.prices();
        let deadline = Deadline::new(budget, self.progress.watch("plan auto"));
        let search = || optimize(self.scene, &log, &prices, &options, &deadline);
        let found = input::pool(self.options.threads)?.install(search).map_err(failure)?;
        Ok(Some(found.plan))
    }

    /// How long to search, or why not at all.
    fn budget(&self, default: &Taken) -> Result<Duration, String> {
        let whole = self.seconds(default);
        let budget = (PART * whole).min(MOST);
        match self.asked {
            Some(asked) => Ok(asked),
            None if budget < LEAST => Err(format!("the picture takes about {whole:.1} s")),
            None if budget < BUILDS * default.build => {
                let build = default.build;
                Err(format!("the picture takes about {whole:.1} s, building one plan {build:.2} s"))
            }
            None => Ok(Duration::from_secs_f64(budget)),
        }
    }

    /// Seconds to build a plan and render with it.
    fn seconds(&self, taken: &Taken) -> f64 {
        taken.sample * self.share() + taken.build
    }

    /// Samples of all frames.
    fn samples(&self) -> u64 {
        let Crop { from, to } = self.options.window();
        let [width, height] = [0, 1].map(|i| u64::from(to[i] - from[i]));
        width * height * u64::from(self.options.samples) * self.frames as u64
    }

    /// Samples of each thread.
    fn share(&self) -> f64 {
        self.samples() as f64 / self.threads() as f64
    }

    fn threads(&self) -> usize {
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        if self.options.threads == 0 { all } else { self.options.threads.min(all) }
    }

    fn key(&self) -> Key {
        let integrator = match self.options.integrator {
            Integrator::Whitted(_) => "whitted",
            Integrator::Path => "path",
            Integrator::AmbientOcclusion { .. } => "ao",
            Integrator::Cost => "cost",
        };
        Key {
            nestray: env!("CARGO_PKG_VERSION").into(),
            vector_level: stats::level(),
            integrator: integrator.into(),
            scene: fingerprint(self.scene),
        }
    }
}

fn failure(error: PlanError) -> Failure {
    input::plan_failure(&error, None)
}
