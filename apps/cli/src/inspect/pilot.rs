//! A few rays of each kind, sent through the nest to see what it does for them.

use nestray::plan::describe::Sent;
use nestray::prelude::{DynObject, Hit, Object as _, RayKind, Scene, Scratch};

use crate::bench::rays;
use crate::errors::Failure;

/// Rays of each kind, about.
const RAYS: usize = 4096;
/// Lights that shadow rays go to, at most.
const LIGHTS: usize = 8;

/// Sends rays from the first camera, from what they hit, and from everywhere; always the same.
pub(crate) fn send(scene: &Scene, world: &DynObject) -> Result<Sent, Failure> {
    let mut scratch = Scratch::counting_by_site();
    let mut sent = Vec::<(String, RayKind, u64)>::new();
    for set in rays::sets(scene, world, RAYS, LIGHTS)? {
        for ray in &set.rays {
            if set.any {
                world.any_hit(ray, &mut scratch);
            } else {
                world.closest_hit(ray, &mut Hit::none(ray.t_max()), &mut scratch);
            }
            let kind = ray.kind();
            match sent.iter_mut().find(|other| other.1 == kind) {
                Some((_, _, count)) => *count += 1,
                None => sent.push((name(set.name, kind), kind, 1)),
            }
        }
    }
    sent.sort_by_key(|&(_, kind, _)| kind);
    Ok(Sent { rays: sent, counters: scratch.counters })
}

/// What rays of a kind in a set are called.
fn name(set: &str, kind: RayKind) -> String {
    match kind {
        RayKind::Shadow { light } => format!("{set} {light}"),
        _ => set.into(),
    }
}
