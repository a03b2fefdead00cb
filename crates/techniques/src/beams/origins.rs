//! Rays that leave an object, told apart by which one it is and where they go [Ohta 87].

use nestray_core::aabb::{Aabb, Clip};
use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind, Source};
use nestray_core::slot::Slot;

use super::cells::{Address, Cell, Cells, Limits, Maker, Room};
use super::cut::Forest;
use super::list::Key;
use super::{Ask, Found, Guide};

/// The lists of all leaves that rays start from.
#[derive(Debug)]
pub(crate) struct Origins {
    /// For each leaf, once a ray started there.
    tables: Box<[Slot<Box<Table>>]>,
    slack: f32,
    room: Room,
}

/// The lists of the rays that start from one leaf.
#[derive(Debug)]
struct Table {
    /// They start in here.
    bounds: Aabb,
    /// Down x, up x, down y, …
    faces: [Cells; 6],
}

impl Origins {
    /// Of a tree with so many leaves, whose boxes are within `bounds`.
    pub(crate) fn new(leaves: usize, bounds: Aabb, limits: Limits) -> Self {
        let tables = (0..leaves).map(|_| Slot::new()).collect();
        Self { tables, slack: 8.0 * Clip::SLACK * bounds.reach(), room: Room::new(limits) }
    }

    /// The table of the leaf that a ray starts from, if it does.
    fn table(&self, forest: &Forest, family: &dyn Family, ray: &Ray) -> Option<&Table> {
        let source = ray.source();
        if source == Source::NONE {
            return None;
        }
        let start = ray.at(ray.t_min());
        let reach = Aabb { min: start - self.slack, max: start + self.slack };
        let (leaf, bounds) = forest.leaf_around(&reach, &|child| family.holds(child, &source))?;
        let slot = &self.tables[leaf];
        let table = match slot.get() {
            Some(table) => table,
            None if self.room.is_left() => slot.get_or_make(|| {
                self.room.take(size_of::<Table>());
                Box::new(Table { bounds, faces: Default::default() })
            })?,
            None => return None,
        };
        let room = 2.0 * self.slack;
        let around = Aabb { min: table.bounds.min - room, max: table.bounds.max + room };
        around.contains(&Aabb { min: start, max: start }).then_some(&**table)
    }
}

impl Guide for Origins {
    fn may_know(&self, kind: RayKind) -> bool {
        kind != RayKind::Camera
    }

    fn find(&self, forest: &Forest, family: &dyn Family, ask: &Ask<'_>) -> Option<Found<'_>> {
        let table = self.table(forest, family, ask.ray)?;
        let dir = ask.ray.dir();
        let size = dir.abs();
        let axis = size.max_position();
        let backward = dir[axis] < 0.0;
        let inverse = 1.0 / size[axis];
        let [u, v] = [1, 2].map(|next| dir[(axis + next) % 3] * inverse);
        let beam = |cell: Cell| {
            let room = 4.0 * self.slack;
            let origin = Aabb { min: table.bounds.min - room, max: table.bounds.max + room };
            let [u, v] = [0, 1].map(|side| cell.range(side).map(|x| 2.0 * x - 1.0));
            Beam { origin, axis, backward, u, v, farthest: f32::INFINITY }
        };
        let key = (Key::Coordinate { axis, backward }, self.slack);
        let maker = Maker { forest, family, room: &self.room, beam: &beam, key };
        let address = Address::new(u * 0.5 + 0.5, v * 0.5 + 0.5);
        let list = table.faces[2 * axis + usize::from(!backward)].list(address, &maker)?;
        let range = [0.0, (ask.limit - ask.ray.t_min()) * size[axis]];
        if !list.serves(range, !ask.all, family, &ask.ray.source()) {
            return None;
        }
        let origin = ask.ray.origin()[axis] * if backward { -1.0 } else { 1.0 };
        let to = origin + ask.limit * size[axis] + 2.0 * self.slack;
        let scale = if ask.any { 0.0 } else { inverse };
        Some(Found { list, to, from: origin + 2.0 * self.slack, scale })
    }

    fn bytes(&self) -> u64 {
        size_of_val(&*self.tables) as u64 + self.room.taken()
    }
}
