//! Many rays at once, on all threads.
//!
//! The answers do not depend on how many threads there are. Run inside a
//! `rayon::ThreadPool` to use fewer than the machine has.

use nestray_core::hit::Hit;
use nestray_core::object::Object;
use nestray_core::ray::Ray;
use nestray_core::scratch::Scratch;
use rayon::prelude::*;

/// Rays that one thread takes at a time: enough to keep many in flight, few enough that no
/// thread is left with much to do at the end.
const RAYS: usize = 4096;

/// The nearest hit of each ray.
#[must_use]
pub fn closest_hits(world: &dyn Object, rays: &[Ray]) -> Vec<Hit> {
    let mut hits: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
    rays.par_chunks(RAYS)
        .zip(hits.par_chunks_mut(RAYS))
        .for_each_init(Scratch::new, |scratch, (rays, hits)| {
            world.closest_hits(rays, hits, scratch)
        });
    hits
}

/// Whether each ray hits anything.
#[must_use]
pub fn any_hits(world: &dyn Object, rays: &[Ray]) -> Vec<bool> {
    let mut blocked = vec![false; rays.len()];
    rays.par_chunks(RAYS)
        .zip(blocked.par_chunks_mut(RAYS))
        .for_each_init(Scratch::new, |scratch, (rays, blocked)| {
            world.any_hits(rays, blocked, scratch)
        });
    blocked
}

/// Every hit of each ray, nearest first.
#[must_use]
pub fn all_hits(world: &dyn Object, rays: &[Ray]) -> Vec<Vec<Hit>> {
    let mut hits = vec![Vec::new(); rays.len()];
    rays.par_chunks(RAYS).zip(hits.par_chunks_mut(RAYS)).for_each_init(
        Scratch::new,
        |scratch, (rays, hits)| {
            world.all_hits_each(rays, hits, scratch);
            hits.iter_mut().for_each(in_order);
        },
    );
    hits
}

/// Sorts hits by distance and then by what was hit, and removes those that came twice.
pub fn in_order(hits: &mut Vec<Hit>) {
    hits.sort_by(|a, b| a.t.total_cmp(&b.t).then_with(|| a.id().cmp(&b.id())));
    hits.dedup_by(|a, b| a.t == b.t && a.id() == b.id());
}

#[cfg(test)]
mod tests {
    use nestray_core::ray::RayKind;

    use crate::prelude::*;

    #[test]
    fn batches_answer_as_single_rays_do() {
        let mut scene = Scene::new();
        let balls = (0..500).map(|i| {
            let center = Vec3A::new((i % 20) as f32, (i / 20) as f32, (i % 7) as f32);
            Sphere { center, radius: 0.6 }.into()
        });
        scene.add(Geometry::shapes("balls", 0, balls.collect()));
        let world = build(&single("bvh", Default::default(), &scene).expect("known"), &scene);
        let world = world.expect("sound");
        let rays: Vec<Ray> = (0..9000)
            .map(|i| {
                let from = Vec3A::new((i % 90) as f32 * 0.25, (i / 90) as f32 * 0.25, -9.0);
                Ray::new(from, Vec3A::new(0.1, 0.05, 1.0), RayKind::Camera)
            })
            .collect();
        let (closest, any) = (closest_hits(&world, &rays), any_hits(&world, &rays));
        let all = all_hits(&world, &rays);
        let mut scratch = Scratch::new();
        for (i, ray) in rays.iter().enumerate() {
            let mut hit = Hit::none(ray.t_max());
            let found = world.closest_hit(ray, &mut hit, &mut scratch);
            assert_eq!((closest[i], any[i]), (hit, found));
            assert_eq!(all[i].first().map(|hit| hit.t), found.then_some(hit.t));
            assert!(all[i].windows(2).all(|pair| pair[0].t <= pair[1].t));
        }
        assert!(any.iter().any(|&hit| hit) && !any.iter().all(|&hit| hit));
    }
}
