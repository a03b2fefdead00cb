//! The scene of the front page: a teapot and a sphereflake on a plaza among trees, with
//! rings of rings of beads, glass, metal, and two glowing doors.

use std::f64::consts::TAU;

use glam::{DAffine3, DMat3, DVec3, Vec3A};
use nestray_shapes::any::AnyShape;
use nestray_shapes::sphere::Sphere;
use nestray_shapes::triangle_mesh::Triangles;

use super::balls::flake;
use super::forest::{add_tree, tree_count};
use super::look::{camera, glass, matte, metal, outdoors, paint, still, upright};
use super::mesh::Mesh;
use super::newell::newell_mesh;
use super::random::Random;
use super::standard::rotation;
use crate::geometry::Geometry;
use crate::group::{Group, Place};
use crate::light::Background;
use crate::material::Material;
use crate::scene::Scene;

/// Squares along a side of the plaza, each a metre long.
const SQUARES: u32 = 20;

/// Cells along a side of the teapot's patches.
const CELLS: u32 = 12;

/// Beads of a ring, and rings of a coil.
const BEADS: u32 = 12;
const RINGS: u32 = 30;

/// Trees around the plaza.
const TREES: u32 = 200;

/// Balls of clear glass: where, and how large.
const GLASS: [([f64; 2], f64); 3] =
    [([0.55, -3.0], 0.75), ([-1.3, -3.9], 0.32), ([2.6, -4.1], 0.24)];

/// What is stored: balls, beads, and the triangles of teapot, plaza, plinth, doors, meadow
/// and tree.
pub(super) fn count(size: u32) -> u64 {
    let balls: u64 = (0..=size).map(|level| 9u64.pow(level)).sum();
    let teapot = 64 * CELLS * CELLS - 8 * CELLS;
    let boxes = 12 * (1 + 2);
    let flat = 2 * (SQUARES * SQUARES + 2 + 1);
    let triangles = u64::from(teapot + boxes + flat) + tree_count();
    balls + u64::from(BEADS) + GLASS.len() as u64 + triangles
}

pub(super) fn build(size: u32) -> Scene {
    let mut scene = outdoors();
    scene.background = Background::Gradient([[1.0, 0.93, 0.86], [0.2, 0.4, 0.82]], Vec3A::Z);
    lay_ground(&mut scene);
    put_things(&mut scene, size);
    put_coils(&mut scene);
    for (name, [x, y], turn, emission) in [
        ("warm", [-6.2, 3.2], 0.75, [1.9, 0.55, 0.1]),
        ("cool", [6.2, 3.4], -0.75, [0.1, 0.5, 1.9]),
    ] {
        put_door(&mut scene, name, upright(turn, 1.0, DVec3::new(x, y, 0.0)), emission);
    }
    plant_trees(&mut scene);
    let from = DVec3::new(1.7, -11.6, 3.3);
    scene.cameras.push(camera("plaza", from, DVec3::new(0.1, 0.0, 1.35), 33.0));
    let above = DVec3::new(-26.0, -44.0, 30.0);
    scene.cameras.push(camera("above", above, DVec3::new(0.0, 4.0, 0.0), 34.0));
    scene
}

/// The chessboard of the plaza, and the meadow around it.
fn lay_ground(scene: &mut Scene) {
    let light = scene.add_material(paint("marble", [0.74, 0.7, 0.64], 0.2));
    let dark = scene.add_material(paint("slate", [0.07, 0.075, 0.085], 0.15));
    let grass = scene.add_material(matte("grass", [0.12, 0.2, 0.05]));
    let square = |i: u32, j: u32| {
        let place = |i: u32| f64::from(i) - f64::from(SQUARES) / 2.0;
        [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            .map(|(i, j)| DVec3::new(place(i), place(j), 0.0))
    };
    for (name, material, odd) in [("light squares", light, 0), ("dark squares", dark, 1)] {
        let mut mesh = Mesh::default();
        for cell in 0..SQUARES * SQUARES {
            let (i, j) = (cell % SQUARES, cell / SQUARES);
            if (i + j) % 2 == odd {
                mesh.quad(square(i, j));
            }
        }
        scene.add(Geometry::mesh(name, material, mesh.finish()));
    }
    let mut meadow = Mesh::default();
    let far = |x: f64, y: f64| DVec3::new(x * 400.0, y * 400.0, -0.03);
    meadow.quad([far(-1.0, -1.0), far(1.0, -1.0), far(1.0, 1.0), far(-1.0, 1.0)]);
    scene.add(Geometry::mesh("meadow", grass, meadow.finish()));
}

/// Teapots, one of them on a plinth, the sphereflake, and glass.
fn put_things(scene: &mut Scene, size: u32) {
    let glaze = scene.add_material(paint("glaze", [0.02, 0.22, 0.3], 0.06));
    let gold = scene.add_material(metal("gold", [1.0, 0.72, 0.34], 0.04));
    let stone = scene.add_material(matte("stone", [0.5, 0.36, 0.27]));
    let clear = scene.add_material(glass("glass", [0.97, 0.99, 0.98]));
    let plinth = DVec3::new(-2.7, 0.6, 0.0);
    scene.add(Geometry::mesh("plinth", stone, cuboid(plinth + DVec3::Z * 0.4, [2.7, 2.7, 0.8])));
    let teapot = add_group(scene, Geometry::mesh("teapot", glaze, newell_mesh(CELLS)));
    scene.place(teapot, still(upright(-0.5, 0.72, plinth + DVec3::Z * 0.8)));
    for (x, y, turn, scale) in
        [(-0.6, -4.6, 0.7, 0.13), (3.6, -2.6, 2.5, 0.2), (4.35, -3.1, 0.2, 0.13)]
    {
        scene.place(teapot, still(upright(turn, scale, DVec3::new(x, y, 0.0))));
    }
    let mut balls = Vec::new();
    flake(size, DVec3::ZERO, 0.5, &mut |center, radius| balls.push(ball(center, radius)));
    let balls = add_group(scene, Geometry::shapes("sphereflake", gold, balls));
    scene.place(balls, still(upright(0.35, 2.7, DVec3::new(2.5, 0.9, 1.35))));
    let drops = GLASS.map(|([x, y], radius)| ball(DVec3::new(x, y, radius), radius));
    scene.add(Geometry::shapes("glass", clear, drops.to_vec()));
}

/// Beads in rings, rings in coils, coils around things: instances three deep.
fn put_coils(scene: &mut Scene) {
    let silver = scene.add_material(metal("silver", [0.9, 0.9, 0.92], 0.08));
    let circle = |i: u32, many: u32| {
        let angle = TAU * f64::from(i) / f64::from(many);
        (angle, DVec3::new(libm::cos(angle), libm::sin(angle), 0.0))
    };
    let beads = (0..BEADS).map(|i| {
        let at = circle(i, BEADS).1;
        ball(DVec3::new(at.x, 0.0, at.y) * 0.24, 0.055)
    });
    let ring = add_group(scene, Geometry::shapes("beads", silver, beads.collect()));
    let rings = (0..RINGS).map(|i| {
        let (angle, at) = circle(i, RINGS);
        Place { name: String::new(), group: ring, motion: still(upright(angle, 1.0, at * 2.0)) }
    });
    let places = rings.collect();
    let coil = Group { name: "coil".into(), geometries: Vec::new(), places };
    let coil = scene.add_group(coil);
    let tilt = DAffine3::from_mat3_translation(
        rotation(DVec3::new(0.8, 0.6, 0.0), 0.62) * DMat3::from_diagonal(DVec3::splat(0.95)),
        DVec3::new(2.5, 0.9, 1.75),
    );
    scene.place(coil, still(tilt));
    scene.place(coil, still(upright(0.0, 1.13, DVec3::new(-2.7, 0.6, 0.28))));
}

/// A slab with a glowing front, which looks along −y.
fn put_door(scene: &mut Scene, name: &str, place: DAffine3, emission: [f32; 3]) {
    let glow = Material { emission, ..matte(name, [0.0; 3]) };
    let glow = scene.add_material(glow);
    let frame = scene.add_material(matte("frame", [0.05; 3]));
    let mut slab = Mesh::default();
    let middle = DVec3::new(0.0, 0.1, 1.75);
    let sizes = DMat3::from_diagonal(DVec3::new(1.5, 0.16, 3.5));
    slab.cuboid(place * DAffine3::from_mat3_translation(sizes, middle));
    let mut front = Mesh::default();
    let corner = |x: f64, z: f64| place.transform_point3(DVec3::new(x, 0.0, z));
    front.quad([corner(-0.65, 0.1), corner(0.65, 0.1), corner(0.65, 3.4), corner(-0.65, 3.4)]);
    scene.add(Geometry::mesh("frame", frame, slab.finish()));
    scene.add(Geometry::mesh(name, glow, front.finish()));
}

/// One tree in many places around the plaza.
fn plant_trees(scene: &mut Scene) {
    let tree = add_tree(scene);
    let mut random = Random::new(7);
    for i in 0..TREES {
        // Turns by the golden angle, farther out each time.
        let angle = f64::from(i) * 2.399_963 + random.between(-0.05, 0.05);
        let away = 16.5 + 36.0 * (f64::from(i) / f64::from(TREES)).sqrt();
        let at = DVec3::new(away * libm::cos(angle), away * libm::sin(angle), -0.05);
        let (turn, scale) = (random.between(0.0, TAU), random.between(1.0, 1.7));
        scene.place(tree, still(upright(turn, scale, at)));
    }
}

/// A group of one geometry, in no place yet.
fn add_group(scene: &mut Scene, geometry: Geometry) -> usize {
    let name = geometry.name.clone();
    let geometries = vec![scene.add_apart(geometry)];
    scene.add_group(Group { name, geometries, places: Vec::new() })
}

fn cuboid(middle: DVec3, sizes: [f64; 3]) -> Triangles {
    let mut mesh = Mesh::default();
    let sizes = DMat3::from_diagonal(DVec3::from_array(sizes));
    mesh.cuboid(DAffine3::from_mat3_translation(sizes, middle));
    mesh.finish()
}

fn ball(center: DVec3, radius: f64) -> AnyShape {
    Sphere { center: center.as_vec3a(), radius: radius as f32 }.into()
}
