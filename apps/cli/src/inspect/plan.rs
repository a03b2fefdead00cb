//! What is in a plan.

use std::fmt::Write as _;
use std::path::Path;

use nestray::plan::check::check_form;
use nestray::plan::plan::{Node, Plan};
use serde_json::json;

use super::Report;
use crate::args::InspectArgs;
use crate::errors::Failure;
use crate::input;

pub(super) fn report(path: &Path, args: &InspectArgs) -> Result<Report, Failure> {
    if args.ray.is_some() {
        let failure = Failure::usage("--ray: a plan has no surfaces");
        return Err(failure.hint("nestray inspect SCENE --plan PLAN --ray X,Y"));
    }
    if args.explain.is_some() {
        let failure = Failure::usage("--explain: what a technique costs depends on the scene");
        return Err(failure.hint("nestray inspect SCENE --plan PLAN --explain NODE"));
    }
    let plan = input::read_plan(path)?;
    check_form(&plan).map_err(|error| input::plan_failure(&error, Some(path)))?;
    let (nests, levels) = counts(&plan);
    let mut text = String::new();
    let _ = writeln!(text, "plan      {}", path.display());
    let _ = writeln!(text, "hash      {}", plan.hash());
    if let Some(scene) = &plan.scene {
        let _ = writeln!(text, "scene     {scene}");
    }
    let _ = writeln!(text, "nests     {nests}, at most {levels} levels deep without instances");
    tree("root", &plan.root, 0, &mut text);
    for (name, node) in &plan.shared {
        tree(&format!("shared {name}"), node, 0, &mut text);
    }
    let json = json!({ "hash": plan.hash(), "nests": nests, "levels": levels, "plan": plan });
    Ok(Report { text, json })
}

/// How many nests there are, and the most levels of any subtree.
fn counts(plan: &Plan) -> (usize, usize) {
    let (mut nests, mut levels) = (0, 0);
    let mut rest: Vec<(&Node, usize)> =
        plan.shared.values().chain([&plan.root]).map(|node| (node, 1)).collect();
    while let Some((node, level)) = rest.pop() {
        nests += usize::from(matches!(node, Node::Nest(_)));
        levels = levels.max(level);
        node.visit_children(|_, child| rest.push((child, level + 1)));
    }
    (nests, levels)
}

fn tree(name: &str, node: &Node, level: usize, text: &mut String) {
    let what = match node {
        Node::Pick(selection) => format!("pick {selection}"),
        Node::Place(place) => format!("place {} of {}", place.shared, place.instance),
        Node::Nest(nest) if nest.params.is_empty() => nest.technique.clone(),
        Node::Nest(nest) => {
            format!("{} {}", nest.technique, serde_json::Value::Object(nest.params.clone()))
        }
        Node::ByKind(_) => "by kind".into(),
        Node::Lazy(_) => "lazy".into(),
        Node::Fence(fence) => format!("fence, {}", fence.by.name()),
    };
    let name = if name.is_empty() { String::new() } else { format!("{name}: ") };
    let _ = writeln!(text, "{:indent$}{name}{what}", "", indent = 2 * level);
    node.visit_children(|path, child| {
        let name = match node {
            Node::ByKind(_) => path.trim_start_matches("by_kind/"),
            _ => "",
        };
        tree(name, child, level + 1, text);
    });
}
