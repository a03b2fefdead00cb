//! Objects as a technique sees them.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::family::Family;
use nestray_core::object::DynObject;
use nestray_core::object::Object;
use nestray_core::ray::Source;

/// Children of equal weight.
pub(crate) struct Objects(pub(crate) Vec<DynObject>);

impl Family for Objects {
    fn count(&self) -> u32 {
        self.0.len() as u32
    }
    fn bounds(&self, child: u32) -> Aabb {
        self.0[child as usize].bounds().padded()
    }
    fn weight(&self, _child: u32) -> f32 {
        40.0
    }
    fn together(&self) -> u32 {
        1
    }
    fn bounds_during(&self, child: u32, time: [f32; 2]) -> Aabb {
        self.0[child as usize].bounds_during(time).padded()
    }
    fn clipped(&self, child: u32, cell: &Aabb) -> Aabb {
        self.0[child as usize].clipped(cell).padded()
    }
    fn along(&self, child: u32, direction: Vec3A) -> [f32; 2] {
        self.0[child as usize].along(direction)
    }
    fn touches(&self, child: u32, cell: &Aabb) -> bool {
        self.bounds(child).overlaps(cell)
    }
    fn meets(&self, child: u32, beam: &Beam) -> Option<[f32; 2]> {
        beam.meets(&self.bounds(child))
    }
    fn blocks(&self, _child: u32, _beam: &Beam) -> Option<f32> {
        None
    }
    fn facing(&self, _child: u32, _beam: &Beam) -> Facing {
        Facing::Mixed
    }
    fn child_of(&self, _source: &Source) -> Option<u32> {
        None
    }
}
