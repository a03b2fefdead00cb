//! A child during a part of the shutter, as builders see it.

use nestray_core::aabb::Aabb;
use nestray_core::family::Family;

use super::Linear;

/// A child during a part of the shutter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference {
    /// The child.
    pub(crate) child: u32,
    /// Its place among the halves looked up so far, or [`NOWHERE`](Self::NOWHERE).
    pub(super) halves: u32,
    /// A box around it.
    pub(crate) bounds: Linear,
    /// The mean area of boxes around it in short parts of the time: how small that of `bounds`
    /// might become if time were cut.
    pub(crate) snug: f32,
}

/// Parts of the time looked at, for a child that moves by less and more than its own size.
const PARTS: [f32; 2] = [4.0, 64.0];
/// Moments looked at, as parts of the time, for one that moves evenly.
const MOMENTS: [f64; 4] = [0.125, 0.375, 0.625, 0.875];

impl Reference {
    pub(super) const NOWHERE: u32 = u32::MAX;

    /// A child during `time`.
    pub(crate) fn new(family: &dyn Family, child: u32, time: [f32; 2]) -> Self {
        let always = family.bounds(child);
        let during = |time: [f32; 2]| match family.bounds_during(child, time).meet(always) {
            odd if odd.is_empty() => always,
            bounds => bounds,
        };
        let whole = during(time);
        let moment = |time: f32| during([time, time]);
        let begin = moment(time[0]);
        if begin == whole {
            let bounds = Linear::still(whole);
            return Self { child, halves: Self::NOWHERE, bounds, snug: bounds.mean_area() as f32 };
        }
        let bounds = Linear { begin, end: moment(time[1]), within: whole };
        let (extent, shift) = (begin.size().element_sum(), whole.size().element_sum());
        let parts = (8.0 * (shift - extent) / extent.max(1e-3 * shift)).clamp(PARTS[0], PARTS[1]);
        let (bounds, snug) = if family.moves_evenly(child, time) {
            // Moments will do: between them nothing is farther out.
            let moments = MOMENTS.map(|share| [lerp(time, share) as f32; 2]);
            around(bounds, time, &moments, during)
        } else {
            around(bounds, time, &spans(time, parts as usize), during)
        };
        Self { child, halves: Self::NOWHERE, bounds, snug: snug as f32 }
    }
}

/// So many equal parts of `time`.
fn spans(time: [f32; 2], parts: usize) -> Vec<[f32; 2]> {
    let moment = |part: usize| {
        let share = part as f64 / parts as f64;
        if part == parts { time[1] } else { (lerp(time, share) as f32).min(time[1]) }
    };
    (0..parts).map(|part| [moment(part), moment(part + 1)]).collect()
}

/// Moves the faces of `bounds` outwards, each by the same at all times, until it contains what
/// `during` says of each of the `spans` of `time`; and the mean area of those.
fn around(
    bounds: Linear,
    time: [f32; 2],
    spans: &[[f32; 2]],
    during: impl Fn([f32; 2]) -> Aabb,
) -> (Linear, f64) {
    let share =
        |time_at: f32| f64::from(time_at - time[0]) / (f64::from(time[1]) - f64::from(time[0]));
    let (mut low, mut high, mut snug) = ([0f64; 3], [0f64; 3], 0.0);
    for &span in spans {
        let inside = during(span);
        snug += Linear::still(inside).mean_area() / spans.len() as f64;
        for at in span.map(share) {
            for axis in 0..3 {
                let lower = lerp([bounds.begin.min[axis], bounds.end.min[axis]], at);
                let upper = lerp([bounds.begin.max[axis], bounds.end.max[axis]], at);
                low[axis] = low[axis].max(lower - f64::from(inside.min[axis]));
                high[axis] = high[axis].max(f64::from(inside.max[axis]) - upper);
            }
        }
    }
    let moved = |bounds: Aabb| {
        let mut moved = bounds;
        for axis in 0..3 {
            moved.min[axis] = ((f64::from(bounds.min[axis]) - low[axis]) as f32).next_down();
            moved.max[axis] = ((f64::from(bounds.max[axis]) + high[axis]) as f32).next_up();
        }
        moved
    };
    (Linear { begin: moved(bounds.begin), end: moved(bounds.end), ..bounds }, snug)
}

fn lerp([from, to]: [f32; 2], part: f64) -> f64 {
    f64::from(from) + (f64::from(to) - f64::from(from)) * part
}
