//! Rough boundaries as small mirrors whose normals are spread as in [Walter 07].

use std::f32::consts::{PI, TAU};

use glam::Vec3A;

/// Boundaries of a roughness below this are taken as smooth.
pub(crate) const SMOOTHEST: f32 = 0.02;

/// Normals of the small mirrors, about `z`. `alpha` is the square of the roughness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ggx {
    alpha: f32,
}

impl Ggx {
    pub(crate) fn new(alpha: f32) -> Self {
        Self { alpha }
    }

    /// Density of normals `h`, as seen from straight above.
    pub(crate) fn density(&self, h: Vec3A) -> f32 {
        let across = (h.x * h.x + h.y * h.y) / (self.alpha * self.alpha);
        let cosine_squared = h.z * h.z;
        let spread = across + cosine_squared;
        1.0 / (PI * self.alpha * self.alpha * spread * spread)
    }

    /// Smith's auxiliary function of a direction on either side.
    fn lambda(&self, v: Vec3A) -> f32 {
        let cosine_squared = v.z * v.z;
        if cosine_squared == 0.0 {
            return f32::INFINITY;
        }
        let tangent_squared = (v.x * v.x + v.y * v.y) / cosine_squared;
        0.5 * ((1.0 + self.alpha * self.alpha * tangent_squared).sqrt() - 1.0)
    }

    /// Share of the small mirrors that `v` sees.
    pub(crate) fn seen(&self, v: Vec3A) -> f32 {
        1.0 / (1.0 + self.lambda(v))
    }

    /// Share that both see.
    pub(crate) fn seen_by_both(&self, v: Vec3A, w: Vec3A) -> f32 {
        1.0 / (1.0 + self.lambda(v) + self.lambda(w))
    }

    /// Density of normals as `v` sees them.
    pub(crate) fn density_seen(&self, v: Vec3A, h: Vec3A) -> f32 {
        self.seen(v) / v.z.abs() * self.density(h) * v.dot(h).abs()
    }

    /// A normal as `v` sees them, `v.z > 0` [Dupuy 23].
    pub(crate) fn sample(&self, v: Vec3A, [u, w]: [f32; 2]) -> Vec3A {
        let stretched = Vec3A::new(self.alpha * v.x, self.alpha * v.y, v.z).normalize();
        let (sine, cosine) = libm::sincosf(TAU * u);
        let z = (1.0 - w) * (1.0 + stretched.z) - stretched.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let cap = Vec3A::new(radius * cosine, radius * sine, z) + stretched;
        Vec3A::new(self.alpha * cap.x, self.alpha * cap.y, cap.z.max(1e-7)).normalize()
    }
}
