//! All rays, told apart by where they start and where they go: five numbers, and the axis along
//! which they run fastest [Arvo 87].

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};

use super::cells::Cells;
use super::cut::Forest;
use super::guide::{Ask, Guide, Heading, Search};
use super::list::Key;
use super::path::{Cell, Path};

/// All rays; six roots: down x, up x, down y, …
#[derive(Debug)]
pub(crate) struct Classes {
    /// Rays start in here, or come in before they meet anything.
    bounds: Aabb,
    /// How far a point or a place on the main axis may be off.
    slack: f32,
    /// Rays from farther out go through the tree.
    reach: f32,
}

/// The rays of a class: start in a box, slopes in a rectangle.
#[derive(Clone, Copy, Debug)]
struct Hypercube {
    origin: Aabb,
    slopes: [[f32; 2]; 2],
}

/// Where a ray is cut off: a point along one of five numbers.
#[derive(Clone, Copy, Debug)]
enum Side {
    Origin(usize),
    Slope(usize),
}

impl Hypercube {
    /// The side to cut: that along which its rays are farthest apart at a distance.
    fn longest(&self, distance: f32) -> Side {
        let size = self.origin.size();
        let origins = [0, 1, 2].map(|axis| (size[axis], Side::Origin(axis)));
        let slopes = [0, 1].map(|side| {
            let [low, high] = self.slopes[side];
            ((high - low) * distance, Side::Slope(side))
        });
        let all = origins.into_iter().chain(slopes);
        all.reduce(|a, b| if b.0 > a.0 { b } else { a }).map_or(Side::Origin(0), |(_, side)| side)
    }

    /// The range along one side.
    fn range(&self, side: Side) -> [f32; 2] {
        match side {
            Side::Origin(axis) => [self.origin.min[axis], self.origin.max[axis]],
            Side::Slope(side) => self.slopes[side],
        }
    }

    /// The lower half, or the upper.
    fn half(mut self, side: Side, upper: bool) -> Self {
        let [low, high] = self.range(side);
        let middle = middle([low, high]);
        let [low, high] = if upper { [middle, high] } else { [low, middle] };
        match side {
            Side::Origin(axis) => (self.origin.min[axis], self.origin.max[axis]) = (low, high),
            Side::Slope(side) => self.slopes[side] = [low, high],
        }
        self
    }
}

fn middle([low, high]: [f32; 2]) -> f32 {
    0.5 * (low + high)
}

impl Classes {
    /// How many roots there are.
    pub(crate) const ROOTS: usize = 6;

    /// Classes of the rays in `bounds`.
    pub(crate) fn new(bounds: Aabb) -> Self {
        let slack = 8.0 * Clip::SLACK * bounds.reach();
        Self { bounds, slack, reach: 4.0 * bounds.reach() }
    }

    /// All rays of a root.
    fn all(&self) -> Hypercube {
        Hypercube { origin: self.bounds, slopes: [[-1.0, 1.0]; 2] }
    }

    /// How far from where they start rays should be close together.
    fn distance(&self) -> f32 {
        0.25 * self.bounds.size().length()
    }
}

/// How far rounding may move a slope.
const SLOPE: f32 = 4.0 * f32::EPSILON;

impl Guide for Classes {
    fn may_know(&self, _kind: RayKind) -> bool {
        true
    }

    fn knows_all(&self) -> bool {
        true
    }

    fn search(
        &self,
        _forest: &Forest,
        _family: &dyn Family,
        cells: &Cells,
        ask: &Ask<'_>,
    ) -> Option<Search> {
        let (start, first) = self.start(ask.ray, ask.limit)?;
        let heading = Heading::of(ask.ray);
        let (mut cube, mut path) = (self.all(), Path::default());
        for bit in 0..cells.deepest() {
            let side = cube.longest(self.distance());
            let at = match side {
                Side::Origin(axis) => start[axis],
                Side::Slope(side) => heading.slopes[side],
            };
            let upper = at >= middle(cube.range(side));
            (cube, path) = (cube.half(side, upper), path.with(bit, usize::from(upper)));
        }
        Some(Search { path, root: heading.root(0), ..heading.search(ask, first, self.slack) })
    }

    /// All rays of a class, with room for rounding.
    fn beam(
        &self,
        _of: (&Forest, &dyn Family),
        _ray: &Ray,
        root: u32,
        cell: Cell,
    ) -> (Beam, Key, f32) {
        let mut cube = self.all();
        for half in cell.halves() {
            cube = cube.half(cube.longest(self.distance()), half == 1);
        }
        let (axis, backward) = (root as usize / 2, root.is_multiple_of(2));
        let room = Vec3A::splat(2.0 * self.slack);
        let origin = Aabb { min: cube.origin.min - room, max: cube.origin.max + room };
        let [u, v] = cube.slopes.map(|[low, high]| [low - SLOPE, high + SLOPE]);
        let beam = Beam { origin, axis, backward, u, v, farthest: f32::INFINITY };
        (beam, Key::Coordinate { axis, backward }, self.slack)
    }

    fn bytes(&self) -> u64 {
        size_of::<Self>() as u64
    }
}

impl Classes {
    /// Where in the bounds a ray begins, and at which parameter; none if it is not there, or too
    /// far out to tell.
    fn start(&self, ray: &Ray, limit: f32) -> Option<(Vec3A, f32)> {
        if ray.origin().abs().max_element() > self.reach {
            return None;
        }
        let (enter, _) = Clip::new(ray, self.bounds.reach()).cut(&self.bounds, limit)?;
        Some((ray.at(enter).clamp(self.bounds.min, self.bounds.max), enter))
    }
}
