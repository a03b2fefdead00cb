//! Points that many rays pass, and directions that many take: lights and eyes.

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::aim::Emitter;
use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};

use super::cells::{Address, Cell, Cells, Limits, Maker, Room};
use super::cut::Forest;
use super::list::Key;
use super::{Ask, Found, Guide};

/// The lists of some emitters.
#[derive(Debug)]
pub(crate) struct Emitters {
    tables: Vec<Table>,
    room: Room,
    /// Which rays come near them.
    serves: fn(RayKind) -> bool,
}

/// The lists of one emitter, for rays that come to it or go out from it.
#[derive(Debug)]
struct Table {
    place: Place,
    /// How far a point or a place on the main axis may be off.
    slack: f32,
    /// Rays from farther out go through the tree.
    reach: f32,
    /// Towards lower x, higher x, lower y, …
    faces: [Cells; 6],
}

/// Where its rays are.
#[derive(Debug)]
enum Place {
    /// They pass through a box, mostly a point.
    Through(Aabb),
    /// They run along one direction: its main axis, whether it runs down that, and its slopes.
    /// `shadow` is what all children cover, as seen along it, of the plane across the main axis
    /// at `plane`, which is before all of them.
    Along { axis: usize, backward: bool, slopes: [f32; 2], plane: f32, shadow: [[f32; 2]; 2] },
}

/// A ray as a table sees it: going out from the emitter, from one place on the main axis to
/// another.
struct Seen {
    face: usize,
    address: Address,
    range: [f32; 2],
    /// Place of parameter 0, if the ray really goes out.
    out: Option<f32>,
    /// What a parameter is along the main axis.
    scale: f32,
}

impl Emitters {
    /// Tables for `emitters`, for the kinds of rays that `serves` says.
    pub(crate) fn new(
        emitters: &[Emitter],
        bounds: Aabb,
        limits: Limits,
        serves: fn(RayKind) -> bool,
    ) -> Self {
        let tables = emitters.iter().map(|emitter| Table::new(emitter, bounds)).collect();
        Self { tables, room: Room::new(limits), serves }
    }
}

impl Guide for Emitters {
    #[inline]
    fn may_know(&self, kind: RayKind) -> bool {
        !self.tables.is_empty() && (self.serves)(kind)
    }

    fn find(&self, forest: &Forest, family: &dyn Family, ask: &Ask<'_>) -> Option<Found<'_>> {
        // Lights are numbered: mostly the first guess is right.
        let first = match ask.ray.kind() {
            RayKind::Shadow { light } if usize::from(light) < self.tables.len() => light.into(),
            _ => 0,
        };
        let (before, from) = self.tables.split_at(first);
        let (table, seen) = from
            .iter()
            .chain(before)
            .find_map(|table| Some((table, table.see(ask.ray, ask.limit)?)))?;
        let beam = |cell: Cell| table.beam(seen.face, cell);
        let (room, slack) = (&self.room, table.slack);
        let maker = Maker { forest, family, room, beam: &beam, key: (Key::Distance, 4.0 * slack) };
        let list = table.faces[seen.face].list(seen.address, &maker)?;
        let nearest = !ask.all && (ask.any || seen.out.is_some());
        if !list.serves(seen.range, nearest, family, &ask.ray.source()) {
            return None;
        }
        let (from, scale) = match seen.out {
            Some(from) if !ask.any => (from + 4.0 * slack, 1.0 / seen.scale),
            _ => (0.0, 0.0),
        };
        Some(Found { list, to: seen.range[1] + 4.0 * slack, from, scale })
    }

    fn bytes(&self) -> u64 {
        size_of_val(&*self.tables) as u64 + self.room.taken()
    }
}

impl Place {
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
    fn new(emitter: &Emitter, bounds: Aabb) -> Self {
        let (place, reach) = match *emitter {
            Emitter::Point(at) => {
                let at = at.into();
                let through = Aabb { min: at, max: at };
                (Place::Through(through), through.reach().max(bounds.reach()))
            }
            Emitter::Box { min, max } => {
                let through = Aabb { min: min.into(), max: max.into() };
                (Place::Through(through), through.reach().max(bounds.reach()))
            }
            Emitter::Direction(toward) => (Place::along(toward, bounds), bounds.reach()),
        };
        let slack = 4.0 * Clip::SLACK * reach;
        Self { place, slack, reach: 2.0 * reach, faces: Default::default() }
    }

    /// A ray as seen from the emitter, if it passes it at one of its ends.
    #[inline]
    fn see(&self, ray: &Ray, limit: f32) -> Option<Seen> {
        if ray.origin().abs().max_element() > self.reach {
            return None;
        }
        match &self.place {
            Place::Through(through) => {
                [true, false].into_iter().find_map(|out| self.see_through(ray, limit, through, out))
            }
            Place::Along { axis, backward, slopes, plane, shadow } => {
                self.see_along(ray, limit, (*axis, *backward, *slopes), (*plane, shadow))
            }
        }
    }

    /// A ray that goes out if it begins behind the emitter, or comes in if it ends there.
    #[inline]
    fn see_through(&self, ray: &Ray, limit: f32, through: &Aabb, out: bool) -> Option<Seen> {
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
        let outward = if out { 0.5 / scale } else { -0.5 / scale };
        let [u, v] = asides.map(|aside| dir[aside] * outward + 0.5);
        let face = 2 * axis + usize::from(!backward);
        let out = out.then_some(-at * scale);
        passes.then(|| Seen { face, address: Address::new(u, v), range, out, scale })
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
        Some(Seen { face: 0, address: Address::new(x, y), range, out: None, scale })
    }

    /// The rays of a cell.
    fn beam(&self, face: usize, cell: Cell) -> Beam {
        let farthest = f32::INFINITY;
        match &self.place {
            Place::Through(through) => {
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
                let [u, v] = [0, 1].map(|side| cell.range(side).map(|x| 2.0 * x - 1.0));
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

/// How far the slopes of rays along one direction may differ.
const PARALLEL: f32 = 1e-6;
