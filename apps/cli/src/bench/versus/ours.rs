//! Our own plans, asked as other libraries are.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use nestray::core::cost::CostModel;
use nestray::prelude::{DynObject, Hit, Object as _, Ray, RayKind, Scene, Scratch, build};
use nestray_peers::clock::timed;
use nestray_peers::peer::{Peer, Way};
use nestray_peers::rays::{HitRecord, Kind, RayRecord};

use crate::bench::sets;
use crate::errors::Failure;
use crate::{input, stats};

/// Rays in a batch: with their answers they fit the nearest caches.
const BATCH: usize = 1024;

/// A plan, and what was built from it.
pub(super) struct Ours {
    name: String,
    world: DynObject,
    build_time: Duration,
    build_time_on_all: Duration,
    /// What queries need: rays and answers in our own form are part of it.
    state: RefCell<State>,
}

struct State {
    scratch: Scratch,
    rays: Vec<Ray>,
    hits: Vec<Hit>,
}

impl Ours {
    /// Builds a plan on one thread; and, for comparison, on all.
    pub(super) fn new(name: &str, scene: &Scene) -> Result<Self, Failure> {
        let choice = input::choose(name)?;
        let plan = choice.plan(scene)?;
        let begun = Instant::now();
        drop(build(&plan, scene).map_err(|error| choice.failure(&error))?);
        let build_time_on_all = begun.elapsed();
        let (world, build_time) = input::pool(1)?.install(|| timed(|| build(&plan, scene)));
        let world = world.map_err(|error| choice.failure(&error))?;
        let state = State { scratch: Scratch::new(), rays: Vec::new(), hits: Vec::new() };
        Ok(Self { name: name.into(), world, build_time, build_time_on_all, state: state.into() })
    }

    /// By the clock on the wall.
    pub(super) fn build_on_all(&self) -> (String, Duration) {
        (self.name.clone(), self.build_time_on_all)
    }

    pub(super) fn world(&self) -> &DynObject {
        &self.world
    }
}

fn kind(of: Kind) -> RayKind {
    match of {
        Kind::Primary => RayKind::Camera,
        Kind::Shadow => RayKind::Shadow { light: 0 },
        Kind::Bounce => RayKind::Diffuse,
        Kind::Chord => RayKind::Custom(0),
    }
}

fn found(hit: &Hit) -> HitRecord {
    if hit.is_some() {
        HitRecord { t: hit.t, uv: [hit.u, hit.v], primitive: hit.primitive }
    } else {
        HitRecord::MISS
    }
}

impl Peer for Ours {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn version(&self) -> String {
        format!("{}, {}", env!("CARGO_PKG_VERSION"), stats::level())
    }

    fn build_time(&self) -> Duration {
        self.build_time
    }

    fn bytes(&self) -> u64 {
        self.world.cost(CostModel::usual()).bytes
    }

    fn ways(&self) -> &[Way] {
        &[Way::Batch, Way::Single]
    }

    fn closest(&self, way: Way, of: Kind, rays: &[RayRecord], hits: &mut [HitRecord]) {
        let (kind, mut state) = (kind(of), self.state.borrow_mut());
        let state = &mut *state;
        if way == Way::Single {
            for (record, found_) in rays.iter().zip(hits) {
                let ray = sets::ray(record, kind);
                let mut hit = Hit::none(ray.t_max());
                self.world.closest_hit(&ray, &mut hit, &mut state.scratch);
                *found_ = found(&hit);
            }
            return;
        }
        for (records, answers) in rays.chunks(BATCH).zip(hits.chunks_mut(BATCH)) {
            state.rays.clear();
            state.rays.extend(records.iter().map(|record| sets::ray(record, kind)));
            state.hits.clear();
            state.hits.extend(records.iter().map(|record| Hit::none(record.t_max)));
            self.world.closest_hits(&state.rays, &mut state.hits, &mut state.scratch);
            answers.iter_mut().zip(&state.hits).for_each(|(answer, hit)| *answer = found(hit));
        }
    }

    fn any(&self, way: Way, of: Kind, rays: &[RayRecord], blocked: &mut [bool]) {
        let (kind, mut state) = (kind(of), self.state.borrow_mut());
        let state = &mut *state;
        if way == Way::Single {
            for (record, blocked) in rays.iter().zip(blocked) {
                *blocked = self.world.any_hit(&sets::ray(record, kind), &mut state.scratch);
            }
            return;
        }
        for (records, blocked) in rays.chunks(BATCH).zip(blocked.chunks_mut(BATCH)) {
            state.rays.clear();
            state.rays.extend(records.iter().map(|record| sets::ray(record, kind)));
            blocked.fill(false);
            self.world.any_hits(&state.rays, blocked, &mut state.scratch);
        }
    }
}
