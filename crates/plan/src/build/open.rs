//! Which instances of a nest are taken apart.

use std::sync::Arc;

use nestray_core::aabb::Aabb;
use nestray_core::object::{DynObject, Object};
use nestray_core::opened::open;

use super::order::Placed;

/// The children of a nest with its largest instances taken apart, and how far the nest reaches;
/// none if none are. There are at most `more` times as many more children as there are instances.
pub(super) fn opened(
    more: f32,
    objects: &[DynObject],
    placed: &[Option<Placed>],
) -> Option<(Vec<DynObject>, f32)> {
    let bounds = objects.iter().map(|object| object.bounds());
    let bounded = bounds.filter(|bounds| !bounds.is_empty() && bounds.is_bounded());
    let reach = bounded.fold(Aabb::EMPTY, Aabb::join).reach();
    let mut left = (f64::from(more) * placed.iter().flatten().count() as f64) as usize;
    let mut largest: Vec<(usize, &Placed)> = (0..)
        .zip(placed)
        .filter_map(|(child, placed)| Some((child, placed.as_ref()?)))
        .filter(|(_, placed)| placed.parts.len() > 1)
        .collect();
    let area = |placed: &Placed| placed.instance.bounds().surface_area();
    // Of equals the first: the sort keeps their order.
    largest.sort_by(|(_, a), (_, b)| area(b).total_cmp(&area(a)));
    let mut taken: Vec<Option<Vec<DynObject>>> = vec![None; objects.len()];
    for (child, placed) in largest {
        let more = placed.parts.len() - 1;
        if more > left {
            continue;
        }
        taken[child] = open(&placed.instance, &placed.parts, reach);
        left -= if taken[child].is_some() { more } else { 0 };
    }
    if taken.iter().all(Option::is_none) {
        return None;
    }
    let children = objects.iter().zip(taken).flat_map(|(object, taken)| match taken {
        Some(parts) => parts,
        None => vec![Arc::clone(object)],
    });
    Some((children.collect(), reach))
}
