//! The rays that a plan is to be fast for.

use nestray_core::by_kind::Case;
use nestray_core::object::{DynObject, Object as _};
use nestray_core::packet::{self, Packet};
use nestray_core::ray::{Ray, RayKind};

/// Rays of one kind.
#[derive(Clone, Debug)]
pub struct RaySet {
    /// What they are called in reports.
    pub name: String,
    /// The rays, neighbours side by side as they will be cast.
    pub rays: Vec<Ray>,
    /// Whether it only matters that something is hit.
    pub any: bool,
    /// How many of these come with how many of the others; 0 leaves them out.
    pub weight: f64,
}

/// Rays of all kinds that count.
#[derive(Clone, Debug, Default)]
pub struct RayLog {
    /// One set for each kind.
    pub sets: Vec<RaySet>,
}

/// Neighbours that stay together.
const BLOCK: usize = packet::RAYS;

impl RaySet {
    /// For which rays a world may have a structure of its own, if these are all alike.
    #[must_use]
    pub fn case(&self) -> Option<Case> {
        match self.rays.first()?.kind() {
            RayKind::Camera => Some(Case::Camera),
            RayKind::Shadow { .. } => Some(Case::Shadow(None)),
            RayKind::Reflect => Some(Case::Reflect),
            RayKind::Refract => Some(Case::Refract),
            RayKind::Diffuse => Some(Case::Diffuse),
            RayKind::Custom(number) => Some(Case::Custom(Some(number))),
        }
    }

    /// Whether most of the rays go the same way as those next to them, so that they may be led
    /// together.
    #[must_use]
    pub fn are_neighbours(&self) -> bool {
        let blocks = self.rays.chunks(BLOCK);
        let together = self.rays.chunks(BLOCK).filter(|rays| Packet::may_be(rays)).count();
        2 * together > blocks.len()
    }

    /// Whether they are kept together in a world: whether they have neighbours, and these stay so.
    #[must_use]
    pub fn stay_together(&self, world: &DynObject) -> bool {
        self.are_neighbours() && !self.are_parted(world)
    }

    /// Whether a world shows neighbours one by one to what is inside.
    pub(super) fn are_parted(&self, world: &DynObject) -> bool {
        self.rays.first().is_some_and(|ray| world.parts(ray.kind()))
    }

    /// About `most` of the rays, in blocks of neighbours spread evenly.
    #[must_use]
    pub fn thinned(&self, most: usize) -> Self {
        let step = self.rays.len().div_ceil(most.max(1)).max(1);
        self.with(self.rays.chunks(BLOCK).step_by(step).flatten().copied().collect())
    }

    /// About `most` of the rays, spread evenly one by one: what neighbours do is much alike.
    #[must_use]
    pub fn scattered(&self, most: usize) -> Self {
        let step = self.rays.len().div_ceil(most.max(1)).max(1);
        self.with(self.rays.iter().step_by(step).copied().collect())
    }

    fn with(&self, rays: Vec<Ray>) -> Self {
        Self { name: self.name.clone(), rays, any: self.any, weight: self.weight }
    }
}

impl RayLog {
    /// Sets that count, with weights that add up to 1.
    #[must_use]
    pub fn new(sets: Vec<RaySet>) -> Self {
        let mut sets: Vec<RaySet> =
            sets.into_iter().filter(|set| set.weight > 0.0 && !set.rays.is_empty()).collect();
        let sum: f64 = sets.iter().map(|set| set.weight).sum();
        for set in &mut sets {
            set.weight /= sum;
        }
        Self { sets }
    }

    /// Every other block of neighbours, and the rest: to search with, and to time with.
    #[must_use]
    pub fn halves(&self) -> (Self, Self) {
        let half = |which: usize| Self {
            sets: self
                .sets
                .iter()
                .map(|set| {
                    let few = set.rays.len() < 2 * BLOCK;
                    let blocks = set.rays.chunks(BLOCK).enumerate();
                    let mine = blocks.filter(|(number, _)| few || number % 2 == which);
                    set.with(mine.flat_map(|(_, rays)| rays.iter().copied()).collect())
                })
                .collect(),
        };
        (half(0), half(1))
    }

    /// About `most` rays of each set, in blocks of neighbours spread evenly.
    #[must_use]
    pub fn thinned(&self, most: usize) -> Self {
        Self { sets: self.sets.iter().map(|set| set.thinned(most)).collect() }
    }
}
