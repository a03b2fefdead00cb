//! The plans that a search starts from: every technique and preset alone.

use nestray_core::cost::CostModel;
use nestray_core::object::Object as _;
use nestray_registry as registry;

use super::Limits;
use super::archive::{Archive, Goal, Name};
use super::learn::Lessons;
use super::ray_log::RayLog;
use super::score::{Counted, Scorer};
use super::shelf::Shelf;
use crate::build::build;
use crate::check::check;
use crate::error::{PlanError, Problem};
use crate::plan::Plan;
use crate::presets;
use crate::single::{AUTO, single};

/// Techniques that plans may use, in the order of the registry.
///
/// # Errors
/// If a name is not known.
pub(super) fn allowed(names: &[String]) -> Result<Vec<&'static str>, PlanError> {
    for name in names {
        if registry::find(name).is_none() {
            let problem = Problem::unknown("technique", name, registry::names());
            return Err(PlanError::at("techniques", problem));
        }
    }
    let is_allowed = |name: &&str| names.is_empty() || names.iter().any(|other| other == name);
    Ok(registry::names().filter(is_allowed).collect())
}

/// Techniques that are most often good, each after its own fashion: they come first.
const PROMISING: &[&str] =
    &[AUTO, "light-buffer", "eye-buffer", "sbvh", "slabs", "reinsertion", "goldsmith-salmon"];

/// Part of the time that is not spent on them.
const REST: f64 = 0.4;

/// The start of a search.
pub(super) struct Start<'a, 's> {
    limits: &'a Limits<'a>,
    scorer: &'a mut Scorer<'s>,
    archive: &'a mut Archive,
    shelf: &'a mut Shelf,
    /// None if the same is to be found every time, which clocks do not allow.
    lessons: Option<Lessons>,
    /// What was counted in plans, by their numbers.
    counted: Vec<(usize, Counted)>,
}

impl<'a, 's> Start<'a, 's> {
    pub(super) fn new(
        log: &RayLog,
        limits: &'a Limits<'a>,
        (scorer, archive): (&'a mut Scorer<'s>, &'a mut Archive),
        shelf: &'a mut Shelf,
    ) -> Self {
        let lessons = limits.options.evaluations.is_none().then(|| Lessons::new(log));
        Self { limits, scorer, archive, shelf, lessons, counted: Vec::new() }
    }

    /// Tries the plan that somebody has already.
    ///
    /// # Errors
    /// If it does not fit the scene.
    pub(super) fn given(&mut self, plan: &Plan) -> Result<(), PlanError> {
        check(plan, self.scorer.scene())?;
        // What is found is marked in the end.
        let plan = Plan { scene: None, ..plan.clone() };
        let counted = self.count(&plan)?;
        self.archive.add_given(plan, self.scorer.price(&counted));
        Ok(())
    }

    /// Tries each single technique, those that promise most first, then each preset of allowed ones,
    /// as far as there is time for them. The very first is tried however little may be spent. In
    /// the end prices are changed by what they took.
    ///
    /// # Errors
    /// If the parts of the scene do not fit together, or none of them can be built.
    pub(super) fn singles(&mut self, allowed: &[&'static str]) -> Result<(), PlanError> {
        let mut wrong = None;
        // The rest is for changing them.
        let early = self.limits.earlier(REST);
        for name in in_order(allowed) {
            let is_first = self.archive.evaluations() == 0;
            if !is_first && early.reached(self.archive.evaluations()) {
                break;
            }
            let (Name::Single(word) | Name::Preset(word)) = name else { continue };
            let plan = single(word, Default::default(), self.scorer.scene())?;
            let seconds = self.archive.efforts.expected(&plan);
            if !is_first && !early.is_time_for(&[seconds]) {
                continue;
            }
            let counted = self.count(&plan).map_err(|error| wrong = Some(error)).ok();
            let score = counted.as_ref().map(|counted| self.scorer.price(counted));
            let number = self.archive.add(plan, score, name);
            self.counted.extend(number.zip(counted));
            tell(self.limits, self.archive);
        }
        if let Some(error) = wrong.filter(|_| self.archive.is_empty()) {
            return Err(error);
        }
        self.learn();
        Ok(())
    }

    /// Builds a plan and counts what rays do; what is built, and how long rays take, is kept for later.
    fn count(&mut self, plan: &Plan) -> Result<Counted, PlanError> {
        let clock = self.limits.clock;
        let begun = clock.seconds();
        let world = build(plan, self.scorer.scene())?;
        let build_seconds = clock.seconds() - begun;
        // Not the usual prices: sums by those are kept.
        let bytes = world.cost(&CostModel::usual().clone()).bytes;
        let counted = self.scorer.count(&world);
        self.archive.efforts.note(plan, clock.seconds() - begun);
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

    /// Changes prices by what techniques took, and prices all that was tried anew.
    fn learn(&mut self) {
        let Some(lessons) = &self.lessons else { return };
        let prices = lessons.prices(self.scorer.prices());
        self.scorer.set_prices(prices);
        for (number, counted) in &self.counted {
            self.archive.price_anew(*number, self.scorer.price(counted));
        }
    }
}

/// Techniques, those that promise most first, then the presets that use no others.
fn in_order(allowed: &[&'static str]) -> Vec<Name> {
    let promise = |name: &&str| PROMISING.iter().position(|other| other == name);
    let mut techniques = allowed.to_vec();
    techniques.sort_by_key(|name| promise(name).unwrap_or(PROMISING.len()));
    let presets = presets::PRESETS.iter().filter(|preset| {
        let nest = preset.nest();
        let uses = |technique: &str| allowed.contains(&technique);
        uses(&nest.technique) && nest.all_leaves().all(|(_, leaves)| uses(&leaves.technique))
    });
    let presets = presets.map(|preset| Name::Preset(preset.name));
    techniques.into_iter().map(Name::Single).chain(presets).collect()
}

/// Says how far it is.
pub(super) fn tell(limits: &Limits<'_>, archive: &Archive) {
    if let Some(&best) = archive.best(Goal::Mix).first() {
        limits.observer().tried(archive.evaluations(), archive.cost(best, Goal::Mix));
    }
}
