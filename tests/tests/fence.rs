//! Objects behind fences are hit as those without, and reached less often.

use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3, Vec3A};
use nestray_core::cost::CostModel;
use nestray_core::fence::{Fenced, Planes};
use nestray_core::instance::Instance;
use nestray_core::object::{DynObject, Object};
use nestray_registry::{Members, find};
use nestray_shapes::any::AnyShape;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::disk::Disk;
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;
use nestray_tests::compare::assert_equal;
use nestray_tests::numbers::Numbers;
use nestray_tests::{rays, worlds};
use serde_json::Value;

type Maker = fn(&dyn Object) -> Option<Planes>;

const KINDS: [Maker; 2] = [Planes::turned_box, Planes::slabs];

fn aggregate(technique: &str, members: Members) -> DynObject {
    let entry = find(technique).expect("there is such a technique");
    (entry.build)(&Value::Null, members).expect("settings in range")
}

/// One object for each child, and all triangles as one.
fn objects(members: &Members) -> Vec<DynObject> {
    match members {
        Members::Objects(objects) => objects.clone(),
        Members::Shapes(shapes) => shapes
            .iter()
            .map(|one| one.shape.clone().into_object(one.geometry, one.primitive, one.sides))
            .collect(),
        triangles @ Members::Triangles(_) => vec![aggregate("bvh", triangles.clone())],
    }
}

fn fenced(object: &DynObject, maker: Maker) -> DynObject {
    match maker(&**object) {
        Some(planes) => Arc::new(Fenced::new(Arc::clone(object), planes)),
        None => Arc::clone(object),
    }
}

#[test]
fn every_family_of_children_is_hit_as_in_the_list() {
    for seed in 0..3 {
        for world in worlds::families(seed).into_iter().chain(worlds::crowds(seed)) {
            let oracle = world.oracle();
            let rays = rays::hard(seed, world.bounds(), &world.aims, 4_000);
            for (number, maker) in KINDS.into_iter().enumerate() {
                let children = objects(&world.members).iter().map(|o| fenced(o, maker)).collect();
                let nest = aggregate("bvh", Members::Objects(children));
                let what = format!("{}, fence {number}, seed {seed}", world.name);
                assert_equal(&*oracle, &*nest, &rays, &what);
            }
        }
    }
}

/// Rods, plates and balls stretched to either, all askew.
fn askew(numbers: &mut Numbers, count: usize) -> Vec<DynObject> {
    let one = |i: usize| -> DynObject {
        let (at, dir) = (numbers.point() * 10.0, numbers.direction());
        let single = |shape: AnyShape| Single::new(i as u32, shape);
        match i % 3 {
            0 => {
                let (base, top) = (at - dir, at + dir);
                Arc::new(single(Cylinder { base, top, radius: 0.02 }.into()))
            }
            1 => Arc::new(single(Disk { center: at, normal: dir, radius: 0.5 }.into())),
            _ => {
                let ball = Sphere { center: Vec3A::ZERO, radius: 1.0 };
                let thin = *numbers.pick(&[0.03, 0.3, 1.0]);
                let turn = Quat::from_rotation_arc(Vec3::Z, dir.into());
                let place = Affine3A::from_scale_rotation_translation(
                    Vec3::new(thin, 0.03, 1.0),
                    turn,
                    at.into(),
                );
                Arc::new(Instance::new(1, single(ball.into()), place))
            }
        }
    };
    (0..count).map(one).collect()
}

#[test]
fn rods_and_plates_are_hit_as_in_the_list() {
    for seed in 0..4 {
        let mut numbers = Numbers::new(seed);
        let objects = askew(&mut numbers, 120);
        let aims: Vec<Vec3A> = objects.iter().map(|object| object.bounds().center()).collect();
        let oracle = aggregate("list", Members::Objects(objects.clone()));
        let rays = rays::hard(seed, oracle.bounds(), &aims, 10_000);
        for (number, maker) in KINDS.into_iter().enumerate() {
            let children = objects.iter().map(|object| fenced(object, maker)).collect();
            let nest = aggregate("bvh", Members::Objects(children));
            assert_equal(&*oracle, &*nest, &rays, &format!("fence {number}, seed {seed}"));
        }
    }
}

#[test]
fn turned_boxes_fit_what_lies_askew() {
    let dir = Vec3A::new(1.0, 0.7, -0.5).normalize();
    let rod = Cylinder { base: -dir, top: dir, radius: 0.03 };
    let rod: DynObject = Arc::new(Single::new(0, rod));
    let planes = Planes::turned_box(&*rod).expect("it has bounds");
    let share = Fenced::new(Arc::clone(&rod), planes).share();
    assert!((0.01..0.15).contains(&share), "a turned box lets {share} of the rays through");
    let slabs = Planes::slabs(&*rod).expect("it has bounds");
    assert!(slabs.share(&rod.bounds()) < 0.5);
    // A box along the axes is as tight as can be around itself.
    let ball: DynObject = Arc::new(Single::new(0, Sphere { center: Vec3A::ONE, radius: 2.0 }));
    let planes = Planes::turned_box(&*ball).expect("it has bounds");
    assert!(planes.share(&ball.bounds()) > 0.8);
}

#[test]
fn only_what_is_dear_gets_a_fence_unless_told() {
    let rod = Cylinder { base: Vec3A::ZERO, top: Vec3A::new(1.0, 1.0, 0.9), radius: 0.01 };
    let rod: DynObject = Arc::new(Single::new(0, rod));
    let mut model = CostModel::default();
    model.primitive.insert("cylinder".into(), 2.0);
    assert!(Fenced::if_it_pays(&rod, &model).is_none());
    model.primitive.insert("cylinder".into(), 500.0);
    let fenced = Fenced::if_it_pays(&rod, &model).expect("it pays");
    assert!(fenced.cost(&model).nanos() < 0.5 * rod.cost(&model).nanos());
    assert_eq!(fenced.kind(), "fence");
}
