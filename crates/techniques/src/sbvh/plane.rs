//! Where to cut children.

use nestray_core::aabb::{Aabb, Clip};

use super::build::Knife;
use crate::bvh::part::Part;
use crate::cells::Plane;

/// Most slices along an axis.
const SLICES: usize = 16;
/// Slices for fewer parts than [`MANY`].
const FEW_SLICES: usize = 8;
const MANY: usize = 256;
/// Slices where most parts would be in many.
const LEAST_SLICES: usize = 4;
/// Where the best plane across a long axis costs so many times what is wanted, none is tried across
/// shorter ones.
const HOPELESS: f32 = 1.2;
/// Of more parts than this, some are asked for all.
const MOST_ASKED: usize = 4096;

/// The parts, or the pieces of them, in a slice.
#[derive(Clone, Copy)]
struct Slice {
    bounds: Aabb,
    /// Of the parts that begin here, and of those that end.
    begin: f32,
    end: f32,
}

/// The plane with the least `area × Σ weights` on both sides if parts are cut by it, if that seems
/// less than `cost`.
pub(super) fn best_cut(
    knife: &Knife<'_>,
    inside: &[Part],
    bounds: &Aabb,
    cost: f32,
) -> Option<Plane> {
    let every = inside.len().div_ceil(MOST_ASKED);
    let asked: Vec<Part> = inside.iter().copied().step_by(every).collect();
    let weight = |parts: &[Part]| parts.iter().map(Part::weight).sum::<f32>();
    // What those are asked for weigh more.
    let scale = weight(inside) / weight(&asked);
    let (mut best, mut least) = (None, cost / scale);
    let (mut axes, size) = ([0, 1, 2], bounds.size());
    axes.sort_by(|&a, &b| size[b].total_cmp(&size[a]));
    for axis in axes {
        let Some((plane, cost)) = best_along(axis, knife, &asked, bounds) else { continue };
        if cost > HOPELESS * least {
            break;
        }
        if cost < least {
            (best, least) = (Some(plane), cost);
        }
    }
    best
}

/// The best plane across an axis.
fn best_along(
    axis: usize,
    knife: &Knife<'_>,
    inside: &[Part],
    bounds: &Aabb,
) -> Option<(Plane, f32)> {
    let (low, size) = (bounds.min[axis], bounds.size()[axis]);
    // Slices must be wider than rounding.
    if size <= SLICES as f32 * 16.0 * Clip::SLACK * knife.reach {
        return None;
    }
    let spans: f32 = inside.iter().map(|part| part.around().bounds().size()[axis]).sum();
    let is_crowded = spans / size * SLICES as f32 > 2.0 * inside.len() as f32;
    let count = match inside.len() {
        _ if is_crowded => LEAST_SLICES,
        ..MANY => FEW_SLICES,
        _ => SLICES,
    };
    let width = size / count as f32;
    let walls: Vec<f32> = (0..=count).map(|i| low + width * i as f32).collect();
    let slices = sliced(axis, &walls, knife, inside);
    let mut right = [0.0; SLICES];
    let (mut all, mut weight) = (Aabb::EMPTY, 0.0);
    for i in (1..count).rev() {
        (all, weight) = (all.join(slices[i].bounds), weight + slices[i].end);
        right[i] = all.surface_area() * weight;
    }
    let mut best: Option<(Plane, f32)> = None;
    (all, weight) = (Aabb::EMPTY, 0.0);
    for i in 1..count {
        (all, weight) = (all.join(slices[i - 1].bounds), weight + slices[i - 1].begin);
        let cost = all.surface_area() * weight + right[i];
        if best.as_ref().is_none_or(|(_, least)| cost < *least) {
            best = Some((Plane { axis, at: walls[i] }, cost));
        }
    }
    best
}

/// What is in each slice between two walls.
fn sliced(axis: usize, walls: &[f32], knife: &Knife<'_>, inside: &[Part]) -> [Slice; SLICES] {
    let mut slices = [Slice { bounds: Aabb::EMPTY, begin: 0.0, end: 0.0 }; SLICES];
    let count = walls.len() - 1;
    let (low, width) = (walls[0], (walls[count] - walls[0]) / count as f32);
    let slice = |at: f32| (((at - low) / width) as usize).min(count - 1);
    for part in inside {
        let bounds = part.around().bounds();
        let (first, last) = (slice(bounds.min[axis]), slice(bounds.max[axis]));
        slices[first].begin += part.weight();
        slices[last].end += part.weight();
        for i in first..=last {
            let mut cell = bounds;
            if first < i {
                cell.min[axis] = walls[i];
            }
            if i < last {
                cell.max[axis] = walls[i + 1];
            }
            let piece = if first == last { bounds } else { knife.inside(part, &cell) };
            slices[i].bounds = slices[i].bounds.join(piece);
        }
    }
    slices
}
