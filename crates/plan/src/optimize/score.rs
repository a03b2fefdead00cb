//! What a plan costs: built, sent a few rays, and priced by what they did.

use std::borrow::Cow;

use nestray_core::cost::CostModel;
use nestray_core::counters::Tally;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object as _};
use nestray_core::scratch::Scratch;
use nestray_scene::scene::Scene;

use super::ray_log::{RayLog, RaySet};
use crate::build::build;
use crate::error::PlanError;
use crate::plan::Plan;
use crate::prices::{self, Prices};

/// What the rays of each set cost in a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Score {
    /// Nanoseconds per ray, for each set of the log.
    pub nanos: Vec<f64>,
    /// Memory of the objects.
    pub bytes: u64,
}

impl Score {
    /// What a ray of the mix costs.
    #[must_use]
    pub fn mix(&self, log: &RayLog) -> f64 {
        self.nanos.iter().zip(&log.sets).map(|(nanos, set)| nanos * set.weight).sum()
    }
}

/// What the rays of a set did.
#[derive(Clone, Debug)]
pub(crate) struct Did {
    pub(crate) neighbours: bool,
    pub(crate) tally: Tally,
    /// Rays that were sent.
    pub(crate) rays: usize,
}

/// What the rays of each set did in a plan.
#[derive(Clone, Debug)]
pub(crate) struct Counted {
    pub(crate) sets: Vec<Did>,
    /// Memory of the objects.
    pub(crate) bytes: u64,
}

/// Prices plans for one scene.
#[derive(Debug)]
pub struct Scorer<'a> {
    scene: &'a Scene,
    /// Some rays of each set, and whether they have neighbours in it.
    sets: Vec<(RaySet, bool)>,
    /// Those of the machine.
    before: &'a Prices,
    /// Those that are gone by.
    prices: Cow<'a, Prices>,
    max_memory: u64,
}

/// Rays of each set that are counted.
const COUNTED: usize = 1024;
/// Rays after which a plan may be given up.
const FIRST: usize = 64;
/// Nanoseconds per ray above which it is: no structure worth having takes so long.
const HOPELESS: f64 = 50_000.0;

impl<'a> Scorer<'a> {
    /// For the rays of a log; plans that take more than `max_memory` bytes cost infinitely much.
    #[must_use]
    pub fn new(scene: &'a Scene, log: &RayLog, prices: &'a Prices, max_memory: u64) -> Self {
        let sets = log.sets.iter().map(|set| (set.scattered(COUNTED), set.are_neighbours()));
        Self {
            scene,
            sets: sets.collect(),
            before: prices,
            prices: Cow::Borrowed(prices),
            max_memory,
        }
    }

    /// What a plan costs. The same plan always costs the same.
    ///
    /// # Errors
    /// If it cannot be built.
    pub fn score(&self, plan: &Plan) -> Result<Score, PlanError> {
        Ok(self.price(&self.try_out(plan)?))
    }

    /// Builds a plan and counts what rays do.
    ///
    /// # Errors
    /// If it cannot be built.
    pub(super) fn try_out(&self, plan: &Plan) -> Result<Counted, PlanError> {
        Ok(self.count(&build(plan, self.scene)?))
    }

    /// The scene.
    pub(super) fn scene(&self) -> &'a Scene {
        self.scene
    }

    /// The prices that it began with.
    pub(super) fn prices_before(&self) -> &'a Prices {
        self.before
    }

    /// Goes by other prices from now on.
    pub(super) fn set_prices(&mut self, prices: Prices) {
        self.prices = Cow::Owned(prices);
    }

    /// Sends rays through a world, and counts what they do.
    pub(super) fn count(&self, world: &DynObject) -> Counted {
        let send = |(set, neighbours): &(RaySet, bool)| {
            self.send(world, set, *neighbours && !set.are_parted(world))
        };
        let sets = self.sets.iter().map(send).collect();
        // What is built when rays come is there now.
        Counted { sets, bytes: world.cost(CostModel::usual()).bytes }
    }

    /// What rays cost that did this.
    pub(super) fn price(&self, counted: &Counted) -> Score {
        let Counted { sets, bytes } = counted;
        if *bytes > self.max_memory {
            return Score { nanos: vec![f64::INFINITY; sets.len()], bytes: *bytes };
        }
        let per_ray = |did: &Did| {
            let model = self.prices.of(did.neighbours);
            prices::nanos(model, &did.tally, did.rays, *bytes) / did.rays.max(1) as f64
        };
        Score { nanos: sets.iter().map(per_ray).collect(), bytes: *bytes }
    }

    /// Sends the rays of a set.
    fn send(&self, world: &DynObject, set: &RaySet, neighbours: bool) -> Did {
        let mut scratch = Scratch::counting();
        let model = self.prices.of(neighbours);
        let mut done = 0;
        for rays in set.rays.chunks(FIRST) {
            for ray in rays {
                if set.any {
                    world.any_hit(ray, &mut scratch);
                } else {
                    world.closest_hit(ray, &mut Hit::none(ray.t_max()), &mut scratch);
                }
            }
            done += rays.len();
            let nanos = prices::nanos(model, &scratch.counters.total(), done, 0);
            if nanos > HOPELESS * done as f64 {
                break;
            }
        }
        Did { neighbours, tally: scratch.counters.total(), rays: done }
    }
}
