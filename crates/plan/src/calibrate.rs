//! What steps and tests cost on this machine: every technique is timed over scenes of all kinds,
//! and the prices are those that explain the times best, given what was counted.

mod runs;

use nestray_scene::scene::Scene;

use crate::error::PlanError;
use crate::optimize::Observer;
use crate::optimize::ray_log::RayLog;
use crate::prices::Prices;
use crate::prices::fit::{self, Run};

/// A scene to time techniques over, and rays.
#[derive(Clone, Debug)]
pub struct Sample {
    /// What it is called in reports.
    pub name: String,
    /// The scene.
    pub scene: Scene,
    /// The rays; weights do not matter.
    pub log: RayLog,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// The prices.
    pub prices: Prices,
    /// How many times were explained.
    pub runs: usize,
    /// How far off a prediction is, as a part of what was measured: the median over all runs, each
    /// predicted by prices found without its scene.
    pub error: f64,
}

/// How much the usual prices weigh against one run: enough where nothing else is known.
const PRIOR: f64 = 0.01;

/// Prices of this machine, by one thread: nothing else should run. `Observer::tried` is told how many
/// scenes are done.
///
/// # Errors
/// If the parts of a scene do not fit together.
pub fn calibrate(
    samples: impl IntoIterator<Item = Sample>,
    observer: &dyn Observer,
) -> Result<Calibration, PlanError> {
    let mut runs = Vec::<Run>::new();
    for (done, sample) in (1..).zip(samples) {
        if observer.stop() {
            break;
        }
        runs.extend(runs::of(&sample, observer)?);
        observer.tried(done, 0.0);
    }
    let usual = Prices::usual();
    let prices = fit::prices(&runs, usual, PRIOR);
    Ok(Calibration { prices, runs: runs.len(), error: fit::error(&runs, usual, PRIOR) })
}

#[cfg(test)]
mod tests;
