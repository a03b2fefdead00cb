//! Cutting children by a plane.

use nestray_core::aabb::Aabb;

use super::build::Knife;
use crate::bvh::part::Part;
use crate::cells::Plane;

/// Parts on two sides of a plane, not yet cut.
pub(super) struct Cut {
    left: Side,
    right: Side,
    /// Parts on both sides, with the boxes of the two pieces.
    through: Vec<(Part, [Aabb; 2])>,
}

/// One side.
struct Side {
    /// Whole parts.
    whole: Vec<Part>,
    bounds: Aabb,
    /// Of parts and pieces.
    weight: f32,
}

impl Side {
    fn put(&mut self, bounds: Aabb, weight: f32) {
        self.bounds = self.bounds.join(bounds);
        self.weight += weight;
    }

    fn cost(&self) -> f32 {
        self.bounds.surface_area() * self.weight
    }
}

/// Boxes around what of a part is on each side of a plane; none if it is on one side only.
pub(super) fn halved(knife: &Knife<'_>, part: &Part, axis: usize, at: f32) -> Option<[Aabb; 2]> {
    let bounds = part.around().bounds();
    if bounds.max[axis] <= at || at <= bounds.min[axis] {
        return None;
    }
    let (mut below, mut above) = (bounds, bounds);
    (below.max[axis], above.min[axis]) = (at, at);
    let pieces = [knife.inside(part, &below), knife.inside(part, &above)];
    // What is not in one of them is in the other, whole.
    (!pieces.iter().any(|piece| piece.is_empty())).then_some(pieces)
}

impl Cut {
    pub(super) fn new(knife: &Knife<'_>, inside: &[Part], Plane { axis, at }: Plane) -> Self {
        let side = || Side { whole: Vec::new(), bounds: Aabb::EMPTY, weight: 0.0 };
        let mut cut = Self { left: side(), right: side(), through: Vec::new() };
        for &part in inside {
            let (bounds, weight) = (part.around().bounds(), part.weight());
            if let Some(pieces) = halved(knife, &part, axis, at) {
                cut.left.put(pieces[0], weight);
                cut.right.put(pieces[1], weight);
                cut.through.push((part, pieces));
                continue;
            }
            let is_left = bounds.center()[axis] <= at;
            let side = if is_left { &mut cut.left } else { &mut cut.right };
            side.put(bounds, weight);
            side.whole.push(part);
        }
        cut.put_back();
        cut
    }

    /// Leaves parts whole, on one side, where that costs less.
    fn put_back(&mut self) {
        let Self { left, right, .. } = self;
        self.through.retain(|&(part, _)| {
            let (bounds, weight) = (part.around().bounds(), part.weight());
            let both = left.cost() + right.cost();
            let with = |side: &Side| side.bounds.join(bounds).surface_area() * side.weight;
            let without = |side: &Side| side.bounds.surface_area() * (side.weight - weight);
            let (on_left, on_right) = (with(left) + without(right), without(left) + with(right));
            if both < on_left.min(on_right) {
                return true;
            }
            let (to, from) = if on_left <= on_right {
                (&mut *left, &mut *right)
            } else {
                (&mut *right, &mut *left)
            };
            to.bounds = to.bounds.join(bounds);
            to.whole.push(part);
            from.weight -= weight;
            false
        });
    }

    /// How many parts there are on each side.
    pub(super) fn counts(&self) -> [usize; 2] {
        [&self.left, &self.right].map(|side| side.whole.len() + self.through.len())
    }

    /// `area × Σ weights` on both sides.
    pub(super) fn cost(&self) -> f32 {
        self.left.cost() + self.right.cost()
    }

    /// Makes two parts of each that is on both sides; returns what is on each.
    pub(super) fn made(self) -> [Vec<Part>; 2] {
        let Self {
            left: Side { whole: mut left, .. }, right: Side { whole: mut right, .. }, ..
        } = self;
        for (part, pieces) in self.through {
            let [below, above] = pieces.map(|piece| part.piece(&piece));
            left.push(below);
            right.push(above);
        }
        [left, right]
    }
}
