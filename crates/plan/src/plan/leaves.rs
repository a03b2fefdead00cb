//! Techniques for the leaves of others.

use std::num::NonZeroU32;

use nestray_registry::hybrid::Filling;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// A technique for the leaves of another.
///
/// The technique above is asked what it would put in its leaves; its settings decide how much.
/// A child that would be in several leaves is given to the one it fits best. What is in a leaf of
/// more than `more_than` children becomes an aggregate by this technique, and the technique
/// above orders these aggregates and all else. Children without bounds stay above.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Leaves {
    /// Which technique; the command line lists them.
    pub technique: String,
    /// Its settings; a missing one takes its default.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub params: Map<String, Value>,
    /// Leaves of so many children or fewer are left as they are.
    #[serde(default = "more_than")]
    pub more_than: NonZeroU32,
    /// How many children in one leaf the technique above may take to be as cheap as a few of
    /// them are alone.
    #[serde(default = "per_leaf")]
    pub per_leaf: NonZeroU32,
    /// Whether a leaf is put in order when the first ray comes to it.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub lazy: bool,
    /// What the leaves of this technique are put in order by, if not by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaves: Option<Box<Self>>,
}

impl Leaves {
    /// A technique with its defaults.
    #[must_use]
    pub fn new(technique: impl Into<String>) -> Self {
        Self {
            technique: technique.into(),
            params: Map::new(),
            more_than: more_than(),
            per_leaf: per_leaf(),
            lazy: false,
            leaves: None,
        }
    }
}

fn more_than() -> NonZeroU32 {
    NonZeroU32::new(Filling::MORE_THAN).expect("it is not zero")
}

fn per_leaf() -> NonZeroU32 {
    NonZeroU32::new(Filling::PER_LEAF).expect("it is not zero")
}
