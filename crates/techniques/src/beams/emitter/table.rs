//! One point that rays pass, or one direction that they take.

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::aim::Emitter;
use nestray_core::beam::Beam;
use nestray_core::ray::{Ray, RayKind};

use crate::beams::path::{Cell, Path};

/// One emitter, for rays that come to it or go out from it. It has six roots: towards lower x,
/// higher x, lower y, …
#[derive(Debug)]
pub(crate) struct Table {
    place: Place,
    /// How far a point or a place on the main axis may be off.
    pub(super) slack: f32,
    /// Rays from farther out go through the tree.
    reach: f32,
}

/// Where its rays are.
#[derive(Debug)]
enum Place {
    /// They pass through a box, mostly a point.
    Through {
        through: Aabb,
        /// For each root the slopes at which children are seen.
        seen: [[[f32; 2]; 2]; 6],
    },
    /// They run along one direction: its main axis, whether it runs down that, and its slopes.
    /// `shadow` is what all children cover, as seen along it, of the plane across the main axis
    /// at `plane`, which is before all of them.
    Along { axis: usize, backward: bool, slopes: [f32; 2], plane: f32, shadow: [[f32; 2]; 2] },
}

/// A ray as a table sees it: going out from the emitter, from one place on the main axis to
/// another.
pub(super) struct Seen {
    /// Which root.
    pub(super) face: usize,
    pub(super) path: Path,
    pub(super) range: [f32; 2],
    /// Place of parameter 0, if the ray really goes out.
    pub(super) out: Option<f32>,
    /// What a parameter is along the main axis.
    pub(super) scale: f32,
}

impl Place {
    /// Rays through a box that may meet `bounds`, where places may be off by `slack`.
    fn through(through: Aabb, bounds: Aabb, slack: f32) -> Self {
        let (middle, half) = (through.center(), through.size() * 0.5);
        let seen = std::array::from_fn(|face| {
            let axis = face / 2;
            let sign = if face.is_multiple_of(2) { -1.0 } else { 1.0 };
            let plane = middle[axis] - sign * (half[axis] + 2.0 * slack);
            let [a, b] = [bounds.min, bounds.max].map(|corner| (corner[axis] - plane) * sign);
            let [near, far] = [a.min(b), a.max(b)];
            [1, 2].map(|next| {
                let aside = (axis + next) % 3;
                let wide = half[aside] + 2.0 * half[axis] + 6.0 * slack;
                let low = bounds.min[aside] - (middle[aside] + wide);
                let high = bounds.max[aside] - (middle[aside] - wide);
                if near <= 0.0 {
                    return if far > 0.0 { [-1.0, 1.0] } else { [1.0, -1.0] };
                }
                let low = low / if low < 0.0 { near } else { far };
                let high = high / if high > 0.0 { near } else { far };
                [(low - SLOPE).max(-1.0), (high + SLOPE).min(1.0)]
            })
        });
        Self::Through { through, seen }
    }

    /// Rays towards `toward`, over all of `bounds`.
    fn along(toward: [f32; 3], bounds: Aabb) -> Self {
        let out = -Vec3A::from_array(toward);
        let size = out.abs();
        let axis = size.max_position();
        let backward = out[axis] < 0.0;
        let slopes = [1, 2].map(|next| out[(axis + next) % 3] / size[axis]);
        let room = 16.0 * Clip::SLACK * bounds.reach();
        let plane = if backward { bounds.max[axis] + room } else { bounds.min[axis] - room };
        let mut shadow = [[f32::INFINITY, f32::NEG_INFINITY]; 2];
        for corner in (0..8).map(|corner| bounds.corner(corner)) {
            for (side, [low, high]) in shadow.iter_mut().enumerate() {
                let behind = (corner[axis] - plane).abs();
                let at = corner[(axis + 1 + side) % 3] - slopes[side] * behind;
                (*low, *high) = (low.min(at - room), high.max(at + room));
            }
        }
        Self::Along { axis, backward, slopes, plane, shadow }
    }
}

impl Table {
    pub(super) fn new(emitter: &Emitter, bounds: Aabb) -> Self {
        let slack = |reach: f32| 4.0 * Clip::SLACK * reach;
        let through = |min: [f32; 3], max: [f32; 3]| {
            let through = Aabb { min: min.into(), max: max.into() };
            let reach = through.reach().max(bounds.reach());
            (Place::through(through, bounds, slack(reach)), reach)
        };
        let (place, reach) = match *emitter {
            Emitter::Point(at) => through(at, at),
            Emitter::Box { min, max } => through(min, max),
            Emitter::Direction(toward) => (Place::along(toward, bounds), bounds.reach()),
        };
        Self { place, slack: slack(reach), reach: 2.0 * reach }
    }

    /// A ray as seen from the emitter, if it passes it at one of its ends.
    #[inline]
    pub(super) fn see(&self, ray: &Ray, limit: f32) -> Option<Seen> {
        if ray.origin().abs().max_element() > self.reach {
            return None;
        }
        match &self.place {
            Place::Through { through, seen } => {
                // Shadow rays mostly come in, and others go out.
                let out = !matches!(ray.kind(), RayKind::Shadow { .. });
                self.see_through(ray, limit, (through, seen), out)
                    .or_else(|| self.see_through(ray, limit, (through, seen), !out))
            }
            Place::Along { axis, backward, slopes, plane, shadow } => {
                self.see_along(ray, limit, (*axis, *backward, *slopes), (*plane, shadow))
            }
        }
    }

    /// A ray that goes out if it begins behind the emitter, or comes in if it ends there.
    #[inline]
    fn see_through(
        &self,
        ray: &Ray,
        limit: f32,
        (through, seen): (&Aabb, &[[[f32; 2]; 2]; 6]),
        out: bool,
    ) -> Option<Seen> {
        let (origin, dir) = (ray.origin(), ray.dir());
        let axis = dir.abs().max_position();
        let scale = dir[axis].abs();
        let backward = (dir[axis] > 0.0) != out;
        let sign = if backward { -1.0 } else { 1.0 };
        let (middle, half) = (through.center(), through.size() * 0.5);
        let at = (middle[axis] - sign * half[axis] - origin[axis]) / dir[axis];
        let range = if out {
            [(ray.t_min() - at) * scale, (limit - at) * scale]
        } else {
            [(at - limit) * scale, (at - ray.t_min()) * scale]
        };
        if range[0].is_nan() || range[0] < -self.slack {
            return None;
        }
        let asides = [(axis + 1) % 3, (axis + 2) % 3];
        let passes = asides.iter().all(|&aside| {
            let off = (origin[aside] + dir[aside] * at - middle[aside]).abs();
            off <= half[aside] + 2.0 * half[axis] + self.slack
        });
        if !passes {
            return None;
        }
        let outward = if out { 1.0 / scale } else { -1.0 / scale };
        let face = 2 * axis + usize::from(!backward);
        let mut place = [0.0; 2];
        for (side, place) in place.iter_mut().enumerate() {
            let ([low, high], slope) = (seen[face][side], dir[asides[side]] * outward);
            if !(low..=high).contains(&slope) {
                return None;
            }
            *place = (slope - low) / (high - low);
        }
        let path = Path::in_square(place[0], place[1]);
        Some(Seen { face, path, range, out: out.then_some(-at * scale), scale })
    }

    /// A ray towards the light: seen from there, against its direction.
    #[inline]
    fn see_along(
        &self,
        ray: &Ray,
        limit: f32,
        (axis, backward, slopes): (usize, bool, [f32; 2]),
        (plane, shadow): (f32, &[[f32; 2]; 2]),
    ) -> Option<Seen> {
        let (origin, dir) = (ray.origin(), ray.dir());
        let scale = dir[axis].abs();
        if scale == 0.0 || (dir[axis] > 0.0) != backward {
            return None;
        }
        let at = (plane - origin[axis]) / dir[axis];
        let mut address = [0.0; 2];
        for (side, address) in address.iter_mut().enumerate() {
            let aside = (axis + 1 + side) % 3;
            let ([low, high], point) = (shadow[side], origin[aside] + dir[aside] * at);
            let parallel = (dir[aside] / scale + slopes[side]).abs() <= PARALLEL;
            if !parallel || !(low..=high).contains(&point) {
                return None;
            }
            *address = (point - low) / (high - low);
        }
        let [x, y] = address;
        let range = [(at - limit) * scale, (at - ray.t_min()) * scale];
        Some(Seen { face: 0, path: Path::in_square(x, y), range, out: None, scale })
    }

    /// The rays of a cell.
    pub(super) fn beam(&self, face: usize, cell: Cell) -> Beam {
        let farthest = f32::INFINITY;
        match &self.place {
            Place::Through { through, seen } => {
                let (axis, backward) = (face / 2, face.is_multiple_of(2));
                let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
                let sign = if backward { -1.0 } else { 1.0 };
                let (middle, half) = (through.center(), through.size() * 0.5);
                let mut origin = Aabb { min: middle, max: middle };
                // A little behind, so that all of a ray is ahead.
                let plane = middle[axis] - sign * (half[axis] + 2.0 * self.slack);
                (origin.min[axis], origin.max[axis]) =
                    (plane - 0.5 * self.slack, plane + 0.5 * self.slack);
                for aside in [next, last] {
                    let wide = half[aside] + 2.0 * half[axis] + 5.0 * self.slack;
                    (origin.min[aside], origin.max[aside]) =
                        (middle[aside] - wide, middle[aside] + wide);
                }
                let [u, v] = [0, 1].map(|side| {
                    let [low, high] = seen[face][side];
                    let [from, to] = cell.range(side).map(|x| low + (high - low) * x);
                    [from - SLOPE, to + SLOPE]
                });
                Beam { origin, axis, backward, u, v, farthest }
            }
            Place::Along { axis, backward, slopes, plane, shadow } => {
                let mut origin = Aabb { min: Vec3A::splat(*plane), max: Vec3A::splat(*plane) };
                for (side, [low, high]) in shadow.iter().enumerate() {
                    let aside = (axis + 1 + side) % 3;
                    let place = |x: f32| low + (high - low) * x;
                    let range = cell.range(side);
                    origin.min[aside] = place(range[0]) - 2.0 * self.slack;
                    origin.max[aside] = place(range[1]) + 2.0 * self.slack;
                }
                let [u, v] = slopes.map(|slope| [slope - PARALLEL, slope + PARALLEL]);
                Beam { origin, axis: *axis, backward: *backward, u, v, farthest }
            }
        }
    }
}

/// How far rounding may move a slope.
const SLOPE: f32 = 16.0 * f32::EPSILON;
/// How far the slopes of rays along one direction may differ.
const PARALLEL: f32 = 1e-6;
