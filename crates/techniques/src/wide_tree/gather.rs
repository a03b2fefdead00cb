//! Where a bundle of rays starts: the nodes about as large as the bundle that it meets.
//!
//! A node that is much larger is met by all of its rays or by none, so that looking into it
//! once saves a visit for each. A node that is smaller is met by some: each ray asks.

use nestray_core::beam::Beam;
use nestray_core::bundle::{Bundle, Entrance};
use nestray_core::simd::Simd;
use nestray_core::trail::{self, DONE, Trail};

use super::{Node, WideTree};

/// A beam's part of the box tests.
pub(crate) struct Pencil {
    /// The main axis and the two after it.
    axes: [usize; 3],
    sign: f32,
    /// What to take off lower and upper coordinates along each axis: rounded outwards, the
    /// first along the main axis by `sign`.
    low: [f32; 3],
    high: [f32; 3],
    u: [f32; 2],
    v: [f32; 2],
}

/// How far coordinates are moved outwards, relative to the largest: more than the slack of a
/// ray's own box test and what rounding does here.
const SLACK: f32 = 64.0 * f32::EPSILON;
/// How many times as large as the bundle a node must be to be looked into.
const LARGE: f32 = 4.0;

impl Pencil {
    /// For boxes whose coordinates are at most `reach`.
    pub(crate) fn new(beam: &Beam, reach: f32) -> Self {
        let axes = [beam.axis, (beam.axis + 1) % 3, (beam.axis + 2) % 3];
        let slack = beam.origin.reach().max(reach) * SLACK;
        let (mut low, mut high) = (
            axes.map(|axis| beam.origin.max[axis] + slack),
            axes.map(|axis| beam.origin.min[axis] - slack),
        );
        let mut sign = 1.0;
        if beam.backward {
            sign = -1.0;
            (low[0], high[0]) =
                (-beam.origin.min[beam.axis] + slack, -beam.origin.max[beam.axis] - slack);
        }
        Self { axes, sign, low, high, u: beam.u, v: beam.v }
    }

    /// Which of eight boxes some ray may meet, which of those are large, and from how far
    /// along the main axis on.
    #[inline(always)]
    pub(crate) fn meets<S: Simd>(&self, simd: S, rows: &[[f32; 8]; 6]) -> (u32, u32, S::F32) {
        let [a, b, c] = self.axes;
        let backward = usize::from(self.sign < 0.0);
        let side = |row: usize, shift: f32| simd.sub(simd.load(&rows[row]), simd.splat(shift));
        let along = |row: usize, shift: f32| {
            simd.mul_sub(simd.load(&rows[row]), simd.splat(self.sign), simd.splat(shift))
        };
        let enter = simd.max(along(2 * a + backward, self.low[0]), simd.splat(0.0));
        let leave = along(2 * a + 1 - backward, self.high[0]);
        let mut mask = simd.le(enter, leave);
        let middle = simd.add(enter, leave);
        let mut size = simd.splat(0.0);
        for (axis, which, slopes) in [(b, 1, self.u), (c, 2, self.v)] {
            let (low, high) =
                (side(2 * axis, self.low[which]), side(2 * axis + 1, self.high[which]));
            let far = if slopes[1] > 0.0 { leave } else { enter };
            let near = if slopes[0] > 0.0 { enter } else { leave };
            mask &= simd.le(low, simd.mul(simd.splat(slopes[1]), far));
            mask &= simd.le(simd.mul(simd.splat(slopes[0]), near), high);
            size = simd.add(size, simd.sub(high, low));
        }
        let width = (self.u[1] - self.u[0]) + (self.v[1] - self.v[0]);
        let large = simd.le(simd.mul(simd.splat(0.5 * LARGE * width), middle), size);
        (mask, large & mask, enter)
    }
}

/// Lanes that hold a node.
fn inner(node: &Node) -> u32 {
    (0..8).fold(0, |mask, lane| mask | (!node.words[lane] >> 31) << lane)
}

impl WideTree {
    /// See [`gather`](nestray_core::technique::Technique::gather).
    #[inline(always)]
    pub(super) fn gather_nodes<S: Simd>(
        &self,
        simd: S,
        bundle: &Bundle,
        trail: &mut Trail,
        entrance: &mut Entrance,
    ) -> bool {
        if bundle.spread() > 0.01 * self.reach {
            return false;
        }
        entrance.clear();
        let pencil = Pencil::new(&bundle.beam, self.reach);
        let mut top = trail.reset();
        // Nodes to look into are put off as `parent << 3 | lane`.
        let (mut parent, mut lane, mut at) = (0usize, None, 0u32);
        loop {
            let node = &self.nodes[at as usize];
            let (mask, large, enter) = pencil.meets(simd, &node.rows);
            let pending = entrance.count() + top.count();
            match lane {
                // No room for what is in it: it stays whole.
                Some(lane) if pending + mask.count_ones() as usize > Entrance::ROOM => {
                    if !entrance.push(&self.nodes[parent].rows, lane, at) {
                        return false;
                    }
                }
                _ => {
                    let open = large & inner(node);
                    let mut rest = mask & !open;
                    while rest != 0 {
                        let lane = rest.trailing_zeros() as usize;
                        if !entrance.push(&node.rows, lane, node.words[lane & 7]) {
                            return false;
                        }
                        rest &= rest - 1;
                    }
                    let names = std::array::from_fn(|lane| at << 3 | lane as u32);
                    trail::put_off_all(simd, trail, &mut top, open, enter, &names);
                }
            }
            let name = trail::take_last(trail, &mut top);
            if name == DONE {
                return true;
            }
            (parent, lane) = (name as usize >> 3, Some(name as usize & 7));
            at = self.nodes[parent].words[name as usize & 7];
        }
    }
}
