//! Any single shape, as one type: so that a list of mixed shapes needs no box for each.

use std::sync::Arc;

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_core::beam::{Beam, Facing};
use nestray_core::object::DynObject;
use nestray_core::ray::Ray;
use nestray_core::surface::Surface;

use crate::bezier::BezierPatch;
use crate::block::Block;
use crate::cone::Cone;
use crate::cylinder::Cylinder;
use crate::disk::Disk;
use crate::height_field::HeightField;
use crate::parallelogram::Parallelogram;
use crate::patch::Patch;
use crate::plane::Plane;
use crate::polygon::Polygon;
use crate::quadric::Quadric;
use crate::shape::{Crossing, Shape, Sides, Single};
use crate::sphere::Sphere;
use crate::torus::Torus;

/// Passes every question on to the shape inside.
macro_rules! any_shape {
    ($($(#[$doc:meta])* $name:ident($shape:ty),)+) => {
        /// One of the single shapes.
        #[derive(Clone, Debug, PartialEq)]
        pub enum AnyShape {
            $($(#[$doc])* $name($shape),)+
        }

        $(impl From<$shape> for AnyShape {
            fn from(shape: $shape) -> Self {
                Self::$name(shape)
            }
        })+

        impl AnyShape {
            /// The shape as an object of its own, as small as the shape is.
            #[must_use]
            pub fn into_object(self, geometry: u32, primitive: u32, sides: Sides) -> DynObject {
                match self {
                    $(Self::$name(shape) => Arc::new(Single { geometry, primitive, sides, shape }),)+
                }
            }
        }

        impl Shape for AnyShape {
            fn kind(&self) -> &'static str {
                match self { $(Self::$name(shape) => shape.kind(),)+ }
            }
            fn bounds(&self) -> Aabb {
                match self { $(Self::$name(shape) => shape.bounds(),)+ }
            }
            fn along(&self, direction: Vec3A) -> [f32; 2] {
                match self { $(Self::$name(shape) => shape.along(direction),)+ }
            }
            fn hull_area(&self) -> f32 {
                match self { $(Self::$name(shape) => shape.hull_area(),)+ }
            }
            fn touches(&self, cell: &Aabb) -> bool {
                match self { $(Self::$name(shape) => shape.touches(cell),)+ }
            }
            fn facing(&self, beam: &Beam) -> Facing {
                match self { $(Self::$name(shape) => shape.facing(beam),)+ }
            }
            fn blocks(&self, beam: &Beam) -> Option<f32> {
                match self { $(Self::$name(shape) => shape.blocks(beam),)+ }
            }
            fn crossings(&self, ray: &Ray, found: impl FnMut(Crossing)) {
                match self { $(Self::$name(shape) => shape.crossings(ray, found),)+ }
            }
            fn crossings_until(&self, ray: &Ray, limit: f32, found: impl FnMut(Crossing) -> f32) {
                match self { $(Self::$name(shape) => shape.crossings_until(ray, limit, found),)+ }
            }
            fn surface(&self, ray: &Ray, crossing: &Crossing) -> Surface {
                match self { $(Self::$name(shape) => shape.surface(ray, crossing),)+ }
            }
            fn is_flat(&self) -> bool {
                match self { $(Self::$name(shape) => shape.is_flat(),)+ }
            }
        }
    };
}

any_shape! {
    /// See [`Sphere`].
    Sphere(Sphere),
    /// See [`Cone`].
    Cone(Cone),
    /// See [`Cylinder`].
    Cylinder(Cylinder),
    /// See [`Plane`].
    Plane(Plane),
    /// See [`Disk`].
    Disk(Disk),
    /// See [`Parallelogram`].
    Parallelogram(Parallelogram),
    /// See [`Block`].
    Block(Block),
    /// See [`Polygon`].
    Polygon(Polygon),
    /// See [`Patch`].
    Patch(Patch),
    /// See [`Torus`].
    Torus(Torus),
    /// See [`Quadric`].
    Quadric(Quadric),
    /// See [`BezierPatch`]; elsewhere, since it is so much larger than the others.
    Bezier(Box<BezierPatch>),
    /// See [`HeightField`].
    HeightField(HeightField),
}

impl From<BezierPatch> for AnyShape {
    fn from(patch: BezierPatch) -> Self {
        Self::Bezier(Box::new(patch))
    }
}
