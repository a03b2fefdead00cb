use glam::{Affine3A, Vec3, Vec3A};
use nestray_core::moving::Keys;
use nestray_scene::geometry::Geometry;
use nestray_scene::group::{Group, Motion, Place};
use nestray_scene::scene::Scene;
use nestray_shapes::sphere::Sphere;

use super::check;
use crate::plan::{Node, Plan};

#[test]
fn scenes_whose_parts_do_not_fit_together_are_refused() {
    let mut scene = garden();
    let plan = crate::single::single("bvh", Default::default(), &scene).expect("known");
    scene.groups[1].geometries.push(77);
    let expected = "the scene: groups[1].geometries[1]: there is no geometry 77";
    let told = [
        check(&plan, &scene).err(),
        crate::build::build(&plan, &scene).err(),
        crate::single::single("bvh", Default::default(), &scene).err(),
    ];
    assert_eq!(
        told.map(|error| error.map(|e| e.to_string())),
        [(); 3].map(|()| Some(expected.into()))
    );
    scene.root = 9;
    let told = check(&plan, &scene).expect_err("there is no world").to_string();
    assert_eq!(told, "the scene: root: there is no group 9");
}

/// A world of ground, two leaves and three trees; a tree is a trunk, a leaf and a nut.
fn garden() -> Scene {
    let sphere = |name: &str, x: f32| {
        let sphere = Sphere { center: Vec3A::new(x, 0.0, 0.0), radius: 1.0 };
        Geometry::shapes(name, 0, vec![sphere.into()])
    };
    let mut scene = Scene::new();
    for (i, name) in ["ground", "leaf", "leaf"].into_iter().enumerate() {
        scene.add(sphere(name, i as f32));
    }
    let parts: Vec<usize> =
        ["trunk", "leaf"].iter().map(|name| scene.add_apart(sphere(name, 0.0))).collect();
    let nut = scene.add_apart(sphere("nut", 0.0));
    let at = |x: f32| Motion::Still(Affine3A::from_translation(Vec3::new(x, 9.0, 0.0)));
    let mut nuts = Group { name: "nut".into(), geometries: vec![nut], ..Group::default() };
    nuts.places = Vec::new();
    let nuts = scene.add_group(nuts);
    let hanging = Place { name: "hanging".into(), group: nuts, motion: at(1.0) };
    let tree = Group { name: "tree".into(), geometries: parts, places: vec![hanging] };
    let tree = scene.add_group(tree);
    for x in 0..3 {
        scene.place(tree, at(x as f32));
    }
    scene
}

/// The shared subtrees of the garden, and a root.
fn plan(root: &str) -> String {
    format!(
        r#"{{ "version": 1, "shared": {{
             "nut": {{ "pick": "nut" }},
             "tree": {{ "nest": {{ "technique": "list", "children": [
                {{ "pick": ["trunk", "leaf"] }},
                {{ "place": {{ "instance": "hanging", "shared": "nut" }} }} ] }} }} }},
           "root": {root} }}"#
    )
}

fn nest(children: &str) -> String {
    format!(r#"{{ "nest": {{ "technique": "bvh", "children": [ {children} ] }} }}"#)
}

const TREES: &str = r#"{ "place": { "instance": "group:tree", "shared": "tree" } }"#;

/// What is wrong with a plan for the garden; empty if nothing is.
fn wrong(text: &str) -> String {
    let plan = Plan::from_json(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    check(&plan, &garden()).map_or_else(|error| error.to_string(), |()| String::new())
}

fn root(children: &str) -> String {
    wrong(&plan(&nest(children)))
}

#[test]
fn whatever_way_it_is_said_all_is_held_once() {
    for pick in [
        r#""*""#,
        r#""rest""#,
        r#"["ground", "leaf"]"#,
        r#"["ground", "l*f"]"#,
        r#"[0, 1, 2]"#,
        r#""0-2""#,
        r#""0-99""#,
        r#"["leaf", "rest"]"#,
        r#"["*", "leaf"]"#,
    ] {
        assert_eq!(root(&format!(r#"{{ "pick": {pick} }}, {TREES}"#)), "", "{pick}");
    }
    for instance in [r#""*""#, r#""rest""#, r#""0-2""#, r#"[2, 1, 0]"#, r#""group:2""#] {
        let trees = TREES.replace(r#""group:tree""#, instance);
        assert_eq!(root(&format!(r#"{{ "pick": "*" }}, {trees}"#)), "", "{instance}");
    }
    let nested = nest(r#"{ "pick": "leaf" }, { "lazy": { "pick": "ground" } }"#);
    assert_eq!(root(&format!("{nested}, {TREES}")), "");
}

#[test]
fn what_is_held_twice_or_not_at_all_is_named() {
    assert_eq!(
        root(&format!(r#"{{ "pick": "leaf" }}, {TREES}"#)),
        "root: geometry 0 \"ground\" of the world is not held by anything"
    );
    assert_eq!(
        root(r#"{ "pick": "rest" }"#),
        "root: instance 0 of the world is not held by anything, nor are 2 others"
    );
    assert_eq!(
        root(r#"{ "pick": "rest" }, { "place": { "instance": 1, "shared": "tree" } }"#),
        "root: instance 0 of the world is not held by anything, nor is another"
    );
    assert_eq!(
        root(&format!(r#"{{ "pick": "*" }}, {{ "pick": 2 }}, {TREES}"#)),
        "root/nest/children/1/pick: geometry 2 \"leaf\" of the world is held twice, \
         also by root/nest/children/0/pick"
    );
    let twice = root(&format!(r#"{{ "pick": "rest" }}, {{ "pick": "rest" }}, {TREES}"#));
    assert!(twice.contains("is held twice"), "{twice}");
    let tree = plan(&nest(&format!(r#"{{ "pick": "*" }}, {TREES}"#)));
    assert_eq!(
        wrong(&tree.replace(r#"["trunk", "leaf"]"#, r#""trunk""#)),
        "shared/tree: geometry 4 \"leaf\" of group \"tree\" is not held by anything"
    );
}

#[test]
fn unknown_names_come_with_the_nearest() {
    let unknown = |children: &str, expected: &str| assert_eq!(root(children), expected);
    unknown(
        r#"{ "pick": "graund" }"#,
        "root/nest/children/0/pick: unknown geometry of the world \"graund\" \
         (did you mean \"ground\"?)",
    );
    unknown(r#"{ "pick": 3 }"#, "root/nest/children/0/pick: unknown geometry of the world \"3\"");
    unknown(
        r#"{ "place": { "instance": "group:treee", "shared": "tree" } }"#,
        "root/nest/children/0/place/instance: unknown instance of the world \"group:treee\" \
         (did you mean \"group:tree\"?)",
    );
    unknown(
        r#"{ "place": { "instance": 3, "shared": "tree" } }"#,
        "root/nest/children/0/place/instance: unknown instance of the world \"3\"",
    );
    unknown(
        r#"{ "place": { "instance": 0, "shared": "free" } }"#,
        "root/nest/children/0/place/shared: unknown shared subtree \"free\" \
         (did you mean \"tree\"?)",
    );
    assert_eq!(
        wrong(&plan(&nest("").replace("bvh", "bhv"))),
        "root/nest/technique: unknown technique \"bhv\" (did you mean \"bvh\"?)"
    );
}

#[test]
fn settings_are_checked_by_their_technique() {
    let with = |params: &str| {
        let technique = r#""technique": "grid""#;
        let nest = nest("")
            .replace(r#""technique": "bvh""#, &format!(r#"{technique}, "params": {params}"#));
        wrong(&plan(&nest))
    };
    let unknown = with(r#"{ "densty": 1.0 }"#);
    assert!(unknown.starts_with("root/nest/params/densty: grid: unknown setting"), "{unknown}");
    assert!(unknown.ends_with("(did you mean \"density\"?)"), "{unknown}");
    let out = with(r#"{ "density": -1.0 }"#);
    assert!(out.starts_with("root/nest/params/density: grid: \"density\" must be"), "{out}");
    let kind = with(r#"{ "density": "much" }"#);
    assert!(kind.starts_with("root/nest/params"), "{kind}");
}

#[test]
fn all_cases_of_a_by_kind_node_hold_the_same() {
    let by_kind = |shadow: &str, other: &str| {
        root(&format!(r#"{{ "by_kind": {{ "shadow": {shadow}, "other": {other} }} }}, {TREES}"#))
    };
    let all = r#"{ "pick": "*" }"#;
    assert_eq!(by_kind(all, all), "");
    assert_eq!(by_kind(r#"{ "pick": "rest" }"#, all), "");
    assert_eq!(by_kind(r#"{ "pick": ["leaf", "rest"] }"#, r#"{ "pick": "rest" }"#), "");
    assert_eq!(
        by_kind(r#"{ "pick": "leaf" }"#, all),
        "root/nest/children/0/by_kind/shadow: holds less than `other`, \
         for example geometry 0 \"ground\" of the world"
    );
    assert_eq!(
        by_kind(all, r#"{ "pick": 0 }"#),
        "root/nest/children/0/by_kind/shadow: holds more than `other`, \
         for example geometry 1 \"leaf\" of the world"
    );
    // The rest outside is what no case picks.
    let outside = |other: &str| {
        root(&format!(
            r#"{{ "by_kind": {{ "lights": {{ "0": {{ "pick": 0 }} }}, "other": {other} }} }},
               {{ "pick": "rest" }}, {TREES}"#
        ))
    };
    assert_eq!(outside(r#"{ "pick": 0 }"#), "");
    assert!(outside(r#"{ "pick": 1 }"#).starts_with("root/nest/children/0/by_kind/lights/0:"));
}

#[test]
fn circles_and_depth_are_refused_by_name() {
    let circle = plan(&nest(&format!(r#"{{ "pick": "*" }}, {TREES}"#))).replace(
        r#""nut": { "pick": "nut" }"#,
        r#""nut": { "lazy": { "place": { "instance": 0, "shared": "tree" } } }"#,
    );
    assert_eq!(
        wrong(&circle),
        "shared/nut/lazy/place/shared: shared subtrees place each other in a \
         circle: tree > nut > tree"
    );
    let mut node = Node::rest();
    for _ in 0..Plan::DEEPEST {
        node = Node::nest("list", vec![node]);
    }
    let deep = check(&Plan::new(node), &Scene::new()).expect_err("too deep").to_string();
    assert!(deep.ends_with("more than 192 levels, instances counted (the limit `Plan::DEEPEST`)"));
    let unused = Plan::from_json(&plan(r#"{ "pick": "*" }"#)).expect("a plan");
    let unused = check(&unused, &Scene::new()).expect_err("nothing places it").to_string();
    assert_eq!(unused, "shared/nut: nothing places this shared subtree");
    let version = plan(r#"{ "pick": "*" }"#).replace(r#""version": 1"#, r#""version": 2"#);
    assert_eq!(wrong(&version), "version: format 2 is not known, only 1");
}

#[test]
fn a_scene_that_holds_itself_is_refused() {
    let mut scene = Scene::new();
    scene.place(0, Motion::Keys(Keys::new(vec![(0.0, Affine3A::IDENTITY)]).expect("one key")));
    let error = check(&Plan::new(Node::nest("bvh", Vec::new())), &scene).expect_err("a cycle");
    assert_eq!(error.to_string(), "the scene: groups: group 0 stands in itself");
}

#[test]
fn a_light_buffer_below_an_instance_is_refused_by_place_and_reason() {
    let scene = garden();
    for technique in ["light-buffer", "eye-buffer"] {
        let plan = crate::single::single(technique, Default::default(), &scene).expect("known");
        assert_eq!(
            check(&plan, &scene).map_err(|e| e.to_string()),
            Ok(()),
            "in the world it is fine"
        );
        let mut below = plan.clone();
        for node in below.shared.values_mut() {
            let Node::Nest(nest) = node else { panic!("a nest") };
            nest.technique = technique.into();
        }
        let told = check(&below, &scene).expect_err("it has a space of its own").to_string();
        assert!(told.contains("shared/") && told.contains("an instance has a space"), "{told}");
    }
}
