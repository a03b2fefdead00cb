//! Hybrids with names.

use nestray_core::object::DynObject;
use nestray_registry::{self as registry, Members};

use crate::build;
use crate::plan::Nest;

/// A nest of techniques that is known by a name: it can be said wherever a technique can.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// The word for it.
    pub name: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
    /// The nest, as in a plan but without children.
    nest: &'static str,
}

/// Every preset there is.
pub static PRESETS: &[Preset] = &[
    Preset {
        name: "scherson-caspary",
        about: "an octree of little depth, hierarchies of boxes in its cells",
        nest: r#"{ "technique": "octree",
            "params": { "max_depth": 3, "max_leaf": 8, "places": "by-cost" },
            "leaves": { "technique": "bvh", "per_leaf": 256 } }"#,
    },
    Preset {
        name: "snyder-barr",
        about: "grids in the cells of a grid, lists where there is little",
        nest: r#"{ "technique": "grid", "params": { "max_cells": 16 },
            "leaves": { "technique": "grid", "params": { "density": 4.0 }, "more_than": 8 } }"#,
    },
    Preset {
        name: "grid-in-grid",
        about: "grids in the cells of a grid, all as fine as seems cheapest",
        nest: r#"{ "technique": "grid", "leaves": { "technique": "grid", "per_leaf": 256 } }"#,
    },
    Preset {
        name: "grid-over-bvh",
        about: "a coarse grid, hierarchies of boxes in its cells",
        nest: r#"{ "technique": "grid", "params": { "max_cells": 16 },
            "leaves": { "technique": "bvh", "per_leaf": 512 } }"#,
    },
    Preset {
        name: "kd-over-bvh",
        about: "a coarse kd-tree, hierarchies of boxes in its cells",
        nest: r#"{ "technique": "kd-tree", "leaves": { "technique": "bvh", "per_leaf": 1024 } }"#,
    },
    Preset {
        name: "bvh-over-kd",
        about: "a hierarchy of large boxes, a kd-tree in each",
        nest: r#"{ "technique": "bvh", "params": { "max_leaf": 1024 },
            "leaves": { "technique": "kd-tree", "per_leaf": 1024 } }"#,
    },
    Preset {
        name: "bvh-over-grid",
        about: "a hierarchy of large boxes, a grid in each",
        nest: r#"{ "technique": "bvh", "params": { "max_leaf": 256 },
            "leaves": { "technique": "grid", "per_leaf": 256 } }"#,
    },
    Preset {
        name: "lazy-bvh",
        about: "a hierarchy of boxes whose lower levels are built when a ray comes",
        nest: r#"{ "technique": "bvh", "params": { "max_leaf": 4096 },
            "leaves": { "technique": "bvh", "per_leaf": 4096, "lazy": true } }"#,
    },
];

/// The preset called `name`.
#[must_use]
pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name)
}

/// What all techniques and presets are called, techniques first.
pub fn names() -> impl Iterator<Item = &'static str> {
    registry::names().chain(PRESETS.iter().map(|preset| preset.name))
}

impl Preset {
    /// As a part of a plan, without children.
    #[must_use]
    pub fn nest(&self) -> Nest {
        serde_json::from_str(self.nest).expect("the table is sound")
    }

    /// The aggregate over `members`, without a scene.
    #[must_use]
    pub fn build(&self, members: Members) -> DynObject {
        build::over(&self.nest(), members)
    }
}

#[cfg(test)]
mod tests {
    use nestray_scene::scene::Scene;

    use super::*;
    use crate::check::check;
    use crate::plan::{Node, Plan};

    #[test]
    fn presets_are_plans_with_names_of_their_own() {
        for preset in PRESETS {
            let plan = Plan::new(Node::Nest(preset.nest()));
            assert_eq!(check(&plan, &Scene::new()), Ok(()), "{}", preset.name);
            assert!(preset.nest().leaves.is_some(), "{}", preset.name);
            assert_eq!(names().filter(|&name| name == preset.name).count(), 1, "{}", preset.name);
        }
    }
}
