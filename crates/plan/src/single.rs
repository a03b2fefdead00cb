//! The plainest plans: one technique over everything.

use std::collections::{BTreeMap, BTreeSet};

use nestray_core::technique;
use nestray_registry as registry;
use nestray_scene::scene::Scene;
use serde_json::{Map, Value};

use crate::error::{PlanError, Problem};
use crate::plan::{Nest, Node, Place, Plan};
use crate::select::{Selection, Term};

/// What `auto` means: the technique that is good at most scenes.
pub const AUTO: &str = "bvh";

/// One technique over everything: over the world, and, once for all its instances, over
/// each group. Below instances a technique that cannot serve there gives way to
/// [`AUTO`].
///
/// # Errors
/// If the technique is not known, or the parts of the scene do not fit together.
pub fn single(
    technique: &str,
    params: Map<String, Value>,
    scene: &Scene,
) -> Result<Plan, PlanError> {
    let technique = if technique == "auto" { AUTO } else { technique };
    let Some(entry) = registry::find(technique) else {
        let problem = Problem::unknown("technique", technique, registry::names());
        return Err(PlanError::at("root/nest/technique", problem));
    };
    scene.check_places()?;
    let below = technique::Place { instances: 1, moving: false };
    let refused = (entry.objection)(&Value::Object(params.clone()), &below);
    let within = match refused {
        Ok(Some(_)) => (AUTO, Map::new()),
        _ => (technique, params.clone()),
    };
    let names = names(scene);
    let mut plan = Plan::new(node(technique, params, scene.root, scene, &names));
    for (&group, name) in &names {
        let (technique, params) = within.clone();
        plan.shared.insert(name.clone(), node(technique, params, group, scene, &names));
    }
    Ok(plan)
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

/// A technique over what stands in a group.
fn node(
    technique: &str,
    params: Map<String, Value>,
    group: usize,
    scene: &Scene,
    names: &BTreeMap<usize, String>,
) -> Node {
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
    Node::Nest(Nest { technique: technique.into(), params, children })
}
