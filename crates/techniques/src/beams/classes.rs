//! All rays, told apart by where they start and where they go: five numbers, and the axis along
//! which they run fastest [Arvo 87].

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::slot::Slot;

use super::cells::{Limits, Room};
use super::cut::{Forest, Name};
use super::list::{Key, List};
use super::{Ask, Found, Guide};

/// The lists of all rays.
#[derive(Debug)]
pub(crate) struct Classes {
    /// Rays start in here, or come in before they meet anything.
    bounds: Aabb,
    /// How far a point or a place on the main axis may be off.
    slack: f32,
    /// Rays from farther out go through the tree.
    reach: f32,
    /// Down x, up x, down y, …
    roots: [Slot<Class>; 6],
    room: Room,
}

/// What a class of rays knows.
#[derive(Debug)]
enum Class {
    List(List),
    /// What its beam meets, and its two halves.
    Halves(Box<Halves>),
}

#[derive(Debug)]
struct Halves {
    cut: Box<[Name]>,
    /// Cuts on the way here since lists last became much shorter.
    idle: u32,
    halves: [Slot<Class>; 2],
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

/// Most parts of a cut that halves begin with.
const BROAD: usize = 64;
/// Most cuts in a row that do not pay: twice along each number.
const IDLE: u32 = 10;

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

    /// The half that a ray is in, and which of the two it is.
    fn half(mut self, side: Side, start: Vec3A, slopes: [f32; 2]) -> (Self, usize) {
        let ([low, high], at) = match side {
            Side::Origin(axis) => ([self.origin.min[axis], self.origin.max[axis]], start[axis]),
            Side::Slope(side) => (self.slopes[side], slopes[side]),
        };
        let middle = 0.5 * (low + high);
        let upper = at >= middle;
        let range = if upper { [middle, high] } else { [low, middle] };
        match side {
            Side::Origin(axis) => {
                (self.origin.min[axis], self.origin.max[axis]) = (range[0], range[1]);
            }
            Side::Slope(side) => self.slopes[side] = range,
        }
        (self, usize::from(upper))
    }
}

impl Classes {
    /// Classes of the rays in `bounds`.
    pub(crate) fn new(bounds: Aabb, limits: Limits) -> Self {
        let slack = 8.0 * Clip::SLACK * bounds.reach();
        let reach = 4.0 * bounds.reach();
        Self { bounds, slack, reach, roots: Default::default(), room: Room::new(limits) }
    }

    /// All rays of a class, with room for rounding.
    fn beam(&self, cube: &Hypercube, axis: usize, backward: bool) -> Beam {
        let room = Vec3A::splat(2.0 * self.slack);
        let origin = Aabb { min: cube.origin.min - room, max: cube.origin.max + room };
        let [u, v] = cube.slopes.map(|[low, high]| [low - SLOPE, high + SLOPE]);
        Beam { origin, axis, backward, u, v, farthest: f32::INFINITY }
    }

    /// What there is to know of a class, all of whose rays meet nothing but what is in `above`.
    fn known(
        &self,
        (forest, family): (&Forest, &dyn Family),
        (cube, depth): (&Hypercube, u32),
        above: Option<&Halves>,
        (axis, backward): (usize, bool),
    ) -> Class {
        let limits = self.room.limits();
        let beam = self.beam(cube, axis, backward);
        let from = above.map(|above| &*above.cut);
        let mut cut = forest.cut(&beam, from, BROAD);
        if cut.whole.is_empty() {
            forest.keep_met(family, &beam, &mut cut.leaves);
        }
        let few = cut.whole.is_empty() && cut.count() <= limits.most.min(List::ROOM);
        let idle = above.map_or(0, |above| {
            let much = 4 * cut.count() <= 3 * above.cut.len() && cut.whole.is_empty();
            if much || !cut.whole.is_empty() { 0 } else { above.idle + 1 }
        });
        if !few && depth < limits.depth && idle < IDLE {
            let halves = [const { Slot::new() }; 2];
            let parts = Box::new(Halves { cut: cut.names(), idle, halves });
            self.room.take(size_of_val(&*parts) + size_of_val::<[Name]>(&parts.cut));
            return Class::Halves(parts);
        }
        if cut.count() > List::ROOM {
            cut = forest.cut(&beam, None, List::ROOM);
        }
        let key = (Key::Coordinate { axis, backward }, self.slack);
        let list = List::new(forest, family, &beam, key, cut.into_parts());
        self.room.take(list.bytes());
        Class::List(list)
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

    fn forget(&mut self) {
        self.roots = Default::default();
        self.room = Room::new(*self.room.limits());
    }

    fn find(&self, forest: &Forest, family: &dyn Family, ask: &Ask<'_>) -> Option<Found<'_>> {
        let (start, first) = self.start(ask.ray, ask.limit)?;
        let dir = ask.ray.dir();
        let size = dir.abs();
        let axis = size.max_position();
        let backward = dir[axis] < 0.0;
        let inverse = 1.0 / size[axis];
        let slopes = [1, 2].map(|next| dir[(axis + next) % 3] * inverse);
        let distance = 0.25 * self.bounds.size().length();
        let mut cube = Hypercube { origin: self.bounds, slopes: [[-1.0, 1.0]; 2] };
        let mut slot = &self.roots[2 * axis + usize::from(!backward)];
        let (mut above, mut depth) = (None, 0);
        let list = loop {
            let known = match slot.get() {
                Some(known) => known,
                None if self.room.is_left() => slot.get_or_make(|| {
                    self.known((forest, family), (&cube, depth), above, (axis, backward))
                })?,
                None => return None,
            };
            match known {
                Class::List(list) => break list,
                Class::Halves(halves) => {
                    let (half, which) = cube.half(cube.longest(distance), start, slopes);
                    (cube, depth, above) = (half, depth + 1, Some(&**halves));
                    slot = &halves.halves[which];
                }
            }
        };
        let range = [0.0, (ask.limit - first) * size[axis]];
        if !list.serves(range, !ask.all, family, &ask.ray.source()) {
            return None;
        }
        let origin = ask.ray.origin()[axis] * if backward { -1.0 } else { 1.0 };
        let to = origin + ask.limit * size[axis] + 2.0 * self.slack;
        let scale = if ask.any { 0.0 } else { inverse };
        Some(Found { list, to, from: origin + 2.0 * self.slack, scale })
    }

    fn bytes(&self) -> u64 {
        size_of::<Self>() as u64 + self.room.taken()
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
