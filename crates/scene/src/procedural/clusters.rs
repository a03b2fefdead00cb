//! Four things far apart, each best served by another technique: a lattice, a sphereflake,
//! a bundle of long thin bars, and a dense mesh.

use std::f64::consts::TAU;

use glam::DVec3;
use nestray_shapes::any::AnyShape;
use nestray_shapes::cylinder::Cylinder;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::triangle_mesh::Triangles;

use super::balls::flake;
use super::look::{camera, matte, metal, outdoors, paint};
use super::mesh::Mesh;
use super::random::Random;
use crate::geometry::Geometry;
use crate::scene::Scene;

/// Primitives of the clusters and the ground.
pub(super) fn count(size: u32) -> u64 {
    let n = u64::from(lattice_cells(size));
    let lattice = (n + 1).pow(3) + 3 * n * (n + 1).pow(2);
    let flake: u64 = (0..=size + 1).map(|level| 9u64.pow(level)).sum();
    let mesh = 2 * u64::from(knot_cells(size)).pow(2);
    lattice + flake + u64::from(bars(size)) + mesh + 2
}

fn lattice_cells(size: u32) -> u32 {
    6 * size
}

fn bars(size: u32) -> u32 {
    500 * 4u32.pow(size)
}

fn knot_cells(size: u32) -> u32 {
    64 << size
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = outdoors();
    let ground = scene.add_material(matte("ground", [0.45, 0.42, 0.38]));
    let red = scene.add_material(paint("red", [0.6, 0.1, 0.08], 0.4));
    let gold = scene.add_material(metal("gold", [0.95, 0.7, 0.35], 0.1));
    let blue = scene.add_material(paint("blue", [0.1, 0.2, 0.55], 0.3));
    let white = scene.add_material(paint("white", [0.8; 3], 0.3));
    let mut floor = Mesh::default();
    floor.quad(
        [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x * 400.0, y * 400.0, 0.0)),
    );
    scene.add(Geometry::mesh("ground", ground, floor.finish()));
    let corner = |x: f64, y: f64| DVec3::new(x * 30.0, y * 30.0, 3.5);
    scene.add(Geometry::shapes("lattice", red, lattice(size, corner(-1.0, -1.0))));
    scene.add(Geometry::shapes("sphereflake", gold, balls(size, corner(1.0, -1.0))));
    scene.add(Geometry::shapes("bundle", blue, bundle(size, corner(-1.0, 1.0))));
    scene.add(Geometry::mesh("knot", white, knot(knot_cells(size), corner(1.0, 1.0))));
    let from = DVec3::new(-20.0, -92.0, 42.0);
    scene.cameras.push(camera("whole", from, DVec3::new(0.0, -8.0, 0.0), 38.0));
    scene
}

/// Balls and bars in a cube of side 6.
fn lattice(size: u32, middle: DVec3) -> Vec<AnyShape> {
    let cells = lattice_cells(size);
    let (many, step) = (cells + 1, 6.0 / f64::from(cells));
    let mut shapes = Vec::new();
    for i in 0..many.pow(3) {
        let cell = [i % many, i / many % many, i / (many * many)];
        let at = middle - 3.0 + DVec3::from_array(cell.map(f64::from)) * step;
        shapes.push(ball(at, step / 4.0));
        for (axis, i) in DVec3::AXES.into_iter().zip(cell) {
            if i < cells {
                let to = at + axis * step;
                shapes.push(bar(at, to, step / 16.0));
            }
        }
    }
    shapes
}

fn balls(size: u32, middle: DVec3) -> Vec<AnyShape> {
    let mut shapes = Vec::new();
    flake(size + 1, middle, 1.8, &mut |center, radius| shapes.push(ball(center, radius)));
    shapes
}

/// Bars of length 25 side by side, about upright but no two alike.
fn bundle(size: u32, middle: DVec3) -> Vec<AnyShape> {
    let mut random = Random::new(6);
    let thin = 1.6 / f64::from(bars(size)).sqrt();
    let strew = |random: &mut Random| {
        let at = random.in_cube();
        DVec3::new(at.x, at.y, 0.0) * 2.5
    };
    let one = |_| {
        let base = middle + strew(&mut random) - DVec3::Z * 3.5;
        let top = base + strew(&mut random) * 0.3 + DVec3::new(6.0, 4.0, 24.0);
        bar(base, top, thin)
    };
    (0..bars(size)).map(one).collect()
}

/// A tube around a trefoil knot.
fn knot(cells: u32, middle: DVec3) -> Triangles {
    let line = |angle: f64| {
        let (twice, thrice) = (2.0 * angle, 3.0 * angle);
        let wide = 2.0 + libm::cos(thrice);
        DVec3::new(wide * libm::cos(twice), wide * libm::sin(twice), 1.2 * libm::sin(thrice)) * 1.15
    };
    let angle = |i: u32| TAU * f64::from(i) / f64::from(cells);
    let mut mesh = Mesh::default();
    let first = mesh.corners(cells, |row, column| {
        let along = angle(row);
        let dir = (line(along + 1e-3) - line(along - 1e-3)).normalize();
        let side = dir.cross(DVec3::Z).normalize();
        let up = side.cross(dir);
        let around = angle(column);
        let normal = side * libm::cos(around) + up * libm::sin(around);
        (middle + line(along) + normal * 0.75, normal)
    });
    mesh.cells(cells, first);
    mesh.finish()
}

fn ball(center: DVec3, radius: f64) -> AnyShape {
    Sphere { center: center.as_vec3a(), radius: radius as f32 }.into()
}

fn bar(base: DVec3, top: DVec3, radius: f64) -> AnyShape {
    Cylinder { base: base.as_vec3a(), top: top.as_vec3a(), radius: radius as f32 }.into()
}
