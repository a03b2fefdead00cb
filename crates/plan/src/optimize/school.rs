//! Where prices are learnt: plans are built, counted and timed, and kept for later.

use nestray_core::cost::CostModel;
use nestray_core::object::Object as _;

use super::Limits;
use super::archive::Archive;
use super::learn::Lessons;
use super::ray_log::RayLog;
use super::score::{Counted, Scorer};
use super::shelf::Shelf;
use crate::build::build;
use crate::error::PlanError;
use crate::plan::Plan;

/// What prices plans, and what it learnt from.
pub(super) struct School<'a> {
    pub(super) scorer: Scorer<'a>,
    /// What was built.
    pub(super) shelf: Shelf,
    /// None if the same is to be found every time, which clocks do not allow.
    lessons: Option<Lessons>,
}

impl<'a> School<'a> {
    /// The part of the time for changing plans that is left when nests are looked at.
    pub(super) const AGAIN: f64 = 0.5;

    pub(super) fn new(scorer: Scorer<'a>, log: &RayLog, limits: &Limits<'_>) -> Self {
        let lessons = limits.options.evaluations.is_none().then(|| Lessons::new(log));
        Self { scorer, shelf: Shelf::default(), lessons }
    }

    /// Whether anything is learnt.
    pub(super) fn is_open(&self) -> bool {
        self.lessons.is_some()
    }

    /// Builds a plan and counts what rays do; what is built, and how long rays take, is kept for later.
    pub(super) fn attend(
        &mut self,
        plan: &Plan,
        limits: &Limits<'_>,
        archive: &mut Archive,
    ) -> Result<Counted, PlanError> {
        let clock = limits.clock;
        let begun = clock.seconds();
        let world = build(plan, self.scorer.scene())?;
        let build_seconds = clock.seconds() - begun;
        // Not the usual prices: sums by those are kept.
        let bytes = world.cost(&CostModel::usual().clone()).bytes;
        let counted = self.scorer.count(&world);
        archive.efforts.note(plan, clock.seconds() - begun);
        if let Some(lessons) = &mut self.lessons {
            let nanos = self.scorer.price(&counted).nanos;
            lessons.take(&world, (&counted, &nanos), clock);
            // What grows when rays come takes longer to build than was seen.
            if counted.bytes == bytes {
                self.shelf.keep(plan, world, build_seconds, bytes);
            }
        }
        Ok(counted)
    }

    /// Looks at the best nests so far, as far as there is time: what is expected to be good is most
    /// often what was misjudged.
    pub(super) fn look_at_nests(&mut self, limits: &Limits<'_>, archive: &mut Archive) {
        for number in archive.best_nests() {
            let plan = archive.get(number).plan.clone();
            let is_time = limits.is_time_for(&[archive.efforts.expected(&plan)]);
            if is_time && !limits.observer().stop() && !self.shelf.holds(&plan) {
                // It was built before.
                let _ = self.attend(&plan, limits, archive);
            }
        }
    }

    /// Changes prices by what was timed, and prices all that was tried anew.
    pub(super) fn learn(&mut self, archive: &mut Archive) {
        let Some(lessons) = &self.lessons else { return };
        let prices = lessons.prices(self.scorer.prices_before());
        self.scorer.set_prices(prices);
        archive.price_anew(&self.scorer);
    }
}
