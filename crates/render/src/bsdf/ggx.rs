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
    fn density(&self, h: Vec3A) -> f32 {
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

    /// The small mirrors as they are seen from a side.
    pub(crate) fn viewed(self, v: Vec3A) -> Viewed {
        let lambda = self.lambda(v);
        Viewed { ggx: self, v, lambda, seen: 1.0 / (1.0 + lambda) }
    }
}

/// The small mirrors, seen along `v`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Viewed {
    ggx: Ggx,
    v: Vec3A,
    /// [`Ggx::lambda`] of it.
    lambda: f32,
    /// Share of them that it sees.
    seen: f32,
}

impl Viewed {
    /// Share that `w` sees too, of those seen.
    pub(crate) fn both(&self, w: Vec3A) -> f32 {
        1.0 / (1.0 + self.lambda + self.ggx.lambda(w)) / self.seen
    }

    /// Density of the normals seen.
    pub(crate) fn density(&self, h: Vec3A) -> f32 {
        self.seen / self.v.z.abs() * self.ggx.density(h) * self.v.dot(h).abs()
    }

    /// One of the normals seen, `v.z > 0` [Dupuy 23].
    pub(crate) fn sample(&self, [u, w]: [f32; 2]) -> Vec3A {
        let (alpha, v) = (self.ggx.alpha, self.v);
        let stretched = Vec3A::new(alpha * v.x, alpha * v.y, v.z).normalize();
        let (sine, cosine) = libm::sincosf(TAU * u);
        let z = (1.0 - w) * (1.0 + stretched.z) - stretched.z;
        let radius = (1.0 - z * z).max(0.0).sqrt();
        let cap = Vec3A::new(radius * cosine, radius * sine, z) + stretched;
        Vec3A::new(alpha * cap.x, alpha * cap.y, cap.z.max(1e-7)).normalize()
    }
}
