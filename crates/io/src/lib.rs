//! Readers and writers of scenes and pictures.
//!
//! [`load::load`] reads a scene of any format it knows. What a file says of its own size is
//! checked against its bytes before anything is set aside for it.

pub mod load;

pub mod error;

pub mod complete;

pub mod nff;

pub mod obj;

pub mod ply;

pub mod stl;

pub mod off;

pub mod gltf;

pub mod native;

pub mod atomic;

pub mod write;

pub mod png;

pub mod exr;

pub mod pfm;

pub mod image;

mod json;

mod uri;

mod words;

mod polygon;

mod mesh;
