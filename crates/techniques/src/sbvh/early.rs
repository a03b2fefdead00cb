//! Cutting the largest children before the tree is built [Ernst 07].
//!
//! A cut through many long children pays only after more such cuts: no single one is worth it to a
//! builder that goes down from the top.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use nestray_core::aabb::{Aabb, Clip};
use rayon::prelude::*;

use super::build::Knife;
use super::cut::halved;
use crate::bvh::part::Part;

/// How large a child must be, relative to a leaf in a good tree.
const LARGE: f64 = 1.0;

/// A part that may be cut in half, and what surface is saved by that.
struct Worth {
    saved: f32,
    part: u32,
    halves: [Aabb; 2],
}

impl PartialEq for Worth {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Worth {}

impl PartialOrd for Worth {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Worth {
    /// The most first, of equals the one cut off first.
    fn cmp(&self, other: &Self) -> Ordering {
        self.saved.total_cmp(&other.saved).then(other.part.cmp(&self.part))
    }
}

/// Halves parts that are much larger than leaves of `together`, those first by which most surface is
/// saved, until there are `room` of them.
pub(super) fn cut_large(
    knife: &Knife<'_>,
    parts: &mut Vec<Part>,
    bounds: &Aabb,
    together: usize,
    room: usize,
) {
    let in_leaf = together as f64 / parts.len() as f64;
    let least = LARGE * f64::from(bounds.surface_area()) * libm::cbrt(in_leaf * in_leaf);
    let worth = |(number, part): (usize, &Part)| {
        let bounds = part.around().bounds();
        let is_large = f64::from(bounds.surface_area()) > least;
        let halves = if is_large { halves(knife, part, bounds)? } else { return None };
        let saved = bounds.surface_area() - halves[0].surface_area() - halves[1].surface_area();
        (saved > 0.0).then_some(Worth { saved, part: number as u32, halves })
    };
    let mut open: BinaryHeap<Worth> =
        parts.par_iter().enumerate().filter_map(worth).collect::<Vec<_>>().into();
    while parts.len() < room
        && let Some(Worth { part, halves, .. }) = open.pop()
    {
        let (one, other) = (part as usize, parts.len());
        let [a, b] = halves.map(|half| parts[one].piece(&half));
        parts[one] = a;
        parts.push(b);
        open.extend([one, other].into_iter().filter_map(|part| worth((part, &parts[part]))));
    }
}

/// What is in each half of a box, cut across its longest axis.
fn halves(knife: &Knife<'_>, part: &Part, bounds: Aabb) -> Option<[Aabb; 2]> {
    let size = bounds.size();
    let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b]))?;
    let is_wide = size[axis] > 32.0 * Clip::SLACK * knife.reach;
    is_wide.then(|| halved(knife, part, axis, bounds.center()[axis]))?
}
