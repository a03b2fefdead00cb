//! Embree 4, from its shared library.

mod flushed;
mod kernel;
mod library;
#[cfg(test)]
mod tests;

use std::rc::Rc;
use std::time::{Duration, Instant};

use crate::clock::timed;
use crate::peer::{Missing, Peer, Way};
use crate::rays::{HitRecord, Kind, RayRecord};
use crate::world::{Mesh, World};

use self::flushed::Flushed;
use self::kernel::{Arguments, Device, NOTHING, RayHit, Scene, Valid};

/// How much it works on its tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// Its default.
    Medium,
    /// With splits.
    High,
}

/// How it is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// How much it works on its tree.
    pub quality: Quality,
    /// Without leaks between neighbours.
    pub robust: bool,
}

impl Settings {
    /// Those that are compared with.
    pub const ALL: [Self; 3] = [
        Self { quality: Quality::High, robust: false },
        Self { quality: Quality::Medium, robust: false },
        Self { quality: Quality::High, robust: true },
    ];

    /// The word in tables.
    #[must_use]
    pub fn name(self) -> String {
        let quality = match self.quality {
            Quality::Medium => "MEDIUM",
            Quality::High => "HIGH",
        };
        format!("Embree {quality}{}", if self.robust { " ROBUST" } else { "" })
    }
}

/// A scene in Embree.
#[expect(missing_debug_implementations, reason = "there is nothing to show")]
pub struct Embree {
    settings: Settings,
    ways: Vec<Way>,
    version: [isize; 3],
    scene: Scene,
    /// Of this thread.
    build_time: Duration,
    /// By the clock on the wall.
    build_took: Duration,
    bytes: u64,
}

impl Embree {
    /// Puts triangles into Embree, set in each way that is compared with; it builds with one
    /// thread. One device holds them all.
    ///
    /// # Errors
    /// If the library is not found, or is none, or fails.
    pub fn all(world: &World) -> Result<Vec<Self>, Missing> {
        let build = || -> Result<Vec<Self>, String> {
            let device = Rc::new(library::open(1)?);
            Settings::ALL.iter().map(|&settings| Self::build(world, settings, &device)).collect()
        };
        build().map_err(|reason| Missing { peer: "Embree".into(), reason })
    }

    /// How long builds take on all threads, by the clock on the wall; none if it is not there.
    #[must_use]
    pub fn builds_on_all(world: &World) -> Vec<(String, Duration)> {
        let Ok(device) = library::open(0).map(Rc::new) else { return Vec::new() };
        let built = |settings: &Settings| Self::build(world, *settings, &device).ok();
        let all = Settings::ALL.iter().filter_map(built);
        all.map(|built| (built.name(), built.build_took)).collect()
    }

    fn build(world: &World, settings: Settings, device: &Rc<Device>) -> Result<Self, String> {
        let quality = match settings.quality {
            Quality::Medium => 1,
            Quality::High => 2,
        };
        let flags = if settings.robust { 4 } else { 0 };
        let new = || Scene::new(device, quality, flags);
        let (scene, inner) = (new(), world.meshes.iter().map(|_| new()).collect::<Vec<_>>());
        add(&scene, &world.fixed);
        inner.iter().zip(&world.meshes).for_each(|(scene, mesh)| add(scene, mesh));
        let (before, begun) = (device.bytes(), Instant::now());
        let ((), build_time) = timed(|| {
            inner.iter().for_each(Scene::commit);
            for place in &world.places {
                let columns = place.world_from_mesh.to_cols_array();
                scene.add_instance(&inner[place.mesh], &columns);
            }
            let _flushed = Flushed::new();
            scene.commit();
        });
        let build_took = begun.elapsed();
        match device.error() {
            0 => {}
            number => return Err(format!("its error number {number}")),
        }
        let bytes = (device.bytes() - before).max(0) as u64;
        let mut ways = vec![Way::Single];
        ways.extend(device.takes_16().then_some(Way::Packets));
        let version = device.version();
        Ok(Self { settings, ways, version, scene, build_time, build_took, bytes })
    }
}

fn add(scene: &Scene, mesh: &Mesh) {
    if !mesh.faces.is_empty() {
        scene.add_triangles(&mesh.positions, &mesh.faces);
    }
}

impl Peer for Embree {
    fn name(&self) -> String {
        self.settings.name()
    }

    fn version(&self) -> String {
        self.version.map(|number| number.to_string()).join(".")
    }

    fn build_time(&self) -> Duration {
        self.build_time
    }

    fn bytes(&self) -> u64 {
        self.bytes
    }

    fn ways(&self) -> &[Way] {
        &self.ways
    }

    fn closest(&self, way: Way, of: Kind, rays: &[RayRecord], hits: &mut [HitRecord]) {
        let mut with = Arguments::new(of.is_coherent());
        let _flushed = Flushed::new();
        if way == Way::Packets {
            for (rays, hits) in rays.chunks(16).zip(hits.chunks_mut(16)) {
                let (mut packet, valid) = packet(rays);
                self.scene.closest_16(&valid, &mut packet, &mut with);
                hits.iter_mut().enumerate().for_each(|(i, hit)| *hit = found(&packet, i));
            }
            return;
        }
        for (ray, hit) in rays.iter().zip(hits) {
            let mut one = RayHit::<1>::NEW;
            set(&mut one, 0, ray);
            self.scene.closest(&mut one, &mut with);
            *hit = found(&one, 0);
        }
    }

    fn any(&self, way: Way, of: Kind, rays: &[RayRecord], blocked: &mut [bool]) {
        let mut with = Arguments::new(of.is_coherent());
        let _flushed = Flushed::new();
        if way == Way::Packets {
            for (rays, blocked) in rays.chunks(16).zip(blocked.chunks_mut(16)) {
                let (mut packet, valid) = packet(rays);
                self.scene.any_16(&valid, &mut packet, &mut with);
                blocked.iter_mut().zip(packet.far).for_each(|(b, far)| *b = is_blocked(far));
            }
            return;
        }
        for (ray, blocked) in rays.iter().zip(blocked) {
            let mut one = RayHit::<1>::NEW;
            set(&mut one, 0, ray);
            self.scene.any(&mut one, &mut with);
            *blocked = is_blocked(one.far[0]);
        }
    }
}

#[inline(always)]
fn set<const N: usize>(to: &mut RayHit<N>, i: usize, ray: &RayRecord) {
    for axis in 0..3 {
        to.origin[axis][i] = ray.origin[axis];
        to.dir[axis][i] = ray.dir[axis];
    }
    to.near[i] = ray.t_min;
    to.far[i] = ray.t_max;
}

/// Up to 16 rays, and which of the 16 are there.
#[inline(always)]
fn packet(rays: &[RayRecord]) -> (RayHit<16>, Valid) {
    let (mut packet, mut valid) = (RayHit::<16>::NEW, Valid([0; 16]));
    for (i, ray) in rays.iter().enumerate() {
        set(&mut packet, i, ray);
        valid.0[i] = -1;
    }
    (packet, valid)
}

#[inline(always)]
fn found<const N: usize>(in_: &RayHit<N>, i: usize) -> HitRecord {
    if in_.geometry[i] == NOTHING {
        return HitRecord::MISS;
    }
    HitRecord { t: in_.far[i], uv: [in_.u[i], in_.v[i]], primitive: in_.primitive[i] }
}

/// Embree sets how far a blocked ray goes to −∞.
#[inline(always)]
fn is_blocked(far: f32) -> bool {
    far == f32::NEG_INFINITY
}
