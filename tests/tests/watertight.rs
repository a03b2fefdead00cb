//! Closed meshes do not leak: every ray from inside hits, also at vertices and edges.

use nestray_shapes::triangle_mesh::Triangles;
use nestray_tests::closed::{edges, welded};
use nestray_tests::leaks::Closed;
use nestray_tests::scene_files::{files, name, scene};

/// Rays through each technique; `NESTRAY_RAYS` asks for another number.
fn rays() -> usize {
    std::env::var("NESTRAY_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_000_000)
}

#[test]
fn a_twisted_torus_does_not_leak() {
    let torus = Closed::new("twisted torus", twisted_torus(64, 24)).expect("it is closed");
    eprintln!("{}", torus.assert_no_leak(rays() / 4));
}

/// Every mesh of the folder that is closed; rays are shared out by what there is to aim at.
#[test]
fn the_closed_meshes_of_the_test_scenes_do_not_leak() {
    let mut closed = Vec::new();
    for path in files("meshes", &["obj", "off", "stl", "ply"], u64::MAX) {
        let mesh = welded(&scene(&path));
        let open = edges(&mesh).values().filter(|[along, against]| along != against).count();
        match Closed::new(name(&path), mesh) {
            Some(mesh) => closed.push(mesh),
            None => eprintln!("{} is not closed at {open} edges", name(&path)),
        }
    }
    let aims: usize = closed.iter().map(Closed::aims).sum();
    for mesh in &closed {
        let share = rays() as f64 * mesh.aims() as f64 / aims as f64;
        eprintln!("{}", mesh.assert_no_leak((share as usize).max(rays() / 40)));
    }
}

#[test]
fn a_mesh_with_a_hole_is_seen_to_leak() {
    let whole = twisted_torus(12, 8);
    assert!(Closed::new("whole", whole.clone()).is_some());
    let faces = whole.faces()[1..].to_vec();
    let holed = Triangles::new(whole.positions().to_vec(), faces).expect("indices in range");
    assert!(Closed::new("holed", holed).is_none());
}

/// A torus with a triangular bulge that turns along it: no face is in a plane of the axes.
fn twisted_torus(around: usize, along: usize) -> Triangles {
    let tau = std::f32::consts::TAU;
    let mut positions = Vec::new();
    for i in 0..around {
        let turn = i as f32 / around as f32 * tau;
        for j in 0..along {
            let angle = j as f32 / along as f32 * tau;
            let radius = 0.3 + 0.1 * (3.0 * angle + turn).cos();
            let out = 1.0 + radius * angle.cos();
            positions.push([out * turn.cos(), out * turn.sin(), radius * angle.sin()]);
        }
    }
    let vertex = |i: usize, j: usize| ((i % around) * along + j % along) as u32;
    let faces = (0..around * along)
        .flat_map(|n| {
            let (i, j) = (n / along, n % along);
            let [a, b] = [vertex(i, j), vertex(i + 1, j)];
            let [c, d] = [vertex(i, j + 1), vertex(i + 1, j + 1)];
            [[a, b, c], [b, d, c]]
        })
        .collect();
    Triangles::new(positions, faces).expect("indices in range")
}
