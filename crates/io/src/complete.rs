//! A camera and light for scenes whose files have none.

use glam::Vec3A;
use nestray_core::aabb::Aabb;
use nestray_scene::camera::{Camera, Projection};
use nestray_scene::light::{Background, Light, LightKind};
use nestray_scene::scene::Scene;

/// Where the added camera stands, seen from the middle: before it (+z), to the right, above.
const STANDS: Vec3A = Vec3A::new(0.55, 0.4, 1.0);

/// Where the added sun stands: above, over the left shoulder of the camera.
const SUN: Vec3A = Vec3A::new(-0.45, 1.0, 0.75);

/// Irradiance of the sun.
const SUNLIGHT: [f32; 3] = [2.4, 2.3, 2.1];

/// Radiance of the sky straight down and straight up.
const SKY: [[f32; 3]; 2] = [[0.35, 0.34, 0.33], [0.55, 0.7, 0.95]];

/// Light from everywhere, in Whitted's model.
const AMBIENT: [f32; 3] = [0.25, 0.27, 0.3];

/// Gives a scene without a camera one that shows all of it, with +y up; and a scene in which
/// nothing shines a sky and a sun.
pub fn complete(scene: &mut Scene) {
    if scene.cameras.is_empty() {
        let camera = camera(scene.bounds());
        scene.cameras.push(camera);
    }
    let dark = scene.background == Background::default();
    if dark && scene.lights.is_empty() && !glows(scene) {
        scene.background = Background::Gradient(SKY, Vec3A::Y);
        scene.lights.push(Light {
            name: "sun".into(),
            color: SUNLIGHT,
            kind: LightKind::Directional { direction: -SUN.normalize() },
            node: None,
        });
        if scene.ambient == [0.0; 3] {
            scene.ambient = AMBIENT;
        }
    }
}

/// Whether some surface gives off light.
fn glows(scene: &Scene) -> bool {
    scene.geometries.iter().any(|geometry| scene.materials[geometry.material].glows())
}

/// A camera so far away that all corners of a box are in a square picture.
fn camera(bounds: Aabb) -> Camera {
    /// Of the picture, in degrees.
    const ANGLE: f32 = 35.0;
    /// Room at the edges.
    const MARGIN: f32 = 1.06;
    let usual = Camera {
        name: "front".into(),
        projection: Projection::Perspective { degrees: ANGLE },
        ..Camera::default()
    };
    let size = bounds.size().max_element();
    if bounds.is_empty() || !(size > 0.0 && size.is_finite()) {
        return usual;
    }
    let back = STANDS.normalize();
    let right = Vec3A::Y.cross(back).normalize();
    let up = back.cross(right);
    let slope = libm::tanf(ANGLE.to_radians() / 2.0) / MARGIN;
    let distance = (0..8)
        .map(|which| {
            let corner = bounds.corner(which) - bounds.center();
            let off = corner.dot(right).abs().max(corner.dot(up).abs());
            corner.dot(back) + off / slope
        })
        .fold(0.0, f32::max);
    let from = bounds.center() + back * distance;
    Camera { from, forward: -back * distance, focus: 1.0, ..usual }
}

#[cfg(test)]
mod tests {
    use nestray_scene::geometry::Geometry;
    use nestray_scene::material::Material;
    use nestray_shapes::sphere::Sphere;

    use super::*;

    fn scene(spheres: &[([f32; 3], f32)]) -> Scene {
        let mut scene = Scene::new();
        let material = scene.add_material(Material::default());
        let sphere = |&(center, radius): &([f32; 3], f32)| {
            Sphere { center: Vec3A::from_array(center), radius }.into()
        };
        scene.add(Geometry::shapes("", material, spheres.iter().map(sphere).collect()));
        scene
    }

    #[test]
    fn the_camera_sees_all_corners_and_is_not_far_away() {
        for shape in [[0.0, 0.0, 0.0], [9.0, 0.0, 0.0], [0.0, 9.0, 0.0], [0.0, 0.0, 9.0]] {
            for scale in [1e-5, 1.0, 1e6] {
                let far = shape.map(|x| (x + 7.0) * scale);
                let mut scene = scene(&[([7.0 * scale; 3], scale), (far, scale)]);
                complete(&mut scene);
                let camera = &scene.cameras[0];
                let forward = camera.forward.normalize();
                let right = forward.cross(camera.up).normalize();
                let up = right.cross(forward);
                let bounds = scene.bounds();
                let mut most = 0.0f32;
                for which in 0..8 {
                    let corner = bounds.corner(which) - camera.from;
                    let depth = corner.dot(forward);
                    assert!(depth > 0.0, "a corner is behind the camera");
                    let off = corner.dot(right).abs().max(corner.dot(up).abs());
                    most = most.max(off / depth / libm::tanf(17.5f32.to_radians()));
                }
                assert!((0.8..1.0).contains(&most), "{most}");
            }
        }
    }

    #[test]
    fn only_what_is_missing_is_added() {
        let mut scene = scene(&[([0.0; 3], 1.0)]);
        scene.materials[0].emission = [1.0; 3];
        scene.cameras.push(Camera { name: "own".into(), ..Camera::default() });
        complete(&mut scene);
        assert!(scene.lights.is_empty() && scene.background == Background::default());
        assert_eq!((scene.cameras.len(), scene.cameras[0].name.as_str()), (1, "own"));
    }

    #[test]
    fn an_empty_scene_gets_a_camera_too() {
        let mut scene = Scene::new();
        complete(&mut scene);
        assert!(scene.cameras[0].from.is_finite() && scene.lights.len() == 1);
    }
}
