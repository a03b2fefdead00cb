//! Our own scenes.

use nestray_shapes::any::AnyShape;

use crate::geometry::Content;
use crate::group::Motion;
use crate::procedural::generate;
use crate::scene::Scene;

/// A number that changes with any bit of any place in a scene [Fowler 91].
fn fingerprint(scene: &Scene) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut mix = |numbers: &[f32]| {
        for x in numbers {
            hash = (hash ^ u64::from(x.to_bits())).wrapping_mul(0x0100_0000_01b3);
        }
    };
    for geometry in &scene.geometries {
        match &geometry.content {
            Content::Mesh(mesh) => {
                mix(mesh.positions().as_flattened());
                mix(mesh.normals().as_flattened());
                mix(mesh.colors().as_flattened());
            }
            Content::Shapes(shapes) => shapes.iter().for_each(|shape| match shape {
                AnyShape::Sphere(ball) => mix(&[ball.center.x, ball.center.y, ball.radius]),
                AnyShape::Cone(cone) => mix(&cone.apex.to_array()),
                AnyShape::Cylinder(bar) => mix(&bar.top.to_array()),
                AnyShape::Polygon(polygon) => mix(polygon.vertices().as_flattened()),
                AnyShape::Patch(patch) => mix(patch.normals().as_flattened()),
                _ => {}
            }),
            Content::Solids(solids) => solids.iter().for_each(|solid| {
                let bounds = solid.bounds();
                mix(&[bounds.min.to_array(), bounds.max.to_array()].concat());
            }),
        }
    }
    for place in scene.groups.iter().flat_map(|group| &group.places) {
        let Motion::Still(place) = &place.motion else { panic!("nothing moves") };
        mix(&place.to_cols_array());
    }
    hash
}

#[test]
fn scenes_are_the_same_on_every_machine() {
    let known = [
        ("demo", 2, 0x6305_5914_e7dc_0a09),
        ("stadium", 1000, 0xe50a_7568_77b1_6b46),
        ("clusters", 1, 0xf156_7ea9_4761_403f),
        ("forest", 100, 0x866d_c387_f4f4_e51c),
        ("needles", 1000, 0x85d1_7d8c_e0c5_8560),
        ("scatter", 1000, 0x23b8_0ff6_d846_1190),
        ("terrain", 64, 0xbe79_bf92_7b56_6379),
        ("truss", 4, 0x7597_caac_20e3_b6cb),
        ("hair", 200, 0xc64e_3351_7503_85bf),
        ("mixed", 2, 0x0e5b_f729_3855_46c9),
        ("balls", 3, 0x737c_f896_44d8_2c07),
        ("gears", 2, 0xbc2d_f6de_acd3_fd05),
        ("mount", 6, 0xff4e_7867_d786_f2fd),
        ("rings", 3, 0xc8cb_e743_aa4c_3b6d),
        ("teapot", 6, 0xb9ca_2dd0_6fe0_996a),
        ("tetra", 3, 0x457b_5679_0f08_3025),
        ("tree", 6, 0xe22b_1a35_614b_10d0),
        ("shells", 2, 0xff68_8bd2_a7ce_6496),
    ];
    let found = known.map(|(name, size, _)| {
        (name, size, fingerprint(&generate(name, Some(size)).expect("it can be made")))
    });
    assert_eq!(found, known);
}

#[test]
fn the_forest_is_one_tree_in_ten_thousand_places() {
    let scene = generate("forest", None).expect("it can be made");
    assert_eq!(scene.groups[scene.root].places.len(), 10_000);
    assert_eq!(scene.geometries.len(), 3);
    let tree: u32 = scene.geometries[1..].iter().map(|part| part.primitives()).sum();
    assert!((58_000..62_000).contains(&tree), "{tree} triangles");
    let ground = u64::from(scene.geometries[0].primitives());
    assert_eq!(scene.primitives(), 10_000 * u64::from(tree) + ground);
}

#[test]
fn the_stadium_is_as_many_teapots_long_as_asked() {
    for size in [10, 1000, 100_000] {
        let scene = generate("stadium", Some(size)).expect("it can be made");
        let places = &scene.groups[scene.root].places;
        assert!((9_000..13_000).contains(&places.len()), "{} places", places.len());
        let teapot = places.last().expect("there are places");
        let bounds = scene.geometries[scene.groups[teapot.group].geometries[0]].bounds();
        let bounds = scene.sweep(&teapot.motion, bounds);
        let ratio = 200.0 / (bounds.max - bounds.min).x;
        assert!((ratio / size as f32 - 1.0).abs() < 0.01, "{ratio} for {size}");
    }
}

#[test]
fn chairs_are_instances_that_stand_within_the_stadium() {
    let scene = generate("stadium", None).expect("it can be made");
    for place in &scene.groups[scene.root].places {
        let Motion::Still(at) = &place.motion else { panic!("chairs stand still") };
        let [x, y, z] = at.translation.to_array();
        let ellipse = (x / 100.0) * (x / 100.0) + (y / 75.0) * (y / 75.0);
        assert!(ellipse <= 1.0 && (0.0..=40.5).contains(&z), "{x} {y} {z}");
    }
}

#[test]
fn the_demo_has_instances_within_instances() {
    let scene = generate("demo", None).expect("it can be made");
    let stored: u64 = scene.geometries.iter().map(|g| u64::from(g.primitives())).sum();
    assert!(scene.primitives() > 100 * stored, "most of it is instances");
    let nested = |place: &crate::group::Place| !scene.groups[place.group].places.is_empty();
    assert!(scene.groups[scene.root].places.iter().any(nested));
    assert!(scene.materials.iter().any(|material| material.glows()));
    assert!(scene.materials.iter().any(|material| material.transmission > 0.0));
    assert!(scene.materials.iter().any(|material| material.metallic > 0.0));
}

#[test]
fn a_terrain_of_usual_size_has_a_million_triangles() {
    let scene = generate("terrain", None).expect("it can be made");
    assert_eq!(scene.primitives(), 1_002_528);
    assert_eq!(generate("scatter", None).expect("it can be made").primitives(), 1_000_000);
}
