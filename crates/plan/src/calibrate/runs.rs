//! Timing and counting the rays of a scene in every technique.

use std::iter;

use nestray_core::cost::CostModel;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object as _};
use nestray_core::scratch::Scratch;
use nestray_registry as registry;

use super::Sample;
use crate::build::build;
use crate::error::PlanError;
use crate::optimize::Observer;
use crate::optimize::clock::{Clock as _, Wall};
use crate::optimize::effort::Efforts;
use crate::optimize::measure::shots::{median, per_ray, shoot};
use crate::optimize::ray_log::RaySet;
use crate::presets::PRESETS;
use crate::prices::fit::Run;
use crate::single::{AUTO, single};

/// Rays of each set that are counted, and those that are timed.
const COUNTED: usize = 2048;
const TIMED: usize = 16_384;
/// Those that tell how slow a technique is.
const FIRST: usize = 64;
/// Turns, after one that nobody keeps.
const TURNS: usize = 5;
/// Seconds that a technique may take to build; where scenes are large, some take longer.
const PATIENCE: f64 = 3.0;
/// Nanoseconds that a ray may take: nobody wants what is slower, or what it costs.
const SLOW: f64 = 20_000.0;

/// All techniques and presets over one scene.
pub(super) fn of(sample: &Sample, observer: &dyn Observer) -> Result<Vec<Run>, PlanError> {
    let (mut runs, mut efforts) = (Vec::new(), Efforts::default());
    let clock = Wall::new();
    let others = registry::names().filter(|&name| name != AUTO);
    // The one first that efforts are told by.
    let names = iter::once(AUTO).chain(others).chain(PRESETS.iter().map(|preset| preset.name));
    for name in names {
        let plan = single(name, Default::default(), &sample.scene)?;
        if observer.stop() {
            break;
        }
        if efforts.expected(&plan) > PATIENCE {
            continue;
        }
        let begun = clock.seconds();
        let world = build(&plan, &sample.scene)?;
        efforts.note(&plan, clock.seconds() - begun);
        runs.extend(sample.log.sets.iter().filter_map(|set| run(sample, &world, set, &clock)));
    }
    Ok(runs)
}

/// The rays of one set; none if they take too long.
fn run(sample: &Sample, world: &DynObject, set: &RaySet, clock: &Wall) -> Option<Run> {
    let thinned = |most: usize| set.thinned(most);
    let first = thinned(FIRST);
    // What is built late is there the second time.
    let [_, again] = [0; 2].map(|_| shoot(world, &first, clock));
    if per_ray(again.worked, &first) > SLOW {
        return None;
    }
    let timed = thinned(TIMED);
    shoot(world, &timed, clock);
    let turns: Vec<f64> =
        (0..TURNS).map(|_| per_ray(shoot(world, &timed, clock).worked, &timed)).collect();
    let counted = thinned(COUNTED);
    let mut scratch = Scratch::counting();
    for ray in &counted.rays {
        if set.any {
            world.any_hit(ray, &mut scratch);
        } else {
            world.closest_hit(ray, &mut Hit::none(ray.t_max()), &mut scratch);
        }
    }
    Some(Run {
        scene: sample.name.clone(),
        neighbours: set.stay_together(world),
        tally: scratch.counters.total(),
        rays: counted.rays.len(),
        // Not the usual prices: sums by those are kept, and would be those of before.
        bytes: world.cost(&CostModel::default()).bytes,
        nanos: median(&turns),
        weight: 1.0,
    })
}
