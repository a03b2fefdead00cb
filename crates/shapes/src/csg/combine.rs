//! Two tracks made one.

use nestray_core::aabb::Aabb;

use super::Operation;
use super::track::Track;

/// Where the ray enters or leaves the whole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change {
    pub(super) t: f32,
    pub(super) enters: bool,
    /// Whether the surface is that of the right operand.
    pub(super) right: bool,
}

/// A walk along both tracks.
#[derive(Debug)]
pub(super) struct Merge<'a> {
    operation: Operation,
    tracks: [&'a Track; 2],
}

impl Operation {
    /// Whether a point is in the whole.
    fn holds(self, [left, right]: [bool; 2]) -> bool {
        match self {
            Self::Union => left || right,
            Self::Intersection => left && right,
            Self::Difference => left && !right,
        }
    }

    /// A box around the whole, from those of the operands.
    #[must_use]
    pub fn bounds(self, left: Aabb, right: Aabb) -> Aabb {
        let met = match self {
            Self::Union if left.is_empty() => right,
            Self::Union if right.is_empty() => left,
            Self::Union => left.join(right),
            Self::Intersection => left.meet(right),
            Self::Difference => left,
        };
        if met.is_empty() { Aabb::EMPTY } else { met }
    }
}

impl<'a> Merge<'a> {
    pub(super) fn new(operation: Operation, left: &'a Track, right: &'a Track) -> Self {
        Self { operation, tracks: [left, right] }
    }

    /// Calls `found` with one change after the other as long as it wants more.
    pub(super) fn take_while(&self, mut found: impl FnMut(&Change) -> bool) {
        let mut inside = self.tracks.map(|track| track.inside);
        let mut passed = [0; 2];
        loop {
            let next = [0, 1].map(|side| self.tracks[side].events.get(passed[side]));
            let t = match next {
                [None, None] => return,
                [Some(a), Some(b)] => a.t.min(b.t),
                [Some(a), None] | [None, Some(a)] => a.t,
            };
            // What happens at the same place happens at once.
            let now = next.map(|event| event.filter(|event| event.t == t));
            let before = self.operation.holds(inside);
            for side in 0..2 {
                if let Some(event) = now[side] {
                    (inside[side], passed[side]) = (event.enters, passed[side] + 1);
                }
            }
            let enters = self.operation.holds(inside);
            if enters == before {
                continue;
            }
            // The left surface, unless it is only met from the other side.
            let right = now[0].is_none_or(|left| left.enters != enters && now[1].is_some());
            if !found(&Change { t, enters, right }) {
                return;
            }
        }
    }
}
