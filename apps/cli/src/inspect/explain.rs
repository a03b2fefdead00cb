//! Why a technique stands where it does in a nest: what the plan would cost with each other in its
//! place, what it expects to do for a random ray, and what it did for some of each kind.

use std::fmt::Write as _;

use nestray::plan::build::build;
use nestray::plan::describe::{Part, describe};
use nestray::plan::error::{PlanError, Problem};
use nestray::plan::explain::{Alternative, alternatives, nest};
use nestray::plan::optimize::ray_log::RayLog;
use nestray::plan::plan::{Node, Plan};
use nestray::plan::prices::Prices;
use nestray::prelude::Scene;
use serde_json::{Value, json};

use super::{Report, pilot};
use crate::args::Weights;
use crate::errors::Failure;
use crate::input::Choice;
use crate::optimize::{log_from, nest::weight};

/// Rays of each kind to price with.
const RAYS: usize = 4096;
/// Most parts that are shown of those that a node may have become.
const PARTS: usize = 4;

pub(super) fn report(
    scene: &Scene,
    choice: &Choice,
    path: &str,
    prices: &Prices,
) -> Result<Report, Failure> {
    scene.check().map_err(|error| Failure::new(Failure::UNREADABLE, error))?;
    let scene = &scene.frame(0.0, 0.0);
    let plan = choice.plan(scene)?;
    let world = build(&plan, scene).map_err(|error| choice.failure(&error))?;
    let node = nest(&plan, path).map_err(|error| unknown(&error))?;
    let log = log_from(scene.cameras.first(), scene, &world, &Weights::default(), RAYS)?;
    if log.sets.is_empty() {
        return Err(Failure::usage("--explain: no camera sees anything to price it by"));
    }
    let all =
        alternatives(&plan, path, scene, &log, prices).map_err(|error| choice.failure(&error))?;
    let prices = &prices.scattered;
    let sent = pilot::send(scene, &world)?;
    let part = describe(&world, prices).counted(&sent);
    let of = |rays: &str| weight(rays, &sent, &log);
    let (whole, parts) = (part.spent(prices, &of).total, parts(&part, &plan, path));
    let mut text = String::new();
    let _ = writeln!(text, "node        {path}");
    let settings = Value::Object(node.params.clone());
    let settings = if node.params.is_empty() { String::new() } else { format!(" {settings}") };
    let _ = writeln!(text, "technique   {}{settings}", node.technique);
    let mix: Vec<String> =
        log.sets.iter().map(|set| format!("{:.0} % {}", 100.0 * set.weight, set.name)).collect();
    let _ = writeln!(text, "rays        {}", mix.join(", "));
    table(&mut text, &all, &log);
    let spent: Vec<f64> = parts.iter().map(|part| part.spent(prices, &of).total).collect();
    let _ =
        writeln!(text, "\nwhat it expected of a random ray, and what was counted per ray sent:");
    for (part, spent) in parts.iter().zip(&spent).take(PARTS) {
        text.push_str(&Part { children: Vec::new(), cut: false, ..(*part).clone() }.to_text());
        let percent = 100.0 * spent / whole.max(f64::MIN_POSITIVE);
        let _ = writeln!(
            text,
            "    of {whole:.0} ns a ray of the mix, {spent:.0} are spent in it: {percent:.0} %"
        );
    }
    if parts.is_empty() {
        let _ =
            writeln!(text, "    nothing stands there: what it was to hold is elsewhere, or none");
    }
    let json = json!({ "node": path, "technique": node.technique, "params": node.params,
        "alternatives": all.iter().map(|one| alternative(one, &log)).collect::<Vec<_>>(),
        "parts": parts, "spent": spent, "spent_in_all": whole });
    Ok(Report { text, json })
}

/// What is wrong with the path.
fn unknown(error: &PlanError) -> Failure {
    match error {
        PlanError::At { problem, .. } => Failure::usage(format!("--explain: {problem}")),
        _ => Failure::usage(format!("--explain: {error}")),
    }
}

/// What the whole plan is expected to cost with each technique in that place.
fn table(text: &mut String, all: &[Alternative], log: &RayLog) {
    let chosen = all.iter().find(|one| one.is_chosen).and_then(|one| one.score.as_ref().ok());
    let now = chosen.map_or(f64::NAN, |score| score.mix(log));
    let _ = writeln!(text, "\nexpected ns a ray of the whole plan, with each technique there:");
    let _ = write!(text, "  {:<20} {:>9} {:>7}", "technique", "mix", "times");
    for set in &log.sets {
        let _ = write!(text, " {:>9}", set.name);
    }
    text.push('\n');
    for one in all {
        let mark = if one.is_chosen { '*' } else { ' ' };
        let _ = write!(text, "{mark} {:<20}", one.technique);
        match &one.score {
            Ok(score) => {
                let mix = score.mix(log);
                let _ = write!(text, " {mix:>9.1} {:>7.2}", mix / now);
                for nanos in &score.nanos {
                    let _ = write!(text, " {nanos:>9.1}");
                }
                text.push('\n');
            }
            Err(error) => {
                let _ = writeln!(text, " {}", reason(error));
            }
        }
    }
}

/// Why a technique cannot stand there, in a line.
fn reason(error: &PlanError) -> String {
    match error {
        PlanError::At { problem: Problem::Objection { reason, .. }, .. } => {
            format!("cannot serve there: {reason}")
        }
        PlanError::At { problem, .. } => problem.to_string(),
        _ => error.to_string(),
    }
}

fn alternative(one: &Alternative, log: &RayLog) -> Value {
    match &one.score {
        Ok(score) => json!({ "technique": one.technique, "chosen": one.is_chosen,
            "expected_mix": score.mix(log), "expected_nanos": score.nanos, "bytes": score.bytes }),
        Err(error) => json!({ "technique": one.technique, "chosen": one.is_chosen,
            "cannot_serve": reason(error) }),
    }
}

/// The parts of a nest that a node has become: several if it stands in several places, or beside
/// others of the same technique.
fn parts<'a>(world: &'a Part, plan: &Plan, path: &str) -> Vec<&'a Part> {
    let leads = |other: &str| {
        path.strip_prefix(other).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'))
    };
    let mut found: Option<Vec<&Part>> = None;
    for (_, node) in plan.nodes().into_iter().filter(|(other, _)| leads(other)) {
        let Node::Nest(nest) = node else { continue };
        let mut next = Vec::new();
        match found {
            None => first(world, &nest.technique, path.starts_with("shared/"), &mut next),
            Some(parts) => parts.into_iter().for_each(|p| below(p, &nest.technique, &mut next)),
        }
        found = Some(next);
    }
    found.unwrap_or_default()
}

/// Parts by a technique with which the world begins, or what instances place.
fn first<'a>(part: &'a Part, technique: &str, is_shared: bool, found: &mut Vec<&'a Part>) {
    if is_shared {
        if part.kind == "instance" {
            below(part, technique, found);
        }
        part.children.iter().for_each(|child| first(child, technique, true, found));
    } else if part.kind == technique {
        found.push(part);
    } else if is_wrapper(part.kind) {
        below(part, technique, found);
    }
}

/// Parts by a technique that stand in another, wrapped or not.
fn below<'a>(part: &'a Part, technique: &str, found: &mut Vec<&'a Part>) {
    for child in &part.children {
        if child.kind == technique {
            found.push(child);
        } else if is_wrapper(child.kind) {
            below(child, technique, found);
        }
    }
}

/// Whether an object only stands for others.
fn is_wrapper(kind: &str) -> bool {
    ["by-kind", "fence", "lazy", "opened", "part of an instance"].contains(&kind)
}
