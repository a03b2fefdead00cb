//! Things a ray can hit: single shapes, each an object, and triangle meshes, packed
//! families of children.

pub mod shape;

pub mod any;

pub mod sphere;

pub mod cone;

pub mod cylinder;

pub mod plane;

pub mod disk;

pub mod parallelogram;

pub mod block;

pub mod polygon;

pub mod patch;

mod rounding;

mod outline;

mod shadow;

pub mod torus;

pub mod quadric;

pub mod bezier;

pub mod height_field;

pub mod csg;

pub mod triangle_mesh;
