use glam::{Affine3A, Vec3};
use nestray_scene::group::{Group, Motion};
use nestray_shapes::triangle_mesh::Triangles;

use super::write::write_nff;
use super::*;

const SMALL: &str = "# a comment\nb 0.5 0 1\nv\nfrom 1 2 3#close\nat 0 0 0\nup 0 0 1\nangle 30\n\
    hither 1\nresolution 64 32\nl 1 0 0\nl 0 1 0 0.25 0.5 1\n\
    f 1 0.5 0 0.8 0.2 10 0 1\ns 0 0 0 1\ns 0 0 0 -2\nc 0 0 0 1 0 0 1 0.5\nc\n0 0 0 1\n0 0 1 1\n\
    p 3\n0 0 0\n1 0 0\n0 1 0\nf 1 1 1 0 0.1 5 0.9 1.5\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 2\n\
    0 1 0 0 1 0\ns 1 1 1 -1\n";

fn load(text: &str) -> Loaded {
    read(text.as_bytes(), &Source::new("a.nff")).expect("it is sound")
}

fn error(text: &str) -> String {
    read(text.as_bytes(), &Source::new("a.nff")).expect_err("it is not sound").to_string()
}

fn shapes(scene: &Scene, geometry: usize) -> &[AnyShape] {
    match &scene.geometries[geometry].content {
        Content::Shapes(shapes) => shapes,
        _ => unreachable!("NFF holds no meshes"),
    }
}

fn written(scene: &Scene) -> String {
    let mut out = Vec::new();
    write_nff(scene, &mut out).expect("it can be held");
    String::from_utf8(out).expect("it is text")
}

#[test]
fn every_statement_is_read() {
    let Loaded { scene, warnings } = load(SMALL);
    assert!(warnings.is_empty());
    assert_eq!(scene.background, Background::Color([0.5, 0.0, 1.0]));
    let camera = &scene.cameras[0];
    assert_eq!((camera.from, camera.up), (Vec3A::new(1.0, 2.0, 3.0), Vec3A::Z));
    assert_eq!((camera.hither, camera.resolution), (1.0, Some([64, 32])));
    let usual = 1.0 / 2f32.sqrt();
    assert_eq!(scene.lights[0].color, [usual; 3]);
    assert_eq!(scene.lights[1].color, [0.25, 0.5, 1.0]);
    assert_eq!(scene.ambient, [0.0; 3]);
    let seen: Vec<(Sides, u32)> =
        scene.geometries.iter().map(|g| (g.sides, g.primitives())).collect();
    assert_eq!(seen, [(Sides::Front, 1), (Sides::Back, 1), (Sides::Front, 3), (Sides::Both, 2)]);
    let kinds: Vec<&str> = shapes(&scene, 2).iter().map(Shape::kind).collect();
    assert_eq!(kinds, ["cone", "cylinder", "polygon"]);
    let sphere = Sphere { center: Vec3A::ZERO, radius: 2.0 };
    assert_eq!(shapes(&scene, 1), [sphere.into()]);
    let whitted = scene.materials[1].whitted.expect("it has coefficients");
    assert_eq!((whitted.ks, whitted.t, scene.materials[1].ior), (0.1, 0.9, 1.5));
}

#[test]
fn what_was_written_is_read_as_the_same() {
    let scene = load(SMALL).scene;
    let text = written(&scene);
    let again = load(&text).scene;
    assert_eq!(written(&again), text);
    assert_eq!(again.materials, {
        let [a, b] = [&scene.materials[0], &scene.materials[1]];
        [a, a, a, b].map(Clone::clone)
    });
    for (a, b) in scene.geometries.iter().zip(&again.geometries) {
        assert_eq!(a.sides == Sides::Both, b.sides == Sides::Both);
    }
    assert_eq!(shapes(&again, 2), shapes(&scene, 2));
}

#[test]
fn instances_are_written_where_they_stand() {
    let mut scene = Scene::new();
    let material = scene.add_material(Material::default());
    let mesh = Triangles::new(vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], vec![[0, 1, 2]])
        .expect("it is sound");
    let mesh = scene.add_apart(Geometry::mesh("", material, mesh));
    let sphere = Sphere { center: Vec3A::X, radius: 1.0 };
    let sphere = scene.add_apart(Geometry::shapes("", material, vec![sphere.into()]));
    let group = Group { geometries: vec![mesh, sphere], ..Group::default() };
    let group = scene.add_group(group);
    let mirror = Affine3A::from_scale(Vec3::new(-2.0, 2.0, 2.0));
    scene.place(group, Motion::Still(Affine3A::from_translation(Vec3::Z) * mirror));
    let text = written(&scene);
    // Turned around, so that the front of the mirror image is its front.
    assert!(text.contains("p 3\n0 2 1\n-2 0 1\n0 0 1\n"), "{text}");
    assert!(text.contains("s -2 0 1 2\n"), "{text}");
    scene.groups[scene.root].places[0].motion =
        Motion::Still(Affine3A::from_scale(Vec3::new(1.0, 2.0, 1.0)));
    let refused = write_nff(&scene, &mut Vec::new()).expect_err("an ellipsoid");
    assert_eq!(refused.to_string(), "NFF cannot hold a sphere that is distorted");
}

#[test]
fn what_nff_cannot_hold_is_named() {
    let refused = |change: fn(&mut Scene)| {
        let mut scene = load(SMALL).scene;
        change(&mut scene);
        write_nff(&scene, &mut Vec::new()).expect_err("it cannot be held").to_string()
    };
    assert_eq!(
        refused(|scene| scene.materials[1].emission = [1.0; 3]),
        "NFF cannot hold the glow of material \"\""
    );
    assert_eq!(
        refused(|scene| scene.lights[0] = Light::point(Vec3A::ZERO, [1.0; 3])),
        "NFF cannot hold lights other than points that do not get weaker"
    );
    assert_eq!(
        refused(|scene| scene.background = Background::Gradient([[0.0; 3]; 2], Vec3A::Y)),
        "NFF cannot hold a background that is no even colour"
    );
    assert_eq!(
        refused(|scene| scene.cameras[0].aperture = 1.0),
        "NFF cannot hold a camera with a lens"
    );
    assert_eq!(
        refused(|scene| scene.groups[0].places.push(nestray_scene::group::Place {
            name: "a".into(),
            group: 0,
            motion: Motion::Still(Affine3A::IDENTITY),
        })),
        "group 0 stands in itself"
    );
}

#[test]
fn errors_name_line_and_column() {
    let change = |from: &str, to: &str| error(&SMALL.replace(from, to));
    assert_eq!(change("b 0.5", "q 0.5"), "a.nff:2:1: expected a statement of NFF, found `q`");
    assert_eq!(
        change("s 0 0 0 1", "s 0 0 nan 1"),
        "a.nff:13:7: expected a coordinate, found `nan`"
    );
    assert_eq!(change("s 0 0 0 1", "s 0 0 0 1e39"), "a.nff:13:9: expected a radius, found `1e39`");
    assert_eq!(
        change("angle 30", "angle 180"),
        "a.nff:7:7: expected an angle between 0 and 180, found `180`"
    );
    assert_eq!(change("from 1 2 3#close\n", ""), "a.nff:3:1: a view without `from` and `at`");
    assert_eq!(
        change("from 1 2 3", "from 0 0 0"),
        "a.nff:3:1: a view from a place at the same place"
    );
    assert_eq!(
        change("resolution 64 32", "resolution 64 -1"),
        "a.nff:9:15: expected a number of pixels, found `-1`"
    );
    assert_eq!(
        change("p 3\n0 0 0\n1", "p 2\n0 0 0\n1"),
        "a.nff:19:3: expected a number of corners, at least 3, found `2`"
    );
    assert!(
        change("p 3\n0 0 0\n1", "p 4000000000\n0 0 0\n1")
            .starts_with("a.nff:19:1: a polygon of 4000000000 corners does not fit in the ")
    );
    assert_eq!(
        change("0 0 1 0.5", "0 0 1 -0.5"),
        "a.nff:15:1: a cone with radii 1 and -0.5 (hint: negate both or none)"
    );
    assert_eq!(error("s 0 0"), "a.nff:1:6: the file ends where a coordinate should be");
}

#[test]
fn shapes_without_extent_are_told() {
    let loaded = load("s 0 0 0 1\nc 0 0 0 1 0 0 0 1\ns 0 0 0 0");
    assert_eq!(loaded.scene.primitives(), 3);
    assert_eq!(
        loaded.warnings[0].to_string(),
        "a.nff:2: 2 shapes from here on have no extent and are not seen"
    );
    assert_eq!(loaded.scene.ambient, [0.0; 3]);
}
