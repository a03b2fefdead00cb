//! Plans that shoot the same rays in turns.

use std::time::{Duration, Instant};

use nestray::core::cost::CostModel;
use nestray::prelude::{DynObject, Hit, Object as _, Ray, Scratch};

use super::rays::RaySet;
use crate::errors::Failure;
use crate::stop;

/// How long a plan may shoot in one turn: one that is slow gets fewer rays.
const TURN: Duration = Duration::from_millis(500);
/// Rays of the first try.
const FIRST: usize = 64;
/// Neighbours that stay together when there is no time for all rays.
const BLOCK: usize = nestray::core::packet::RAYS;
/// Rays that are counted.
const COUNTED: usize = 2048;

/// What rays found: hits, or only whether there is one.
#[derive(Clone, PartialEq)]
pub(super) enum Answers {
    Hits(Vec<Hit>),
    Blocked(Vec<bool>),
}

/// What one plan took for the rays of one kind.
pub(super) struct Taken {
    /// So many of the rays were shot.
    pub(super) rays: usize,
    /// Median nanoseconds per ray, in batches.
    pub(super) batch: f64,
    /// The same, one ray at a time.
    pub(super) single: f64,
    /// Per ray, over some of them.
    pub(super) steps: f64,
    pub(super) tests: f64,
    /// Answers unlike those of the fastest.
    pub(super) differ: usize,
    /// Seconds that the first shots took longer than later ones: what is built while rays fly.
    pub(super) late: f64,
    /// Memory that the shots took for good.
    pub(super) bytes: u64,
}

/// Lets all worlds shoot `rounds` times, in turns, on this thread.
pub(super) fn run(
    worlds: &[DynObject],
    set: &RaySet,
    rounds: usize,
) -> Result<Vec<Taken>, Failure> {
    let before: Vec<u64> = worlds.iter().map(memory).collect();
    let firsts: Vec<First> = worlds.iter().map(|world| fit(world, set)).collect();
    let fit: Vec<usize> = firsts.iter().map(|first| first.fit).collect();
    let picked: Vec<Vec<Ray>> = fit.iter().map(|&count| spread(&set.rays, count, BLOCK)).collect();
    let mut times = vec![(Vec::new(), Vec::new()); worlds.len()];
    let mut answers = vec![Answers::Hits(Vec::new()); worlds.len()];
    for _ in 0..rounds {
        for (i, world) in worlds.iter().enumerate() {
            stop::check()?;
            let rays = &picked[i];
            let begun = Instant::now();
            answers[i] = batch(world, rays, set.any);
            times[i].0.push(begun.elapsed().as_secs_f64());
            let begun = Instant::now();
            let one = single(world, rays, set.any);
            times[i].1.push(begun.elapsed().as_secs_f64());
            if one != answers[i] {
                let message = format!("{} rays: a batch answers unlike single rays", set.name);
                return Err(Failure::new(Failure::DIFFERENT, message));
            }
        }
    }
    // The fastest has answers for the most rays.
    let fastest = (0..worlds.len()).max_by_key(|&i| picked[i].len()).unwrap_or(0);
    let all = batch(&worlds[fastest], &set.rays, set.any);
    let firsts = firsts.iter().zip(before);
    let taken = worlds.iter().zip(firsts.zip(picked)).zip(times).zip(answers);
    Ok(taken
        .map(|(((world, ((first, before), rays)), (mut batch, mut single)), answers)| {
            let (steps, tests) = count(world, &spread(&rays, COUNTED, 1), set.any);
            let nanos = |times: &mut Vec<f64>| median(times) * 1e9 / rays.len().max(1) as f64;
            let (batch, single) = (nanos(&mut batch), nanos(&mut single));
            let differ = answers.differences(&all.spread(first.fit));
            let late = (first.seconds - first.shots as f64 * batch * 1e-9).max(0.0);
            let bytes = memory(world).saturating_sub(before);
            Taken { rays: rays.len(), batch, single, steps, tests, differ, late, bytes }
        })
        .collect())
}

/// About `count` of `all`, in blocks of neighbours that are spread evenly.
fn spread<T: Copy>(all: &[T], count: usize, block: usize) -> Vec<T> {
    let blocks = all.len().div_ceil(block);
    let step = all.len().div_ceil(count.max(1)).min(blocks).max(1);
    all.chunks(block).step_by(step).flatten().copied().collect()
}

/// The first shots of a world.
struct First {
    /// So many of the rays are shot in a turn.
    fit: usize,
    /// How many were shot to find out, and how long that took.
    shots: usize,
    seconds: f64,
}

/// Memory in use now, of a world in which not too much is shared.
fn memory(world: &DynObject) -> u64 {
    // Sums are kept for the usual model, and would be those of before.
    let model = CostModel::usual().clone();
    if world.paths() > 1 << 17 { 0 } else { world.cost(&model).bytes }
}

/// How many of the rays a world shoots in a turn.
fn fit(world: &DynObject, set: &RaySet) -> First {
    let mut first = First { fit: FIRST.min(set.rays.len()), shots: 0, seconds: 0.0 };
    loop {
        let count = first.fit;
        let rays = spread(&set.rays, count, BLOCK);
        let shoot = || {
            let begun = Instant::now();
            batch(world, &rays, set.any);
            begun.elapsed()
        };
        let spent = shoot();
        first.shots += rays.len();
        first.seconds += spent.as_secs_f64();
        // What was built late is there the second time.
        if count == set.rays.len() || (spent * 2 > TURN && shoot() * 2 > TURN) {
            return first;
        }
        first.fit = (count * 2).min(set.rays.len());
    }
}

/// All answers, by batches.
pub(super) fn batch(world: &DynObject, rays: &[Ray], any: bool) -> Answers {
    /// Rays in a batch.
    const RAYS: usize = 4096;
    let mut scratch = Scratch::new();
    if any {
        let mut blocked = vec![false; rays.len()];
        for (rays, blocked) in rays.chunks(RAYS).zip(blocked.chunks_mut(RAYS)) {
            world.any_hits(rays, blocked, &mut scratch);
        }
        return Answers::Blocked(blocked);
    }
    let mut hits: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
    for (rays, hits) in rays.chunks(RAYS).zip(hits.chunks_mut(RAYS)) {
        world.closest_hits(rays, hits, &mut scratch);
    }
    Answers::Hits(hits)
}

/// All answers, one by one.
pub(super) fn single(world: &DynObject, rays: &[Ray], any: bool) -> Answers {
    shoot(world, rays, any, &mut Scratch::new())
}

fn shoot(world: &DynObject, rays: &[Ray], any: bool, scratch: &mut Scratch) -> Answers {
    if any {
        return Answers::Blocked(rays.iter().map(|ray| world.any_hit(ray, scratch)).collect());
    }
    let closest = |ray: &Ray| {
        let mut hit = Hit::none(ray.t_max());
        world.closest_hit(ray, &mut hit, scratch);
        hit
    };
    Answers::Hits(rays.iter().map(closest).collect())
}

/// Steps and tests per ray.
fn count(world: &DynObject, rays: &[Ray], any: bool) -> (f64, f64) {
    let mut scratch = Scratch::counting();
    shoot(world, rays, any, &mut scratch);
    let total = scratch.counters.total();
    let per_ray = |count: u64| count as f64 / rays.len().max(1) as f64;
    (per_ray(total.all_steps()), per_ray(total.all_tests()))
}

impl Answers {
    /// Those of [`spread`] rays.
    fn spread(&self, count: usize) -> Self {
        match self {
            Self::Hits(hits) => Self::Hits(spread(hits, count, BLOCK)),
            Self::Blocked(blocked) => Self::Blocked(spread(blocked, count, BLOCK)),
        }
    }

    /// How many of the answers that both have are not the same.
    pub(super) fn differences(&self, other: &Self) -> usize {
        match (self, other) {
            (Self::Hits(a), Self::Hits(b)) => a.iter().zip(b).filter(|(a, b)| a != b).count(),
            (Self::Blocked(a), Self::Blocked(b)) => a.iter().zip(b).filter(|(a, b)| a != b).count(),
            _ => 0,
        }
    }
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() / 2).copied().unwrap_or(0.0)
}
