//! Whether a ray passes through a closed line of edges: a polygon seen along the ray.
//!
//! The vertices are moved to where the ray is the main axis, by sums and products that are
//! the same for every polygon with that vertex, and an edge lies to the right of the ray or
//! to the left for both its polygons alike. So a ray at an edge goes through one of them,
//! never between [Woop 13; Haines 94].

use glam::DVec3;
use nestray_core::ray::Ray;

/// A ray's view, along the main axis `MAIN`: the ray itself is at the origin.
struct View<const MAIN: usize> {
    origin: DVec3,
    dir: DVec3,
    shear: [f64; 2],
}

impl<const MAIN: usize> View<MAIN> {
    fn new(ray: &Ray) -> Self {
        let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
        let along = dir[MAIN];
        Self { origin, dir, shear: [dir[(MAIN + 1) % 3] / along, dir[(MAIN + 2) % 3] / along] }
    }

    #[inline(always)]
    fn x(&self, vertex: DVec3) -> f64 {
        let axis = (MAIN + 1) % 3;
        (vertex[axis] - self.origin[axis]) - self.shear[0] * (vertex[MAIN] - self.origin[MAIN])
    }

    #[inline(always)]
    fn y(&self, vertex: DVec3) -> f64 {
        let axis = (MAIN + 2) % 3;
        (vertex[axis] - self.origin[axis]) - self.shear[1] * (vertex[MAIN] - self.origin[MAIN])
    }

    fn t(&self, vertex: DVec3) -> f64 {
        (vertex[MAIN] - self.origin[MAIN]) / self.dir[MAIN]
    }

    /// Calls `found` with every edge that crosses the line `y = 0`.
    #[inline(always)]
    fn each_edge(
        &self,
        count: usize,
        vertex: impl Fn(usize) -> DVec3,
        mut found: impl FnMut([DVec3; 2], [f64; 2]),
    ) {
        let mut before = count - 1;
        let mut y_before = self.y(vertex(before));
        for at in 0..count {
            let y = self.y(vertex(at));
            if (y_before > 0.0) != (y > 0.0) {
                found([vertex(before), vertex(at)], [y_before, y]);
            }
            (before, y_before) = (at, y);
        }
    }

    /// Whether an edge crosses the line `y = 0` to the right of the ray: the same for an edge
    /// and its reverse.
    #[inline(always)]
    fn is_right(&self, ends: [DVec3; 2], [y0, y1]: [f64; 2]) -> bool {
        let edge = self.x(ends[0]) * y1 - self.x(ends[1]) * y0;
        if y1 > y0 { edge > 0.0 } else { edge < 0.0 }
    }

    /// Where an edge crosses the line `y = 0`: the other coordinate, and the parameter there.
    fn cross(&self, [from, to]: [DVec3; 2], [y0, y1]: [f64; 2]) -> (f64, f64) {
        let part = y0 / (y0 - y1);
        let (x, t) = (self.x(from), self.t(from));
        (x + (self.x(to) - x) * part, t + (self.t(to) - t) * part)
    }

    #[inline(always)]
    fn pass(&self, count: usize, vertex: impl Fn(usize) -> DVec3) -> Option<f64> {
        let mut odd = false;
        self.each_edge(count, &vertex, |ends, ys| odd ^= self.is_right(ends, ys));
        odd.then(|| self.place(count, vertex))
    }

    /// The parameter of a ray that passes through: between those at the nearest edges on its
    /// left and on its right.
    fn place(&self, count: usize, vertex: impl Fn(usize) -> DVec3) -> f64 {
        let mut left = (f64::NEG_INFINITY, 0.0);
        let mut right = (f64::INFINITY, 0.0);
        self.each_edge(count, vertex, |ends, ys| {
            let (x, t) = self.cross(ends, ys);
            // Rounding may tell the sides otherwise; the sign above decides.
            if self.is_right(ends, ys) {
                right = if x < right.0 { (x.max(0.0), t) } else { right };
            } else {
                left = if x > left.0 { (x.min(0.0), t) } else { left };
            }
        });
        let part = left.0 / (left.0 - right.0);
        let t = if part > 0.0 { left.1 + (right.1 - left.1) * part } else { left.1 };
        t.clamp(left.1.min(right.1), left.1.max(right.1))
    }
}

/// The parameter at which the ray passes through the outline of `count` vertices, if it does.
/// A point is inside if an odd number of edges lie to its right.
///
/// The place is found between two edges, not from a plane, so it lies within the hull of the
/// vertices even if they are not quite in a plane or the ray is.
#[inline]
pub(crate) fn pass(ray: &Ray, count: usize, vertex: impl Fn(usize) -> DVec3) -> Option<f64> {
    if count == 0 {
        return None;
    }
    match ray.dir().abs().max_position() {
        0 => View::<0>::new(ray).pass(count, vertex),
        1 => View::<1>::new(ray).pass(count, vertex),
        _ => View::<2>::new(ray).pass(count, vertex),
    }
}
