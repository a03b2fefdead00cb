//! A scene with everything in it goes into a file and comes back the same.

use std::sync::Arc;

use glam::{Affine3A, Quat, Vec3, Vec3A, vec3a};
use nestray_core::aabb::Aabb;
use nestray_core::moving::Keys;
use nestray_scene::animation::{Node, Pose, Track, Way};
use nestray_scene::camera::{Camera, Projection};
use nestray_scene::geometry::Geometry;
use nestray_scene::group::{Group, Motion, Place};
use nestray_scene::light::{Background, Light, LightKind};
use nestray_scene::material::{AlphaMode, Material, Whitted};
use nestray_scene::solid::{Operand, Solid};
use nestray_scene::texture::{Image, Pixels, Texture, Wrap};
use nestray_shapes::any::AnyShape;
use nestray_shapes::bezier::BezierPatch;
use nestray_shapes::block::Block;
use nestray_shapes::cone::Cone;
use nestray_shapes::csg::Operation;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::disk::Disk;
use nestray_shapes::height_field::{HeightField, Relief};
use nestray_shapes::parallelogram::Parallelogram;
use nestray_shapes::patch::Patch;
use nestray_shapes::plane::Plane;
use nestray_shapes::polygon::Polygon;
use nestray_shapes::quadric::Quadric;
use nestray_shapes::shape::Sides;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::torus::Torus;
use nestray_shapes::triangle_mesh::Triangles;

use super::*;

/// One shape of every kind.
fn shapes() -> Vec<AnyShape> {
    let p = vec3a(0.1, 1e-30, -2.5e7);
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.3, 0.7, 0.0]];
    let field = HeightField::new([0.1, -1.0], [0.7, 1.3], [2, 3], vec![0.1; 6]).expect("sound");
    let clip = Aabb { min: vec3a(-1.0, f32::NEG_INFINITY, -1.0), max: Vec3A::INFINITY };
    let quadric = Quadric {
        squares: [1.0, 1.0, -1.0],
        products: [0.1; 3],
        linear: [0.2; 3],
        constant: -1.0,
        clip,
    };
    vec![
        Sphere { center: p, radius: 0.3 }.into(),
        Cone { base: p, base_radius: 0.3, apex: Vec3A::ONE, apex_radius: 0.1 }.into(),
        Cylinder { base: p, top: Vec3A::ONE, radius: 0.2 }.into(),
        Plane { point: p, normal: Vec3A::Y }.into(),
        Disk { center: p, normal: Vec3A::Y, radius: 2.0 }.into(),
        Parallelogram { corner: p, u: Vec3A::X, v: Vec3A::Y }.into(),
        Block { extent: Aabb { min: Vec3A::ZERO, max: Vec3A::ONE } }.into(),
        Polygon::new(corners.as_slice()).into(),
        Patch::new(&corners.map(|corner| (corner, [0.0, 0.0, 1.0]))).into(),
        Torus { center: p, axis: Vec3A::Z, major: 2.0, minor: 0.5 }.into(),
        quadric.into(),
        Quadric { clip: Aabb::ENDLESS, ..quadric }.into(),
        BezierPatch { points: [[p, Vec3A::X, Vec3A::Y, Vec3A::Z]; 4] }.into(),
        field.clone().into(),
        field.shaded(Relief::Smooth).into(),
    ]
}

fn materials() -> Vec<Material> {
    let whitted = Whitted { color: [0.3; 3], kd: 0.1, ks: 0.7, shine: 30.0, t: 0.2 };
    vec![
        Material::default(),
        Material {
            name: "glass \"ü\"\n".into(),
            base_color: [0.1, 0.2, 1.0 / 3.0],
            base_texture: Some(0),
            metallic: 0.5,
            roughness: 0.25,
            metallic_roughness_texture: Some(1),
            normal_texture: Some(1),
            normal_scale: 0.7,
            emission: [3.0, 2.0, 1.0],
            emission_texture: Some(2),
            transmission: 0.9,
            ior: 1.33,
            alpha: 0.4,
            alpha_mode: AlphaMode::Mask(0.3),
            whitted: Some(whitted),
        },
        Material { alpha_mode: AlphaMode::Blend, ..Material::default() },
    ]
}

fn textures() -> Vec<Texture> {
    let image = |pixels| Arc::new(Image { width: 2, height: 1, pixels });
    let colors = image(Pixels::Srgb(vec![[1, 2, 3, 4], [255, 254, 0, 255]]));
    let wrap = [Wrap::Mirror, Wrap::Clamp];
    let turned = Texture {
        wrap,
        nearest: true,
        scale: [2.0, 3.0],
        rotation: 0.1,
        offset: [0.5, -0.5],
        ..Texture::new("turned", colors.clone())
    };
    vec![
        Texture::new("plain", colors),
        Texture::new("", image(Pixels::Linear(vec![[9, 8, 7, 6]; 2]))),
        Texture::new("light", image(Pixels::Float(vec![[1e-8, 3.0, 1e6]; 2]))),
        turned,
    ]
}

fn motions() -> Vec<Motion> {
    let place = Affine3A::from_scale_rotation_translation(
        Vec3::new(1.0, -2.0, 0.1),
        Quat::from_rotation_y(0.7),
        Vec3::new(1.0 / 3.0, 0.0, 9.0),
    );
    let keys = Keys::new(vec![(0.0, Affine3A::IDENTITY), (0.3, place)]).expect("they ascend");
    vec![
        Motion::Still(Affine3A::IDENTITY),
        Motion::Still(place),
        Motion::Keys(keys),
        Motion::Node(1),
    ]
}

/// A solid of every operation and every kind of operand.
fn solid() -> Solid {
    let ball = || Operand::shape(Sphere { center: vec3a(0.1, 0.2, 0.3), radius: 0.7 });
    let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mesh = Triangles::new(corners, faces).expect("sound");
    let solid = |operation, left: Operand, right: Operand| {
        Solid::new(operation, left, right).expect("not deep")
    };
    let place = Affine3A::from_scale_rotation_translation(
        Vec3::new(1.0, -2.0, 0.1),
        Quat::from_rotation_y(0.7),
        Vec3::X,
    );
    let placed = |operand: Operand| operand.placed(place).expect("not flat");
    let both =
        solid(Operation::Intersection, ball().expect("closed"), placed(ball().expect("closed")));
    let either =
        solid(Operation::Union, Operand::mesh(Arc::new(mesh)).expect("closed"), both.into());
    solid(Operation::Difference, ball().expect("closed"), placed(either.into()))
}

pub(super) fn everything() -> Scene {
    let mut scene = Scene::new();
    scene.materials = materials();
    scene.textures = textures();
    let positions = vec![[0.1, 0.2, 0.3], [1.0, 0.0, 0.0], [0.0, 1.0, 1e-40]];
    let mesh = Triangles::new(positions, vec![[0, 1, 2], [2, 1, 0]])
        .and_then(|mesh| mesh.with_normals(vec![[0.0, 0.0, 1.0]; 3]))
        .and_then(|mesh| mesh.with_uvs(vec![[0.25, 0.75]; 3]))
        .and_then(|mesh| mesh.with_colors(vec![[0.1, 0.2, 0.3, 1.0]; 3]));
    scene.add(Geometry::mesh("mesh", 1, mesh.expect("sound")));
    let shapes = Geometry { sides: Sides::Back, ..Geometry::shapes("shapes", 2, shapes()) };
    let number = scene.add_apart(shapes);
    let solids = scene.add_apart(Geometry::solids("solids", 0, vec![solid(), solid()]));
    let geometries = vec![number, solids];
    let inner = Group { name: "inner".into(), geometries, places: Vec::new() };
    let inner = scene.add_group(inner);
    for (i, motion) in motions().into_iter().enumerate() {
        let place = Place { name: format!("place {i}"), group: inner, motion };
        scene.groups[0].places.push(place);
    }
    let spot = LightKind::Spot {
        position: Vec3A::ONE,
        direction: Vec3A::NEG_Y,
        cos_inner: 0.9,
        cos_outer: 0.8,
    };
    let point = LightKind::Point { position: Vec3A::ONE, fades: false };
    for kind in [spot, point, LightKind::Directional { direction: Vec3A::NEG_Z }] {
        scene.lights.push(Light {
            name: "light".into(),
            color: [1.0, 0.5, 0.1],
            kind,
            node: Some(0),
        });
    }
    let projection = Projection::Orthographic { height: 3.0 };
    let camera = Camera::looking(Vec3A::ONE, Vec3A::ZERO, Vec3A::Z, 33.3);
    scene.cameras = vec![
        Camera { resolution: Some([3, 4]), aperture: 0.1, focus: 2.0, ..camera },
        Camera { name: "flat".into(), projection, node: Some(1), hither: 0.5, ..Camera::default() },
    ];
    scene.background = Background::Environment { texture: 2, radians: 0.1, scale: 2.0 };
    scene.ambient = [0.1, 0.2, 0.3];
    animate(&mut scene);
    scene
}

fn animate(scene: &mut Scene) {
    let parts = Pose::Parts {
        translation: Vec3::X,
        rotation: Quat::from_rotation_x(0.3),
        scale: Vec3::splat(2.0),
    };
    let turn = |angle: f32| Quat::from_rotation_z(angle);
    scene.animation.nodes = vec![
        Node {
            parent: None,
            rest: Pose::Matrix(Affine3A::IDENTITY),
            translation: Track::default(),
            rotation: Track::default(),
            scale: Track::default(),
        },
        Node {
            parent: Some(0),
            rest: parts,
            translation: Track { keys: vec![(0.0, Vec3::X), (2.5, Vec3::Y)], way: Way::Step },
            rotation: Track { keys: vec![(0.0, turn(0.1)), (1.0, turn(0.2))], way: Way::Linear },
            scale: Track { keys: vec![(1.0, Vec3::ONE); 3], way: Way::Cubic },
        },
    ];
}

#[test]
fn a_scene_with_everything_comes_back_the_same() {
    let scene = everything();
    let (back, written) = there_and_back(&scene);
    assert_eq!(format!("{back:#?}"), format!("{scene:#?}"));
    let (_, again) = there_and_back(&back);
    assert_eq!(again, written);
}

#[test]
fn every_background_comes_back_the_same() {
    let gradient = Background::Gradient([[0.1; 3], [0.9; 3]], Vec3A::Y);
    for background in [Background::Color([0.1, 0.2, 0.3]), gradient] {
        let scene = Scene { background: background.clone(), ..everything() };
        assert_eq!(there_and_back(&scene).0.background, background);
    }
}

#[test]
fn images_are_written_once_for_all_textures_that_share_them() {
    let (back, written) = there_and_back(&everything());
    assert_eq!(written.matches("data:image").count(), 3);
    assert!(Arc::ptr_eq(&back.textures[0].image, &back.textures[3].image));
}

#[test]
fn what_json_cannot_say_is_told_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.json");
    let mut scene = everything();
    scene.ambient[1] = f32::NAN;
    let error = write_native(&scene, &path).expect_err("no number").to_string();
    assert!(error.contains("a number of the scene is infinite, or none"), "{error}");
    assert!(!path.exists());
    // Corners of a mesh are another matter: such triangles are in many files.
    let mesh = Triangles::new(vec![[f32::NAN, 0.0, 0.0]; 3], vec![[0, 1, 2]]).expect("sound");
    let mut scene = Scene::new();
    scene.add_material(Material::default());
    scene.add(Geometry::mesh("", 0, mesh));
    let (back, _) = there_and_back(&scene);
    assert!(back.bounds().is_empty());
}

#[test]
fn what_is_written_is_as_the_schema_says() {
    let schema = schema();
    assert!(schema["properties"]["nestray_scene"].is_object());
    let valid = jsonschema::validator_for(&schema).expect("a schema");
    let (_, written) = there_and_back(&everything());
    let document: serde_json::Value = serde_json::from_str(&written).expect("JSON");
    let errors: Vec<String> = valid.iter_errors(&document).map(|e| e.to_string()).collect();
    assert_eq!(errors, Vec::<String>::new());
    let mut unknown = document;
    unknown["geometries"][0]["colour"] = 1.into();
    assert!(!valid.is_valid(&unknown));
}
