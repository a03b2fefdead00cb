//! The plans that a search starts from: every technique and preset alone.

use nestray_registry as registry;

use super::Limits;
use super::archive::{Archive, Goal, Name};
use super::school::School;
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

/// Tries the plan that somebody has already.
///
/// # Errors
/// If it does not fit the scene.
pub(super) fn given(
    plan: &Plan,
    limits: &Limits<'_>,
    archive: &mut Archive,
    school: &mut School<'_>,
) -> Result<(), PlanError> {
    check(plan, school.scorer.scene())?;
    // What is found is marked in the end.
    let plan = Plan { scene: None, ..plan.clone() };
    let counted = school.attend(&plan, limits, archive)?;
    archive.add_given(plan, counted, &school.scorer);
    Ok(())
}

/// Tries each single technique, those that promise most first, then each preset of allowed ones,
/// as far as there is time for them. The very first is tried however little may be spent.
///
/// # Errors
/// If the parts of the scene do not fit together, or none of them can be built.
pub(super) fn singles(
    allowed: &[&'static str],
    limits: &Limits<'_>,
    archive: &mut Archive,
    school: &mut School<'_>,
) -> Result<(), PlanError> {
    let mut wrong = None;
    // The rest is for changing them.
    let early = limits.earlier(REST);
    for name in in_order(allowed) {
        let is_first = archive.evaluations() == 0;
        if !is_first && early.reached(archive.evaluations()) {
            break;
        }
        let (Name::Single(word) | Name::Preset(word)) = name else { continue };
        let plan = single(word, Default::default(), school.scorer.scene())?;
        let seconds = archive.efforts.expected(&plan);
        if !is_first && !early.is_time_for(&[seconds]) {
            continue;
        }
        let counted = school.attend(&plan, limits, archive);
        let counted = counted.map_err(|error| wrong = Some(error)).ok();
        archive.add(plan, counted, name, &school.scorer);
        tell(limits, archive);
    }
    match wrong {
        Some(error) if archive.is_empty() => Err(error),
        _ => Ok(()),
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
