//! Ray tracing libraries in Rust behind the C interface of [`nestray_peers`], as a shared library:
//! so they are compiled for the very machine, and weigh on nobody who does not compare.

mod bvh_crate;
mod kernel;
mod obvhs_crate;
mod parry;
#[cfg(test)]
mod tests;

use nestray_peers::rays::{HitRecord, RayRecord};
use nestray_peers::world::Mesh;

/// A library, set in some way.
struct Entry {
    /// The first word is what it is asked for by. Both end with a zero.
    name: &'static str,
    version: &'static str,
    new: fn(Mesh) -> Box<dyn Peer>,
}

/// All of them.
static PEERS: &[Entry] = &[
    Entry { name: "obvhs CwBvh slow\0", version: "0.4\0", new: obvhs_crate::eight },
    Entry { name: "obvhs Bvh2 slow\0", version: "0.4\0", new: obvhs_crate::two },
    Entry { name: "parry3d TriMesh\0", version: "0.31\0", new: parry::new },
    Entry { name: "bvh nearest-first\0", version: "0.13\0", new: bvh_crate::new },
];

/// A scene in a library: first without, then with order.
trait Peer {
    fn build(&mut self);
    fn bytes(&self) -> u64;
    fn closest(&self, rays: &[RayRecord], hits: &mut [HitRecord]);
    fn any(&self, rays: &[RayRecord], blocked: &mut [bool]);
}

/// Triangles in no order yet, then the library's structure.
enum Scene<B: Built> {
    Given(B::Given),
    Built(B),
}

/// A library's structure, which takes one ray at a time.
trait Built: Sized {
    /// The triangles as it wants them.
    type Given: Default;
    fn build(given: Self::Given) -> Self;
    fn bytes(&self) -> u64;
    fn closest(&self, ray: &RayRecord) -> HitRecord;
    fn any(&self, ray: &RayRecord) -> bool;
}

impl<B: Built> Scene<B> {
    fn built(&self) -> &B {
        match self {
            Self::Built(built) => built,
            Self::Given(_) => panic!("it is built first"),
        }
    }
}

impl<B: Built> Peer for Scene<B> {
    fn build(&mut self) {
        if let Self::Given(given) = self {
            *self = Self::Built(B::build(std::mem::take(given)));
        }
    }

    fn bytes(&self) -> u64 {
        self.built().bytes()
    }

    fn closest(&self, rays: &[RayRecord], hits: &mut [HitRecord]) {
        let built = self.built();
        rays.iter().zip(hits).for_each(|(ray, hit)| *hit = built.closest(ray));
    }

    fn any(&self, rays: &[RayRecord], blocked: &mut [bool]) {
        let built = self.built();
        rays.iter().zip(blocked).for_each(|(ray, blocked)| *blocked = built.any(ray));
    }
}
