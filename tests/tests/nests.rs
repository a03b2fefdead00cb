//! Random nests answer as nested lists do, bit for bit.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_tests::compare::assert_equal;
use nestray_tests::nests::{Spec, Way};
use nestray_tests::numbers::Numbers;
use nestray_tests::rays::{following, hard};

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
        let around = aims.iter().fold(Aabb::EMPTY, |all, &aim| all.with(aim));
        let cube = Aabb { min: Vec3A::ZERO, max: Vec3A::ONE };
        let bounds = if around.is_empty() { cube } else { around };
        let mut rays = hard(seed, bounds, &aims, EACH * 3 / 4);
        rays.extend(following(seed, &oracle, &rays[..EACH / 4]));
        assert_equal(&oracle, &nest, &rays, &format!("nest of depth {depth}, seed {seed}"));
    }
}
