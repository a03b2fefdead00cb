//! Where to split children in space, by the mean surface of boxes linear in time.

use glam::Vec3A;
use nestray_core::aabb::Aabb;

use crate::timed_tree::{Linear, Reference};
use crate::wide_tree::Contents;

/// "Bins up to `last` go left", along one axis.
pub(super) struct Plane {
    axis: usize,
    low: f32,
    scale: f32,
    bins: usize,
    last: usize,
    /// `mean area × Σ weights`, of both sides.
    pub(super) cost: f64,
}

impl Plane {
    /// On which side a child is half way through the time.
    pub(super) fn is_left(&self, one: &Reference) -> bool {
        bin((center(one)[self.axis] - self.low) * self.scale, self.bins) <= self.last
    }
}

/// Twice the centre, half way through the time.
fn center(one: &Reference) -> Vec3A {
    let middle = one.bounds.at(0.5);
    middle.min + middle.max
}

fn bin(at: f32, bins: usize) -> usize {
    (at as usize).min(bins - 1)
}

/// The children whose centres fall between two candidate planes.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Linear,
    weight: f64,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Linear::EMPTY, weight: 0.0, count: 0 };

    fn join(&mut self, other: &Self) {
        self.bounds = self.bounds.join(other.bounds);
        self.weight += other.weight;
        self.count += other.count;
    }

    fn cost(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.bounds.mean_area() * self.weight }
    }
}

/// The best of the planes along all axes, if any separates.
pub(super) fn best_plane(bins: usize, of: &Contents, inside: &[Reference]) -> Option<Plane> {
    let bins = match inside.len() {
        ..2 => return None,
        2..16 => bins.min(8),
        16..128 => bins.min(16),
        _ => bins,
    };
    let centers = inside.iter().fold(Aabb::EMPTY, |all, one| all.with(center(one)));
    let size = centers.size();
    let scale = Vec3A::splat(bins as f32 * 0.9999) / size.max(Vec3A::splat(f32::MIN_POSITIVE));
    let mut filled = vec![Bin::EMPTY; 3 * bins];
    for one in inside {
        let at = (center(one) - centers.min) * scale;
        let weight = f64::from(of.weights[one.child as usize]);
        for axis in 0..3 {
            let one = Bin { bounds: one.bounds, weight, count: 1 };
            filled[axis * bins + bin(at[axis], bins)].join(&one);
        }
    }
    (0..3)
        .filter(|&axis| size[axis] > 0.0)
        .filter_map(|axis| {
            let (cost, last) = best_of(&filled[axis * bins..][..bins], inside.len())?;
            let (low, scale) = (centers.min[axis], scale[axis]);
            Some(Plane { axis, low, scale, bins, last, cost })
        })
        .reduce(|best, plane| if plane.cost < best.cost { plane } else { best })
}

/// What the best cut through these bins costs, and the last bin before it.
fn best_of(filled: &[Bin], count: usize) -> Option<(f64, usize)> {
    let mut right = vec![0.0; filled.len()];
    let mut all = Bin::EMPTY;
    for bin in (1..filled.len()).rev() {
        all.join(&filled[bin]);
        right[bin] = all.cost();
    }
    let (mut all, mut best): (Bin, Option<(f64, usize)>) = (Bin::EMPTY, None);
    for last in 0..filled.len() - 1 {
        all.join(&filled[last]);
        if all.count == 0 || all.count == count {
            continue;
        }
        let cost = all.cost() + right[last + 1];
        if best.is_none_or(|(least, _)| cost < least) {
            best = Some((cost, last));
        }
    }
    best
}
