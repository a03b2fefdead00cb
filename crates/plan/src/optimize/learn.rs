//! What steps and tests cost in this very scene.
//!
//! Prices are of many scenes together; here a test may hit more often than there, or what is tested lie
//! nearer together. So each technique is timed as soon as it was tried, for some milliseconds, and
//! prices are changed as far as that explains the times.

use nestray_core::object::DynObject;

use super::clock::Clock;
use super::measure::shots::{per_ray, shoot};
use super::ray_log::{RayLog, RaySet};
use super::score::Counted;
use crate::prices::Prices;
use crate::prices::fit::{self, Run};

/// Rays of each set that are timed, at least and at most. With fewer, chance decides what they meet,
/// and all of it is in the caches the second time.
const RAYS: [f64; 2] = [1024.0, 16_384.0];
/// Nanoseconds that a turn with the rays of a set should take.
const TURN: f64 = 6e6;
/// So many times as dear as the cheapest so far, nobody wants to know how slow something is.
const SLOW: f64 = 6.0;
/// How much the prices from before weigh against one run.
const PRIOR: f64 = 0.02;

/// What techniques took.
#[derive(Debug)]
pub(super) struct Lessons {
    sets: Vec<Lesson>,
}

/// The rays of a set.
#[derive(Debug)]
struct Lesson {
    /// The same for all, once it is known how many there is time for: some rays take a hundred times
    /// as long as others.
    rays: RaySet,
    /// The least that a ray was expected to take.
    least: f64,
    runs: Vec<Run>,
}

impl Lessons {
    pub(super) fn new(log: &RayLog) -> Self {
        let lesson =
            |set: &RaySet| Lesson { rays: set.clone(), least: f64::INFINITY, runs: Vec::new() };
        Self { sets: log.sets.iter().map(lesson).collect() }
    }

    /// Times a world in which rays did what was counted, and are expected to take `nanos` each.
    pub(super) fn take(
        &mut self,
        world: &DynObject,
        (counted, nanos): (&Counted, &[f64]),
        clock: &dyn Clock,
    ) {
        for ((lesson, did), &expected) in self.sets.iter_mut().zip(&counted.sets).zip(nanos) {
            let Some(nanos) = lesson.time(world, expected, clock) else { continue };
            lesson.runs.push(Run {
                scene: String::new(),
                neighbours: did.neighbours,
                tally: did.tally.clone(),
                rays: did.rays,
                bytes: counted.bytes,
                nanos,
                weight: 1.0,
            });
        }
    }

    /// Prices that explain what was timed, and are else as they were. What is fastest counts most.
    pub(super) fn prices(&self, before: &Prices) -> Prices {
        let mut all = Vec::new();
        for Lesson { runs, .. } in &self.sets {
            let least = runs.iter().map(|run| run.nanos).fold(f64::INFINITY, f64::min);
            all.extend(runs.iter().map(|run| Run { weight: least / run.nanos, ..run.clone() }));
        }
        fit::prices(&all, before, PRIOR)
    }
}

impl Lesson {
    /// Nanoseconds that a ray takes; none if nobody wants to know.
    fn time(&mut self, world: &DynObject, expected: f64, clock: &dyn Clock) -> Option<f64> {
        if self.least == f64::INFINITY {
            let [least, most] = RAYS;
            let count = (TURN / expected.max(f64::MIN_POSITIVE)).clamp(least, most);
            self.rays = self.rays.thinned(count as usize);
        }
        if expected > SLOW * self.least {
            return None;
        }
        self.least = self.least.min(expected);
        // What is built late is there the second time.
        let turns = [0; 2].map(|_| per_ray(shoot(world, &self.rays, clock).worked, &self.rays));
        Some(turns[0].min(turns[1])).filter(|nanos| *nanos > 0.0)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicU32, Ordering};

    use glam::Vec3A;
    use nestray_core::ray::{Ray, RayKind};
    use nestray_scene::procedural::generate;

    use super::*;
    use crate::build::build;
    use crate::optimize::score::Scorer;
    use crate::single::single;

    /// A clock on which a thread works for a millisecond between any two looks.
    #[derive(Debug, Default)]
    struct Even(AtomicU32);

    impl Clock for Even {
        fn seconds(&self) -> f64 {
            0.0
        }

        fn worked(&self) -> f64 {
            f64::from(self.0.fetch_add(1, Ordering::Relaxed)) * 1e-3
        }
    }

    #[test]
    fn prices_explain_what_was_timed_and_slow_plans_are_not() {
        let scene = generate("balls", Some(2)).expect("there is one");
        let center = scene.bounds().center();
        let ray = |i: u32| {
            let from = center + Vec3A::new(0.3, 9.0, (i % 64) as f32 / 32.0 - 1.0);
            Ray::new(from, center - from, RayKind::Camera)
        };
        let rays = (0..4096).map(ray).collect();
        let set = RaySet { name: "camera".into(), rays, any: false, weight: 1.0 };
        let log = RayLog::new(vec![set]);
        let mut scorer = Scorer::new(&scene, &log, Prices::usual(), u64::MAX);
        let mut lessons = Lessons::new(&log);
        let mut all = Vec::new();
        for technique in ["bvh", "sbvh", "list"] {
            let plan = single(technique, Default::default(), &scene).expect("it is sound");
            let world = build(&plan, &scene).expect("it is sound");
            let counted = scorer.count(&world);
            let nanos = scorer.price(&counted).nanos;
            lessons.take(&world, (&counted, &nanos), &Even::default());
            all.push(counted);
        }
        assert_eq!(lessons.sets[0].runs.len(), 2, "a list is slow");
        let truth = 1e6 / lessons.sets[0].rays.rays.len() as f64;
        let before = scorer.price(&all[0]).nanos[0];
        scorer.set_prices(lessons.prices(scorer.prices_before()));
        let after = scorer.price(&all[0]).nanos[0];
        assert!((before / truth - 1.0).abs() > 0.5, "nothing was to be learnt: {before} {truth}");
        assert!(
            (after / truth - 1.0).abs() < 0.2,
            "{before} before, {after} now, {truth} in truth"
        );
    }
}
