//! Which of all that was timed is taken.

use super::{Measured, SIMPLER};
use crate::plan::{Node, Plan};

/// The number of the fastest, or of something simpler that is hardly slower.
pub(in crate::optimize) fn choose(all: &[Measured]) -> usize {
    let best = all.iter().map(|one| one.total).fold(f64::INFINITY, f64::min);
    let good = (0..all.len()).filter(|&i| all[i].total <= best * SIMPLER);
    let order = |&i: &usize| (!all[i].finalist.is_single, nodes(&all[i].finalist.plan));
    let chosen =
        good.min_by(|a, b| order(a).cmp(&order(b)).then(all[*a].total.total_cmp(&all[*b].total)));
    chosen.expect("at least one was timed")
}

/// How many nodes a plan has.
fn nodes(plan: &Plan) -> usize {
    fn count(node: &Node) -> usize {
        let mut nodes = 1;
        node.visit_children(|_, child| nodes += count(child));
        nodes
    }
    count(&plan.root) + plan.shared.values().map(count).sum::<usize>()
}
