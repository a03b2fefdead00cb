//! Whether a ray passes through a closed line of edges: a polygon seen along the ray.
//!
//! The vertices are moved to where the ray is the main axis, by sums and products that are
//! the same for every polygon with that vertex, and an edge lies to the right of the ray or
//! to the left for both its polygons alike. So a ray at an edge goes through one of them,
//! never between [Woop 13; Haines 94].

use glam::DVec3;
use nestray_core::ray::Ray;

/// A ray's view: its main axis last, the ray itself at the origin.
struct View {
    axes: [usize; 3],
    origin: DVec3,
    shear: [f64; 2],
    along: f64,
}

impl View {
    fn new(ray: &Ray) -> Self {
        let dir = ray.dir().as_dvec3();
        let size = dir.abs();
        let main = match size.max_element() {
            longest if longest == size.x => 0,
            longest if longest == size.y => 1,
            _ => 2,
        };
        let axes = [(main + 1) % 3, (main + 2) % 3, main];
        Self {
            axes,
            origin: ray.origin().as_dvec3(),
            shear: [dir[axes[0]] / dir[main], dir[axes[1]] / dir[main]],
            along: dir[main],
        }
    }

    /// A coordinate across the ray: 0 or 1.
    #[inline(always)]
    fn across(&self, which: usize, vertex: DVec3) -> f64 {
        let (axis, main) = (self.axes[which], self.axes[2]);
        (vertex[axis] - self.origin[axis]) - self.shear[which] * (vertex[main] - self.origin[main])
    }

    fn t(&self, vertex: DVec3) -> f64 {
        (vertex[self.axes[2]] - self.origin[self.axes[2]]) / self.along
    }
}

/// The parameter at which the ray passes through the outline of `count` vertices, if it does.
/// A point is inside if an odd number of edges lie to its right.
///
/// The place is found between two edges, not from a plane, so it lies within the hull of the
/// vertices even if they are not quite in a plane or the ray is.
#[inline]
pub(crate) fn pass(ray: &Ray, count: usize, vertex: impl Fn(usize) -> DVec3) -> Option<f64> {
    let view = View::new(ray);
    let mut odd = false;
    // The nearest edges on the left and on the right: how far, and at which parameter.
    let mut left = (f64::NEG_INFINITY, 0.0);
    let mut right = (f64::INFINITY, 0.0);
    let mut before = count.checked_sub(1)?;
    let mut y_before = view.across(1, vertex(before));
    for at in 0..count {
        let y = view.across(1, vertex(at));
        if (y_before > 0.0) != (y > 0.0) {
            let (x, t, is_right) = view.cross([vertex(before), vertex(at)], [y_before, y]);
            odd ^= is_right;
            if is_right && x < right.0 {
                right = (x, t);
            } else if !is_right && x > left.0 {
                left = (x, t);
            }
        }
        (before, y_before) = (at, y);
    }
    if !odd {
        return None;
    }
    let part = left.0 / (left.0 - right.0);
    let t = if part > 0.0 { left.1 + (right.1 - left.1) * part } else { left.1 };
    Some(t.clamp(left.1.min(right.1), left.1.max(right.1)))
}

impl View {
    /// Where an edge crosses the line `y = 0`: the other coordinate, the parameter there, and
    /// whether that is to the right. The same for an edge and its reverse.
    fn cross(&self, ends: [DVec3; 2], [y0, y1]: [f64; 2]) -> (f64, f64, bool) {
        let [x0, x1] = ends.map(|end| self.across(0, end));
        let [t0, t1] = ends.map(|end| self.t(end));
        let edge = x0 * y1 - x1 * y0;
        let is_right = if y1 > y0 { edge > 0.0 } else { edge < 0.0 };
        let part = y0 / (y0 - y1);
        let x = x0 + (x1 - x0) * part;
        let x = if is_right { x.max(0.0) } else { x.min(0.0) };
        (x, t0 + (t1 - t0) * part, is_right)
    }
}
