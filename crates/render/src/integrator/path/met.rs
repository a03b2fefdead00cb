//! A surface on a path, ready to be shaded.

use glam::Vec3A;
use nestray_core::surface::Surface;

use crate::bsdf::Bsdf;
use crate::directions::Frame;
use crate::look::Look;

/// A surface a path met.
pub(super) struct Met {
    pub(super) surface: Surface,
    pub(super) bsdf: Bsdf,
    pub(super) frame: Frame,
    /// The true normal, on the side of the eye.
    pub(super) normal: Vec3A,
}

impl Met {
    pub(super) fn new(surface: Surface, look: &Look, to_eye: Vec3A, part: f32) -> Self {
        let front = to_eye.dot(surface.normal) >= 0.0;
        let side = if front { 1.0 } else { -1.0 };
        let (normal, mut shading) = (surface.normal * side, look.normal * side);
        // A smooth normal that would turn the surface away from the eye is not used.
        if shading.dot(to_eye) <= 1e-4 {
            shading = normal;
        }
        let frame = Frame::about(shading);
        let bsdf = Bsdf::new(look, front, part, frame.local(to_eye));
        Self { surface, bsdf, frame, normal }
    }
}
