//! Instances taken apart, so that the technique above sees what is in them [Benthin 17].

use std::sync::Arc;

use glam::{Affine3A, Vec3A};

use crate::aabb::Aabb;
use crate::cost::{Cost, CostModel};
use crate::hit::Hit;
use crate::instance::Instance;
use crate::object::{DynObject, Object};
use crate::ray::{Ray, Source};
use crate::scratch::Scratch;
use crate::surface::Surface;

/// How many times farther out than the nest reaches rays may start that see its instances taken
/// apart.
const NEAR: f32 = 4.0;

/// A part of an instance: it answers for what is in the part as the whole would. Its box is so
/// wide that no ray that starts [`NEAR`] passes by what it would hit, rounding or not.
struct Opened {
    part: Instance<DynObject>,
    bounds: Aabb,
}

/// The parts of an instance, each an object, for a nest that reaches out as far as `reach`; none
/// if it is better left whole. All answers together are those of the instance, for rays that
/// [`NearFar`] takes for near ones.
#[must_use]
pub fn open(
    whole: &Instance<DynObject>,
    parts: &[DynObject],
    reach: f32,
) -> Option<Vec<DynObject>> {
    /// More than the largest edge of a part may grow by.
    const MOST: f32 = 0.05;
    let room = rounding(whole.place()?, whole.inner().bounds().reach(), reach)?;
    let opened = parts.iter().filter(|part| !part.bounds().is_empty()).map(|part| {
        let placed = whole.part(Arc::clone(part));
        let tight = placed.tight_bounds();
        let bounds = Aabb { min: tight.min - room, max: tight.max + room };
        let fits = bounds.is_bounded() && room <= MOST * tight.size().max_element();
        fits.then(|| Arc::new(Opened { part: placed, bounds }) as DynObject)
    });
    opened.collect()
}

/// By how much a hit in an instance may seem off its box, for rays that start [`NEAR`].
///
/// Moving a ray rounds its origin, its direction, the matrix, and what is in the instance rounds
/// the hit: 30 half-ulps of all coordinates on the way, as large as both matrices make them; four
/// times that is allowed.
fn rounding([out, into]: [Affine3A; 2], inside: f32, reach: f32) -> Option<f32> {
    let norm = |m: Affine3A| {
        let rows = m.matrix3.transpose();
        let row = |r: Vec3A| r.abs().element_sum();
        row(rows.x_axis).max(row(rows.y_axis)).max(row(rows.z_axis))
    };
    let (out, into) = (norm(out), norm(into));
    let coordinates = (NEAR + 1.0) * reach + out * inside;
    let room = 128.0 * (f32::EPSILON / 2.0) * out * into * coordinates;
    room.is_finite().then_some(room)
}

impl Object for Opened {
    fn kind(&self) -> &'static str {
        "part of an instance"
    }

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        self.part.closest_hit(ray, hit, scratch)
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.part.any_hit(ray, scratch)
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        self.part.all_hits(ray, hits, scratch);
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        self.part.closest_hits(rays, hits, scratch);
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        self.part.any_hits(rays, blocked, scratch);
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.part.surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.part.holds(source)
    }

    fn paths(&self) -> u32 {
        self.part.paths()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        self.part.cost(model)
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        self.part.visit_children(visit);
    }
}

/// Two nests that hold the same: one for rays that start near, where instances may be taken apart,
/// and one for all others.
///
/// To move a ray into an instance rounds by as much as its origin is far away. A nest of whole
/// instances does not mind, since each sees for itself whether a ray passes; the parts of one do.
pub struct NearFar {
    near: DynObject,
    far: DynObject,
    limit: f32,
}

impl NearFar {
    /// Both must hold the same; `near` may hold parts from [`open`] with this `reach`.
    #[must_use]
    pub fn new(near: DynObject, far: DynObject, reach: f32) -> Self {
        Self { near, far, limit: NEAR * reach }
    }

    /// Whether a ray starts near.
    #[inline]
    fn is_near(&self, ray: &Ray) -> bool {
        // A NaN is not.
        ray.origin().abs().cmple(Vec3A::splat(self.limit)).all()
    }

    #[inline]
    fn of(&self, ray: &Ray) -> &DynObject {
        if self.is_near(ray) { &self.near } else { &self.far }
    }

    /// Who answers all of these rays; none if both do.
    fn of_all(&self, rays: &[Ray]) -> Option<&DynObject> {
        let near = rays.iter().filter(|ray| self.is_near(ray)).count();
        match near {
            0 => Some(&self.far),
            all if all == rays.len() => Some(&self.near),
            _ => None,
        }
    }
}

impl std::fmt::Debug for NearFar {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("NearFar").field("limit", &self.limit).finish_non_exhaustive()
    }
}

impl Object for NearFar {
    fn kind(&self) -> &'static str {
        "opened"
    }

    fn bounds(&self) -> Aabb {
        self.far.bounds()
    }

    fn bounds_during(&self, time: [f32; 2]) -> Aabb {
        self.far.bounds_during(time)
    }

    fn along(&self, direction: Vec3A) -> [f32; 2] {
        self.far.along(direction)
    }

    fn closest_hit(&self, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        self.of(ray).closest_hit(ray, hit, scratch)
    }

    fn any_hit(&self, ray: &Ray, scratch: &mut Scratch) -> bool {
        self.of(ray).any_hit(ray, scratch)
    }

    fn all_hits(&self, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        self.of(ray).all_hits(ray, hits, scratch);
    }

    fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        if let Some(of_all) = self.of_all(rays) {
            return of_all.closest_hits(rays, hits, scratch);
        }
        for (ray, hit) in rays.iter().zip(hits) {
            self.closest_hit(ray, hit, scratch);
        }
    }

    fn any_hits(&self, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        if let Some(of_all) = self.of_all(rays) {
            return of_all.any_hits(rays, blocked, scratch);
        }
        for (ray, blocked) in rays.iter().zip(blocked) {
            *blocked = *blocked || self.any_hit(ray, scratch);
        }
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.far.surface(ray, hit)
    }

    fn holds(&self, source: &Source) -> bool {
        self.far.holds(source)
    }

    fn paths(&self) -> u32 {
        self.far.paths()
    }

    fn cost(&self, model: &CostModel) -> Cost {
        self.near.cost(model).plus(0.0, self.far.cost(model).bytes)
    }

    fn visit_children(&self, visit: &mut dyn FnMut(&dyn Object)) {
        visit(&self.near);
    }
}
