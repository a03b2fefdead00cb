//! What share of light a smooth boundary mirrors.

use glam::Vec3A;

/// Of a clear boundary; `cosine` of the angle on the near side, `eta` how much slower light
/// is on the far side.
pub(crate) fn dielectric(cosine: f32, eta: f32) -> f32 {
    let sine_squared = (1.0 - cosine * cosine).max(0.0) / (eta * eta);
    if sine_squared >= 1.0 {
        return 1.0;
    }
    let below = (1.0 - sine_squared).sqrt();
    let parallel = (eta * cosine - below) / (eta * cosine + below);
    let across = (cosine - eta * below) / (cosine + eta * below);
    (0.5 * (parallel * parallel + across * across)).min(1.0)
}

/// `(1 − cosine)⁵` [Schlick 94].
pub(crate) fn grazing(cosine: f32) -> f32 {
    let rest = (1.0 - cosine).clamp(0.0, 1.0);
    let squared = rest * rest;
    squared * squared * rest
}

/// Between `straight`, seen straight on, and `edge`, seen edge-on.
pub(crate) fn schlick(straight: Vec3A, edge: f32, cosine: f32) -> Vec3A {
    let grazing = grazing(cosine);
    straight * (1.0 - grazing) + Vec3A::splat(edge * grazing)
}

/// Of a boundary seen straight on.
pub(crate) fn straight(ior: f32) -> f32 {
    let part = (ior - 1.0) / (ior + 1.0);
    part * part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn glass_mirrors_four_percent_straight_on_and_all_edge_on() {
        assert!((dielectric(1.0, 1.5) - 0.04).abs() < 1e-6);
        assert!((straight(1.5) - 0.04).abs() < 1e-6);
        assert!(dielectric(0.0, 1.5) > 0.999);
        assert_eq!(dielectric(0.5, 1.0 / 1.5), 1.0, "all of it, from inside");
        assert!(dielectric(0.3, 1.0) < 1e-12, "no boundary at all");
    }
}
