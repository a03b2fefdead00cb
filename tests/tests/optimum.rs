//! Where all plans can be tried, a search finds one that is nearly as cheap as the cheapest of them, or
//! cheaper.
//!
//! Four groups of balls, unlike each other, are put in order in every way that three techniques allow:
//! each group stands in the outermost nest itself, or in one of its own, or in one with others. A search
//! may do more than that, and so may find what is cheaper still.
#![expect(clippy::print_stdout, reason = "the figures are what one looks at")]

use glam::Vec3A;
use nestray_core::ray::{Ray, RayKind};
use nestray_plan::optimize::ray_log::{RayLog, RaySet};
use nestray_plan::optimize::score::Scorer;
use nestray_plan::optimize::{Observer, Options, optimize};
use nestray_plan::plan::{Node, Plan};
use nestray_plan::prices::Prices;
use nestray_plan::select::Selection;
use nestray_scene::geometry::Geometry;
use nestray_scene::scene::Scene;
use nestray_shapes::any::AnyShape;
use nestray_shapes::sphere::Sphere;
use nestray_tests::numbers::Numbers;

const TECHNIQUES: [&str; 3] = ["octree", "grid", "list"];
const GROUPS: usize = 4;
/// Plans that a search may try.
const EVALUATIONS: usize = 800;
/// Dearer than the cheapest by no more than this is as cheap.
const SAME: f64 = 1.001;
/// So much dearer is never found.
const NEVER: f64 = 1.25;
/// So many times as dear as the cheapest is every technique alone.
const NESTS: f64 = 5.0;

/// Searches; `NESTRAY_SEEDS` asks for another number.
fn seeds() -> u64 {
    let asked = std::env::var("NESTRAY_SEEDS").ok().and_then(|n| n.parse().ok());
    asked.unwrap_or(3)
}

struct Nobody;
impl Observer for Nobody {}

/// A fine lattice, large balls that overlap, a few far away, and a floor of one.
fn scene() -> Scene {
    let mut scene = Scene::new();
    let mut numbers = Numbers::new(0x0071_0a11);
    let ball = |center: Vec3A, radius: f32| -> AnyShape { Sphere { center, radius }.into() };
    let lattice = (0..343).map(|i| {
        let at = Vec3A::new((i % 7) as f32, (i / 7 % 7) as f32, (i / 49) as f32);
        ball(at * 0.3, 0.1)
    });
    let mut anywhere = |size: f32| {
        Vec3A::new(numbers.between(0.0, 1.0), numbers.between(0.0, 1.0), numbers.between(0.0, 1.0))
            * size
    };
    let large: Vec<AnyShape> =
        (0..40).map(|_| ball(Vec3A::new(4.0, 0.0, 0.0) + anywhere(2.0), 0.5)).collect();
    let far: Vec<AnyShape> =
        (0..12).map(|_| ball(Vec3A::new(0.0, 0.0, 9.0) + anywhere(1.0), 0.2)).collect();
    let floor = vec![ball(Vec3A::new(0.0, -1000.5, 0.0), 1000.0)];
    for (name, balls) in
        [("lattice", lattice.collect()), ("large", large), ("far", far), ("floor", floor)]
    {
        scene.add(Geometry::shapes(name, 0, balls));
    }
    scene
}

/// Rays from afar to what is there, and on from there.
fn log() -> RayLog {
    let mut numbers = Numbers::new(0x0010_9ad5);
    let mut point = |low: Vec3A, high: Vec3A| {
        let at = Vec3A::new(
            numbers.between(0.0, 1.0),
            numbers.between(0.0, 1.0),
            numbers.between(0.0, 1.0),
        );
        low + (high - low) * at
    };
    let (low, high) = (Vec3A::new(0.0, -0.5, 0.0), Vec3A::new(6.0, 2.0, 10.0));
    let eye = Vec3A::new(12.0, 6.0, -4.0);
    let camera = (0..512).map(|_| Ray::new(eye, point(low, high) - eye, RayKind::Camera));
    let camera: Vec<Ray> = camera.collect();
    let around = (0..512).map(|_| {
        let from = point(low, high);
        Ray::new(from, point(low, high) - from, RayKind::Diffuse)
    });
    let set =
        |name: &str, rays: Vec<Ray>| RaySet { name: name.into(), rays, any: false, weight: 1.0 };
    RayLog::new(vec![set("camera", camera), set("diffuse", around.collect())])
}

/// Every way to put the groups from `next` on where they belong: into the outermost nest, into a
/// nest that is there, or into a new one.
fn partitions(next: usize, parts: &mut Vec<Vec<usize>>, all: &mut Vec<Vec<Vec<usize>>>) {
    if next == GROUPS {
        all.push(parts.clone());
        return;
    }
    for part in 0..parts.len() {
        parts[part].push(next);
        partitions(next + 1, parts, all);
        parts[part].pop();
    }
    parts.push(vec![next]);
    partitions(next + 1, parts, all);
    parts.pop();
}

/// Every plan: the first part stands in the outermost nest itself.
fn plans() -> Vec<Plan> {
    let mut divided = Vec::new();
    partitions(0, &mut vec![Vec::new()], &mut divided);
    let mut plans = Vec::new();
    for parts in divided {
        let nests = parts.len() as u32 - 1;
        for choice in 0..TECHNIQUES.len().pow(nests + 1) {
            let technique = |which: usize| {
                TECHNIQUES[choice / TECHNIQUES.len().pow(which as u32) % TECHNIQUES.len()]
            };
            let pick = |group: usize| Node::Pick(Selection::numbers([group]));
            let inner = parts.iter().enumerate().skip(1).map(|(which, part)| {
                Node::nest(technique(which), part.iter().map(|&group| pick(group)).collect())
            });
            let children = parts[0].iter().map(|&group| pick(group)).chain(inner);
            plans.push(Plan::new(Node::nest(technique(0), children.collect())));
        }
    }
    plans
}

#[test]
fn a_search_comes_near_the_cheapest_of_all_plans() {
    let (scene, log) = (scene(), log());
    let searched = log.halves().0;
    let scorer = Scorer::new(&scene, &searched, Prices::usual(), u64::MAX);
    let cost = |plan: &Plan| scorer.score(plan).map(|score| score.mix(&searched));
    let plans = plans();
    assert_eq!(plans.len(), 1866);
    let costs: Vec<f64> = plans.iter().map(|plan| cost(plan).expect("it is sound")).collect();
    let best = costs.iter().copied().fold(f64::INFINITY, f64::min);
    let nests = |plan: &Plan| {
        let is_nest = |node: &Node| matches!(node, Node::Nest(_));
        plan.nodes().iter().filter(|(_, node)| is_nest(node)).count()
    };
    let single = plans.iter().zip(&costs).filter(|(plan, _)| nests(plan) == 1);
    let single = single.map(|(_, cost)| *cost).fold(f64::INFINITY, f64::min);
    assert!(single > NESTS * best, "nothing is to be found: {single} {best}");
    let found: Vec<f64> = (0..seeds())
        .map(|seed| {
            let options = Options {
                techniques: TECHNIQUES.map(str::to_owned).to_vec(),
                evaluations: Some(EVALUATIONS),
                time: None,
                rounds: 1,
                seed,
                ..Options::default()
            };
            let found = optimize(&scene, &log, Prices::usual(), &options, &Nobody);
            cost(&found.expect("it is sound").expected).expect("it is sound")
        })
        .collect();
    let least = found.iter().copied().fold(f64::INFINITY, f64::min);
    let most = found.iter().copied().fold(0.0, f64::max);
    let as_good = found.iter().filter(|cost| **cost <= SAME * best).count();
    println!(
        "cheapest of {} plans {best:.1} ns, of one technique alone {single:.1}; {} searches \
         {least:.1} to {most:.1}, {as_good} as cheap",
        plans.len(),
        found.len()
    );
    assert!(most <= NEVER * best, "{found:?}");
}
