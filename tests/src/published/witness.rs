//! All rays of a picture.

use std::fmt;
use std::sync::{Mutex, PoisonError};

use nestray_core::aabb::Aabb;
use nestray_core::cost::{Cost, CostModel};
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::Ray;
use nestray_core::scratch::Scratch;
use nestray_core::surface::Surface;
use nestray_render::options::Options;
use nestray_render::render::render;
use nestray_render::watch::Unwatched;
use nestray_scene::scene::Scene;

/// The rays of a picture by the standard procedure, about `eye` of them from the eye; in no order.
///
/// # Panics
/// If the scene cannot be rendered.
#[must_use]
pub fn rays(scene: &Scene, world: DynObject, eye: usize) -> Vec<Ray> {
    // Rays go through the corners of pixels.
    let side = ((eye as f64).sqrt() as u32).saturating_sub(1).max(1);
    let witness = Witness { world, seen: Mutex::default() };
    let options =
        Options { resolution: [side; 2], threads: 2, layers: false, ..Options::standard_test() };
    let rendered = render(scene, &witness, &options, &Unwatched).expect("sound options");
    let seen = witness.seen.into_inner().unwrap_or_else(PoisonError::into_inner);
    assert_eq!(rendered.rays.total().cast, seen.len() as u64, "every ray was seen once");
    seen
}

/// Answers as the world does, and writes down who asked.
struct Witness {
    world: DynObject,
    seen: Mutex<Vec<Ray>>,
}

impl fmt::Debug for Witness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Witness").finish_non_exhaustive()
    }
}

impl Witness {
    fn see(&self, rays: &[Ray]) {
        self.seen.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(rays);
    }
}

impl Object for Witness {
    fn kind(&self) -> &'static str {
        self.world.kind()
    }

    fn bounds(&self) -> Aabb {
        self.world.bounds()
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        self.see(&[*ray]);
        self.world.closest_hit(ray, hit, scratch)
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.see(&[*ray]);
        self.world.any_hit(ray, scratch)
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        self.see(&[*ray]);
        self.world.all_hits(ray, hits, scratch);
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        self.see(rays);
        self.world.closest_hits(rays, hits, scratch);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        self.see(rays);
        self.world.any_hits(rays, blocked, scratch);
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.world.surface(ray, hit)
    }

    fn cost(&self, model: &CostModel) -> Cost {
        self.world.cost(model)
    }
}
