//! Odd worlds: everything in one place, shell in shell, one huge thing among tiny ones. Every
//! technique builds them with little stack and no more memory than random ones take, and answers
//! as a list does.
#![expect(clippy::print_stdout, reason = "how long it took is for people to look at")]

use std::thread;
use std::time::Instant;

use glam::Vec3A;
use nestray_core::cost::CostModel;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_registry::{Entry, Members, TECHNIQUES, find};
use nestray_shapes::any::AnyShape;
use nestray_shapes::parallelogram::Parallelogram;
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;
use nestray_tests::numbers::Numbers;
use serde_json::Value;

/// Bytes of stack a builder gets.
const STACK: usize = 256 << 10;
/// How many times the memory of random input odd input may take.
const MEMORY: u64 = 4;

/// Children of each world; `NESTRAY_CHILDREN` asks for another number.
fn children() -> usize {
    std::env::var("NESTRAY_CHILDREN").ok().and_then(|n| n.parse().ok()).unwrap_or(2_000)
}

/// Whether a technique is built: every one, or those `NESTRAY_TECHNIQUES` names.
fn is_asked_for(name: &str) -> bool {
    let asked = std::env::var("NESTRAY_TECHNIQUES");
    asked.map_or(true, |asked| asked.split(',').any(|one| one == name))
}

fn ball(center: Vec3A, radius: f32) -> AnyShape {
    Sphere { center, radius }.into()
}

/// The worlds, by what they are; the first is random.
fn worlds(count: usize) -> Vec<(&'static str, Vec<AnyShape>)> {
    let mut numbers = Numbers::new(31);
    let mut all = |one: &mut dyn FnMut(&mut Numbers, usize) -> AnyShape| {
        (0..count).map(|i| one(&mut numbers, i)).collect::<Vec<_>>()
    };
    let part = |i: usize| i as f32 / count as f32;
    vec![
        ("random", all(&mut |numbers, _| ball(numbers.point(), 0.01))),
        ("in one place", all(&mut |_, _| ball(Vec3A::ONE, 0.5))),
        ("shell in shell", all(&mut |_, i| ball(Vec3A::ONE, libm::exp2f(-((i % 100) as f32))))),
        (
            "one huge",
            all(&mut |numbers, i| match i {
                0 => ball(Vec3A::ZERO, 1e4),
                _ => ball(numbers.point(), 1e-4),
            }),
        ),
        ("about one point", all(&mut |_, i| ball(Vec3A::ONE, 0.1 + part(i)))),
        ("in a row", all(&mut |_, i| ball(Vec3A::X * part(i) * 100.0, 0.01))),
        (
            "without thickness",
            all(&mut |numbers, _| {
                let corner = numbers.point() * Vec3A::new(1.0, 1.0, 0.0);
                Parallelogram { corner, u: Vec3A::X * 0.02, v: Vec3A::Y * 0.02 }.into()
            }),
        ),
    ]
}

fn nest(entry: &Entry, shapes: &[AnyShape]) -> DynObject {
    let single = |(i, shape): (u32, &AnyShape)| Single::new(i, shape.clone());
    let members = Members::Shapes((0..).zip(shapes).map(single).collect());
    (entry.build)(&Value::Null, members).expect("defaults")
}

fn hits(world: &dyn Object) -> Vec<Hit> {
    let (mut numbers, mut scratch) = (Numbers::new(32), Scratch::new());
    let mut hits = Vec::new();
    for _ in 0..50 {
        let from = numbers.point() * 8.0 - 4.0;
        let ray = Ray::new(from, numbers.point() - from, RayKind::Diffuse);
        let mut hit = Hit::none(ray.t_max());
        world.closest_hit(&ray, &mut hit, &mut scratch);
        hits.push(hit);
    }
    hits
}

#[test]
fn odd_worlds_are_built_with_little_stack_and_memory_and_answered_as_by_lists() {
    let worlds = worlds(children());
    let list = find("list").expect("it is in the registry");
    let expected: Vec<_> = worlds.iter().map(|(_, shapes)| hits(&*nest(list, shapes))).collect();
    for entry in TECHNIQUES.iter().filter(|entry| is_asked_for(entry.name)) {
        let mut usual = 0;
        for ((name, shapes), expected) in worlds.iter().zip(&expected) {
            let begin = Instant::now();
            let build = || nest(entry, shapes);
            let built = thread::scope(|scope| {
                let builder = thread::Builder::new().stack_size(STACK);
                let running = builder.spawn_scoped(scope, build).expect("a thread");
                running.join().expect("it builds")
            });
            let seconds = begin.elapsed().as_secs_f32();
            assert!(hits(&*built) == *expected, "{} over a world {name}", entry.name);
            let bytes = built.cost(CostModel::usual()).bytes;
            println!("{:20} {name:20} {seconds:8.2} s {:6} MB", entry.name, bytes >> 20);
            if usual == 0 {
                usual = bytes;
            }
            assert!(
                bytes <= MEMORY * usual,
                "{} over a world {name}: {bytes} bytes, {usual} over a random one",
                entry.name
            );
        }
    }
}
