//! Random lines, sent through an index where no formula says what they do.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::simd::SCALAR;
use nestray_core::technique::{Every, Index, Leaf, Walk};
use nestray_core::trail::Trail;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// Sends `lines` random lines that meet `bounds` through an index that is not yet renamed. Says
/// how many steps they take on average, and each leaf they come to.
pub(crate) fn send<I: Index>(
    index: &I,
    (lines, bounds): (u32, &Aabb),
    family: &dyn Family,
    mut leaf: impl FnMut(Leaf),
) -> f64 {
    let mut numbers = Pcg64Mcg::seed_from_u64(0);
    let (mut steps, mut trail) = (0, Trail::new());
    for _ in 0..lines {
        let (from, dir) = through(bounds, &mut numbers);
        let ray = Ray::new(from, dir, RayKind::Camera);
        let mut walk = Walk { ray: &ray, trail: &mut trail, family };
        let limit = f32::INFINITY;
        let (mut cursor, mut at) = index.start(SCALAR, &mut walk, limit);
        while !at.is_done() {
            at = if at.is_onward() {
                steps += 1;
                index.step::<_, Every>(SCALAR, &mut walk, &mut cursor, at, limit)
            } else {
                leaf(at.as_leaf());
                index.resume::<_, Every>(SCALAR, &mut walk, &mut cursor, limit)
            };
        }
    }
    f64::from(steps) / f64::from(lines)
}

/// Where a random line comes into a box, and its direction, all as likely: it comes in through any
/// point of a face, the more likely the straighter.
pub(crate) fn through(bounds: &Aabb, numbers: &mut Pcg64Mcg) -> (Vec3A, Vec3A) {
    let mut next = || numbers.random::<f32>();
    let size = bounds.size();
    let areas = [size.y * size.z, size.z * size.x, size.x * size.y];
    let mut pick = next() * (areas[0] + areas[1] + areas[2]);
    let axis = areas.iter().position(|area| {
        pick -= area;
        pick < 0.0
    });
    let axis = axis.unwrap_or(2);
    let mut point = bounds.min + Vec3A::new(next(), next(), next()) * size;
    let is_low = next() < 0.5;
    point[axis] = if is_low { bounds.min[axis] } else { bounds.max[axis] };
    loop {
        let (u, v) = (next() * 2.0 - 1.0, next() * 2.0 - 1.0);
        let inwards = 1.0 - u * u - v * v;
        if inwards > 0.0 {
            let mut dir = Vec3A::ZERO;
            dir[axis] = inwards.sqrt() * if is_low { 1.0 } else { -1.0 };
            dir[(axis + 1) % 3] = u;
            dir[(axis + 2) % 3] = v;
            return (point, dir);
        }
    }
}
