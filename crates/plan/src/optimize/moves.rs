//! One step from a plan to another, after [Arvo 90]: move an object, substitute a technique, split
//! an aggregate, and back.

use nestray_registry as registry;
use nestray_scene::scene::Scene;
use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use serde_json::{Map, Value};

use crate::plan::{Bounds, Fence, Leaves, Nest, Node, Plan};

mod parts;

/// What can be done to a plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Move {
    /// Another technique for a nest.
    Substitute,
    /// Settings one step away.
    Retune,
    /// A technique for the leaves of a nest, or another one.
    Fill,
    /// The leaves of a nest as they are.
    Unfill,
    /// More or fewer children in the leaves that have a technique.
    Resize,
    /// More or fewer of the instances taken apart.
    Open,
    /// A nest in two, each with a part of its geometries.
    Split,
    /// The children of a nest in the nest above.
    Dissolve,
    /// Two nests side by side as one.
    Merge,
    /// A geometry from one nest to another.
    Transfer,
    /// Tighter bounds around a child of a nest, or none.
    Fence,
}

/// How often each is tried, in proportion.
const MOVES: &[(Move, u32)] = &[
    (Move::Substitute, 20),
    (Move::Retune, 30),
    (Move::Fill, 12),
    (Move::Unfill, 6),
    (Move::Resize, 8),
    (Move::Open, 6),
    (Move::Split, 8),
    (Move::Dissolve, 6),
    (Move::Merge, 4),
    (Move::Transfer, 8),
    (Move::Fence, 4),
];

impl Move {
    /// The word for it in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Substitute => "substitute",
            Self::Retune => "retune",
            Self::Fill => "fill",
            Self::Unfill => "unfill",
            Self::Resize => "resize",
            Self::Open => "open",
            Self::Split => "split",
            Self::Dissolve => "dissolve",
            Self::Merge => "merge",
            Self::Transfer => "transfer",
            Self::Fence => "fence",
        }
    }

    /// One of them, by how often it is to be tried.
    pub fn random(numbers: &mut Pcg64Mcg) -> Self {
        let all: u32 = MOVES.iter().map(|(_, often)| often).sum();
        let mut pick = numbers.random_range(0..all);
        for &(step, often) in MOVES {
            if pick < often {
                return step;
            }
            pick -= often;
        }
        unreachable!("the shares add up")
    }

    /// A plan one such step away; none if the step is not possible where it was tried. It may be
    /// one that does not pass [`check`](crate::check::check).
    #[must_use]
    pub fn apply(
        self,
        plan: &Plan,
        scene: &Scene,
        allowed: &[&'static str],
        numbers: &mut Pcg64Mcg,
    ) -> Option<Plan> {
        let mut plan = plan.clone();
        let count = parts::nests(&plan);
        let at = numbers.random_range(0..count.max(1));
        match self {
            Self::Split => parts::split(parts::root_nest(&mut plan, at)?, scene, numbers)?,
            Self::Transfer => parts::transfer(&mut plan, scene, numbers)?,
            _ => {
                let nest = parts::nest(&mut plan, at)?;
                match self {
                    Self::Substitute => substitute(nest, allowed, numbers)?,
                    Self::Retune => retune(&nest.technique.clone(), &mut nest.params, numbers)?,
                    Self::Fill => fill(nest, allowed, numbers)?,
                    Self::Unfill => drop(nest.leaves.take()?),
                    Self::Resize => resize(nest.leaves.as_mut()?, numbers)?,
                    Self::Open => open(nest, numbers)?,
                    Self::Dissolve => parts::dissolve(nest, numbers)?,
                    Self::Merge => parts::merge(nest, numbers)?,
                    Self::Fence => fence(nest, numbers)?,
                    Self::Split | Self::Transfer => unreachable!("done above"),
                }
            }
        }
        Some(plan)
    }
}

/// One of some.
fn pick<'a, T>(from: &'a [T], numbers: &mut Pcg64Mcg) -> Option<&'a T> {
    (!from.is_empty()).then(|| &from[numbers.random_range(0..from.len())])
}

fn substitute(nest: &mut Nest, allowed: &[&str], numbers: &mut Pcg64Mcg) -> Option<()> {
    let technique = *pick(allowed, numbers)?;
    if technique == nest.technique {
        return None;
    }
    nest.technique = technique.into();
    nest.params = Map::new();
    Some(())
}

/// Settings a step away; those that are the default are left out.
fn retune(technique: &str, params: &mut Map<String, Value>, numbers: &mut Pcg64Mcg) -> Option<()> {
    let entry = registry::find(technique)?;
    let near = (entry.neighbours)(&Value::Object(params.clone())).ok()?;
    let Value::Object(next) = pick(&near, numbers)?.clone() else { return None };
    let defaults = (entry.defaults)();
    *params = next.into_iter().filter(|(name, value)| defaults.get(name) != Some(value)).collect();
    Some(())
}

fn fill(nest: &mut Nest, allowed: &[&str], numbers: &mut Pcg64Mcg) -> Option<()> {
    let technique = *pick(allowed, numbers)?;
    match &mut nest.leaves {
        Some(leaves) if leaves.technique == technique => {
            let technique = leaves.technique.clone();
            retune(&technique, &mut leaves.params, numbers)?;
        }
        Some(leaves) => {
            leaves.technique = technique.into();
            leaves.params = Map::new();
        }
        none => *none = Some(Box::new(Leaves::new(technique))),
    }
    Some(())
}

fn resize(leaves: &mut Leaves, numbers: &mut Pcg64Mcg) -> Option<()> {
    let size = leaves.per_leaf.get();
    let next = if numbers.random() { size.checked_mul(2)? } else { size / 2 };
    if !(8..=1 << 16).contains(&next) {
        return None;
    }
    leaves.per_leaf = next.try_into().ok()?;
    Some(())
}

fn open(nest: &mut Nest, numbers: &mut Pcg64Mcg) -> Option<()> {
    const STEPS: &[f32] = &[0.0, 0.5, 1.0, 2.0, 4.0, 8.0];
    let has_places = nest.children.iter().any(|child| matches!(child, Node::Place(_)));
    let next = *pick(STEPS, numbers)?;
    (has_places && next != nest.open).then(|| nest.open = next)
}

fn fence(nest: &mut Nest, numbers: &mut Pcg64Mcg) -> Option<()> {
    let count = nest.children.len();
    let child = nest.children.get_mut(numbers.random_range(0..count.max(1)))?;
    let by = *pick(&[Bounds::Cheapest, Bounds::TurnedBox, Bounds::ThirteenSlabs], numbers)?;
    let old = std::mem::replace(child, Node::rest());
    *child = match old {
        Node::Fence(fence) => fence.around,
        around => Node::Fence(Box::new(Fence { by, around })),
    };
    Some(())
}
