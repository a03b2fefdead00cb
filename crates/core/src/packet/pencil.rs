//! A beam of rays and eight boxes at a time.

use crate::beam::Beam;
use crate::simd::Simd;

/// A beam's part of the box tests.
#[derive(Clone, Copy, Debug)]
pub struct Pencil {
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

impl Pencil {
    /// For boxes whose coordinates are at most `reach`.
    #[must_use]
    pub fn new(beam: &Beam, reach: f32) -> Self {
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

    /// Which of eight boxes some ray may meet, and from how far along the main axis on: lower x
    /// of all, upper x, lower y, ….
    #[inline(always)]
    pub fn meets<S: Simd>(&self, simd: S, rows: &[[f32; 8]; 6]) -> (u32, S::F32) {
        let [a, b, c] = self.axes;
        let backward = usize::from(self.sign < 0.0);
        let side = |row: usize, shift: f32| simd.sub(simd.load(&rows[row]), simd.splat(shift));
        let along = |row: usize, shift: f32| {
            simd.mul_sub(simd.load(&rows[row]), simd.splat(self.sign), simd.splat(shift))
        };
        let enter = simd.max(along(2 * a + backward, self.low[0]), simd.splat(0.0));
        let leave = along(2 * a + 1 - backward, self.high[0]);
        let mut mask = simd.le(enter, leave);
        for (axis, which, slopes) in [(b, 1, self.u), (c, 2, self.v)] {
            let (low, high) =
                (side(2 * axis, self.low[which]), side(2 * axis + 1, self.high[which]));
            let far = if slopes[1] > 0.0 { leave } else { enter };
            let near = if slopes[0] > 0.0 { enter } else { leave };
            mask &= simd.le(low, simd.mul(simd.splat(slopes[1]), far));
            mask &= simd.le(simd.mul(simd.splat(slopes[0]), near), high);
        }
        (mask, enter)
    }
}
