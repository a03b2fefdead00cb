//! Random nests answer as nested lists do, bit for bit.

use nestray_core::aabb::Aabb;
use nestray_core::object::Object;
use nestray_tests::compare::assert_equal;
use nestray_tests::nests::{Spec, Way};
use nestray_tests::numbers::Numbers;
use nestray_tests::rays::hard;

/// Rays over all nests; `NESTRAY_RAYS` asks for another number.
fn rays() -> usize {
    std::env::var("NESTRAY_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(400_000)
}

#[test]
fn nests_to_depth_5_agree_with_lists() {
    const EACH: usize = 1_000;
    for seed in 0..(rays() / EACH) as u64 {
        let mut numbers = Numbers::new(seed);
        let depth = 1 + numbers.below(5);
        let spec = Spec::random(&mut numbers, depth);
        let (oracle, aims) = spec.realise(&mut Way::Lists);
        let (nest, _) = spec.realise(&mut Way::Nested(numbers));
        let bounds = match oracle.bounds() {
            bounds if bounds.is_empty() => Aabb { min: glam::Vec3A::ZERO, max: glam::Vec3A::ONE },
            bounds => bounds,
        };
        let rays = hard(seed, bounds, &aims, EACH);
        assert_equal(&oracle, &nest, &rays, &format!("nest of depth {depth}, seed {seed}"));
    }
}
