//! Cameras and lights.

use glam::{Affine3A, Vec3A};
use nestray_scene::camera::{Camera, Projection};
use nestray_scene::light::{Light, LightKind};

use super::Reader;

impl Reader<'_> {
    /// A camera looks along −z of its node. Its near plane is a need of depth buffers, and
    /// left out; so is its aspect ratio, which the picture decides.
    pub(super) fn add_camera(
        &mut self,
        number: usize,
        place: Affine3A,
        node: Option<usize>,
        name: &str,
    ) -> Result<(), String> {
        let found = self.document.cameras.get(number);
        let found = found.ok_or_else(|| format!("there is no cameras[{number}]"))?;
        let projection = match (&found.perspective, &found.orthographic) {
            (Some(lens), _) => Projection::Perspective { degrees: lens.yfov.to_degrees() },
            (None, Some(lens)) => Projection::Orthographic { height: 2.0 * lens.ymag.abs() },
            (None, None) => return Err(format!("cameras[{number}] has no projection")),
        };
        let sound = match projection {
            Projection::Perspective { degrees } => degrees > 0.0 && degrees < 180.0,
            Projection::Orthographic { height } => height > 0.0 && height.is_finite(),
        };
        let forward = place.transform_vector3a(Vec3A::NEG_Z);
        if !sound || forward.length_squared() == 0.0 {
            self.warn(format!("cameras[{number}] sees nothing and is left out"));
            return Ok(());
        }
        let name = if found.name.is_empty() { name } else { &found.name };
        self.scene.cameras.push(Camera {
            name: name.into(),
            from: place.translation,
            forward,
            up: place.transform_vector3a(Vec3A::Y),
            projection,
            node,
            ..Camera::default()
        });
        Ok(())
    }

    /// A light shines along −z of its node.
    pub(super) fn add_light(
        &mut self,
        number: usize,
        place: Affine3A,
        node: Option<usize>,
        name: &str,
    ) -> Result<(), String> {
        let found = self.document.extensions.lights.lights.get(number);
        let found = found.ok_or_else(|| format!("there is no light {number}"))?;
        let position = place.translation;
        let direction = place.transform_vector3a(Vec3A::NEG_Z).normalize_or(Vec3A::NEG_Z);
        let kind = match found.kind.as_str() {
            "point" => LightKind::Point { position, fades: true },
            "directional" => LightKind::Directional { direction },
            "spot" => {
                let outer = found.spot.outer_cone_angle.unwrap_or(std::f32::consts::FRAC_PI_4);
                let outer = outer.clamp(0.0, std::f32::consts::FRAC_PI_2);
                let inner = found.spot.inner_cone_angle.unwrap_or(0.0).clamp(0.0, outer);
                let (cos_inner, cos_outer) = (libm::cosf(inner), libm::cosf(outer));
                LightKind::Spot { position, direction, cos_inner, cos_outer }
            }
            other => {
                self.warn(format!("light {number} of kind `{}` is left out", other.escape_debug()));
                return Ok(());
            }
        };
        let strength = found.intensity.unwrap_or(1.0);
        let color = found.color.unwrap_or([1.0; 3]).map(|x| (x * strength).clamp(0.0, f32::MAX));
        let name = if found.name.is_empty() { name } else { &found.name };
        self.scene.lights.push(Light { name: name.into(), color, kind, node });
        Ok(())
    }
}
