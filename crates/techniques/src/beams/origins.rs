//! Rays that leave an object, told apart by which one it is and where they go [Ohta 87].

use nestray_core::aabb::{Aabb, Clip};
use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind, Source};

use super::cells::Cells;
use super::cut::Forest;
use super::guide::{Ask, Guide, Heading, Search};
use super::list::Key;
use super::path::{Cell, Path};

/// All leaves that rays start from, each with six roots: down x, up x, down y, …
#[derive(Debug)]
pub(crate) struct Origins {
    slack: f32,
}

impl Origins {
    /// Of a tree whose boxes are within `bounds`.
    pub(crate) fn new(bounds: Aabb) -> Self {
        Self { slack: 8.0 * Clip::SLACK * bounds.reach() }
    }

    /// The leaf that a ray starts from, if it does: its number, and a box that it starts in.
    fn leaf(&self, forest: &Forest, family: &dyn Family, ray: &Ray) -> Option<(usize, Aabb)> {
        let source = ray.source();
        if source == Source::NONE {
            return None;
        }
        let start = ray.at(ray.t_min());
        let reach = Aabb { min: start - self.slack, max: start + self.slack };
        let (leaf, bounds) = forest.leaf_around(&reach, &|child| family.holds(child, &source))?;
        let room = 2.0 * self.slack;
        let around = Aabb { min: bounds.min - room, max: bounds.max + room };
        around.contains(&Aabb { min: start, max: start }).then_some((leaf, around))
    }
}

impl Guide for Origins {
    fn may_know(&self, kind: RayKind) -> bool {
        kind != RayKind::Camera
    }

    fn search(
        &self,
        forest: &Forest,
        family: &dyn Family,
        _cells: &Cells,
        ask: &Ask<'_>,
    ) -> Option<Search> {
        let (leaf, _) = self.leaf(forest, family, ask.ray)?;
        let heading = Heading::of(ask.ray);
        let [u, v] = heading.slopes;
        Some(Search {
            path: Path::in_square(u * 0.5 + 0.5, v * 0.5 + 0.5),
            root: heading.root(6 * leaf),
            ..heading.search(ask, ask.ray.t_min(), self.slack)
        })
    }

    fn beam(
        &self,
        (forest, family): (&Forest, &dyn Family),
        ray: &Ray,
        root: u32,
        cell: Cell,
    ) -> (Beam, Key, f32) {
        let (_, around) = self.leaf(forest, family, ray).expect("its cell has been looked up");
        let room = 2.0 * self.slack;
        let origin = Aabb { min: around.min - room, max: around.max + room };
        let (axis, backward) = (root as usize % 6 / 2, root.is_multiple_of(2));
        let [u, v] = [0, 1].map(|side| cell.range(side).map(|x| 2.0 * x - 1.0));
        let beam = Beam { origin, axis, backward, u, v, farthest: f32::INFINITY };
        (beam, Key::Coordinate { axis, backward }, self.slack)
    }

    fn bytes(&self) -> u64 {
        size_of::<Self>() as u64
    }
}
