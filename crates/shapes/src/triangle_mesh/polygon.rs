//! A triangle cut by planes.

/// A part of a triangle: each of six cuts adds a corner, rarely more by rounding.
#[derive(Clone, Copy)]
pub(super) struct Polygon {
    corners: [[f64; 3]; 12],
    count: usize,
    /// Whether a corner was left out.
    pub(super) is_full: bool,
}

impl Polygon {
    pub(super) const EMPTY: Self = Self { corners: [[0.0; 3]; 12], count: 0, is_full: false };

    pub(super) fn new(triangle: [[f32; 3]; 3]) -> Self {
        let mut whole = Self::EMPTY;
        for corner in triangle {
            whole.push(corner.map(f64::from));
        }
        whole
    }

    pub(super) fn corners(&self) -> &[[f64; 3]] {
        &self.corners[..self.count]
    }

    fn push(&mut self, corner: [f64; 3]) {
        let Some(next) = self.corners.get_mut(self.count) else {
            self.is_full = true;
            return;
        };
        *next = corner;
        self.count += 1;
    }

    /// Makes `kept` the part on one side of a plane across an axis [Sutherland 74].
    #[inline]
    pub(super) fn cut(&self, axis: usize, wall: f64, side: f64, kept: &mut Self) {
        (kept.count, kept.is_full) = (0, self.is_full);
        let corners = self.corners();
        let Some(mut a) = corners.last() else { return };
        let mut from = (a[axis] - wall) * side;
        for b in corners {
            let to = (b[axis] - wall) * side;
            if (from < 0.0 && to > 0.0) || (from > 0.0 && to < 0.0) {
                let part = from / (from - to);
                let mut between = [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * part);
                between[axis] = wall;
                kept.push(between);
            }
            if to >= 0.0 {
                kept.push(*b);
            }
            (a, from) = (b, to);
        }
    }
}
