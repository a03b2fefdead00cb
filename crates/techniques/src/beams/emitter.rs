//! Points that many rays pass, and directions that many take: lights and eyes.

mod table;

use nestray_core::aabb::Aabb;
use nestray_core::aim::Emitter;
use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};

use super::cells::Cells;
use super::cut::Forest;
use super::guide::{Ask, Guide, Search};
use super::list::Key;
use super::path::Cell;

use self::table::Table;

/// The lists of some emitters.
#[derive(Debug)]
pub(crate) struct Emitters {
    tables: Vec<Table>,
    /// Which rays come near them.
    serves: fn(RayKind) -> bool,
}

impl Emitters {
    /// Tables for `emitters`, for the kinds of rays that `serves` says.
    pub(crate) fn new(emitters: &[Emitter], bounds: Aabb, serves: fn(RayKind) -> bool) -> Self {
        let tables = emitters.iter().map(|emitter| Table::new(emitter, bounds)).collect();
        Self { tables, serves }
    }

    /// How many roots there are.
    pub(crate) fn roots(&self) -> usize {
        6 * self.tables.len()
    }
}

impl Guide for Emitters {
    #[inline]
    fn may_know(&self, kind: RayKind) -> bool {
        !self.tables.is_empty() && (self.serves)(kind)
    }

    fn search(
        &self,
        _forest: &Forest,
        _family: &dyn Family,
        _cells: &Cells,
        ask: &Ask<'_>,
    ) -> Option<Search> {
        // Lights are numbered: mostly the first guess is right.
        let first = match ask.ray.kind() {
            RayKind::Shadow { light } if usize::from(light) < self.tables.len() => light.into(),
            _ => 0,
        };
        let count = self.tables.len();
        let (mut number, mut tried) = (first, 0);
        let seen = loop {
            if let Some(seen) = self.tables[number].see(ask.ray, ask.limit) {
                break seen;
            }
            number = if number + 1 < count { number + 1 } else { 0 };
            tried += 1;
            if tried == count {
                return None;
            }
        };
        let slack = self.tables[number].slack;
        let (from, scale) = match seen.out {
            Some(from) if !ask.any => (from + 4.0 * slack, 1.0 / seen.scale),
            _ => (0.0, 0.0),
        };
        Some(Search {
            path: seen.path,
            root: (6 * number + seen.face) as u32,
            range: seen.range,
            nearest: !ask.all && (ask.any || seen.out.is_some()),
            to: seen.range[1] + 4.0 * slack,
            from,
            scale,
            ..Search::default()
        })
    }

    fn beam(
        &self,
        _of: (&Forest, &dyn Family),
        _ray: &Ray,
        root: u32,
        cell: Cell,
    ) -> (Beam, Key, f32) {
        let table = &self.tables[root as usize / 6];
        (table.beam(root as usize % 6, cell), Key::Distance, 4.0 * table.slack)
    }

    fn bytes(&self) -> u64 {
        size_of_val(&*self.tables) as u64
    }
}
