//! What is built while rays fly is right whoever builds it: many threads come to fresh nests at
//! once, and each is answered as by a list.

use std::sync::Barrier;
use std::thread;

use nestray_core::hit::Hit;
use nestray_core::lazy::Lazy;
use nestray_core::object::Object;
use nestray_core::ray::Ray;
use nestray_core::scratch::Scratch;
use nestray_registry::hybrid::{self, Filling};
use nestray_registry::{Entry, find};
use nestray_tests::rays::{following, hard, lamps, lit};
use nestray_tests::worlds::{World, families};
use serde_json::Value;

/// Threads that come to one nest.
const THREADS: usize = 64;

/// Fresh nests of each technique; `NESTRAY_BUILDS` asks for another number.
fn builds() -> u64 {
    std::env::var("NESTRAY_BUILDS").ok().and_then(|n| n.parse().ok()).unwrap_or(25)
}

/// Techniques that make lists when rays come.
fn lazy_techniques() -> Vec<&'static Entry> {
    ["light-buffer", "eye-buffer", "ray-classification", "ray-coherence"]
        .iter()
        .map(|name| find(name).expect("it is in the registry"))
        .collect()
}

/// What a ray is answered: the nearest hit, and whether there is any.
fn answer(world: &dyn Object, ray: &Ray, scratch: &mut Scratch) -> (Hit, bool) {
    let mut hit = Hit::none(ray.t_max());
    world.closest_hit(ray, &mut hit, scratch);
    (hit, world.any_hit(ray, scratch))
}

/// All threads ask at once, each beginning with another ray.
fn ask_at_once(nest: &dyn Object, rays: &[Ray], expected: &[(Hit, bool)], what: &str) {
    let begin = Barrier::new(THREADS);
    let ask = |first: usize| {
        let mut scratch = Scratch::new();
        begin.wait();
        for i in (0..rays.len()).map(|i| (i + first) % rays.len()) {
            let found = answer(nest, &rays[i], &mut scratch);
            assert_eq!(found, expected[i], "{what}: ray {i}, {:?}", rays[i]);
        }
    };
    let ask = &ask;
    thread::scope(|scope| {
        for first in 0..THREADS {
            scope.spawn(move || ask(first));
        }
    });
}

fn worlds() -> Vec<World> {
    families(5)
        .into_iter()
        .filter(|world| ["objects", "loose triangles"].contains(&world.name))
        .collect()
}

#[test]
fn sixty_four_threads_that_come_to_fresh_nests_are_answered_as_by_lists() {
    for world in worlds() {
        let oracle = world.oracle();
        let lamps = lamps(world.bounds());
        let mut rays = hard(6, world.bounds(), &world.aims, 24);
        rays.extend(following(7, &oracle, &rays));
        rays.extend(lit(8, &lamps, &rays[..24]));
        let mut scratch = Scratch::new();
        let expected: Vec<_> = rays.iter().map(|ray| answer(&oracle, ray, &mut scratch)).collect();
        for build in 0..builds() {
            for entry in lazy_techniques() {
                let settings = (entry.aimed)(&Value::Null, &lamps).expect("defaults");
                let nest = (entry.build)(&settings, world.members.clone()).expect("defaults");
                let what = format!("{} over {}, build {build}", entry.name, world.name);
                ask_at_once(&nest, &rays, &expected, &what);
            }
            let members = world.members.clone();
            let bvh = find("bvh").expect("it is in the registry");
            let late = Lazy::new(world.oracle(), move || {
                (bvh.build)(&Value::Null, members.clone()).expect("defaults")
            });
            ask_at_once(&late, &rays, &expected, &format!("lazy over {}, {build}", world.name));
            for above in ["bvh", "grid"] {
                let above = find(above).expect("it is in the registry");
                let inner = Filling { is_lazy: true, more_than: 2, ..Filling::new(bvh) };
                let leaves = Filling { leaves: Some(Box::new(inner.clone())), ..inner };
                let leaves = Filling { more_than: 6, per_leaf: 16, ..leaves };
                let members = world.members.clone();
                let nest = hybrid::build(above, &Value::Null, Some(&leaves), members);
                let what = format!("{} over lazy {}, {build}", above.name, world.name);
                ask_at_once(&nest.expect("defaults"), &rays, &expected, &what);
            }
        }
    }
}
