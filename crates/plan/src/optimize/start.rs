//! The plans that a search starts from: every technique and preset alone.

use nestray_registry as registry;
use nestray_scene::scene::Scene;
use rayon::prelude::*;

use super::Limits;
use super::archive::{Archive, Goal};
use super::score::Scorer;
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

/// Tries the plan that somebody has already.
///
/// # Errors
/// If it does not fit the scene.
pub(super) fn given(
    plan: &Plan,
    scene: &Scene,
    scorer: &Scorer<'_>,
    limits: &Limits<'_>,
    archive: &mut Archive,
) -> Result<(), PlanError> {
    check(plan, scene)?;
    // What is found is marked in the end.
    let plan = Plan { scene: None, ..plan.clone() };
    let (score, seconds) = limits.score(scorer, &plan);
    archive.efforts.note(&plan, seconds);
    archive.add_given(plan, score?);
    Ok(())
}

/// Techniques that are most often good, each after its own fashion: they come first.
const PROMISING: &[&str] =
    &[AUTO, "light-buffer", "eye-buffer", "reinsertion", "sbvh", "goldsmith-salmon", "slabs"];

/// Tries each single technique, those that promise most first, then each preset of allowed ones, as
/// far as there is time for them. The very first is tried however little may be spent.
///
/// # Errors
/// If the parts of the scene do not fit together, or none of them can be built.
pub(super) fn singles(
    scene: &Scene,
    allowed: &[&'static str],
    scorer: &Scorer<'_>,
    limits: &Limits<'_>,
    archive: &mut Archive,
) -> Result<(), PlanError> {
    /// Plans that are tried side by side.
    const TOGETHER: usize = 4;
    let promise = |name: &&str| PROMISING.iter().position(|other| other == name);
    let mut techniques = allowed.to_vec();
    techniques.sort_by_key(|name| promise(name).unwrap_or(PROMISING.len()));
    let first = techniques.first().copied();
    let others = techniques.iter().copied().skip(1);
    let presets = presets::PRESETS
        .iter()
        .filter(|preset| {
            let nest = preset.nest();
            let uses = |technique: &str| allowed.contains(&technique);
            uses(&nest.technique) && nest.all_leaves().all(|(_, leaves)| uses(&leaves.technique))
        })
        .map(|preset| preset.name);
    let rest: Vec<&str> = others.chain(presets).collect();
    let groups = first.iter().map(std::slice::from_ref).chain(rest.chunks(TOGETHER));
    let mut wrong = None;
    for group in groups {
        let some_known = archive.evaluations() > 0;
        if some_known && limits.reached(archive.evaluations()) {
            break;
        }
        let mut plans = Vec::new();
        let mut seconds = Vec::new();
        for &name in group {
            // The budget may end within a group.
            if some_known && limits.reached(archive.evaluations() + plans.len()) {
                break;
            }
            let plan = single(name, Default::default(), scene)?;
            seconds.push(archive.efforts.expected(&plan));
            if some_known && !limits.is_time_for(&seconds) {
                seconds.pop();
                continue;
            }
            plans.push((name, plan));
        }
        let scores: Vec<_> = plans.par_iter().map(|(_, plan)| limits.score(scorer, plan)).collect();
        for ((name, plan), (score, seconds)) in plans.into_iter().zip(scores) {
            archive.efforts.note(&plan, seconds);
            // A preset is a nest, not a technique alone.
            let alone = allowed.contains(&name).then(|| name.to_owned());
            let score = score.map_err(|error| wrong = Some(error)).ok();
            archive.add(plan, score, alone);
        }
        tell(limits, archive);
    }
    match wrong {
        Some(error) if archive.is_empty() => Err(error),
        _ => Ok(()),
    }
}

/// Says how far it is.
pub(super) fn tell(limits: &Limits<'_>, archive: &Archive) {
    if let Some(&best) = archive.best(Goal::Mix).first() {
        limits.observer().tried(archive.evaluations(), archive.cost(best, Goal::Mix));
    }
}
