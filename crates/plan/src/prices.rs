//! What steps and tests cost, for rays that go together and for rays that go alone.

pub(crate) mod fit;

use std::collections::BTreeMap;
use std::sync::LazyLock;

use nestray_core::cost::CostModel;
use nestray_core::counters::Tally;
use nestray_registry as registry;
use serde::{Deserialize, Serialize};

/// Prices of rays in batches, in nanoseconds.
///
/// Rays whose neighbours go the same way share work, in techniques that lead packets of them: what
/// is counted for one ray then takes less.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prices {
    /// Of rays with neighbours, from an eye or towards a light, where these are kept together.
    #[serde(with = "List")]
    pub neighbours: CostModel,
    /// Of all others.
    #[serde(with = "List")]
    pub scattered: CostModel,
}

impl Prices {
    /// Those of a machine of 2026, for where nobody calibrated: see
    /// [`calibrate`](crate::calibrate::calibrate).
    #[must_use]
    pub fn usual() -> &'static Self {
        static USUAL: LazyLock<Prices> = LazyLock::new(|| {
            serde_json::from_str(include_str!("prices/usual.json")).expect("prices")
        });
        &USUAL
    }

    /// Those of rays with neighbours, or without; see
    /// [`RaySet::stay_together`](crate::optimize::ray_log::RaySet::stay_together).
    #[must_use]
    pub fn of(&self, neighbours: bool) -> &CostModel {
        if neighbours { &self.neighbours } else { &self.scattered }
    }

    /// Whether they are numbers that can be prices.
    #[must_use]
    pub fn are_sound(&self) -> bool {
        [&self.neighbours, &self.scattered].into_iter().all(|model| {
            let CostModel { ray, far, call, transform, primitive, step, kind } = model;
            let named = primitive.values().chain(step.values());
            let all = [ray, far, call, transform].into_iter().chain(named);
            kind.is_none() && all.into_iter().all(|price| *price >= 0.0 && price.is_finite())
        })
    }
}

/// Nanoseconds that what `rays` rays did takes, in a structure of so many bytes.
#[must_use]
pub fn nanos(prices: &CostModel, tally: &Tally, rays: usize, bytes: u64) -> f64 {
    let steps = tally.steps.iter().map(|(name, &count)| prices.step(name) * count as f64);
    let tests = tally.tests.iter().map(|(kind, &count)| test(prices, kind) * count as f64);
    let work = (tally.all_steps() + tally.all_tests()) as f64;
    prices.ray * rays as f64
        + steps.sum::<f64>()
        + tests.sum::<f64>()
        + prices.distance(bytes) * work
}

/// What testing one child takes, without what it does itself.
#[must_use]
pub fn test(prices: &CostModel, kind: &str) -> f64 {
    match kind {
        "instance" => prices.transform,
        _ if registry::find(kind).is_some() => prices.call,
        _ => prices.primitive(kind),
    }
}

/// How prices are written down.
#[derive(Serialize, Deserialize)]
#[serde(remote = "CostModel", deny_unknown_fields)]
struct List {
    ray: f64,
    far: f64,
    call: f64,
    transform: f64,
    primitive: BTreeMap<String, f64>,
    step: BTreeMap<String, f64>,
    #[serde(skip)]
    kind: Option<nestray_core::ray::RayKind>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_usual_prices_are_sound_and_know_every_technique() {
        let usual = Prices::usual();
        assert!(usual.are_sound());
        for model in [&usual.neighbours, &usual.scattered] {
            for name in registry::names() {
                assert!(model.step.contains_key(name), "{name}");
            }
        }
    }

    #[test]
    fn prices_are_read_as_they_were_written() {
        let text = serde_json::to_string(Prices::usual()).expect("plain data");
        assert_eq!(serde_json::from_str::<Prices>(&text).expect("the same"), *Prices::usual());
        let mut wrong = Prices::usual().clone();
        wrong.scattered.far = -1.0;
        assert!(!wrong.are_sound());
    }

    #[test]
    fn what_is_far_away_costs_more() {
        let model = CostModel { ray: 5.0, far: 2.0, ..CostModel::default() };
        let mut tally = Tally::default();
        tally.steps.insert("bvh", 3);
        tally.tests.insert("triangle", 4);
        let near = 2.0 * 5.0 + 3.0 * 10.0 + 4.0 * 3.0;
        assert_eq!(nanos(&model, &tally, 2, 1000), near);
        assert_eq!(nanos(&model, &tally, 2, 4 * CostModel::NEAR), near + 7.0 * 2.0 * 2.0);
    }
}
