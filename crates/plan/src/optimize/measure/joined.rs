//! What is put together of the fastest for each kind of rays.

use std::sync::Arc;

use nestray_core::by_kind::ByKind;
use nestray_core::object::DynObject;

use super::{Built, Finalist, Measured, Runner, SIMPLER};
use crate::optimize::archive::composed;
use crate::optimize::ray_log::RayLog;
use crate::plan::{Node, Plan};

/// What is fastest for the mix, with something else for each kind of rays that is faster for those; none
/// if there is nothing. The parts are those that were timed; they count as built anew.
pub(super) fn joined(runners: &[Runner], log: &RayLog) -> Option<Built> {
    // What is made for some kinds already cannot stand in it.
    let whole: Vec<&Runner> = runners
        .iter()
        .filter(|runner| !matches!(runner.measured.finalist.plan.root, Node::ByKind(_)))
        .collect();
    let least = |of: &dyn Fn(&Measured) -> f64| -> Option<&Runner> {
        let of = |runner: &&&Runner| of(&runner.measured);
        whole.iter().min_by(|a, b| of(a).total_cmp(&of(b))).copied()
    };
    let usual = least(&|measured| measured.mix)?;
    let fastest = |set: usize| -> &Runner {
        let best = least(&|measured| measured.nanos[set]).unwrap_or(usual);
        let is_faster = usual.measured.nanos[set] > SIMPLER * best.measured.nanos[set];
        if is_faster { best } else { usual }
    };
    let parts: Vec<&Runner> = (0..log.sets.len()).map(fastest).collect();
    let plans: Vec<&Plan> = parts.iter().map(|part| &part.measured.finalist.plan).collect();
    let plan = composed(log, &plans)?;
    let mut cases = Vec::new();
    let mut build_seconds = usual.measured.build_seconds;
    for (set, part) in log.sets.iter().zip(&parts) {
        if std::ptr::eq(*part, usual) {
            continue;
        }
        cases.push((set.case()?, part.world.clone()));
        build_seconds += part.measured.build_seconds;
    }
    let world: DynObject = Arc::new(ByKind::new(cases, usual.world.clone()));
    let name = "by kind, as timed".into();
    let finalist = Finalist { name, plan, predicted: None, is_single: false };
    Some(Built { finalist, world, build_seconds })
}
