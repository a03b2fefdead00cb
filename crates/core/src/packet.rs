//! Rays with so much in common that they go through an index together.
//!
//! Rays through neighbouring pixels take the same way through most of a tree. A *packet* of them
//! is led to leaves as one: a node is looked into once for all, by the beam that they lie in, and
//! what stands in a leaf is tested with eight rays at a time. What is found is the same, bit for
//! bit.

mod pencil;

use glam::Vec3A;

use crate::aabb::{Aabb, Clip};
use crate::beam::Beam;
use crate::ray::Ray;
use crate::simd::Simd;

pub use self::pencil::Pencil;

/// Most rays in a packet.
pub const RAYS: usize = 32;

/// The first of each eight rays.
pub const GROUPS: [usize; RAYS / 8] = [0, 8, 16, 24];

/// A number for each ray.
pub type Lanes = [f32; RAYS];

/// Neighbouring rays, axis by axis.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Packet {
    /// Where they start.
    pub origin: [Lanes; 3],
    /// Their directions.
    pub dir: [Lanes; 3],
    /// Hits nearer than this are ignored.
    pub t_min: Lanes,
    /// Hits farther than this are ignored: shrinks while they are traced, and is −∞ for rays that
    /// want no more, and for those that are not there.
    pub limit: Lanes,
    /// All of them lie in it. Its main axis is the one along which each runs fastest.
    pub beam: Beam,
    clip: Clips,
}

/// Their own parts of the box tests; see [`Clip`](crate::aabb::Clip).
#[derive(Clone, Debug)]
struct Clips {
    inverse: [Lanes; 3],
    near: [Lanes; 3],
    far: [Lanes; 3],
}

const ZERO: Lanes = [0.0; RAYS];

impl Packet {
    /// Widest range of slopes of neighbours: a twentieth of what an eye sees.
    const WIDEST: f32 = 0.2;
    /// Fewest rays that are worth it.
    const FEWEST: usize = 4;

    /// No rays.
    pub const EMPTY: Self = Self {
        origin: [ZERO; 3],
        dir: [ZERO; 3],
        t_min: ZERO,
        limit: [f32::NEG_INFINITY; RAYS],
        beam: Beam {
            origin: Aabb::EMPTY,
            axis: 0,
            backward: false,
            u: [0.0; 2],
            v: [0.0; 2],
            farthest: f32::INFINITY,
        },
        clip: Clips { inverse: [ZERO; 3], near: [ZERO; 3], far: [ZERO; 3] },
    };

    /// Whether the first and the last of some rays may be neighbours: most that are not are told
    /// apart here.
    #[inline(always)]
    #[must_use]
    pub fn may_be(rays: &[Ray]) -> bool {
        let [first, .., last] = rays else { return false };
        let (a, b) = (first.dir(), last.dir());
        let size = a.abs().max_element();
        rays.len() >= Self::FEWEST && (a - b).abs().max_element() <= size * (1.5 * Self::WIDEST)
    }

    /// Takes all of `rays`, at most [`RAYS`], each up to its limit; false if they are no
    /// neighbours.
    #[inline(always)]
    #[must_use]
    pub fn take<S: Simd>(&mut self, simd: S, rays: &[Ray], limit: impl Fn(usize) -> f32) -> bool {
        let last = rays.len().min(RAYS) - 1;
        for i in 0..RAYS {
            let ray = &rays[i.min(last)];
            let (origin, dir) = (ray.origin().to_array(), ray.dir().to_array());
            for axis in 0..3 {
                self.origin[axis][i] = origin[axis];
                self.dir[axis][i] = dir[axis];
            }
            self.t_min[i] = ray.t_min();
            self.limit[i] = if i <= last { limit(i) } else { f32::NEG_INFINITY };
        }
        let first = [self.dir[0][0], self.dir[1][0], self.dir[2][0]];
        self.beam.axis = longest(first);
        self.beam.backward = first[self.beam.axis] < 0.0;
        self.run_alike(simd) && self.enclose(simd)
    }

    /// Whether all rays run fastest along the main axis, by far enough, in the same direction, and
    /// can hit anything at all: a ray that cannot need not be anywhere near.
    #[inline(always)]
    fn run_alike<S: Simd>(&self, simd: S) -> bool {
        let axis = self.beam.axis;
        let [low, high] = range(simd, &self.dir[axis]);
        let slowest = if self.beam.backward { -high } else { low };
        let next = range(simd, &self.dir[[1, 2, 0][axis]]);
        let last = range(simd, &self.dir[[2, 0, 1][axis]]);
        let fastest = greater(greater(-next[0], next[1]), greater(-last[0], last[1]));
        slowest > fastest && range(simd, &self.t_min)[1] < f32::INFINITY
    }

    /// Works out the beam; false if it is wide.
    #[inline(always)]
    fn enclose<S: Simd>(&mut self, simd: S) -> bool {
        let axis = self.beam.axis;
        let (next, last) = ([1, 2, 0][axis], [2, 0, 1][axis]);
        let sign = simd.splat(if self.beam.backward { -1.0 } else { 1.0 });
        let mut slopes = [ZERO; 2];
        for from in GROUPS {
            let part = |lanes: &Lanes| simd.load(eight(lanes, from));
            let along = simd.div(sign, part(&self.dir[axis]));
            let (u, v) =
                (simd.mul(part(&self.dir[next]), along), simd.mul(part(&self.dir[last]), along));
            *eight_mut(&mut slopes[0], from) = simd.array(u);
            *eight_mut(&mut slopes[1], from) = simd.array(v);
        }
        let (u, v) = (range(simd, &slopes[0]), range(simd, &slopes[1]));
        // A slope is rounded twice.
        let grown = |[low, high]: [f32; 2]| {
            let slack = greater(low.abs(), high.abs()) * (2.0 * f32::EPSILON);
            [low - slack, high + slack]
        };
        (self.beam.u, self.beam.v) = (grown(u), grown(v));
        let x = range(simd, &self.origin[0]);
        let y = range(simd, &self.origin[1]);
        let z = range(simd, &self.origin[2]);
        self.beam.origin.min = Vec3A::new(x[0], y[0], z[0]);
        self.beam.origin.max = Vec3A::new(x[1], y[1], z[1]);
        u[1] - u[0] <= Self::WIDEST && v[1] - v[0] <= Self::WIDEST
    }

    /// How far apart the rays start, along the axis where that is most.
    #[inline(always)]
    #[must_use]
    pub fn spread(&self) -> f32 {
        (self.beam.origin.max - self.beam.origin.min).max_element()
    }

    /// Gets ready for boxes whose coordinates are at most `reach`, and that rounding may move by
    /// `slack` of that; see [`Clip::with_slack`](crate::aabb::Clip::with_slack).
    #[inline(always)]
    pub fn face<S: Simd>(&mut self, simd: S, reach: f32, slack: f32) {
        let main = self.beam.axis;
        for from in GROUPS {
            let part = |lanes: &Lanes| simd.load(eight(lanes, from));
            let origin = [part(&self.origin[0]), part(&self.origin[1]), part(&self.origin[2])];
            let far =
                simd.max(simd.max(simd.abs(origin[0]), simd.abs(origin[1])), simd.abs(origin[2]));
            let off = simd.mul(simd.max(far, simd.splat(reach)), simd.splat(slack));
            let least = simd.mul(simd.abs(part(&self.dir[main])), simd.splat(1e-9));
            for (axis, origin) in origin.into_iter().enumerate() {
                let dir = part(&self.dir[axis]);
                let small = simd.le(simd.abs(dir), least);
                let dir = if small == 0 { dir } else { kept_off(simd, dir, least) };
                let inverse = simd.div(simd.splat(1.0), dir);
                let (middle, off) = (simd.mul(origin, inverse), simd.mul(simd.abs(inverse), off));
                *eight_mut(&mut self.clip.inverse[axis], from) = simd.array(inverse);
                *eight_mut(&mut self.clip.near[axis], from) = simd.array(simd.add(middle, off));
                *eight_mut(&mut self.clip.far[axis], from) = simd.array(simd.sub(middle, off));
            }
        }
    }

    /// Which of eight rays, from number `half` on, still want something.
    #[inline(always)]
    pub fn wanted<S: Simd>(&self, simd: S, half: usize) -> u32 {
        simd.le(simd.load(eight(&self.t_min, half)), simd.load(eight(&self.limit, half)))
    }

    /// The rays that meet one of eight boxes within their limits; lower x of all, upper x, lower
    /// y, ….
    #[inline(always)]
    pub fn meet<S: Simd>(&self, simd: S, rows: &[[f32; 8]; 6], lane: usize) -> u32 {
        let lane = lane & 7;
        let mut mask = 0;
        for half in GROUPS {
            let part = |lanes: &Lanes| simd.load(eight(lanes, half));
            let mut enter = part(&self.t_min);
            let mut leave = part(&self.limit);
            for axis in 0..3 {
                let inverse = part(&self.clip.inverse[axis]);
                let a = simd.mul(simd.splat(rows[2 * axis][lane]), inverse);
                let b = simd.mul(simd.splat(rows[2 * axis + 1][lane]), inverse);
                enter = simd.max(simd.sub(simd.min(a, b), part(&self.clip.near[axis])), enter);
                leave = simd.min(simd.sub(simd.max(a, b), part(&self.clip.far[axis])), leave);
            }
            mask |= simd.le(enter, leave) << half;
        }
        mask
    }

    /// One ray's part of the box tests, once the packet [faces](Self::face) the boxes.
    #[inline(always)]
    #[must_use]
    pub fn clip(&self, ray: usize) -> Clip {
        let at = |lanes: &[Lanes; 3]| Vec3A::new(lanes[0][ray], lanes[1][ray], lanes[2][ray]);
        let Clips { inverse, near, far } = &self.clip;
        Clip { inverse: at(inverse), near: at(near), far: at(far), t_min: self.t_min[ray] }
    }
}

/// Eight of the lanes, from the first of a [group](GROUPS) on.
#[inline(always)]
#[must_use]
pub fn eight(lanes: &Lanes, from: usize) -> &[f32; 8] {
    lanes[from..from + 8].try_into().expect("there are eight")
}

/// The same, to write to.
#[inline(always)]
#[must_use]
pub fn eight_mut(lanes: &mut Lanes, from: usize) -> &mut [f32; 8] {
    (&mut lanes[from..from + 8]).try_into().expect("there are eight")
}

/// Directions that are no smaller than `least`, their signs kept.
#[cold]
#[inline(never)]
fn kept_off<S: Simd>(simd: S, dir: S::F32, least: S::F32) -> S::F32 {
    let (mut dir, least) = (simd.array(dir), simd.array(least));
    for (dir, least) in dir.iter_mut().zip(least) {
        if dir.abs() < least {
            *dir = least.copysign(*dir);
        }
    }
    simd.load(&dir)
}

/// The axis of the largest component, by size; the last of equals.
#[inline(always)]
#[must_use]
pub fn longest(dir: [f32; 3]) -> usize {
    let [x, y, z] = [dir[0].abs(), dir[1].abs(), dir[2].abs()];
    let (first, second) = if x > y { (x, 0) } else { (y, 1) };
    if first > z { second } else { 2 }
}

#[inline(always)]
fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The least and the greatest.
#[inline(always)]
fn range<S: Simd>(simd: S, lanes: &Lanes) -> [f32; 2] {
    let first = simd.load(eight(lanes, 0));
    let (mut low, mut high) = (first, first);
    for from in GROUPS {
        let part = simd.load(eight(lanes, from));
        (low, high) = (simd.min(low, part), simd.max(high, part));
    }
    let negative = simd.sub(simd.splat(0.0), high);
    [simd.least(255, low), -simd.least(255, negative)]
}

#[cfg(test)]
mod tests;
