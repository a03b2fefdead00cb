//! Tests of nests whose instances are taken apart.

use glam::{Affine3A, Quat, Vec3, Vec3A};
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_scene::geometry::Geometry;
use nestray_scene::group::{Group, Motion};
use nestray_scene::scene::Scene;
use nestray_shapes::triangle_mesh::Triangles;
use serde_json::Map;

use super::build;
use super::tests::{Rng, answers, mesh, scene};
use crate::plan::{Leaves, Node, Plan};
use crate::single::single;

/// One technique over everything, leaves of a few by another, instances taken apart.
fn opened(technique: &str, scene: &Scene, open: f32) -> Plan {
    let mut plan = single(technique, Map::new(), scene).expect("known");
    let few = |number: u32| number.try_into().expect("it is not 0");
    let leaves = Leaves { more_than: few(2), per_leaf: few(16), ..Leaves::new("bvh") };
    for node in plan.shared.values_mut() {
        let Node::Nest(nest) = node else { panic!("a nest") };
        (nest.technique, nest.leaves) = ("bvh".into(), Some(Box::new(leaves.clone())));
        nest.open = open;
    }
    let Node::Nest(root) = &mut plan.root else { panic!("a nest") };
    root.open = open;
    plan
}

/// A thicket: many instances of a few large things, one in the other, turned and squeezed.
fn thicket() -> Scene {
    let mut rng = Rng(31);
    let mut scene = Scene::new();
    scene.add(mesh(&mut rng, "ground", 30));
    for number in 0..2 {
        let name = format!("bush {number}");
        let geometries = vec![scene.add_apart(mesh(&mut rng, &name, 900))];
        let group = scene.add_group(Group { name, geometries, ..Group::default() });
        for i in 0..20 {
            let turn = Quat::from_rotation_y(rng.next() * 6.0) * Quat::from_rotation_x(rng.next());
            let scale = match i % 4 {
                0 => Vec3::new(-1.0, 1.0, 1.0),
                1 => Vec3::new(0.4, 1.0, 1.5),
                _ => Vec3::splat(0.5 + rng.next()),
            };
            let at = Vec3::from(rng.point()) * 2.0;
            let place = Affine3A::from_scale_rotation_translation(scale, turn, at);
            scene.place(group, Motion::Still(place));
        }
    }
    scene
}

/// Rays of which most start near, and some as far out as rays can.
fn rays(count: usize) -> Vec<Ray> {
    let mut rng = Rng(12);
    let far = [1.0, 1.0, 3.0, 8.0, 12.0, 14.0, 100.0, 1e6];
    (0..count)
        .map(|i| {
            let aim = rng.point() * 3.0;
            let mut origin = aim + (rng.point() - 0.5) * 4.0 * far[i % far.len()];
            if i % 5 == 0 {
                let axis = i / 5 % 3;
                origin[axis] = aim[axis];
            }
            Ray::new(origin, aim - origin, RayKind::Diffuse).at_time(rng.next())
        })
        .collect()
}

fn all_hits(world: &DynObject, ray: &Ray, scratch: &mut Scratch) -> Vec<Hit> {
    let mut hits = Vec::new();
    world.all_hits(ray, &mut hits, scratch);
    hits.sort_by_key(|hit| (hit.t.to_bits(), hit.id()));
    hits.dedup();
    hits
}

#[test]
fn instances_taken_apart_answer_as_whole_ones() {
    let scene = thicket();
    let list = build(&single("list", Map::new(), &scene).expect("known"), &scene).expect("sound");
    let rays = rays(2_000);
    let mut scratch = Scratch::new();
    let expected: Vec<Vec<Hit>> =
        rays.iter().map(|ray| all_hits(&list, ray, &mut scratch)).collect();
    assert!(expected.iter().filter(|hits| hits.len() > 2).count() > 500);
    for technique in ["list", "bvh", "grid", "octree", "slabs", "sbvh"] {
        let world = build(&opened(technique, &scene, 200.0), &scene).expect("sound");
        assert_eq!(world.kind(), "opened", "{technique}");
        let mut batch: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
        let mut blocked = vec![false; rays.len()];
        world.closest_hits(&rays, &mut batch, &mut scratch);
        world.any_hits(&rays, &mut blocked, &mut scratch);
        for (i, ray) in rays.iter().enumerate() {
            let mut hit = Hit::none(ray.t_max());
            world.closest_hit(ray, &mut hit, &mut scratch);
            let nearest = expected[i].first().copied().unwrap_or(Hit::none(ray.t_max()));
            assert_eq!((hit, batch[i]), (nearest, nearest), "{technique}, ray {i}: {ray:?}");
            assert_eq!(world.any_hit(ray, &mut scratch), hit.is_some(), "{technique}, {ray:?}");
            assert_eq!(blocked[i], hit.is_some(), "{technique}, {ray:?}");
            assert_eq!(all_hits(&world, ray, &mut scratch), expected[i], "{technique}, {ray:?}");
            assert_eq!(world.surface(ray, &hit), list.surface(ray, &hit), "{technique}, {ray:?}");
        }
    }
}

#[test]
fn everything_there_is_may_be_taken_apart() {
    let scene = scene();
    let list = answers(&scene, &single("list", Map::new(), &scene).expect("known"));
    for technique in ["bvh", "grid", "ray-coherence"] {
        assert_eq!(answers(&scene, &opened(technique, &scene, 50.0)), list, "{technique}");
    }
}

/// Slanting rods side by side: their boxes overlap, they do not.
fn rods() -> Scene {
    let mut rng = Rng(8);
    let corners: Vec<[Vec3A; 3]> = (0..900)
        .map(|i| [0; 3].map(|_| Vec3A::splat(i as f32 / 300.0) + rng.point() * 0.05))
        .collect();
    let mut scene = Scene::new();
    let rod = Geometry::mesh("rod", 0, Triangles::from_corners(&corners));
    let geometries = vec![scene.add_apart(rod)];
    let group = scene.add_group(Group { geometries, ..Group::default() });
    for i in 0..30 {
        let place = Affine3A::from_translation(Vec3::X * (i as f32 * 0.1));
        scene.place(group, Motion::Still(place));
    }
    scene
}

#[test]
fn a_ray_comes_to_less_where_boxes_of_instances_overlap() {
    let scene = rods();
    let done = |open: f32| {
        let world = build(&opened("bvh", &scene, open), &scene).expect("sound");
        let mut scratch = Scratch::counting();
        for ray in rays(3_000).iter().filter(|ray| ray.origin().length() < 9.0) {
            world.closest_hit(ray, &mut Hit::none(ray.t_max()), &mut scratch);
        }
        let total = scratch.counters.total();
        total.all_steps() + total.all_tests()
    };
    let (whole, apart) = (done(0.0), done(200.0));
    assert!(2 * apart < whole, "{apart} instead of {whole}");
}

#[test]
fn no_more_are_taken_apart_than_there_is_room_for() {
    let scene = thicket();
    let children = |open: f32| {
        let world = build(&opened("list", &scene, open), &scene).expect("sound");
        let mut count = 0;
        match world.kind() {
            "opened" => world.visit_children(&mut |near| near.visit_children(&mut |_| count += 1)),
            _ => world.visit_children(&mut |_| count += 1),
        }
        count
    };
    let whole = children(0.0);
    let some = children(10.0);
    assert!(some > whole && some <= whole + 10 * 40, "{whole}, then {some}");
    assert!(children(200.0) > some);
    assert_eq!(children(0.001), whole);
}

#[test]
fn how_much_is_taken_apart_has_its_range() {
    let scene = Scene::new();
    for open in [-1.0, 1001.0, f32::NAN] {
        let mut plan = single("bvh", Map::new(), &scene).expect("known");
        let Node::Nest(nest) = &mut plan.root else { panic!("a nest") };
        nest.open = open;
        let told = build(&plan, &scene).err().expect("out of range").to_string();
        assert_eq!(told, "root/nest/open: bvh: \"open\" must be 0 to 1000");
    }
    let ray = Ray::new(Vec3A::ZERO, Vec3A::X, RayKind::Camera);
    let plan = opened("bvh", &scene, 1.0);
    let world = build(&Plan::from_json(&plan.to_json()).expect("a plan"), &scene).expect("sound");
    assert!(!world.any_hit(&ray, &mut Scratch::new()));
}
