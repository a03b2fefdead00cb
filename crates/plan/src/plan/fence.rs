//! Fences, as plans write them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Node;

/// Tighter bounds than its box around each part of another node: each shape, nest or instance
/// that is dear to test. A mesh that is picked is no part of its own: fence a nest of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fence {
    /// Which bounds.
    #[serde(default)]
    pub by: Bounds,
    /// What they are put around.
    pub around: Node,
}

/// Bounds tighter than a box along the axes.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "snake_case")]
pub enum Bounds {
    /// Whichever of the others saves most, where one saves more than it costs.
    #[default]
    Cheapest,
    /// A box turned as the part is.
    TurnedBox,
    /// Thirteen slabs.
    ThirteenSlabs,
}

impl Bounds {
    /// As it is written in a plan.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cheapest => "cheapest",
            Self::TurnedBox => "turned_box",
            Self::ThirteenSlabs => "thirteen_slabs",
        }
    }
}
