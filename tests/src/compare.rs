//! Comparison with exhaustive search, bit for bit.

use std::ops::Range;

use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::Ray;
use nestray_core::scratch::Scratch;
use nestray_core::simd::Level;

/// Asserts that `nest` answers every query as `oracle` does: closest, any and all hits, one
/// ray at a time and in batches, on every vector level of this machine.
///
/// # Panics
/// If an answer differs; says which.
pub fn assert_equal(oracle: &dyn Object, nest: &dyn Object, rays: &[Ray], what: &str) {
    let mut scratch = Scratch::new();
    let mut hits = Vec::with_capacity(rays.len());
    for (i, ray) in rays.iter().enumerate() {
        let (expected, found) =
            (closest(oracle, ray, &mut scratch), closest(nest, ray, &mut scratch));
        assert!(same(&expected, &found), "{what}, ray {i}: {expected:?} but {found:?} for {ray:?}");
        let any = nest.any_hit(ray, &mut scratch);
        assert_eq!(any, expected.is_some(), "{what}, any hit of ray {i}: {expected:?} for {ray:?}");
        if i % 4 == 0 {
            let (expected, found) = (all(oracle, ray, &mut scratch), all(nest, ray, &mut scratch));
            assert_eq!(expected, found, "{what}, all hits of ray {i}: {ray:?}");
        }
        if i % 8 == 0 && found.is_some() {
            let (expected, found) = (oracle.surface(ray, &found), nest.surface(ray, &found));
            assert_eq!(expected, found, "{what}, surface of ray {i}: {ray:?}");
        }
        hits.push(found);
    }
    for level in Level::available().into_iter().chain([Scratch::counting().level]) {
        assert_batches(nest, rays, &hits, level, what);
    }
}

/// Batches on a level against what single rays found.
fn assert_batches(nest: &dyn Object, rays: &[Ray], expected: &[Hit], level: Level, what: &str) {
    let mut scratch = Scratch::with_level(level);
    let mut hits: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
    let mut blocked = vec![false; rays.len()];
    for batch in batches(rays.len()) {
        nest.closest_hits(&rays[batch.clone()], &mut hits[batch.clone()], &mut scratch);
        nest.any_hits(&rays[batch.clone()], &mut blocked[batch], &mut scratch);
    }
    for (i, expected) in expected.iter().enumerate() {
        let ray = &rays[i];
        let found = &hits[i];
        assert!(
            same(expected, found),
            "{what}, batch on {level:?}, ray {i}: {expected:?} but {found:?} for {ray:?}"
        );
        assert_eq!(
            blocked[i],
            expected.is_some(),
            "{what}, any hits on {level:?}, ray {i}: {ray:?}"
        );
    }
    for (i, ray) in rays.iter().enumerate().step_by(7) {
        let found = closest(nest, ray, &mut scratch);
        assert!(same(&expected[i], &found), "{what}, single on {level:?}, ray {i}: {ray:?}");
    }
}

/// All of `count` in batches of 1, 2, 3, 5, 8, … up to 4096.
fn batches(count: usize) -> impl Iterator<Item = Range<usize>> {
    let mut sizes = (1, 2);
    let mut end = 0;
    std::iter::from_fn(move || {
        let start = end;
        end = count.min(start + sizes.0);
        sizes = (sizes.1, (sizes.0 + sizes.1).min(4096));
        (start < end).then_some(start..end)
    })
}

/// The nearest hit.
pub fn closest(object: &dyn Object, ray: &Ray, scratch: &mut Scratch) -> Hit {
    let mut hit = Hit::none(ray.t_max());
    let found = object.closest_hit(ray, &mut hit, scratch);
    assert_eq!(found, hit.is_some(), "the answer and the hit disagree for {ray:?}");
    hit
}

/// All hits, sorted, each once.
pub fn all(object: &dyn Object, ray: &Ray, scratch: &mut Scratch) -> Vec<Hit> {
    let mut hits = Vec::new();
    object.all_hits(ray, &mut hits, scratch);
    let key = |hit: &Hit| (hit.t.to_bits(), hit.id(), hit.u.to_bits(), hit.v.to_bits());
    hits.sort_by_key(key);
    hits.dedup_by_key(|hit| key(hit));
    hits
}

/// The same bits; a zero may have either sign.
fn same(a: &Hit, b: &Hit) -> bool {
    a == b
}
