//! Ten techniques nested in one another, ten levels deep, look as one does.

use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_core::technique::Place;
use nestray_plan::build::build;
use nestray_plan::plan::{Node, Plan};
use nestray_plan::single::single;
use nestray_registry::TECHNIQUES;
use nestray_scene::procedural::generate;
use nestray_tests::pictures::{Subject, whitted};
use serde_json::{Map, Value};

/// How many levels, each by another technique.
const LEVELS: usize = 10;

/// The names of techniques that serve below so many instances, from the `first` on.
fn techniques(first: usize, instances: usize) -> Vec<&'static str> {
    let place = Place { instances, moving: false };
    let serves = |objection: Option<String>| objection.is_none();
    let all = TECHNIQUES.iter().cycle().skip(first).take(TECHNIQUES.len());
    let serving = all.filter(|entry| (entry.objection)(&Value::Null, &place).is_ok_and(serves));
    serving.map(|entry| entry.name).take(LEVELS).collect()
}

/// `node` in a nest of one technique in a nest of the next, and so on.
fn nested(node: Node, techniques: &[&str]) -> Node {
    techniques.iter().fold(node, |node, technique| Node::nest(*technique, vec![node]))
}

#[test]
fn ten_techniques_ten_levels_deep_over_the_forest_look_as_one_hierarchy_of_boxes() {
    let scene = generate("forest", None).expect("it is a scene of ours");
    let subject = Subject::new("forest", &scene);
    let options = whitted(20_000);
    let expected = subject.print(&*subject.world("bvh"), &options);
    // Every technique has its turn.
    for first in [0, LEVELS, 2 * LEVELS] {
        let mut plan = single("bvh", Map::new(), &scene).expect("it is in the registry");
        plan.root = nested(plan.root.clone(), &techniques(first, 0));
        for node in plan.shared.values_mut() {
            *node = nested(node.clone(), &techniques(first, 1));
        }
        let world = build(&plan, &scene.frame(0.3, 0.2)).expect("it fits");
        assert!(expected == subject.print(&*world, &options), "from {first}: {}", plan.to_json());
    }
}

#[test]
fn neighbouring_rays_go_through_a_deep_nest_on_a_small_stack() {
    /// As much as threads usually have.
    const STACK: usize = 2 << 20;
    let scene = generate("balls", Some(2)).expect("it is a scene of ours");
    let plan = single("bvh", Map::new(), &scene).expect("it is in the registry");
    let mut deep = plan.clone();
    deep.root = nested(deep.root.clone(), &["bvh"; 180]);
    let view = scene.cameras[0].view(1.0);
    let rays: Vec<Ray> = (0..64 * 64)
        .map(|i| {
            let (from, dir) = view.through([i % 64, i / 64], [64, 64]);
            Ray::new(from, dir, RayKind::Camera)
        })
        .collect();
    let answers = |plan: &Plan| {
        let world = build(plan, &scene).expect("it is sound");
        let mut hits: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
        let mut blocked = vec![false; rays.len()];
        let mut scratch = Scratch::new();
        world.closest_hits(&rays, &mut hits, &mut scratch);
        world.any_hits(&rays, &mut blocked, &mut scratch);
        assert!(hits.iter().zip(&blocked).all(|(hit, &blocked)| hit.is_some() == blocked));
        hits
    };
    let (plain, deep) = std::thread::scope(|scope| {
        let small = || std::thread::Builder::new().stack_size(STACK);
        let answers = &answers;
        let run =
            |plan| small().spawn_scoped(scope, move || answers(plan)).expect("there is memory");
        let (plain, deep) = (run(&plan), run(&deep));
        (plain.join().expect("no panic"), deep.join().expect("no panic"))
    });
    assert!(plain.iter().filter(|hit| hit.is_some()).count() > 100);
    assert!(plain == deep);
}
