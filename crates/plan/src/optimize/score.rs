//! What a plan costs: built, sent a few rays, and priced by what they did.

use nestray_core::cost::CostModel;
use nestray_core::counters::Tally;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object as _};
use nestray_core::scratch::Scratch;
use nestray_registry as registry;
use nestray_scene::scene::Scene;

use super::ray_log::{RayLog, RaySet};
use crate::build::build;
use crate::error::PlanError;
use crate::plan::Plan;

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

/// Prices plans for one scene.
#[derive(Debug)]
pub struct Scorer<'a> {
    scene: &'a Scene,
    log: RayLog,
    prices: &'a CostModel,
    max_memory: u64,
}

/// Rays of each set that are counted.
const COUNTED: usize = 512;
/// Rays after which a plan may be given up.
const FIRST: usize = 48;
/// Nanoseconds per ray above which it is: no structure worth having takes so long.
const HOPELESS: f64 = 50_000.0;

impl<'a> Scorer<'a> {
    /// For the rays of a log; plans that take more than `max_memory` bytes cost infinitely much.
    #[must_use]
    pub fn new(scene: &'a Scene, log: &RayLog, prices: &'a CostModel, max_memory: u64) -> Self {
        Self { scene, log: log.thinned(COUNTED), prices, max_memory }
    }

    /// What a plan costs. The same plan always costs the same.
    ///
    /// # Errors
    /// If it cannot be built.
    pub fn score(&self, plan: &Plan) -> Result<Score, PlanError> {
        let world = build(plan, self.scene)?;
        let mut nanos: Vec<f64> =
            self.log.sets.iter().map(|set| self.priced(&world, set)).collect();
        let bytes = world.cost(self.prices).bytes;
        if bytes > self.max_memory {
            nanos.fill(f64::INFINITY);
        }
        Ok(Score { nanos, bytes })
    }

    /// Nanoseconds per ray.
    fn priced(&self, world: &DynObject, set: &RaySet) -> f64 {
        let mut scratch = Scratch::counting();
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
            if self.price(&scratch.counters.total()) > HOPELESS * done as f64 {
                break;
            }
        }
        self.price(&scratch.counters.total()) / done.max(1) as f64
    }

    /// Nanoseconds that what was counted takes.
    fn price(&self, tally: &Tally) -> f64 {
        let steps: f64 =
            tally.steps.iter().map(|(name, &count)| self.prices.step(name) * count as f64).sum();
        let tests: f64 = tally
            .tests
            .iter()
            .map(|(kind, &count)| test_price(self.prices, kind) * count as f64)
            .sum();
        steps + tests
    }
}

/// What testing one child takes, without what it does itself.
pub(crate) fn test_price(prices: &CostModel, kind: &str) -> f64 {
    match kind {
        "instance" => prices.transform,
        _ if registry::find(kind).is_some() => prices.call,
        _ => prices.primitive(kind),
    }
}
