//! Where to cut a set of children in two, by bins [Wald 07].

use glam::Vec4;
use nestray_core::dispatch;
use nestray_core::simd::{Level, Simd};
use rayon::prelude::*;

use super::part::{Around, Centers, Part};

/// "Centres up to here go left", along one axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    axis: usize,
    low: f32,
    scale: f32,
    last: f32,
    /// Boxes around both sides.
    pub(crate) sides: [Around; 2],
}

/// More children than this are worth being shared out between threads.
pub(crate) const SHARED: usize = 16_384;

/// Added to a number it leaves the nearest whole number in the lowest bits.
const WHOLE: f32 = 12_582_912.0;

/// From centres to bins.
#[derive(Clone, Copy)]
struct Frame {
    low: Vec4,
    scale: Vec4,
    /// Along which axes there are planes.
    axes: [bool; 3],
}

impl Frame {
    #[inline(always)]
    fn new(bins: usize, centers: &Centers) -> Self {
        /// Less makes no finite scale.
        const LEAST: f32 = 1e-30;
        /// Along an axis along which centres are within so small a part of what they are within
        /// along another, no plane is worth trying.
        const FLAT: f32 = 0.25;
        let size = centers.max - centers.min;
        let least = (FLAT * size.x.max(size.y).max(size.z)).max(LEAST);
        let axes = [size.x > least, size.y > least, size.z > least];
        let scale = |axis: usize| if axes[axis] { (bins - 1) as f32 / size[axis] } else { 0.0 };
        let (scale, low) = (Vec4::new(scale(0), scale(1), scale(2), 0.0), centers.min);
        Self { low: Vec4::new(low.x, low.y, low.z, 0.0), scale, axes }
    }

    /// The number of a bin along each axis, in the lowest bits.
    #[inline(always)]
    fn place(&self, part: &Part) -> [usize; 3] {
        let at = (part.center() - self.low) * self.scale + WHOLE;
        [at.x.to_bits() as usize, at.y.to_bits() as usize, at.z.to_bits() as usize]
    }
}

impl Plane {
    /// Whether a part is on the left: by the same arithmetic that found its bin.
    #[inline(always)]
    fn is_left(&self, part: &Part) -> bool {
        (part.center_along(self.axis) - self.low) * self.scale + WHOLE <= self.last
    }
}

/// The children whose centres fall between candidate planes, along each axis.
struct Bins<const MOST: usize> {
    around: [[Around; MOST]; 3],
    counts: [[u32; MOST]; 3],
    weights: [[f32; MOST]; 3],
}

impl<const MOST: usize> Bins<MOST> {
    const EMPTY: Self = Self {
        around: [[Around::EMPTY; MOST]; 3],
        counts: [[0; MOST]; 3],
        weights: [[0.0; MOST]; 3],
    };

    #[inline(always)]
    fn fill<S: Simd>(&mut self, simd: S, frame: &Frame, parts: &[Part], is_even: bool) {
        // What is side by side is often in one bin, and would wait for it.
        let (front, back) = parts.split_at(parts.len() / 2);
        for (a, b) in front.iter().zip(back) {
            self.put(simd, frame, a, is_even);
            self.put(simd, frame, b, is_even);
        }
        if let Some(last) = back.get(front.len()) {
            self.put(simd, frame, last, is_even);
        }
    }

    #[inline(always)]
    fn put<S: Simd>(&mut self, simd: S, frame: &Frame, part: &Part, is_even: bool) {
        let (lanes, at) = (simd.load(&part.around().0), frame.place(part));
        for (axis, at) in at.into_iter().enumerate() {
            let bin = at & (MOST - 1);
            let around = &mut self.around[axis][bin].0;
            *around = simd.array(simd.min(lanes, simd.load(around)));
            self.counts[axis][bin] += 1;
            if !is_even {
                self.weights[axis][bin] += part.weight();
            }
        }
    }

    fn join(&mut self, other: &Self) {
        for axis in 0..3 {
            for bin in 0..MOST {
                self.around[axis][bin] = self.around[axis][bin].join(&other.around[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
                self.weights[axis][bin] += other.weights[axis][bin];
            }
        }
    }

    /// The plane with the least cost, if any separates.
    #[inline(always)]
    fn best<S: Simd>(&self, simd: S, bins: usize, frame: &Frame, is_even: bool) -> Option<Plane> {
        let (mut best, mut least) = (None, f32::INFINITY);
        let weight = |axis: usize, bin: usize, count: u32| {
            if is_even { count as f32 } else { self.weights[axis][bin] }
        };
        for axis in (0..3).filter(|&axis| frame.axes[axis]) {
            let (around, counts) = (&self.around[axis], &self.counts[axis]);
            let mut right = [0.0; MOST];
            let (mut all, mut total) = (Around::EMPTY, 0.0);
            for bin in (1..bins).rev() {
                total += weight(axis, bin, counts[bin]);
                all.0 = simd.array(simd.min(simd.load(&all.0), simd.load(&around[bin].0)));
                right[bin] = if total > 0.0 { all.half_area() * total } else { f32::INFINITY };
            }
            (all, total) = (Around::EMPTY, 0.0);
            for bin in 0..bins - 1 {
                total += weight(axis, bin, counts[bin]);
                all.0 = simd.array(simd.min(simd.load(&all.0), simd.load(&around[bin].0)));
                let cost = all.half_area() * total + right[bin + 1];
                if cost < least {
                    (best, least) = (Some((axis, bin)), cost);
                }
            }
        }
        let (axis, last) = best?;
        let join = |bins: &[Around]| bins.iter().fold(Around::EMPTY, |all, bin| all.join(bin));
        let (left, right) = self.around[axis][..bins].split_at(last + 1);
        Some(Plane {
            axis,
            low: frame.low[axis],
            scale: frame.scale[axis],
            last: WHOLE + last as f32,
            sides: [join(left), join(right)],
        })
    }
}

/// How children are cut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cutting {
    /// Candidate planes per axis, where children are many.
    pub(crate) bins: usize,
    /// Whether all weigh the same.
    pub(crate) is_even: bool,
}

impl Cutting {
    /// The plane with the least `half area × Σ weights` on both sides, if any separates.
    #[inline(always)]
    pub(crate) fn best_plane<S: Simd>(&self, simd: S, parts: &[Part]) -> Option<Plane> {
        match (parts.len(), self.bins) {
            (..32, _) => self.best_of::<S, 8>(simd, 8, parts),
            (32..128, _) => self.best_of::<S, 16>(simd, 16, parts),
            (_, ..=32) => self.best_of::<S, 32>(simd, self.bins, parts),
            _ => self.best_of::<S, 64>(simd, self.bins, parts),
        }
    }

    #[inline(always)]
    fn best_of<S: Simd, const MOST: usize>(
        &self,
        simd: S,
        bins: usize,
        parts: &[Part],
    ) -> Option<Plane> {
        let frame = Frame::new(bins, &Centers::of(parts));
        let mut filled = Bins::<MOST>::EMPTY;
        filled.fill(simd, &frame, parts, self.is_even);
        filled.best(simd, bins, &frame, self.is_even)
    }

    /// The same of many children, by all cores. Bins are added up in order: so they are the same
    /// for any number of threads.
    pub(crate) fn shared_plane(&self, parts: &[Part]) -> Option<Plane> {
        if parts.len() <= SHARED {
            return dispatch!(Level::best(), simd => self.best_plane(simd, parts));
        }
        let centers = parts.par_chunks(SHARED).map(Centers::of).reduce_with(Centers::join);
        let frame = Frame::new(self.bins, &centers?);
        let fill = |parts: &[Part]| {
            let mut bins = Box::new(Bins::<64>::EMPTY);
            dispatch!(Level::best(), simd => bins.fill(simd, &frame, parts, self.is_even));
            bins
        };
        let filled: Vec<Box<Bins<64>>> = parts.par_chunks(SHARED).map(fill).collect();
        let mut all = Box::new(Bins::EMPTY);
        filled.iter().for_each(|bins| all.join(bins));
        dispatch!(Level::best(), simd => all.best(simd, self.bins, &frame, self.is_even))
    }
}

/// Puts parts on the left of a plane first; returns how many that are.
#[inline(always)]
pub(crate) fn partition(parts: &mut [Part], plane: &Plane) -> usize {
    let mut middle = 0;
    for i in 0..parts.len() {
        parts.swap(i, middle);
        // No branch: none could be foretold.
        middle += usize::from(plane.is_left(&parts[middle]));
    }
    middle
}

/// The same by all cores, in an order that does not depend on how many there are.
pub(crate) fn shared_partition(parts: &mut [Part], plane: &Plane) -> usize {
    if parts.len() <= SHARED {
        return dispatch!(Level::best(), _simd => partition(parts, plane));
    }
    let half = parts.len() / 2;
    let (front, back) = parts.split_at_mut(half);
    let (a, b) = rayon::join(|| shared_partition(front, plane), || shared_partition(back, plane));
    // What is right in the front changes places with what is left in the back.
    let count = (half - a).min(b);
    front[a..][..count].swap_with_slice(&mut back[b - count..b]);
    a + b
}
