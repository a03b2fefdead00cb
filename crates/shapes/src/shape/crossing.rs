//! Where lines meet surfaces.

/// Where a line crosses a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// Ray parameter.
    pub t: f32,
    /// Surface coordinates, of the shape's choice.
    pub uv: [f32; 2],
    /// Whether the ray arrives at the front: against the normal.
    pub front: bool,
}

impl Crossing {
    /// Where a line enters or leaves a solid. A grazing line does both at the same `t`, so
    /// `uv` tells them apart: `u` is 1 where it enters.
    #[inline(always)]
    #[must_use]
    pub fn of_solid(t: f32, front: bool) -> Self {
        Self { t, uv: [f32::from(front), 0.0], front }
    }
}
