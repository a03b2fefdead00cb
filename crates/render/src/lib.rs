//! Light transport over any nest: from a scene and an object that holds its geometry to a
//! picture.
//!
//! The world is opaque here: rays go to it in batches by kind, and hits come back. The
//! picture is a function of the scene and the options; threads, tiles, the size of batches
//! and vector instructions never show in it.

pub mod render;

pub mod options;

pub mod watch;

pub mod ray_counts;

pub mod filter;

pub mod tone_map;

pub mod heat;

mod sampler;

mod directions;

mod eye;

mod tile;

mod film;

mod tracer;

mod look;

mod background;

mod light_sampling;

mod bsdf;

mod integrator;

#[cfg(test)]
mod testing;
