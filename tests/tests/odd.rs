//! Odd worlds: everything in one place, shell in shell, one huge thing among tiny ones. Every
//! technique builds them with little stack and no more memory than random ones take, and answers
//! as a list does.
#![expect(clippy::print_stdout, reason = "how long it took is for people to look at")]

use std::fs;
use std::sync::Arc;
use std::thread;
use std::time::Instant;

use glam::{Affine3A, Quat, Vec3, Vec3A};
use nestray_core::cost::CostModel;
use nestray_core::hit::Hit;
use nestray_core::moving::{Keys, Moving};
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

/// Worlds, by what they are; the first is random.
type Worlds = Vec<(&'static str, Members)>;

/// A ball that moves: its radius, where it is at first and in the end.
type Mover = (f32, [Vec3A; 2]);

/// Worlds of what stands still.
fn still(count: usize) -> Worlds {
    let mut numbers = Numbers::new(31);
    let mut all = |one: &mut dyn FnMut(&mut Numbers, usize) -> AnyShape| {
        let single = |i| Single::new(i as u32, one(&mut numbers, i));
        Members::Shapes((0..count).map(single).collect())
    };
    let part = |i: usize| i as f32 / count as f32;
    // However many there are, as many are at each point.
    let size = 0.126 / libm::cbrtf(count as f32);
    let width = 0.9 / (count as f32).sqrt();
    vec![
        ("random", all(&mut |numbers, _| ball(numbers.point(), size))),
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
                Parallelogram { corner, u: Vec3A::X * width, v: Vec3A::Y * width }.into()
            }),
        ),
    ]
}

/// Worlds of balls that move, each from one place to another.
fn moving(count: usize) -> Worlds {
    let mut numbers = Numbers::new(33);
    let inside = nest("bvh", Members::Shapes(vec![Single::new(0, ball(Vec3A::ZERO, 1.0))]));
    let mut all = |one: &mut dyn FnMut(&mut Numbers, usize) -> Mover| {
        let object = |i| {
            let (size, ends) = one(&mut numbers, i);
            let place = |at: Vec3A| {
                Affine3A::from_scale_rotation_translation(
                    Vec3::splat(size),
                    Quat::IDENTITY,
                    at.into(),
                )
            };
            let [from, to] = ends.map(place);
            let keys = Keys::new(vec![(0.0, from), (1.0, to)]).expect("times ascend");
            Arc::new(Moving::new(i as u32, Arc::clone(&inside), keys)) as DynObject
        };
        Members::Objects((0..count).map(object).collect())
    };
    let part = |i: usize| i as f32 / count as f32;
    let size = 0.126 / libm::cbrtf(count as f32);
    let way = Vec3A::new(0.1, 0.2, -0.1);
    vec![
        ("moving at random", all(&mut |numbers, _| (size, [numbers.point(), numbers.point()]))),
        (
            "moving slowly",
            all(&mut |numbers, _| {
                let from = numbers.point();
                (size, [from, from + numbers.direction() * size * 10.0])
            }),
        ),
        ("moving as one", all(&mut |_, _| (0.5, [Vec3A::ONE, Vec3A::ONE + way]))),
        ("moving apart", all(&mut |numbers, _| (0.1, [Vec3A::ONE, numbers.point() * 3.0]))),
        (
            "moving to and fro",
            all(&mut |_, i| {
                let side = if i % 2 == 0 { 1.0 } else { -1.0 };
                (0.01, [Vec3A::X * side, Vec3A::X * -side])
            }),
        ),
        (
            "shells that move",
            all(&mut |_, i| (libm::exp2f(-((i % 100) as f32)), [Vec3A::ONE, Vec3A::ONE + way])),
        ),
        (
            "one huge that moves",
            all(&mut |numbers, i| match i {
                0 => (1e4, [Vec3A::ZERO, way]),
                _ => (1e-4, [numbers.point(), numbers.point()]),
            }),
        ),
        (
            "moving in a row",
            all(&mut |_, i| {
                let from = Vec3A::X * part(i) * 100.0;
                (0.01, [from, from + Vec3A::X])
            }),
        ),
    ]
}

fn nest(technique: &str, members: Members) -> DynObject {
    let entry = find(technique).expect("it is in the registry");
    (entry.build)(&Value::Null, members).expect("defaults")
}

fn hits(world: &dyn Object) -> Vec<Hit> {
    let (mut numbers, mut scratch) = (Numbers::new(32), Scratch::new());
    let mut hits = Vec::new();
    for _ in 0..50 {
        let from = numbers.point() * 8.0 - 4.0;
        let ray = Ray::new(from, numbers.point() - from, RayKind::Diffuse);
        let ray = ray.at_time(numbers.unit());
        let mut hit = Hit::none(ray.t_max());
        world.closest_hit(&ray, &mut hit, &mut scratch);
        hits.push(hit);
    }
    hits
}

/// Runs with little stack.
fn with_little_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    thread::scope(|scope| {
        let builder = thread::Builder::new().stack_size(STACK);
        let running = builder.spawn_scoped(scope, work).expect("a thread");
        running.join().expect("it builds")
    })
}

/// Kilobytes this process has, and the most it had since it was last asked, where one can know.
fn kilobytes() -> [u64; 2] {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let of = |what: &str| {
        let line = status.lines().find_map(|line| line.strip_prefix(what))?;
        line.split_whitespace().next()?.parse().ok()
    };
    let found = ["VmRSS:", "VmHWM:"].map(|what| of(what).unwrap_or(0));
    // If that cannot be written, the most is since the beginning.
    let _ = fs::write("/proc/self/clear_refs", "5");
    found
}

/// Seconds that all threads of this process have worked, where one can know.
fn worked() -> f64 {
    let all = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name of the program, in brackets, may hold anything.
    let fields = all.rsplit(')').next().unwrap_or_default().split_whitespace();
    let ticks = fields.skip(11).take(2).map(|ticks| ticks.parse::<f64>().unwrap_or(0.0));
    ticks.sum::<f64>() / 100.0
}

/// Builds each of the worlds by one technique and asks it; the first says what is usual.
fn build_and_ask(entry: &Entry, worlds: &Worlds, expected: &[Vec<Hit>]) {
    let mut usual = None;
    for ((name, members), expected) in worlds.iter().zip(expected) {
        let members = members.clone();
        let (before, begin, work) = (kilobytes()[0], Instant::now(), worked());
        let built = with_little_stack(|| nest(entry.name, members));
        let (seconds, work) = (begin.elapsed().as_secs_f64(), worked() - work);
        let peak = kilobytes()[1].saturating_sub(before) >> 10;
        let begin = Instant::now();
        assert!(hits(&*built) == *expected, "{} over a world {name}", entry.name);
        let asked = begin.elapsed().as_secs_f64();
        let bytes = built.cost(CostModel::usual()).bytes;
        let (worked, byte) = *usual.get_or_insert((work, bytes));
        println!(
            "{:18} {name:20} {seconds:7.2} s, worked {work:7.2} s {:5.2}; {:5} MB {:5.2}, peak {peak} MB; \
             asked {asked:.3} s",
            entry.name,
            work / worked.max(0.01),
            bytes >> 20,
            bytes as f64 / byte as f64,
        );
        assert!(
            bytes <= MEMORY * byte,
            "{} over a world {name}: {bytes} bytes, {byte} over a random one",
            entry.name
        );
    }
}

fn hold(worlds: &Worlds) {
    let expected: Vec<_> =
        worlds.iter().map(|(_, members)| hits(&*nest("list", members.clone()))).collect();
    for entry in TECHNIQUES.iter().filter(|entry| is_asked_for(entry.name)) {
        build_and_ask(entry, worlds, &expected);
    }
}

#[test]
fn odd_worlds_are_built_with_little_stack_and_memory_and_answered_as_by_lists() {
    hold(&still(children()));
}

#[test]
fn odd_worlds_that_move_are_built_with_little_stack_and_memory_and_answered_as_by_lists() {
    hold(&moving(children()));
}
