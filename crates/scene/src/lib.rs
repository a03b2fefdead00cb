//! What there is to see: geometry, where it stands, materials, lights, cameras.
//!
//! A scene knows nothing of files, of techniques, or of how it is rendered.

pub mod scene;

pub mod geometry;

pub mod solid;

pub mod group;

pub mod paths;

pub mod check;

pub mod surfaces;

pub mod aims;
pub mod animation;

pub mod material;

pub mod texture;

pub mod light;

pub mod camera;

pub mod picture;

pub mod procedural;
