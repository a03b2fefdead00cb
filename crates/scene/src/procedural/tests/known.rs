//! Numbers that are known of the standard scenes.

use glam::{DVec3, Vec3A};
use nestray_core::ray::{Ray, RayKind};
use nestray_shapes::any::AnyShape;
use nestray_shapes::shape::{Shape, Sides};

use crate::geometry::{Content, Geometry};
use crate::light::LightKind;
use crate::procedural::newell::{nets, surface};
use crate::procedural::{find, generate, newell_mesh, newell_teapot};
use crate::scene::Scene;

/// How many primitives of each kind a scene has: polygons (and patches), balls, cones (and
/// cylinders).
fn kinds(scene: &Scene) -> [usize; 3] {
    let mut kinds = [0; 3];
    for shape in scene.geometries.iter().flat_map(shapes) {
        kinds[match shape {
            AnyShape::Polygon(_) | AnyShape::Patch(_) => 0,
            AnyShape::Sphere(_) => 1,
            _ => 2,
        }] += 1;
    }
    kinds
}

fn shapes(geometry: &Geometry) -> &[AnyShape] {
    let Content::Shapes(shapes) = &geometry.content else { panic!("it has single shapes") };
    shapes
}

#[test]
fn standard_scenes_have_the_published_counts() {
    for (name, size, counts) in [
        ("balls", None, [1, 7381, 0]),
        ("gears", None, [9345, 0, 0]),
        ("mount", None, [8192, 4, 0]),
        ("rings", None, [1, 4200, 4200]),
        ("teapot", None, [2292, 0, 0]),
        ("teapot", Some(12), [9264, 0, 0]),
        ("tetra", None, [4096, 0, 0]),
        ("tree", None, [1, 4095, 4095]),
        ("lattice", None, [0, 2197, 6084]),
        ("shells", None, [0, 5761, 0]),
        ("jacks", None, [0, 6, 3]),
        ("sombrero", None, [1922, 0, 0]),
    ] {
        assert_eq!(
            kinds(&generate(name, size).expect("it can be made")),
            counts,
            "{name} at {size:?}"
        );
    }
}

#[test]
fn standard_scenes_grow_as_published() {
    for n in 1..=3usize {
        let check = |name: &str, counts: [usize; 3]| {
            let scene = generate(name, Some(n as u32)).expect("it can be made");
            assert_eq!(kinds(&scene), counts, "{name} at {n}");
        };
        let power = |base: usize| base.pow(n as u32);
        check("balls", [1, (power(9) * 9 - 1) / 8, 0]);
        check("gears", [2 * n * n * n + 144 * n * n * n + 1, 0, 0]);
        check("mount", [2 * power(4), 4, 0]);
        let rings = 5 * n * (n + 1) * (2 * n + 1);
        check("rings", [1, rings, rings]);
        check("teapot", [64 * n * n - 8 * n + n * n, 0, 0]);
        check("tetra", [power(4), 0, 0]);
        check("tree", [1, 2 * power(2) - 1, 2 * power(2) - 1]);
        check("lattice", [0, (n + 1).pow(3), 3 * n * (n + 1) * (n + 1)]);
        check("shells", [0, 180 * power(2) + 1, 0]);
        check("jacks", [0, 6 * (power(8) - 1) / 7, 3 * (power(8) - 1) / 7]);
        let side = 32 * power(2) / 2 - 1;
        check("sombrero", [2 * side * side, 0, 0]);
    }
}

/// Whether all are the same, as printed with six digits.
fn close(ours: &[f32], known: &[f32]) -> bool {
    let near = |(a, b): (&f32, &f32)| (a - b).abs() <= 5e-6 * b.abs() + 1e-7;
    ours.len() == known.len() && ours.iter().zip(known).all(near)
}

#[test]
fn some_primitives_are_where_they_are_known_to_be() {
    let last = |name: &str, geometry: usize, shape: usize| {
        shapes(&generate(name, None).expect("it can be made").geometries[geometry])[shape].clone()
    };
    let ball = |shape| {
        let AnyShape::Sphere(ball) = shape else { panic!("it is a ball") };
        [ball.center.x, ball.center.y, ball.center.z, ball.radius]
    };
    assert!(close(&ball(last("balls", 1, 1)), &[0.272_166, 0.272_166, 0.544_331, 0.166_667]));
    let smallest = [0.436_486, -0.541_242, -0.222_222, 0.006_172_84];
    assert!(close(&ball(last("balls", 1, 7380)), &smallest));
    let AnyShape::Polygon(face) = last("gears", 1, 0) else { panic!("it is a face") };
    assert!(close(&face.vertices()[0], &[-0.481_96, -0.748_828, 1.0]));
    let AnyShape::Cone(branch) = last("tree", 1, 2) else { panic!("it is a branch") };
    let end = [branch.apex.x, branch.apex.y, branch.apex.z, branch.apex_radius];
    assert!(close(&end, &[0.417_812, 0.0, 1.497_93, 0.067_335]));
    let AnyShape::Cylinder(link) = last("rings", 1, 0) else { panic!("it is a link") };
    let ends = [link.base.x, link.base.y, link.base.z, link.top.x, link.top.y, link.top.z];
    assert!(close(&ends, &[0.930_995, 2.613_13, 0.0, 0.287_693, 1.727_7, 0.0]));
}

#[test]
fn the_mountain_is_as_deep_as_known() {
    let scene = generate("mount", None).expect("it can be made");
    let AnyShape::Polygon(first) = &shapes(&scene.geometries[1])[0] else { panic!("a triangle") };
    assert!(close(&first.vertices()[1], &[-0.968_75, -1.0, -0.016_040_9]));
    assert!(close(&first.vertices()[2], &[-0.968_75, -0.968_75, -0.007_322_02]));
    assert!(close(&[scene.geometries[1].bounds().min.z], &[-0.702_953]));
}

#[test]
fn boxes_are_as_large_as_known() {
    for (name, sizes) in [
        ("balls", [24.0, 24.0, 1.331]),
        ("gears", [4.0, 4.0, 1.0]),
        ("mount", [2.16, 2.16, 2.08]),
        ("rings", [19.68, 19.25, 19.68]),
        ("teapot", [8.0, 8.0, 3.15]),
        ("tetra", [2.0, 2.0, 2.0]),
        ("tree", [100.0, 100.0, 3.136]),
        ("lattice", [1.0417, 1.0417, 1.0417]),
        ("shells", [44.4, 55.4, 50.7]),
        ("jacks", [1.71, 1.60, 1.52]),
        ("sombrero", [8.0, 1.6, 8.0]),
    ] {
        let bounds = generate(name, None).expect("it can be made").bounds();
        let off = (bounds.max - bounds.min) / Vec3A::from_array(sizes) - 1.0;
        assert!(off.abs().max_element() < 0.02, "{name}: {bounds:?}");
    }
}

#[test]
fn only_glass_and_teapots_have_a_back() {
    for name in ["balls", "gears", "mount", "rings", "teapot", "tetra", "tree", "shells"] {
        let scene = generate(name, None).expect("it can be made");
        for geometry in &scene.geometries {
            let whitted = scene.materials[geometry.material].whitted.expect("it is of NFF");
            let both = whitted.t > 0.0 || geometry.name == "teapot";
            assert_eq!(geometry.sides == Sides::Both, both, "{name}: {}", geometry.name);
        }
    }
}

#[test]
fn lights_together_are_the_root_of_their_number() {
    for entry in ["balls", "tree", "mount"].map(|name| find(name).expect("it is known")) {
        let scene = (entry.build)(*entry.sizes.start());
        let count = scene.lights.len() as f32;
        for light in &scene.lights {
            assert_eq!(light.color, [1.0 / count.sqrt(); 3]);
            assert_eq!(scene.ambient, [0.0; 3]);
            assert!(matches!(light.kind, LightKind::Point { fades: false, .. }));
        }
    }
}

#[test]
fn the_teapot_has_32_patches_that_meet() {
    let patches = newell_teapot();
    assert_eq!(patches.len(), 32);
    let all = patches.iter().fold(nestray_core::aabb::Aabb::EMPTY, |all, p| all.join(p.hull()));
    assert_eq!((all.min, all.max), (Vec3A::new(-3.0, -2.0, 0.0), Vec3A::new(3.525, 2.0, 3.15)));
    // Every boundary of a turned part is a boundary of its neighbour.
    for part in patches[..12].chunks(4).chain(patches[20..].chunks(4)) {
        for (i, patch) in part.iter().enumerate() {
            assert_eq!(patch.points[3], part[(i + 1) % 4].points[0]);
        }
    }
    assert_eq!(newell_mesh(6).count(), 2256);
    assert_eq!(newell_mesh(12).count(), 9120);
}

#[test]
fn normals_of_the_teapot_agree_with_the_fronts_of_its_triangles() {
    let mesh = newell_mesh(24);
    let corner = |v: u32| Vec3A::from_array(mesh.positions()[v as usize]);
    for face in mesh.faces() {
        let [a, b, c] = face.map(corner);
        let front = (b - a).cross(c - a).normalize();
        for &v in face {
            let normal = Vec3A::from_array(mesh.normals()[v as usize]);
            assert!(normal.dot(front) > 0.0, "at {a} the normal {normal} is not {front}");
        }
    }
}

#[test]
fn a_ray_at_the_exact_teapot_meets_it_where_the_patch_is() {
    let eye = DVec3::new(4.86, 7.2, 5.4);
    for (number, (net, patch)) in nets().iter().zip(newell_teapot()).enumerate() {
        for i in 0..400 {
            let (s, t) = (f64::from(i % 20) / 20.0 + 0.02, f64::from(i / 20) / 20.0 + 0.03);
            let (place, normal) = surface(net, s, t);
            for from in [place + normal, eye] {
                let ray = Ray::new(from.as_vec3a(), (place - from).as_vec3a(), RayKind::Camera);
                let mut nearest = f32::INFINITY;
                patch.crossings(&ray, |crossing| {
                    nearest = nearest.min((crossing.t - 1.0).abs());
                });
                // Where the ray grazes the patch, it may be found a little beside it.
                let grazing = normal.dot((place - from).normalize()).abs() < 0.05;
                assert!(nearest < 1e-3 || grazing, "{number} at {s} {t}: {nearest} away");
            }
        }
    }
}
