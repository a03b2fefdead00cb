//! The rays of a packet, each in its own space.

use nestray_core::hit::Hit;
use nestray_core::packet::{GROUPS, Lanes, Packet, RAYS, eight, eight_mut};
use nestray_core::simd::Simd;

use crate::shape::Sides;
use crate::triangle_mesh::layout::Block;
use crate::triangle_mesh::shear::{Probe, STILL, Shear, axes};
use crate::triangle_mesh::test::{Hits, Rays};

/// No block has more vertices; a power of two.
const VERTICES: usize = 32;

/// What a packet brings to the triangles of a mesh: its rays, each in its own [`Shear`].
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Probes {
    origin: [Lanes; 3],
    slope: [Lanes; 3],
    reach: Lanes,
    /// The rays that move along x, along y.
    moves: [u32; 2],
    pub(super) axes: [usize; 3],
    is_forward: bool,
    /// The triangle that each has left.
    pub(super) skip: [u32; RAYS],
    /// The rays that have left one.
    pub(super) leaving: u32,
    /// Where each hits so far: which triangle, as the bits of a number, and where on it. How far
    /// away is its limit.
    pub(super) number: Lanes,
    pub(super) weights: [Lanes; 2],
    /// The vertices of a block, as eight of the rays see them.
    places: [[[f32; 8]; 3]; VERTICES],
}

impl Default for Probes {
    fn default() -> Self {
        let zero = [0.0; RAYS];
        Self {
            origin: [zero; 3],
            slope: [zero; 3],
            reach: zero,
            moves: [0; 2],
            axes: [0, 1, 2],
            is_forward: true,
            skip: [Hit::NOTHING; RAYS],
            leaving: 0,
            number: zero,
            weights: [zero; 2],
            places: [[[0.0; 8]; 3]; VERTICES],
        }
    }
}

impl Probes {
    #[inline(always)]
    pub(super) fn set<S: Simd>(&mut self, simd: S, packet: &Packet) {
        self.axes = axes(packet.beam.axis);
        let [x, y, z] = self.axes;
        self.is_forward = !packet.beam.backward;
        self.moves = [0; 2];
        for from in GROUPS {
            let part = |lanes: &Lanes| simd.load(eight(lanes, from));
            let inverse = simd.div(simd.splat(1.0), part(&packet.dir[z]));
            let slopes = [
                simd.mul(part(&packet.dir[x]), inverse),
                simd.mul(part(&packet.dir[y]), inverse),
                inverse,
            ];
            let mut far = simd.splat(0.0);
            for (axis, slope) in slopes.into_iter().enumerate() {
                let origin = part(&packet.origin[self.axes[axis]]);
                *eight_mut(&mut self.origin[axis], from) = simd.array(origin);
                *eight_mut(&mut self.slope[axis], from) = simd.array(slope);
                far = simd.max(far, simd.abs(origin));
            }
            *eight_mut(&mut self.reach, from) = simd.array(simd.add(far, far));
            for (moves, slope) in self.moves.iter_mut().zip(slopes) {
                *moves |= (!simd.le(simd.abs(slope), simd.splat(STILL)) & 255) << from;
            }
        }
        self.number = [f32::from_bits(Hit::NOTHING); RAYS];
    }

    /// One ray.
    #[inline(always)]
    pub(super) fn probe(&self, packet: &Packet, lane: usize, sides: Sides) -> Probe {
        let at = |lanes: &[Lanes; 3]| [lanes[0][lane], lanes[1][lane], lanes[2][lane]];
        let shear = Shear {
            origin: at(&self.origin),
            slope: at(&self.slope),
            t_min: packet.t_min[lane],
            axes: self.axes.map(|axis| axis as u8),
        };
        Probe { shear, skip: self.skip[lane], sides }
    }

    /// Eight rays, from number `half` on.
    #[inline(always)]
    pub(super) fn rays<S: Simd>(&self, simd: S, packet: &Packet, half: usize) -> Rays<S> {
        let lanes = |lanes: &Lanes| simd.load(eight(lanes, half));
        Rays {
            slope: [lanes(&self.slope[0]), lanes(&self.slope[1]), lanes(&self.slope[2])],
            moves: [self.moves[0] >> half & 255, self.moves[1] >> half & 255],
            reach: lanes(&self.reach),
            t_min: lanes(&packet.t_min),
            limit: lanes(&packet.limit),
            is_forward: self.is_forward,
        }
    }

    /// Moves the vertices of a block into the spaces of eight rays.
    #[inline(always)]
    pub(super) fn shear<S: Simd>(
        &mut self,
        simd: S,
        from: usize,
        vertices: impl Iterator<Item = [f32; 3]>,
    ) {
        let lanes = |lanes: &Lanes| simd.load(eight(lanes, from));
        let origin = [lanes(&self.origin[0]), lanes(&self.origin[1]), lanes(&self.origin[2])];
        let slope = [lanes(&self.slope[0]), lanes(&self.slope[1])];
        for (place, at) in self.places.iter_mut().zip(vertices) {
            let off = |i: usize| simd.sub(simd.splat(at[self.axes[i] % 3]), origin[i]);
            let (x, y, z) = (off(0), off(1), off(2));
            place[0] = simd.array(simd.sub(x, simd.mul(slope[0], z)));
            place[1] = simd.array(simd.sub(y, simd.mul(slope[1], z)));
            place[2] = simd.array(z);
        }
    }

    /// One triangle of a block, as eight rays see it.
    #[inline(always)]
    pub(super) fn triangle<S: Simd>(&self, simd: S, [a, b, c]: [usize; 3], lanes: u32) -> Block<S> {
        let corner = |vertex: usize| {
            let [x, y, z] = &self.places[vertex % VERTICES];
            [simd.load(x), simd.load(y), simd.load(z)]
        };
        let corners = [corner(a), corner(b), corner(c)];
        Block { corners, shared: None, lanes, first: 0, next: None }
    }

    /// The triangle that a ray hits so far.
    #[inline(always)]
    pub(super) fn held(&self, lane: usize) -> u32 {
        self.number[lane].to_bits()
    }

    /// Takes a nearer hit for some of eight rays.
    #[inline(always)]
    pub(super) fn hold<S: Simd>(
        &mut self,
        simd: S,
        (packet, from): (&mut Packet, usize),
        number: u32,
        nearer: u32,
        found: &Hits<S>,
    ) {
        let put = |lanes: &mut Lanes, new: S::F32| {
            let lanes = eight_mut(lanes, from);
            *lanes = simd.array(simd.choose(nearer, new, simd.load(lanes)));
        };
        put(&mut packet.limit, found.t);
        put(&mut self.number, simd.splat(f32::from_bits(number)));
        put(&mut self.weights[0], found.weights[0]);
        put(&mut self.weights[1], found.weights[1]);
    }
}
