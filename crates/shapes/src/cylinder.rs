//! Cylinders without caps.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::cone::Cone;
use crate::shape::{Crossing, Shape};

/// A cylinder, open at both ends; rays hit it from outside and from inside. Texture
/// coordinates are the angle in turns and the height from 0 at the base to 1 at the top.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Centre of one end.
    pub base: Vec3A,
    /// Centre of the other end.
    pub top: Vec3A,
    /// Radius, positive.
    pub radius: f32,
}

impl Cylinder {
    fn cone(&self) -> Cone {
        Cone { base: self.base, base_radius: self.radius, apex: self.top, apex_radius: self.radius }
    }
}

impl Shape for Cylinder {
    fn kind(&self) -> &'static str {
        "cylinder"
    }
    fn bounds(&self) -> Aabb {
        self.cone().bounds()
    }
    fn along(&self, direction: Vec3A) -> [f32; 2] {
        self.cone().along(direction)
    }
    fn hull_area(&self) -> f32 {
        self.cone().hull_area()
    }
    fn touches(&self, cell: &Aabb) -> bool {
        self.cone().touches(cell)
    }
    #[inline]
    fn crossings(&self, ray: &Ray, found: impl FnMut(Crossing)) {
        self.cone().crossings(ray, found);
    }
    fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
        self.cone().surface(ray, crossing)
    }
}
