//! Searching small scenes.

use std::sync::atomic::{AtomicU32, Ordering};

use glam::Vec3A;
use nestray_core::ray::{Ray, RayKind};
use nestray_scene::procedural::generate;
use rand_pcg::Pcg64Mcg;

use super::moves::Move;
use super::ray_log::{RayLog, RaySet};
use super::*;
use crate::build::build;
use crate::check::check;
use crate::plan::Node;
use crate::select::{Selection, Term};
use crate::single::{AUTO, single};

struct Nobody;
impl Observer for Nobody {}

/// Rays from outside to points within, of two kinds.
fn log(scene: &Scene, count: usize) -> RayLog {
    let bounds = scene.bounds();
    let part = |i: usize, step: f64| ((i as f64 + 0.5) * step).fract() as f32;
    let ray = |i: usize, kind| {
        let to = bounds.min
            + bounds.size() * Vec3A::new(part(i, 0.7549), part(i, 0.5698), part(i, 0.4159));
        let from = bounds.center() + bounds.size() * Vec3A::new(1.0, 0.8, 1.2);
        Ray::new(from, to - from, kind)
    };
    let set = |name: &str, kind, any| RaySet {
        name: name.into(),
        rays: (0..count).map(|i| ray(i, kind)).collect(),
        any,
        weight: 1.0,
    };
    RayLog::new(vec![
        set("camera", RayKind::Camera, false),
        set("shadow", RayKind::Shadow { light: 0 }, true),
    ])
}

fn options(evaluations: usize) -> Options {
    Options { evaluations: Some(evaluations), time: None, rounds: 1, ..Options::default() }
}

fn found(scene: &Scene, options: &Options) -> Optimized {
    optimize(scene, &log(scene, 400), Prices::usual(), options, &Nobody).expect("it is sound")
}

#[test]
fn weights_add_up_and_halves_share_no_ray() {
    let scene = generate("balls", Some(2)).expect("there is one");
    let log = log(&scene, 400);
    assert_eq!(log.sets.iter().map(|set| set.weight).sum::<f64>(), 1.0);
    let (a, b) = log.halves();
    assert_eq!(a.sets[0].rays.len() + b.sets[0].rays.len(), 400);
    let dirs = |log: &RayLog| -> Vec<Vec3A> { log.sets[0].rays.iter().map(Ray::dir).collect() };
    assert!(dirs(&a).iter().all(|dir| !dirs(&b).contains(dir)));
    assert!(a.thinned(64).sets[0].rays.len() <= 96);
    let some = a.sets[0].scattered(50);
    assert!(some.rays.len() <= 50 && some.rays.len() > 25, "{}", some.rays.len());
    assert_eq!(some.rays[1].dir(), a.sets[0].rays[5].dir(), "one by one, from all over");
}

#[test]
fn what_is_found_is_no_dearer_than_any_technique_alone() {
    let scene = generate("tetra", Some(4)).expect("there is one");
    let found = found(&scene, &options(60));
    assert!(found.evaluations >= 40 && found.evaluations <= 60, "{}", found.evaluations);
    let winner = &found.finalists[0];
    assert_eq!(winner.finalist.plan.root, found.plan.root);
    for one in found.finalists.iter().filter(|one| one.finalist.is_single) {
        assert!(winner.total <= 1.02 * one.total, "{} is faster", one.finalist.name);
    }
    let expected = |plan: &Plan| {
        let log = log(&scene, 400).halves().0;
        let scorer = Scorer::new(&scene, &log, Prices::usual(), u64::MAX);
        scorer.score(plan).expect("it is sound").mix(&log)
    };
    let auto = single(AUTO, Default::default(), &scene).expect("it is sound");
    assert!(expected(&found.expected) <= expected(&auto));
    assert!(found.trace.windows(2).all(|pair| pair[1].best <= pair[0].best));
    assert!(check(&found.plan, &scene).is_ok() && found.plan.scene.is_some());
}

#[test]
fn the_same_seed_finds_the_same_whatever_the_threads() {
    let scene = generate("rings", Some(2)).expect("there is one");
    let run = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let found = pool.install(|| found(&scene, &Options { seed, ..options(70) }));
        let energies: Vec<Vec<f64>> = found.trace.into_iter().map(|round| round.energies).collect();
        (found.expected.to_json(), energies)
    };
    let one = run(1, 3);
    assert_eq!(one, run(2, 3));
    assert_eq!(one, run(7, 3));
    assert_ne!(one.1, run(2, 4).1, "another seed goes another way");
}

#[test]
fn every_move_is_made_sooner_or_later_and_none_loses_a_geometry() {
    let scene = generate("gears", Some(2)).expect("there is one");
    let allowed: Vec<&'static str> = nestray_registry::names().collect();
    let mut plan = single(AUTO, Default::default(), &scene).expect("it is sound");
    let mut numbers = Pcg64Mcg::new(0xcafe_f00d);
    let mut made = std::collections::BTreeMap::<&str, usize>::new();
    for _ in 0..4000 {
        let step = Move::random(&mut numbers);
        let Some(next) = step.apply(&plan, &scene, &allowed, &mut numbers) else { continue };
        // A check finds whatever is lost or stands twice.
        if check(&next, &scene).is_ok() {
            *made.entry(step.name()).or_default() += 1;
            plan = next;
        }
    }
    for step in [
        "substitute",
        "retune",
        "fill",
        "unfill",
        "resize",
        "split",
        "dissolve",
        "merge",
        "transfer",
        "fence",
    ] {
        assert!(made.contains_key(step), "{step} was never possible: {made:?}");
    }
    assert!(build(&plan, &scene).is_ok());
}

#[test]
fn a_budget_of_nothing_gives_the_usual_plan() {
    let scene = generate("balls", Some(1)).expect("there is one");
    let found = found(&scene, &options(0));
    let auto = single(AUTO, Default::default(), &scene).expect("it is sound");
    assert_eq!((found.evaluations, found.plan.root), (1, auto.root));
}

#[test]
fn no_more_plans_are_tried_than_may_be() {
    let scene = generate("balls", Some(1)).expect("there is one");
    for evaluations in [2, 7, 33] {
        assert_eq!(found(&scene, &options(evaluations)).evaluations, evaluations);
    }
}

#[test]
fn scenes_of_nothing_and_next_to_nothing_are_no_trouble() {
    let mut scene = Scene::new();
    let rays = log(&generate("balls", Some(1)).expect("there is one"), 64);
    for count in 0..3 {
        let one = optimize(&scene, &rays, Prices::usual(), &options(30), &Nobody);
        let one = one.unwrap_or_else(|error| panic!("{count} objects: {error}"));
        assert!(check(&one.plan, &scene).is_ok());
        let center = Vec3A::new(count as f32, 0.0, 0.0);
        let sphere = nestray_shapes::sphere::Sphere { center, radius: 0.4 };
        let name = format!("ball {count}");
        scene.add(nestray_scene::geometry::Geometry::shapes(&name, 0, vec![sphere.into()]));
    }
}

#[test]
fn an_unknown_technique_is_refused_by_name() {
    let scene = generate("balls", Some(1)).expect("there is one");
    let options = Options { techniques: vec!["gird".into()], ..options(5) };
    let log = log(&scene, 64);
    let error = optimize(&scene, &log, Prices::usual(), &options, &Nobody).expect_err("no gird");
    assert!(error.to_string().contains("gird"), "{error}");
}

#[test]
fn what_is_pinned_stays_in_every_plan() {
    let scene = generate("gears", Some(2)).expect("there is one");
    let part = Node::nest("octree", vec![pick(0)]);
    let rest = vec![part.clone(), Node::rest()];
    let start = Plan::new(Node::nest("grid", rest));
    let pins = vec!["root/nest/children/0".to_owned()];
    let options = Options { start: Some(start.clone()), pins, ..options(60) };
    let found = found(&scene, &options);
    assert!(found.evaluations > 20, "{}", found.evaluations);
    let holds = |plan: &Plan| plan.nodes().iter().any(|(_, node)| **node == part);
    assert!(found.candidates.iter().all(|one| holds(&one.plan)));
    assert!(found.finalists.iter().all(|one| holds(&one.finalist.plan)) && holds(&found.plan));
    assert!(found.finalists.iter().any(|one| one.finalist.name == "as given"));
    let differ = |one: &Candidate| one.plan.root != start.root;
    assert!(found.candidates.iter().any(differ), "all else may change");
}

fn pick(number: usize) -> Node {
    Node::Pick(Selection(vec![Term::Number(number)]))
}

#[test]
fn a_given_plan_is_tried_with_the_others_and_must_fit() {
    let scene = generate("balls", Some(1)).expect("there is one");
    let start = Plan::new(Node::nest("bvh", Vec::new()));
    let search = |start: Plan, pin: Option<&str>| {
        let pins = pin.into_iter().map(str::to_owned).collect();
        let options = Options { start: Some(start), pins, ..options(5) };
        optimize(&scene, &log(&scene, 64), Prices::usual(), &options, &Nobody)
    };
    assert!(search(start, None).is_err(), "it holds nothing");
    let grid = single("grid", Default::default(), &scene).expect("it is sound");
    let found = search(grid.clone(), None).expect("it fits");
    assert!(found.finalists.iter().any(|one| one.finalist.name == "as given"));
    assert!(found.finalists.iter().any(|one| one.finalist.name == "bvh"));
    let error = search(grid, Some("rot")).expect_err("there is none").to_string();
    assert!(error.contains("unknown node \"rot\"") && error.contains("\"root\""), "{error}");
}

/// A clock on which each look takes a second.
#[derive(Debug, Default)]
struct Slow(AtomicU32);

impl Clock for Slow {
    fn seconds(&self) -> f64 {
        f64::from(self.0.fetch_add(1, Ordering::Relaxed))
    }

    fn worked(&self) -> f64 {
        self.seconds()
    }
}

#[test]
fn nothing_is_begun_that_may_take_longer_than_there_is_time() {
    let scene = generate("balls", Some(1)).expect("there is one");
    let techniques = ["bvh", "sbvh", "grid"];
    let tried = |seconds: u64| {
        let time = Some(Duration::from_secs(seconds));
        let techniques = techniques.map(str::to_owned).to_vec();
        let options = Options { time, techniques, rounds: 1, ..Options::default() };
        let clock = Slow::default();
        let limits = Limits::new(&clock, &options, &Nobody);
        let found = optimize_by(&scene, &log(&scene, 64), Prices::usual(), &limits);
        found.expect("it is sound").candidates
    };
    let uses = |tried: &[Candidate], technique: &str| {
        let is_it = |node: &Node| matches!(node, Node::Nest(nest) if nest.technique == technique);
        tried.iter().any(|one| one.plan.nodes().iter().any(|(_, node)| is_it(node)))
    };
    let [short, long] = [50, 500].map(tried);
    assert_eq!(techniques.map(|technique| uses(&short, technique)), [true, false, true]);
    assert!(uses(&long, "sbvh"));
}
