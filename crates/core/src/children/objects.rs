//! Objects as children.

use glam::Vec3A;

use super::Children;
use crate::aabb::Aabb;
use crate::beam::{Beam, Facing};
use crate::cost::{Cost, CostModel};
use crate::hit::Hit;
use crate::object::Object;
use crate::ray::{Ray, Source};
use crate::scratch::Scratch;
use crate::surface::Surface;

impl<O: Object> Children for Vec<O> {
    type Probe = ();
    type Probes = ();

    fn count(&self) -> u32 {
        u32::try_from(self.len()).expect("at most u32::MAX children")
    }

    fn kind(&self, child: u32) -> &'static str {
        self[child as usize].kind()
    }

    fn bounds(&self, child: u32) -> Aabb {
        self[child as usize].bounds()
    }

    fn bounds_during(&self, child: u32, time: [f32; 2]) -> Aabb {
        self[child as usize].bounds_during(time)
    }

    fn moves_evenly(&self, child: u32, time: [f32; 2]) -> bool {
        self[child as usize].moves_evenly(time)
    }

    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb {
        self[child as usize].clipped(cell)
    }

    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2] {
        self[child as usize].along(direction)
    }

    fn touches(&self, child: u32, cell: &Aabb) -> bool {
        self[child as usize].touches(cell)
    }

    fn meets(&self, child: u32, beam: &Beam) -> Option<[f32; 2]> {
        self[child as usize].meets(beam)
    }

    fn blocks(&self, child: u32, beam: &Beam) -> Option<f32> {
        self[child as usize].blocks(beam)
    }

    fn facing(&self, child: u32, beam: &Beam) -> Facing {
        self[child as usize].facing(beam)
    }

    fn cost(&self, child: u32, model: &CostModel) -> Cost {
        self[child as usize].cost(model)
    }

    #[inline]
    fn closest_hit(&self, child: u32, ray: &Ray, hit: &mut Hit, scratch: &mut Scratch) -> bool {
        self[child as usize].closest_hit(ray, hit, scratch)
    }

    #[inline]
    fn any_hit(&self, child: u32, ray: &Ray, scratch: &mut Scratch) -> bool {
        self[child as usize].any_hit(ray, scratch)
    }

    fn all_hits(&self, child: u32, ray: &Ray, hits: &mut Vec<Hit>, scratch: &mut Scratch) {
        self[child as usize].all_hits(ray, hits, scratch);
    }

    fn closest_hits(&self, child: u32, rays: &[Ray], hits: &mut [Hit], scratch: &mut Scratch) {
        self[child as usize].closest_hits(rays, hits, scratch);
    }

    fn any_hits(&self, child: u32, rays: &[Ray], blocked: &mut [bool], scratch: &mut Scratch) {
        self[child as usize].any_hits(rays, blocked, scratch);
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Option<Surface> {
        self.iter().find_map(|object| object.surface(ray, hit))
    }

    fn child_of(&self, source: &Source) -> Option<u32> {
        self.iter().position(|object| object.holds(source)).map(|child| child as u32)
    }

    fn holds(&self, child: u32, source: &Source) -> bool {
        self[child as usize].holds(source)
    }

    fn paths(&self) -> u32 {
        self.iter().map(Object::paths).max().unwrap_or(1)
    }

    #[inline(always)]
    fn probe(&self, _ray: &Ray) {}

    fn visit(&self, visit: &mut dyn FnMut(&dyn Object)) {
        for object in self {
            visit(object);
        }
    }
}
