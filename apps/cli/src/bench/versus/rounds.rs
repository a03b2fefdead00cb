//! Libraries that shoot the same rays in turns, on this thread.

use std::time::Duration;

use nestray_peers::clock::timed;
use nestray_peers::peer::{Peer, Way};
use nestray_peers::rays::{HitRecord, RayRecord};

use crate::bench::sets::RaySet;
use crate::errors::Failure;
use crate::stop;

/// How long the first of the contenders shoots in one turn: of a hard set fewer rays are taken,
/// the same for all.
const TURN: Duration = Duration::from_millis(600);
/// How many times as long others may shoot: what is slower gets fewer rays.
const PATIENCE: u32 = 6;
/// Neighbours that stay together when not all rays are taken: four tiles of a picture.
const BLOCK: usize = 1024;
/// Distances that differ by more of themselves, and by more than rounding, are not the same.
const NEAR: f32 = 1e-3;

/// A library and the way in which it is asked.
#[derive(Clone, Copy)]
pub(super) struct Contender<'a> {
    pub(super) peer: &'a dyn Peer,
    pub(super) way: Way,
}

/// What one contender took for the rays of one set.
pub(super) struct Taken {
    /// So many rays were shot in a turn.
    pub(super) rays: usize,
    /// Median of millions of rays per second of processor time.
    pub(super) rate: f64,
    /// Each turn of its own.
    pub(super) rates: Vec<f64>,
    /// Rays that hit something for one only, itself or the first contender.
    pub(super) other_hits: usize,
    /// Rays that both see hit, but not in the same distance.
    pub(super) other_distances: usize,
}

/// Answers to one set, of which one list is used.
#[derive(Default)]
struct Answers {
    hits: Vec<HitRecord>,
    blocked: Vec<bool>,
}

/// Lets all contenders shoot `rounds` times. The first is the one that the others' answers are
/// held against.
pub(super) fn run(
    contenders: &[Contender<'_>],
    set: &RaySet,
    rounds: usize,
) -> Result<Vec<Taken>, Failure> {
    let Some(&first) = contenders.first() else { return Ok(Vec::new()) };
    let fit = fit(first, set, &set.rays, TURN);
    let common = spread(&set.rays, fit);
    let all: Vec<Vec<RayRecord>> = contenders
        .iter()
        .map(|&one| {
            let fit = self::fit(one, set, &common, TURN * PATIENCE);
            spread(&common, fit)
        })
        .collect();
    let mut answers: Vec<Answers> = contenders.iter().map(|_| Answers::default()).collect();
    let mut rates = vec![Vec::new(); contenders.len()];
    for _ in 0..rounds {
        for (i, &contender) in contenders.iter().enumerate() {
            stop::check()?;
            let ((), time) = timed(|| shoot(contender, set, &all[i], &mut answers[i]));
            rates[i].push(all[i].len() as f64 / time.as_secs_f64().max(1e-9) / 1e6);
        }
    }
    let taken = all.iter().zip(&answers).zip(rates).map(|((rays, answer), rates)| {
        let (other_hits, other_distances) =
            answers[0].unlike(answer, common.len(), rays.len(), set.rounding);
        let rate = median(&rates);
        Taken { rays: rays.len(), rate, rates, other_hits, other_distances }
    });
    Ok(taken.collect())
}

fn shoot(contender: Contender<'_>, set: &RaySet, rays: &[RayRecord], answers: &mut Answers) {
    let Contender { peer, way } = contender;
    if set.any {
        answers.blocked.resize(rays.len(), false);
        peer.any(way, set.kind, rays, &mut answers.blocked);
    } else {
        answers.hits.resize(rays.len(), HitRecord::MISS);
        peer.closest(way, set.kind, rays, &mut answers.hits);
    }
}

/// How many of the rays can be shot in a time.
fn fit(contender: Contender<'_>, set: &RaySet, rays: &[RayRecord], time: Duration) -> usize {
    let mut answers = Answers::default();
    let mut count = BLOCK.min(rays.len());
    loop {
        let some = spread(rays, count);
        let ((), took) = timed(|| shoot(contender, set, &some, &mut answers));
        let fit = (count as f64 * time.as_secs_f64() / took.as_secs_f64().max(1e-9)) as usize;
        if fit <= 8 * count || count == rays.len() {
            return fit.clamp(BLOCK.min(rays.len()), rays.len());
        }
        count = (4 * count).min(rays.len());
    }
}

/// Numbers of the blocks of about `count` out of `all`, spread evenly.
fn blocks(all: usize, count: usize) -> impl Iterator<Item = usize> {
    let (of, wanted) = (all.div_ceil(BLOCK), count.div_ceil(BLOCK).max(1));
    (0..wanted.min(of)).map(move |i| i * of / wanted.min(of))
}

/// About `count` of `all`, in blocks of neighbours.
fn spread<T: Copy>(all: &[T], count: usize) -> Vec<T> {
    let block = |i: usize| &all[i * BLOCK..((i + 1) * BLOCK).min(all.len())];
    blocks(all.len(), count).flat_map(block).copied().collect()
}

impl Answers {
    /// How many answers of another, who was asked `count` of the `all` rays, are not these: hit or
    /// not, and hit elsewhere.
    fn unlike(&self, other: &Self, all: usize, count: usize, rounding: f32) -> (usize, usize) {
        if !self.blocked.is_empty() {
            let own = spread(&self.blocked[..all], count);
            return (own.iter().zip(&other.blocked).filter(|(a, b)| a != b).count(), 0);
        }
        let is_hit = |hit: &HitRecord| hit.primitive != HitRecord::MISS.primitive;
        let (mut hits, mut distances) = (0, 0);
        for (a, b) in spread(&self.hits[..all], count).iter().zip(&other.hits) {
            if is_hit(a) != is_hit(b) {
                hits += 1;
            } else if is_hit(a) && (a.t - b.t).abs() > NEAR * a.t.abs().max(b.t.abs()) + rounding {
                distances += 1;
            }
        }
        (hits, distances)
    }
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted.get(sorted.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_spread_and_stay_whole() {
        let all: Vec<usize> = (0..10_500).collect();
        assert_eq!(spread(&all, all.len()), all);
        let some = spread(&all, 3000);
        assert_eq!(some.len(), 3 * BLOCK);
        assert!(some[..BLOCK] == all[..BLOCK] && some[BLOCK] == 3 * BLOCK);
        assert_eq!(spread(&all[..10], 1), all[..10]);
    }

    #[test]
    fn answers_are_held_against_the_first() {
        let hit = |t: f32| HitRecord { t, uv: [0.0; 2], primitive: 3 };
        let own = Answers { hits: vec![hit(1.0), hit(2.0), HitRecord::MISS], blocked: vec![] };
        let other = Answers { hits: vec![hit(1.0001), hit(2.1), hit(1.0)], blocked: vec![] };
        assert_eq!(own.unlike(&other, 3, 3, 0.01), (1, 1));
        assert_eq!(own.unlike(&other, 3, 3, 0.2), (1, 0));
        assert_eq!(own.unlike(&own, 3, 3, 0.0), (0, 0));
    }
}
