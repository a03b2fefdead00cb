//! Other ray tracing libraries behind one interface, so that rays can be shot at all of them in
//! turns. Knows nothing of nestray: triangles, rays and answers are plain numbers.

pub mod clock;
pub mod core;
pub mod embree;
mod find;
pub mod peer;
mod plugin;
pub mod rays;
pub mod world;

use std::time::Duration;

use peer::{Missing, Peer};
use world::World;

/// What libraries are asked for by.
pub const NAMES: &[&str] = &["embree", "tinybvh", "obvhs", "parry3d", "bvh"];

/// A library with triangles in it, once for each way in which it is set that is worth comparing.
#[must_use]
pub fn open(name: &str, world: &World) -> Vec<Result<Box<dyn Peer>, Missing>> {
    match name {
        "embree" => match embree::Embree::all(world) {
            Ok(all) => all.into_iter().map(|one| Ok(Box::new(one) as _)).collect(),
            Err(missing) => vec![Err(missing)],
        },
        _ => plugin::open(name, world),
    }
}

/// How long a library takes to build on all threads, by the clock on the wall, for each way in which
/// it is set; nothing of one that builds on one thread only.
#[must_use]
pub fn builds_on_all(name: &str, world: &World) -> Vec<(String, Duration)> {
    match name {
        "embree" => embree::Embree::builds_on_all(world),
        _ => Vec::new(),
    }
}
