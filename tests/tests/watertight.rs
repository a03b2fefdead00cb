//! Closed meshes do not leak: every ray from inside hits, also at vertices and edges.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::Vec3A;
use nestray_core::hit::Hit;
use nestray_core::object::{DynObject, Object};
use nestray_core::ray::{Ray, RayKind};
use nestray_core::scratch::Scratch;
use nestray_shapes::triangle_mesh::{TriangleMesh, Triangles};
use nestray_techniques::registry::{Members, TECHNIQUES};
use nestray_tests::numbers::Numbers;
use serde_json::Value;

/// Rays over all meshes and techniques; `NESTRAY_RAYS` asks for another number.
fn rays() -> usize {
    std::env::var("NESTRAY_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(1_000_000)
}

#[test]
fn a_twisted_torus_does_not_leak() {
    let mesh = twisted_torus(64, 24);
    // Its middle line is inside.
    let inside = |numbers: &mut Numbers| {
        let turn = numbers.between(0.0, std::f32::consts::TAU);
        Vec3A::new(turn.cos(), turn.sin(), 0.0) + (numbers.point() - 0.5) * 0.02
    };
    assert_closed("twisted torus", mesh, inside, rays() / 4);
}

#[test]
fn the_closed_meshes_of_the_test_scenes_do_not_leak() {
    let names = ["cow.obj", "spot.obj", "fandisk.obj", "homer.obj", "low_poly_bunny.obj"];
    let folder = scenes().join("meshes");
    let found: Vec<_> = names.iter().filter(|name| folder.join(name).is_file()).collect();
    if found.is_empty() {
        eprintln!("skipped: no test scenes at {}; set NESTRAY_SCENES", folder.display());
        return;
    }
    for name in &found {
        let mesh = obj(&folder.join(name));
        let points = inside_points(&mesh);
        let inside = |numbers: &mut Numbers| *numbers.pick(&points);
        assert_closed(name, mesh, inside, rays() / found.len());
    }
}

fn scenes() -> PathBuf {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes");
    std::env::var_os("NESTRAY_SCENES").map_or(beside, PathBuf::from)
}

/// Positions and triangles of an OBJ file, nothing else.
fn obj(path: &Path) -> Triangles {
    let text = std::fs::read_to_string(path).expect("readable");
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let mut next = || words.next().and_then(|w| w.parse().ok()).expect("a number");
                positions.push([next(), next(), next()]);
            }
            Some("f") => {
                let index = |word: &str| word.split('/').next().and_then(|w| w.parse::<u32>().ok());
                let corners: Vec<u32> = words.map(|w| index(w).expect("an index") - 1).collect();
                faces.extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
            }
            _ => {}
        }
    }
    Triangles::new(positions, faces).expect("indices in range")
}

/// Points well inside: half way between pairs of hits of lines through the mesh.
fn inside_points(mesh: &Triangles) -> Vec<Vec3A> {
    let nest = (TECHNIQUES[1].build)(&Value::Null, members(mesh.clone())).expect("defaults");
    let bounds = nest.bounds();
    let mut numbers = Numbers::new(9);
    let mut points = Vec::new();
    while points.len() < 64 {
        let from = bounds.min + bounds.size() * numbers.point();
        let dir = numbers.direction();
        let start = from - dir * bounds.size().length();
        let mut hits = Vec::new();
        nest.all_hits(&Ray::new(start, dir, RayKind::Camera), &mut hits, &mut Scratch::new());
        hits.sort_by(|a, b| a.t.total_cmp(&b.t));
        if let [a, b, ..] = hits[..] {
            let depth = b.t - a.t;
            if hits.len() % 2 == 0 && depth > 0.05 * bounds.size().max_element() {
                points.push(start + dir * (a.t + b.t) * 0.5);
            }
        }
    }
    points
}

fn members(mesh: Triangles) -> Members {
    Members::Triangles(TriangleMesh::new(0, Arc::new(mesh)))
}

/// Shoots rays from inside at vertices, points of edges, and anywhere, through every technique.
fn assert_closed(
    name: &str,
    mesh: Triangles,
    inside: impl Fn(&mut Numbers) -> Vec3A,
    count: usize,
) {
    let mut numbers = Numbers::new(4);
    let mut rays = Vec::with_capacity(count);
    while rays.len() < count.min(200_000) {
        let origin = inside(&mut numbers);
        let triangle = numbers.below(mesh.count() as usize) as u32;
        let [a, b, c] = mesh.corners(triangle).map(Vec3A::from_array);
        let aim = match numbers.below(4) {
            0 => a,
            1 => a + (b - a) * (numbers.below(101) as f32 / 100.0),
            2 => b + (c - b) * numbers.unit(),
            _ => origin + numbers.direction(),
        };
        rays.push(Ray::new(origin, aim - origin, RayKind::Camera));
    }
    let rounds = (count / TECHNIQUES.len() / rays.len()).max(1);
    for entry in TECHNIQUES.iter().filter(|entry| entry.name != "list" || mesh.count() < 4_000) {
        let nest: DynObject = (entry.build)(&Value::Null, members(mesh.clone())).expect("defaults");
        let most = if entry.name == "list" { 2_000 } else { rays.len() };
        for round in 0..rounds {
            let rays = moved(&rays[..most], round);
            let mut blocked = vec![false; rays.len()];
            nest.any_hits(&rays, &mut blocked, &mut Scratch::new());
            let mut hits: Vec<Hit> = vec![Hit::none(f32::INFINITY); rays.len()];
            nest.closest_hits(&rays, &mut hits, &mut Scratch::new());
            let lost = blocked.iter().zip(&hits).filter(|(any, hit)| !**any || !hit.is_some());
            assert_eq!(lost.count(), 0, "{name} leaks through {}, round {round}", entry.name);
        }
    }
}

/// The same targets from origins a little further along.
fn moved(rays: &[Ray], round: usize) -> Vec<Ray> {
    let part = round as f32 * 1e-3;
    rays.iter()
        .map(|ray| Ray::new(ray.at(part), ray.dir() * (1.0 - part), RayKind::Camera))
        .collect()
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
