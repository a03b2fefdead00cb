//! Tests: what random lines do, beside what a technique expects of them.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::accel::Accel;
use nestray_core::family::Family;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_core::simd::SCALAR;
use nestray_core::technique::{Asks, Index, Leaf, Technique, Walk};
use nestray_core::trail::Trail;
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::Single;
use nestray_shapes::sphere::Sphere;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Random numbers, the same for the same seed.
pub(crate) struct Numbers(Pcg64Mcg);

impl Numbers {
    pub(crate) fn new(seed: u64) -> Self {
        Self(Pcg64Mcg::seed_from_u64(seed))
    }

    /// In `[0, 1)`.
    pub(crate) fn next(&mut self) -> f32 {
        self.0.random()
    }

    pub(crate) fn point(&mut self) -> Vec3A {
        Vec3A::new(self.next(), self.next(), self.next())
    }

    pub(crate) fn direction(&mut self) -> Vec3A {
        loop {
            let dir = self.point() * 2.0 - 1.0;
            if (0.01..=1.0).contains(&dir.length()) {
                return dir.normalize();
            }
        }
    }

    /// A line such that all that meet `bounds` are as likely.
    pub(crate) fn line(&mut self, bounds: &Aabb) -> Ray {
        let radius = 0.51 * bounds.size().length();
        loop {
            let dir = self.direction();
            let (u, v) = dir.any_orthonormal_pair();
            let at = (u * (self.next() * 2.0 - 1.0) + v * (self.next() * 2.0 - 1.0)) * radius;
            let ray = Ray::new(bounds.center() + at - dir * (2.0 * radius), dir, RayKind::Camera);
            if Clip::new(&ray, bounds.reach()).cut(bounds, f32::INFINITY).is_some() {
                return ray;
            }
        }
    }
}

/// Sends a ray through an index, which is not yet renamed; calls `leaf` for all leaves and returns
/// the number of steps.
pub(crate) fn walk<I: Index>(
    index: &I,
    family: &dyn Family,
    ray: &Ray,
    mut leaf: impl FnMut(Leaf, &I::Cursor),
) -> usize {
    let mut trail = Trail::new();
    let mut walk = Walk { ray, trail: &mut trail, family };
    let limit = ray.t_max();
    let (mut cursor, mut at) = index.start(SCALAR, &mut walk, limit);
    let mut steps = 0;
    while !at.is_done() {
        if at.is_onward() {
            steps += 1;
            at = index.step::<_, Asks<false, false>>(SCALAR, &mut walk, &mut cursor, at, limit);
        } else {
            leaf(at.as_leaf(), &cursor);
            at = index.resume::<_, Asks<false, false>>(SCALAR, &mut walk, &mut cursor, limit);
        }
    }
    steps
}

/// Says what lines are expected to do and do: steps, then tests.
pub(crate) fn expected_and_counted<T: Technique>(
    technique: &T,
    shapes: &[AnyShape],
    seed: u64,
) -> [[f64; 2]; 2] {
    const LINES: u32 = 20_000;
    let object = |shape: &AnyShape| Arc::new(Single::new(0, shape.clone())) as DynObject;
    let nest = Accel::new(technique.clone(), shapes.iter().map(object).collect::<Vec<_>>());
    let (mut numbers, mut scratch) = (Numbers::new(seed), Scratch::counting());
    for _ in 0..LINES {
        nest.all_hits(&numbers.line(&nest.bounds()), &mut Vec::new(), &mut scratch);
    }
    let total = scratch.counters.total();
    let each = |count: u64| count as f64 / f64::from(LINES);
    let tests = nest.expected().tests.iter().map(|&tests| f64::from(tests)).sum();
    [[nest.expected().steps, each(total.all_steps())], [tests, each(total.all_tests())]]
}

/// Spheres of two sizes all over the place.
pub(crate) fn spheres(count: u32, seed: u64) -> Vec<AnyShape> {
    let mut numbers = Numbers::new(seed);
    let one = |i: u32| Sphere {
        center: numbers.point() * 10.0,
        radius: if i.is_multiple_of(10) { 0.6 } else { 0.1 },
    };
    (0..count).map(one).map(AnyShape::from).collect()
}
