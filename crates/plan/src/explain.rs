//! Why a technique stands where it does: what a plan would cost with any other in its place.

use nestray_registry as registry;
use nestray_scene::scene::Scene;
use rayon::prelude::*;
use serde_json::Map;

use crate::check::check;
use crate::error::{PlanError, Problem};
use crate::optimize::ray_log::RayLog;
use crate::optimize::score::{Score, Scorer};
use crate::plan::{Nest, Node, Plan};
use crate::prices::Prices;

/// A technique in the place of another.
#[derive(Clone, Debug)]
pub struct Alternative {
    /// Which.
    pub technique: &'static str,
    /// Whether it is what the plan says, with its settings; others have their defaults.
    pub is_chosen: bool,
    /// What rays are expected to cost in the whole plan, or why it cannot serve there.
    pub score: Result<Score, PlanError>,
}

/// The nest at a path of a plan.
///
/// # Errors
/// If there is no node, or it is no nest.
pub fn nest<'a>(plan: &'a Plan, path: &str) -> Result<&'a Nest, PlanError> {
    match plan.node(path) {
        Some(Node::Nest(nest)) => Ok(nest),
        Some(_) => {
            let inside = |(other, node): &(String, &Node)| {
                other.starts_with(path) && matches!(node, Node::Nest(_))
            };
            let near = plan.nodes().into_iter().find(inside).map(|(other, _)| other);
            Err(missing("nest", path, Some(near.unwrap_or_else(|| "root".into()))))
        }
        None => Err(missing("node", path, Some(plan.nearest_path(path)))),
    }
}

fn missing(what: &str, path: &str, nearest: Option<String>) -> PlanError {
    PlanError::at("plan", Problem::Unknown { what: what.into(), name: path.into(), nearest })
}

/// Every technique in the place of the one at a path, the cheapest for the mix first, those that
/// cannot serve there last. What is in the nest, and in its leaves, stays.
///
/// # Errors
/// If there is no nest at that path, or the plan itself does not fit the scene.
pub fn alternatives(
    plan: &Plan,
    path: &str,
    scene: &Scene,
    log: &RayLog,
    prices: &Prices,
) -> Result<Vec<Alternative>, PlanError> {
    let chosen = registry::find(&nest(plan, path)?.technique).map(|entry| entry.name);
    check(plan, scene)?;
    let scorer = Scorer::new(scene, log, prices, u64::MAX);
    let techniques: Vec<&'static str> = registry::names().collect();
    let mut all: Vec<Alternative> = techniques
        .into_par_iter()
        .map(|technique| {
            let is_chosen = chosen == Some(technique);
            let mut other = plan.clone();
            if let Some(Node::Nest(nest)) = other.node_mut(path)
                && !is_chosen
            {
                nest.technique = technique.into();
                nest.params = Map::new();
            }
            let score = check(&other, scene).and_then(|()| scorer.score(&other));
            Alternative { technique, is_chosen, score }
        })
        .collect();
    let cost = |one: &Alternative| one.score.as_ref().map_or(f64::INFINITY, |score| score.mix(log));
    all.sort_by(|a, b| cost(a).total_cmp(&cost(b)));
    Ok(all)
}

#[cfg(test)]
mod tests {
    use glam::Vec3A;
    use nestray_core::ray::{Ray, RayKind};
    use nestray_scene::procedural::generate;

    use super::*;
    use crate::optimize::ray_log::RaySet;
    use crate::single::single;

    fn log(scene: &Scene) -> RayLog {
        let bounds = scene.bounds();
        let ray = |i: usize| {
            let part = |step: f64| ((i as f64 + 0.5) * step).fract() as f32;
            let to = bounds.min + bounds.size() * Vec3A::new(part(0.7549), part(0.5698), 0.5);
            let from = bounds.center() + bounds.size() * 1.5;
            Ray::new(from, to - from, RayKind::Camera)
        };
        let rays = (0..300).map(ray).collect();
        RayLog::new(vec![RaySet { name: "camera".into(), rays, any: false, weight: 1.0 }])
    }

    #[test]
    fn every_technique_is_priced_in_the_place_of_one() {
        let scene = generate("tetra", Some(4)).expect("there is one");
        let mut plan = single("bvh", Map::new(), &scene).expect("it is sound");
        plan.root = Node::nest("list", vec![plan.root]);
        let log = log(&scene);
        let path = "root/nest/children/0";
        let all = alternatives(&plan, path, &scene, &log, Prices::usual()).expect("it is there");
        assert_eq!(all.len(), registry::names().count());
        let chosen: Vec<_> = all.iter().filter(|one| one.is_chosen).collect();
        assert_eq!(chosen.len(), 1);
        let scorer = Scorer::new(&scene, &log, Prices::usual(), u64::MAX);
        assert_eq!(chosen[0].score, scorer.score(&plan));
        let mixes: Vec<f64> =
            all.iter().filter_map(|one| Some(one.score.as_ref().ok()?.mix(&log))).collect();
        assert!(mixes.is_sorted() && mixes.len() > 10);
        let list = all.iter().find(|one| one.technique == "list").expect("it is one");
        let cost = |one: &Alternative| one.score.as_ref().map_or(f64::INFINITY, |s| s.mix(&log));
        assert!(cost(list) > 3.0 * cost(chosen[0]), "a list is dear");
    }

    #[test]
    fn what_is_no_nest_is_refused_with_what_is_near() {
        let scene = generate("tetra", Some(1)).expect("there is one");
        let plan = single("bvh", Map::new(), &scene).expect("it is sound");
        let check = |path: &str, words: [&str; 2]| {
            let error = nest(&plan, path).expect_err("it is none").to_string();
            assert!(words.iter().all(|word| error.contains(word)), "{error}");
        };
        check("rot", ["unknown node \"rot\"", "\"root\""]);
        check("root/nest/children/0", ["unknown nest", "\"root\""]);
        check("root/nest/children/9", ["unknown node", "\"root/nest/children/0\""]);
    }
}
