//! Nodes that a search must keep.

use crate::error::{PlanError, Problem};
use crate::plan::{Node, Plan};

/// Nodes that every plan must hold as they are, with all that is in them, wherever they stand.
#[derive(Clone, Debug, Default)]
pub(super) struct Pins(Vec<Node>);

impl Pins {
    /// Nodes of a plan by their paths.
    ///
    /// # Errors
    /// If there is no such node, or no plan.
    pub(super) fn new(plan: Option<&Plan>, paths: &[String]) -> Result<Self, PlanError> {
        let node = |path: &String| {
            let found = plan.and_then(|plan| plan.node(path));
            found.cloned().ok_or_else(|| {
                let nearest = plan.map(|plan| plan.nearest_path(path));
                let (what, name) = ("node".into(), path.clone());
                PlanError::at("pins", Problem::Unknown { what, name, nearest })
            })
        };
        paths.iter().map(node).collect::<Result<_, _>>().map(Self)
    }

    pub(super) fn are_none(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a plan holds them all.
    pub(super) fn are_in(&self, plan: &Plan) -> bool {
        if self.are_none() {
            return true;
        }
        let nodes = plan.nodes();
        self.0.iter().all(|pin| nodes.iter().any(|(_, node)| *node == pin))
    }
}
