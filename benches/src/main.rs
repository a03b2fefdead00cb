//! The same rays through `nestray` and `parry3d`, in turns, one thread.
//!
//! `cargo run --release -p nestray-benches -- [SCENE] [SIDE]`: a scene file of triangles (default:
//! the built-in terrain), and the number of pixels along each side of the picture whose rays are
//! shot (default 1024).
#![expect(clippy::print_stdout, reason = "a program for people at a terminal")]

mod contest;

use std::error::Error;
use std::path::Path;

use contest::{Contender, Contest};
use glam::DVec3;
use nestray::prelude::*;
use parry3d::math::Vector;
use parry3d::query::RayCast;
use parry3d::shape::TriMesh;

/// Times each contender takes its turn.
const ROUNDS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let scene = match args.next() {
        Some(path) => load(Path::new(&path), &Default::default())?.scene,
        None => nestray::scene::procedural::generate("terrain", None)?,
    };
    let side: usize = args.next().map_or(Ok(1024), |side| side.parse())?;
    let (positions, faces) = triangles(&scene);
    println!("{} triangles, {side} × {side} rays, {ROUNDS} rounds", faces.len());

    let world = build(&single("bvh", Default::default(), &scene)?, &scene)?;
    let corner = |p: &[f32; 3]| Vector::new(p[0], p[1], p[2]);
    let peer = TriMesh::new(positions.iter().map(corner).collect(), faces.clone())?;
    for (name, rays) in [("primary", primary(&scene, side)), ("chords", chords(&scene, side))] {
        let theirs: Vec<parry3d::query::Ray> = rays
            .iter()
            .map(|ray| {
                let vector = |v: Vec3A| Vector::new(v.x, v.y, v.z);
                parry3d::query::Ray::new(vector(ray.origin()), vector(ray.dir()))
            })
            .collect();
        let mut scratch = Scratch::new();
        let mut one_by_one = |hits: &mut [f32]| {
            for (ray, t) in rays.iter().zip(hits) {
                let mut hit = Hit::none(ray.t_max());
                world.closest_hit(ray, &mut hit, &mut scratch);
                *t = hit.t;
            }
        };
        let mut scratch = Scratch::new();
        let mut in_batches = |hits: &mut [f32]| {
            for (rays, hits) in rays.chunks(4096).zip(hits.chunks_mut(4096)) {
                let mut found: Vec<Hit> = rays.iter().map(|ray| Hit::none(ray.t_max())).collect();
                world.closest_hits(rays, &mut found, &mut scratch);
                hits.iter_mut().zip(&found).for_each(|(t, hit)| *t = hit.t);
            }
        };
        let mut parry = |hits: &mut [f32]| {
            for (ray, t) in theirs.iter().zip(hits) {
                *t = peer.cast_local_ray(ray, f32::MAX, false).unwrap_or(f32::INFINITY);
            }
        };
        let judge = |ray: usize| exhaustive(&positions, &faces, &rays[ray]);
        Contest { name, rays: rays.len(), rounds: ROUNDS, judge: &judge }.run(vec![
            Contender { name: "parry3d", shoot: &mut parry },
            Contender { name: "nestray, single", shoot: &mut one_by_one },
            Contender { name: "nestray, batch", shoot: &mut in_batches },
        ]);
    }
    Ok(())
}

/// All triangles of a scene, in one list.
fn triangles(scene: &Scene) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for geometry in &scene.geometries {
        if let Content::Mesh(mesh) = &geometry.content {
            let first = positions.len() as u32;
            positions.extend_from_slice(mesh.positions());
            faces.extend(mesh.faces().iter().map(|face| face.map(|v| v + first)));
        }
    }
    (positions, faces)
}

/// How far a ray goes until it meets a triangle, in doubles; infinite if it meets none.
fn exhaustive(positions: &[[f32; 3]], faces: &[[u32; 3]], ray: &Ray) -> f64 {
    let (origin, dir) = (ray.origin().as_dvec3(), ray.dir().as_dvec3());
    let corner = |v: u32| DVec3::from(positions[v as usize].map(f64::from)) - origin;
    let mut nearest = f64::INFINITY;
    for &[a, b, c] in faces {
        let [a, b, c] = [corner(a), corner(b), corner(c)];
        // The volumes the ray spans with the edges have one sign where it is inside all three.
        let edges = [c.cross(b), a.cross(c), b.cross(a)].map(|edge| edge.dot(dir));
        let sum: f64 = edges.iter().sum();
        if edges.iter().all(|&edge| edge >= 0.0) || edges.iter().all(|&edge| edge <= 0.0) {
            let t = (a * edges[0] + b * edges[1] + c * edges[2]).dot(dir) / sum / dir.dot(dir);
            if t >= 0.0 && t < nearest {
                nearest = t;
            }
        }
    }
    nearest
}

/// One ray through the middle of each pixel, line by line.
fn primary(scene: &Scene, side: usize) -> Vec<Ray> {
    let view = scene.cameras.first().cloned().unwrap_or_default().view(1.0);
    let side = side as u32;
    let through = |i: u32| view.through([i % side, i / side], [side; 2]);
    (0..side * side)
        .map(through)
        .map(|(origin, dir)| Ray::new(origin, dir, RayKind::Camera))
        .collect()
}

/// Rays between points spread over the faces of the bounds, in no order.
fn chords(scene: &Scene, side: usize) -> Vec<Ray> {
    let bounds = scene.bounds();
    // Steps of irrational length fill the box evenly.
    let part = |i: usize, step: f64| ((i as f64 + 1.0) * step).fract() as f32;
    (0..side * side)
        .map(|i| {
            let point = |a: f64, b: f64, c: f64| {
                let mut at = Vec3A::new(part(i, a), part(i, b), part(i, c));
                at[i % 3] = at[i % 3].round();
                bounds.min + bounds.size() * at
            };
            let from = point(0.754_877_666, 0.569_840_291, 0.415_926_535);
            let to = point(0.819_172_513, 0.671_043_607, 0.549_700_478);
            Ray::new(from, to - from, RayKind::Diffuse)
        })
        .collect()
}
