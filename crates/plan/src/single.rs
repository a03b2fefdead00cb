//! The plainest plans: one technique over everything.

use std::collections::{BTreeMap, BTreeSet};

use nestray_core::technique;
use nestray_registry as registry;
use nestray_scene::scene::Scene;
use serde_json::{Map, Value};

use crate::error::{PlanError, Problem};
use crate::plan::{Nest, Node, Place, Plan};
use crate::presets;
use crate::select::{Selection, Term};

/// What `auto` means: the technique that is good at most scenes.
pub const AUTO: &str = "bvh";

/// One technique, or one [preset](crate::presets), over everything: over the world, and, once for
/// all its instances, over each group. Settings are those of the technique, of a preset those of
/// its uppermost. Below instances a technique that cannot serve there gives way to [`AUTO`].
///
/// # Errors
/// If the technique is not known, or the parts of the scene do not fit together.
pub fn single(
    technique: &str,
    params: Map<String, Value>,
    scene: &Scene,
) -> Result<Plan, PlanError> {
    let mut nest = nest(technique).ok_or_else(|| {
        let problem = Problem::unknown("technique", technique, presets::names());
        PlanError::at("root/nest/technique", problem)
    })?;
    nest.params.extend(params);
    scene.check_places()?;
    let within = if serves_below(&nest) { nest.clone() } else { plain(AUTO) };
    let names = names(scene);
    let mut plan = Plan::new(node(nest, scene.root, scene, &names));
    for (&group, name) in &names {
        plan.shared.insert(name.clone(), node(within.clone(), group, scene, &names));
    }
    Ok(plan)
}

/// What a name means, without children.
fn nest(name: &str) -> Option<Nest> {
    let technique = if name == "auto" { AUTO } else { name };
    match presets::find(technique) {
        Some(preset) => Some(preset.nest()),
        None => registry::find(technique).map(|entry| plain(entry.name)),
    }
}

fn plain(technique: &str) -> Nest {
    let technique = technique.into();
    Nest { technique, params: Map::new(), leaves: None, open: 0.0, children: Vec::new() }
}

/// Whether nothing in a nest objects to a place below an instance.
fn serves_below(nest: &Nest) -> bool {
    let below = technique::Place { instances: 1, moving: false };
    let serves = |technique: &str, params: &Map<String, Value>| {
        registry::find(technique).is_some_and(|entry| {
            let objection = (entry.objection)(&Value::Object(params.clone()), &below);
            // What is wrong with settings is said by whoever checks the plan.
            !matches!(objection, Ok(Some(_)))
        })
    };
    serves(&nest.technique, &nest.params)
        && nest.all_leaves().all(|(_, leaves)| serves(&leaves.technique, &leaves.params))
}

/// What to call each group that stands somewhere.
fn names(scene: &Scene) -> BTreeMap<usize, String> {
    let (mut seen, mut rest) = (BTreeSet::new(), vec![scene.root]);
    while let Some(group) = rest.pop() {
        for place in &scene.groups[group].places {
            if seen.insert(place.group) {
                rest.push(place.group);
            }
        }
    }
    let mut used = BTreeSet::new();
    let name = |group: usize| {
        let own = &scene.groups[group].name;
        let numbered = format!("group {group}");
        let name = if own.is_empty() || own.contains('/') { &numbered } else { own };
        if used.insert(name.clone()) { name.clone() } else { format!("{name} ({group})") }
    };
    let names: Vec<String> = seen.iter().copied().map(name).collect();
    seen.into_iter().zip(names).collect()
}

/// A nest over what stands in a group.
fn node(nest: Nest, group: usize, scene: &Scene, names: &BTreeMap<usize, String>) -> Node {
    let mut children = Vec::new();
    if !scene.groups[group].geometries.is_empty() {
        children.push(Node::Pick(Selection::all()));
    }
    let inner: BTreeSet<usize> = scene.groups[group].places.iter().map(|p| p.group).collect();
    for group in &inner {
        let instance = if inner.len() == 1 {
            Selection::all()
        } else {
            Selection(vec![Term::Group(group.to_string())])
        };
        children.push(Node::Place(Place { instance, shared: names[group].clone() }));
    }
    Node::Nest(Nest { children, ..nest })
}
