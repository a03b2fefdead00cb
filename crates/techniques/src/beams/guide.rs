//! Who tells rays apart.

use std::fmt::Debug;

use nestray_core::beam::Beam;
use nestray_core::family::Family;
use nestray_core::ray::{Ray, RayKind};

use super::cells::Cells;
use super::cut::Forest;
use super::list::Key;
use super::path::{Cell, Path};

/// Who knows which cell a ray is in.
pub(crate) trait Guide: Debug + Send + Sync {
    /// Whether it is worth asking for the lists of rays of this kind.
    fn may_know(&self, kind: RayKind) -> bool;

    /// Whether it has lists for rays of every kind, from anywhere.
    fn knows_all(&self) -> bool {
        false
    }

    /// What to look for, for a ray; none if there is no list for it. `cells` says how far its
    /// path has to go.
    fn search(
        &self,
        forest: &Forest,
        family: &dyn Family,
        cells: &Cells,
        ask: &Ask<'_>,
    ) -> Option<Search>;

    /// The rays of a cell of a root, in which the ray asked for is; what their lists are sorted
    /// by, and how far places on the main axis may be off.
    fn beam(
        &self,
        of: (&Forest, &dyn Family),
        ray: &Ray,
        root: u32,
        cell: Cell,
    ) -> (Beam, Key, f32);

    /// Memory in use.
    fn bytes(&self) -> u64;
}

/// What is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ask<'a> {
    pub(crate) ray: &'a Ray,
    /// Nothing farther counts.
    pub(crate) limit: f32,
    /// [`Query::ANY`].
    pub(crate) any: bool,
    /// [`Query::ALL`].
    pub(crate) all: bool,
}

/// The cell that a ray looks for, and the part of its list that counts.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Search {
    pub(crate) path: Path,
    pub(crate) root: u32,
    /// How far along the path it is.
    pub(super) bits: u32,
    /// The part of the main axis that the ray goes over.
    pub(crate) range: [f32; 2],
    /// Whether the hit nearest to where the rays of the beam start will do.
    pub(crate) nearest: bool,
    /// What begins farther along the main axis, by the key of the list, does not count.
    pub(crate) to: f32,
    /// Where on the main axis the ray has parameter 0.
    pub(crate) from: f32,
    /// What the parameter grows by along the main axis; 0 if the order does not matter.
    pub(crate) scale: f32,
}

/// Where a ray goes: the axis along which it runs fastest, and its slopes along the other two.
#[derive(Clone, Copy, Debug)]
pub(super) struct Heading {
    pub(super) axis: usize,
    pub(super) backward: bool,
    pub(super) slopes: [f32; 2],
    /// How fast it runs along the axis.
    speed: f32,
}

impl Heading {
    #[inline]
    pub(super) fn of(ray: &Ray) -> Self {
        let dir = ray.dir();
        let size = dir.abs();
        let axis = size.max_position();
        let inverse = 1.0 / size[axis];
        let slopes = [1, 2].map(|next| dir[(axis + next) % 3] * inverse);
        Self { axis, backward: dir[axis] < 0.0, slopes, speed: size[axis] }
    }

    /// The root, of the six that begin with `first`: down x, up x, down y, …
    pub(super) fn root(&self, first: usize) -> u32 {
        (first + 2 * self.axis + usize::from(!self.backward)) as u32
    }

    /// What to look for in lists sorted by [`Key::Coordinate`], for a ray that begins at parameter
    /// `begin`, where places on the main axis may be off by `slack`.
    #[inline]
    pub(super) fn search(&self, ask: &Ask<'_>, begin: f32, slack: f32) -> Search {
        let origin = ask.ray.origin()[self.axis] * if self.backward { -1.0 } else { 1.0 };
        Search {
            range: [0.0, (ask.limit - begin) * self.speed],
            nearest: !ask.all,
            to: origin + ask.limit * self.speed + 2.0 * slack,
            from: origin + 2.0 * slack,
            scale: if ask.any { 0.0 } else { 1.0 / self.speed },
            ..Search::default()
        }
    }
}
