//! A child while children are put in order.

use glam::Vec4;
use nestray_core::aabb::Aabb;

/// A child, or a part of one: what putting it in order takes, side by side.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Part {
    /// The lower corner of its box and its number; the upper corner, negated, and its weight. So
    /// the joint box of two is the smaller of each, and both moves in one piece.
    lanes: [f32; 8],
}

impl Part {
    pub(crate) fn new(bounds: &Aabb, number: u32, weight: f32) -> Self {
        let ([a, b, c], [d, e, f]) = (bounds.min.to_array(), bounds.max.to_array());
        Self { lanes: [a, b, c, f32::from_bits(number), -d, -e, -f, weight] }
    }

    /// A part of the same child with another box.
    pub(crate) fn piece(&self, bounds: &Aabb) -> Self {
        Self::new(bounds, self.number(), self.weight())
    }

    /// Which child it is or is of.
    #[inline(always)]
    pub(crate) fn number(&self) -> u32 {
        self.lanes[3].to_bits()
    }

    /// What testing the child costs.
    #[inline(always)]
    pub(crate) fn weight(&self) -> f32 {
        self.lanes[7]
    }

    /// Its box.
    #[inline(always)]
    pub(crate) fn around(&self) -> Around {
        Around(self.lanes)
    }

    /// Twice the centre of its box; a fourth lane means nothing.
    #[inline(always)]
    pub(crate) fn center(&self) -> Vec4 {
        let [a, b, c, d, e, f, g, h] = self.lanes;
        Vec4::new(a, b, c, d) - Vec4::new(e, f, g, h)
    }

    /// The same along one axis.
    #[inline(always)]
    pub(super) fn center_along(&self, axis: usize) -> f32 {
        self.lanes[axis & 3] - self.lanes[(axis & 3) + 4]
    }
}

/// A box as [`Part`] has it; lanes 3 and 7 mean nothing.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(crate) struct Around(pub(super) [f32; 8]);

impl Around {
    pub(crate) const EMPTY: Self = Self([f32::INFINITY; 8]);

    /// A box around all parts.
    pub(crate) fn all(parts: &[Part]) -> Self {
        parts.iter().fold(Self::EMPTY, |all, part| all.join(&part.around()))
    }

    /// A box around both.
    #[inline(always)]
    pub(crate) fn join(mut self, other: &Self) -> Self {
        for (a, &b) in self.0.iter_mut().zip(&other.0) {
            *a = if *a < b { *a } else { b };
        }
        self
    }

    /// Half the surface area, of what is not empty.
    #[inline(always)]
    pub(crate) fn half_area(&self) -> f32 {
        // Negated twice is as good as never.
        let [a, b, c, _, d, e, f, _] = self.0;
        let (x, y, z) = (a + d, b + e, c + f);
        x * y + y * z + z * x
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let [a, b, c, _, d, e, f, _] = self.0;
        Aabb { min: [a, b, c].into(), max: [-d, -e, -f].into() }
    }
}

/// The centres of parts, doubled.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Centers {
    pub(super) min: Vec4,
    pub(super) max: Vec4,
}

impl Centers {
    const NONE: Self =
        Self { min: Vec4::splat(f32::INFINITY), max: Vec4::splat(f32::NEG_INFINITY) };

    #[inline(always)]
    pub(crate) fn of(parts: &[Part]) -> Self {
        // Two at a time: each waits for the one before.
        let (mut even, mut odd) = (Self::NONE, Self::NONE);
        let (pairs, last) = parts.as_chunks::<2>();
        for [a, b] in pairs {
            (even, odd) = (even.with(a.center()), odd.with(b.center()));
        }
        last.iter().fold(even.join(odd), |all, part| all.with(part.center()))
    }

    #[inline(always)]
    fn with(self, center: Vec4) -> Self {
        Self { min: self.min.min(center), max: self.max.max(center) }
    }

    #[inline(always)]
    pub(super) fn join(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }
}

/// Puts the lower half along the longest axis first; returns how many that are.
pub(crate) fn in_halves(parts: &mut [Part]) -> usize {
    let size = Around::all(parts).bounds().size();
    let axis = size.max_position();
    let half = parts.len() / 2;
    parts.select_nth_unstable_by(half, |a, b| {
        let [x, y] = [a, b].map(|part| part.center_along(axis));
        x.total_cmp(&y).then(a.number().cmp(&b.number()))
    });
    half
}
