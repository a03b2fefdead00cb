//! From a plan and a scene to the objects.

mod fences;
mod open;
mod order;
mod recipe;
mod rests;

use nestray_core::object::DynObject;
use nestray_registry::Members;
use nestray_scene::scene::Scene;

pub(crate) use self::order::Order;
use self::order::Whole;
use self::recipe::recipe;
use crate::check::{order, resolve};
use crate::error::PlanError;
use crate::fingerprint;
use crate::plan::{Nest, Plan};

/// The objects of a plan. Hits name geometries, primitives and instances as the scene counts
/// them, whatever the plan; the same plan and scene make the same objects.
///
/// Nodes of an animation stand where they are at its start: ask for a
/// [`frame`](Scene::frame) of the scene first.
///
/// # Errors
/// If the plan does not pass [`check`](crate::check::check).
pub fn build(plan: &Plan, scene: &Scene) -> Result<DynObject, PlanError> {
    Builder::new(plan).build(scene)
}

/// A nest over these members instead of its children; it must be sound.
pub(crate) fn over(nest: &Nest, members: Members) -> DynObject {
    order(nest).build(members).object
}

/// Builds the objects of a plan for one frame of a scene after the other. Shared subtrees in
/// which nothing moved since the frame before are kept.
#[expect(missing_debug_implementations, reason = "objects say what they are by other ways")]
pub struct Builder<'a> {
    plan: &'a Plan,
    /// The frame before, and its shared subtrees.
    before: Option<(Scene, Vec<Whole>)>,
}

impl<'a> Builder<'a> {
    /// For this plan.
    #[must_use]
    pub fn new(plan: &'a Plan) -> Self {
        Self { plan, before: None }
    }

    /// The objects for a scene; see [`build()`].
    ///
    /// # Errors
    /// If the plan does not pass [`check`](crate::check::check).
    pub fn build(&mut self, scene: &Scene) -> Result<DynObject, PlanError> {
        let resolved = resolve(self.plan, scene)?;
        if self.before.is_none() {
            // Frames of one scene do not differ in it.
            fingerprint::check(self.plan, scene)?;
        }
        let rests = match &self.before {
            Some((before, _)) => rests::rests(before, scene),
            None => vec![false; scene.groups.len()],
        };
        let mut shared = Vec::with_capacity(resolved.subtrees.len());
        for (i, (group, tree)) in resolved.subtrees.iter().enumerate() {
            shared.push(match &self.before {
                Some((_, before)) if rests[*group] => before[i].clone(),
                _ => recipe(tree, *group, scene, &resolved, &shared).whole(),
            });
        }
        let root = recipe(&resolved.root, scene.root, scene, &resolved, &shared).whole();
        self.before = Some((scene.clone(), shared));
        Ok(root.object)
    }
}

#[cfg(test)]
mod hybrids;
#[cfg(test)]
mod openings;
#[cfg(test)]
mod tests;
