//! Rays that are timed.

use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object as _};
use nestray_core::scratch::Scratch;

use crate::optimize::clock::Clock;
use crate::optimize::ray_log::{RayLog, RaySet};

pub(crate) fn per_ray(seconds: f64, set: &RaySet) -> f64 {
    seconds * 1e9 / set.rays.len().max(1) as f64
}

pub(crate) fn mixed(nanos: &[f64], log: &RayLog) -> f64 {
    nanos.iter().zip(&log.sets).map(|(nanos, set)| nanos * set.weight).sum()
}

/// Seconds.
pub(crate) struct Took {
    /// On the clock on the wall.
    pub(crate) passed: f64,
    /// That this thread worked.
    pub(crate) worked: f64,
}

/// What the rays of a set take, in batches.
pub(crate) fn shoot(world: &DynObject, set: &RaySet, clock: &dyn Clock) -> Took {
    /// Rays in a batch.
    const BATCH: usize = 4096;
    let mut scratch = Scratch::new();
    let mut hits: Vec<Hit> = Vec::new();
    let mut blocked = Vec::new();
    let begun = [clock.seconds(), clock.worked()];
    for rays in set.rays.chunks(BATCH) {
        if set.any {
            blocked.clear();
            blocked.resize(rays.len(), false);
            world.any_hits(rays, &mut blocked, &mut scratch);
        } else {
            hits.clear();
            hits.extend(rays.iter().map(|ray| Hit::none(ray.t_max())));
            world.closest_hits(rays, &mut hits, &mut scratch);
        }
    }
    Took { passed: clock.seconds() - begun[0], worked: clock.worked() - begun[1] }
}

pub(crate) fn median(times: &[f64]) -> f64 {
    let mut times = times.to_vec();
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(f64::INFINITY)
}
