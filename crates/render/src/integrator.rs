//! Ways to follow light.

pub(crate) mod ambient_occlusion;
pub(crate) mod cost;
pub(crate) mod path;
pub(crate) mod whitted;

use nestray_core::hit::Hit;
use nestray_core::ray::Ray;
use nestray_scene::surfaces::Point;

use crate::eye::{Seen, Start};
use crate::look::Look;
use crate::tracer::Tracer;

/// Follows light back from the eye, many paths at a time; each thread has its own.
pub(crate) trait Integrate {
    /// What each of `starts` sees, in the same order. The answer for one does not depend on
    /// the others.
    fn trace(&mut self, tracer: &mut Tracer<'_>, starts: &[Start], seen: &mut Vec<Seen>);

    /// How many starts to take at a time if batches should hold `wave` rays: fewer where
    /// paths split.
    fn starts(&self, wave: usize) -> usize {
        wave
    }
}

/// Notes what the ray from the eye met first.
fn note(seen: &mut Seen, start: &Start, ray: &Ray, hit: &Hit, point: &Point, look: &Look) {
    let facing = if ray.dir().dot(look.normal) > 0.0 { -look.normal } else { look.normal };
    seen.albedo = look.base;
    seen.normal = facing;
    seen.depth = (point.surface.position - start.ray.origin()).length();
    seen.geometry = hit.geometry as f32;
}
