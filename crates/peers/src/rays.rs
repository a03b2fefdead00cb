//! Rays and answers as they are kept: every library makes its own of them while the clock runs.

/// A ray of 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct RayRecord {
    /// Where it starts.
    pub origin: [f32; 3],
    /// Nothing nearer counts, in multiples of the direction.
    pub t_min: f32,
    /// Where it goes, of any length.
    pub dir: [f32; 3],
    /// Nothing farther counts.
    pub t_max: f32,
}

/// A hit of 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct HitRecord {
    /// How far, in multiples of the direction; infinite for a miss.
    pub t: f32,
    /// Where on the triangle, by each library's custom; 0 where it does not say.
    pub uv: [f32; 2],
    /// Which triangle, by each library's count; `u32::MAX` for a miss.
    pub primitive: u32,
}

impl HitRecord {
    /// Nothing hit.
    pub const MISS: Self = Self { t: f32::INFINITY, uv: [0.0; 2], primitive: u32::MAX };
}

/// What rays that are handed over together are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// From an eye.
    Primary,
    /// Towards a light at one point.
    Shadow,
    /// Scattered by a surface.
    Bounce,
    /// Any lines.
    Chord,
}

impl Kind {
    /// Whether each 16 that follow one another go nearly the same way.
    #[must_use]
    pub const fn is_coherent(self) -> bool {
        matches!(self, Self::Primary | Self::Shadow)
    }
}
