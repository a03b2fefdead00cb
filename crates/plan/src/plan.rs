//! Plans: meta-hierarchies written down.

pub mod diff;

mod fence;
mod leaves;
mod paths;

use std::collections::BTreeMap;

use nestray_core::by_kind::Case;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use crate::select::Selection;

pub use self::fence::{Bounds, Fence};
pub use self::leaves::Leaves;

/// How a scene is put in order. It names geometry and never holds it; the scene knows
/// nothing of plans.
///
/// In the root stands the world, in a shared subtree the group of whatever instance it is
/// placed for: selections choose among what stands in that group. A plan must hold every
/// geometry and every instance of a group once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Of the format: 1.
    pub version: u32,
    /// The fingerprint of the scene it was made for, if it was made for one; then it is refused
    /// for any other. `nestray inspect` says that of a scene.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    /// Subtrees that instances place, each built once.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub shared: BTreeMap<String, Node>,
    /// The world.
    pub root: Node,
}

/// A part of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Node {
    /// Geometries, by selection. They join the members of the nest they stand in; elsewhere
    /// they make a list.
    Pick(Selection),
    /// A technique over children.
    Nest(Nest),
    /// A shared subtree, wherever the instances put it.
    Place(Place),
    /// One structure for rays of some kinds, another for the rest.
    ByKind(Box<ByKind>),
    /// Built when the first ray reaches it.
    Lazy(Box<Self>),
    /// Tighter bounds around each part of another node.
    Fence(Box<Fence>),
}

/// A technique over children.
///
/// What stands in it is given to the technique in the fastest form there is: meshes alone
/// triangle by triangle, all together, single shapes alone shape by shape. Among other things a
/// shape is an object, and the meshes together are an aggregate of their own by the same technique
/// with the same settings and leaves, or a list if they have no more than [`Nest::TINY`] triangles.
/// Meshes that are seen from other sides, or have more triangles together than can be named, do
/// not come together; a mesh in a nest of its own stays alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nest {
    /// Which technique; the command line lists them.
    pub technique: String,
    /// Its settings; a missing one takes its default.
    #[serde(default, skip_serializing_if = "Map::is_empty")]
    pub params: Map<String, Value>,
    /// What its leaves are put in order by, if not by itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaves: Option<Box<Leaves>>,
    /// How many more children there may be, per instance, if large instances are taken apart:
    /// those of nests over several objects, or with `leaves`. 0 takes none apart.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(range(min = 0.0, max = 1000.0))]
    pub open: f32,
    /// What it puts in order; none is fine.
    #[serde(default)]
    pub children: Vec<Node>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde asks")]
fn is_zero(number: &f32) -> bool {
    *number == 0.0
}

/// A shared subtree, wherever the instances put it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Place {
    /// Which instances of the group: they count from 0 within it.
    pub instance: Selection,
    /// Which shared subtree.
    pub shared: String,
}

/// One structure for rays of some kinds, another for the rest. All must hold the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ByKind {
    /// Rays from the eye.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub camera: Option<Node>,
    /// Rays to any light that is not among `lights`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shadow: Option<Node>,
    /// Rays to one light, by its number in the scene.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub lights: BTreeMap<u16, Node>,
    /// Mirrored rays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reflect: Option<Node>,
    /// Refracted rays.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub refract: Option<Node>,
    /// Diffuse bounces.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diffuse: Option<Node>,
    /// Kinds of the user's own, by number.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub custom: BTreeMap<u8, Node>,
    /// All others.
    pub other: Node,
}

impl Plan {
    /// The format that is read and written.
    pub const VERSION: u32 = 1;
    /// Most levels from the root to a geometry, instances counted too: each takes room on the
    /// stack of whatever walks through it.
    pub const DEEPEST: usize = 192;

    /// A plan without shared subtrees.
    #[must_use]
    pub fn new(root: Node) -> Self {
        Self { version: Self::VERSION, scene: None, shared: BTreeMap::new(), root }
    }

    /// As JSON for people, with a line end.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut text = serde_json::to_string_pretty(self).expect("a plan is plain data");
        text.push('\n');
        text
    }

    /// What it is told apart by: the BLAKE3 hash of its JSON without blanks and with all
    /// names in order.
    #[must_use]
    pub fn hash(&self) -> String {
        let mut value = serde_json::to_value(self).expect("a plan is plain data");
        value.sort_all_objects();
        blake3::hash(value.to_string().as_bytes()).to_hex().to_string()
    }
}

impl Nest {
    /// Most triangles of a mesh that is no aggregate of its own.
    pub const TINY: u32 = 8;
    /// What [`open`](Self::open) is at most.
    pub const MOST_OPEN: f32 = 1000.0;

    /// The techniques for its leaves, and for the leaves of these, each with what leads to it.
    pub fn all_leaves(&self) -> impl Iterator<Item = (String, &Leaves)> {
        let mut path = "nest".to_owned();
        std::iter::successors(self.leaves.as_deref(), |leaves| leaves.leaves.as_deref()).map(
            move |leaves| {
                path.push_str("/leaves");
                (path.clone(), leaves)
            },
        )
    }
}

impl Node {
    /// A technique with its defaults over children.
    #[must_use]
    pub fn nest(technique: impl Into<String>, children: Vec<Self>) -> Self {
        let (technique, params) = (technique.into(), Map::new());
        Self::Nest(Nest { technique, params, leaves: None, open: 0.0, children })
    }

    /// All geometries that are not picked elsewhere.
    #[must_use]
    pub fn rest() -> Self {
        Self::Pick(Selection::rest())
    }

    /// Calls `visit` with each direct child and what leads to it, as in error messages.
    pub fn visit_children<'a>(&'a self, mut visit: impl FnMut(String, &'a Self)) {
        match self {
            Self::Pick(_) | Self::Place(_) => {}
            Self::Nest(nest) => {
                for (i, child) in nest.children.iter().enumerate() {
                    visit(format!("nest/children/{i}"), child);
                }
            }
            Self::ByKind(cases) => {
                for (_, name, node) in cases.cases() {
                    visit(format!("by_kind/{name}"), node);
                }
            }
            Self::Lazy(inner) => visit("lazy".into(), inner),
            Self::Fence(fence) => visit("fence/around".into(), &fence.around),
        }
    }
}

impl ByKind {
    /// The same structure for all rays; set the ones that differ.
    #[must_use]
    pub fn new(other: Node) -> Self {
        Self {
            camera: None,
            shadow: None,
            lights: BTreeMap::new(),
            reflect: None,
            refract: None,
            diffuse: None,
            custom: BTreeMap::new(),
            other,
        }
    }

    /// All cases, each with what leads to it, the more special before the more general;
    /// `other` comes last and is none.
    #[must_use]
    pub fn cases(&self) -> Vec<(Option<Case>, String, &Node)> {
        let mut cases = Vec::new();
        let mut add = |case, name: String, node| cases.push((Some(case), name, node));
        for (case, name, node) in [
            (Case::Camera, "camera", &self.camera),
            (Case::Reflect, "reflect", &self.reflect),
            (Case::Refract, "refract", &self.refract),
            (Case::Diffuse, "diffuse", &self.diffuse),
        ] {
            if let Some(node) = node {
                add(case, name.into(), node);
            }
        }
        for (&light, node) in &self.lights {
            add(Case::Shadow(Some(light)), format!("lights/{light}"), node);
        }
        if let Some(node) = &self.shadow {
            add(Case::Shadow(None), "shadow".into(), node);
        }
        for (&number, node) in &self.custom {
            add(Case::Custom(Some(number)), format!("custom/{number}"), node);
        }
        cases.push((None, "other".into(), &self.other));
        cases
    }
}
