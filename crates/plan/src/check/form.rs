//! What can be checked without a scene.

use std::collections::{BTreeMap, BTreeSet};

use nestray_registry::{self as registry, SettingsError};
use serde_json::{Map, Value};

use super::draft::known;
use crate::error::{PlanError, Problem, nearest};
use crate::plan::{Nest, Node, Plan};

/// Checks version, depth, techniques, settings, and that shared subtrees are there, in no
/// circle.
pub(super) fn form(plan: &Plan) -> Result<(), PlanError> {
    if plan.version != Plan::VERSION {
        return Err(PlanError::at("version", Problem::Version(plan.version)));
    }
    let mut heights = Heights { plan, open: Vec::new(), known: BTreeMap::new() };
    heights.of_node("root", &plan.root)?;
    for (name, node) in &plan.shared {
        heights.of_shared(&format!("shared/{name}"), name)?;
        words(&format!("shared/{name}"), node)?;
    }
    words("root", &plan.root)
}

/// Checks that every shared subtree is placed by something that is.
pub(super) fn unused(plan: &Plan) -> Result<(), PlanError> {
    let mut used = BTreeSet::new();
    let mut rest = vec![&plan.root];
    while let Some(node) = rest.pop() {
        match node {
            Node::Place(place) if used.insert(place.shared.as_str()) => {
                rest.push(&plan.shared[&place.shared]);
            }
            _ => node.visit_children(|_, child| rest.push(child)),
        }
    }
    match plan.shared.keys().find(|name| !used.contains(name.as_str())) {
        Some(name) => Err(PlanError::at(format!("shared/{name}"), Problem::Unused)),
        None => Ok(()),
    }
}

/// How many levels there are below shared subtrees.
struct Heights<'a> {
    plan: &'a Plan,
    /// Those being looked at, outermost first.
    open: Vec<&'a str>,
    known: BTreeMap<&'a str, usize>,
}

impl<'a> Heights<'a> {
    /// Levels from a node down; walks on a heap of its own, since a plan made by program can
    /// be of any depth.
    fn of_node(&mut self, path: &str, node: &'a Node) -> Result<usize, PlanError> {
        let (mut rest, mut highest) = (vec![(1, path.to_owned(), node)], 1);
        while let Some((mut level, path, node)) = rest.pop() {
            if let Node::Place(place) = node {
                level += self.of_shared(&format!("{path}/place/shared"), &place.shared)?;
            }
            if let Node::Nest(nest) = node {
                level += nest.all_leaves().count();
            }
            if level > Plan::DEEPEST {
                return Err(PlanError::at(path, Problem::TooDeep));
            }
            highest = highest.max(level);
            let parent = path;
            node.visit_children(|path, child| {
                rest.push((level + 1, format!("{parent}/{path}"), child));
            });
        }
        Ok(highest)
    }

    /// Levels from a shared subtree down.
    fn of_shared(&mut self, path: &str, name: &'a str) -> Result<usize, PlanError> {
        if let Some(&height) = self.known.get(name) {
            return Ok(height);
        }
        if let Some(at) = self.open.iter().position(|&open| open == name) {
            let circle = self.open[at..].iter().chain([&name]).map(|&n| n.to_owned());
            return Err(PlanError::at(path, Problem::Cycle(circle.collect())));
        }
        if self.open.len() > Plan::DEEPEST {
            return Err(PlanError::at(path, Problem::TooDeep));
        }
        let shared = &self.plan.shared;
        let Some(node) = shared.get(name) else {
            let known = shared.keys().map(String::as_str);
            return Err(PlanError::at(path, Problem::unknown("shared subtree", name, known)));
        };
        self.open.push(name);
        let height = self.of_node(&format!("shared/{name}"), node)?;
        self.open.pop();
        self.known.insert(name, height);
        Ok(height)
    }
}

/// Checks the techniques of a subtree that is not too deep, and their settings.
fn words(path: &str, node: &Node) -> Result<(), PlanError> {
    if let Node::Nest(nest) = node {
        settings(&format!("{path}/nest"), &nest.technique, &nest.params)?;
        if !(0.0..=Nest::MOST_OPEN).contains(&nest.open) {
            let range = format!("0 to {}", Nest::MOST_OPEN);
            let error = SettingsError::OutOfRange { setting: "open".into(), range };
            let technique = known(&nest.technique).name;
            let problem = Problem::Settings { technique, error, nearest: None };
            return Err(PlanError::at(format!("{path}/nest/open"), problem));
        }
        for (below, leaves) in nest.all_leaves() {
            settings(&format!("{path}/{below}"), &leaves.technique, &leaves.params)?;
        }
    }
    let mut result = Ok(());
    node.visit_children(|below, child| {
        if result.is_ok() {
            result = words(&format!("{path}/{below}"), child);
        }
    });
    result
}

fn settings(path: &str, technique: &str, params: &Map<String, Value>) -> Result<(), PlanError> {
    let Some(entry) = registry::find(technique) else {
        let problem = Problem::unknown("technique", technique, registry::names());
        return Err(PlanError::at(format!("{path}/technique"), problem));
    };
    let params = Value::Object(params.clone());
    let Err(error) = (entry.neighbours)(&params) else { return Ok(()) };
    let (setting, near) = match &error {
        SettingsError::Unknown { setting, known } => {
            (setting, nearest(setting, known.iter().map(String::as_str)))
        }
        SettingsError::OutOfRange { setting, .. } => (setting, None),
    };
    let path = format!("{path}/params/{setting}");
    let path = path.trim_end_matches('/');
    let problem = Problem::Settings { technique: entry.name, error, nearest: near };
    Err(PlanError::at(path, problem))
}
