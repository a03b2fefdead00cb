//! Boxes whose faces move evenly.

use glam::{DVec3, Vec3A};
use nestray_core::aabb::Aabb;

/// A box linear in time, cut to one that does not move. It may be empty for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Linear {
    /// What it is when its time begins, before it is cut.
    pub begin: Aabb,
    /// What it is when its time ends, before it is cut.
    pub end: Aabb,
    /// What it is cut to.
    pub within: Aabb,
}

impl Linear {
    /// Contains nothing; the identity of [`join`](Self::join).
    pub const EMPTY: Self = Self::still(Aabb::EMPTY);

    /// A box that does not move.
    #[must_use]
    pub const fn still(bounds: Aabb) -> Self {
        Self { begin: bounds, end: bounds, within: bounds }
    }

    /// Whether it does not move.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.begin == self.within && self.end == self.within
    }

    /// A box around both at any time: a straight line below two straight lines at both ends is
    /// below them.
    #[must_use]
    pub fn join(self, other: Self) -> Self {
        Self {
            begin: self.begin.join(other.begin),
            end: self.end.join(other.end),
            within: self.within.join(other.within),
        }
    }

    /// Where it is when `part` of its time is over.
    #[must_use]
    pub fn at(&self, part: f32) -> Aabb {
        self.uncut(part).meet(self.within)
    }

    /// The same before it is cut.
    #[must_use]
    pub fn uncut(&self, part: f32) -> Aabb {
        let [begin, end] = [self.begin, self.end];
        Aabb {
            min: begin.min + (end.min - begin.min) * part,
            max: begin.max + (end.max - begin.max) * part,
        }
    }

    /// The part of it in `cell`.
    #[must_use]
    pub fn cut_to(&self, cell: &Aabb) -> Self {
        let within = self.within.meet(*cell);
        if self.is_still() { Self::still(within) } else { Self { within, ..*self } }
    }

    /// Whether any of it is in `cell` at any time, give or take rounding.
    #[must_use]
    pub fn passes(&self, cell: &Aabb) -> bool {
        if !self.within.overlaps(cell) {
            return false;
        }
        if self.is_still() {
            return true;
        }
        let slack = 1e-6 * self.begin.join(self.end).reach();
        // When it is neither all before nor all behind the cell, along all axes so far.
        let mut when = [0f32, 1.0];
        let mut narrow = |begin: f32, end: f32| match (begin > slack, end > slack) {
            (false, false) => {}
            (true, true) => when = [1.0, 0.0],
            (true, false) => when[0] = when[0].max((begin - slack) / (begin - end)),
            (false, true) => when[1] = when[1].min((slack - begin) / (end - begin)),
        };
        for axis in 0..3 {
            narrow(self.begin.min[axis] - cell.max[axis], self.end.min[axis] - cell.max[axis]);
            narrow(cell.min[axis] - self.begin.max[axis], cell.min[axis] - self.end.max[axis]);
        }
        when[0] <= when[1] + 1e-5
    }

    /// Surface area, on average over its time.
    #[must_use]
    pub fn mean_area(&self) -> f64 {
        let [begin, end] = [self.begin, self.end].map(|bounds| bounds.meet(self.within));
        if self.is_still() || (Self::goes_by(begin, self.begin) && Self::goes_by(end, self.end)) {
            return mean(size(begin), size(end));
        }
        /// How many moments are looked at where much is cut off.
        const MOMENTS: u8 = 8;
        let at = |i: u8| {
            let size = size(self.at((f32::from(i) + 0.5) / f32::from(MOMENTS)));
            mean(size, size)
        };
        (0..MOMENTS).map(at).sum::<f64>() / f64::from(MOMENTS)
    }

    /// Whether hardly anything was cut off.
    fn goes_by(cut: Aabb, uncut: Aabb) -> bool {
        let allowed = cut.size() * 0.05;
        let off = |a: Vec3A, b: Vec3A| (a - b).abs().cmple(allowed).all();
        off(cut.min, uncut.min) && off(cut.max, uncut.max)
    }
}

fn size(bounds: Aabb) -> DVec3 {
    bounds.max.as_dvec3() - bounds.min.as_dvec3()
}

/// The mean area of a box that grows evenly from one size to another: the integral of
/// `2(xy + yz + zx)`.
///
/// What has no area counts for a little by its length, so that builders can tell long from short.
fn mean(a: DVec3, b: DVec3) -> f64 {
    if a.min(b).min_element() < 0.0 {
        return 0.0;
    }
    let (c, d) = (DVec3::new(a.y, a.z, a.x), DVec3::new(b.y, b.z, b.x));
    let faces = (a.dot(c) * 2.0 + a.dot(d) + b.dot(c) + b.dot(d) * 2.0) / 3.0;
    let length = a.element_sum() + b.element_sum();
    faces + 1e-7 * length * length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::counted::Numbers;

    fn any(numbers: &mut Numbers) -> Linear {
        let mut one = || {
            let min = numbers.point() * 3.0;
            Aabb { min, max: min + numbers.point() }
        };
        let [begin, end] = [one(), one()];
        Linear { begin, end, within: begin.join(end) }
    }

    #[test]
    fn the_mean_area_is_that_of_many_moments() {
        let mut numbers = Numbers::new(1);
        for i in 0..200 {
            let mut moving = any(&mut numbers);
            if i % 2 == 1 {
                moving = moving.cut_to(&Aabb { min: Vec3A::ONE, max: Vec3A::splat(2.5) });
            }
            let at = |i: u16| size(moving.at((f32::from(i) + 0.5) / 1000.0));
            let area = |i: u16| if at(i).min_element() < 0.0 { 0.0 } else { mean(at(i), at(i)) };
            let many = (0..1000).map(area).sum::<f64>() / 1000.0;
            let off = (moving.mean_area() - many).abs();
            assert!(off < if i % 2 == 1 { 0.5 } else { 1e-3 * many }, "{many}, off by {off}");
        }
    }

    #[test]
    fn a_join_holds_both_at_any_time_and_cells_tell_who_passes() {
        let mut numbers = Numbers::new(2);
        let mut passing = 0;
        for _ in 0..500 {
            let (a, b) = (any(&mut numbers), any(&mut numbers));
            let min = numbers.point() * 3.0;
            let cell = Aabb { min, max: min + numbers.point() };
            let passes = a.passes(&cell);
            passing += u32::from(passes);
            for i in 0..50 {
                let part = i as f32 / 49.0;
                let (now, both) = (a.at(part), a.join(b).at(part));
                let wider = Aabb { min: both.min - 1e-5, max: both.max + 1e-5 };
                assert!(wider.contains(&now));
                assert!(passes || now.is_empty() || !now.overlaps(&cell), "{a:?} {cell:?}");
            }
        }
        assert!((50..450).contains(&passing), "{passing} pass");
    }
}
