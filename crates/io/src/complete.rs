//! A camera and light for scenes whose files have none.

use glam::{DVec3, Vec3, Vec3A};
use nestray_core::aabb::Aabb;
use nestray_scene::camera::{Camera, Projection};
use nestray_scene::geometry::Content;
use nestray_scene::light::{Background, Light, LightKind};
use nestray_scene::scene::Scene;

/// Where the added camera stands, seen from the middle: to the right, above, before it.
const STANDS: Vec3A = Vec3A::new(0.55, 0.4, 1.0);

/// Where the added sun stands: above, over the left shoulder of the camera.
const SUN: Vec3A = Vec3A::new(-0.45, 1.0, 0.75);

/// Irradiance of the sun: with the sky, white in full light is just not too bright to be shown.
const SUNLIGHT: [f32; 3] = [1.9, 1.82, 1.66];

/// Radiance of the sky straight down and straight up.
const SKY: [[f32; 3]; 2] = [[0.28, 0.275, 0.27], [0.42, 0.53, 0.72]];

/// Light from everywhere, in Whitted's model.
const AMBIENT: [f32; 3] = [0.25, 0.27, 0.3];

/// Gives a scene without a camera one that shows all of it, with `up` (+y or +z) upwards; and a
/// scene in which nothing shines a sky and a sun.
pub fn complete(scene: &mut Scene, up: Vec3A) {
    let sides = sides(scene, up);
    if scene.cameras.is_empty() {
        let camera = camera(scene.bounds(), sides);
        scene.cameras.push(camera);
    }
    let dark = scene.background == Background::default();
    if dark && scene.lights.is_empty() && !glows(scene) {
        let [right, up, back] = sides;
        let sun = right * SUN.x + up * SUN.y + back * SUN.z;
        scene.background = Background::Gradient(SKY, up);
        scene.lights.push(Light {
            name: "sun".into(),
            color: SUNLIGHT,
            kind: LightKind::Directional { direction: -sun.normalize() },
            node: None,
        });
        if scene.ambient == [0.0; 3] {
            scene.ambient = AMBIENT;
        }
    }
}

/// Whether some surface is there to give light. One with a picture on it is not: screens and
/// signs would leave all else in the dark.
fn glows(scene: &Scene) -> bool {
    scene.geometries.iter().any(|geometry| {
        let material = &scene.materials[geometry.material];
        material.glows() && material.emission_texture.is_none()
    })
}

/// The directions to which the camera stands to the right, above and before the scene: those
/// from which most faces show their front. Closed meshes look alike from all sides and are
/// seen from where front is by custom, +z or, with +z up, −y; a room that is open to one side
/// is looked into.
fn sides(scene: &Scene, up: Vec3A) -> [Vec3A; 3] {
    /// Of the area seen along an axis, how much more must face away. Holes are less.
    const MOST: f64 = 0.3;
    let back = if up == Vec3A::Z { Vec3A::NEG_Y } else { Vec3A::Z };
    let (mut sum, mut all) = (DVec3::ZERO, DVec3::ZERO);
    for &geometry in &scene.groups[scene.root].geometries {
        let Content::Mesh(mesh) = &scene.geometries[geometry].content else { continue };
        for face in mesh.faces() {
            let at = |i: usize| Vec3::from(mesh.positions()[face[i] as usize]).as_dvec3();
            let area = (at(1) - at(0)).cross(at(2) - at(0));
            if area.is_finite() {
                (sum, all) = (sum + area, all + area.abs());
            }
        }
    }
    let front = |axis: Vec3A| {
        let axis64 = axis.as_dvec3();
        let away = sum.dot(axis64) < -MOST * all.dot(axis64.abs());
        if away { -axis } else { axis }
    };
    [front(Vec3A::X), up, front(back)]
}

/// A camera so far away that all corners of a box are in a square picture.
fn camera(bounds: Aabb, [right, up, back]: [Vec3A; 3]) -> Camera {
    /// Of the picture, in degrees.
    const ANGLE: f32 = 35.0;
    /// Room at the edges.
    const MARGIN: f32 = 1.06;
    let usual = Camera {
        name: "front".into(),
        projection: Projection::Perspective { degrees: ANGLE },
        up,
        ..Camera::default()
    };
    let size = bounds.size().max_element();
    if bounds.is_empty() || !(size > 0.0 && size.is_finite()) {
        return usual;
    }
    let back = (right * STANDS.x + up * STANDS.y + back * STANDS.z).normalize();
    let right = up.cross(back).normalize();
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
    use nestray_shapes::triangle_mesh::Triangles;

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
                complete(&mut scene, Vec3A::Y);
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
        complete(&mut scene, Vec3A::Y);
        assert!(scene.lights.is_empty() && scene.background == Background::default());
        assert_eq!((scene.cameras.len(), scene.cameras[0].name.as_str()), (1, "own"));
    }

    #[test]
    fn an_empty_scene_gets_a_camera_too() {
        let mut scene = Scene::new();
        complete(&mut scene, Vec3A::Y);
        assert!(scene.cameras[0].from.is_finite() && scene.lights.len() == 1);
    }

    /// A cube without one side, that which faces `open`; its faces look inwards.
    fn room(open: Vec3A) -> Scene {
        let mut triangles = Vec::new();
        for side in [Vec3A::X, Vec3A::Y, Vec3A::Z].into_iter().flat_map(|axis| [axis, -axis]) {
            if side != open {
                let (u, v) = side.any_orthonormal_pair();
                let (u, v) = if u.cross(v).dot(side) < 0.0 { (u, v) } else { (v, u) };
                let corner = |a: f32, b: f32| side + u * a + v * b;
                let [a, b, c] = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0)];
                triangles.extend([[a, b, c], [a, c, corner(-1.0, 1.0)]]);
            }
        }
        let mut scene = Scene::new();
        let material = scene.add_material(Material::default());
        scene.add(Geometry::mesh("room", material, Triangles::from_corners(&triangles)));
        scene
    }

    #[test]
    fn one_looks_into_a_room_and_the_sun_shines_into_it() {
        for (open, seen_from) in [
            (Vec3A::Z, [1.0, 1.0]),
            (Vec3A::NEG_Z, [1.0, -1.0]),
            (Vec3A::NEG_X, [-1.0, 1.0]),
            (Vec3A::ZERO, [1.0, 1.0]),
        ] {
            let mut scene = room(open);
            complete(&mut scene, Vec3A::Y);
            let from = scene.cameras[0].from;
            assert_eq!([from.x.signum(), from.z.signum()], seen_from, "{open}");
            let LightKind::Directional { direction } = scene.lights[0].kind else { panic!() };
            assert!(direction.z * open.z <= 0.0, "{open}");
        }
    }

    #[test]
    fn a_scene_may_stand_on_its_xy_plane() {
        let mut scene = scene(&[([0.0; 3], 1.0)]);
        complete(&mut scene, Vec3A::Z);
        let camera = &scene.cameras[0];
        assert!(camera.from.y < 0.0 && camera.from.z > 0.0 && camera.up == Vec3A::Z);
        let LightKind::Directional { direction } = scene.lights[0].kind else { panic!() };
        assert!(direction.z < 0.0);
    }

    #[test]
    fn a_screen_that_glows_is_no_light() {
        let mut scene = scene(&[([0.0; 3], 1.0)]);
        scene.materials[0].emission = [1.0; 3];
        scene.materials[0].emission_texture = Some(0);
        complete(&mut scene, Vec3A::Y);
        assert_eq!(scene.lights.len(), 1);
    }
}
