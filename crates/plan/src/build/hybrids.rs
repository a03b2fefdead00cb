//! Tests of nests whose leaves are put in order by other techniques.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::counters::Counters;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_registry::Members;
use nestray_scene::scene::Scene;
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use serde_json::Map;

use super::tests::{Rng, answers, mesh, rays, scene};
use super::{build, over};
use crate::describe::describe;
use crate::plan::{Leaves, Nest, Node, Plan};
use crate::presets::PRESETS;
use crate::single::single;

/// A nest without children, as it is written.
fn nest(text: &str) -> Nest {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

/// The same plan with these leaves in every nest.
fn with_leaves(mut plan: Plan, leaves: &Leaves) -> Plan {
    for node in plan.shared.values_mut().chain([&mut plan.root]) {
        if let Node::Nest(nest) = node {
            nest.leaves = Some(Box::new(leaves.clone()));
        }
    }
    plan
}

fn leaves(text: &str) -> Leaves {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn every_hybrid_gives_the_same_answers() {
    let scene = scene();
    let list = answers(&scene, &single("list", Map::new(), &scene).expect("known"));
    for preset in PRESETS {
        let plan = single(preset.name, Map::new(), &scene).expect("known");
        assert_eq!(answers(&scene, &plan), list, "{}", preset.name);
    }
    for fill in [
        r#"{ "technique": "bvh", "more_than": 1, "per_leaf": 1 }"#,
        r#"{ "technique": "grid", "more_than": 2, "per_leaf": 8, "lazy": true }"#,
        r#"{ "technique": "octree", "more_than": 3, "per_leaf": 16, "leaves":
             { "technique": "ploc", "more_than": 2, "per_leaf": 4, "lazy": true } }"#,
    ] {
        for name in ["list", "bvh", "grid", "kd-tree", "octree", "sbvh", "ray-coherence"] {
            let plan = single(name, Map::new(), &scene).expect("known");
            let plan = with_leaves(plan, &leaves(fill));
            assert_eq!(answers(&scene, &plan), list, "{name} over {fill}");
        }
    }
}

/// A lot of triangles, and a lot of balls.
fn members() -> [Members; 2] {
    let mut rng = Rng(17);
    let corners: Vec<[Vec3A; 3]> = (0..3000)
        .map(|_| {
            let at = rng.point();
            [0, 1, 2].map(|_| at + rng.point() * 0.05)
        })
        .collect();
    let mesh = TriangleMesh::new(0, Arc::new(Triangles::from_corners(&corners)));
    let ball = |i| {
        let sphere = Sphere { center: rng.point(), radius: 0.02 };
        Single { primitive: i, ..Single::new(1, sphere.into()) }
    };
    [Members::Triangles(mesh), Members::Shapes((0..1000).map(ball).collect())]
}

/// What is hit, and what was done for it.
fn counted(object: &DynObject) -> (Vec<Hit>, Counters) {
    let mut scratch = Scratch::counting();
    let hits = rays().into_iter().map(|ray| {
        let mut hit = Hit::none(ray.t_max());
        object.closest_hit(&ray, &mut hit, &mut scratch);
        hit
    });
    (hits.collect(), scratch.counters)
}

#[test]
fn where_all_leaves_are_small_there_is_only_the_technique_above() {
    let octree = nest(r#"{ "technique": "octree", "params": { "max_leaf": 8 } }"#);
    for members in members() {
        let alone = counted(&over(&octree, members.clone()));
        let fine = r#""leaves": { "technique": "bvh", "more_than": 2900, "per_leaf": 1 }"#;
        let text = format!(r#"{{ "technique": "octree", "params": {{ "max_leaf": 8 }}, {fine} }}"#);
        assert_eq!(counted(&over(&nest(&text), members.clone())), alone, "{members:?}");
    }
}

#[test]
fn where_there_is_one_leaf_there_is_only_the_technique_for_leaves() {
    let bvh = nest(r#"{ "technique": "bvh" }"#);
    for members in members() {
        let alone = counted(&over(&bvh, members.clone()));
        for above in [
            r#""technique": "list""#,
            r#""technique": "octree", "params": { "max_leaf": 64, "max_depth": 1 }"#,
            r#""technique": "grid", "params": { "max_cells": 1 }"#,
        ] {
            let fill = r#""leaves": { "technique": "bvh", "per_leaf": 1 }"#;
            let object = over(&nest(&format!("{{ {above}, {fill} }}")), members.clone());
            if !above.contains("octree") {
                assert_eq!(counted(&object), alone, "{above} over {members:?}");
            }
            assert_eq!(counted(&object).0, alone.0, "{above} over {members:?}");
        }
    }
}

#[test]
fn leaves_are_seen_in_the_description() {
    let [triangles, _] = members();
    let hybrid = r#"{ "technique": "grid", "params": { "max_cells": 3 },
        "leaves": { "technique": "kd-tree", "lazy": true } }"#;
    let object = over(&nest(hybrid), triangles);
    let model = nestray_core::cost::CostModel::default();
    let text = describe(&*object, &model).to_text();
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("grid"), "{text}");
    assert!(lines[1].trim().contains("lazy") && lines[2].contains("list"), "{text}");
    let mut scratch = Scratch::new();
    for ray in rays() {
        object.any_hit(&ray, &mut scratch);
    }
    let text = describe(&*object, &model).to_text();
    assert!(text.contains("kd-tree") && !text.contains("list"), "{text}");
}

#[test]
fn what_no_ray_comes_to_is_not_built() {
    let [triangles, _] = members();
    let lazy = PRESETS.iter().find(|preset| preset.name == "lazy-bvh").expect("it is there");
    let mut nest = lazy.nest();
    let leaves = nest.leaves.as_mut().expect("it is a hybrid");
    (leaves.per_leaf, leaves.more_than) = (64.try_into().expect("1"), 8.try_into().expect("1"));
    let object = over(&nest, triangles);
    let built = |object: &DynObject| {
        let (mut built, mut all) = (0, 0);
        object.visit_children(&mut |child| {
            child.visit_children(&mut |inner| {
                (built, all) = (built + usize::from(inner.kind() == "bvh"), all + 1);
            });
        });
        (built, all)
    };
    let (before, all) = built(&object);
    assert!(before == 0 && all > 20, "{before} of {all}");
    let ray = Ray::new(Vec3A::splat(-1.0), Vec3A::ONE, RayKind::Camera);
    object.any_hit(&ray, &mut Scratch::new());
    let (after, _) = built(&object);
    assert!(after > 0 && after < all / 2, "{after} of {all}");
}

#[test]
fn what_is_wrong_with_leaves_is_said_by_place() {
    let scene = Scene::new();
    let wrong = |nest: &str| {
        let plan = format!(r#"{{ "version": 1, "root": {{ "nest": {nest} }} }}"#);
        let plan = Plan::from_json(&plan).unwrap_or_else(|error| panic!("{nest}: {error}"));
        build(&plan, &scene).err().map_or_else(String::new, |error| error.to_string())
    };
    let over = |leaves: &str| wrong(&format!(r#"{{ "technique": "grid", "leaves": {leaves} }}"#));
    assert_eq!(over(r#"{ "technique": "bvh" }"#), "");
    assert_eq!(
        over(r#"{ "technique": "bhv" }"#),
        "root/nest/leaves/technique: unknown technique \"bhv\" (did you mean \"bvh\"?)"
    );
    let told = over(r#"{ "technique": "bvh", "params": { "max_leaf": 0 } }"#);
    assert!(told.starts_with("root/nest/leaves/params/max_leaf: bvh: \"max_leaf\" must be"));
    let told = over(
        r#"{ "technique": "bvh", "leaves": { "technique": "grid", "params": { "densty": 1 } } }"#,
    );
    assert!(told.starts_with("root/nest/leaves/leaves/params/densty: grid: unknown setting"));
    let zero = r#"{ "version": 1, "root": { "nest": { "technique": "bvh",
        "leaves": { "technique": "bvh", "more_than": 0 } } } }"#;
    assert!(Plan::from_json(zero).is_err());
}

#[test]
fn leaves_that_cannot_serve_below_an_instance_are_refused_there() {
    let scene = scene();
    let mut plan = single("bvh", Map::new(), &scene).expect("known");
    let Some(Node::Nest(nest)) = plan.shared.values_mut().next() else { panic!("a nest") };
    let fill = r#"{ "technique": "bvh", "leaves": { "technique": "light-buffer" } }"#;
    nest.leaves = Some(Box::new(leaves(fill)));
    let told = build(&plan, &scene).err().expect("it has a space of its own").to_string();
    assert!(told.contains("/nest/leaves/leaves: light-buffer cannot serve here"), "{told}");
}

#[test]
fn leaves_of_leaves_are_levels_too() {
    let deep = |levels: usize| {
        let mut inner = Leaves::new("list");
        for _ in 1..levels {
            inner = Leaves { leaves: Some(Box::new(inner)), ..Leaves::new("list") };
        }
        let mut rng = Rng(9);
        let mut scene = Scene::new();
        scene.add(mesh(&mut rng, "large", 60));
        let plan = with_leaves(Plan::new(Node::nest("list", vec![Node::rest()])), &inner);
        let plan = Plan::from_json(&plan.to_json()).expect("it is a plan");
        build(&plan, &scene).map(|object| object.kind())
    };
    assert_eq!(deep(Plan::DEEPEST - 2), Ok("list"));
    let told = deep(Plan::DEEPEST).expect_err("too deep").to_string();
    assert!(told.contains("more than 192 levels"), "{told}");
}
