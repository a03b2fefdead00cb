//! The nest that was chosen, built again and looked into: what rays of the log do in each part.

use nestray::plan::build::build;
use nestray::plan::describe::{Part, Sent, Spent, describe};
use nestray::plan::optimize::Optimized;
use nestray::plan::optimize::ray_log::RayLog;
use nestray::plan::prices::Prices;
use nestray::prelude::Scene;

use super::html::Boxes;
use crate::errors::Failure;
use crate::input;
use crate::inspect::pilot;

/// What the nest is made of, and where rays spend their time.
pub(super) struct Nest {
    pub(super) part: Part,
    pub(super) spent: Spent,
    /// None if there is no camera.
    pub(super) boxes: Option<Boxes>,
}

impl Nest {
    pub(super) fn new(
        scene: &Scene,
        found: &Optimized,
        log: &RayLog,
        prices: &Prices,
    ) -> Result<Self, Failure> {
        let failure = |error| input::plan_failure(&error, None);
        let world = build(&found.plan, scene).map_err(failure)?;
        let sent = pilot::send(scene, &world)?;
        let prices = &prices.scattered;
        let part = describe(&world, prices).counted(&sent);
        let spent = part.spent(prices, &|rays| weight(rays, &sent, log));
        Ok(Self { part, spent, boxes: Boxes::new(scene, &*world)? })
    }
}

/// The share of rays of a name in the mix. A set of shadow rays has a name for each light.
pub(crate) fn weight(rays: &str, sent: &Sent, log: &RayLog) -> f64 {
    let set = |name: &str| name.split(' ').next().unwrap_or_default().to_owned();
    let own = set(rays);
    let weight = log.sets.iter().find(|set| set.name == own).map_or(0.0, |set| set.weight);
    let of = |all: bool| -> u64 {
        let counts =
            sent.rays.iter().filter(|(name, ..)| if all { set(name) == own } else { name == rays });
        counts.map(|&(_, _, count)| count).sum()
    };
    weight * of(false) as f64 / of(true).max(1) as f64
}
