//! Rays that leave a shape do not meet it again where they left it.

use glam::{DVec3, Vec3A};
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::any::AnyShape;
use nestray_shapes::cone::Cone;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::shape::Shape;
use nestray_shapes::sphere::Sphere;

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

/// At the origin an `f32` is so fine that its own rounding moves a ray by next to nothing.
#[test]
fn a_ray_that_leaves_at_the_origin_does_not_hit_there() {
    let mut tried = 0;
    for seed in 0..300 {
        let mut numbers = Numbers(seed);
        let size = numbers.size(-3.0, 5.0) as f32;
        let below = Vec3A::NEG_Z * size;
        let axis = Vec3A::X * (size * numbers.between(0.2, 3.0) as f32);
        let drop = below * numbers.next() as f32;
        let shapes: [AnyShape; 3] = [
            Sphere { center: below, radius: size }.into(),
            Cylinder { base: below - axis, top: below + axis, radius: size }.into(),
            Cone {
                base: below - axis - drop,
                base_radius: size - drop.z,
                apex: below + axis + drop,
                apex_radius: size + drop.z,
            }
            .into(),
        ];
        for shape in shapes {
            for _ in 0..200 {
                let near = numbers.cube() * f64::from(size) * numbers.size(-14.0, -2.0);
                let dir = numbers.outward(Vec3A::Z).as_dvec3() * DVec3::new(1.0, 1.0, -1.0);
                let origin = (near - dir * f64::from(size)).as_vec3a();
                let ray = Ray::new(origin, dir.as_vec3a(), RayKind::Camera);
                for crossing in crossings(&shape, &ray) {
                    let surface = shape.surface(&ray, &crossing);
                    let out = numbers.outward(surface.normal);
                    let again = Ray::new(surface.leave(out), out, RayKind::Reflect);
                    let hits = crossings(&shape, &again);
                    let clear = hits.iter().all(|hit| hit.t < 0.0);
                    assert!(clear, "seed {seed} {shape:?} {ray:?} {again:?} {hits:?}");
                    tried += 1;
                }
            }
        }
    }
    assert!(tried > 100_000, "only {tried} rays left");
}
