//! All rays from a box through a rectangle of directions: the one test that light buffers,
//! ray coherence, ray classification and packets of rays share.

use glam::Vec3A;

use crate::aabb::Aabb;

/// The rays `o + s · (±e_a + u · e_b + v · e_c)` with `o` in a box, `(u, v)` in a rectangle
/// and `s` in `[0, farthest]`, where `a` is the main axis and `b`, `c` follow it in turn.
///
/// When `|u|, |v| ≤ 1` the main axis is the one along which the rays run fastest, and `s`
/// the distance along it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam {
    /// Where the rays start.
    pub origin: Aabb,
    /// The main axis, 0 to 2.
    pub axis: usize,
    /// Whether the rays run towards lower coordinates along it.
    pub backward: bool,
    /// Least and greatest slope along the next axis, `(axis + 1) % 3`.
    pub u: [f32; 2],
    /// Least and greatest slope along the one after.
    pub v: [f32; 2],
    /// Where the rays end, as a distance along the main axis; may be infinite.
    pub farthest: f32,
}

/// What a surface shows to the rays of a beam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// Its front, to all of them.
    Front,
    /// Its back, to all of them.
    Back,
    /// Both, or nobody knows.
    Mixed,
}

impl Beam {
    /// The distances along the main axis at which some ray of the beam is inside `bounds`;
    /// none if no ray ever is.
    ///
    /// Exact up to rounding, not just conservative: at one distance the rays fill a box,
    /// since each coordinate depends on a slope and an origin of its own. So the two meet
    /// where six linear inequalities hold, and the first number bounds from below how far
    /// along the main axis any ray of the beam meets the box. Rounded outwards.
    #[must_use]
    pub fn meets(&self, bounds: &Aabb) -> Option<[f32; 2]> {
        if bounds.is_empty() || self.origin.is_empty() {
            return None;
        }
        let [a, b, c] = [self.axis % 3, (self.axis + 1) % 3, (self.axis + 2) % 3];
        let side = |which: Vec3A, axis: usize| f64::from(which[axis]);
        let mut range = [0.0, f64::from(self.farthest)];
        // Along the main axis the slope is one; seen backwards, coordinates change sign.
        let (low, high, from, to) = if self.backward {
            (
                -side(bounds.max, a),
                -side(bounds.min, a),
                -side(self.origin.max, a),
                -side(self.origin.min, a),
            )
        } else {
            (
                side(bounds.min, a),
                side(bounds.max, a),
                side(self.origin.min, a),
                side(self.origin.max, a),
            )
        };
        at_least(&mut range, 1.0, to, low);
        at_least(&mut range, -1.0, -from, -high);
        for (axis, slopes) in [(b, self.u), (c, self.v)] {
            // The farthest out that any ray can be must reach the near side, and so on.
            at_least(
                &mut range,
                f64::from(slopes[1]),
                side(self.origin.max, axis),
                side(bounds.min, axis),
            );
            at_least(
                &mut range,
                -f64::from(slopes[0]),
                -side(self.origin.min, axis),
                -side(bounds.max, axis),
            );
        }
        // Half-lines were cut in doubles; a hair for the way back to `f32`.
        let slack = (self.origin.reach().max(bounds.reach()) * 1e-6).min(f32::MAX);
        let [first, last] = [range[0] as f32 - slack, range[1] as f32 + slack];
        (first <= last).then_some([first.max(0.0), last])
    }
}

/// Keeps the `s` of `range` with `origin + slope · s ≥ wall`.
fn at_least(range: &mut [f64; 2], slope: f64, origin: f64, wall: f64) {
    let missing = wall - origin;
    if slope > 0.0 {
        range[0] = range[0].max(missing / slope);
    } else if slope < 0.0 {
        range[1] = range[1].min(missing / slope);
    } else if missing > 0.0 {
        range[1] = f64::NEG_INFINITY;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A small generator of numbers in `[0, 1)`, so that core needs no other crate for it.
    struct Numbers(u64);

    impl Numbers {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (self.0 >> 40) as f32 / (1u64 << 24) as f32
        }
        fn between(&mut self, low: f32, high: f32) -> f32 {
            low + (high - low) * self.next()
        }
        fn aabb(&mut self, reach: f32) -> Aabb {
            let a = Vec3A::new(self.next(), self.next(), self.next()) * 2.0 - 1.0;
            let size = Vec3A::new(self.next(), self.next(), self.next()) * 0.5;
            Aabb { min: a * reach, max: a * reach + size }
        }
        fn slopes(&mut self) -> [f32; 2] {
            let (a, b) = (self.between(-1.0, 1.0), self.between(-1.0, 1.0));
            [a.min(b), a.max(b)]
        }
    }

    fn beam(numbers: &mut Numbers, case: usize) -> Beam {
        Beam {
            origin: numbers.aabb(1.0),
            axis: case % 3,
            backward: !case.is_multiple_of(2),
            u: numbers.slopes(),
            v: numbers.slopes(),
            farthest: if case.is_multiple_of(5) {
                numbers.between(0.5, 4.0)
            } else {
                f32::INFINITY
            },
        }
    }

    fn direction(beam: &Beam, u: f32, v: f32) -> Vec3A {
        let mut dir = Vec3A::ZERO;
        dir[beam.axis] = if beam.backward { -1.0 } else { 1.0 };
        dir[(beam.axis + 1) % 3] = u;
        dir[(beam.axis + 2) % 3] = v;
        dir
    }

    #[test]
    fn no_ray_of_a_beam_meets_a_box_the_beam_misses() {
        let mut numbers = Numbers(11);
        let mut missed = 0;
        for case in 0..20_000 {
            let (beam, bounds) = (beam(&mut numbers, case), numbers.aabb(4.0));
            let answer = beam.meets(&bounds);
            missed += usize::from(answer.is_none());
            for _ in 0..20 {
                let o = beam.origin;
                let origin =
                    o.min + o.size() * Vec3A::new(numbers.next(), numbers.next(), numbers.next());
                let u = numbers.between(beam.u[0], beam.u[1]);
                let v = numbers.between(beam.v[0], beam.v[1]);
                let s = numbers.between(0.0, beam.farthest.min(8.0));
                let point = origin + direction(&beam, u, v) * s;
                if bounds.contains(&Aabb { min: point, max: point }) {
                    let [first, last] = answer.expect("a ray is inside the box");
                    assert!(first <= s && s <= last, "seed 11, case {case}");
                }
            }
        }
        assert!(missed > 1_000, "the test saw no box that is missed");
    }

    #[test]
    fn where_a_beam_meets_a_box_some_ray_does() {
        let mut numbers = Numbers(12);
        let mut met = 0;
        for case in 0..20_000 {
            let (beam, bounds) = (beam(&mut numbers, case), numbers.aabb(2.0));
            let Some([first, last]) = beam.meets(&bounds) else { continue };
            met += 1;
            // Half way the rays fill a box that must overlap this one.
            let s = (first + last.min(first + 8.0)) / 2.0;
            let [low, high] = [(beam.u[0], beam.v[0]), (beam.u[1], beam.v[1])]
                .map(|(u, v)| direction(&beam, u, v) * s);
            let filled =
                Aabb { min: beam.origin.min + low.min(high), max: beam.origin.max + low.max(high) };
            let grown = Aabb { min: filled.min - 1e-4, max: filled.max + 1e-4 };
            assert!(grown.overlaps(&bounds), "seed 12, case {case}");
        }
        assert!(met > 1_000, "the test saw no box that is met");
    }
}
