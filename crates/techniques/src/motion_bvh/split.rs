//! Splitting in space or in time.

use super::MotionBvh;
use super::plane::best_plane;
use crate::timed_tree::{Growing, Linear, Open, Reference};

/// Splits children in two, from `halves_from` splits down in halves; gives back a single one.
pub(crate) fn split(
    params: &MotionBvh,
    growing: &mut Growing<'_>,
    mut open: Open,
    halves_from: usize,
) -> Result<[Open; 2], Open> {
    let by_area = open.depth < halves_from;
    let plane = if by_area { best_plane(params.bins, growing.of, &open.inside) } else { None };
    let cost = plane.as_ref().map_or(f64::INFINITY, |plane| plane.cost);
    if by_area && let Some(halves) = in_time(params, growing, &mut open, cost) {
        return Ok(halves);
    }
    if open.inside.len() == 1 {
        return Err(open);
    }
    let mut left = std::mem::take(&mut open.inside);
    let count = left.len() as f64;
    let right: Vec<Reference> = match plane {
        Some(plane) => left.extract_if(.., |one| !plane.is_left(one)).collect(),
        None => {
            halve(&mut left);
            left.split_off(left.len() / 2)
        }
    };
    let share = left.len() as f64 / count;
    Ok([open.part_of(left, share), open.part_of(right, 1.0 - share)])
}

/// The two halves of the time, if that is so much cheaper than a split in space for `cost`.
fn in_time(
    params: &MotionBvh,
    growing: &mut Growing<'_>,
    open: &mut Open,
    cost: f64,
) -> Option<[Open; 2]> {
    let long = f64::from(open.time[1] - open.time[0]) * f64::from(1u32 << params.halvings) > 1.0;
    let fits = 2.0 * open.inside.len() as f64 <= open.room;
    if !(long && fits && open.moves()) {
        return None;
    }
    let weight = growing.weight(&open.inside) * f64::from(params.bias);
    // One child costs its own box.
    let cost = cost.min(open.bounds().mean_area() * growing.weight(&open.inside));
    if weight * hoped_for(&open.inside) >= cost {
        return None;
    }
    let halves = growing.in_time(open);
    if halves.iter().any(|half| half.inside.is_empty()) {
        return None;
    }
    let area = halves.iter().map(|half| half.bounds().mean_area() * 0.5).sum::<f64>();
    (weight * area < cost).then_some(halves)
}

/// The mean area there may be if time is halved, without looking: each child's box goes on as
/// it does, but becomes as small as it can.
fn hoped_for(inside: &[Reference]) -> f64 {
    let mut halves = [Linear::EMPTY; 2];
    let (mut areas, mut snug) = (0.0, 0.0);
    for one in inside {
        let middle = one.bounds.uncut(0.5);
        halves[0] = halves[0].join(Linear { end: middle, ..one.bounds });
        halves[1] = halves[1].join(Linear { begin: middle, ..one.bounds });
        areas += one.bounds.mean_area();
        snug += f64::from(one.snug);
    }
    let area = halves.iter().map(|half| half.mean_area() * 0.5).sum::<f64>();
    area * (snug / areas.max(f64::MIN_POSITIVE)).min(1.0)
}

/// Puts the lower half along the longest axis first.
fn halve(inside: &mut [Reference]) {
    let all = inside.iter().fold(Linear::EMPTY, |all, one| all.join(one.bounds));
    let axis = all.within.size().max_position();
    let half = inside.len() / 2;
    let center = |one: &Reference| one.bounds.at(0.5).center()[axis];
    inside.select_nth_unstable_by(half, |a, b| {
        center(a).total_cmp(&center(b)).then(a.child.cmp(&b.child))
    });
}
