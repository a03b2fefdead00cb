//! The one triangle test: watertight, after [Woop 13].
//!
//! The ray is made the z axis by a shear, the same for all triangles, so two triangles
//! that share an edge see the same two points and decide with exactly opposite signs.
//! Plain multiplies and adds, never fused: the same bits on every machine.

use std::hint::black_box;

use nestray_core::hit::Hit;
use nestray_core::simd::Simd;

use super::exact;
use super::layout::{Block, Layout};
use super::shear::Probe;
use crate::shape::Sides;

/// The rays in eight lanes: the same in all where eight triangles are tested with one ray, or
/// eight that are tested with one triangle.
#[derive(Clone, Copy)]
pub(super) struct Rays<S: Simd> {
    /// As of a [`Shear`].
    pub(super) slope: [S::F32; 3],
    /// Lanes in which the ray moves along x, along y.
    pub(super) moves: [u32; 2],
    /// Twice the largest coordinate of the origin.
    pub(super) reach: S::F32,
    pub(super) t_min: S::F32,
    pub(super) limit: S::F32,
    /// Whether z grows along the rays.
    pub(super) is_forward: bool,
}

/// Where the lanes are hit.
#[derive(Clone, Copy)]
pub(super) struct Hits<S: Simd> {
    /// The lanes that are.
    pub(super) mask: u32,
    pub(super) t: S::F32,
    /// Weights of the second and third corner.
    pub(super) weights: [S::F32; 2],
}

impl<S: Simd> Hits<S> {
    /// Distance and barycentrics in one lane.
    #[inline(always)]
    pub(super) fn lane(&self, simd: S, lane: usize) -> (f32, [f32; 2]) {
        let [v, w] = self.weights;
        (simd.lane(self.t, lane), [simd.lane(v, lane), simd.lane(w, lane)])
    }

    /// The nearest lane, the first of equals; there is one at least.
    #[inline(always)]
    pub(super) fn nearest(&self, simd: S) -> (usize, f32, [f32; 2]) {
        let mut lanes = self.mask;
        // Mostly one lane is hit.
        if lanes & (lanes - 1) != 0 {
            lanes &= simd.eq(self.t, simd.splat(simd.least(lanes, self.t)));
        }
        let lane = lanes.trailing_zeros() as usize;
        let (t, uv) = self.lane(simd, lane);
        (lane, t, uv)
    }
}

/// Twice the area, seen along the ray, that a triangle must have: less has no inverse.
const LEAST: f32 = 1e-37;

/// Tests the triangles of a block; `number` says which one is in a lane.
#[inline(always)]
pub(super) fn hits<S: Simd, L: Layout>(
    simd: S,
    probe: &Probe,
    block: &Block<S>,
    limit: f32,
    number: impl Fn(usize) -> u32,
) -> Option<Hits<S>> {
    let (mask, edges) = crossed(simd, block);
    if mask == 0 {
        return None;
    }
    // Else the compiler prepares what follows at the head of the loop over blocks, for every leaf.
    let Probe { shear, skip, sides } = black_box(probe);
    let rays = shear.in_all(simd, limit);
    let mut hits = settled::<S, L>(simd, &rays, *sides, block, (mask, edges));
    if *skip != Hit::NOTHING {
        let hit = hits.mask;
        for lane in (0..8).filter(|lane| hit >> lane & 1 == 1) {
            hits.mask &= !(u32::from(number(lane) == *skip) << lane);
        }
    }
    (hits.mask != 0).then_some(hits)
}

/// Lanes in which the ray seems to pass through the triangle, and the edge functions.
#[inline(always)]
pub(super) fn crossed<S: Simd>(simd: S, block: &Block<S>) -> (u32, [S::F32; 3]) {
    let [a, b, c] = block.corners;
    let edge =
        |a: [S::F32; 3], b: [S::F32; 3]| simd.sub(simd.mul(a[0], b[1]), simd.mul(a[1], b[0]));
    let edges = [edge(c, b), edge(a, c), edge(b, a)];
    (inside(simd, edges) & block.lanes, edges)
}

/// What becomes of lanes that are [`crossed`].
#[inline(always)]
pub(super) fn settled<S: Simd, L: Layout>(
    simd: S,
    rays: &Rays<S>,
    sides: Sides,
    block: &Block<S>,
    (mut mask, mut edges): (u32, [S::F32; 3]),
) -> Hits<S> {
    let [a, b, c] = block.corners;
    // A zero may have been rounded to: decide such lanes with doubles. Other signs are right.
    let zero = simd.splat(0.0);
    let [u, v, w] = edges;
    let (least, most) = range(simd, edges);
    let unclear = (simd.eq(least, zero) | simd.eq(most, zero)) & mask;
    if unclear != 0 {
        let arrays = |p: [S::F32; 3]| [simd.array(p[0]), simd.array(p[1])];
        let rounded = [simd.array(u), simd.array(v), simd.array(w)];
        let fixed = exact::edges(unclear, [arrays(a), arrays(b), arrays(c)], rounded);
        edges = [simd.load(&fixed[0]), simd.load(&fixed[1]), simd.load(&fixed[2])];
        mask &= inside(simd, edges);
    }
    let [u, v, w] = edges;
    let sum = simd.add(simd.add(u, v), w);
    // A triangle seen exactly from its side has no hit, and no weights.
    mask &= !simd.le(simd.abs(sum), simd.splat(LEAST));
    if sides != Sides::Both {
        // The sum is twice the area, positive where the corners run clockwise along z.
        let front = if rays.is_forward { simd.le(zero, sum) } else { simd.le(sum, zero) };
        mask &= if sides == Sides::Front { front } else { !front };
    }
    let depths = L::depths(simd, block);
    let weights = weighed(simd, rays, block, (edges, sum), depths, mask);
    let sum = simd.add(simd.mul(weights[0], depths[0]), simd.mul(weights[1], depths[1]));
    let depth =
        within_bounds(simd, rays, block, depths, simd.add(sum, simd.mul(weights[2], depths[2])));
    let t = simd.mul(depth, rays.slope[2]);
    mask &= simd.le(rays.t_min, t) & simd.le(t, rays.limit);
    Hits { mask, t, weights: [weights[1], weights[2]] }
}

/// Lanes where all three edge functions have the same sign, or are zero.
#[inline(always)]
fn inside<S: Simd>(simd: S, [u, v, w]: [S::F32; 3]) -> u32 {
    let (zero, (least, most)) = (simd.splat(0.0), range(simd, [u, v, w]));
    simd.le(zero, least) | simd.le(most, zero)
}

/// The least of three, and the most.
#[inline(always)]
fn range<S: Simd>(simd: S, [a, b, c]: [S::F32; 3]) -> (S::F32, S::F32) {
    (simd.min(simd.min(a, b), c), simd.max(simd.max(a, b), c))
}

/// Weights of the corners, in the lanes of `mask`, by the edge functions and their sum.
#[inline(always)]
fn weighed<S: Simd>(
    simd: S,
    rays: &Rays<S>,
    block: &Block<S>,
    ([u, v, w], sum): ([S::F32; 3], S::F32),
    depths: [S::F32; 3],
    mask: u32,
) -> [S::F32; 3] {
    let inverse = simd.div(simd.splat(1.0), sum);
    // Divided before they are summed: they are at most 1, so that the depth lies between those of
    // the corners, and nothing overflows.
    let weights = [simd.mul(u, inverse), simd.mul(v, inverse), simd.mul(w, inverse)];
    let unsure = mask & !are_sure(simd, rays, block, depths, sum);
    if unsure == 0 {
        return weights;
    }
    let arrays = |p: [S::F32; 3]| [simd.array(p[0]), simd.array(p[1])];
    let [a, b, c] = block.corners;
    let corners = [arrays(a), arrays(b), arrays(c)];
    let rounded = [simd.array(weights[0]), simd.array(weights[1]), simd.array(weights[2])];
    let fixed = exact::weights(unsure, corners, rounded);
    [simd.load(&fixed[0]), simd.load(&fixed[1]), simd.load(&fixed[2])]
}

/// Lanes where rounding of the edge functions, whose sum is given, moves the hit no farther than
/// rounding of the corners does.
///
/// Of a triangle seen nearly from its side, or a long thin one, the weights may be mostly
/// rounding, and the hit anywhere along it: off the part of the triangle that the ray meets, where
/// a technique that cuts up triangles would look for it.
#[inline(always)]
fn are_sure<S: Simd>(
    simd: S,
    rays: &Rays<S>,
    block: &Block<S>,
    depths: [S::F32; 3],
    sum: S::F32,
) -> u32 {
    let [a, b, c] = block.corners;
    let wide_by = |corner: [S::F32; 3]| simd.max(simd.abs(corner[0]), simd.abs(corner[1]));
    let wide = simd.max(simd.max(wide_by(a), wide_by(b)), wide_by(c));
    let (near, far) = range(simd, depths);
    // Edge functions are off by 12 half-ulps of `wide²` together; 24 of the largest coordinate
    // are allowed, of which this is at most a quarter.
    let reach = simd.add(simd.max(simd.abs(near), simd.abs(far)), rays.reach);
    let off = simd.mul(simd.sub(far, near), simd.mul(wide, wide));
    simd.le(off, simd.mul(reach, simd.abs(sum)))
}

/// Depths moved to where the ray is within the box of each triangle: nearly always they are, but
/// techniques must agree on every ray.
#[inline(always)]
fn within_bounds<S: Simd>(
    simd: S,
    rays: &Rays<S>,
    block: &Block<S>,
    depths: [S::F32; 3],
    depth: S::F32,
) -> S::F32 {
    let (enter, leave) = range(simd, depths);
    // By hand, axis by axis: an array that a loop runs over would have to be in memory.
    let (near, far) = within_slab(simd, rays.slope[0], rays.moves[0], along(block, 0), depths);
    let (enter, leave) = (simd.max(near, enter), simd.min(far, leave));
    let (near, far) = within_slab(simd, rays.slope[1], rays.moves[1], along(block, 1), depths);
    let (enter, leave) = (simd.max(near, enter), simd.min(far, leave));
    simd.min(simd.max(depth, enter), leave)
}

/// The corners along one axis.
#[inline(always)]
fn along<S: Simd>(block: &Block<S>, axis: usize) -> [S::F32; 3] {
    let [a, b, c] = block.corners;
    [a[axis], b[axis], c[axis]]
}

/// From which depth to which a ray is between the corners along one axis; everywhere if it hardly
/// moves along it.
#[inline(always)]
fn within_slab<S: Simd>(
    simd: S,
    slope: S::F32,
    moves: u32,
    [a, b, c]: [S::F32; 3],
    [az, bz, cz]: [S::F32; 3],
) -> (S::F32, S::F32) {
    if moves == 0 {
        return (simd.splat(f32::NEG_INFINITY), simd.splat(f32::INFINITY));
    }
    // Unsheared again, relative to the origin of the ray.
    let at = |corner: S::F32, z: S::F32| simd.add(corner, simd.mul(slope, z));
    let inverse = simd.div(simd.splat(1.0), slope);
    let (least, most) = range(simd, [at(a, az), at(b, bz), at(c, cz)]);
    let (low, high) = (simd.mul(least, inverse), simd.mul(most, inverse));
    let (near, far) = (simd.min(low, high), simd.max(low, high));
    if moves == 255 {
        return (near, far);
    }
    (kept(simd, near, moves, f32::NEG_INFINITY), kept(simd, far, moves, f32::INFINITY))
}

/// The lanes of `mask`, and `other` in the rest.
#[cold]
#[inline(never)]
fn kept<S: Simd>(simd: S, lanes: S::F32, mask: u32, other: f32) -> S::F32 {
    let mut lanes = simd.array(lanes);
    for (i, lane) in lanes.iter_mut().enumerate() {
        *lane = if mask >> i & 1 == 1 { *lane } else { other };
    }
    simd.load(&lanes)
}
