use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3, Vec3A};
use nestray_core::hit::Hit;
use nestray_core::moving::Keys;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_registry as registry;
use nestray_scene::geometry::{Content, Geometry};
use nestray_scene::group::{Group, Motion, Place};
use nestray_scene::scene::Scene;
use nestray_scene::solid::{Operand, Solid};
use nestray_scene::surfaces::Surfaces;
use nestray_shapes::any::AnyShape;
use nestray_shapes::block::Block;
use nestray_shapes::csg::Operation;
use nestray_shapes::shape::Sides;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::triangle_mesh::Triangles;
use serde_json::Map;

use super::build;
use crate::plan::{ByKind, Node, Plan};
use crate::select::Selection;
use crate::single::single;

pub(super) struct Rng(pub(super) u64);

impl Rng {
    pub(super) fn next(&mut self) -> f32 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u64 << 24) as f32
    }
    pub(super) fn point(&mut self) -> Vec3A {
        Vec3A::new(self.next(), self.next(), self.next())
    }
}

pub(super) fn mesh(rng: &mut Rng, name: &str, count: usize) -> Geometry {
    let corners: Vec<[Vec3A; 3]> = (0..count)
        .map(|_| {
            let at = rng.point();
            [0, 1, 2].map(|_| at + rng.point() * 0.3)
        })
        .collect();
    Geometry::mesh(name, 0, Triangles::from_corners(&corners))
}

fn spheres(rng: &mut Rng, name: &str, count: usize) -> Geometry {
    let sphere = |_| Sphere { center: rng.point(), radius: 0.05 }.into();
    Geometry::shapes(name, 0, (0..count).map(sphere).collect::<Vec<AnyShape>>())
}

/// Blocks without balls, pyramids with them.
fn solids(rng: &mut Rng, name: &str, count: usize) -> Geometry {
    let solid = |i: usize| {
        let at = rng.point();
        let ball = Operand::shape(Sphere { center: at, radius: 0.12 }).expect("closed");
        let half = Vec3A::splat(0.1);
        let (operation, other) = match i % 2 {
            0 => (Operation::Union, Operand::mesh(Arc::new(pyramids(40)))),
            _ => (Operation::Difference, Operand::shape(Block::between(-half, half))),
        };
        let turn = Quat::from_rotation_x(rng.next() * 6.0);
        let place = Affine3A::from_rotation_translation(turn, at.into());
        let other = other.and_then(|other| other.placed(place)).expect("closed");
        Solid::new(operation, other, ball).expect("not deep")
    };
    Geometry::solids(name, 0, (0..count).map(solid).collect())
}

/// Two pyramids of many sides, foot on foot.
fn pyramids(sides: u32) -> Triangles {
    let corner = |i: u32| {
        let (y, x) = (i as f32 * std::f32::consts::TAU / sides as f32).sin_cos();
        [0.1 * x, 0.1 * y, 0.0]
    };
    let positions = (0..sides).map(corner).chain([[0.0, 0.0, 0.2], [0.0, 0.0, -0.2]]).collect();
    let around = (0..sides).flat_map(|i| {
        let next = (i + 1) % sides;
        [[i, next, sides], [next, i, sides + 1]]
    });
    Triangles::new(positions, around.collect()).expect("sound")
}

/// Everything there is: meshes large and tiny, shapes, solids, one side only, instances in instances,
/// one of them moving, one flat.
pub(super) fn scene() -> Scene {
    let mut rng = Rng(5);
    let mut scene = Scene::new();
    scene.add(mesh(&mut rng, "large", 60));
    scene.add(mesh(&mut rng, "tiny", 3));
    scene.add(spheres(&mut rng, "balls", 20));
    scene.add(Geometry { sides: Sides::Front, ..mesh(&mut rng, "front", 30) });
    scene.add(solids(&mut rng, "solids", 12));
    let inner = vec![scene.add_apart(mesh(&mut rng, "inner", 40))];
    let inner = Group { name: "inner".into(), geometries: inner, ..Group::default() };
    let inner = scene.add_group(inner);
    let turned = |rng: &mut Rng| {
        let turn = Quat::from_rotation_y(rng.next() * 6.0);
        let at = Vec3::from(rng.point() * 3.0 - 1.0);
        Affine3A::from_scale_rotation_translation(Vec3::splat(0.5), turn, at)
    };
    let mut places = Vec::new();
    for _ in 0..3 {
        let motion = Motion::Still(turned(&mut rng));
        places.push(Place { name: String::new(), group: inner, motion });
    }
    let dots = scene.add_apart(spheres(&mut rng, "dots", 10));
    let hollow = Geometry { sides: Sides::Back, ..solids(&mut rng, "hollow", 5) };
    let geometries = vec![dots, scene.add_apart(hollow)];
    let outer = scene.add_group(Group { name: "outer".into(), geometries, places });
    for _ in 0..4 {
        scene.place(outer, Motion::Still(turned(&mut rng)));
        scene.place(inner, Motion::Still(turned(&mut rng)));
    }
    let keys = vec![(0.0, turned(&mut rng)), (1.0, turned(&mut rng))];
    scene.place(outer, Motion::Keys(Keys::new(keys).expect("times ascend")));
    scene.place(inner, Motion::Still(Affine3A::from_scale(Vec3::new(1.0, 0.0, 1.0))));
    scene
}

pub(super) fn rays() -> Vec<Ray> {
    let mut rng = Rng(11);
    let kinds = [RayKind::Camera, RayKind::Shadow { light: 1 }, RayKind::Diffuse];
    (0..900)
        .map(|i| {
            let origin = rng.point() * 6.0 - 2.0;
            let aim = rng.point() * 2.0 - 0.5;
            Ray::new(origin, aim - origin, kinds[i % 3]).at_time(rng.next())
        })
        .collect()
}

/// What is hit, and what the surface looks like there.
pub(super) fn answers(scene: &Scene, plan: &Plan) -> Vec<(Hit, Vec<f32>)> {
    let world = build(plan, scene).unwrap_or_else(|error| panic!("{}: {error}", plan.to_json()));
    let surfaces = Surfaces::new(scene).expect("it can be numbered");
    let mut scratch = Scratch::new();
    rays()
        .iter()
        .map(|ray| {
            let mut hit = Hit::none(ray.t_max());
            let found = world.closest_hit(ray, &mut hit, &mut scratch);
            assert_eq!(found, world.any_hit(ray, &mut scratch));
            let mut at = Vec::new();
            if found {
                let point = surfaces.at(ray, &hit);
                let asked = world.surface(ray, &hit).expect("the hit is of it");
                let off = (asked.position - point.surface.position).length();
                assert!(off < 1e-4 && asked.normal.dot(point.surface.normal) > 0.999, "{hit:?}");
                at = point.surface.position.to_array().to_vec();
            }
            (hit, at)
        })
        .collect()
}

#[test]
fn every_plan_gives_the_same_answers() {
    let scene = scene();
    let list = answers(&scene, &single("list", Map::new(), &scene).expect("known"));
    let hits = list.iter().filter(|(hit, _)| hit.is_some()).count();
    let deep = list.iter().filter(|(hit, _)| hit.path.number() > 0).count();
    assert!(hits > 100 && deep > 30, "{hits} hits, {deep} in instances");
    let solid = |hit: &Hit| {
        let geometry = scene.geometries.get(hit.geometry as usize);
        geometry.is_some_and(|geometry| matches!(geometry.content, Content::Solids(_)))
    };
    let solids = list.iter().filter(|(hit, _)| solid(hit)).count();
    assert!(solids > 30, "{solids} hits of solids");
    for name in registry::names() {
        let plan = single(name, Map::new(), &scene).expect("known");
        if (registry::find(name).expect("known").objection)(
            &serde_json::Value::Null,
            &nestray_core::technique::Place { instances: 0, moving: true },
        )
        .is_ok_and(|objection| objection.is_some())
        {
            continue;
        }
        assert_eq!(answers(&scene, &plan), list, "{name}");
    }
    let mut plan = single("bvh", Map::new(), &scene).expect("known");
    let Node::Nest(root) = &mut plan.root else { panic!("a nest") };
    root.children[0] = Node::nest(
        "grid",
        vec![
            Node::Pick(Selection::named("large")),
            Node::ByKind(Box::new(ByKind {
                shadow: Some(Node::Lazy(Box::new(Node::nest("bvh", vec![Node::rest()])))),
                lights: [(1, Node::nest("grid", vec![Node::rest()]))].into(),
                ..ByKind::new(Node::rest())
            })),
        ],
    );
    for node in plan.shared.values_mut() {
        *node = Node::Lazy(Box::new(node.clone()));
    }
    assert_eq!(answers(&scene, &plan), list, "{}", plan.to_json());
}

#[test]
fn shared_subtrees_are_built_once() {
    let mut rng = Rng(3);
    let mut scene = Scene::new();
    let geometries = vec![scene.add_apart(mesh(&mut rng, "large", 20_000))];
    let group = scene.add_group(Group { geometries, ..Group::default() });
    for i in 0..1000 {
        let place = Affine3A::from_translation(Vec3::new(i as f32, 0.0, 0.0));
        scene.place(group, Motion::Still(place));
    }
    let world = build(&single("bvh", Map::new(), &scene).expect("known"), &scene).expect("sound");
    let mut first = None;
    world.visit_children(&mut |child| {
        first.get_or_insert_with(|| child.cost(&nestray_core::cost::CostModel::default()).bytes);
    });
    assert!(first.expect("there are instances") < 1000, "instances count no memory twice");
    assert_eq!(world.paths(), 1001);
}

#[test]
fn an_empty_world_is_never_hit() {
    let scene = Scene::new();
    let world = build(&single("grid", Map::new(), &scene).expect("known"), &scene).expect("sound");
    assert!(world.bounds().is_empty());
    let ray = Ray::new(Vec3A::ZERO, Vec3A::X, RayKind::Camera);
    assert!(!world.any_hit(&ray, &mut Scratch::new()));
}

/// The deepest plans are walked through on the stack of an ordinary thread.
#[test]
fn the_deepest_nest_is_built_traced_and_dropped() {
    let mut rng = Rng(9);
    let mut scene = Scene::new();
    scene.add(mesh(&mut rng, "large", 60));
    let scene = Arc::new(scene);
    for technique in registry::names() {
        let mut node = Node::rest();
        for _ in 1..Plan::DEEPEST {
            node = Node::nest(technique, vec![node]);
        }
        let (plan, scene) = (Plan::new(node), Arc::clone(&scene));
        if crate::check::check(&plan, &scene).is_err() {
            continue;
        }
        let deep = std::thread::Builder::new().stack_size(2 << 20).spawn(move || {
            let text = Plan::from_json(&plan.to_json()).expect("it is a plan");
            answers(&scene, &text)
        });
        let deep = deep.expect("a thread").join().expect("it does not overflow");
        let plain = answers(&scene_of(&mut Rng(9)), &Plan::new(Node::rest()));
        assert_eq!(deep, plain, "{technique}");
    }
}

fn scene_of(rng: &mut Rng) -> Scene {
    let mut scene = Scene::new();
    scene.add(mesh(rng, "large", 60));
    scene
}

/// Where the first child of a world reaches to; instances share what is in them.
fn first_bounds(world: &dyn Object) -> [f32; 3] {
    let mut found = None;
    world.visit_children(&mut |child| {
        found.get_or_insert_with(|| child.bounds().max.to_array());
    });
    found.expect("there is a child")
}

#[test]
fn what_moves_from_frame_to_frame_is_built_anew_and_the_rest_is_kept() {
    let mut rng = Rng(21);
    let mut scene = Scene::new();
    let geometries = vec![scene.add_apart(spheres(&mut rng, "dots", 30))];
    let inner = scene.add_group(Group { geometries, ..Group::default() });
    let at = |x: f32| Motion::Still(Affine3A::from_translation(Vec3::new(x, 0.0, 0.0)));
    let place = |x| Place { name: String::new(), group: inner, motion: at(x) };
    let outer = scene.add_group(Group { places: vec![place(0.0)], ..Group::default() });
    scene.place(outer, at(0.0));
    let plan = single("bvh", Map::new(), &scene).expect("known");
    let mut builder = super::Builder::new(&plan);
    let mut last = f32::NEG_INFINITY;
    for x in [0.0, 1.0, 2.0] {
        scene.groups[outer].places[0].motion = at(x);
        let world = builder.build(&scene).expect("sound");
        let alone = build(&plan, &scene).expect("sound");
        assert_eq!(first_bounds(&world), first_bounds(&alone));
        assert!(first_bounds(&world)[0] > last);
        last = first_bounds(&world)[0];
    }
    let (_, before) = builder.before.clone().expect("it was built");
    builder.build(&scene).expect("sound");
    let (_, after) = builder.before.expect("it was built");
    let mut pairs = before.iter().zip(&after);
    assert!(pairs.all(|(a, b)| Arc::ptr_eq(&a.object, &b.object)), "nothing moved");
}
