//! Paths on their way.

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::ray::Ray;

use crate::eye::Start;

/// A path on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    /// Which of the starts.
    pub(super) start: u32,
    /// What light from here on is multiplied by.
    pub(super) share: Vec3A,
    /// Where it was scattered last.
    pub(super) from: Vec3A,
    /// With what density; of no use if `sharp`.
    pub(super) density: f32,
    /// Whether only this path can find the light it meets.
    pub(super) sharp: bool,
}

/// A walk where its ray ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step<'a> {
    /// How many rays it took.
    pub(super) depth: u32,
    pub(super) walk: &'a Walk,
    pub(super) start: &'a Start,
    pub(super) ray: &'a Ray,
    pub(super) hit: &'a Hit,
}
