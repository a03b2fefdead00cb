//! What a technique expects of a random line is what random lines do: steps and tests, counted,
//! over small scenes of many kinds.
#![expect(clippy::print_stdout, reason = "the table is what one looks at")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use glam::Vec3A;
use nestray_core::aabb::{Aabb, Clip};
use nestray_core::cost::CostModel;
use nestray_core::object::Object;
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_registry::{Members, TECHNIQUES};
use nestray_scene::geometry::Content;
use nestray_scene::procedural::generate;
use nestray_shapes::shape::Single;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use nestray_tests::numbers::Numbers;
use nestray_tests::rays::lamps;

/// Lines through each nest; `NESTRAY_LINES` asks for another number. All do the same in a list.
fn lines(technique: &str) -> u32 {
    let asked = std::env::var("NESTRAY_LINES").ok().and_then(|n| n.parse().ok());
    if technique == "list" { 100 } else { asked.unwrap_or(20_000) }
}

/// The scenes, of what size; their shapes, or their triangles. None where all is in a few cells of
/// a grid, which few lines meet: it would take millions of lines to know how many.
const SCENES: &[(&str, u32)] = &[
    ("lattice", 6),
    ("tetra", 4),
    ("gears", 2),
    ("hair", 60),
    ("teapot", 4),
    ("needles", 1000),
    ("scatter", 3000),
    ("truss", 3),
    ("terrain", 24),
];

/// A formula that counts what lines meet by the surface of convex volumes is exact, but for what
/// rounding and padding add.
const EXACT: f64 = 0.02;
/// All others.
const ABOUT: f64 = 0.20;

/// How near steps and tests of a technique come to what it expects, if its children are tested
/// one by one; leaves of packed triangles are convex volumes in any technique.
fn allowed(technique: &str) -> [f64; 2] {
    match technique {
        // Cells are boxes, but what a child is tested for is several of them: lines are sent.
        "kd-tree" | "bsp" | "octree" | "nested-grid" | "adaptive-grid" | "sbvh" | "spacetime" => {
            [EXACT, ABOUT]
        }
        // Lines are sent to count steps: a region is crossed in one wherever it is entered.
        "macro-regions" => [ABOUT, EXACT],
        // Turned boxes stick out of those around them.
        "rubin-whitted" => [ABOUT, ABOUT],
        // Lines are sent: lists depend on all five numbers of a ray.
        "ray-classification" => [ABOUT, ABOUT],
        _ => [EXACT, EXACT],
    }
}

/// A kind of rays that a technique has no lists for: what it has them for are no random lines.
fn kind(technique: &str) -> RayKind {
    if technique == "eye-buffer" { RayKind::Refract } else { RayKind::Camera }
}

/// The shapes of a scene, its triangles.
fn members(name: &str, size: u32) -> Vec<Members> {
    let scene = generate(name, Some(size)).expect("it can be made");
    let (mut shapes, mut corners) = (Vec::new(), Vec::new());
    for geometry in &scene.geometries {
        match &geometry.content {
            Content::Shapes(more) => shapes.extend(more.iter().cloned()),
            Content::Mesh(mesh) => corners.extend((0..mesh.count()).map(|i| mesh.corners(i))),
            Content::Solids(_) => {}
        }
    }
    let single = |(i, shape)| Single::new(i, shape);
    let shapes: Vec<_> = (0..).zip(shapes).map(single).collect();
    let corners: Vec<_> = corners.iter().map(|c| c.map(Vec3A::from_array)).collect();
    let triangles = Arc::new(Triangles::from_corners(&corners));
    let triangles = Members::Triangles(TriangleMesh::new(0, triangles));
    match (shapes.len(), corners.len()) {
        (_, 0) => vec![Members::Shapes(shapes)],
        (0, _) => vec![triangles],
        _ => vec![Members::Shapes(shapes), triangles],
    }
}

/// A line such that all that meet `bounds` are as likely.
fn line(numbers: &mut Numbers, bounds: &Aabb, kind: RayKind) -> Ray {
    let radius = 0.51 * bounds.size().length();
    loop {
        let dir = numbers.direction();
        let (u, v) = dir.any_orthonormal_pair();
        let at = (u * numbers.between(-1.0, 1.0) + v * numbers.between(-1.0, 1.0)) * radius;
        let ray = Ray::new(bounds.center() + at - dir * (2.0 * radius), dir, kind);
        if Clip::new(&ray, bounds.reach()).cut(bounds, f32::INFINITY).is_some() {
            return ray;
        }
    }
}

/// Steps and tests of a random line, as expected: the cost where nothing else costs anything.
fn expected(nest: &dyn Object) -> [f64; 2] {
    let mut kinds = BTreeMap::from([("triangle".to_owned(), 1.0)]);
    nest.visit_children(&mut |child| _ = kinds.insert(child.kind().to_owned(), 1.0));
    let free = CostModel {
        ray: 0.0,
        far: 0.0,
        call: 0.0,
        transform: 0.0,
        primitive: BTreeMap::new(),
        step: BTreeMap::new(),
        kind: None,
    };
    let steps = CostModel { step: BTreeMap::from([(nest.kind().to_owned(), 1.0)]), ..free.clone() };
    [steps, CostModel { primitive: kinds, ..free }].map(|model| nest.cost(&model).miss_nanos)
}

/// Steps and tests of random lines, as counted.
fn counted(nest: &dyn Object, kind: RayKind) -> [f64; 2] {
    let (mut numbers, mut scratch) = (Numbers::new(17), Scratch::counting());
    let lines = lines(nest.kind());
    for _ in 0..lines {
        let ray = line(&mut numbers, &nest.bounds(), kind);
        nest.all_hits(&ray, &mut Vec::new(), &mut scratch);
    }
    let total = scratch.counters.total();
    [total.all_steps(), total.all_tests()].map(|count| count as f64 / f64::from(lines))
}

#[test]
fn random_lines_do_what_techniques_expect() {
    let (mut table, mut wrong) = (String::new(), Vec::new());
    for &(name, size) in SCENES {
        for members in members(name, size) {
            let is_packed = matches!(members, Members::Triangles(_));
            let what = if is_packed { "triangles" } else { "shapes" };
            _ = writeln!(table, "{name} {size}, {what}: steps, tests, expected and counted");
            for entry in TECHNIQUES {
                let lamps = lamps(Aabb { min: Vec3A::ZERO, max: Vec3A::ONE });
                let settings = (entry.aimed)(&serde_json::Value::Null, &lamps).expect("defaults");
                let nest = (entry.build)(&settings, members.clone()).expect("defaults");
                let (expected, counted) = (expected(&*nest), counted(&*nest, kind(entry.name)));
                let [steps, tests] = allowed(entry.name);
                let exact = is_packed && steps == EXACT;
                let allowed = [steps, if exact { EXACT } else { tests }];
                _ = write!(table, "    {:20}", entry.name);
                for ((expected, counted), allowed) in expected.into_iter().zip(counted).zip(allowed)
                {
                    let off = if counted == expected { 0.0 } else { counted / expected - 1.0 };
                    let off = off * 100.0;
                    _ = write!(table, "{expected:9.2}{counted:9.2}{off:+7.1} %");
                    if off.abs() > allowed * 100.0 {
                        wrong.push(format!("{} over {name}, {what}: {off:+.1} %", entry.name));
                    }
                }
                table.push('\n');
            }
        }
    }
    println!("{table}");
    assert!(wrong.is_empty(), "{wrong:#?}");
}
