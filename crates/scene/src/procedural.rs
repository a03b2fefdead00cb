//! Scenes made by programs: the standard ones of [Haines 87], and some of
//! our own, each hard on one technique or another.

mod balls;
mod bezier_teapot;
mod clusters;
mod demo;
mod forest;
mod gears;
mod hair;
mod jacks;
mod lattice;
mod look;
mod mesh;
mod mixed;
mod mount;
mod needles;
mod newell;
mod random;
mod rings;
mod scatter;
mod shells;
mod sombrero;
mod stadium;
mod standard;
mod teapot;
mod terrain;
mod tetra;
mod tree;
mod truss;

#[cfg(test)]
mod tests;

use std::ops::RangeInclusive;

use crate::scene::Scene;

pub use self::newell::{newell_mesh, newell_teapot};

/// One scene that can be made.
#[derive(Clone, Debug)]
pub struct Entry {
    /// What it is asked for by.
    pub name: &'static str,
    /// What it shows, in a line.
    pub about: &'static str,
    /// What its size factor counts.
    pub unit: &'static str,
    /// The size factor if none is given.
    pub default: u32,
    /// The size factors it can be made at; never more than [`MOST`] primitives.
    pub sizes: RangeInclusive<u32>,
    /// How many primitives are stored at a size factor, instances not counted.
    pub primitives: fn(u32) -> u64,
    /// Makes it; the same size gives the same bytes on every machine.
    pub build: fn(u32) -> Scene,
}

/// The most primitives that a scene stores, instances not counted: about half a gigabyte.
pub const MOST: u64 = 10_100_000;

/// Why a scene cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GenerateError {
    /// There is no scene of that name.
    #[error("no scene is called {name:?}; did you mean {nearest:?}?")]
    Unknown {
        /// What was asked for.
        name: String,
        /// The known name that is most like it.
        nearest: &'static str,
    },
    /// A scene cannot be made at that size factor.
    #[error("{name:?} cannot be made at size {size}: {unit}, from {smallest} to {largest}")]
    Size {
        /// The scene.
        name: &'static str,
        /// What was asked for.
        size: u32,
        /// What its size factor counts.
        unit: &'static str,
        /// The smallest size factor.
        smallest: u32,
        /// The largest size factor.
        largest: u32,
    },
}

/// Makes a scene by name, at its usual size if none is given.
///
/// # Errors
/// If there is no such scene, or not of that size.
pub fn generate(name: &str, size: Option<u32>) -> Result<Scene, GenerateError> {
    let entry = find(name)?;
    let size = size.unwrap_or(entry.default);
    if !entry.sizes.contains(&size) {
        return Err(GenerateError::Size {
            name: entry.name,
            size,
            unit: entry.unit,
            smallest: *entry.sizes.start(),
            largest: *entry.sizes.end(),
        });
    }
    Ok((entry.build)(size))
}

/// Looks a scene up by name.
///
/// # Errors
/// If there is none, with the name most like it.
pub fn find(name: &str) -> Result<&'static Entry, GenerateError> {
    SCENES.iter().find(|entry| entry.name == name).ok_or_else(|| {
        // A long name is not compared whole.
        let asked: String = name.chars().take(40).collect();
        let unlike = |entry: &&Entry| strsim::osa_distance(&asked.to_lowercase(), entry.name);
        let nearest = SCENES.iter().min_by_key(unlike).expect("there are scenes").name;
        GenerateError::Unknown { name: asked, nearest }
    })
}

/// A line of the list.
macro_rules! entry {
    ($room:ident, $name:literal, $default:literal, $sizes:expr, $unit:literal, $about:literal) => {
        Entry {
            name: $name,
            about: $about,
            unit: $unit,
            default: $default,
            sizes: $sizes,
            primitives: $room::count,
            build: $room::build,
        }
    };
}

/// All scenes that can be made.
#[rustfmt::skip]
pub const SCENES: &[Entry] = &[
    entry!(demo, "demo", 3, 1..=5, "depth of the sphereflake",
        "a teapot and a sphereflake in a ring of trees: glass, metal, matte, sun and lamps"),
    entry!(balls, "balls", 4, 0..=6, "depth", "Haines: sphereflake on a square"),
    entry!(gears, "gears", 4, 1..=32, "gears along a side",
        "Haines: meshing gears with faces of 144 corners, some of glass"),
    entry!(jacks, "jacks", 1, 1..=7, "depth", "Haines: jacks within jacks"),
    entry!(lattice, "lattice", 12, 1..=100, "cells along a side",
        "Haines: mirror balls and bars in a cubic lattice"),
    entry!(mount, "mount", 6, 1..=7, "depth", "Haines: fractal mountain and four balls of glass"),
    entry!(rings, "rings", 7, 1..=60, "layers", "Haines: pyramid of linked pentagons"),
    entry!(shells, "shells", 5, 1..=14, "halvings of the step",
        "Haines: sea shell of balls that overlap without end"),
    entry!(sombrero, "sombrero", 1, 1..=6, "doublings of the resolution",
        "Haines: ripple as a height field of triangles"),
    entry!(teapot, "teapot", 6, 1..=200, "cells along a side of a patch",
        "Haines: teapot in triangles on a chessboard"),
    entry!(tetra, "tetra", 6, 1..=11, "depth", "Haines: Sierpiński's tetrahedron"),
    entry!(tree, "tree", 11, 0..=19, "depth", "Haines: tree of cones, tiny on a huge field"),
    entry!(bezier_teapot, "bezier-teapot", 6, 1..=500, "squares along a side of the board",
        "the teapot's 32 Bezier patches, exact, on a chessboard"),
    entry!(stadium, "stadium", 1000, 10..=100_000, "length of the stadium over the teapot's",
        "teapot in a stadium of ten thousand chairs"),
    entry!(clusters, "clusters", 2, 1..=4, "depth",
        "lattice, sphereflake, long thin bundle and dense mesh, far apart"),
    entry!(forest, "forest", 10_000, 1..=200_000, "trees",
        "instances of one tree of about 60,000 triangles"),
    entry!(needles, "needles", 100_000, 1..=2_000_000, "needles",
        "long thin triangles and cylinders, none along an axis"),
    entry!(scatter, "scatter", 1_000_000, 1..=4_000_000, "triangles",
        "small triangles anywhere in a cube"),
    entry!(terrain, "terrain", 708, 2..=2240, "cells along a side",
        "mountains as one mesh of a million triangles"),
    entry!(truss, "truss", 24, 1..=54, "cells along a side",
        "lattice of square bars as one mesh, turned so that none is along an axis"),
    entry!(hair, "hair", 20_000, 1..=400_000, "strands", "a furry ball of curved strands of cones"),
    entry!(mixed, "mixed", 1, 1..=40, "copies along a side", "one of every kind of shape"),
];
