//! Where to cut a set of children in two.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use rayon::prelude::*;

use crate::wide_tree::Contents;

/// "Bins up to `last` go left", along one axis.
pub(crate) struct Plane {
    axis: usize,
    low: f32,
    scale: f32,
    last: usize,
    bins: usize,
    /// `area × Σ weights` on both sides.
    pub(crate) cost: f32,
}

impl Plane {
    /// Whether a child is on the left, by twice the centre of its box.
    #[inline]
    pub(crate) fn is_left(&self, center: Vec3A) -> bool {
        let bin = (((center[self.axis] - self.low) * self.scale) as usize).min(self.bins - 1);
        bin <= self.last
    }
}

/// More children than this are worth being shared out between threads.
pub(super) const SHARED: usize = 16_384;

/// The plane with the least `area × Σ weights` on both sides, if any separates.
pub(crate) fn best_plane(most_bins: usize, of: &Contents, children: &[u32]) -> Option<Plane> {
    match children.len() {
        ..16 => best_of::<8>(8, of, children),
        16..128 => best_of::<16>(16, of, children),
        _ => best_of::<64>(most_bins.clamp(2, 64), of, children),
    }
}

/// The best of `bins` planes along each axis.
#[inline(never)] // its tables must not lie on the stack of every level
fn best_of<const MOST: usize>(bins: usize, of: &Contents, children: &[u32]) -> Option<Plane> {
    let centers = centers(of, children);
    let size = centers.size();
    let scale = Vec3A::splat(bins as f32 * 0.9999) / size.max(Vec3A::splat(f32::MIN_POSITIVE));
    let filled = filled::<MOST>(of, children, &|center| {
        let at = (center - centers.min) * scale;
        [at.x, at.y, at.z].map(|at| (at as usize).min(bins - 1))
    });
    let mut best: Option<Plane> = None;
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
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                let (low, scale) = (centers.min[axis], scale[axis]);
                best = Some(Plane { axis, low, scale, last, bins, cost });
            }
        }
    }
    best
}

/// A box around the centres.
fn centers(of: &Contents, children: &[u32]) -> Aabb {
    let around = |part: &[u32]| part.iter().fold(Aabb::EMPTY, |all, &c| all.with(of.center(c)));
    if children.len() <= SHARED {
        return around(children);
    }
    children.par_chunks(SHARED).map(around).reduce(|| Aabb::EMPTY, Aabb::join)
}

type Bins<const MOST: usize> = [[Bin; MOST]; 3];

/// The bins of all children. Parts are added up in order: the same for any number of threads.
fn filled<const MOST: usize>(
    of: &Contents,
    children: &[u32],
    place: &(impl Fn(Vec3A) -> [usize; 3] + Sync),
) -> Bins<MOST> {
    let fill = |bins: &mut Bins<MOST>, part: &[u32]| {
        for &child in part {
            let (bounds, weight) = (of.boxes[child as usize], of.weights[child as usize]);
            for (bins, bin) in bins.iter_mut().zip(place(of.center(child))) {
                bins[bin].put(bounds, weight);
            }
        }
    };
    let mut all = [[Bin::EMPTY; MOST]; 3];
    if children.len() <= SHARED {
        fill(&mut all, children);
        return all;
    }
    let part = |part: &[u32]| {
        let mut bins = Box::new([[Bin::EMPTY; MOST]; 3]);
        fill(&mut bins, part);
        bins
    };
    let parts: Vec<Box<Bins<MOST>>> = children.par_chunks(SHARED).map(part).collect();
    for part in parts {
        for (all, part) in all.as_flattened_mut().iter_mut().zip(part.as_flattened()) {
            all.join(part);
        }
    }
    all
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
pub(crate) fn partition(children: &mut [u32], left: impl Fn(u32) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..children.len() {
        if left(children[i]) {
            children.swap(i, middle);
            middle += 1;
        }
    }
    middle
}
