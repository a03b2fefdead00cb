//! Lights without a surface.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec3A;
use nestray_scene::light::{Light, LightKind};

use super::luminance;

/// Light of such a light at a point.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arriving {
    /// Towards the light, of length one.
    pub(crate) dir: Vec3A,
    /// Where it is; none if infinitely far.
    pub(crate) end: Option<Vec3A>,
    /// How bright it makes a white surface that faces it: irradiance over π. A light that
    /// does not fade, as in NFF, makes it as bright as its colour.
    pub(crate) brightness: Vec3A,
}

/// What arrives at `at`; none if nothing does.
pub(crate) fn arriving(light: &Light, at: Vec3A) -> Option<Arriving> {
    let color = Vec3A::from(light.color);
    let (dir, end, brightness) = match light.kind {
        LightKind::Directional { direction } => {
            ((-direction).try_normalize()?, None, color * FRAC_1_PI)
        }
        LightKind::Point { position, fades } => {
            let way = position - at;
            let dir = way.try_normalize()?;
            let share = if fades { FRAC_1_PI / way.length_squared() } else { 1.0 };
            (dir, Some(position), color * share)
        }
        LightKind::Spot { position, direction, cos_inner, cos_outer } => {
            let way = position - at;
            let dir = way.try_normalize()?;
            let cosine = -dir.dot(direction.try_normalize()?);
            let share = within(cosine, cos_inner, cos_outer) * FRAC_1_PI / way.length_squared();
            (dir, Some(position), color * share)
        }
    };
    let shines = brightness.max_element() > 0.0 && brightness.is_finite();
    shines.then_some(Arriving { dir, end, brightness })
}

/// 1 within the inner cone, 0 outside the outer one, smooth between: as glTF has it.
fn within(cosine: f32, inner: f32, outer: f32) -> f32 {
    if cosine >= inner {
        return 1.0;
    }
    if cosine <= outer || inner <= outer {
        return 0.0;
    }
    let part = (cosine - outer) / (inner - outer);
    part * part
}

/// About how much light it sends to a scene around `middle`, to choose lights by.
pub(crate) fn power(light: &Light, middle: Vec3A, radius: f32) -> f32 {
    let bright = luminance(Vec3A::from(light.color).max(Vec3A::ZERO));
    let disk = PI * radius * radius;
    match light.kind {
        LightKind::Directional { .. } => bright * disk,
        LightKind::Point { fades: false, .. } => bright * PI * disk,
        LightKind::Point { position, fades: true } | LightKind::Spot { position, .. } => {
            // All of it if it stands in the scene, the share of the sky that the scene takes
            // if it stands outside.
            let share = disk / (middle - position).length_squared().max(disk / (4.0 * PI));
            bright * share
        }
    }
}
