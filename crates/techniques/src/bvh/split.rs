//! Where to cut a set of children in two.

use glam::Vec3A;
use nestray_core::aabb::Aabb;

use super::build::Children;

/// "Bins up to `last` go left", along one axis.
pub(super) struct Plane {
    axis: usize,
    low: f32,
    scale: f32,
    pub(super) last: usize,
    bins: usize,
}

impl Plane {
    #[inline]
    pub(super) fn bin(&self, center: Vec3A) -> usize {
        (((center[self.axis] - self.low) * self.scale) as usize).min(self.bins - 1)
    }
}

/// The plane with the least `area × Σ weights` on both sides, if any separates.
#[inline(never)] // its tables must not lie on the stack of every level
pub(super) fn best_plane(most_bins: usize, of: &Children, children: &[u32]) -> Option<Plane> {
    const MOST: usize = 64;
    let bins = if children.len() < 64 { 16 } else { most_bins.clamp(2, MOST) };
    let centers = children.iter().fold(Aabb::EMPTY, |all, &c| all.with(of.center(c)));
    let size = centers.size();
    let scale = Vec3A::splat(bins as f32 * 0.9999) / size.max(Vec3A::splat(f32::MIN_POSITIVE));
    let mut filled = [[Bin::EMPTY; MOST]; 3];
    for &child in children {
        let at = (of.center(child) - centers.min) * scale;
        for axis in 0..3 {
            filled[axis][(at[axis] as usize).min(bins - 1)]
                .put(of.boxes[child as usize], of.weights[child as usize]);
        }
    }
    let mut best: Option<(f32, Plane)> = None;
    for axis in (0..3).filter(|&axis| size[axis] > 0.0) {
        let mut right = [0.0; MOST];
        let mut all = Bin::EMPTY;
        for bin in (1..bins).rev() {
            all.join(&filled[axis][bin]);
            right[bin] = all.cost();
        }
        all = Bin::EMPTY;
        for last in 0..bins - 1 {
            all.join(&filled[axis][last]);
            if all.count == 0 || all.count as usize == children.len() {
                continue;
            }
            let cost = all.cost() + right[last + 1];
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                let (low, scale) = (centers.min[axis], scale[axis]);
                best = Some((cost, Plane { axis, low, scale, last, bins }));
            }
        }
    }
    best.map(|(_, plane)| plane)
}

/// The children whose centres fall between two candidate planes.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    weight: f32,
    count: u32,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Aabb::EMPTY, weight: 0.0, count: 0 };

    #[inline]
    fn put(&mut self, bounds: Aabb, weight: f32) {
        self.join(&Self { bounds, weight, count: 1 });
    }

    #[inline]
    fn join(&mut self, other: &Self) {
        self.bounds = self.bounds.join(other.bounds);
        self.weight += other.weight;
        self.count += other.count;
    }

    #[inline]
    fn cost(&self) -> f32 {
        self.bounds.surface_area() * self.weight
    }
}

/// Moves the children that satisfy `left` to the front; returns how many.
pub(super) fn partition(children: &mut [u32], left: impl Fn(u32) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..children.len() {
        if left(children[i]) {
            children.swap(i, middle);
            middle += 1;
        }
    }
    middle
}
