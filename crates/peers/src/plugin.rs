//! Peers that `cargo xtask peers` puts into shared libraries of our own, compiled for the very
//! machine: tinybvh, and those in Rust.

mod kernel;

use std::rc::Rc;
use std::time::Duration;

use self::kernel::{Plugin, Scene};
use crate::clock::timed;
use crate::find;
use crate::peer::{Missing, Peer, Way};
use crate::rays::{HitRecord, Kind, RayRecord};
use crate::world::World;

/// A scene in one of them.
struct Plugged {
    name: String,
    version: String,
    scene: Scene,
    build_time: Duration,
}

/// All peers of a library whose names begin with `name`.
pub(crate) fn open(name: &str, world: &World) -> Vec<Result<Box<dyn Peer>, Missing>> {
    let missing = |reason: String| Missing { peer: name.into(), reason };
    match with_scene(name, world) {
        Ok(peers) => peers.into_iter().map(|peer| Ok(Box::new(peer) as _)).collect(),
        Err(reason) => vec![Err(missing(reason))],
    }
}

fn with_scene(name: &str, world: &World) -> Result<Vec<Plugged>, String> {
    let (mut found, mut reason) = (Vec::new(), None);
    let mesh = world.flat()?;
    for path in find::installed(&|file| file.contains("nestray_peers_")) {
        let plugin = match Plugin::open(&path) {
            Ok(plugin) => Rc::new(plugin),
            Err(error) => {
                reason = Some(error);
                continue;
            }
        };
        for which in 0..plugin.count() {
            let [own, version] = plugin.names(which);
            if own.split(' ').next() != Some(name) {
                continue;
            }
            let mut scene = Scene::new(&plugin, which, &mesh);
            let ((), build_time) = timed(|| scene.build());
            found.push(Plugged { name: own, version, scene, build_time });
        }
        if !found.is_empty() {
            return Ok(found);
        }
    }
    Err(reason.unwrap_or_else(|| "it is not installed; `cargo xtask peers` does that".into()))
}

impl Peer for Plugged {
    fn name(&self) -> String {
        self.name.clone()
    }

    fn version(&self) -> String {
        self.version.clone()
    }

    fn build_time(&self) -> Duration {
        self.build_time
    }

    fn bytes(&self) -> u64 {
        self.scene.bytes()
    }

    fn ways(&self) -> &[Way] {
        &[Way::Single]
    }

    fn closest(&self, _: Way, _: Kind, rays: &[RayRecord], hits: &mut [HitRecord]) {
        self.scene.closest(rays, hits);
    }

    fn any(&self, _: Way, _: Kind, rays: &[RayRecord], blocked: &mut [bool]) {
        self.scene.any(rays, blocked);
    }
}
