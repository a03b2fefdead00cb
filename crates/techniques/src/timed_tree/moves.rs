//! How the boxes of one node move, and when they are there.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::simd::Simd;

use super::{Linear, Part};

/// What the boxes of eight children change by over their time, and when that is.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Moves {
    /// What lower x of all changes by, upper x, lower y, …
    rows: [[f32; 8]; 6],
    /// What they are cut to.
    walls: [[f32; 8]; 6],
    from: [f32; 8],
    /// The last moment it is there.
    last: [f32; 8],
    /// One over how long it is.
    per: [f32; 8],
}

/// How far a moving box is widened, relative to its largest coordinate: more than what rounding
/// does where a ray asks where it is.
const SLACK: f32 = 20.0 * f32::EPSILON / 2.0;

impl Moves {
    /// A box so that where a ray finds it at any time, it contains `bounds`.
    pub(super) fn widened(bounds: Linear) -> Linear {
        if bounds.is_still() {
            return bounds;
        }
        let slack = bounds.begin.join(bounds.end).reach() * SLACK;
        let wider = |b: Aabb| Aabb { min: b.min - slack, max: b.max + slack };
        Linear { begin: wider(bounds.begin), end: wider(bounds.end), ..bounds }
    }

    /// How the parts of a node move; none if they do not, and are always there.
    pub(super) fn new(parts: &[Part]) -> Option<Self> {
        if parts.iter().all(|part| part.bounds.is_still() && part.time == [0.0, 1.0]) {
            return None;
        }
        let mut moves = Self {
            rows: [[0.0; 8]; 6],
            walls: [[0.0; 8]; 6],
            from: [0.0; 8],
            last: [1.0; 8],
            per: [1.0; 8],
        };
        for (lane, part) in parts.iter().enumerate() {
            let Part { bounds: Linear { begin, end, within }, time: [from, until], .. } = part;
            for axis in 0..3 {
                moves.rows[2 * axis][lane] = end.min[axis] - begin.min[axis];
                moves.rows[2 * axis + 1][lane] = end.max[axis] - begin.max[axis];
                moves.walls[2 * axis][lane] = within.min[axis];
                moves.walls[2 * axis + 1][lane] = within.max[axis];
            }
            moves.from[lane] = *from;
            moves.last[lane] = if *until < 1.0 { until.next_down() } else { 1.0 };
            moves.per[lane] = 1.0 / (until - from);
        }
        Some(moves)
    }

    /// The box of one part, which is `begin` at first.
    pub(super) fn bounds(&self, begin: Aabb, lane: usize) -> Linear {
        let corner = |rows: &[[f32; 8]; 6], row: usize| {
            Vec3A::from_array([0, 2, 4].map(|axis: usize| rows[axis + row][lane]))
        };
        let [low, high] = [0, 1].map(|row| corner(&self.rows, row));
        let end = Aabb { min: begin.min + low, max: begin.max + high };
        let [min, max] = [0, 1].map(|row| corner(&self.walls, row));
        Linear { begin, end, within: Aabb { min, max } }
    }

    /// When a part is there.
    pub(super) fn time(&self, lane: usize) -> [f32; 2] {
        let last = self.last[lane];
        [self.from[lane], if last < 1.0 { last.next_up() } else { 1.0 }]
    }

    /// Where the boxes, which are `begin` at first, are at a time, and which are there then.
    #[inline(always)]
    pub(super) fn rows_at<S: Simd>(
        &self,
        simd: S,
        begin: &[[f32; 8]; 6],
        time: f32,
    ) -> ([[f32; 8]; 6], u32) {
        let (time, from) = (simd.splat(time), simd.load(&self.from));
        let there = simd.le(from, time) & simd.le(time, simd.load(&self.last));
        let part = simd.mul(simd.sub(time, from), simd.load(&self.per));
        let mut rows = [[0.0; 8]; 6];
        for axis in 0..3 {
            let (low, high) = (2 * axis, 2 * axis + 1);
            let moved = simd.mul(simd.load(&self.rows[low]), part);
            let moved = simd.add(simd.load(&begin[low]), moved);
            rows[low] = simd.array(simd.max(moved, simd.load(&self.walls[low])));
            let moved = simd.mul(simd.load(&self.rows[high]), part);
            let moved = simd.add(simd.load(&begin[high]), moved);
            rows[high] = simd.array(simd.min(moved, simd.load(&self.walls[high])));
        }
        (rows, there)
    }
}
