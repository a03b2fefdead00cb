//! The three planes of a cell.

use nestray_core::aabb::Aabb;

use crate::cells::{Cell, Plane};

use super::Places;

/// Places tried for each plane.
const PLACES: usize = 10;
/// Children looked at for the middle one, evenly spread.
const SAMPLE: usize = 1000;

/// The planes that cut a cell into eighths, fewer where it is too narrow; none if that would be
/// no gain.
pub(super) fn planes(places: Places, cell: &Cell<'_>) -> Option<[Option<f32>; 3]> {
    let planes = [0, 1, 2].map(|axis| {
        let middle = cell.middle(axis)?;
        Some(match places {
            Places::Middle => middle,
            Places::ByCost => cheapest(cell, axis, middle),
        })
    });
    (planes != [None; 3] && price(cell, planes) < cell.price()).then_some(planes)
}

/// What a random ray through the cell costs in its eighths.
fn price(cell: &Cell<'_>, planes: [Option<f32>; 3]) -> f64 {
    let mut sides = [(0, 0.0); 8];
    for &child in cell.inside {
        let bounds = &cell.children.boxes[child as usize];
        for (eighth, (count, weight)) in sides.iter_mut().enumerate() {
            let is_in = (0..3).all(|axis| match planes[axis] {
                Some(at) if eighth >> axis & 1 == 1 => bounds.max[axis] > at,
                Some(at) => bounds.min[axis] < at,
                None => eighth >> axis & 1 == 0,
            });
            if is_in {
                *count += 1;
                *weight += f64::from(cell.children.weights[child as usize]);
            }
        }
    }
    let whole = f64::from(cell.bounds.surface_area()).max(f64::MIN_POSITIVE);
    let share = |eighth: usize| {
        let mut part: Aabb = cell.bounds;
        for axis in 0..3 {
            if let Some(at) = planes[axis] {
                let end = if eighth >> axis & 1 == 1 { &mut part.min } else { &mut part.max };
                end[axis] = at;
            }
        }
        f64::from(part.surface_area()) / whole
    };
    let prices = sides.iter().enumerate().map(|(eighth, &(count, weight))| {
        if count == 0 { 0.0 } else { share(eighth) * cell.children.price(count, weight) }
    });
    prices.sum()
}

/// The place for a plane that costs least, of a few from the middle of the cell to that of the
/// children.
fn cheapest(cell: &Cell<'_>, axis: usize, middle: f32) -> f32 {
    let stride = cell.inside.len().div_ceil(SAMPLE);
    let mut centers: Vec<f32> = cell
        .inside
        .iter()
        .step_by(stride)
        .map(|&child| cell.part(child, axis))
        .map(|[low, high]| low * 0.5 + high * 0.5)
        .collect();
    let half = centers.len() / 2;
    let (_, &mut median, _) = centers.select_nth_unstable_by(half, f32::total_cmp);
    let [low, high] = cell.extent(axis);
    (0..PLACES)
        .map(|place| middle + (median - middle) * (place as f32 / (PLACES - 1) as f32))
        .filter(|&at| low < at && at < high)
        .map(|at| (at, cost(cell, Plane { axis, at })))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(middle, |(at, _)| at)
}

/// What tests cost a random ray through the cell if only this plane cuts it, up to a factor.
fn cost(cell: &Cell<'_>, Plane { axis, at }: Plane) -> f64 {
    let size = cell.bounds.size().as_dvec3();
    let (b, c) = (size[(axis + 1) % 3], size[(axis + 2) % 3]);
    let area = |length: f64| length * (b + c) + b * c;
    let (mut below, mut above) = (0.0, 0.0);
    for &child in cell.inside {
        let weight = f64::from(cell.children.weights[child as usize]);
        let bounds = &cell.children.boxes[child as usize];
        below += if bounds.min[axis] < at { weight } else { 0.0 };
        above += if bounds.max[axis] > at { weight } else { 0.0 };
    }
    let [low, high] = cell.extent(axis).map(f64::from);
    below * area(f64::from(at) - low) + above * area(high - f64::from(at))
}
