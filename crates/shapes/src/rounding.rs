//! What rounding does to hits, and how much room it needs.

use crate::shape::Crossing;

/// The crossing found anew before its rounding, among the `(t, front)` that `roots` shows: far
/// from the origin of the ray the rounding of `t` alone moves a point a long way.
pub(crate) fn unrounded(crossing: &Crossing, roots: impl FnOnce(&mut dyn FnMut(f64, bool))) -> f64 {
    let mut exact = f64::from(crossing.t);
    roots(&mut |t, front| {
        if t as f32 == crossing.t && front == crossing.front {
            exact = t;
        }
    });
    exact
}

/// How far rounding may move a point of a shape, or a wall of a cell, of this reach. Twice
/// what the padding of boxes allows for.
pub(crate) fn slack(reach: f32) -> f64 {
    f64::from(reach) * 1e-6 + 1e-30
}
