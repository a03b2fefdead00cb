//! Where rays of a scene come from and go to.

use glam::Vec3A;
use nestray_core::aim::{Aims, Emitter};

use crate::camera::Camera;
use crate::light::LightKind;
use crate::material::Material;
use crate::scene::Scene;

/// Most glowing surfaces that are counted as places of their own.
const LAMPS: usize = 8;

impl Scene {
    /// Its lights, in the order of [`lights`](Self::lights), then boxes around what glows in the
    /// world, if that is not much; and its cameras. As it stands at the start of its animation.
    #[must_use]
    pub fn aims(&self) -> Aims {
        let lights = self.lights.iter().map(|light| {
            let mut light = light.clone();
            light.follow(&self.animation, 0.0);
            match light.kind {
                LightKind::Point { position, .. } | LightKind::Spot { position, .. } => {
                    Emitter::Point(position.to_array())
                }
                LightKind::Directional { direction } => Emitter::Direction((-direction).to_array()),
            }
        });
        let lamps = self.groups[self.root]
            .geometries
            .iter()
            .map(|&geometry| &self.geometries[geometry])
            .filter(|geometry| {
                // A scene that only rays are sent into needs no materials.
                self.materials.get(geometry.material).is_some_and(Material::glows)
            })
            .map(crate::geometry::Geometry::bounds)
            .filter(|bounds| !bounds.is_empty() && bounds.is_bounded())
            .map(|bounds| Emitter::Box { min: bounds.min.into(), max: bounds.max.into() });
        let lamps: Vec<Emitter> = lamps.take(LAMPS + 1).collect();
        let lamps = if lamps.len() > LAMPS { Vec::new() } else { lamps };
        let eyes = self.cameras.iter().map(|camera| self.eye(camera));
        Aims { lights: lights.chain(lamps).collect(), eyes: eyes.collect() }
    }

    /// The eye of a camera, or the box around its lens.
    fn eye(&self, camera: &Camera) -> Emitter {
        let mut camera = camera.clone();
        camera.follow(&self.animation, 0.0);
        let lens = Vec3A::splat(camera.aperture);
        if camera.aperture > 0.0 {
            let (min, max) = ((camera.from - lens).into(), (camera.from + lens).into());
            Emitter::Box { min, max }
        } else {
            Emitter::Point(camera.from.to_array())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Light;

    #[test]
    fn lights_and_eyes_are_where_they_are() {
        let mut scene = Scene::new();
        scene.lights.push(Light::point(Vec3A::new(1.0, 2.0, 3.0), [1.0; 3]));
        let kind = LightKind::Directional { direction: Vec3A::NEG_Y };
        scene.lights.push(Light { kind, ..scene.lights[0].clone() });
        scene.cameras.push(Camera { from: Vec3A::X, aperture: 0.5, ..Camera::default() });
        let aims = scene.aims();
        let up = Emitter::Direction([0.0, 1.0, 0.0]);
        assert_eq!(aims.lights, [Emitter::Point([1.0, 2.0, 3.0]), up]);
        let lens = Emitter::Box { min: [0.5, -0.5, -0.5], max: [1.5, 0.5, 0.5] };
        assert_eq!(aims.eyes, [lens]);
    }
}
