//! What a plan costs: built, sent a few rays, and priced by what they did.

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

/// Prices plans for one scene.
#[derive(Debug)]
pub struct Scorer<'a> {
    scene: &'a Scene,
    log: RayLog,
    prices: &'a Prices,
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
    pub fn new(scene: &'a Scene, log: &RayLog, prices: &'a Prices, max_memory: u64) -> Self {
        Self { scene, log: log.thinned(COUNTED), prices, max_memory }
    }

    /// What a plan costs. The same plan always costs the same.
    ///
    /// # Errors
    /// If it cannot be built.
    pub fn score(&self, plan: &Plan) -> Result<Score, PlanError> {
        let world = build(plan, self.scene)?;
        let done: Vec<Done<'_>> = self.log.sets.iter().map(|set| self.send(&world, set)).collect();
        // What is built when rays come is there now.
        let bytes = world.cost(CostModel::usual()).bytes;
        if bytes > self.max_memory {
            return Ok(Score { nanos: vec![f64::INFINITY; done.len()], bytes });
        }
        let per_ray = |Done { model, tally, rays }: &Done<'_>| {
            prices::nanos(model, tally, *rays, bytes) / (*rays).max(1) as f64
        };
        Ok(Score { nanos: done.iter().map(per_ray).collect(), bytes })
    }

    /// Sends the rays of a set through a world, and counts what they do.
    fn send(&self, world: &DynObject, set: &RaySet) -> Done<'_> {
        let mut scratch = Scratch::counting();
        let model = self.prices.of(set);
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
        Done { model, tally: scratch.counters.total(), rays: done }
    }
}

/// What some rays did.
struct Done<'a> {
    /// Their prices.
    model: &'a CostModel,
    tally: Tally,
    rays: usize,
}
