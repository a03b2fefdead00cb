//! Rays that leave a shape do not meet it again where they left it.

use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::shape::Shape;

use crate::hits::crossings;
use crate::numbers::Numbers;
use crate::samples::{Form, samples};

/// Leaves convex bodies at random hits, outwards and inwards.
#[test]
fn a_ray_that_leaves_does_not_hit_where_it_left() {
    let mut tried = 0;
    for seed in 0..3_000 {
        for sample in samples(seed).iter().filter(|sample| sample.form == Form::Body) {
            let mut numbers = Numbers(seed ^ 0x1eaf);
            for _ in 0..8 {
                let ray = numbers.ray_near(sample.center, sample.size);
                for crossing in crossings(&sample.shape, &ray) {
                    let surface = sample.shape.surface(&ray, &crossing);
                    for _ in 0..8 {
                        let mut out = numbers.outward(surface.normal);
                        if numbers.below(4) == 0 {
                            // Nearly along the surface.
                            out = out.reject_from(surface.normal) + surface.normal * 1e-4;
                        }
                        let again = Ray::new(surface.leave(out), out, RayKind::Reflect);
                        let hits = crossings(&sample.shape, &again);
                        assert!(
                            hits.iter().all(|hit| hit.t < 0.0),
                            "seed {seed} {sample:?} {ray:?} {again:?} {hits:?}"
                        );
                        // Inside, the front is behind it.
                        let again = Ray::new(surface.leave(-out), -out, RayKind::Refract);
                        let hits = crossings(&sample.shape, &again);
                        assert!(
                            hits.iter().all(|hit| hit.t < 0.0 || !hit.front),
                            "seed {seed} {sample:?} {ray:?} {again:?} {hits:?}"
                        );
                        tried += 2;
                    }
                }
            }
        }
    }
    assert!(tried > 1_000_000, "only {tried} rays left");
}
