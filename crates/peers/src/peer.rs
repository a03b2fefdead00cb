//! What every library is asked.

use std::time::Duration;

use crate::rays::{HitRecord, Kind, RayRecord};

/// In which way rays are handed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Way {
    /// One ray per call.
    Single,
    /// 16 rays per call.
    Packets,
    /// Thousands of rays per call.
    Batch,
}

impl Way {
    /// The word for it in tables.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Packets => "packets of 16",
            Self::Batch => "batch",
        }
    }
}

/// A library, set in some way, with triangles in it.
pub trait Peer {
    /// Which library, and how it is set.
    fn name(&self) -> String;

    /// Its version, and anything else worth keeping; may be empty.
    fn version(&self) -> String;

    /// Processor time of its build, on one thread; triangles are there already.
    fn build_time(&self) -> Duration;

    /// Memory that queries need: nodes and leaves. What is not known is 0.
    fn bytes(&self) -> u64;

    /// The ways in which it takes rays.
    fn ways(&self) -> &[Way];

    /// The nearest hit of each ray; as many hits as rays.
    fn closest(&self, way: Way, of: Kind, rays: &[RayRecord], hits: &mut [HitRecord]);

    /// Whether each ray hits anything; as many answers as rays.
    fn any(&self, way: Way, of: Kind, rays: &[RayRecord], blocked: &mut [bool]);
}

/// Why a library does not take part.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{peer} does not take part: {reason}")]
pub struct Missing {
    /// Its name.
    pub peer: String,
    /// Why, and what helps.
    pub reason: String,
}
