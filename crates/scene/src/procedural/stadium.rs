//! The teapot in a stadium: something small and dense in the middle of something huge, as
//! told in the Ray Tracing News.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DVec3};
use nestray_shapes::triangle_mesh::Triangles;

use super::look::{camera, matte, metal, outdoors, paint, still, upright};
use super::mesh::Mesh;
use super::newell::newell_mesh;
use crate::geometry::Geometry;
use crate::group::Group;
use crate::scene::Scene;

/// Length of the stadium, in metres.
const LENGTH: f64 = 200.0;

/// Rows of chairs.
const ROWS: u32 = 25;

/// Straight pieces of each terrace.
const PIECES: u32 = 120;

/// Cells along a side of the teapot's patches.
const CELLS: u32 = 12;

/// Triangles of the teapot, one chair, the terraces, the field and the ground.
pub(super) fn count(_size: u32) -> u64 {
    let teapot = 64 * CELLS * CELLS - 8 * CELLS;
    u64::from(teapot + 12 * PARTS.len() as u32 + 4 * ROWS * PIECES + 2 + 2)
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = outdoors();
    let grass = scene.add_material(matte("grass", [0.12, 0.32, 0.08]));
    let concrete = scene.add_material(matte("concrete", [0.5, 0.49, 0.47]));
    let red = scene.add_material(paint("red", [0.6, 0.06, 0.05], 0.4));
    let china = scene.add_material(metal("copper", [0.9, 0.55, 0.35], 0.15));
    scene.add(Geometry::mesh("field", grass, level(43.0, 29.0, 0.0)));
    scene.add(Geometry::mesh("ground", concrete, level(600.0, 600.0, -0.05)));
    scene.add(Geometry::mesh("terraces", concrete, terraces()));
    let chair = scene.add_apart(Geometry::mesh("chair", red, chair()));
    let chair = Group { name: "chair".into(), geometries: vec![chair], places: Vec::new() };
    let chair = scene.add_group(chair);
    for place in seats() {
        scene.place(chair, still(place));
    }
    let teapot = scene.add_apart(Geometry::mesh("teapot", china, newell_mesh(CELLS)));
    let teapot = Group { name: "teapot".into(), geometries: vec![teapot], places: Vec::new() };
    let teapot = scene.add_group(teapot);
    // From the end of the handle to that of the spout the teapot is 6.43 long.
    let length = LENGTH / f64::from(size);
    scene.place(teapot, still(upright(0.0, length / 6.43, DVec3::ZERO)));
    let middle = DVec3::new(0.0, 0.0, 0.22 * length);
    let near = middle + DVec3::new(0.6, -2.0, 0.42) * length;
    let above = middle + DVec3::Z * (0.08 * length);
    scene.cameras.push(camera("teapot", near, above, 40.0));
    scene.cameras.push(camera("rim", DVec3::new(-84.0, -36.0, 44.0), middle, 55.0));
    scene
}

/// A level rectangle about the z-axis.
fn level(half_x: f64, half_y: f64, z: f64) -> Triangles {
    let corner = |x: f64, y: f64| DVec3::new(x * half_x, y * half_y, z);
    let mut mesh = Mesh::default();
    mesh.quad([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)]);
    mesh.finish()
}

/// Half the axes of a row's front edge, and how high it is.
fn row(row: u32) -> (DVec3, f64) {
    let part = f64::from(row) / f64::from(ROWS);
    (
        DVec3::new(62.0 + 38.0 * part, 43.0 + 32.0 * part, 1.0),
        0.6 + 39.4 * part * (0.6 + 0.4 * part),
    )
}

/// A point above or below a row's front edge.
fn on(row_axes: DVec3, angle: f64, z: f64) -> DVec3 {
    DVec3::new(libm::cos(angle), libm::sin(angle), z) * row_axes
}

/// Steps, each a wall and the floor behind it.
fn terraces() -> Triangles {
    let mut mesh = Mesh::default();
    for step in 0..ROWS {
        let below = if step == 0 { 0.0 } else { row(step - 1).1 };
        let ((axes, z), (behind, _)) = (row(step), row(step + 1));
        let angle = |i: u32| TAU * f64::from(i) / f64::from(PIECES);
        for i in 0..PIECES {
            let (a, b) = (angle(i), angle(i + 1));
            mesh.quad([on(axes, b, below), on(axes, a, below), on(axes, a, z), on(axes, b, z)]);
            mesh.quad([on(axes, b, z), on(axes, a, z), on(behind, a, z), on(behind, b, z)]);
        }
    }
    mesh.finish()
}

/// Where the chairs are, each turned to the field, about one per metre.
fn seats() -> impl Iterator<Item = DAffine3> {
    (0..ROWS).flat_map(|step| {
        let (front, z) = row(step);
        let (behind, _) = row(step + 1);
        let axes = (front + behind) / 2.0;
        let many = (TAU * ((axes.x * axes.x + axes.y * axes.y) / 2.0).sqrt()) as u32;
        (0..many).map(move |i| {
            let angle = TAU * f64::from(i) / f64::from(many);
            let at = on(axes, angle, z);
            upright(libm::atan2(at.y, at.x) + TAU / 4.0, 1.0, at)
        })
    })
}

/// The parts of a chair that looks along +y, each a middle and sizes, in centimetres.
const PARTS: [([f64; 3], [f64; 3]); 16] = [
    ([0.0, 0.0, 44.0], [46.0, 44.0, 4.0]),
    ([-21.0, -20.0, 21.0], [4.0, 4.0, 42.0]),
    ([21.0, -20.0, 21.0], [4.0, 4.0, 42.0]),
    ([-21.0, 20.0, 21.0], [4.0, 4.0, 42.0]),
    ([21.0, 20.0, 21.0], [4.0, 4.0, 42.0]),
    ([-21.0, -20.0, 68.0], [4.0, 4.0, 44.0]),
    ([21.0, -20.0, 68.0], [4.0, 4.0, 44.0]),
    ([0.0, -20.0, 86.0], [38.0, 3.0, 8.0]),
    ([0.0, -20.0, 74.0], [38.0, 2.0, 6.0]),
    ([0.0, -20.0, 64.0], [38.0, 2.0, 6.0]),
    ([0.0, -20.0, 54.0], [38.0, 2.0, 6.0]),
    ([-24.0, 0.0, 64.0], [5.0, 40.0, 3.0]),
    ([24.0, 0.0, 64.0], [5.0, 40.0, 3.0]),
    ([-24.0, 18.0, 54.0], [3.0, 3.0, 18.0]),
    ([24.0, 18.0, 54.0], [3.0, 3.0, 18.0]),
    ([0.0, 20.0, 14.0], [40.0, 2.0, 3.0]),
];

fn chair() -> Triangles {
    let mut mesh = Mesh::default();
    for (middle, sizes) in PARTS {
        let [middle, sizes] = [middle, sizes].map(|v| DVec3::from_array(v) / 100.0);
        mesh.cuboid(DAffine3::from_mat3_translation(DMat3::from_diagonal(sizes), middle));
    }
    mesh.finish()
}
