//! Ten techniques nested in one another, ten levels deep, look as one does.

use nestray_core::technique::Place;
use nestray_plan::build::build;
use nestray_plan::plan::Node;
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
