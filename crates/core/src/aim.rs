//! Where many rays come from or go to: what directional techniques prepare for.

use serde::{Deserialize, Serialize};

/// A place or a direction that many rays share.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Emitter {
    /// A point: a small lamp, the hole of a camera.
    Point([f32; 3]),
    /// A box: around a lamp with a surface, or the lens of a camera.
    Box {
        /// Its lower corner.
        min: [f32; 3],
        /// Its upper corner.
        max: [f32; 3],
    },
    /// The direction towards something far away: the sun. Of any length but zero.
    Direction([f32; 3]),
}

impl Emitter {
    /// Whether it can be somewhere: finite, a box with its corners in order, a direction that is
    /// not zero.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let in_range = |at: &[f32; 3]| at.iter().all(|x| x.abs() <= crate::ray::Ray::FARTHEST);
        match self {
            Self::Point(at) => in_range(at),
            Self::Box { min, max } => {
                in_range(min) && in_range(max) && min.iter().zip(max).all(|(a, b)| a <= b)
            }
            Self::Direction(along) => {
                let longest = along.iter().fold(0f32, |longest, x| longest.max(x.abs()));
                in_range(along) && longest >= crate::ray::Ray::SHORTEST
            }
        }
    }
}

/// What a scene has of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Aims {
    /// The lights, in the order that shadow rays number them.
    pub lights: Vec<Emitter>,
    /// The eyes.
    pub eyes: Vec<Emitter>,
}
