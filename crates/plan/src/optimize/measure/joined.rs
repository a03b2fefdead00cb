//! What is put together of the fastest for each kind of rays.

use super::{Finalist, Measured, Runner, SIMPLER};
use crate::optimize::archive::composed;
use crate::optimize::ray_log::RayLog;
use crate::plan::{Node, Plan};

/// What is fastest for the mix, with something else for each kind of rays that is faster for those; none
/// if there is nothing. And how many seconds it may take to build, all parts anew.
pub(super) fn joined(runners: &[Runner], log: &RayLog) -> Option<(Finalist, f64)> {
    // What is made for some kinds already cannot stand in it.
    let whole: Vec<&Runner> = runners
        .iter()
        .filter(|runner| !matches!(runner.measured.finalist.plan.root, Node::ByKind(_)))
        .collect();
    let least = |of: &dyn Fn(&Measured) -> f64| {
        let of = |runner: &&&Runner| of(&runner.measured);
        whole.iter().min_by(|a, b| of(a).total_cmp(&of(b))).map(|runner| &runner.measured)
    };
    let usual = least(&|measured| measured.mix)?;
    let fastest = |set: usize| -> &Measured {
        let best = least(&|measured| measured.nanos[set]).unwrap_or(usual);
        let is_faster = usual.nanos[set] > SIMPLER * best.nanos[set];
        if is_faster { best } else { usual }
    };
    let parts: Vec<&Measured> = (0..log.sets.len()).map(fastest).collect();
    let plans: Vec<&Plan> = parts.iter().map(|part| &part.finalist.plan).collect();
    let plan = composed(log, &plans)?;
    let seconds = parts.iter().map(|part| part.build_seconds).sum();
    let name = "by kind, as timed".into();
    Some((Finalist { name, plan, predicted: None, is_single: false }, seconds))
}
