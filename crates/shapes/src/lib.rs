//! Things a ray can hit: single shapes, each an object, and triangle meshes, packed
//! families of children.

pub mod shape;

pub mod any;

pub mod sphere;

pub mod bezier;

pub mod triangle_mesh;
